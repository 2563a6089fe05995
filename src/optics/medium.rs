//! What fills a region: how it bends, absorbs, scatters and emits light.
//!
//! A medium that emits adds sigma_a n^2 Le to the radiance along each metre, Le being the radiance that an endless depth
//! of it would show in a medium of index 1 (Kirchhoff; L / n^2 is what boundaries leave alone). Along a way of which
//! nothing else is added,
//!
//! ```text
//! L = n^2 Le sigma_a / sigma_t (1 - exp(-sigma_t d))
//! ```
//! An ambient radiance that is scattered in from all around adds to it in the same way, with sigma_s for sigma_a.

use glam::Vec4;

use super::density::Density;
use super::phase::MediumPhase;
use crate::geometry::elementary::{exp4, ln_1p, minus_ln_of_rest, one_minus_exp4};
use crate::spectrum::{LaneCurve, Lanes, Wavelengths};

/// Index of a medium in its scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MediumId(pub u16);

/// A medium.
#[derive(Clone, Debug)]
pub struct Medium {
    /// Its name in the scene file.
    pub name: String,
    /// Refractive index at the reference wavelength.
    pub n: f32,
    /// Absorption coefficient in 1/m.
    pub sigma_a: LaneCurve,
    /// Scattering coefficient in 1/m.
    pub sigma_s: LaneCurve,
    /// Le: the radiance of an endless depth that does not scatter, over n^2.
    pub emission: LaneCurve,
    /// Where scattered light goes.
    pub phase: MediumPhase,
    /// What both coefficients are multiplied by from place to place.
    pub density: Density,
}

/// A medium's coefficients at the wavelengths of one path.
#[derive(Clone, Copy, Debug)]
pub struct MediumLanes {
    /// Scattering in 1/m.
    pub sigma_s: Lanes,
    /// Extinction (absorption and scattering) in 1/m.
    pub sigma_t: Lanes,
    /// What flights through nearly grey media are drawn with, in 1/m: the least extinction of the lanes that carry light,
    /// or the least scattering where next to nothing is absorbed.
    least: f32,
    /// 1 over that.
    mean_free_path: f32,
    /// Scattering over it.
    albedo: Lanes,
    /// Extinction above that: with its digits where it is little, as all that is absorbed in a mile of ice may be.
    excess: Lanes,
    /// True when any lane scatters.
    pub scatters: bool,
    /// True when no lane loses anything.
    pub clear: bool,
    /// True when all lanes that carry light have one extinction, but for [`GREY`] of it.
    grey: bool,
}

/// Relative spread of extinctions below which all free flights are drawn from the least of them.
///
/// A collision's weight is then off by as much in each lane, and the product of n of them by sqrt(n) times as much: 3 % at
/// a thousand collisions, a quarter where the roulette of long walks begins. In exchange a flight depends on nothing
/// that the path has been through, and its lane need not be chosen: walks are 1.6 times as fast.
const GREY: f32 = 1e-3;

/// How far light goes before it meets a particle.
///
/// Distances here and in [`MediumLanes`] are metres of density 1: lengths in the sense of [`Density`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeFlight {
    /// Distance in metres; infinite where nothing is in the way.
    pub distance: f32,
    /// Selection probabilities of the lanes.
    probabilities: Lanes,
}

