//! Particles of ocean water: Fournier and Forand's function of index and size distribution `[FOURNIER99]`.
//!
//! ```text
//! p = (nu (1 - d) - (1 - d^nu) + (d (1 - d^nu) - nu (1 - d)) / s) / (4 pi (1 - d)^2 d^nu)
//!     + (1 - b^nu) (3 cos^2 - 1) / (16 pi (b - 1) b^nu)
//! s = sin^2(theta / 2),   d = 4 s / (3 (n - 1)^2),   b = d at 180 degrees,   nu = (3 - mu) / 2
//!
//! P(theta) = ((1 - d^(nu + 1)) - s (1 - d^nu)) / ((1 - d) d^nu) + (1 - b^nu) cos sin^2 / (8 (b - 1) b^nu)
//! B = 1 - P(90 degrees)       share of light that is scattered back                          [MOBLEY02]
//! ```
//! n in [1.01, 1.4] is the index of the particles relative to water, mu in [3.05, 4.95] the slope of their size
//! distribution (number above a size ~ size^(1 - mu)). The function is singular at 0, as the distribution has no
//! largest particle; the light within 1.4e-6 rad is spread there with its right share. Samples come from a table through
//! the values; their weights are within 0.5 % of 1.

use std::f64::consts::PI;
use std::sync::Arc;

use super::Lobe;
use super::angle_table::{AngleTable, POLE, moments};
use super::deflection::Deflection;

/// Fournier and Forand's phase function.
#[derive(Clone, Debug, PartialEq)]
pub struct FournierForand {
    shape: Shape,
    /// Density straight on.
    peak: f64,
    mean_cosine: f32,
    table: Arc<AngleTable>,
}

/// The parameters as the formula needs them.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shape {
    nu: f64,
    /// d at 180 degrees.
    b: f64,
    /// Factor of the second term.
    back: f64,
}

/// Below this |1 - d| the first term is taken from its series: both brackets vanish like (1 - d)^2.
const NEAR: f64 = 1e-3;

impl FournierForand {
    /// Relative indices of the particles.
    pub const INDICES: [f64; 2] = [1.01, 1.4];
    /// Slopes of the size distribution.
    pub const SLOPES: [f64; 2] = [3.05, 4.95];
    /// Shares scattered back for which [`FournierForand::of_backscatter`] knows an index and a slope.
    pub const BACKSCATTERS: [f64; 2] = [1e-4, 0.2];

    /// Of an index and a slope; `None` outside of their ranges.
    pub fn new(index: f64, slope: f64) -> Option<Self> {
        if !(within(index, Self::INDICES) && within(slope, Self::SLOPES)) {
            return None;
        }
        let shape = Shape::new(index, slope);
        let at_pole = Deflection::from_one_minus_cos(POLE);
        // Linear up to the pole's node, with the share that the exact function has there.
        let peak = shape.share_within(at_pole) / (PI * f64::from(POLE)) - shape.value(at_pole);
        let value = |d| shape.with_peak(peak, d);
        let table = AngleTable::of(value)?;
        let (_, mean) = moments(value);
        Some(Self { shape, peak, mean_cosine: mean as f32, table: Arc::new(table) })
    }

    /// Of the share scattered back, on the line n = 1.01 + 0.1542 (mu - 3) `[MOBLEY02]`; `None` outside of its range.
    pub fn of_backscatter(share: f64) -> Option<Self> {
        let index = |slope: f64| 1.01 + 0.1542 * (slope - 3.0);
        let [mut low, mut high] = Self::SLOPES;
        if !within(share, Self::BACKSCATTERS) {
            return None;
        }
        // The share rises with the slope; 60 halvings leave no digit.
        for _ in 0..60 {
            let slope = 0.5 * (low + high);
            if Shape::new(index(slope), slope).backscatter() < share { low = slope } else { high = slope }
        }
        Self::new(index(low), low)
    }

    /// Share of light that is scattered by more than 90 degrees.
    pub fn backscatter(&self) -> f64 {
        self.shape.backscatter()
    }
}

impl Lobe for FournierForand {
    fn value(&self, deflection: Deflection) -> f32 {
        self.shape.with_peak(self.peak, deflection) as f32
    }

    fn table(&self) -> Option<&AngleTable> {
        Some(&self.table)
    }

    fn sample(&self, u: f32) -> Deflection {
        self.table.sample(u)
    }

    fn mean_cosine(&self) -> f32 {
        self.mean_cosine
    }
}

impl Shape {
    fn new(index: f64, slope: f64) -> Self {
        let nu = 0.5 * (3.0 - slope);
        let b = 4.0 / (3.0 * (index - 1.0) * (index - 1.0));
        let power = libm::pow(b, nu);
        Self { nu, b, back: (1.0 - power) / ((b - 1.0) * power) }
    }

