//! Volumetric path tracing through labelled interfaces.
//!
//! Both branches, reflection and refraction, are followed at the first `split` interfaces of a path; afterwards one is
//! chosen by Fresnel's reflectance. What lies between two events is told by the flight.

use glam::Vec3;

use super::beams::Beams;
use super::direct::Receiver;
use super::dispersion::Carried;
use super::flight::{Around, Event};
use super::photon::{self, PhotonPass};
use super::roulette::{LONGEST_WALK, UNTOUCHED, UNTOUCHED_IN_GLOW};
use super::strays::StrayPass;
use super::{EyeSample, FirstHit, PreparedLight, Scattered, Scratch};
use crate::geometry::Ray;
use crate::light::balance;
use crate::optics::medium::MediumId;
use crate::optics::phase::{Deflection, PhaseLanes};
use crate::sampling::SampleStream;
use crate::scene::frame::Frame;
use crate::scene::geometry::SurfaceHit;
use crate::scene::layers::Insides;
use crate::spectrum::{Lanes, Wavelengths};

/// Volumetric path tracing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathTracer {
    /// Interactions along a path at most; 0 for no limit but [`HARD_LIMIT`] and that of the longest walks.
    pub max_depth: u32,
    /// Both branches are followed at this many interfaces.
    pub split: u32,
    /// Both what is scattered and what gets through are followed on this many ways through media that scatter.
    pub forced: u32,
    /// What becomes of the light that particles scatter.
    pub scattered: Scattered,
}

/// No path goes on beyond this many surfaces without a particle in between.
pub const HARD_LIMIT: u32 = 65_536;
/// A path being followed.
#[derive(Clone, Copy, Debug)]
pub struct Branch {
    pub(super) origin: Vec3,
    pub(super) direction: Vec3,
    /// The triangle that the ray leaves.
    pub(super) leaves: u32,
    pub(super) medium: MediumId,
    /// The meshes that it is in, of those that overlap. It fills what alignment leaves over.
    pub(super) insides: Insides,
    pub(super) throughput: Lanes,
    /// The lanes that are left.
    pub(super) carried: Carried,
    /// The product of (n_a / n_b)^2 that is part of the throughput.
    pub(super) index_factor: f32,
    /// The branch's share of the path at its splits, which roulette measures the throughput by.
    pub(super) share: f32,
    pub(super) interactions: u32,
    /// Those with surfaces since the last particle.
    pub(super) bounces: u32,
    /// The same with index-matched boundaries.
    pub(super) steps: u32,
    pub(super) splits_left: u32,
    pub(super) forced_left: u32,
    /// How many particles it may still turn at; beyond them media only attenuate.
    pub(super) scatterings_left: u32,
    /// Vertices at which it still asks for photons.
    pub(super) lookups_left: u8,
    pub(super) arrival: Arrival,
    /// Roulette leaves paths of a greater throughput alone.
    pub(super) untouched: f32,
    pub(super) stream: SampleStream,
}

/// How a path came to where it is, which decides what light counts when it runs into a source.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrival {
    /// Nothing but specular surfaces since the eye.
    pub(super) specular_from_eye: bool,
    /// What next-event estimation looked for at the last vertex.
    pub(super) looked: Looked,
}

/// Which of the lights that a path may run into next-event estimation has looked for.
#[derive(Clone, Copy, Debug)]
pub(super) enum Looked {
    /// None.
    Not,
    /// Those that are seen straight from a vertex, and nothing has turned the path since.
    Straight(LitVertex),
    /// Those beyond one interface, which is still ahead. Chance has this weight.
    Beneath(f32),
    /// Those beyond the interface that the path has just gone through. Chance has this weight.
    Through(f32),
}

impl Arrival {
    /// True where light that photons carry is not theirs: straight from a vertex that was lit, or seen by the eye.
    pub(super) fn counts_lights(&self) -> bool {
        self.specular_from_eye || matches!(self.looked, Looked::Straight(vertex) if vertex.lamps)
    }
}

