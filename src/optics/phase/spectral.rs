//! Phase functions that differ from wavelength to wavelength, on the four wavelengths of a path.
//!
//! Henyey and Greenstein's lobe with a g that is a curve, or tables at several wavelengths on the same angles, blended:
//!
//! ```text
//! p = (1 - s) p_i + s p_(i+1),   s = (lambda - lambda_i) / (lambda_(i+1) - lambda_i), constant beyond the ends
//! ```
//! Each table is normalised, so every blend is. A direction is drawn from the function of one lane, chosen with the
//! probability P in proportion to the path's throughput, and weighted over all of them by the balance heuristic
//! `[WILKIE14]`; of a blend it is drawn from either table with the blend's own shares, exactly:
//!
//! ```text
//! pdf_w = sum over the lanes of P p,   weight of each lane = p / pdf_w,   sum of P weight = 1
//! ```
//! So the sum of a path's lanes is what it would be if all scattered alike, whatever is drawn: no lane ever weighs more
//! than all of them did, and where they are alike the weight is 1. Drawing the lane anew at each particle is the same as
//! drawing it once and following its functions, for P are the chances that a path like this one is of each lane.
//!
//! The lanes of a path part as the product of their functions' ratios does, until one carries all the light; the noise is
//! then that of paths which carry one wavelength. The deviation of a sample's colours (r - g and b - g) and of its luminance,
//! over the mean, of a ball under a sky of which half is dark, with g falling evenly from 400 to 700 nm:
//!
//! | g | 20 collisions | 85 | 400 | 1900 |
//! |---|---|---|---|---|
//! | 0.85 | 0.29, 1.01 | 0.29, 0.99 | 0.29, 0.98 | 0.28, 0.97 |
//! | 0.855 to 0.85 | 0.29, 1.00 | 0.32, 0.99 | 0.41, 0.98 | 0.79, 0.99 |
//! | 0.87 to 0.83 | 0.60, 1.02 | 1.1, 1.04 | 1.7, 1.08 | 1.9, 1.10 |
//! | 0.95 to 0.75 | 2.5, 1.23 | 3.3, 1.39 | 3.5, 1.40 | 3.5, 1.40 |
//!
//! So 0.87 to 0.83 takes 15 times as many samples for the same noise in colour after 85 collisions, and 1.1 times as many for
//! that in luminance (`tests/analytic/spectral_phases.rs`). A sample takes as long as with one function where lights are
//! looked for at each collision (0.9 to 1.2 times), and under an even sky, where else eight collisions are drawn at a time, 1.2
//! times (20 collisions) to 4.3 times (1900). No other weights of the same paths have less noise: these are what any that are
//! right average to, given the path.

use std::sync::Arc;

use super::Lobe;
use super::deflection::Deflection;
use super::henyey_greenstein::{self, HenyeyGreenstein};
use super::tabulated::Tabulated;
use super::{PhaseFunction, angle_table};
use crate::optics::medium::pick;
use crate::spectrum::cie::{LAMBDA_MAX, LAMBDA_MIN};
use crate::spectrum::{LaneCurve, LaneMode, Lanes, Role, Spectrum, Wavelengths};

/// A phase function over wavelength. Copies share its tables.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectralPhase(Kind);

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    /// g at every wavelength.
    HenyeyGreenstein(LaneCurve),
    Tables(Arc<Tables>),
}

/// Tables at several wavelengths on the same angles.
#[derive(Debug, PartialEq)]
struct Tables {
    /// In nm, strictly rising.
    wavelengths: Vec<f32>,
    /// What samples are drawn from.
    tables: Vec<Tabulated>,
    /// The same densities, those of all wavelengths side by side at each angle: from the forward and from the backward pole.
    rows: [Rows; 2],
}

/// Densities at the nodes of one hemisphere.
#[derive(Debug, PartialEq)]
struct Rows {
    /// 1 - cos or 1 + cos, rising from 0 to 1.
    t: Vec<f32>,
    /// One row a node.
    density: Vec<f32>,
}

