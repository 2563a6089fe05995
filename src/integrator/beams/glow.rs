//! Directions towards the glow around suns, as a turbid medium shows it.
//!
//! Particles that scatter forward send most of a sun's light on to where the sun itself seems to stand. Few of the directions that
//! a sand bed or other particles draw lead there, and those that do bring much. So a vertex in such a medium draws some of
//! its directions with the phase function about one of five directions of the brightest sun's refracted light, the mean and four
//! around it, and weighs by the mixture of all densities `[VEACH97 section 9.2.4]`:
//!
//! ```text
//! p = (1 - q) p_own + q sum_k p_phase(angle to w_k) / 5
//! ```
//! Roulette takes a path for what it would be without the mixture: what is drawn towards light is worth as much. A path that is
//! about to see much of the light goes on as several, as where roulette is played the other way round.

use std::f32::consts::PI;

use glam::Vec3;

use super::super::path::{Branch, Fate, Sample};
use super::SunBeams;
use crate::light::Sun;
use crate::optics::medium::Medium;
use crate::optics::phase::{Deflection, LanesSample, PhaseLanes};
use crate::scene::frame::Frame;
use crate::spectrum::Lanes;

/// Media of a greater mean cosine show a glow.
const FORWARD: f32 = 0.5;
/// q of the head on surfaces. In the scene of `tests/bench/hero` 0.4 is as good, and the glow as a whole leaves 0.6 of the time to
/// equal error.
const ON_SURFACES: f32 = 0.3;
/// q in volumes, whose own directions lead to the glow more often; 0.25 is worse by a tenth.
const IN_VOLUMES: f32 = 0.1;
/// One flight is enough where the vertex after it would return so much of what an eye path's first white surface does. In the
/// scene of `tests/bench/hero` further ones leave 0.82 of the variance in the same time, and half of the fireflies.
const WORTH_ANOTHER: f32 = 0.25;
/// Most flights after a vertex.
const MOST_WAYS: f32 = 8.0;
/// From where light comes: in the mean, and from where most of it does on each side.
pub(super) type Directions = [Vec3; LOBES];
const LOBES: usize = 5;

/// How directions towards the glow are drawn.
pub(in crate::integrator) struct Glow<'a> {
    from: Directions,
    share: f32,
    phase: PhaseLanes<'a>,
    throughput: Lanes,
}

/// From where the light of the brightest sun comes, in those of the media that its beams reach which show a glow around it.
pub(super) fn of_media(frame: &Frame, of_suns: &[SunBeams], reached: &[bool]) -> Vec<Option<Directions>> {
    let lit = |(sun, own): &(&Sun, &SunBeams)| !own.beams.is_empty() && sun.power() > 0.0;
    let brightest = frame.lights.suns.iter().zip(of_suns).filter(lit);
    let brightest = brightest.max_by(|a, b| a.0.power().total_cmp(&b.0.power())).map(|(_, own)| own.mean);
    let shows =
        |medium: &Medium| medium.sigma_s.maximum() > 0.0 && medium.phase.mean_cosine().maximum() > FORWARD;
    let media = frame.media.iter().zip(reached);
    media.map(|(medium, is_reached)| brightest.filter(|_| *is_reached && shows(medium))).collect()
}

impl<'a> Sample<'a> {
    /// For a path at a surface; none where the medium shows no glow, or it is behind the surface.
    #[inline]
    pub(in crate::integrator) fn glow_before(&self, branch: &Branch, ng: Vec3) -> Option<Glow<'a>> {
        self.glow(branch, ON_SURFACES).filter(|glow| glow.from[0].dot(ng) > 0.0)
    }

    /// The same for a path at a particle.
    #[inline]
    pub(in crate::integrator) fn glow_around(&self, branch: &Branch) -> Option<Glow<'a>> {
        self.glow(branch, IN_VOLUMES)
    }

    fn glow(&self, branch: &Branch, share: f32) -> Option<Glow<'a>> {
        let from = self.beams?.glow(branch.medium)?;
        let phase = self.frame.medium(branch.medium).phase.at(self.wavelengths);
        Some(Glow { from, share, phase, throughput: branch.throughput })
    }

    /// Roulette has been played for what the path would be alone; its own density over that of the mixture weighs it then, and
    /// one whose next vertex would return much of the glow's light goes on as several, each with a flight of its own: which
    /// caustics it crosses is chance.
    pub(in crate::integrator) fn of_mixture(
        &mut self,
        branch: &mut Branch,
        fate: Fate,
        glow: Option<&Glow>,
        own_share: f32,
    ) -> Fate {
        let Some(glow) = glow.filter(|_| fate == Fate::GoesOn) else { return fate };
        if own_share <= 0.0 {
            return Fate::Ends;
        }
        branch.throughput *= own_share;
        let worth = branch.weight() * glow.worth(branch.direction);
        let ways = (worth / WORTH_ANOTHER).ceil().clamp(1.0, MOST_WAYS);
        branch.throughput /= ways;
        branch.share /= ways;
        for way in 1..ways as u32 {
            self.scratch.branches.push(Branch { stream: branch.stream.fork(2 + way), ..*branch });
        }
        Fate::GoesOn
    }
}

