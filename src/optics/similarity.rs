//! A medium that scatters less often and wider, and looks the same from afar: similarity relations.
//!
//! ```text
//! sigma_a* = sigma_a,   sigma_s* (1 - g_k*) = sigma_s (1 - g_k)   for k = 1 .. N                       [WYMAN89]
//! alpha = sigma_s* / sigma_s,   g_k* = 1 - (1 - g_k) / alpha
//! p* = max(0, sum of b_k P_k(cos) over k = 0 .. N)
//! ```
//! g_k are the Legendre moments of the phase function. Radiance fields whose moments vanish beyond N are the same in both
//! media; others, near boundaries and lights, are not. So the reduction is biased. Order 1 leads to isotropic scattering.
//! From order 2 on p* is the density of least mean square with the new moments that is nowhere negative, which is their
//! Legendre series where that is not negative, and alpha the least at which it scatters forward and is no sharper than a
//! series of its degree can be. (The series itself, `[ZHAO14]`'s starting point, has no alpha at which it is not negative
//! for peaks as narrow as those of Henyey and Greenstein's g = 0.9 at order 3.)
//!
//! The b_k solve a convex problem, the least of (integral of p*^2) / 2 - sum of b_k g_k*, by Newton's method.

use std::f64::consts::PI;

use super::phase::{Isotropic, PhaseFunction, Tabulated, legendre};

/// The highest order that there is.
pub const HIGHEST_ORDER: usize = 4;

/// Cells of the cosine in which phase functions are computed and tabulated.
const CELLS: usize = 1024;
/// A reduction to more than this share of the collisions is not worth its bias.
const WORTH_A_BIAS: f64 = 0.95;
/// 4 pi p* straight ahead at most, by order: what a series of that degree can reach without being negative somewhere.
const SHARPEST: [f64; HIGHEST_ORDER + 1] = [1.0, 2.0, 4.0, 6.0, 9.0];
/// Values of alpha that are looked at, even in their logarithm.
const ALPHAS: i32 = 256;

/// What takes a phase function's place.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduction {
    /// sigma_s* / sigma_s.
    pub alpha: f64,
    /// The wider phase function.
    pub phase: PhaseFunction,
}

impl Reduction {
    /// The reduction of an order from 1 to [`HIGHEST_ORDER`]; `None` where there is none that scatters less often.
    pub fn of(phase: &PhaseFunction, order: usize) -> Option<Self> {
        let lacks = phase.lacks_of_moments(order.min(HIGHEST_ORDER));
        let least = *lacks.first()?;
        if !(least > 0.0 && least <= WORTH_A_BIAS) {
            return None;
        }
        if lacks.iter().all(|lack| (lack / least - 1.0).abs() < 1e-6) {
            return Some(Self { alpha: least, phase: PhaseFunction::Isotropic(Isotropic) });
        }
        let basis = Basis::new(lacks.len());
        let alphas =
            (0..=ALPHAS).map(|i| least * libm::pow(WORTH_A_BIAS / least, f64::from(i) / f64::from(ALPHAS)));
        alphas.into_iter().find_map(|alpha| {
            let moments: Vec<f64> = lacks.iter().map(|lack| 1.0 - lack / alpha).collect();
            let values = basis.density(&moments)?;
            let sharpest = values.iter().fold(0.0, |most: f64, value| most.max(*value));
            let phase = (4.0 * PI * sharpest <= SHARPEST[lacks.len()]).then(|| tabulated(&values))??;
            Some(Self { alpha, phase: PhaseFunction::Tabulated(phase) })
        })
    }
}

/// Legendre polynomials up to a degree at even steps of the cosine, from 1 to -1.
struct Basis {
    rows: Vec<Vec<f64>>,
}

impl Basis {
    /// Steps that Newton's method may take; it needs 5 to 20 where there is a density, and where there is none it grows
    /// without end.
    const MOST_STEPS: u32 = 60;

    fn new(degree: usize) -> Self {
        Self { rows: cosines().map(|cos| (0..=degree).map(|k| legendre(k, cos)).collect()).collect() }
    }

