//! The lobe of a Lambertian surface about an interpolated normal.
//!
//! ```text
//! p(wi) = (max(0, wi . ns) + max(0, wi' . ns)) / pi   where wi . ng > 0,      wi' = wi - 2 (wi . ng) ng
//! ```
//! The part of the cosine lobe about the shading normal `ns` that dips under the surface is mirrored at the surface, so
//! that nothing is lost and the density has a closed form. With `ns` = `ng` it is the plain cosine lobe. The lobe does
//! not depend on where the light goes; light that arrives along `wi` is reflected by the albedo times `p(wi)`.

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use crate::geometry::Frame;
use crate::sampling::warp;

/// Shading and geometric normal, both on the side of the light.
#[derive(Clone, Copy, Debug)]
pub(super) struct DiffuseLobe {
    pub(super) ns: Vec3,
    pub(super) ng: Vec3,
}

impl DiffuseLobe {
    /// Density per solid angle; also the cosine-weighted value for an albedo of 1.
    #[inline]
    pub(super) fn pdf_w(&self, wi: Vec3) -> f32 {
        self.weighted_pdf_w(wi, |_| 1.0)
    }

    /// The same where directions about the shading normal are drawn `relative` times as densely as the cosine says.
    #[inline]
    pub(super) fn weighted_pdf_w(&self, wi: Vec3, relative: impl Fn(Vec3) -> f32) -> f32 {
        if wi.dot(self.ng) <= 0.0 {
            return 0.0;
        }
        let part = |direction: Vec3| {
            let cos = direction.dot(self.ns);
            if cos > 0.0 { cos * relative(direction) } else { 0.0 }
        };
        (part(wi) + part(self.mirrored(wi))) * FRAC_1_PI
    }

    /// A direction drawn from the lobe.
    #[inline]
    pub(super) fn sample(&self, u: [f32; 2]) -> Vec3 {
        self.above(Frame::around(self.ns).to_world(warp::cosine_hemisphere(u)).normalize())
    }

    /// A direction about the shading normal, mirrored where it dips under the surface.
    #[inline]
    pub(super) fn above(&self, direction: Vec3) -> Vec3 {
        if direction.dot(self.ng) > 0.0 { direction } else { self.mirrored(direction) }
    }

    fn mirrored(&self, direction: Vec3) -> Vec3 {
        direction - 2.0 * direction.dot(self.ng) * self.ng
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 512 x 512 cells of equal solid angle; each holds its density to the second order of its size. Measured: 2e-5 off.
    #[test]
    fn the_lobe_is_normalised_and_weights_are_one() {
        for tilt in [0.0_f32, 0.3, 1.2, 1.5] {
            let lobe = DiffuseLobe { ns: Vec3::new(tilt.sin(), 0.0, tilt.cos()), ng: Vec3::Z };
            let (n, mut sum) = (512, 0.0_f64);
            for i in 0..n * n {
                let u = [(i % n) as f32 + 0.5, (i / n) as f32 + 0.5].map(|x| x / n as f32);
                sum += f64::from(lobe.pdf_w(warp::sphere(u)));
                let wi = lobe.sample(u);
                assert!(wi.z >= 0.0 && lobe.pdf_w(wi) >= 0.0, "{wi}");
            }
            let integral = sum / f64::from(n * n) * 4.0 * std::f64::consts::PI;
            assert!((integral - 1.0).abs() < 1e-4, "{tilt}: {integral}");
        }
    }

    /// The mean of a function over samples is its integral against the density.
    #[test]
    fn samples_follow_the_density() {
        let lobe = DiffuseLobe { ns: Vec3::new(0.932, 0.0, 0.362).normalize(), ng: Vec3::Z };
        let f = |d: Vec3| f64::from(d.x) + 2.0 * f64::from(d.z * d.z) + f64::from(d.x * d.y);
        let (n, mut sampled, mut integrated) = (512, 0.0, 0.0);
        for i in 0..n * n {
            let u = [(i % n) as f32 + 0.5, (i / n) as f32 + 0.5].map(|x| x / n as f32);
            sampled += f(lobe.sample(u));
            let d = warp::sphere(u);
            integrated += f(d) * f64::from(lobe.pdf_w(d)) * 4.0 * std::f64::consts::PI;
        }
        let n = f64::from(n * n);
        // Both are midpoint rules on the same number of points; measured difference 1e-4.
        assert!((sampled / n - integrated / n).abs() < 5e-4, "{} {}", sampled / n, integrated / n);
    }
}
