//! Follows photons from the lights through the scene and leaves them where they arrive.
//!
//! A photon carries flux, which boundaries do not scale by the square of the index as they do radiance. It takes one
//! of its ways at each interface in proportion to their shares, and Russian roulette ends it as it ends eye paths.
//! What travels straight from a light to a surface is left to next-event estimation; in media every photon counts.
//! Of those that only stand for what no path finds, fewer are kept ([`super::stray`]).

use glam::Vec3;
use rayon::prelude::*;

use super::emission::{Emission, Emitted};
use super::map::Photon;
use super::peak::is_peak;
use super::stray::Strays;
use crate::accel::Hit;
use crate::geometry::Frame as Basis;
use crate::integrator::diffuse::DiffuseLobe;
use crate::integrator::flight::{Around, Event};
use crate::integrator::interface::{PhotonWay, photon_ways};
use crate::integrator::layers::Crossing;
use crate::integrator::path::{Branch, Fate, HARD_LIMIT, Sample};
use crate::integrator::roulette::LONGEST_WALK;
use crate::integrator::{Counters, Scratch};
use crate::optics::fresnel;
use crate::optics::refraction::reflect;
use crate::sampling::{SampleStream, warp};
use crate::scene::frame::Frame;
use crate::scene::geometry::SurfaceHit;
use crate::scene::surface::{MediumPair, Surface};
use crate::spectrum::{LaneCurve, Lanes, Wavelengths};

/// Photons that one worker follows at a time.
const BATCH: u32 = 1024;

/// What a photon has met since its light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum History {
    /// Nothing that turned it.
    Straight,
    /// One refracting interface, through which beams are looked for too.
    Bent,
    /// Specular surfaces and the peaks of phase functions only.
    Narrowed,
    /// Something else.
    Scattered,
}

/// The photons of one pass.
#[derive(Clone, Debug, Default)]
pub(in crate::integrator) struct Arrivals {
    /// On surfaces, turned by specular surfaces and within peaks only.
    pub(in crate::integrator) caustic: Vec<Photon>,
    /// On surfaces, after scattering.
    pub(super) global: Vec<Photon>,
    /// In media.
    pub(in crate::integrator) volume: Vec<Photon>,
    pub(in crate::integrator) counters: Counters,
}

/// What the photons of a pass have in common.
#[derive(Clone, Copy, Debug)]
pub(in crate::integrator) struct Tracing<'a> {
    pub(in crate::integrator) frame: &'a Frame,
    pub(in crate::integrator) emission: &'a Emission,
    pub(in crate::integrator) wavelengths: &'a Wavelengths,
    /// When all of them are on their way, in frames since the shutter opened.
    pub(in crate::integrator) time: f32,
    /// Photons emitted.
    pub(in crate::integrator) count: u32,
    pub(in crate::integrator) max_depth: u32,
    /// The part of the photons in media that are kept, each for so many more.
    pub(in crate::integrator) volume_share: f32,
    /// Which photons are kept, where it is not all.
    pub(in crate::integrator) strays: Option<Strays<'a>>,
}

impl Tracing<'_> {
    /// Emits and follows all photons, or fewer when it is told to stop; `stream` gives the numbers of each by its index.
    pub(in crate::integrator) fn run(
        &self,
        stream: impl Fn(u32) -> SampleStream + Sync,
        stops: &(dyn Fn() -> bool + Sync),
    ) -> Arrivals {
        let batches: Vec<Arrivals> = (0..self.count.div_ceil(BATCH))
            .into_par_iter()
            .map_init(Scratch::default, |scratch, batch| {
                scratch.counters = Counters::default();
                scratch.start(self.frame, self.wavelengths, Lanes::ZERO);
                let range = batch * BATCH..((batch + 1) * BATCH).min(self.count);
                let mut walk = self.walk(scratch);
                for index in range.take_while(|_| !stops()) {
                    walk.emit(index, stream(index));
                }
                let Walk { sample, mut arrivals, .. } = walk;
                arrivals.counters = sample.scratch.counters;
                arrivals
            })
            .collect();
        let mut all = Arrivals::default();
        for batch in batches {
            all.caustic.extend(batch.caustic);
            all.global.extend(batch.global);
            all.volume.extend(batch.volume);
            all.counters += batch.counters;
        }
        all.counters.photons += u64::from(self.count);
        all
    }

    /// Ready to follow photons; the scratch knows the media.
    pub(in crate::integrator) fn walk<'s>(&'s self, scratch: &'s mut Scratch) -> Walk<'s> {
        let arrivals = Arrivals::default();
        Walk { sample: self.sample(scratch), arrivals, tracing: *self, waiting: Vec::new() }
    }

    fn sample<'s>(&'s self, scratch: &'s mut Scratch) -> Sample<'s> {
        Sample {
            frame: self.frame,
            scratch,
            wavelengths: self.wavelengths,
            eye: Vec3::ZERO,
            time: self.time,
            max_depth: self.max_depth,
            photons: None,
            beams: None,
            strays: None,
            radiance: Lanes::ZERO,
            first: None,
        }
    }
}