    fn with_peak(self, peak: f64, deflection: Deflection) -> f64 {
        let t = deflection.one_minus_cos();
        if t < POLE {
            let edge = self.value(Deflection::from_one_minus_cos(POLE));
            return peak + (edge - peak) * f64::from(t / POLE);
        }
        self.value(deflection)
    }

    fn value(self, deflection: Deflection) -> f64 {
        let s = 0.5 * f64::from(deflection.one_minus_cos());
        let d = self.b * s;
        let power = libm::pow(d, self.nu);
        let [first, second] = self.brackets(d, power);
        let cos = 1.0 - 2.0 * s;
        (first + second / s) / (4.0 * PI * power) + self.back * (3.0 * cos * cos - 1.0) / (16.0 * PI)
    }

    /// nu (1 - d) - (1 - d^nu) and d (1 - d^nu) - nu (1 - d), both over (1 - d)^2.
    fn brackets(self, d: f64, power: f64) -> [f64; 2] {
        let (nu, x) = (self.nu, 1.0 - d);
        if x.abs() > NEAR {
            let squared = x * x;
            return [(nu * x - (1.0 - power)) / squared, (d * (1.0 - power) - nu * x) / squared];
        }
        // 1 - d^nu = nu x - a x^2 + b x^3 - c x^4 + ..
        let a = nu * (nu - 1.0) / 2.0;
        let b = a * (nu - 2.0) / 3.0;
        let c = b * (nu - 3.0) / 4.0;
        [a - x * (b - x * c), -(nu + a) + x * ((a + b) - x * (b + c))]
    }

    /// P(theta).
    fn share_within(self, deflection: Deflection) -> f64 {
        let s = 0.5 * f64::from(deflection.one_minus_cos());
        let d = self.b * s;
        let power = libm::pow(d, self.nu);
        let cos = 1.0 - 2.0 * s;
        let sin_squared = 4.0 * s * (1.0 - s);
        ((1.0 - d * power) - s * (1.0 - power)) / ((1.0 - d) * power) + self.back * cos * sin_squared / 8.0
    }

    fn backscatter(self) -> f64 {
        1.0 - self.share_within(Deflection::from_one_minus_cos(1.0))
    }
}

fn within(x: f64, [least, greatest]: [f64; 2]) -> bool {
    (least..=greatest).contains(&x)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pairs that C. D. Mobley tabulates in the Ocean Optics Web Book; the indices are rounded there.
    #[test]
    fn the_backscatter_is_the_published_one() {
        for (index, slope, share, tolerance) in [
            (1.021, 3.0742, 1e-4, 0.1),
            (1.040, 3.2010, 1e-3, 0.1),
            (1.08, 3.483, 0.01, 0.1),
            (1.10, 3.5835, 0.0183, 0.02),
            (1.175, 4.065, 0.1, 0.02),
            (1.15, 4.874, 0.4, 0.02),
        ] {
            let found = FournierForand::new(index, slope).unwrap().backscatter();
            assert!((found / share - 1.0).abs() < tolerance, "{index} {slope}: {found} for {share}");
        }
    }

    #[test]
    fn a_backscatter_is_met() {
        for share in [1e-4, 0.0183, 0.2] {
            let found = FournierForand::of_backscatter(share).unwrap().backscatter();
            assert!((found / share - 1.0).abs() < 1e-9, "{found} for {share}");
        }
        assert_eq!(FournierForand::of_backscatter(0.5), None);
        assert_eq!(FournierForand::new(1.0, 3.5), None);
        assert_eq!(FournierForand::new(1.1, 3.0), None);
    }

    /// Where d = 1 the formula is 0 / 0; its series meets it on both sides.
    #[test]
    fn the_removable_singularity_is_removed() {
        let shape = Shape::new(1.1, 3.5835);
        for x in [0.99 * NEAR, -0.99 * NEAR] {
            let d: f64 = 1.0 - x;
            let power = libm::pow(d, shape.nu);
            let series = shape.brackets(d, power);
            let direct =
                [(shape.nu * x - (1.0 - power)) / (x * x), (d * (1.0 - power) - shape.nu * x) / (x * x)];
            for (series, direct) in series.into_iter().zip(direct) {
                assert!((series / direct - 1.0).abs() < 1e-8, "{series} {direct}");
            }
        }
    }

    #[test]
    fn it_is_never_negative() {
        for index in [1.01, 1.05, 1.2, 1.4] {
            for slope in [3.05, 3.5, 4.0, 4.5, 4.95] {
                let phase = FournierForand::new(index, slope).unwrap();
                for i in 0..=1000 {
                    let value = phase.value(Deflection::from_one_minus_cos(0.002 * i as f32));
                    assert!(value > 0.0, "{index} {slope}: {value} at 1 - cos = {}", 0.002 * i as f32);
                }
            }
        }
    }
}