/// A vertex at which next-event estimation looked for the lights.
#[derive(Clone, Copy, Debug)]
pub(super) struct LitVertex {
    pub(super) position: Vec3,
    /// Density with which the path's direction was drawn there.
    pub(super) pdf_w: f32,
    /// It was lit by lamps too, not only by a sky that photons do not carry.
    pub(super) lamps: bool,
}

/// Whether a branch goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fate {
    GoesOn,
    Ends,
}

/// The scene and the sample that a path belongs to.
pub(super) struct Sample<'a> {
    pub(super) frame: &'a Frame,
    pub(super) scratch: &'a mut Scratch,
    pub(super) wavelengths: &'a Wavelengths,
    /// Where the eye ray, or the photon, begins.
    pub(super) eye: Vec3,
    /// When the whole path happens, in frames since the shutter opened.
    pub(super) time: f32,
    /// Interactions along a path at most.
    pub(super) max_depth: u32,
    /// The photons of the pass, where there are any.
    pub(super) photons: Option<&'a PhotonPass>,
    /// The triangles that bend light of the sun, where it is looked for through them.
    pub(super) beams: Option<&'a Beams>,
    /// The photons of what they do not find.
    pub(super) strays: Option<&'a StrayPass>,
    pub(super) radiance: Lanes,
    pub(super) first: Option<FirstHit>,
}

impl PathTracer {
    /// Radiance along an eye ray, with the light that was prepared for it.
    pub(super) fn trace(
        &self,
        frame: &Frame,
        scratch: &mut Scratch,
        ray: &Ray,
        wavelengths: &Wavelengths,
        stream: SampleStream,
        PreparedLight { photons, beams, strays }: PreparedLight,
    ) -> EyeSample {
        scratch.start(frame, wavelengths, self.scattered.ambient(&frame.lights, wavelengths));
        let start = frame.start_of(ray);
        scratch.branches.push(Branch {
            medium: start.medium,
            insides: start.insides,
            throughput: frame.mode.white(),
            splits_left: self.split,
            forced_left: self.forced,
            scatterings_left: self.scattered.most(),
            lookups_left: photons.map_or(0, |pass| pass.lookups),
            untouched: if beams.is_some_and(Beams::show_glow) { UNTOUCHED_IN_GLOW } else { UNTOUCHED },
            ..Branch::new(ray.origin, ray.direction, stream)
        });
        let max_depth = self.interactions();
        let mut sample = Sample {
            frame,
            scratch,
            wavelengths,
            eye: ray.origin,
            time: ray.time,
            max_depth,
            photons,
            beams,
            strays,
            radiance: Lanes::ZERO,
            first: None,
        };
        // Light transport is compiled five times over what the scene needs in its inner loop.
        let varied = frame.needs.heterogeneous || !sample.scratch.sources.is_empty() || photons.is_some();
        if !varied {
            sample.scratch.lead(frame);
        }
        let is_left_out = cfg!(floe_without_scattering);
        let direct = frame.needs.direct_light || beams.is_some();
        match (varied && !is_left_out, frame.needs.scattering && !is_left_out, direct) {
            (false, false, false) => self.follow_all::<false, false, false>(&mut sample),
            (false, false, true) => self.follow_all::<false, true, false>(&mut sample),
            (false, true, false) => self.follow_all::<true, false, false>(&mut sample),
            (false, true, true) => self.follow_all::<true, true, false>(&mut sample),
            (true, ..) => self.follow_all::<true, true, true>(&mut sample),
        }
        EyeSample { radiance: sample.radiance, first: sample.first }
    }

    /// Interactions along a path at most.
    pub(super) fn interactions(&self) -> u32 {
        if self.max_depth == 0 { u32::MAX } else { self.max_depth }
    }

    fn follow_all<const SCATTERING: bool, const DIRECT: bool, const VARIED: bool>(
        &self,
        sample: &mut Sample,
    ) {
        while let Some(mut branch) = sample.scratch.branches.pop() {
            if SCATTERING {
                sample.scratch.around = Around::NOTHING;
            }
            while sample.advance::<SCATTERING, DIRECT, VARIED>(&mut branch) == Fate::GoesOn {}
        }
    }
}

