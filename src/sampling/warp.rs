//! Warps of the unit square onto directions and triangles, each with its density.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, FRAC_PI_4, PI};

use glam::{Vec2, Vec3};

use crate::geometry::elementary::sin_cos;

/// The unit disc by the concentric map `[SHIRLEY97]`; density 1 / pi.
#[inline]
pub fn disc(u: [f32; 2]) -> Vec2 {
    let (a, b) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
    if a == 0.0 && b == 0.0 {
        return Vec2::ZERO;
    }
    let (radius, phi) =
        if a.abs() > b.abs() { (a, FRAC_PI_4 * (b / a)) } else { (b, FRAC_PI_2 - FRAC_PI_4 * (a / b)) };
    let (sin, cos) = sin_cos(phi);
    Vec2::new(radius * cos, radius * sin)
}

/// A direction around +z with density cos / pi.
#[inline]
pub fn cosine_hemisphere(u: [f32; 2]) -> Vec3 {
    let p = disc(u);
    Vec3::new(p.x, p.y, (1.0 - p.length_squared()).max(0.0).sqrt())
}

/// Density of [`cosine_hemisphere`] per solid angle.
#[inline]
pub fn cosine_hemisphere_pdf_w(cos: f32) -> f32 {
    cos.max(0.0) * FRAC_1_PI
}

/// Any direction, density 1 / (4 pi).
#[inline]
pub fn sphere(u: [f32; 2]) -> Vec3 {
    around_z(2.0 * u[0], u[1])
}

/// A direction within a cone around +z of which 1 - cos is `one_minus_cos_max`; density [`cone_pdf_w`].
///
/// Written in 1 - cos, which stays exact for the sun's half degree where the cosine itself has run out of digits.
#[inline]
pub fn cone(u: [f32; 2], one_minus_cos_max: f32) -> Vec3 {
    around_z(u[0] * one_minus_cos_max, u[1])
}

/// Density of [`cone`] per solid angle.
#[inline]
pub fn cone_pdf_w(one_minus_cos_max: f32) -> f32 {
    1.0 / (2.0 * PI * one_minus_cos_max)
}

/// The direction at 1 - cos from +z and at the fraction `u` of a turn around it.
#[inline]
pub fn around_z(one_minus_cos: f32, u: f32) -> Vec3 {
    let sin_theta = (one_minus_cos * (2.0 - one_minus_cos)).max(0.0).sqrt();
    let (sin, cos) = sin_cos(2.0 * PI * u);
    Vec3::new(sin_theta * cos, sin_theta * sin, 1.0 - one_minus_cos)
}

/// Barycentric weights of a point spread evenly over a triangle, without the square root's fold `[HEITZ19]`.
#[inline]
pub fn triangle(u: [f32; 2]) -> Vec3 {
    let (b0, b1) = if u[1] > u[0] {
        let b0 = 0.5 * u[0];
        (b0, u[1] - b0)
    } else {
        let b1 = 0.5 * u[1];
        (u[0] - b1, b1)
    };
    Vec3::new(b0, b1, 1.0 - b0 - b1)
}