impl Medium {
    /// The coefficients at the wavelengths of a path.
    pub fn lanes(&self, wavelengths: &Wavelengths) -> MediumLanes {
        let sigma_s = self.sigma_s.lanes(wavelengths);
        let sigma_a = self.sigma_a.lanes(wavelengths);
        let sigma_t = sigma_a + sigma_s;
        let of_light =
            |sigma: Lanes| if *wavelengths == Wavelengths::RGB { sigma.with_w(sigma.x) } else { sigma };
        let most = of_light(sigma_t).max_element();
        // What scatters next to all that it meets is flown through as if it did scatter all.
        let scattered = of_light(sigma_s).min_element();
        let is_clear = scattered > 0.0 && most - scattered <= GREY * scattered;
        let (of_flights, least) = match is_clear {
            true => (sigma_s, scattered),
            false => (sigma_t, of_light(sigma_t).min_element()),
        };
        let absorbed = if is_clear { sigma_a } else { Lanes::ZERO };
        MediumLanes {
            sigma_s,
            sigma_t,
            least,
            // Of less than 1e-38 per metre the inverse would be infinite, and 0 times it no number.
            mean_free_path: (1.0 / least).min(f32::MAX),
            albedo: sigma_s / least,
            excess: (of_flights - least).max(Vec4::ZERO) + absorbed,
            scatters: sigma_s != Lanes::ZERO,
            clear: sigma_t == Lanes::ZERO,
            grey: least > 0.0 && most - least <= GREY * least,
        }
    }

    /// sigma_s (1 - g) in 1/m: the scattering of what is similar at order 1 ([`super::similarity`]).
    pub fn reduced_scattering(&self) -> LaneCurve {
        self.sigma_s.combined(&self.phase.mean_cosine(), |s, g| s * (1.0 - g))
    }

    /// True when it takes more from light in some places than in others.
    pub fn is_heterogeneous(&self) -> bool {
        let clear = self.sigma_a.is_zero() && self.sigma_s.is_zero();
        !clear && !self.density.is_homogeneous()
    }

    /// True when it adds light to a path.
    pub fn glows(&self) -> bool {
        !self.emission.is_zero() && !self.sigma_a.is_zero()
    }

    /// n^2 (Le sigma_a + L_ambient sigma_s) / sigma_t: what an endless depth adds to the radiance of a way.
    pub fn source(&self, wavelengths: &Wavelengths, ambient: Lanes) -> Lanes {
        if !self.glows() && ambient == Lanes::ZERO {
            return Lanes::ZERO;
        }
        let sigma_a = self.sigma_a.lanes(wavelengths);
        let sigma_s = self.sigma_s.lanes(wavelengths);
        let sigma_t = sigma_a + sigma_s;
        let share = |sigma: Vec4| Vec4::select(sigma.cmpgt(Vec4::ZERO), sigma / sigma_t, Vec4::ZERO);
        let added = self.emission.lanes(wavelengths) * share(sigma_a) + ambient * share(sigma_s);
        added * (self.n * self.n)
    }
}

impl FreeFlight {
    /// Probability of a distance below `length`, over all lanes.
    pub fn probability_within(&self, medium: &MediumLanes, length: f32) -> f32 {
        (self.probabilities * medium.flights_within(length)).element_sum()
    }

    /// Probability of a distance beyond `length`, over all lanes.
    pub fn probability_beyond(&self, medium: &MediumLanes, length: f32) -> f32 {
        (self.probabilities * transmittance(medium.of_flights(), length)).element_sum()
    }
}

impl MediumLanes {
    /// exp(-sigma_t d), Bouguer's law.
    #[inline]
    pub fn transmittance(&self, distance: f32) -> Lanes {
        if self.clear {
            return Lanes::ONE;
        }
        transmittance(self.sigma_t, distance)
    }

    /// 1 - exp(-sigma_t d): what is lost on the way, with its digits where that is little.
    #[inline]
    pub fn opacity(&self, distance: f32) -> Lanes {
        opacity(self.sigma_t, distance)
    }

    /// Samples a distance in one lane, chosen in proportion to `throughput` `[WILKIE14]`; of nearly grey media in the
    /// clearest one.
    #[inline(always)]
    pub fn free_flight(&self, throughput: Lanes, u: f32) -> FreeFlight {
        if self.grey {
            let distance = minus_ln_of_rest(u) * self.mean_free_path;
            return FreeFlight { distance, probabilities: Lanes::ZERO };
        }
        let probabilities = throughput / throughput.element_sum();
        let (lane, u) = pick(probabilities, u);
        let sigma_t = self.sigma_t[lane];
        let distance = if sigma_t > 0.0 { minus_ln_of_rest(u) / sigma_t } else { f32::INFINITY };
        FreeFlight { distance, probabilities }
    }

