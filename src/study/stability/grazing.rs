//! Light along surfaces, and at the angle from which on all of it is reflected.

use glam::DVec3;

use super::index::fresnel;
use super::pieces::{WHITE_SKY, camera, dielectric, medium, render};
use super::shapes::cuboid;
use super::{Case, Group, Measurement, Reference, Scene};
use crate::optics::fresnel::{conductor, dielectric as reflectance_of};
use crate::spectrum::Lanes;
use crate::study::StudyError;

/// The group.
pub(super) const GROUP: Group = Group {
    name: "grazing",
    parameter: "angle in radians",
    about: "Angles with the surface, and with the critical angle, down to a millionth.",
    cases,
};

const ANGLES: [f64; 7] = [0.5, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

fn cases() -> Vec<Case> {
    let seen = ANGLES.map(|angle| {
        Case::new(&GROUP, "the sky in water, seen along it", angle, move || seen_along(angle)).quick()
    });
    let metal =
        ANGLES.map(|angle| Case::new(&GROUP, "a metal's 1 - R", angle, move || Ok(metal(angle))).quick());
    let sides = [("this side of", -1.0), ("beyond", 1.0)].into_iter();
    let critical = sides.clone().flat_map(|(side, sign)| {
        [0.0, 1e-7, 1e-5, 1e-3].map(|angle| {
            let name = format!("R {side} the critical angle of 1.33");
            Case::new(&GROUP, name, angle, move || Ok(critical(sign * angle))).quick()
        })
    });
    let beneath = sides.flat_map(|(side, sign)| {
        [1e-5, 1e-3, 1e-2].map(|angle| {
            let name = format!("white furnace under water, {side} the critical angle");
            Case::new(&GROUP, name, angle, move || beneath(sign * angle)).quick()
        })
    });
    seen.into_iter().chain(metal).chain(critical).chain(beneath).collect()
}

/// The eye is 1 m from where it looks at black water, and sin(angle) above it. So only the reflected sky is seen. The
/// cosine is right to 2^-23 of itself, since the surface lies at heights of about its size from the scene's origin, and
/// 1 - R falls as 1 in it.
fn seen_along(angle: f64) -> Result<Measurement, StudyError> {
    let (sin, cos) = libm::sincos(angle);
    let text = medium("ink", "ior = 1.33\nabsorption = 1e9")
        + &dielectric("sea.ply", "air", "ink")
        + &camera([0.0, 0.0, sin], [0.0, cos, 0.0], 1e-6, [4, 4])
        + &render(4, "")
        + WHITE_SKY;
    let sea = cuboid(DVec3::new(-8.0, -8.0, -1.0), DVec3::new(8.0, 8.0, 0.0));
    let picture = Scene::new().mesh("sea.ply", &sea).render(&text)?;
    let (expected, _) = fresnel(sin, f64::from(1.33_f32));
    // A pixel's rays differ by 1e-6 degrees of angle at most: 2e-8 of the cosine, absolutely.
    let tolerance = (1.0 - expected) * (2e-8 / sin + 1e-6) + 1e-7;
    Ok(Measurement::farthest_in(&picture, Reference::ClosedForm, expected).tolerance(tolerance))
}

/// Silver at 589 nm, m = 0.155 + 3.61 i, against the amplitudes in complex numbers `[BORN99 sec. 14.2]`,
///
/// ```text
/// r_s = (cos - q) / (cos + q),   r_p = (m^2 cos - q) / (m^2 cos + q),   q^2 = m^2 - sin^2
/// 1 - |(a - q) / (a + q)|^2 = 4 Re(a conj(q)) / |a + q|^2
/// ```
/// R is an f32, so that 1 - R is right to 6e-8.
fn metal(angle: f64) -> Measurement {
    let (eta, k) = (f64::from(0.155_f32), f64::from(3.61_f32));
    let cosine = libm::sin(angle) as f32;
    let got = 1.0 - f64::from(conductor(cosine, Lanes::splat(0.155), Lanes::splat(3.61)).x);
    let cos = f64::from(cosine);
    // m^2 and its root q of m^2 - sin^2, by their parts.
    let m = [eta * eta - k * k, 2.0 * eta * k];
    let squared = [m[0] - (1.0 - cos * cos), m[1]];
    let modulus = libm::hypot(squared[0], squared[1]);
    let q = [(0.5 * (modulus + squared[0])).max(0.0).sqrt(), (0.5 * (modulus - squared[0])).sqrt()];
    let absorbed = |a: [f64; 2]| {
        let sum = [a[0] + q[0], a[1] + q[1]];
        4.0 * (a[0] * q[0] + a[1] * q[1]) / (sum[0] * sum[0] + sum[1] * sum[1])
    };
    let expected = 0.5 * (absorbed([cos, 0.0]) + absorbed([m[0] * cos, m[1] * cos]));
    Measurement::new(Reference::ClosedForm, expected, got).tolerance(6e-8)
}

/// From water into air, this much beyond the critical angle. The cosine is an f32, of which the closed form in f64 is
/// taken: total reflection begins at the same number, and below it R is right to 2^-24.
fn critical(beyond: f64) -> Measurement {
    let eta = 1.0_f32 / 1.33;
    let angle = libm::asin(f64::from(eta)) + beyond;
    let cosine = libm::cos(angle) as f32;
    let sin_t = (1.0 - f64::from(cosine) * f64::from(cosine)).sqrt() / f64::from(eta);
    let expected = if sin_t >= 1.0 { 1.0 } else { fresnel(f64::from(cosine), f64::from(eta)).0 };
    let got = f64::from(reflectance_of(cosine, eta).reflectance);
    // Both sides take a difference of numbers of about 1 in f64: its root is off by 2^-52 over twice itself.
    let root = ((1.0 - sin_t) * (1.0 + sin_t)).abs().sqrt();
    let tolerance = 6e-8 + 8.0 * f64::EPSILON / root.max(1e-8);
    Measurement::new(Reference::ClosedForm, expected, got).tolerance(tolerance)
}

/// Under a surface that all looks the same above, and with the same below it: n^2 where light comes through, plus
/// whatever is reflected of n^2 below, which is the same.
fn beneath(beyond: f64) -> Result<Measurement, StudyError> {
    let n = f64::from(1.33_f32);
    let (sin, cos) = libm::sincos(libm::asin(1.0 / n) + beyond);
    let text = medium("water", "ior = 1.33")
        + &dielectric("pool.ply", "air", "water")
        + &camera([-sin, 0.0, -cos], [0.0; 3], 1e-4, [4, 4])
        + &render(64, "")
        + WHITE_SKY;
    let pool = cuboid(DVec3::new(-9.0, -9.0, -9.0), DVec3::new(9.0, 9.0, 0.0));
    let picture = Scene::new().mesh("pool.ply", &pool).render(&text)?;
    // Of the closed box some directions are trapped for ever; those of this view leave through its sides.
    Ok(Measurement::farthest_in(&picture, Reference::ClosedForm, n * n).tolerance(2e-6 * n * n))
}