    /// The density of least mean square with these moments (from the first on) that is not negative.
    fn density(&self, moments: &[f64]) -> Option<Vec<f64>> {
        let wanted: Vec<f64> = std::iter::once(1.0).chain(moments.iter().copied()).collect();
        let mut b: Vec<f64> =
            wanted.iter().zip(0..).map(|(g, k)| f64::from(2 * k + 1) * g / (4.0 * PI)).collect();
        for _ in 0..Self::MOST_STEPS {
            let (mut gap, gram) = self.gap_and_gram(&b, &wanted);
            if gap.iter().all(|off| off.abs() < 1e-9) {
                return Some(self.rows.iter().map(|row| dot(row, &b).max(0.0)).collect());
            }
            solve(gram, &mut gap)?;
            let before = self.objective(&b, &wanted);
            let moved = |step: f64| -> Vec<f64> { b.iter().zip(&gap).map(|(b, d)| b + step * d).collect() };
            let steps = std::iter::successors(Some(1.0), |step| Some(0.5 * step)).take(30);
            b = steps.map(moved).find(|b| self.objective(b, &wanted) < before + 1e-15)?;
        }
        None
    }

    /// What the moments of max(0, b P) lack of those that are wanted, and how they change with b.
    fn gap_and_gram(&self, b: &[f64], wanted: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
        let n = wanted.len();
        let (mut gap, mut gram) = (wanted.to_vec(), vec![vec![0.0; n]; n]);
        for (row, weight) in self.rows.iter().zip(weights()) {
            let value = dot(row, b);
            if value > 0.0 {
                for j in 0..n {
                    gap[j] -= weight * value * row[j];
                    (0..n).for_each(|k| gram[j][k] += weight * row[j] * row[k]);
                }
            }
        }
        (gap, gram)
    }

    fn objective(&self, b: &[f64], wanted: &[f64]) -> f64 {
        let square = |row: &Vec<f64>| {
            let value = dot(row, b).max(0.0);
            value * value
        };
        0.5 * self.rows.iter().zip(weights()).map(|(row, w)| w * square(row)).sum::<f64>() - dot(b, wanted)
    }
}

