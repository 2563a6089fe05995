//! Random walks that are led to the surface that they came in through: Dwivedi's sampling.
//!
//! Deep in a half space light falls off as exp(-kappa z), z being the depth, and its angular distribution is Case's
//! eigenfunction. Walks that pretended to live in that light would leave with next to no variance `[KRIVANEK14]`. With
//! w_z the cosine of a direction with the outward normal and c the albedo,
//!
//! ```text
//! D(w)   = 1 / (2 pi ln((nu + 1) / (nu - 1)) (nu - w_z)),   1 = (c nu / 2) ln((nu + 1) / (nu - 1))
//! sigma' = sigma_t (1 - w_z / nu) = sigma_t - kappa w_z,    kappa = sigma_t / nu
//! nu^-2  = 1 - c^(2.44294 - 0.0215813 c + 0.578637 / c)                                      within 1e-4
//! ```
//! are the density of directions and the extinction that their free flights are drawn with.
//!
//! Where scattering is not even the phase function p has a part in the directions, or else the weights of long walks
//! spread without bound. Led directions w are then drawn from p, tilted outwards; after `[KRIVANEK14]`'s equation for the
//! importance phi of directions, (1 - w_z / nu) phi = c (integral of p phi), its first two moments are in the ratio
//! 3 phi_1 / phi_0 = 3 nu (1 - c), and so, travelling along w' before,
//!
//! ```text
//! D(w) = p(w) (1 + b w_z) / (1 + b g w'_z),   b = 3 sigma_a / kappa, at most STEEPEST
//! kappa = sigma_t* / nu(c*),   sigma_s* = sigma_s (1 - g)
//! ```
//! with the kappa of what is similar at order 1 ([`super::similarity`]). The integral of p(w) w_z is g w'_z, so D is
//! normalised exactly, of whichever b and phase function.
//!
//! Real surfaces are bent, light comes from elsewhere and lanes differ. So a direction is drawn from D of a lane with
//! probability [`SHARE`], else from p, and its free flight with the same lane's sigma' or sigma_t. Both together are
//! weighted by the balance heuristic over all lanes and both strategies; P are the lanes' selection probabilities and f is
//! the phase function's value:
//!
//! ```text
//! pdf(w, s)  = sum of P [SHARE D(w) sigma' exp(-sigma' s) + (1 - SHARE) p(w) sigma_t exp(-sigma_t s)]
//! collision: f(w) sigma_s exp(-sigma_t s) / pdf(w, s)
//! surface:   f(w) exp(-sigma_t d) / (sum of P [SHARE D(w) exp(-sigma' d) + (1 - SHARE) p(w) exp(-sigma_t d)])
//! ```

use glam::{Vec3, Vec4};

use super::medium::{MediumLanes, pick};
use super::phase::{Deflection, PhaseFunction, PhaseSample};
use crate::geometry::Frame;
use crate::geometry::elementary::{exp, exp4, ln, sin_cos_of_turn};
use crate::sampling::SampleStream;
use crate::spectrum::Lanes;

/// Probability with which a direction is led to the surface.
pub const SHARE: f32 = 0.75;

/// The albedo below which nu is that of this one: it is within a thousandth of 1 there.
const LEAST_ALBEDO: f32 = 0.25;
/// The albedo above which nu is that of this one.
const MOST_ALBEDO: f32 = 0.9999;

/// The greatest b: most directions that are drawn are taken.
const STEEPEST: f32 = 0.9;

/// How the walks of a medium are led, in each lane.
#[derive(Clone, Copy, Debug)]
pub struct Dwivedi {
    /// nu - 1: nu itself has no digits left next to 1.
    beyond_one: Lanes,
    /// ln((nu + 1) / (nu - 1)).
    rate: Lanes,
    /// sigma_t / nu in 1/m.
    kappa: Lanes,
    sigma_t: Lanes,
    /// b, and the phase function's mean cosine; none where scattering is even.
    tilt: Option<(Lanes, f32)>,
}