    /// What flights are drawn with, lane by lane, in 1/m.
    fn of_flights(&self) -> Lanes {
        if self.grey { Lanes::splat(self.least) } else { self.sigma_t }
    }

    /// Share of the flights of each lane that end within a length.
    fn flights_within(&self, length: f32) -> Lanes {
        opacity(self.of_flights(), length)
    }

    /// Samples a distance below `length` as [`MediumLanes::free_flight`] does, on condition that it is below.
    pub fn free_flight_within(&self, throughput: Lanes, length: f32, u: f32) -> FreeFlight {
        let weights = if self.grey { Lanes::X } else { throughput };
        let probabilities = weights / weights.element_sum();
        let within = self.flights_within(length);
        let (lane, u) = pick(probabilities * within / (probabilities * within).element_sum(), u);
        let sigma = self.of_flights()[lane];
        let distance = if sigma > 0.0 { -ln_1p(-u * within[lane]) / sigma } else { f32::INFINITY };
        FreeFlight { distance: distance.min(length), probabilities }
    }

    /// Weight of a path that scatters at the sampled distance: sigma_s T over the density summed over all lanes.
    #[inline(always)]
    pub fn scatter_weight(&self, flight: &FreeFlight) -> Lanes {
        if self.grey {
            return self.albedo * self.relative_transmittance(flight.distance);
        }
        let transmittance = self.transmittance(flight.distance);
        let pdf_d = (flight.probabilities * self.sigma_t * transmittance).element_sum();
        if pdf_d > 0.0 { self.sigma_s * transmittance / pdf_d } else { Lanes::ZERO }
    }

    /// Of nearly grey media only: 1 over what flights are drawn with, in metres, and the weight of a collision but for
    /// [`MediumLanes::relative_transmittance`]. Flights of all lanes are drawn with the least extinction of them, or with
    /// the least scattering where next to nothing is absorbed.
    #[inline]
    pub fn grey(&self) -> Option<(f32, Lanes)> {
        self.grey.then_some((self.mean_free_path, self.albedo))
    }

    /// exp(-(sigma_t - sigma_f) d) of nearly grey media, sigma_f being what flights are drawn with: what is absorbed on
    /// the way is part of it where that is the least scattering.
    #[inline]
    pub fn relative_transmittance(&self, distance: f32) -> Lanes {
        /// The first term of the series that is left out is x^4 / 24: 7e-9.
        const SMALL: f32 = 0.02;
        let x = self.excess * distance;
        if x.max_element() < SMALL {
            return Vec4::ONE - x * (Vec4::ONE - x * (Vec4::splat(0.5) - x * (1.0 / 6.0)));
        }
        exp4(-Vec4::select(self.excess.cmpeq(Vec4::ZERO), Vec4::ZERO, x))
    }

    /// Weight of a path that reaches a surface at `distance`, nearer than the sampled one: T over the probability of
    /// getting that far, summed over all lanes.
    #[inline]
    pub fn pass_weight(&self, flight: &FreeFlight, distance: f32) -> Lanes {
        if self.grey {
            return self.relative_transmittance(distance);
        }
        let transmittance = self.transmittance(distance);
        let probability = (flight.probabilities * transmittance).element_sum();
        if probability > 0.0 { transmittance / probability } else { Lanes::ZERO }
    }
}

/// exp(-sigma d); 0 times infinity is a clear lane: nothing is lost there however far the light goes.
#[inline]
fn transmittance(sigma: Lanes, distance: f32) -> Lanes {
    exp4(-Vec4::select(sigma.cmpeq(Vec4::ZERO), Vec4::ZERO, sigma * distance))
}