/// A phase function on the wavelengths of one path.
#[derive(Clone, Copy, Debug)]
pub struct SpectralLanes<'a>(OnLanes<'a>);

#[derive(Clone, Copy, Debug)]
enum OnLanes<'a> {
    /// g of each lane.
    HenyeyGreenstein(Lanes),
    Tables {
        tables: &'a Tables,
        /// The table at or below the wavelength of each lane.
        below: [usize; 4],
        /// The share of the one above it.
        above: Lanes,
    },
}

impl SpectralPhase {
    /// Values that are not negative, `[wavelength][angle]` in any unit, at strictly rising wavelengths in nm and strictly
    /// rising angles in radians, from 0 to pi; `None` when they are not, when those of any wavelength are all zero, or when
    /// their numbers do not agree.
    pub fn tabulated(wavelengths: &[f64], angles: &[f64], values: &[Vec<f64>]) -> Option<Self> {
        let wavelengths: Vec<f32> = wavelengths.iter().map(|&nm| nm as f32).collect();
        let in_range = wavelengths.iter().all(|nm| *nm > 0.0 && nm.is_finite());
        let rising = wavelengths.windows(2).all(|w| w[0] < w[1]);
        if wavelengths.is_empty() || wavelengths.len() != values.len() || !(in_range && rising) {
            return None;
        }
        let tables: Vec<Tabulated> =
            values.iter().map(|values| Tabulated::new(angles, values)).collect::<Option<_>>()?;
        let rows = [0, 1].map(|end| Rows::of(&tables, end));
        Some(Self(Kind::Tables(Arc::new(Tables { wavelengths, tables, rows }))))
    }

    /// Henyey and Greenstein's with a mean cosine over wavelength, a constant or a table, taken at whole nanometres and
    /// linear between them; `None` unless it is between -1 and 1 everywhere.
    pub fn henyey_greenstein(g: Spectrum) -> Option<Self> {
        if !matches!(g, Spectrum::Constant(_) | Spectrum::Table { .. }) {
            return None;
        }
        let g = g.prepare(Role::Coefficient, LaneMode::Spectral);
        let is_between = |g: &f32| g.abs() < 1.0;
        let is_valid = match &g {
            LaneCurve::Constant(g) => is_between(g),
            LaneCurve::Sampled(all) => all.iter().all(is_between),
            LaneCurve::Rgb(_) => false,
        };
        is_valid.then_some(Self(Kind::HenyeyGreenstein(g)))
    }

    /// On the wavelengths of a path.
    pub fn at(&self, wavelengths: &Wavelengths) -> SpectralLanes<'_> {
        SpectralLanes(match &self.0 {
            Kind::HenyeyGreenstein(g) => OnLanes::HenyeyGreenstein(g.lanes(wavelengths)),
            Kind::Tables(tables) => {
                let places = wavelengths.lambda.map(|lambda| tables.place_of(lambda));
                let above = Lanes::from_array(places.map(|(_, above)| above));
                OnLanes::Tables { tables, below: places.map(|(below, _)| below), above }
            }
        })
    }

    /// Mean cosine over wavelength; positive is forward.
    pub fn mean_cosine(&self) -> LaneCurve {
        match &self.0 {
            Kind::HenyeyGreenstein(g) => g.clone(),
            Kind::Tables(tables) => LaneCurve::sampled(|lambda| {
                let (below, above) = tables.place_of(lambda as f32);
                let [a, b] = [below, tables.next(below)].map(|i| tables.tables[i].mean_cosine());
                f64::from(a + (b - a) * above)
            }),
        }
    }

    /// The functions at the wavelengths in nm between which it is linear, or nearly so: every 10 nm of a g that is a curve.
    pub fn nodes(&self) -> Vec<(f64, PhaseFunction)> {
        match &self.0 {
            Kind::HenyeyGreenstein(g) => {
                let all = (LAMBDA_MIN as u32..=LAMBDA_MAX as u32).step_by(10);
                let at = |nm: u32| g.lanes(&Wavelengths::single(nm as f32)).x;
                let lobe = |nm| PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g: at(nm) });
                all.map(|nm| (f64::from(nm), lobe(nm))).collect()
            }
            Kind::Tables(tables) => {
                let functions = tables.tables.iter().cloned().map(PhaseFunction::Tabulated);
                tables.wavelengths.iter().map(|&nm| f64::from(nm)).zip(functions).collect()
            }
        }
    }
}