/// A vertex whose path is to be led outwards.
#[derive(Clone, Copy, Debug)]
pub struct Led {
    dwivedi: Dwivedi,
    forward: Vec3,
    outward: Vec3,
    /// Selection probabilities of the lanes.
    probabilities: Lanes,
}

/// The free flight that belongs to a direction drawn by [`Led::sample`]; it has the direction's weight.
#[derive(Clone, Copy, Debug)]
pub struct LedFlight {
    /// The lanes' shares in the density of the direction over the phase function's value: of D, and of p.
    led: Lanes,
    free: Lanes,
    /// sigma' in 1/m.
    stretched: Lanes,
    /// The extinction that the distance is drawn with, in 1/m; 0 without a flight.
    drawn: f32,
}

impl Dwivedi {
    /// That of a medium with this phase function.
    pub fn new(medium: &MediumLanes, phase: &PhaseFunction) -> Self {
        let g = phase.mean_cosine();
        let reduced_s = medium.sigma_s * (1.0 - g);
        let reduced_t = medium.sigma_t - medium.sigma_s * g;
        let share = |a: Vec4, b: Vec4| Vec4::select(b.cmpgt(Vec4::ZERO), a / b, Vec4::ZERO);
        let albedo = share(reduced_s, reduced_t);
        let reduced = albedo.clamp(Vec4::splat(LEAST_ALBEDO), Vec4::splat(MOST_ALBEDO));
        let least = beyond_one(Vec4::splat(LEAST_ALBEDO));
        let beyond = beyond_one(reduced);
        // nu = nu* sigma_t / sigma_t*.
        let wider = share(medium.sigma_t - reduced_t, reduced_t);
        let beyond = (beyond * (Vec4::ONE + wider) + wider).max(least);
        let rate = Vec4::from_array(((beyond + 2.0) / beyond).to_array().map(ln));
        let kappa = medium.sigma_t / (beyond + 1.0);
        let b = (share(medium.sigma_t - medium.sigma_s, kappa) * 3.0).min(Vec4::splat(STEEPEST));
        let tilt = (!matches!(phase, PhaseFunction::Isotropic(_))).then_some((b, g));
        Self { beyond_one: beyond, rate, kappa, sigma_t: medium.sigma_t, tilt }
    }

    /// D(w) of each lane at the cosine with the outward normal.
    #[inline]
    pub fn pdf_w(&self, cosine: f32) -> Lanes {
        (self.rate * (self.beyond_one + (1.0 - cosine)) * std::f32::consts::TAU).recip()
    }

    /// The cosine that belongs to a random number in [0, 1) in one lane.
    pub fn sample_cosine(&self, lane: usize, u: f32) -> f32 {
        let beyond_one = self.beyond_one[lane];
        // nu - w_z, which falls from nu + 1 to nu - 1.
        let below = (beyond_one + 2.0) * exp(-self.rate[lane] * u);
        (1.0 + (beyond_one - below)).clamp(-1.0, 1.0)
    }

    /// At a vertex of a path along `forward` of this throughput, with this outward normal.
    #[inline]
    pub fn at(&self, forward: Vec3, outward: Vec3, throughput: Lanes) -> Led {
        Led { dwivedi: *self, forward, outward, probabilities: throughput / throughput.element_sum() }
    }
}

/// kappa in 1/m of isotropic scattering, or of what is similar to it.
pub fn decay(sigma_s: f32, sigma_a: f32) -> f32 {
    let sigma_t = sigma_s + sigma_a;
    if sigma_s <= 0.0 {
        return sigma_t;
    }
    let albedo = Vec4::splat((sigma_s / sigma_t).clamp(LEAST_ALBEDO, MOST_ALBEDO));
    sigma_t / (1.0 + beyond_one(albedo).x)
}

