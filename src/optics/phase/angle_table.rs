//! A density of angles that is linear in the cosine between nodes: integrated and inverted exactly.
//!
//! ```text
//! p(t) = p_i + (p_{i+1} - p_i) (t - t_i) / (t_{i+1} - t_i),   t = 1 - cos up to 90 degrees, 1 + cos beyond
//! P(t) = 2 pi (integral of p from the pole to t)
//! ```
//! Each hemisphere is counted from its own pole, so that peaks at either end keep their digits. The nodes of
//! [`AngleTable::of`] are even in log t: 16 an octave from 2^-40, where directions in single precision end. Between
//! nodes it is off by 0.2 % where p falls like t^(-3/2), the side of a Henyey-Greenstein peak.

use std::f64::consts::PI;

use super::deflection::Deflection;

/// Octaves of 1 - cos and of 1 + cos that are resolved below 90 degrees.
const OCTAVES: i32 = 40;
/// Nodes an octave.
const STEPS: i32 = 16;
/// The first node beside a pole.
pub(super) const POLE: f32 = 1.0 / (1_u64 << OCTAVES) as f32;

/// A normalised density per solid angle.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct AngleTable {
    forward: Hemisphere,
    backward: Hemisphere,
    mean_cosine: f32,
}

/// A density at one node, at its distance from the pole (1 - cos or 1 + cos).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Node {
    pub t: f32,
    pub density: f64,
}

/// Angles up to 90 degrees from one pole.
#[derive(Clone, Debug, PartialEq)]
struct Hemisphere {
    /// Rising from 0 to 1.
    t: Vec<f32>,
    density: Vec<f32>,
    /// Share of all samples up to each node.
    cumulative: Vec<f32>,
    /// The cell in which each of [`GUIDES`] even steps of the share begins.
    guide: Vec<u32>,
}

/// Steps of the share whose cell is known: from there few cells are left to be looked at.
const GUIDES: usize = 256;

impl AngleTable {
    /// Through the values of a function that is not negative; `None` when it vanishes or is not finite.
    pub fn of(function: impl Fn(Deflection) -> f64) -> Option<Self> {
        let node = |t, d| Node { t, density: function(d) };
        let forward = grid().map(|t| node(t, Deflection::from_one_minus_cos(t))).collect();
        let backward = grid().map(|t| node(t, Deflection::from_one_plus_cos(t))).collect();
        Self::new([forward, backward])
    }

    /// Through given nodes from each pole (t = 0) to 90 degrees (t = 1), rising; `None` when they sum to nothing or
    /// are not finite.
    pub fn new(nodes: [Vec<Node>; 2]) -> Option<Self> {
        let cells =
            || nodes.iter().zip([1.0, -1.0]).flat_map(|(n, side)| n.windows(2).map(move |c| (c, side)));
        let total: f64 = cells().map(|(cell, _)| cell_mass(cell)).sum();
        if !(total > 0.0 && total.is_finite()) {
            return None;
        }
        let mean: f64 = cells().map(|(cell, side)| side * cell_cosine(cell)).sum();
        let [forward, backward] = nodes.map(|nodes| Hemisphere::new(&nodes, total));
        Some(Self { forward, backward, mean_cosine: (mean / total) as f32 })
    }

    pub fn mean_cosine(&self) -> f32 {
        self.mean_cosine
    }

    /// Nodes and densities of both hemispheres, each from its own pole.
    pub fn nodes(&self) -> [(&[f32], &[f32]); 2] {
        [&self.forward, &self.backward].map(|side| (side.t.as_slice(), side.density.as_slice()))
    }

    /// Density per solid angle.
    pub fn pdf_w(&self, deflection: Deflection) -> f32 {
        if deflection.one_minus_cos() <= deflection.one_plus_cos() {
            self.forward.density_at(deflection.one_minus_cos())
        } else {
            self.backward.density_at(deflection.one_plus_cos())
        }
    }

    /// An angle with that density.
    pub fn sample(&self, u: f32) -> Deflection {
        let ahead = self.forward.share();
        if u < ahead || self.backward.share() == 0.0 {
            Deflection::from_one_minus_cos(self.forward.at_share(u.min(ahead)))
        } else {
            Deflection::from_one_plus_cos(self.backward.at_share((1.0 - u).min(self.backward.share())))
        }
    }
}

impl Hemisphere {
    fn new(nodes: &[Node], total: f64) -> Self {
        let mut cumulative = vec![0.0];
        let mut sum = 0.0;
        for cell in nodes.windows(2) {
            sum += cell_mass(cell) / total;
            cumulative.push(sum as f32);
        }
        let guide = (0..GUIDES).map(|i| cell_of(&cumulative, sum as f32 * (i as f32 / GUIDES as f32)) as u32);
        Self {
            guide: guide.collect(),
            t: nodes.iter().map(|n| n.t).collect(),
            density: nodes.iter().map(|n| (n.density / total) as f32).collect(),
            cumulative,
        }
    }

    /// Share of all samples in this hemisphere.
    fn share(&self) -> f32 {
        self.cumulative.last().copied().unwrap_or(0.0)
    }

    fn density_at(&self, t: f32) -> f32 {
        let (i, s) = cell_at(&self.t, t);
        self.density[i] + (self.density[i + 1] - self.density[i]) * s
    }