impl SpectralLanes<'_> {
    /// Density of scattered light per solid angle in each lane, in 1/sr.
    pub fn value(&self, turned: Deflection) -> Lanes {
        match &self.0 {
            OnLanes::HenyeyGreenstein(g) => henyey_greenstein::on_lanes(*g, turned),
            OnLanes::Tables { tables, below, above } => tables.value(below, *above, turned),
        }
    }

    /// An angle for a path of this throughput, drawn with `u`, with the value of each lane there and the density. The
    /// second number decides from which function, and is returned with what is left of it.
    pub(super) fn draw(&self, throughput: Lanes, [u, v]: [f32; 2]) -> Drawn {
        let shares = shares(throughput);
        let (lane, rest) = pick(shares, v);
        let (turned, rest) = self.draw_in(lane, u, rest);
        let value = self.value(turned);
        let pdf_w = (shares * value).element_sum();
        Drawn { turned, value, pdf_w, weight: weight(shares, value, pdf_w), rest }
    }

    fn draw_in(&self, lane: usize, u: f32, v: f32) -> (Deflection, f32) {
        match &self.0 {
            OnLanes::HenyeyGreenstein(g) => (HenyeyGreenstein { g: g[lane] }.sample(u), v),
            OnLanes::Tables { tables, below, above } => {
                let (below, above) = (below[lane], above[lane]);
                let (which, rest) = match v < above {
                    true => (tables.next(below), v / above),
                    false => (below, (v - above) / (1.0 - above)),
                };
                (tables.tables[which].sample(u), rest.min(1.0 - f32::EPSILON * 0.5))
            }
        }
    }

    /// Density per solid angle with which a path of this throughput draws an angle where the lanes have these values.
    pub(super) fn pdf_w(throughput: Lanes, value: Lanes) -> f32 {
        (shares(throughput) * value).element_sum()
    }
}

/// An angle that was drawn.
pub(super) struct Drawn {
    pub turned: Deflection,
    /// Value of each lane in 1/sr.
    pub value: Lanes,
    /// Density per solid angle.
    pub pdf_w: f32,
    /// Value over density.
    pub weight: Lanes,
    /// What is left of the random number that chose the function, in [0, 1).
    pub rest: f32,
}

/// A lane with less than this share of a path's light has none. Its light would be lost in the rounding of products with the
/// others' if the path ever took a turn that only it can take; what is left out of its mean is less than this.
const LEAST_SHARE: f32 = 1e-20;

/// P: the lanes' shares in the throughput; none of nothing.
fn shares(throughput: Lanes) -> Lanes {
    let shares = throughput / throughput.element_sum();
    Lanes::select(shares.cmpgt(Lanes::splat(LEAST_SHARE)), shares, Lanes::ZERO)
}

/// Value over density in the lanes that have a share; where both are 0, at the very node of a table, what they go to if the
/// lanes are alike.
fn weight(shares: Lanes, value: Lanes, pdf_w: f32) -> Lanes {
    if pdf_w > 0.0 {
        Lanes::select(shares.cmpgt(Lanes::ZERO), value / pdf_w, Lanes::ZERO)
    } else {
        Lanes::ONE
    }
}

