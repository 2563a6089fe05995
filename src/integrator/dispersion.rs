//! Dispersion: what becomes of a path's four wavelengths where each bends its own way.
//!
//! A path follows its hero, lane 0. Where the indices of an interface are in the same ratio on all lanes it carries all of
//! them on; else the first refraction leaves lane 0 alone `[WILKIE14]`. With R_i the reflectance on lane i and T_i the
//! throughput
//!
//! ```text
//! q = (R_0 + R_1 + R_2 + R_3) / 4          chance of reflection, or its share where both ways are followed
//! reflected, q:       T_i R_i / q                           on each lane
//! refracted, 1 - q:   4 T_0 (1 - R_0) / (1 - q)             on lane 0, and 0 on the others
//! ```
//! That is unbiased. A reflection keeps the expectation T_i R_i on each lane for any q that is not 0 where an R_i is not. A
//! refraction has 4 T_0 (1 - R_0); each of the four wavelengths is lane 0 with the same chance, as u and u + 1/4 give the
//! same four, so the mean over these is the sum of T_i (1 - R_i), all that the four of them refract. And it is bounded:
//! R_i <= 4 q and 1 - R_i <= 4 (1 - q), also where some lanes are reflected totally and others are not. Where the hero is,
//! q is 1: what others refract is found when they lead.
//!
//! Interpolated normals are taken or not by where the refracted direction ends up ([`super::interface`]). Where lanes
//! differ in that, they reflect apart, too, and lane 0 goes on alone either way. What is looked for through an interface
//! ([`super::beneath`]) is seen by lane 0 alone as well.
//!
//! Photons keep one lane too, but each draws its own, i with the chance T_i / sum_k T_k, and goes on with sum_k T_k on it.
//! So every lane keeps its expectation among photons, whatever eye paths do: what an eye path of lane 0 alone takes of
//! them is the fourth part of them that have lane 0, and nothing is counted sixteen-fold.

use glam::Vec3;

use super::interface::{Ways, ways};
use super::path::{Branch, Sample};
use crate::optics::medium::{MediumId, pick};
use crate::scene::geometry::SurfaceHit;
use crate::spectrum::Lanes;

/// The lanes that are left of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Carried {
    All,
    One(u8),
}

/// What goes on in lane 0 alone stands for all four.
const HERO_ALONE: Lanes = Lanes::new(4.0, 0.0, 0.0, 0.0);

/// An interface at which the lanes of a path part.
pub(super) struct Parting {
    /// q of the head.
    pub(super) reflectance: f32,
    /// Throughput of both ways over their chance.
    reflected: Lanes,
    refracted: Lanes,
    /// The lanes part where they are reflected, too.
    reflects_apart: bool,
}

impl Sample<'_> {
    /// The index beyond an interface over that before it, on each lane.
    #[inline]
    pub(super) fn eta(&self, incident: MediumId, beyond: MediumId) -> Lanes {
        self.index(beyond) / self.index(incident)
    }
}

/// True when the directions of a path's lanes are not one beyond an interface of these indices.
#[inline]
fn is_parted_by(carried: Carried, eta: Lanes) -> bool {
    carried == Carried::All && eta != Lanes::splat(eta.x)
}

/// What is seen by a path through an interface on each lane, over what one direction sees there.
#[inline]
pub(super) fn seen_through(carried: Carried, eta: Lanes) -> Lanes {
    if is_parted_by(carried, eta) { HERO_ALONE } else { Lanes::ONE }
}

impl Parting {
    /// Where lanes part; `hero` are the ways of lane 0.
    #[inline]
    pub(super) fn at(branch: &Branch, hit: &SurfaceHit, eta: Lanes, hero: &Ways) -> Option<Self> {
        is_parted_by(branch.carried, eta).then(|| Self::of_ways(-branch.direction, hit.ns, hit.ng, eta, hero))
    }

    #[inline(never)]
    fn of_ways(wo: Vec3, ns: Vec3, ng: Vec3, eta: Lanes, hero: &Ways) -> Self {
        let mut each = Lanes::splat(hero.reflectance);
        let mut reflects_apart = false;
        for lane in 1..4 {
            let own = ways(wo, ns, ng, eta[lane]);
            each[lane] = own.reflectance;
            reflects_apart |= own.shaded != hero.shaded;
        }
        if reflects_apart {
            let (reflectance, reflected) = (hero.reflectance, HERO_ALONE);
            return Self { reflectance, reflected, refracted: HERO_ALONE, reflects_apart };
        }
        let reflectance = if hero.refracted.is_none() { 1.0 } else { 0.25 * each.element_sum() };
        let over = |share: Lanes, chance: f32| if chance > 0.0 { share / chance } else { Lanes::ZERO };
        let refracted = over(HERO_ALONE * (1.0 - hero.reflectance), 1.0 - reflectance);
        Self { reflectance, reflected: over(each, reflectance), refracted, reflects_apart }
    }

    /// The branch is reflected.
    pub(super) fn reflect(&self, branch: &mut Branch) {
        branch.throughput *= self.reflected;
        if self.reflects_apart {
            branch.leave_to_hero();
        }
    }

    /// The branch is refracted.
    pub(super) fn refract(&self, branch: &mut Branch) {
        branch.throughput *= self.refracted;
        branch.leave_to_hero();
    }
}

