//! Luminance of linear Rec. 709 RGB, the one number that errors and tone curves look at.
//!
//! ```text
//! Y = 0.2126 R + 0.7152 G + 0.0722 B
//! ```
//!
//! `[BT709]`. The weights sum to 1, so grey keeps its value. Saturated water has negative components; its
//! luminance is still right, since the weights are linear.

use glam::{DVec3, Vec3};

/// The weights of R, G and B.
pub const LUMINANCE_WEIGHTS: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// Maximum luminous efficacy in lm/W: a luminance in W times this is in lm.
pub const LUMENS_PER_WATT: f64 = 683.0;

/// Luminance in double precision, for statistics.
pub fn luminance_f64(rgb: DVec3) -> f64 {
    rgb.dot(DVec3::from_array(LUMINANCE_WEIGHTS))
}

/// Luminance in single precision, for pictures.
pub fn luminance(rgb: Vec3) -> f32 {
    rgb.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grey_keeps_its_value_and_both_precisions_agree() {
        assert!((luminance_f64(DVec3::splat(0.3)) - 0.3).abs() < 1e-15);
        let water = Vec3::new(-0.1, 0.4, 0.7);
        // Three products and two sums in f32: a few units in the last place of 0.3.
        assert!((f64::from(luminance(water)) - luminance_f64(water.as_dvec3())).abs() < 1e-7);
    }
}