/// 1 - exp(-sigma d); a clear lane loses nothing however far the light goes.
#[inline]
fn opacity(sigma: Lanes, distance: f32) -> Lanes {
    one_minus_exp4(Vec4::select(sigma.cmpeq(Vec4::ZERO), Vec4::ZERO, sigma * distance))
}

/// A lane at `u` of weights that sum to 1, and where in its share u lies, below 1.
#[inline]
pub(super) fn pick(weights: Lanes, u: f32) -> (usize, f32) {
    let mut lane = 0;
    let mut rest = u;
    while lane < 3 && rest >= weights[lane] {
        rest -= weights[lane];
        lane += 1;
    }
    // Rounding may run past the last lane that has any weight.
    while lane > 0 && weights[lane] == 0.0 {
        lane -= 1;
    }
    (lane, (rest / weights[lane]).min(1.0 - f32::EPSILON * 0.5))
}

#[cfg(test)]
mod tests {
    use super::super::phase::{Isotropic, PhaseFunction, SpectralPhase};
    use super::*;
    use crate::spectrum::Spectrum;

    fn medium(sigma_a: LaneCurve, sigma_s: LaneCurve) -> Medium {
        Medium {
            name: "ice".into(),
            n: 1.31,
            sigma_a,
            sigma_s,
            emission: LaneCurve::Constant(0.0),
            phase: PhaseFunction::Isotropic(Isotropic).into(),
            density: Density::Homogeneous,
        }
    }

    /// What is not scattered is absorbed.
    fn lanes_of(sigma_t: [f32; 3], sigma_s: f32) -> MediumLanes {
        let curve = |values: [f32; 3]| LaneCurve::Rgb(Vec4::new(values[0], values[1], values[2], 0.0));
        medium(curve(sigma_t.map(|s| s - sigma_s)), curve([sigma_s; 3])).lanes(&Wavelengths::RGB)
    }

    /// The share of the distances below x is that which free flights have below x, over that below the length.
    #[test]
    fn flights_within_a_length_are_free_flights_that_end_there() {
        for (sigma_t, sigma_s) in
            [([0.01, 0.5, 3.0], 0.01), ([3.0, 3.001, 3.002], 0.01), ([3.0, 3.001, 3.002], 2.9999)]
        {
            let medium = lanes_of(sigma_t, sigma_s);
            let throughput = Vec4::new(3.0, 1.0, 0.5, 0.0);
            for length in [0.01, 1.0, 100.0, f32::INFINITY] {
                // 4096 midpoints in three lanes miss a share by at most a point in each.
                let flights: Vec<FreeFlight> = (0..4096)
                    .map(|i| medium.free_flight_within(throughput, length, (i as f32 + 0.5) / 4096.0))
                    .collect();
                for x in [0.1, 0.3, 0.9].map(|share: f32| share * length.min(200.0)) {
                    let below = flights.iter().filter(|f| f.distance < x).count() as f32 / 4096.0;
                    let within = |d| flights[0].probability_within(&medium, d);
                    let expected = within(x) / within(length);
                    assert!((below - expected).abs() < 3.0 / 4096.0, "{length} {x}: {below} {expected}");
                }
                let both = flights[0].probability_within(&medium, length)
                    + flights[0].probability_beyond(&medium, length);
                assert!((both - 1.0).abs() < 1e-6 && flights.iter().all(|f| f.distance <= length));
                // The weights of what is scattered within, and of what passes, are those of each lane.
                let scattered: Vec4 = flights.iter().map(|f| medium.scatter_weight(f)).sum();
                let scattered = scattered * flights[0].probability_within(&medium, length) / 4096.0;
                let expected = medium.sigma_s / medium.sigma_t * medium.opacity(length);
                let off = ((scattered - expected) / expected).truncate().abs();
                assert!(off.max_element() < 4e-3, "{sigma_t:?} {length}: {scattered} {expected}");
            }
        }
    }

