//! Hero wavelengths: the four wavelengths that a path carries.
//!
//! ```text
//! lambda_i = W(frac(u + i/4)),   RGB = 1/4 sum_i L(lambda_i) (rbar, gbar, bbar)(lambda_i) / p(lambda_i)     [WILKIE14]
//! p proportional to 4/5 |(rbar, gbar, bbar)| / (its integral) + 1/5 uniform on 380 to 780 nm
//! ```
//! The four lanes are stratified and share one random number. W is a table of 1024 equal steps in u, linear in
//! between, and p is the exact density of that table (1 / (1024 step)), so nothing is biased. The density was chosen
//! by measuring the deviation of one estimate of white: 0.13 (root mean square over R, G, B), against 0.18 for
//! |rbar| + |gbar| + |bbar|, 0.26 for xbar + ybar + zbar, 0.32 for the fit `[RADZISZEWSKI09]` and 0.41 for uniform.

use std::sync::LazyLock;

use glam::Vec3;

use super::cie::{self, NANOMETRES};
use super::{LaneMode, Lanes};

const STEPS: usize = 1024;
const UNIFORM_SHARE: f64 = 0.2;

/// The wavelengths of one path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wavelengths {
    /// Wavelength of each lane in nm.
    pub lambda: [f32; 4],
    /// Density of each lane's wavelength in 1/nm.
    pub pdf: [f32; 4],
}

impl Wavelengths {
    /// Stands in where lanes are RGB. The wavelengths are the dominant ones of the Rec. 709 primaries; no curve that
    /// was prepared for [`LaneMode::Rgb`] looks at them.
    pub const RGB: Self = Self { lambda: [611.4, 549.1, 464.2, 549.1], pdf: [1.0; 4] };

    /// Four stratified wavelengths for the random number `u` in [0, 1).
    pub fn sample(u: f32) -> Self {
        let table = &TABLES.warp;
        let mut wavelengths = Self { lambda: [0.0; 4], pdf: [0.0; 4] };
        for lane in 0..4 {
            let shifted = u + 0.25 * lane as f32;
            let position = if shifted >= 1.0 { shifted - 1.0 } else { shifted } * STEPS as f32;
            let index = (position as usize).min(STEPS - 1);
            let step = table[index + 1] - table[index];
            wavelengths.lambda[lane] = table[index] + (position - index as f32) * step;
            wavelengths.pdf[lane] = 1.0 / (STEPS as f32 * step);
        }
        wavelengths
    }

    /// All lanes at one wavelength in nm, to look a curve up there.
    pub const fn single(lambda: f32) -> Self {
        Self { lambda: [lambda; 4], pdf: [1.0; 4] }
    }

    /// The wavelengths for `u` in this mode.
    pub fn for_mode(mode: LaneMode, u: f32) -> Self {
        match mode {
            LaneMode::Rgb => Self::RGB,
            LaneMode::Spectral => Self::sample(u),
        }
    }

    /// Estimate of the linear Rec. 709 colour of radiance on the four wavelengths.
    pub fn to_rgb(&self, lanes: Lanes) -> Vec3 {
        let weighted = lanes / Lanes::from_array(self.pdf);
        let mut sum = Vec3::ZERO;
        for lane in 0..4 {
            let (index, t) = nanometre_cell(self.lambda[lane]);
            let matching = &TABLES.rgb_matching;
            sum += weighted[lane] * matching[index].lerp(matching[index + 1], t);
        }
        0.25 * sum
    }
}

/// The number u of which four wavelengths are sampled: `v` says which four, `hero` which of them is lane 0.
///
/// ```text
/// u = (floor(4 hero) + v) / 4
/// ```
/// u and u + 1/4 give the same four. So n stratified numbers u are n / 4 strata of v with four unstratified ones in
/// each; as v itself they are n. Only dispersion asks which of the four is the hero: else 0 does.
pub fn of_four(v: f32, hero: f32) -> f32 {
    (0.25 * ((4.0 * hero).floor() + v)).min(1.0 - f32::EPSILON * 0.5)
}

