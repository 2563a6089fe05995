//! Reflection of unpolarised light at smooth boundaries.
//!
//! ```text
//! r_s = (cos_i - q) / (cos_i + q),   r_p = (eta^2 cos_i - q) / (eta^2 cos_i + q),   q = eta cos_t
//! q^2 = eta^2 - sin_i^2 = (eta - 1) (eta + 1) + cos_i^2 < 0: total internal reflection      [BORN99 sec. 1.5.2]
//! R = (r_s^2 + r_p^2) / 2
//! ```
//! eta is `eta_t_over_i`. The arguments are f32, the arithmetic is f64: near grazing incidence, near the critical
//! angle and for indices that hardly differ the differences above lose all digits in f32. cos_i - q is written as
//! (1 - eta^2) / (cos_i + q). Measured against the textbook form in f64 and complex numbers for cosines from 1e-6 to 1
//! and eta down to 1 + 5e-7: reflectances of dielectrics are right to 6e-8 relative, cos_t and conductors to 3e-8
//! absolute, half a unit in the last place of f32.

use glam::DVec4;

use crate::spectrum::Lanes;

/// What a dielectric boundary does with light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fresnel {
    /// Reflected share of unpolarised flux, in [0, 1]; the rest is transmitted.
    pub reflectance: f32,
    /// Cosine of the refracted direction with the normal's far side, not negative; 0 when all is reflected.
    pub cos_t: f32,
}

/// Amplitude ratios at a dielectric boundary below the critical angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amplitudes {
    /// Reflected over incident field, polarised perpendicular to the plane of incidence.
    pub r_s: f64,
    /// Reflected over incident field, polarised in the plane of incidence; positive at normal incidence for eta > 1.
    pub r_p: f64,
    /// Cosine of the refracted direction.
    pub cos_t: f64,
}

/// Reflectance of a dielectric at the incident cosine `cos_i`; its sign does not matter.
pub fn dielectric(cos_i: f32, eta_t_over_i: f32) -> Fresnel {
    match dielectric_amplitudes(f64::from(cos_i), f64::from(eta_t_over_i)) {
        None => Fresnel { reflectance: 1.0, cos_t: 0.0 },
        Some(Amplitudes { r_s, r_p, cos_t }) => {
            Fresnel { reflectance: (0.5 * (r_s * r_s + r_p * r_p)) as f32, cos_t: cos_t as f32 }
        }
    }
}

/// The polarised amplitudes at a dielectric; `None` beyond the critical angle.
pub fn dielectric_amplitudes(cos_i: f64, eta_t_over_i: f64) -> Option<Amplitudes> {
    let cos_i = cos_i.abs().min(1.0);
    let eta = eta_t_over_i;
    let difference = (eta - 1.0) * (eta + 1.0);
    let q_squared = difference + cos_i * cos_i;
    if q_squared < 0.0 {
        return None;
    }
    if difference == 0.0 {
        return Some(Amplitudes { r_s: 0.0, r_p: 0.0, cos_t: cos_i });
    }
    let q = q_squared.sqrt();
    let sum = cos_i + q;
    Some(Amplitudes {
        r_s: -difference / (sum * sum),
        r_p: (eta * eta * cos_i - q) / (eta * eta * cos_i + q),
        cos_t: (q / eta).min(1.0),
    })
}

/// Cosine of the refracted direction; `None` beyond the critical angle.
pub(super) fn refracted_cosine(cos_i: f64, eta_t_over_i: f64) -> Option<f64> {
    let cos_i = cos_i.abs().min(1.0);
    let q_squared = (eta_t_over_i - 1.0) * (eta_t_over_i + 1.0) + cos_i * cos_i;
    (q_squared >= 0.0).then(|| (q_squared.sqrt() / eta_t_over_i).min(1.0))
}

/// Reflectance on each lane of a conductor whose index relative to the medium in front is `eta + i k`.
pub fn conductor(cos_i: f32, eta: Lanes, k: Lanes) -> Lanes {
    let (reflectance_s, reflectance_p) = conductor_polarised(f64::from(cos_i), eta.as_dvec4(), k.as_dvec4());
    (0.5 * (reflectance_s + reflectance_p)).as_vec4()
}