    /// Means over the random number are integrals over the distance: sigma_s / sigma_t of the weights of collisions, and
    /// exp(-sigma_t d) of reaching d, in each lane. The midpoint rule over n numbers is good to 1 / n.
    #[test]
    fn flights_of_grey_and_coloured_media_have_the_means_of_every_lane() {
        for (sigma_t, sigma_s, grey) in [
            ([870.12_f32, 870.02, 870.0], 500.0, true),
            ([870.12, 870.02, 870.0], 869.9, true),
            ([900.0, 870.0, 600.0], 500.0, false),
        ] {
            let lanes = lanes_of(sigma_t, sigma_s);
            assert_eq!(lanes.grey, grey);
            let (n, reach) = (100_000, 0.001);
            let (mut collided, mut reached) = (Vec4::ZERO.as_dvec4(), Vec4::ZERO.as_dvec4());
            for i in 0..n {
                let u = (i as f32 + 0.5) / n as f32;
                let flight = lanes.free_flight(Vec4::new(0.5, 1.0, 0.2, 0.0), u);
                collided += lanes.scatter_weight(&flight).as_dvec4() / f64::from(n);
                if flight.distance > reach {
                    reached += lanes.pass_weight(&flight, reach).as_dvec4() / f64::from(n);
                }
            }
            for lane in 0..3 {
                let sigma_t = f64::from(sigma_t[lane]);
                let expected = [f64::from(sigma_s) / sigma_t, libm::exp(-sigma_t * f64::from(reach))];
                for (mean, expected) in [collided[lane], reached[lane]].into_iter().zip(expected) {
                    // Three lanes have three ends of the range and of the reach.
                    assert!((mean - expected).abs() < 1e-4, "lane {lane}: {mean} {expected}");
                }
            }
        }
    }

    /// A thousand collisions of a medium that absorbs next to nothing, one by one: the product of their weights is what the
    /// flights have come through, exp(-sum of sigma_a d). A weight is rounded to 2^-24 of 1: of what flights of even chance
    /// lose, 1e-7 in the mean, these roundings leave all but 2 %; where the extinction stands for the sum of absorption and
    /// scattering, as in f32 it may, half of it or more is lost.
    #[test]
    fn what_is_absorbed_next_to_nothing_is_absorbed() {
        for absorbed in [1e-7_f32, 3e-7, 1e-6] {
            let curve = |value| LaneCurve::Constant(value);
            let lanes = medium(curve(absorbed * 870.0), curve(870.0)).lanes(&Wavelengths::RGB);
            let (mut throughput, mut length) = (Vec4::ONE, 0.0);
            for i in 0..100_000_u32 {
                let u = (f64::from(i) * 0.618_033_988_749_895).fract() as f32;
                let flight = lanes.free_flight(throughput, u);
                throughput *= lanes.scatter_weight(&flight);
                length += f64::from(flight.distance);
            }
            let expected = -libm::expm1(-length * f64::from(absorbed) * 870.0);
            let got = 1.0 - f64::from(throughput.x);
            assert!((got / expected - 1.0).abs() < 0.03, "{absorbed}: {got} {expected}");
        }
    }

    /// sigma_s (1 - g), each wavelength with its own g.
    #[test]
    fn scattering_is_reduced_lane_by_lane() {
        let g = Spectrum::Table { wavelengths: vec![400.0, 500.0], values: vec![-0.5, 0.9] };
        let phase = SpectralPhase::henyey_greenstein(g).unwrap().into();
        let medium = Medium { phase, ..medium(LaneCurve::Constant(0.0), LaneCurve::Constant(10.0)) };
        let wavelengths = Wavelengths { lambda: [400.0, 450.0, 500.0, 600.0], pdf: [1.0; 4] };
        let off = medium.reduced_scattering().lanes(&wavelengths) - Vec4::new(15.0, 8.0, 1.0, 1.0);
        assert!(off.abs().max_element() < 1e-5, "{off}");
    }
}