impl Branch {
    /// Roulette must not take the fourfold throughput for one that is worth more.
    fn leave_to_hero(&mut self) {
        self.carried = Carried::One(0);
        self.share *= HERO_ALONE.x;
    }

    /// The ratio of indices at which a photon bends; where its lanes part it draws the one that it keeps.
    #[inline]
    pub(super) fn drawn(&mut self, eta: Lanes) -> f32 {
        if is_parted_by(self.carried, eta) {
            self.draw();
        }
        match self.carried {
            Carried::All => eta.x,
            Carried::One(lane) => eta[usize::from(lane)],
        }
    }

    #[inline(never)]
    fn draw(&mut self) {
        let sum = self.throughput.element_sum();
        let (lane, _) = pick(self.throughput / sum, self.stream.next4()[0]);
        self.share *= sum / self.throughput[lane];
        self.throughput = Lanes::ZERO;
        self.throughput[lane] = sum;
        self.carried = Carried::One(lane as u8);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{SampleSeed, SampleStream};

    fn stream(i: u32) -> SampleStream {
        SampleStream::new(SampleSeed::new(3), i, 0, 0)
    }

    /// Each of four wavelengths leads once: in the mean every one of them is reflected and refracted as it would be alone,
    /// up to the rounding of sums and quotients, and no weight is above the bounds of the head. Where 1 - q is below 1e-3
    /// rounding has a share of it, and of what is refracted there.
    #[test]
    fn parting_keeps_every_wavelength_and_is_bounded() {
        let (mut apart, mut total) = (0, 0);
        for i in 0..40_000 {
            let ([x, y, z, spread], [tilt, turn, which, _]) = {
                let mut stream = stream(i);
                (stream.next4(), stream.next4())
            };
            let wo = Vec3::new(2.0 * x - 1.0, 2.0 * y - 1.0, z * z + 1e-3).normalize();
            let ns = Vec3::new(tilt - 0.5, turn - 0.5, 0.7).normalize();
            let ns = if which < 0.5 { ns } else { Vec3::Z };
            let base = [1.33, 0.75, 1.0, 0.99][i as usize % 4];
            let etas = [0.0, 0.3, 0.5, 1.0].map(|at| base * (1.0 + 0.05 * spread * (at - 0.5)));
            let alone = etas.map(|eta| ways(wo, ns, Vec3::Z, eta));
            let (mut reflected, mut refracted) = ([0.0_f32; 4], [0.0_f32; 4]);
            let mut least_rest = 1.0_f32;
            for lead in 0..4 {
                let lane = |wavelength: usize| (wavelength + 4 - lead) % 4;
                let eta = Lanes::from_array(std::array::from_fn(|k| etas[(k + lead) % 4]));
                let parting = Parting::of_ways(wo, ns, Vec3::Z, eta, &alone[lead]);
                let q = parting.reflectance;
                assert!((0.0..=1.0 + 1e-6).contains(&q), "{q}");
                assert!(parting.reflected.max_element() <= 4.0 + 1e-5, "{}", parting.reflected);
                assert!(parting.refracted.max_element() <= 16.0 + 1e-4, "{}", parting.refracted);
                apart += u32::from(parting.reflects_apart);
                total += u32::from(alone[lead].refracted.is_none());
                least_rest = least_rest.min(if q < 1.0 { 1.0 - q } else { 1.0 });
                for wavelength in 0..4 {
                    reflected[wavelength] += 0.25 * q * parting.reflected[lane(wavelength)];
                    refracted[wavelength] += 0.25 * (1.0 - q) * parting.refracted[lane(wavelength)];
                }
            }
            let allowed = 4e-7 * (1.0 + 1.0 / least_rest.max(1e-3));
            for (wavelength, alone) in alone.iter().enumerate() {
                let off = (reflected[wavelength] - alone.reflectance).abs();
                assert!(off < allowed, "{i} {wavelength}: {reflected:?} {alone:?}");
                let off = (refracted[wavelength] - (1.0 - alone.reflectance)).abs();
                assert!(off < allowed, "{i} {wavelength}: {refracted:?} {alone:?}");
            }
        }
        assert!(apart > 20 && total > 1000, "{apart} apart, {total} reflected totally");
    }

    /// 40,000 photons: five standard errors of the mean on each lane.
    #[test]
    fn photons_keep_the_mean_of_every_lane() {
        let throughput = Lanes::new(0.4, 1.0, 0.0, 0.2);
        let eta = Lanes::new(1.33, 1.34, 1.35, 1.36);
        let (n, mut sum) = (40_000, Lanes::ZERO);
        for i in 0..n {
            let mut photon = Branch { throughput, ..Branch::new(Vec3::ZERO, Vec3::X, stream(i)) };
            let drawn = photon.drawn(eta);
            let Carried::One(lane) = photon.carried else { panic!("nothing parted") };
            assert_eq!(drawn, eta[usize::from(lane)]);
            // Roulette measures the photon as it was.
            assert!(
                (photon.throughput[usize::from(lane)] / photon.share - throughput[usize::from(lane)]).abs()
                    < 1e-6
            );
            sum += photon.throughput / n as f32;
        }
        for lane in 0..4 {
            let share = throughput[lane] / 1.6;
            let error = 1.6 * (share * (1.0 - share) / n as f32).sqrt();
            assert!((sum[lane] - throughput[lane]).abs() <= 5.0 * error, "{sum}");
        }
    }
}