/// The colour that a path adds to the film: its lanes themselves when they are RGB, else [`Wavelengths::to_rgb`].
pub fn film_rgb(mode: LaneMode, wavelengths: &Wavelengths, lanes: Lanes) -> Vec3 {
    match mode {
        LaneMode::Rgb => lanes.truncate(),
        LaneMode::Spectral => wavelengths.to_rgb(lanes),
    }
}

/// The whole nanometre at or below `lambda` (as index from 380 nm, never the last) and the fraction above it.
pub(super) fn nanometre_cell(lambda: f32) -> (usize, f32) {
    let position = (lambda - cie::LAMBDA_MIN as f32).clamp(0.0, (NANOMETRES - 1) as f32);
    let index = (position as usize).min(NANOMETRES - 2);
    (index, position - index as f32)
}

struct Tables {
    /// Wavelengths at equal steps of the random number.
    warp: Box<[f32; STEPS + 1]>,
    /// (rbar, gbar, bbar) at whole nanometres.
    rgb_matching: Box<[Vec3; NANOMETRES]>,
}

static TABLES: LazyLock<Tables> = LazyLock::new(|| Tables {
    warp: warp(),
    rgb_matching: Box::new(std::array::from_fn(|i| cie::rgb_matching(cie::nanometre(i)).as_vec3())),
});

/// Inverts the distribution function, whose density is linear between whole nanometres.
fn warp() -> Box<[f32; STEPS + 1]> {
    let visible = |i: usize| cie::rgb_matching(cie::nanometre(i)).length();
    let cell = |i: usize| 0.5 * (visible(i) + visible(i + 1));
    let total: f64 = (0..NANOMETRES - 1).map(cell).sum();
    let density = |i: usize| {
        (1.0 - UNIFORM_SHARE) * visible(i) / total + UNIFORM_SHARE / (cie::LAMBDA_MAX - cie::LAMBDA_MIN)
    };
    let mut table = Box::new([cie::LAMBDA_MAX as f32; STEPS + 1]);
    let (mut index, mut below) = (0, 0.0);
    for (step, lambda) in table.iter_mut().enumerate().take(STEPS) {
        let u = step as f64 / STEPS as f64;
        let mut mass = 0.5 * (density(index) + density(index + 1));
        while below + mass <= u && index + 2 < NANOMETRES {
            below += mass;
            index += 1;
            mass = 0.5 * (density(index) + density(index + 1));
        }
        *lambda =
            (cie::nanometre(index) + inverse_in_cell(density(index), density(index + 1), u - below)) as f32;
    }
    table
}

