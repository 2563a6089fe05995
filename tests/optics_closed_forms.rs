//! Fresnel, Snell and the tables of water and ice against formulas that are written down independently here.
//!
//! The reference is f64 with complex numbers and the textbook form with two angles
//! (r_s = (n_i cos_i - n_t cos_t) / (n_i cos_i + n_t cos_t)), which shares no algebra with the code under test.

use std::ops::{Add, Div, Mul, Sub};

use floe::optics::fresnel::{conductor, conductor_polarised, dielectric, dielectric_amplitudes};
use floe::optics::refraction::refract;
use floe::optics::{RefractiveIndex, ice, water};
use floe::spectrum::Lanes;
use glam::{DVec3, DVec4, Vec3};

#[derive(Clone, Copy, Debug)]
struct Complex(f64, f64);

impl Add for Complex {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0, self.1 + other.1)
    }
}

impl Sub for Complex {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0, self.1 - other.1)
    }
}

impl Mul for Complex {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0 - self.1 * other.1, self.0 * other.1 + self.1 * other.0)
    }
}

impl Div for Complex {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let norm = other.norm_squared();
        self * Self(other.0 / norm, -other.1 / norm)
    }
}

impl Complex {
    fn real(value: f64) -> Self {
        Self(value, 0.0)
    }

    fn norm_squared(self) -> f64 {
        self.0 * self.0 + self.1 * self.1
    }

    /// The root in the first quadrant for arguments of the upper half plane, by half the angle.
    fn sqrt(self) -> Self {
        let (radius, angle) = (self.norm_squared().sqrt().sqrt(), 0.5 * self.1.atan2(self.0));
        Self(radius * angle.cos(), radius * angle.sin())
    }
}

struct Reference {
    reflectance_s: f64,
    reflectance_p: f64,
    transmittance: f64,
}

/// Light from index 1 on index `n`, with the complex cosine of the refracted wave.
fn reference(cos_i: f64, n: Complex) -> Reference {
    let cos_i_complex = Complex::real(cos_i);
    let sin_t = Complex::real(((1.0 - cos_i) * (1.0 + cos_i)).sqrt()) / n;
    let cos_t = (Complex::real(1.0) - sin_t * sin_t).sqrt();
    let two_cos_i = Complex::real(2.0 * cos_i);
    let (sum_s, sum_p) = (cos_i_complex + n * cos_t, n * cos_i_complex + cos_t);
    let r_s = (cos_i_complex - n * cos_t) / sum_s;
    let r_p = (n * cos_i_complex - cos_t) / sum_p;
    let (t_s, t_p) = (two_cos_i / sum_s, two_cos_i / sum_p);
    let flux = (n * cos_t).0 / cos_i;
    Reference {
        reflectance_s: r_s.norm_squared(),
        reflectance_p: r_p.norm_squared(),
        transmittance: 0.5 * flux * (t_s.norm_squared() + t_p.norm_squared()),
    }
}

impl Reference {
    fn unpolarised(&self) -> f64 {
        0.5 * (self.reflectance_s + self.reflectance_p)
    }
}

/// Cosines from 1e-6 to 1, dense at the grazing end.
fn cosines() -> impl Iterator<Item = f32> {
    (0..=400).map(|i| 10.0_f64.powf(-6.0 + 6.0 * f64::from(i) / 400.0) as f32)
}

const INDICES: [f32; 12] =
    [1.33, 1.5, 2.4, 1.31, 0.985, 1.0154, 0.75, 0.666_666_7, 0.4166, 1.000_01, 0.9999, 1.000_000_5];

#[test]
fn normal_incidence_is_the_square_of_n_minus_1_over_n_plus_1() {
    for n in INDICES {
        let exact = ((f64::from(n) - 1.0) / (f64::from(n) + 1.0)).powi(2);
        let got = f64::from(dielectric(1.0, n).reflectance);
        assert!((got / exact - 1.0).abs() < 6e-8, "{n}: {got} is not {exact}");
    }
}

#[test]
fn nothing_polarised_in_the_plane_is_reflected_at_brewsters_angle() {
    for n in [1.33_f64, 1.5, 2.4, 0.75] {
        // tan theta = n
        let cos_i = 1.0 / (1.0 + n * n).sqrt();
        let amplitudes = dielectric_amplitudes(cos_i, n).unwrap();
        assert!(amplitudes.r_p.abs() < 1e-15, "{n}: {}", amplitudes.r_p);
        // What is left is s: ((n^2 - 1) / (n^2 + 1))^2 / 2.
        let expected = 0.5 * ((n * n - 1.0) / (n * n + 1.0)).powi(2);
        assert!((f64::from(dielectric(cos_i as f32, n as f32).reflectance) - expected).abs() < 1e-7);
    }
}