/// Solves a x = b by elimination with pivots; x takes the place of b.
fn solve(mut a: Vec<Vec<f64>>, b: &mut [f64]) -> Option<()> {
    let n = b.len();
    for i in 0..n {
        let pivot = (i..n).max_by(|&j, &k| a[j][i].abs().total_cmp(&a[k][i].abs()))?;
        a.swap(i, pivot);
        b.swap(i, pivot);
        if a[i][i].abs() < 1e-14 {
            return None;
        }
        for row in 0..n {
            let factor = a[row][i] / a[i][i];
            if row != i && factor != 0.0 {
                (i..n).for_each(|k| a[row][k] -= factor * a[i][k]);
                b[row] -= factor * b[i];
            }
        }
    }
    (0..n).for_each(|i| b[i] /= a[i][i]);
    Some(())
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// From 1 to -1.
pub(super) fn cosines() -> impl Iterator<Item = f64> {
    (0..=CELLS).map(|i| 1.0 - 2.0 * i as f64 / CELLS as f64)
}

/// Solid angle that belongs to each of [`cosines`], by the trapezoidal rule.
fn weights() -> impl Iterator<Item = f64> {
    (0..=CELLS).map(|i| if i == 0 || i == CELLS { 2.0 * PI / CELLS as f64 } else { 4.0 * PI / CELLS as f64 })
}

fn tabulated(values: &[f64]) -> Option<Tabulated> {
    let angles: Vec<f64> = cosines().map(libm::acos).collect();
    Tabulated::new(&angles, values)
}

#[cfg(test)]
mod tests {
    use super::super::phase::{Deflection, EXAMPLES, FournierForand, HenyeyGreenstein, Rayleigh};
    use super::*;

    fn henyey_greenstein(g: f32) -> PhaseFunction {
        PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g })
    }

    /// 1 - g_k by the midpoint rule in even steps of the cosine, for what has no peak.
    fn lack_of_moment(phase: &PhaseFunction, k: usize) -> f64 {
        let n = 20_000;
        let at = |i: i32| {
            let t = (2.0 * f64::from(i) + 1.0) / f64::from(n);
            let deflection = if t < 1.0 {
                Deflection::from_one_minus_cos(t as f32)
            } else {
                Deflection::from_one_plus_cos((2.0 - t) as f32)
            };
            f64::from(phase.value(deflection)) * (1.0 - legendre(k, 1.0 - t))
        };
        4.0 * PI / f64::from(n) * (0..n).map(at).sum::<f64>()
    }

    /// The trapezoidal rule over cells of 1/512, and single precision, are good to 2e-5 of what a moment lacks of 1.
    fn assert_similar(name: &str, phase: &PhaseFunction, order: usize) {
        let Some(reduction) = Reduction::of(phase, order) else { panic!("{name}: no reduction of {order}") };
        for (lack, k) in phase.lacks_of_moments(order).iter().zip(1..) {
            let kept = reduction.alpha * lack_of_moment(&reduction.phase, k);
            assert!((kept / lack - 1.0).abs() < 5e-5, "{name}, order {order}, moment {k}: {kept} {lack}");
        }
        for cos in cosines() {
            let value = reduction.phase.value(Deflection::from_one_minus_cos((1.0 - cos) as f32));
            assert!(value >= 0.0, "{name}, order {order}: {value} at {cos}");
        }
        assert!(reduction.phase.mean_cosine() > -1e-4, "{name}, order {order}");
    }

    #[test]
    fn order_1_is_isotropic_and_keeps_the_transport_coefficient() {
        for g in [0.3, 0.86, 0.9999] {
            let reduction = Reduction::of(&henyey_greenstein(g), 1).unwrap();
            assert_eq!(reduction.phase, PhaseFunction::Isotropic(Isotropic));
            assert!((reduction.alpha / (1.0 - f64::from(g)) - 1.0).abs() < 2e-5);
        }
    }

    #[test]
    fn every_order_keeps_its_moments() {
        for order in 2..=HIGHEST_ORDER {
            for g in [0.85, 0.9, 0.99, 0.9999] {
                assert_similar(&format!("henyey-greenstein {g}"), &henyey_greenstein(g), order);
            }
            let ocean = FournierForand::of_backscatter(0.0183).map(PhaseFunction::FournierForand).unwrap();
            assert_similar("fournier-forand", &ocean, order);
        }
    }

    /// Where the series of the moments is not negative, it is the density of least mean square.
    #[test]
    fn a_series_that_is_not_negative_is_taken_as_it_is() {
        let moments = [0.5, 0.2, 0.05];
        let values = Basis::new(3).density(&moments).unwrap();
        for (value, cos) in values.iter().zip(cosines()) {
            let series =
                1.0 + (1..=3).map(|k| (2 * k + 1) as f64 * moments[k - 1] * legendre(k, cos)).sum::<f64>();
            // The trapezoidal rule is good to 1e-5.
            assert!((4.0 * PI * value - series).abs() < 1e-4, "{value} {series} at {cos}");
        }
        assert_eq!(Basis::new(2).density(&[0.5, -0.2]), None, "g_2 is (3 g_1^2 - 1) / 2 at least");
    }

    #[test]
    fn higher_orders_collide_more_often() {
        let alphas: Vec<f64> = (1..=HIGHEST_ORDER)
            .map(|order| Reduction::of(&henyey_greenstein(0.86), order).unwrap().alpha)
            .collect();
        println!("{alphas:.4?}");
        assert!(alphas.windows(2).all(|pair| pair[0] < pair[1]) && alphas[3] < 1.0, "{alphas:?}");
    }

    #[test]
    fn what_scatters_back_or_evenly_is_left_alone() {
        for order in 0..=HIGHEST_ORDER {
            for phase in [
                PhaseFunction::Rayleigh(Rayleigh),
                PhaseFunction::Isotropic(Isotropic),
                henyey_greenstein(-0.5),
                henyey_greenstein(0.0),
            ] {
                assert_eq!(Reduction::of(&phase, order), None, "{phase:?} {order}");
            }
        }
        assert_eq!(Reduction::of(&henyey_greenstein(0.9), 0), None);
    }

    #[test]
    fn every_phase_function_is_reduced_soundly_or_left_alone() {
        for (name, phase) in EXAMPLES.iter() {
            for order in 1..=HIGHEST_ORDER {
                if let Some(Reduction { alpha, .. }) = Reduction::of(phase, order) {
                    assert!(alpha > 0.0 && alpha < 1.0 && phase.mean_cosine() > 0.0, "{name}, order {order}");
                    if order > 1 {
                        assert_similar(name, phase, order);
                    }
                }
            }
        }
    }
}