    /// Where the share counted from the pole is `share`.
    fn at_share(&self, share: f32) -> f32 {
        // The last node at or below it starts the cell; cells of no share are stepped over.
        let step = (share / self.share().max(f32::MIN_POSITIVE) * GUIDES as f32) as usize;
        // The step before: the quotient is rounded.
        let mut i = self.guide[step.clamp(1, GUIDES) - 1] as usize;
        while i + 2 < self.t.len() && self.cumulative[i + 1] <= share {
            i += 1;
        }
        let (t0, width) = (self.t[i], self.t[i + 1] - self.t[i]);
        let (p0, rise) = (self.density[i], self.density[i + 1] - self.density[i]);
        let rest = (share - self.cumulative[i]) / (2.0 * std::f32::consts::PI);
        // p0 d + rise d^2 / (2 width) = rest, solved without a difference of like numbers.
        let root = (p0 * p0 + 2.0 * rise * rest / width).max(0.0).sqrt();
        let d = 2.0 * rest / (p0 + root).max(f32::MIN_POSITIVE);
        t0 + d.min(width)
    }
}

/// The cell of rising nodes that holds `t`, and how far it lies in it.
#[inline]
pub(super) fn cell_at(nodes: &[f32], t: f32) -> (usize, f32) {
    let i = nodes.partition_point(|&node| node <= t).clamp(1, nodes.len() - 1) - 1;
    let (t0, t1) = (nodes[i], nodes[i + 1]);
    (i, ((t - t0) / (t1 - t0)).clamp(0.0, 1.0))
}

/// The cell whose share begins at or below `share`; cells of no share are stepped over.
fn cell_of(cumulative: &[f32], share: f32) -> usize {
    cumulative.partition_point(|&c| c <= share).clamp(1, cumulative.len() - 1) - 1
}

/// Integral over the sphere and mean cosine of a smooth function.
pub(super) fn moments(function: impl Fn(Deflection) -> f64) -> (f64, f64) {
    let ahead = |t: f64| function(Deflection::from_one_minus_cos(t as f32));
    let back = |t: f64| function(Deflection::from_one_plus_cos(t as f32));
    let whole = integral(ahead) + integral(back);
    let cosine = integral(|t| (1.0 - t) * ahead(t)) - integral(|t| (1.0 - t) * back(t));
    (2.0 * PI * whole, cosine / whole)
}

/// Integral over the unit interval of a function that is smooth in the logarithm, by Simpson's rule between the nodes,
/// all of which are numbers in single precision.
pub(super) fn integral(function: impl Fn(f64) -> f64) -> f64 {
    let nodes: Vec<f64> = grid().map(f64::from).collect();
    let cell = |cell: &[f64]| {
        let [a, b] = [cell[0], cell[1]];
        (b - a) / 6.0 * (function(a) + 4.0 * function(0.5 * (a + b)) + function(b))
    };
    nodes.windows(2).map(cell).sum()
}

/// 0, then 16 nodes an octave up to 1.
fn grid() -> impl Iterator<Item = f32> {
    let steps = (0..OCTAVES * STEPS).map(|i| {
        let octave = (1_u64 << (i / STEPS)) as f32;
        POLE * octave * (1.0 + (i % STEPS) as f32 / STEPS as f32)
    });
    std::iter::once(0.0).chain(steps).chain([1.0])
}

fn width(cell: &[Node]) -> f64 {
    f64::from(cell[1].t) - f64::from(cell[0].t)
}

fn cell_mass(cell: &[Node]) -> f64 {
    PI * (cell[0].density + cell[1].density) * width(cell)
}

/// Integral of (1 - t) p over a cell; Simpson's rule is exact.
fn cell_cosine(cell: &[Node]) -> f64 {
    let [a, b] = [f64::from(cell[0].t), f64::from(cell[1].t)];
    let (p, q) = (cell[0].density, cell[1].density);
    let ends = (1.0 - a) * p + (1.0 - b) * q;
    let middle = (1.0 - 0.5 * (a + b)) * 0.5 * (p + q);
    2.0 * PI * width(cell) / 6.0 * (ends + 4.0 * middle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_have_their_moments() {
        let (whole, mean) = moments(|d| 1.0 + 0.5 * f64::from(d.cosine()));
        assert!((whole - 4.0 * PI).abs() < 1e-6 && (mean - 0.5 / 3.0).abs() < 1e-7, "{whole} {mean}");
        let table = AngleTable::of(|d| 1.0 + 0.5 * f64::from(d.cosine())).unwrap();
        assert!((table.mean_cosine() - 0.5 / 3.0).abs() < 1e-7);
        let half_pi = f64::from(table.pdf_w(Deflection::from_one_minus_cos(1.0)));
        assert!((half_pi * 4.0 * PI - 1.0).abs() < 1e-6);
    }

    #[test]
    fn the_ends_of_the_unit_interval_stay_in_range() {
        let peaks: [fn(Deflection) -> f64; 4] = [
            |_| 1.0,
            |d| f64::from(u8::from(d.cosine() < 0.0)),
            |d| f64::from(u8::from(d.cosine() > 0.5)),
            |d| f64::from(d.one_minus_cos() + 1e-9).powi(-2),
        ];
        for peak in peaks {
            let table = AngleTable::of(peak).unwrap();
            for u in [0.0, 1e-7, 0.25, 0.5, 0.75, 1.0 - f32::EPSILON * 0.5] {
                let d = table.sample(u);
                assert!((0.0..=2.0).contains(&d.one_minus_cos()) && (0.0..=2.0).contains(&d.one_plus_cos()));
            }
        }
        assert_eq!(AngleTable::of(|_| 0.0), None);
        assert_eq!(AngleTable::of(|_| f64::NAN), None);
    }
}