#[test]
fn total_reflection_begins_at_the_critical_angle() {
    for n in [0.75_f32, 0.666_666_7, 0.985, 0.999_999] {
        let critical = (1.0 - f64::from(n).powi(2)).sqrt();
        let inside = (critical * (1.0 + 1e-7)).max(critical + 1e-7) as f32;
        let beyond = (critical * (1.0 - 1e-7)).min(critical - 1e-7) as f32;
        assert_eq!(dielectric(beyond, n).reflectance, 1.0, "{n}");
        assert_eq!(dielectric(beyond, n).cos_t, 0.0);
        let fresnel = dielectric(inside, n);
        assert!(fresnel.reflectance < 1.0 && fresnel.cos_t > 0.0, "{n}: {fresnel:?}");
    }
}

/// Half a unit in the last place of f32 is 6e-8. Next to Brewster's angle nothing cancels, since s remains.
#[test]
fn dielectrics_agree_with_complex_double_precision() {
    let mut worst = (0.0_f64, 0.0_f64);
    for n in INDICES {
        for cos_i in cosines() {
            let fresnel = dielectric(cos_i, n);
            let exact = reference(f64::from(cos_i), Complex::real(f64::from(n)));
            let error = (f64::from(fresnel.reflectance) - exact.unpolarised()).abs();
            // For indices within 1e-4 of 1 the reference itself cancels: 1e-16 / (n - 1) of an amplitude.
            let conditioning = 1e-15 / (f64::from(n) - 1.0).abs();
            let relative = (error / exact.unpolarised() - conditioning).max(0.0);
            worst.0 = worst.0.max(relative);
            let sin_t = (1.0 - f64::from(cos_i).powi(2)).sqrt() / f64::from(n);
            if sin_t < 1.0 {
                let cos_t = ((1.0 - sin_t) * (1.0 + sin_t)).sqrt();
                worst.1 = worst.1.max((f64::from(fresnel.cos_t) - cos_t).abs());
            }
        }
    }
    println!("dielectric: reflectance {:e} relative, cos_t {:e} absolute", worst.0, worst.1);
    assert!(worst.0 < 7e-8 && worst.1 < 6e-8, "{worst:?}");
}

#[test]
fn indices_that_hardly_differ_keep_their_tiny_reflectance() {
    for steps in [-8_i32, -1, 1, 8] {
        let n = 1.0 + steps as f32 * f32::EPSILON;
        for cos_i in [1.0_f32, 0.7, 0.1] {
            let difference = f64::from(n) - 1.0;
            // To first order r_s = -d / (2 cos^2), r_p = r_s times minus cos(2 theta).
            let r_s = difference / (2.0 * f64::from(cos_i).powi(2));
            let r_p = r_s * (2.0 * f64::from(cos_i).powi(2) - 1.0);
            let expected = 0.5 * (r_s * r_s + r_p * r_p);
            let got = f64::from(dielectric(cos_i, n).reflectance);
            // The next order is d / cos^2, at most 1e-4; the rounding of q in f64 is 1e-16 / d = 1e-9.
            assert!((got / expected - 1.0).abs() < 5e-4, "{n} {cos_i}: {got} is not {expected}");
        }
    }
}

#[test]
fn reflected_and_transmitted_flux_sum_to_one() {
    for n in INDICES {
        for cos_i in cosines() {
            let transmittance = reference(f64::from(cos_i), Complex::real(f64::from(n))).transmittance;
            let sum = f64::from(dielectric(cos_i, n).reflectance) + transmittance;
            assert!((sum - 1.0).abs() < 7e-8, "n {n}, cosine {cos_i}: {sum}");
        }
    }
}

/// Stokes' relation: from the other side, at the refracted angle, the amplitudes only change their sign. There q is the
/// root of a difference, (cos_i / n)^2: roundings of 2e-16 move it by 2e-16 n / cos_i, and the amplitudes by up to
/// 2 n^2 / cos_t times that.
#[test]
fn both_sides_reflect_the_same_share() {
    for n in [1.33_f64, 1.5, 2.4, 1.0001] {
        for cos_i in cosines().map(f64::from) {
            let there = dielectric_amplitudes(cos_i, n).unwrap();
            let back = dielectric_amplitudes(there.cos_t, 1.0 / n);
            // Rounding may put grazing light just beyond the critical angle.
            let (r_s, r_p) = back.map_or((1.0, 1.0), |a| (a.r_s, a.r_p));
            let tolerance = 1e-14 + 4e-16 * n.powi(3) / (cos_i * there.cos_t);
            assert!((there.r_s + r_s).abs() < tolerance, "s, {n} {cos_i}: {} {r_s}", there.r_s);
            assert!((there.r_p + r_p).abs() < tolerance, "p, {n} {cos_i}: {} {r_p}", there.r_p);
        }
    }
}

/// n + i k of metals: gold, silver and copper after Babar and Weaver (Applied Optics 54, 2015), aluminium after the
/// table of Hecht's Optics. The reflectances are ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2), worked out by hand.
#[test]
fn metals_have_their_normal_reflectance() {
    let n = Lanes::new(0.1091, 0.05009, 0.0878, 0.965);
    let k = Lanes::new(3.529, 3.694, 3.759, 6.399);
    let got = conductor(1.0, n, k);
    let expected = Lanes::new(0.96811, 0.98642, 0.97707, 0.91385);
    assert!((got - expected).abs().max_element() < 2e-5, "{got}");
}