/// Where in a cell of width 1 the integral of the density from `a` to `b` (linear) reaches `mass`.
fn inverse_in_cell(a: f64, b: f64, mass: f64) -> f64 {
    2.0 * mass / (a + (a * a + 2.0 * (b - a) * mass).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean_rgb(spectrum: impl Fn(f64) -> f64, count: usize) -> Vec3 {
        let mut sum = glam::DVec3::ZERO;
        for i in 0..count {
            let w = Wavelengths::sample((i as f32 + 0.5) / count as f32);
            let lanes = Lanes::from_array(w.lambda.map(|lambda| spectrum(f64::from(lambda)) as f32));
            sum += w.to_rgb(lanes).as_dvec3();
        }
        (sum / count as f64).as_vec3()
    }

    #[test]
    fn d65_averages_to_white() {
        let white = mean_rgb(cie::d65, 4096);
        assert!((white - Vec3::ONE).abs().max_element() < 1e-5, "{white}");
    }

    #[test]
    fn a_steep_spectrum_averages_to_its_integral() {
        let spectrum = |lambda: f64| cie::d65(lambda) * libm::exp(-libm::pow((lambda - 470.0) / 15.0, 2.0));
        let want = cie::rgb(spectrum).as_vec3();
        let got = mean_rgb(spectrum, 4096);
        assert!((got - want).abs().max_element() < 1e-4, "{got} is not {want}");
    }

    /// The mean of 1 / pdf is the length of the range.
    #[test]
    fn the_density_is_that_of_the_samples() {
        let mut length = 0.0;
        for i in 0..4096 {
            let w = Wavelengths::sample((i as f32 + 0.5) / 4096.0);
            length += w.pdf.iter().map(|p| 0.25 / f64::from(*p)).sum::<f64>();
        }
        assert!((length / 4096.0 - 400.0).abs() < 0.01, "{}", length / 4096.0);
    }

    #[test]
    fn lanes_are_stratified_in_range_and_distinct() {
        let largest = 1.0 - f32::EPSILON / 2.0;
        for u in (0..1000).map(|i| i as f32 / 1000.0).chain([largest, 0.25 - f32::EPSILON / 8.0]) {
            let w = Wavelengths::sample(u);
            assert!(w.lambda.iter().all(|l| (380.0..=780.0).contains(l)), "{w:?}");
            assert!(w.pdf.iter().all(|p| *p > 0.2 / 400.0 * 0.99 && p.is_finite()), "{w:?}");
            let mut sorted = w.lambda;
            sorted.sort_by(f32::total_cmp);
            assert!(sorted.windows(2).all(|pair| pair[1] - pair[0] > 10.0), "{w:?}");
        }
    }

    #[test]
    fn one_estimate_of_white_deviates_by_an_eighth() {
        let mut square = 0.0;
        for i in 0..4096 {
            let w = Wavelengths::sample((i as f32 + 0.5) / 4096.0);
            let rgb = w.to_rgb(Lanes::from_array(w.lambda.map(|l| cie::d65(f64::from(l)) as f32)));
            square += f64::from((rgb - Vec3::ONE).length_squared()) / 3.0;
        }
        let deviation = (square / 4096.0).sqrt();
        assert!((0.12..0.14).contains(&deviation), "{deviation}");
    }

    /// A lane alone counts four times: one that ended adds nothing, and lane 0 has every wavelength in the end.
    #[test]
    fn the_hero_alone_averages_to_white() {
        let mut sum = glam::DVec3::ZERO;
        for (i, hero) in (0..4096).flat_map(|i| [0.1, 0.3, 0.6, 0.9].map(|hero| (i, hero))) {
            let w = Wavelengths::sample(of_four((i as f32 + 0.5) / 4096.0, hero));
            let alone = 4.0 * cie::d65(f64::from(w.lambda[0])) as f32;
            sum += film_rgb(LaneMode::Spectral, &w, Lanes::new(alone, 0.0, 0.0, 0.0)).as_dvec3();
        }
        let white = sum / (4.0 * 4096.0);
        assert!((white - glam::DVec3::ONE).abs().max_element() < 1e-5, "{white}");
    }

    #[test]
    fn which_of_the_four_leads_does_not_change_the_four() {
        for v in [0.0, 0.3, 0.999] {
            let sets = [0.0, 0.25, 0.5, 0.75].map(|hero| Wavelengths::sample(of_four(v, hero)).lambda);
            for (lead, set) in sets.iter().enumerate() {
                for (lane, lambda) in set.iter().enumerate() {
                    let same = sets[0][(lane + lead) % 4];
                    // The number is rounded to 2^-24 of 400 nm at the most, where the table is steepest 20 times that.
                    assert!((lambda - same).abs() < 1e-3, "{v}: {sets:?}");
                }
            }
        }
    }

    #[test]
    fn rgb_lanes_reach_the_film_as_they_are() {
        let lanes = Lanes::new(0.1, 2.0, 3.0, 0.0);
        let w = Wavelengths::for_mode(LaneMode::Rgb, 0.3);
        assert_eq!(film_rgb(LaneMode::Rgb, &w, lanes), Vec3::new(0.1, 2.0, 3.0));
    }
}