impl Tables {
    /// The table at or below a wavelength in nm, and the share of the next.
    fn place_of(&self, lambda: f32) -> (usize, f32) {
        let below = self.wavelengths.partition_point(|&nm| nm <= lambda).saturating_sub(1);
        let (from, to) = (self.wavelengths[below], self.wavelengths[self.next(below)]);
        let above = if to > from { ((lambda - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
        (below, above)
    }

    /// The table above one, or the last.
    fn next(&self, below: usize) -> usize {
        (below + 1).min(self.wavelengths.len() - 1)
    }

    fn value(&self, below: &[usize; 4], above: Lanes, turned: Deflection) -> Lanes {
        let is_ahead = turned.one_minus_cos() <= turned.one_plus_cos();
        let (rows, t) = match is_ahead {
            true => (&self.rows[0], turned.one_minus_cos()),
            false => (&self.rows[1], turned.one_plus_cos()),
        };
        let (node, s) = angle_table::cell_at(&rows.t, t);
        let count = self.wavelengths.len();
        let blended = |node: usize| {
            let row = &rows.density[node * count..][..count];
            let a = Lanes::from_array(below.map(|i| row[i]));
            let b = Lanes::from_array(below.map(|i| row[self.next(i)]));
            a + (b - a) * above
        };
        let (p, q) = (blended(node), blended(node + 1));
        p + (q - p) * s
    }
}

impl Rows {
    /// Of tables on the same angles.
    fn of(tables: &[Tabulated], end: usize) -> Self {
        let columns: Vec<(&[f32], &[f32])> = tables.iter().map(|table| table.nodes()[end]).collect();
        let t = columns.first().map_or(Vec::new(), |(t, _)| t.to_vec());
        let density = (0..t.len()).flat_map(|node| columns.iter().map(move |(_, density)| density[node]));
        Self { density: density.collect(), t }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{PhaseLanes, SPECTRAL_EXAMPLES};
    use super::*;
    use glam::Vec3;

    const WAVELENGTHS: Wavelengths = Wavelengths { lambda: [380.0, 475.0, 550.0, 700.0], pdf: [1.0; 4] };

    fn table(wavelengths: &[f32], values: &[f32]) -> Spectrum {
        Spectrum::Table { wavelengths: wavelengths.to_vec(), values: values.to_vec() }
    }

    #[test]
    fn between_wavelengths_normalised_tables_are_blended() {
        let angles = [0.0, 1.0, 2.0, 3.0];
        // The second in another unit.
        let values = [vec![4.0, 3.0, 1.0, 2.0], vec![10.0, 20.0, 30.0, 0.0]];
        let alone = [0, 1].map(|i| Tabulated::new(&angles, &values[i]).unwrap());
        let phase = SpectralPhase::tabulated(&[450.0, 500.0], &angles, &values).unwrap();
        for turned in (0..=40).map(|i| Deflection::from_one_minus_cos(0.05 * i as f32)) {
            let [a, b] = [0, 1].map(|i| alone[i].value(turned));
            let expected = Lanes::new(a, 0.5 * (a + b), b, b);
            let off = (phase.at(&WAVELENGTHS).value(turned) - expected).abs();
            assert!(off.max_element() < 1e-7, "{turned:?}: {off}");
        }
        let g = [alone[0].mean_cosine(), alone[1].mean_cosine()];
        let expected = Lanes::new(g[0], 0.5 * (g[0] + g[1]), g[1], g[1]);
        assert!((phase.mean_cosine().lanes(&WAVELENGTHS) - expected).abs().max_element() < 1e-7);
        assert_eq!(phase.nodes().iter().map(|(nm, _)| *nm).collect::<Vec<_>>(), [450.0, 500.0]);
    }

    #[test]
    fn lanes_are_henyey_and_greensteins_lobes_to_the_last_bit() {
        let phase =
            SpectralPhase::henyey_greenstein(table(&[400.0, 550.0, 700.0], &[-0.9, 0.0, 0.999])).unwrap();
        let lanes = phase.at(&WAVELENGTHS);
        let g = phase.mean_cosine().lanes(&WAVELENGTHS);
        assert_eq!((g.x, g.y, g.z, g.w), (-0.9, -0.45, 0.0, 0.999));
        for turned in (0..=40).map(|i| Deflection::from_one_minus_cos(0.05 * i as f32)) {
            let alone = g.to_array().map(|g| HenyeyGreenstein { g }.value(turned));
            assert_eq!(lanes.value(turned).to_array(), alone);
        }
        assert_eq!(phase.nodes().len(), 41);
    }

    #[test]
    fn nonsense_is_refused() {
        let (angles, row) = ([0.0, 1.0], vec![1.0, 2.0]);
        let two = [row.clone(), row.clone()];
        assert!(SpectralPhase::tabulated(&[500.0, 600.0], &angles, &two).is_some());
        let refused: [(&[f64], &[Vec<f64>]); 8] = [
            (&[], &[]),
            (&[500.0], &two),
            (&[600.0, 500.0], &two),
            (&[500.0, 500.0], &two),
            (&[f64::NAN, 600.0], &two),
            (&[-1.0, 600.0], &two),
            (&[500.0, 600.0], &[row.clone(), vec![1.0]]),
            (&[500.0, 600.0], &[row.clone(), vec![0.0, 0.0]]),
        ];
        for (wavelengths, values) in refused {
            assert_eq!(
                SpectralPhase::tabulated(wavelengths, &angles, values),
                None,
                "{wavelengths:?} {values:?}"
            );
        }
        for g in [
            table(&[400.0, 700.0], &[0.5, 1.0]),
            table(&[500.0], &[f32::NAN]),
            Spectrum::Rgb([0.5; 3]),
            Spectrum::Constant(-1.0),
        ] {
            assert_eq!(SpectralPhase::henyey_greenstein(g.clone()), None, "{g:?}");
        }
    }

    /// Tables that are all equal are the function that they tabulate; its weights are 1 but for the rounding of the shares.
    #[test]
    fn lanes_that_are_alike_weigh_one() {
        let angles: Vec<f64> = (0..=180).map(|i| f64::from(i).to_radians()).collect();
        let row: Vec<f64> = angles.iter().map(|a| 1.0 + 1000.0 * libm::exp(-50.0 * a)).collect();
        let phase =
            SpectralPhase::tabulated(&[400.0, 500.0, 700.0], &angles, &[row.clone(), row.clone(), row]);
        let phase = phase.unwrap();
        let lanes = PhaseLanes::Spectral(phase.at(&WAVELENGTHS));
        for i in 0..1000 {
            let u = [i as f32 / 1000.0, (i as f32 * 0.618).fract()];
            let weight = lanes.sample(Vec3::Z, u, Lanes::new(0.1, 1.0, 0.0, 3.0)).weight;
            let off = (weight - Lanes::new(1.0, 1.0, 0.0, 1.0)).abs().max_element();
            assert!(off < 3e-7, "{u:?}: {weight}");
        }
    }

    /// No light, light in the last lane only, light next to nothing: directions are directions and weights are numbers.
    #[test]
    fn no_throughput_makes_a_weight_that_is_not_a_number() {
        let least = f32::from_bits(1);
        let throughputs = [
            Lanes::ZERO,
            Lanes::W,
            Lanes::splat(least),
            Lanes::new(least, 1e30, 0.0, least),
            Lanes::new(1e-38, 0.0, 0.0, 1.0),
        ];
        for (name, phase) in SPECTRAL_EXAMPLES.iter() {
            let lanes = PhaseLanes::Spectral(phase.at(&WAVELENGTHS));
            for throughput in throughputs {
                for i in 0..64 {
                    let edge = [0.0, 1.0 - f32::EPSILON * 0.5, i as f32 / 64.0];
                    for u in edge.into_iter().flat_map(|u| edge.map(|v| [u, v])) {
                        let sample = lanes.sample(Vec3::Z, u, throughput);
                        let carried = throughput * sample.weight;
                        assert!(sample.wi.is_normalized() && sample.pdf_w.is_finite(), "{name} {throughput}");
                        assert!(carried.is_finite(), "{name} {throughput}: {}", sample.weight);
                        let most = throughput.element_sum() * 1.001 + 4.0 * least;
                        assert!(carried.element_sum() <= most, "{name} {throughput} becomes {carried}");
                    }
                }
            }
        }
        assert_eq!(SPECTRAL_EXAMPLES.len(), 6);
    }
}