/// nu - 1 of an albedo of isotropic scattering.
fn beyond_one(albedo: Vec4) -> Vec4 {
    let exponent = Vec4::splat(2.442_94) - albedo * 0.021_581_3 + Vec4::splat(0.578_637) / albedo;
    let power = exp4(exponent * Vec4::from_array(albedo.to_array().map(ln)));
    let inverse = Vec4::from_array((Vec4::ONE - power).to_array().map(f32::sqrt));
    power / (inverse * (Vec4::ONE + inverse))
}

impl Led {
    /// Density of [`Led::sample`] for a direction, of which the phase function has the density `phase_w`.
    #[inline]
    pub fn pdf_w(&self, wi: Vec3, phase_w: f32) -> f32 {
        let led = (self.probabilities * self.led_pdf_w(wi.dot(self.outward), phase_w)).element_sum();
        SHARE * led + (1.0 - SHARE) * phase_w
    }

    /// Density of led directions in each lane at the cosine with the outward normal.
    #[inline]
    fn led_pdf_w(&self, cosine: f32, phase_w: f32) -> Lanes {
        match self.dwivedi.tilt {
            None => self.dwivedi.pdf_w(cosine),
            Some((b, g)) => {
                (b * cosine + Vec4::ONE) * phase_w / (b * (g * self.forward.dot(self.outward)) + Vec4::ONE)
            }
        }
    }

    /// A new direction, and the flight that has its weight; the sample's own
    /// is 1, or 0 where no light is scattered.
    pub fn sample(&self, phase: &PhaseFunction, stream: &mut SampleStream) -> (PhaseSample, LedFlight) {
        let u = stream.next4();
        let (lane, choice) = pick(self.probabilities, u[0]);
        let is_led = choice < SHARE;
        let wi = match self.dwivedi.tilt {
            None if is_led => self.direction(lane, [u[1], u[2]]),
            Some((b, _)) if is_led => self.tilted(phase, b[lane], u, stream),
            _ => phase.sample(self.forward, [u[1], u[2]]).wi,
        };
        let turned = Deflection::between(self.forward, wi);
        let (value, phase_w) = (phase.value(turned), phase.pdf_w(turned));
        let cosine = wi.dot(self.outward);
        let led = self.probabilities * self.led_pdf_w(cosine, phase_w) * SHARE;
        let free = self.probabilities * (phase_w * (1.0 - SHARE));
        let stretched = self.dwivedi.sigma_t - self.dwivedi.kappa * cosine;
        let (scale, weight) = if value > 0.0 { (value.recip(), 1.0) } else { (1.0, 0.0) };
        let drawn = if is_led { stretched[lane] } else { self.dwivedi.sigma_t[lane] };
        let pdf_w = (led + free).element_sum();
        (
            PhaseSample { wi, weight, pdf_w },
            LedFlight { led: led * scale, free: free * scale, stretched, drawn },
        )
    }

    /// Directions of the phase function, of which a share in proportion to 1 + b w_z is taken.
    fn tilted(&self, phase: &PhaseFunction, b: f32, mut u: [f32; 4], stream: &mut SampleStream) -> Vec3 {
        loop {
            let wi = phase.sample(self.forward, [u[1], u[2]]).wi;
            if u[3] * (1.0 + b) < 1.0 + b * wi.dot(self.outward) {
                return wi;
            }
            u = stream.next4();
        }
    }

    fn direction(&self, lane: usize, u: [f32; 2]) -> Vec3 {
        let cosine = self.dwivedi.sample_cosine(lane, u[0]);
        let sine = (1.0 - cosine * cosine).sqrt();
        let (sin, cos) = sin_cos_of_turn(u[1]);
        Frame::around(self.outward).to_world(Vec3::new(sine * cos, sine * sin, cosine)).normalize()
    }
}

impl Default for LedFlight {
    fn default() -> Self {
        Self::NONE
    }
}

impl LedFlight {
    /// No flight.
    pub const NONE: Self = Self { led: Vec4::ZERO, free: Vec4::ZERO, stretched: Vec4::ZERO, drawn: 0.0 };

    /// False without a flight.
    #[inline]
    pub fn is_there(&self) -> bool {
        self.drawn > 0.0
    }

