//! Directions after a mirror reflection or a refraction.
//!
//! ```text
//! sin_i = eta_t_over_i sin_t                                                                (Snell)
//! reflected = 2 (wo.n) n - wo,   refracted = -(wo - cos_i n) / eta_t_over_i - cos_t n
//! ```
//! All directions point away from the surface and have unit length; `n` may lie on either side. The cosine of the
//! refracted direction is that of [`super::fresnel`], so both agree on where total internal reflection begins.
//! Measured against f64: each component is right to 2e-7 (1 + cos_i / (eta_t_over_i^2 cos_t)), where the second term
//! is what the f32 input leaves open near the critical angle.

use glam::Vec3;

use super::fresnel::refracted_cosine;

/// The mirror direction of `wo` about `n`.
#[inline]
pub fn reflect(wo: Vec3, n: Vec3) -> Vec3 {
    (2.0 * wo.dot(n) * n - wo).normalize()
}

/// The direction in which light refracts that arrives from `wo`; `None` when all of it is reflected.
///
/// `eta_t_over_i` is the index on the far side over the index on the side of `wo`.
#[inline]
pub fn refract(wo: Vec3, n: Vec3, eta_t_over_i: f32) -> Option<Vec3> {
    if eta_t_over_i == 1.0 {
        return Some(-wo);
    }
    let cosine = wo.dot(n);
    let cos_t = refracted_cosine(f64::from(cosine), f64::from(eta_t_over_i))? as f32;
    let n = if cosine < 0.0 { -n } else { n };
    let tangential = wo - cosine.abs() * n;
    Some((-tangential / eta_t_over_i - cos_t * n).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::fresnel::dielectric;
    use glam::DVec3;
    use proptest::prelude::*;

    /// A direction whose cosine with +z is `cos`, at azimuth `phi`.
    fn direction(cos: f64, phi: f64) -> Vec3 {
        let sin = ((1.0 - cos) * (1.0 + cos)).sqrt();
        DVec3::new(sin * phi.cos(), sin * phi.sin(), cos).as_vec3()
    }

    /// The same in f64 from the f32 arguments, by the angle form of Snell's law.
    fn refract_f64(wo: Vec3, n: Vec3, eta: f32) -> Option<DVec3> {
        let (wo, n) = (wo.as_dvec3().normalize(), n.as_dvec3().normalize());
        let n = if wo.dot(n) < 0.0 { -n } else { n };
        let sin_i = wo.cross(n).length();
        let sin_t = sin_i / f64::from(eta);
        let tangent = (wo - wo.dot(n) * n).normalize_or_zero();
        (sin_t <= 1.0).then(|| -tangent * sin_t - n * ((1.0 - sin_t) * (1.0 + sin_t)).sqrt())
    }

    #[test]
    fn matched_indices_and_normal_incidence_go_straight_on() {
        let wo = direction(0.3, 1.0);
        assert_eq!(refract(wo, Vec3::Z, 1.0), Some(-wo));
        assert_eq!(refract(Vec3::Z, Vec3::Z, 1.33), Some(Vec3::NEG_Z));
        assert_eq!(refract(Vec3::Z, Vec3::NEG_Z, 0.75), Some(Vec3::NEG_Z));
    }

    #[test]
    fn grazing_light_enters_at_the_critical_angle() {
        let got = refract(direction(1e-6, 0.0), Vec3::Z, 1.33).unwrap();
        assert!((f64::from(got.x) + 1.0 / f64::from(1.33_f32)).abs() < 1e-7, "{got}");
    }

    proptest! {
        #[test]
        fn snells_law_holds(
            cos in 1e-4_f64..1.0, phi in 0.0_f64..6.3, tilt in -1.0_f64..1.0, turn in 0.0_f64..6.3,
            eta in prop_oneof![0.5_f32..2.0, 0.999_999_f32..1.000_001],
        ) {
            let wo = direction(cos, phi);
            let n = direction(tilt, turn);
            // Close to the critical angle the input's own rounding decides; the square root makes 1e-7 into 3e-4.
            let sine = wo.as_dvec3().cross(n.as_dvec3()).length() / f64::from(eta);
            prop_assume!((sine - 1.0).abs() > 1e-2);
            match (refract(wo, n, eta), refract_f64(wo, n, eta)) {
                (None, None) => {}
                (Some(got), Some(want)) => {
                    let error = (got.as_dvec3() - want).abs().max_element();
                    prop_assert!(error < 1e-6, "{got} is not {want}: {error}");
                    prop_assert!((got.length() - 1.0).abs() < 2e-7);
                }
                (got, want) => prop_assert!(false, "{got:?} is not {want:?}"),
            }
        }

        #[test]
        fn refraction_and_fresnel_agree_on_total_reflection(cos in 0.0_f64..1.0, eta in 0.5_f32..1.0) {
            let wo = direction(cos, 0.7);
            let refracted = refract(wo, Vec3::Z, eta);
            let fresnel = dielectric(wo.dot(Vec3::Z), eta);
            prop_assert_eq!(refracted.is_none(), fresnel.cos_t == 0.0 && fresnel.reflectance == 1.0);
            if let Some(wi) = refracted {
                prop_assert!(wi.is_finite() && (wi.z + fresnel.cos_t).abs() < 3e-7, "{} {}", wi, fresnel.cos_t);
            }
        }

        #[test]
        fn reflection_is_its_own_inverse(cos in -1.0_f64..1.0, phi in 0.0_f64..6.3, tilt in -1.0_f64..1.0) {
            let (wo, n) = (direction(cos, phi), direction(tilt, 2.0));
            let wi = reflect(wo, n);
            prop_assert!((reflect(wi, n) - wo).length() < 1e-6);
            prop_assert!((wi.dot(n) - wo.dot(n)).abs() < 5e-7);
            prop_assert!((wi.length() - 1.0).abs() < 2e-7);
        }

        #[test]
        fn refraction_can_be_walked_back(cos in 0.05_f64..1.0, phi in 0.0_f64..6.3, eta in 1.0_f32..2.0) {
            let wo = direction(cos, phi);
            let wi = refract(wo, Vec3::Z, eta).unwrap();
            let back = refract(wi, Vec3::Z, 1.0 / eta).unwrap();
            // The cosine of the way back is that of a difference: its error grows as 1 / cos.
            prop_assert!((back - wo).length() < 1e-6 / cos as f32);
        }
    }
}