/// Reflectances (s, p) of a conductor, lane by lane.
///
/// With (a + i b)^2 = (eta + i k)^2 - sin_i^2 `[BORN99 sec. 14.2]`:
/// R_s = ((a - cos)^2 + b^2) / ((a + cos)^2 + b^2) and
/// R_p = R_s ((a - sin tan)^2 + b^2) / ((a + sin tan)^2 + b^2), multiplied through by cos^2.
pub fn conductor_polarised(cos_i: f64, eta: DVec4, k: DVec4) -> (DVec4, DVec4) {
    let cos = DVec4::splat(cos_i.abs().min(1.0));
    let cos_squared = cos * cos;
    let sin_squared = DVec4::ONE - cos_squared;
    let real = eta * eta - k * k - sin_squared;
    let imaginary = 2.0 * eta * k;
    let modulus = square_root(real * real + imaginary * imaginary);
    let greater = square_root(0.5 * (modulus + real.abs()));
    // The smaller of a and b from their product, which does not cancel.
    let smaller = ratio(imaginary, 2.0 * greater, DVec4::ZERO);
    let a = DVec4::select(real.cmpge(DVec4::ZERO), greater, smaller);

    let cross = 2.0 * a * cos;
    let sum_s = modulus + cos_squared;
    let reflectance_s = ratio(sum_s - cross, sum_s + cross, DVec4::ZERO);
    let sum_p = cos_squared * modulus + sin_squared * sin_squared;
    let cross_p = cross * sin_squared;
    let reflectance_p = reflectance_s * ratio(sum_p - cross_p, sum_p + cross_p, DVec4::ONE);
    (reflectance_s, reflectance_p)
}

fn square_root(v: DVec4) -> DVec4 {
    DVec4::from_array(v.to_array().map(f64::sqrt))
}

/// a / b, or `otherwise` where b is zero.
fn ratio(a: DVec4, b: DVec4, otherwise: DVec4) -> DVec4 {
    let zero = b.cmpeq(DVec4::ZERO);
    DVec4::select(zero, otherwise, a / DVec4::select(zero, DVec4::ONE, b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn matched_indices_reflect_nothing_at_any_angle() {
        for cos_i in [0.0, 1e-6, 0.5, 1.0] {
            assert_eq!(dielectric(cos_i, 1.0), Fresnel { reflectance: 0.0, cos_t: cos_i });
        }
    }

    #[test]
    fn grazing_light_is_all_reflected() {
        for eta in [1.33, 1.0 + 1e-6, 1.0 / 1.33] {
            assert_eq!(dielectric(0.0, eta).reflectance, 1.0);
        }
    }

    #[test]
    fn cosines_that_rounding_took_out_of_range_are_brought_back() {
        assert_eq!(dielectric(1.000_000_1, 1.5), dielectric(1.0, 1.5));
        assert_eq!(dielectric(-0.3, 1.5), dielectric(0.3, 1.5));
    }

    #[test]
    fn lanes_without_an_index_stay_finite() {
        for cos_i in [0.0, 0.3, 1.0] {
            let reflectance =
                conductor(cos_i, Lanes::new(0.2, 1.0, 1.5, 0.0), Lanes::new(3.0, 0.0, 0.0, 0.0));
            assert!(reflectance.is_finite() && reflectance.max_element() <= 1.0, "{reflectance}");
        }
        assert_eq!(conductor(0.0, Lanes::ONE, Lanes::ZERO), Lanes::ZERO);
    }

    proptest! {
        #[test]
        fn shares_are_in_range(cos_i in 0.0_f32..=1.0, eta in 0.2_f32..5.0, k in 0.0_f32..10.0) {
            let fresnel = dielectric(cos_i, eta);
            prop_assert!((0.0..=1.0).contains(&fresnel.reflectance) && (0.0..=1.0).contains(&fresnel.cos_t));
            let reflectance = conductor(cos_i, Lanes::splat(eta), Lanes::splat(k));
            prop_assert!((0.0..=1.0).contains(&reflectance.x), "{}", reflectance.x);
        }

        #[test]
        fn a_conductor_that_absorbs_nothing_is_a_dielectric(cos_i in 0.0_f32..=1.0, eta in 0.2_f32..5.0) {
            let conductor = conductor(cos_i, Lanes::splat(eta), Lanes::ZERO).x;
            let dielectric = dielectric(cos_i, eta).reflectance;
            prop_assert!((conductor - dielectric).abs() < 2e-7, "{conductor} {dielectric}");
        }
    }
}