impl Glow<'_> {
    /// How much of white a vertex would return, about, of light from where most of it comes.
    fn worth(&self, forward: Vec3) -> f32 {
        let of_lobe =
            |wi: Vec3| self.phase.value_and_pdf_w(Deflection::between(forward, wi), self.throughput).0;
        PI * self.from.map(|wi| of_lobe(wi).max_element()).into_iter().fold(0.0, f32::max)
    }

    /// A direction of the mixture, where `own` draws the vertex's own.
    pub(in crate::integrator) fn sample(&self, [x, y]: [f32; 2], own: impl Fn([f32; 2]) -> Vec3) -> Vec3 {
        let below_one = |x: f32| x.min(1.0 - 0.5 * f32::EPSILON);
        if x >= self.share {
            return own([below_one((x - self.share) / (1.0 - self.share)), y]);
        }
        let x = LOBES as f32 * below_one(x / self.share);
        self.phase.sample(self.from[x as usize], [x.fract(), y], self.throughput).wi
    }

    /// How a path goes on at a particle: weighed by its own density alone, and what that is over the mixture's.
    pub(in crate::integrator) fn turn(&self, forward: Vec3, u: [f32; 2]) -> (LanesSample, f32) {
        let (phase, throughput) = (&self.phase, self.throughput);
        let wi = self.sample(u, |u| phase.sample(forward, u, throughput).wi);
        let (value, own) = phase.value_and_pdf_w(Deflection::between(forward, wi), throughput);
        let weight = if own > 0.0 { value / own } else { Lanes::ZERO };
        let pdf_w = self.pdf_w(wi, own);
        (LanesSample { wi, weight, pdf_w, greatest: value.max_element() }, own / pdf_w)
    }

    /// Density of the mixture for a direction of the vertex's own density.
    pub(in crate::integrator) fn pdf_w(&self, wi: Vec3, own: f32) -> f32 {
        let of_lobe =
            |from: Vec3| self.phase.value_and_pdf_w(Deflection::between(from, wi), self.throughput).1;
        (1.0 - self.share) * own + self.share / LOBES as f32 * self.from.map(of_lobe).iter().sum::<f32>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::phase::{HenyeyGreenstein, MediumPhase, PhaseFunction};
    use crate::sampling::warp;
    use crate::spectrum::Wavelengths;

    /// 1024 x 1024 cells of equal solid angle. The mixture is normalised; the mean of value over density of what it draws is the
    /// integral of the value, and that of the cosine to an axis its first moment, with their signs: these hold for its own
    /// density and for one that it must not follow, within what 2^20 stratified numbers leave (measured: 2e-4).
    #[test]
    fn what_is_drawn_towards_the_glow_is_weighed_by_its_density() {
        let phase = MediumPhase::from(PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g: 0.9 }));
        let axis = Vec3::new(0.3, -0.2, 0.9).normalize();
        let tilted = [[0.0, 0.0], [0.2, 0.0], [-0.2, 0.0], [0.0, 0.3], [0.0, -0.3]];
        let from = tilted.map(|[x, y]| (axis + Vec3::new(x, y, 0.0)).normalize());
        let phase = phase.at(&Wavelengths::RGB);
        for share in [ON_SURFACES, IN_VOLUMES] {
            let glow = Glow { from, share, phase, throughput: Lanes::ONE };
            let cosine = |wi: Vec3| wi.z.max(0.0) * std::f32::consts::FRAC_1_PI;
            let (n, mut norm, mut whole, mut along) = (1024, 0.0_f64, 0.0_f64, 0.0_f64);
            for i in 0..n * n {
                let u = [(i % n) as f32 + 0.5, (i / n) as f32 + 0.5].map(|x| x / n as f32);
                let even = warp::sphere(u);
                norm += 4.0 * std::f64::consts::PI * f64::from(glow.pdf_w(even, cosine(even)));
                let wi = glow.sample(u, warp::cosine_hemisphere);
                let weight = f64::from(cosine(wi) / glow.pdf_w(wi, cosine(wi)));
                whole += weight;
                along += weight * f64::from(wi.z);
            }
            let [norm, whole, along] = [norm, whole, along].map(|sum| sum / f64::from(n * n));
            // The mean cosine of the cosine lobe is 2 / 3.
            assert!((norm - 1.0).abs() < 1e-3, "{share}: {norm}");
            assert!(
                (whole - 1.0).abs() < 1e-3 && (along - 2.0 / 3.0).abs() < 1e-3,
                "{share}: {whole} {along}"
            );
        }
    }
}