impl Sample<'_> {
    /// A ray at the time of the path.
    #[inline]
    pub(super) fn ray(&self, origin: Vec3, direction: Vec3) -> Ray {
        Ray::new(origin, direction).at_time(self.time)
    }

    /// Follows a branch to its next event and through it.
    ///
    /// `VARIED` is for media of varying density and for those that add light.
    fn advance<const SCATTERING: bool, const DIRECT: bool, const VARIED: bool>(
        &mut self,
        branch: &mut Branch,
    ) -> Fate {
        if branch.steps >= HARD_LIMIT || branch.interactions >= LONGEST_WALK {
            return self.cut(branch);
        }
        if SCATTERING
            && !VARIED
            && self.scratch.around.clearing.is_there()
            && !self.scratch.around.flight.is_there()
            && !(DIRECT && self.frame.looks_for_lights(branch.medium))
        {
            // The ball is left when the walk in it ends, or a flight of its own would end.
            if self.walk(branch) == Fate::Ends {
                return Fate::Ends;
            }
        }
        branch.steps += 1;
        let u = branch.stream.next4();
        let event = if SCATTERING && !VARIED && self.scratch.around.flight.is_there() {
            self.fly_led(branch, u[0])
        } else if SCATTERING && branch.forced_left > 0 && self.turns(branch) {
            self.fly_and_scatter::<DIRECT, VARIED>(branch)
        } else {
            self.fly::<SCATTERING, VARIED>(branch, u[0])
        };
        match event {
            Event::Surface(hit) => {
                let hit = self.frame.geometry.surface_hit(&hit, branch.direction, self.time);
                self.meet::<DIRECT>(branch, &hit, u)
            }
            Event::Particle(distance) => self.scatter::<DIRECT>(branch, distance, u),
            Event::Nothing => {
                self.escape(branch);
                Fate::Ends
            }
        }
    }

    /// The path turns at a particle of the medium.
    pub(super) fn scatter<const DIRECT: bool>(
        &mut self,
        branch: &mut Branch,
        distance: f32,
        u: [f32; 4],
    ) -> Fate {
        if branch.throughput.max_element() <= 0.0 {
            return Fate::Ends;
        }
        if self.is_spent(branch) {
            return Fate::Ends;
        }
        let point = self.particle(branch, distance);
        if branch.interactions == 0 && self.first.is_none() {
            self.first = Some(FirstHit {
                distance: (point - self.eye).length(),
                position: point,
                normal: -branch.direction,
                albedo: Lanes::ONE,
                motion: Vec3::ZERO,
            });
        }
        let phase = self.frame.medium(branch.medium).phase.at(self.wavelengths);
        let (forward, throughput) = (branch.direction, branch.throughput);
        // The scattered light of lamps is that of photons, where there are any.
        let lamps = self.photons.is_none();
        let lit = DIRECT && (lamps || self.sky_is_for_paths()) && self.looks_for_lights(branch.medium);
        let led = self.led(branch);
        let glow = if led.is_none() { self.glow_around(branch) } else { None };
        if lit {
            let receiver = Receiver {
                position: point,
                normal: None,
                medium: branch.medium,
                insides: branch.insides,
                leaves: u32::MAX,
                interactions: branch.interactions,
                carried: branch.carried,
                weight: branch.weight(),
            };
            let response = |wi: Vec3| {
                let (value, phase_w) = phase.value_and_pdf_w(Deflection::between(forward, wi), throughput);
                let own = led.as_ref().map_or(phase_w, |led| led.pdf_w(wi, phase_w));
                (value, glow.as_ref().map_or(own, |glow| glow.pdf_w(wi, own)))
            };
            let direct = self.direct(&receiver, lamps, response, &mut branch.stream);
            self.radiance += branch.throughput * direct;
        }
        let (turned, own_share) = match (&glow, &led, phase) {
            (Some(glow), ..) => glow.turn(forward, [u[1], u[2]]),
            (None, Some(led), PhaseLanes::One(phase)) => {
                let (turned, flight) = led.sample(phase, &mut branch.stream);
                self.scratch.around.flight = flight;
                (turned.into(), 1.0)
            }
            _ => (phase.sample(forward, [u[1], u[2]], throughput), 1.0),
        };
        if self.photons.is_some() && !photon::is_peak(turned.greatest) {
            branch.lookups_left = 0;
        }
        branch.scatterings_left -= 1;
        branch.throughput *= turned.weight;
        branch.origin = point;
        branch.direction = turned.wi;
        branch.leaves = u32::MAX;
        let vertex = LitVertex { position: point, pdf_w: turned.pdf_w, lamps };
        let looked = if lit { self.looked(branch, vertex, turned.wi) } else { Looked::Not };
        branch.arrival = Arrival { specular_from_eye: false, looked };
        (branch.bounces, branch.steps) = (0, 0);
        let fate = branch.goes_on(u[3]);
        self.of_mixture(branch, fate, glow.as_ref(), own_share)
    }

    /// The path meets nothing any more: it sees the sky, and the discs of suns on a purely specular chain.
    fn escape(&mut self, branch: &Branch) {
        if self.frame.endless[branch.medium.0 as usize] {
            return;
        }
        if self.ends_somewhere(branch.medium) {
            self.scratch.counters.escaped_inside += 1;
        }
        let lights = &self.frame.lights;
        let weight = match branch.arrival.looked {
            Looked::Straight(v) => balance(v.pdf_w, lights.environment.pdf_w(branch.direction)),
            Looked::Through(weight) if lights.environment.is_sampled() => weight,
            _ => 1.0,
        };
        let mut radiance = Lanes::ZERO;
        if self.sky_is_for_paths() || branch.arrival.counts_lights() {
            radiance = lights.environment.radiance(branch.direction, self.wavelengths) * weight;
        }
        if branch.arrival.specular_from_eye {
            radiance += lights.of_suns(branch.direction, self.wavelengths);
        }
        self.radiance += branch.throughput * radiance;
    }

    /// Remembers the first surface for the picture's extra layers.
    pub(super) fn remember_first(&mut self, branch: &Branch, hit: &SurfaceHit, albedo: Lanes) {
        if branch.interactions == 0 && self.first.is_none() {
            // Index-matched boundaries before it have moved the origin along the eye ray.
            let position = hit.point.position;
            let distance = (position - self.eye).length();
            let motion = self.frame.geometry.motion(hit.triangle, position, self.time);
            self.first = Some(FirstHit { distance, position, normal: hit.ns, albedo, motion });
        }
    }

    /// True when the path has had all its interactions: it may still run into a light, but nothing turns it again.
    pub(super) fn is_spent(&mut self, branch: &Branch) -> bool {
        let spent = branch.interactions >= self.max_depth;
        self.scratch.counters.depth_limited += u64::from(spent);
        spent
    }

    pub(super) fn cut(&mut self, branch: &Branch) -> Fate {
        let kept = branch.throughput.max_element() / (branch.index_factor * branch.share);
        if branch.arrival.specular_from_eye && kept > 0.999 {
            self.scratch.counters.trapped += 1;
        } else {
            self.scratch.counters.cut += 1;
        }
        Fate::Ends
    }
}

impl Branch {
    /// A path that begins in the open air, without photons and splits.
    pub(super) fn new(origin: Vec3, direction: Vec3, stream: SampleStream) -> Self {
        Self {
            origin,
            direction,
            leaves: u32::MAX,
            medium: MediumId(0),
            insides: Insides::NONE,
            throughput: Lanes::ONE,
            carried: Carried::All,
            index_factor: 1.0,
            share: 1.0,
            interactions: 0,
            bounces: 0,
            steps: 0,
            splits_left: 0,
            forced_left: 0,
            scatterings_left: u32::MAX,
            lookups_left: 0,
            arrival: Arrival { specular_from_eye: true, looked: Looked::Not },
            untouched: UNTOUCHED,
            stream,
        }
    }
}