#[test]
fn conductors_agree_with_complex_double_precision() {
    let metals = [
        (0.1091, 3.529),
        (0.05009, 3.694),
        (0.965, 6.399),
        (1.5, 0.0),
        (1.33, 1e-9),
        (0.75, 1e-4),
        (3.0, 3.0),
    ];
    let mut worst = 0.0_f64;
    for (n, k) in metals {
        let (n, k) = (n as f32, k as f32);
        for cos_i in cosines() {
            let exact = reference(f64::from(cos_i), Complex(f64::from(n), f64::from(k)));
            let got = conductor(cos_i, Lanes::splat(n), Lanes::splat(k)).x;
            worst = worst.max((f64::from(got) - exact.unpolarised()).abs());
            let polarised =
                conductor_polarised(f64::from(cos_i), DVec4::splat(f64::from(n)), DVec4::splat(f64::from(k)));
            assert!((polarised.0.x - exact.reflectance_s).abs() < 1e-12, "s: {n} {k} {cos_i}");
            assert!((polarised.1.x - exact.reflectance_p).abs() < 1e-12, "p: {n} {k} {cos_i}");
        }
    }
    println!("conductor: reflectance {worst:e} absolute");
    assert!(worst < 3.1e-8, "{worst:e}");
}

#[test]
fn lanes_of_a_conductor_do_not_mix() {
    let (n, k) = (Lanes::new(0.2, 1.0, 2.0, 0.9), Lanes::new(3.0, 0.5, 0.0, 6.0));
    let together = conductor(0.4, n, k);
    for lane in 0..4 {
        assert_eq!(together[lane], conductor(0.4, Lanes::splat(n[lane]), Lanes::splat(k[lane])).x);
    }
}

/// The refracted direction in f64 from the same f32 input.
fn refracted(wo: Vec3, n: Vec3, eta: f32) -> Option<DVec3> {
    let (wo, n) = (wo.as_dvec3().normalize(), n.as_dvec3().normalize());
    let sin_t = wo.cross(n).length() / f64::from(eta);
    let tangent = (wo - wo.dot(n) * n).normalize_or_zero();
    (sin_t < 1.0).then(|| -tangent * sin_t - n * ((1.0 - sin_t) * (1.0 + sin_t)).sqrt())
}

/// The error of cos_t is that of the cosine of incidence (1e-7 in f32) times cos_i / (eta^2 cos_t), so it is divided by
/// 1 + that slope here; the bound of 3e-7 holds for every component.
#[test]
fn snells_law_holds_at_every_angle() {
    let n = DVec3::new(0.3, -0.5, 0.81).normalize();
    let tangent = n.any_orthonormal_vector();
    let mut worst = 0.0_f64;
    for eta in INDICES {
        for cos_i in cosines() {
            let cos_i = f64::from(cos_i);
            let wo = (n * cos_i + tangent * ((1.0 - cos_i) * (1.0 + cos_i)).sqrt()).as_vec3();
            let (Some(got), Some(want)) = (refract(wo, n.as_vec3(), eta), refracted(wo, n.as_vec3(), eta))
            else {
                continue;
            };
            let cos_t = -want.dot(n);
            let slope = cos_i / (f64::from(eta).powi(2) * cos_t.max(1e-9));
            worst = worst.max((got.as_dvec3() - want).abs().max_element() / (1.0 + slope));
        }
    }
    println!("refract: {worst:e}");
    assert!(worst < 3e-7, "{worst:e}");
}

/// Snell's window: from below, the sky fills a cone of half angle asin(1 / 1.3398) about the zenith.
#[test]
fn the_window_of_a_diver_has_its_half_angle() {
    let sea = RefractiveIndex::Water { temperature: 15.0, salinity: 35.0 };
    let n = sea.for_rays();
    assert!((f64::from(n) - 1.3398).abs() < 5e-4, "{n}");
    let half_angle = f64::from(1.0 / n).asin().to_degrees();
    assert!((half_angle - 48.3).abs() < 0.1, "{half_angle}");
    let looking = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        refract(DVec3::new(sin, 0.0, -cos).as_vec3(), Vec3::Z, 1.0 / n)
    };
    assert!(looking(half_angle - 0.01).is_some() && looking(half_angle + 0.01).is_none());
}

#[test]
fn pure_water_and_ice_are_clearest_in_the_violet() {
    let least = |absorption: fn(f64) -> f64| {
        (380..=780).min_by(|a, b| absorption(f64::from(*a)).total_cmp(&absorption(f64::from(*b)))).unwrap()
    };
    assert_eq!(least(water::absorption), 415);
    assert!((380..=400).contains(&least(ice::absorption)));
    // The same vibrations of the molecule absorb the red in both: within a factor of two at 700 nm.
    let ratio = ice::absorption(700.0) / water::absorption(700.0);
    assert!((0.5..2.0).contains(&ratio), "{ratio}");
}