pub(in crate::integrator) struct Walk<'a> {
    pub(super) sample: Sample<'a>,
    pub(in crate::integrator) arrivals: Arrivals,
    pub(super) tracing: Tracing<'a>,
    /// Photons that have split off and are still to be followed.
    pub(super) waiting: Vec<Flying>,
}

/// A photon on its way; the branch's throughput is the flux over `scale`.
#[derive(Clone, Copy)]
pub(super) struct Flying {
    pub(super) branch: Branch,
    pub(super) scale: f32,
    pub(super) spread: f32,
    pub(super) history: History,
}

impl Walk<'_> {
    /// Emits a photon and follows it to its end.
    pub(in crate::integrator) fn emit(&mut self, index: u32, mut stream: SampleStream) {
        let Tracing { frame, emission, wavelengths, time, count, .. } = self.tracing;
        if let Some(start) = emission.emit(frame, (wavelengths, time), (index, count), &mut stream) {
            self.follow(&start, stream);
        }
    }

    fn follow(&mut self, start: &Emitted, stream: SampleStream) {
        // Roulette and the choice of lanes look at the throughput: its greatest lane begins at 1.
        let scale = start.flux.max_element();
        let mut flying = Flying {
            branch: Branch {
                medium: start.place.medium,
                insides: start.place.insides,
                throughput: start.flux / scale,
                leaves: start.leaves,
                ..Branch::new(start.origin, start.direction, stream)
            },
            scale,
            spread: start.spread,
            history: History::Straight,
        };
        loop {
            self.sample.scratch.around = Around::NOTHING;
            while self.advance(&mut flying) == Fate::GoesOn {}
            let Some(next) = self.waiting.pop() else { return };
            flying = next;
        }
    }

    fn advance(&mut self, flying: &mut Flying) -> Fate {
        let branch = &mut flying.branch;
        if branch.steps >= HARD_LIMIT || branch.interactions >= LONGEST_WALK {
            return self.sample.cut(branch);
        }
        branch.steps += 1;
        let u = branch.stream.next4();
        if let Some(strays) = self.tracing.strays {
            return self.pass_on(&strays, flying, u);
        }
        let event = if self.tracing.frame.needs.heterogeneous {
            self.sample.fly::<true, true>(branch, u[0])
        } else {
            self.sample.fly::<true, false>(branch, u[0])
        };
        if flying.branch.throughput.max_element() <= 0.0 {
            return Fate::Ends;
        }
        match event {
            Event::Surface(hit) => self.meet(flying, &hit, u),
            Event::Particle(distance) => self.scatter(flying, distance, u),
            Event::Nothing => Fate::Ends,
        }
    }

    pub(super) fn meet(&mut self, flying: &mut Flying, found: &Hit, u: [f32; 4]) -> Fate {
        let frame = self.tracing.frame;
        let hit = frame.geometry.surface_hit(found, flying.branch.direction, self.sample.time);
        match frame.surface(hit.triangle) {
            // Light from below a model that is open there, say: no eye path sees where it has got to.
            Surface::Interface(pair) if pair.crossed(hit.from_front).0 != flying.branch.medium => {
                self.sample.scratch.counters.astray_photons += 1;
                Fate::Ends
            }
            Surface::Emitter { .. } => Fate::Ends,
            Surface::Layer(_) => self.meet_layer(flying, found, &hit, u),
            Surface::Interface(pair) if pair.matched => self.pass(flying, &hit, pair),
            Surface::Interface(pair) => self.bend(flying, (found, &hit), pair, None, u),
            Surface::Diffuse { reflectance } => self.arrive(flying, &hit, reflectance, u),
            Surface::Conductor { eta, k } => self.reflect_on_metal(flying, found, &hit, [eta, k], u),
        }
    }

    /// An index-matched boundary.
    fn pass(&mut self, flying: &mut Flying, hit: &SurfaceHit, pair: &MediumPair) -> Fate {
        if self.stops_before(pair, hit) {
            return Fate::Ends;
        }
        let (incident, beyond) = pair.crossed(hit.from_front);
        // Where indices differ all the same, L / n^2 holds: its adjoint is the inverse of an eye path's factor.
        flying.branch.enter(beyond, self.sample.index_factor(beyond, incident));
        flying.branch.go_on(hit, flying.branch.direction);
        Fate::GoesOn
    }

    /// A triangle of a mesh that overlaps others.
    fn meet_layer(&mut self, flying: &mut Flying, found: &Hit, hit: &SurfaceHit, u: [f32; 4]) -> Fate {
        let branch = &mut flying.branch;
        let crossing = self.sample.crossing(branch, hit);
        let is_of = |crossing: &Crossing| {
            !crossing.contradicts && (crossing.is_hidden() || crossing.media.0 == branch.medium)
        };
        let Some(crossing) = crossing.filter(is_of) else {
            self.sample.scratch.counters.astray_photons += 1;
            return Fate::Ends;
        };
        branch.insides = crossing.beyond;
        if crossing.is_hidden() {
            branch.go_on(hit, branch.direction);
            return Fate::GoesOn;
        }
        let frame = self.tracing.frame;
        let found = crossing.stronger.unwrap_or(*found);
        let hit = frame.geometry.surface_hit(&found, branch.direction, self.sample.time);
        let pair = crossing.pair(frame, hit.from_front);
        if pair.matched {
            return self.pass(flying, &hit, &pair);
        }
        self.bend(flying, (&found, &hit), &pair, Some(&crossing), u)
    }

    /// A refracting interface: one of the ways, by its share, or each; `overlap` is what is crossed there of meshes that overlap.
    fn bend(
        &mut self,
        flying: &mut Flying,
        (found, hit): (&Hit, &SurfaceHit),
        pair: &MediumPair,
        overlap: Option<&Crossing>,
        u: [f32; 4],
    ) -> Fate {
        let branch = &mut flying.branch;
        if self.sample.is_spent(branch) {
            return Fate::Ends;
        }
        let (incident, beyond) = pair.crossed(hit.from_front);
        let frame = self.tracing.frame;
        let eta_t_over_i = branch.drawn(self.sample.eta(incident, beyond));
        let ns = frame.geometry.interpolated_normal(found, hit.ng, self.sample.time);
        let mut ways = photon_ways(-branch.direction, ns, hit.ng, eta_t_over_i);
        if self.stops_before(pair, hit) {
            ways.iter_mut().filter(|way| way.crosses).for_each(|way| way.share = 0.0);
        }
        let is_beam = overlap.is_none() && frame.lit[incident.0 as usize] && self.has_beams();
        let taken = |flying: &Flying, way: &PhotonWay, weight: f32| {
            let mut next = *flying;
            next.branch.medium = if way.crosses { beyond } else { incident };
            if let Some(overlap) = overlap {
                next.branch.insides = if way.crosses { overlap.beyond } else { overlap.before };
            }
            next.branch.throughput *= weight;
            next.branch.go_on(hit, way.direction);
            next.turned_narrowly(way.crosses && is_beam);
            next
        };
        if self.splits(flying) {
            return self.split(flying, &ways, taken, u[3]);
        }
        let total: f32 = ways.iter().map(|way| way.share).sum();
        if total <= 0.0 {
            return Fate::Ends;
        }
        let mut rest = u[1] * total;
        let chosen = ways.iter().find(|way| {
            let is_it = rest < way.share;
            rest -= way.share;
            is_it
        });
        // Rounding may run past the last way.
        let Some(way) = chosen.or_else(|| ways.iter().rev().find(|way| way.share > 0.0)) else {
            return Fate::Ends;
        };
        *flying = taken(flying, way, total);
        flying.branch.interacted(u[3])
    }

    fn reflect_on_metal(
        &mut self,
        flying: &mut Flying,
        found: &Hit,
        hit: &SurfaceHit,
        index: [&LaneCurve; 2],
        u: [f32; 4],
    ) -> Fate {
        let branch = &mut flying.branch;
        if self.sample.is_spent(branch) {
            return Fate::Ends;
        }
        let frame = self.tracing.frame;
        let wi = -branch.direction;
        let n = self.sample.index(branch.medium);
        let [eta, k] = index.map(|curve| curve.lanes(self.tracing.wavelengths) / n);
        // A mirror direction about a normal is its own reverse: the eye path from it must take the same normal.
        let ns = frame.geometry.interpolated_normal(found, hit.ng, self.sample.time);
        let (about_ns, about_ng) = (reflect(wi, ns), reflect(wi, hit.ng));
        let is_shaded =
            |wo: Vec3| wo.dot(ns) > 0.0 && ns.dot(hit.ng) > 0.0 && reflect(wo, ns).dot(hit.ng) > 0.0;
        let share = |wo: Vec3, normal: Vec3, follows: bool| {
            let correction = (wo.dot(hit.ng) / wi.dot(hit.ng)).abs();
            if follows { fresnel::conductor(wi.dot(normal), eta, k) * correction } else { Lanes::ZERO }
        };
        let first = share(about_ns, ns, about_ns.dot(hit.ng) > 0.0 && is_shaded(about_ns));
        let second = share(about_ng, hit.ng, ns != hit.ng && !is_shaded(about_ng));
        let sums = [first, second].map(|s| (s * branch.throughput).element_sum());
        let total = sums[0] + sums[1];
        if total <= 0.0 {
            return Fate::Ends;
        }
        let takes_first = u[1] * total < sums[0];
        let (weight, direction, own) =
            if takes_first { (first, about_ns, sums[0]) } else { (second, about_ng, sums[1]) };
        branch.throughput *= weight * (total / own);
        branch.leave(hit, direction);
        flying.turned_narrowly(false);
        flying.branch.interacted(u[3])
    }

    /// A diffuse surface: the photon is left there, and goes on.
    fn arrive(
        &mut self,
        flying: &mut Flying,
        hit: &SurfaceHit,
        reflectance: &LaneCurve,
        u: [f32; 4],
    ) -> Fate {
        let is_kept = self.is_kept(flying);
        let branch = &mut flying.branch;
        let wi = -branch.direction;
        let lobe = DiffuseLobe { ns: hit.ns, ng: hit.ng };
        let cos = wi.dot(hit.ng);
        if cos <= 0.0 {
            return Fate::Ends;
        }
        let albedo = reflectance.lanes(self.tracing.wavelengths);
        if albedo == Lanes::ZERO {
            return Fate::Ends;
        }
        // What leaves in any direction is the same multiple of what arrives through the surface: the adjoint of the lobe.
        branch.throughput *= lobe.pdf_w(wi) * std::f32::consts::PI / cos;
        let photon = Photon {
            position: hit.point.position,
            direction: branch.direction,
            normal: hit.ng,
            medium: branch.medium,
            flux: branch.throughput * flying.scale,
            scattered: flying.history == History::Scattered,
            spread: flying.spread,
        };
        match flying.history {
            _ if !is_kept => {}
            History::Straight => {}
            History::Bent | History::Narrowed => self.arrivals.caustic.push(photon),
            History::Scattered => self.arrivals.global.push(photon),
        }
        if self.tracing.strays.is_some() || self.sample.is_spent(branch) {
            return Fate::Ends;
        }
        branch.throughput *= albedo;
        let local = warp::cosine_hemisphere([u[1], u[2]]);
        branch.leave(hit, Basis::around(hit.ng).to_world(local).normalize());
        flying.history = History::Scattered;
        flying.branch.interacted(u[3])
    }

    /// A particle of a medium: the photon is left there, and turns.
    fn scatter(&mut self, flying: &mut Flying, distance: f32, u: [f32; 4]) -> Fate {
        let branch = &mut flying.branch;
        let point = self.sample.particle(branch, distance);
        let share = self.tracing.volume_share;
        if share >= 1.0 || branch.stream.next4()[0] < share {
            self.arrivals.volume.push(Photon {
                position: point,
                direction: branch.direction,
                normal: Vec3::ZERO,
                medium: branch.medium,
                flux: branch.throughput * (flying.scale / share),
                scattered: flying.history == History::Scattered,
                spread: flying.spread,
            });
        }
        if self.sample.is_spent(branch) {
            return Fate::Ends;
        }
        let phase = self.tracing.frame.medium(branch.medium).phase.at(self.tracing.wavelengths);
        let turned = phase.sample(branch.direction, [u[1], u[2]], branch.throughput);
        branch.throughput *= turned.weight;
        branch.origin = point;
        branch.direction = turned.wi;
        branch.leaves = u32::MAX;
        (branch.bounces, branch.steps) = (0, 0);
        if is_peak(turned.greatest) {
            flying.turned_narrowly(false);
        } else {
            flying.history = History::Scattered;
        }
        flying.branch.goes_on(u[3])
    }
}

impl Flying {
    /// `is_beam` where beams are looked for through what has turned it.
    fn turned_narrowly(&mut self, is_beam: bool) {
        self.history = match self.history {
            History::Straight if is_beam => History::Bent,
            History::Straight | History::Bent => History::Narrowed,
            History::Narrowed | History::Scattered => self.history,
        };
    }
}