    /// The distance in metres that belongs to a random number in [0, 1).
    pub fn distance(&self, u: f32) -> f32 {
        -ln(1.0 - u) / self.drawn
    }

    /// Weight of a path that scatters at the sampled distance.
    pub fn scatter_weight(&self, medium: &MediumLanes, distance: f32) -> Lanes {
        let transmittance = medium.transmittance(distance);
        let led = self.led * self.stretched * exp4(-self.stretched * distance);
        let pdf = (led + self.free * medium.sigma_t * transmittance).element_sum();
        if pdf > 0.0 { medium.sigma_s * transmittance / pdf } else { Lanes::ZERO }
    }

    /// Weight of a path that reaches a surface at `distance`, nearer than the sampled one.
    pub fn pass_weight(&self, medium: &MediumLanes, distance: f32) -> Lanes {
        let transmittance = medium.transmittance(distance);
        let led = self.led * exp4(-self.stretched * distance);
        let pdf = (led + self.free * transmittance).element_sum();
        if pdf > 0.0 { transmittance / pdf } else { Lanes::ZERO }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::density::Density;
    use crate::optics::medium::Medium;
    use crate::optics::phase::{HenyeyGreenstein, Isotropic, Rayleigh};
    use crate::sampling::{SampleSeed, warp};
    use crate::spectrum::{LaneCurve, Wavelengths};
    use glam::DVec4;

    const THROUGHPUT: Vec4 = Vec4::new(0.3, 1.0, 0.6, 0.0);

    fn phases() -> [PhaseFunction; 4] {
        [
            PhaseFunction::Isotropic(Isotropic),
            PhaseFunction::Rayleigh(Rayleigh),
            PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g: 0.86 }),
            PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g: -0.4 }),
        ]
    }

    fn lanes_of(albedos: [f32; 3], phase: &PhaseFunction) -> MediumLanes {
        let curve = |values: [f32; 3]| LaneCurve::Rgb(Vec4::new(values[0], values[1], values[2], 0.0));
        let medium = Medium {
            name: "milk".into(),
            n: 1.0,
            sigma_a: curve(albedos.map(|albedo| 1.0 - albedo)),
            sigma_s: curve(albedos),
            emission: LaneCurve::Constant(0.0),
            phase: phase.clone().into(),
            density: Density::Homogeneous,
        };
        medium.lanes(&Wavelengths::RGB)
    }

    fn stream(i: u32) -> SampleStream {
        SampleStream::new(SampleSeed::new(5), i, 0, 0)
    }

    /// (c nu / 2) ln((nu + 1) / (nu - 1)) - 1 is off by what the fit is: 0.002 of nu - 1 from an albedo of 0.5 on.
    #[test]
    fn nu_solves_its_equation() {
        for albedo in [0.5, 0.7, 0.9, 0.99, 0.999] {
            let dwivedi = Dwivedi::new(&lanes_of([albedo; 3], &phases()[0]), &phases()[0]);
            let beyond_one = f64::from(dwivedi.beyond_one.x);
            let c = f64::from(albedo);
            let one = 0.5 * c * (1.0 + beyond_one) * libm::log((2.0 + beyond_one) / beyond_one);
            assert!((one - 1.0).abs() < 1e-3, "{albedo}: {one}");
        }
    }

    /// The share of cosines below x is ln((nu + 1) / (nu - x)) / ln((nu + 1) / (nu - 1)) from above, which is also the
    /// integral of the density. The midpoint rule over n cells of the peak's logarithm is good to its rounding.
    #[test]
    fn cosines_are_drawn_from_their_density() {
        for albedo in [0.05, 0.3, 0.9, 0.999_99] {
            let dwivedi = Dwivedi::new(&lanes_of([albedo; 3], &phases()[0]), &phases()[0]);
            let n = 1000;
            let mut sum = 0.0;
            for i in 0..n {
                let [from, at, to] = [0.0, 0.5, 1.0].map(|k| (i as f32 + k) / n as f32);
                let [from, at, to] = [from, at, to].map(|u| dwivedi.sample_cosine(1, u));
                // Cells of equal probability hold 1 / n each.
                let held =
                    f64::from(dwivedi.pdf_w(at).y * std::f32::consts::TAU) * f64::from(to - from).abs();
                sum += held;
                // Rounding of a cosine next to 1, of which nu is 7e-4 away at least; elsewhere the width of a cell.
                assert!((held * f64::from(n) - 1.0).abs() < 0.05, "albedo {albedo}, cell {i}: {held}");
            }
            assert!((sum - 1.0).abs() < 1e-3, "albedo {albedo}: {sum}");
        }
    }

    /// Integrals over all directions and distances, each by drawing from the density itself: what is scattered is the albedo
    /// in each lane, what passes d is exp(-sigma_t d), and the density of directions is 1 in all.
    #[test]
    fn led_flights_have_the_means_of_every_lane() {
        let outward = Vec3::new(0.6, 0.0, 0.8);
        for (phase, forward) in phases().iter().flat_map(|p| [(p, Vec3::NEG_Z), (p, outward)]) {
            let albedos = [0.4, 0.9, 0.99];
            let medium = lanes_of(albedos, phase);
            let led = Dwivedi::new(&medium, phase).at(forward, outward, THROUGHPUT);
            let (n, reach) = (100_000, 0.7);
            let mut sums = [[DVec4::ZERO; 2]; 2];
            for i in 0..n {
                let mut stream = stream(i);
                let (turned, flight) = led.sample(phase, &mut stream);
                let phase_w = phase.pdf_w(Deflection::between(forward, turned.wi));
                let pdf_w = led.pdf_w(turned.wi, phase_w);
                assert!((pdf_w / turned.pdf_w - 1.0).abs() < 1e-4, "{pdf_w} {}", turned.pdf_w);
                let distance = flight.distance(stream.next4()[0]);
                let passed = if distance > reach { flight.pass_weight(&medium, reach) } else { Vec4::ZERO };
                for (sum, weight) in sums.iter_mut().zip([flight.scatter_weight(&medium, distance), passed]) {
                    let weight = (weight * turned.weight).as_dvec4();
                    assert!(weight.is_finite());
                    sum[0] += weight / f64::from(n);
                    sum[1] += weight * weight / f64::from(n);
                }
            }
            let survived = libm::exp(-f64::from(reach));
            for lane in 0..3 {
                for (sum, expected) in sums.iter().zip([f64::from(albedos[lane]), survived]) {
                    let (mean, square) = (sum[0][lane], sum[1][lane]);
                    let se = ((square - mean * mean) / f64::from(n)).sqrt();
                    let off = (mean - expected).abs();
                    assert!(
                        se < 0.01 && off < 5.0 * se,
                        "{phase:?}, lane {lane}: {mean} +- {se}, not {expected}"
                    );
                }
            }
        }
    }

    /// Over directions drawn evenly; g = 0.86 peaks at 8 per steradian, so 5 standard errors are 2 %.
    #[test]
    fn densities_of_directions_are_normalised() {
        let outward = Vec3::new(0.6, 0.0, 0.8);
        for phase in phases() {
            let led =
                Dwivedi::new(&lanes_of([0.4, 0.9, 0.99], &phase), &phase).at(Vec3::X, outward, THROUGHPUT);
            let n = 100_000;
            let (mut sum, mut square) = (0.0, 0.0);
            for i in 0..n {
                let u = stream(i).next4();
                let wi = warp::sphere([u[0], u[1]]);
                let value = f64::from(led.pdf_w(wi, phase.pdf_w(Deflection::between(Vec3::X, wi))));
                let value = value * 4.0 * std::f64::consts::PI;
                sum += value / f64::from(n);
                square += value * value / f64::from(n);
            }
            let se = ((square - sum * sum) / f64::from(n)).sqrt();
            assert!(se < 0.02 && (sum - 1.0).abs() < 5.0 * se, "{phase:?}: {sum} +- {se}");
        }
    }
}
