//! What a path does where it meets a surface.

use glam::Vec3;

use super::diffuse::DiffuseLobe;
use super::direct::Receiver;
use super::dispersion::Parting;
use super::half_space::Cover;
use super::interface;
use super::path::{Arrival, Branch, Fate, LitVertex, Looked, Sample};
use super::photon::{self, Guide, PhotonPass};
use crate::light::balance;
use crate::optics::fresnel;
use crate::optics::medium::MediumId;
use crate::optics::refraction::reflect;
use crate::scene::geometry::SurfaceHit;
use crate::scene::surface::{MediumPair, Surface};
use crate::spectrum::{LaneCurve, Lanes};

impl Sample<'_> {
    /// Follows a branch through the surface that it has met.
    pub(super) fn meet<const DIRECT: bool>(
        &mut self,
        branch: &mut Branch,
        hit: &SurfaceHit,
        u: [f32; 4],
    ) -> Fate {
        let frame = self.frame;
        match frame.surface(hit.triangle) {
            Surface::Interface(pair) if pair.matched => self.pass(branch, hit, pair),
            Surface::Emitter { radiance } => {
                self.arrive(branch, hit, radiance);
                Fate::Ends
            }
            Surface::Layer(_) => self.meet_layer(branch, hit, u),
            Surface::Interface(pair) => self.refract(branch, hit, pair, u),
            _ if self.is_done(branch) => Fate::Ends,
            Surface::Diffuse { reflectance } => self.reflect_diffusely::<DIRECT>(branch, hit, reflectance, u),
            Surface::Conductor { eta, k } => self.reflect_on_metal(branch, hit, eta, k, u),
        }
    }

    /// True when a path has nothing more to find but lights that it runs into.
    fn is_done(&mut self, branch: &Branch) -> bool {
        self.has_all_light(branch) || self.is_spent(branch)
    }

    /// A refracting interface, unless the path is done.
    pub(super) fn refract(
        &mut self,
        branch: &mut Branch,
        hit: &SurfaceHit,
        pair: &MediumPair,
        u: [f32; 4],
    ) -> Fate {
        if self.is_done(branch) { Fate::Ends } else { self.bend(branch, hit, pair, u) }
    }

    /// True when photons have given a path all its light, and eye paths do not go on for any other.
    fn has_all_light(&self, branch: &Branch) -> bool {
        self.photons.is_some_and(|pass| !pass.walks) && branch.lookups_left == 0
    }

    /// An index-matched boundary: the medium changes and L / n^2 stays.
    pub(super) fn pass(&mut self, branch: &mut Branch, hit: &SurfaceHit, pair: &MediumPair) -> Fate {
        let (incident, beyond) = pair.crossed(hit.from_front);
        self.check_label(branch, pair, hit);
        if !matches!(branch.arrival.looked, Looked::Straight(_)) {
            branch.arrival.looked = Looked::Not;
        }
        let index_factor = self.index_factor(incident, beyond);
        branch.enter(beyond, index_factor);
        branch.go_on(hit, branch.direction);
        self.scratch.around.outward = hit.ng;
        match self.half_space(beyond) {
            None => Fate::GoesOn,
            Some(half_space) => {
                let media = (incident, beyond);
                let cover = Cover { media, normal: hit.ns, ng: hit.ng, eta: 1.0, gain: index_factor.recip() };
                let mu = -branch.direction.dot(hit.ns);
                self.remember_first(branch, hit, half_space.along(mu).reflectance);
                self.turn_back(branch, hit, &cover, &half_space, mu)
            }
        }
    }

    /// A refracting interface: both ways while splits are left, one by Fresnel's reflectance afterwards.
    fn bend(&mut self, branch: &mut Branch, hit: &SurfaceHit, pair: &MediumPair, u: [f32; 4]) -> Fate {
        let (incident, beyond) = pair.crossed(hit.from_front);
        self.check_label(branch, pair, hit);
        self.remember_first(branch, hit, Lanes::ONE);
        let eta = self.eta(incident, beyond);
        let ways = interface::ways(-branch.direction, hit.ns, hit.ng, eta.x);
        let parting = Parting::at(branch, hit, eta, &ways);
        let reflectance = parting.as_ref().map_or(ways.reflectance, |parting| parting.reflectance);
        branch.medium = incident;
        let beyond_looked = match branch.arrival.looked {
            Looked::Beneath(weight) => Looked::Through(weight),
            _ => Looked::Not,
        };
        branch.arrival.looked = Looked::Not;
        let splits = branch.splits_left > 0;
        let reflects = !splits && u[1] < reflectance;
        let refracted = ways.refracted.filter(|_| !reflects);
        let Some(direction) = refracted else {
            branch.go_on(hit, ways.reflected);
            if let Some(parting) = &parting {
                parting.reflect(branch);
            }
            self.scratch.around.outward = -hit.ng;
            return branch.interacted(u[3]);
        };
        if splits {
            let mut reflected = *branch;
            reflected.go_on(hit, ways.reflected);
            if let Some(parting) = &parting {
                parting.reflect(&mut reflected);
            }
            reflected.split_off(reflectance, 0);
            if reflected.interacted(u[3]) == Fate::GoesOn && reflectance > 0.0 {
                self.scratch.branches.push(reflected);
            }
        }
        branch.go_on(hit, direction);
        branch.enter(beyond, self.index_factor(incident, beyond));
        branch.arrival.looked = beyond_looked;
        if let Some(parting) = &parting {
            parting.refract(branch);
        }
        if splits {
            branch.split_off(1.0 - reflectance, 1);
        }
        self.scratch.around.outward = hit.ng;
        let fate = branch.interacted(u[3]);
        match self.half_space(beyond).filter(|_| fate == Fate::GoesOn) {
            None => fate,
            Some(half_space) => {
                let normal = if ways.shaded { hit.ns } else { hit.ng };
                let (media, eta) = ((incident, beyond), eta.x);
                let cover = Cover { media, normal, ng: hit.ng, eta, gain: Lanes::ONE };
                self.turn_back(branch, hit, &cover, &half_space, -direction.dot(normal))
            }
        }
    }

    fn reflect_diffusely<const DIRECT: bool>(
        &mut self,
        branch: &mut Branch,
        hit: &SurfaceHit,
        reflectance: &LaneCurve,
        u: [f32; 4],
    ) -> Fate {
        let albedo = reflectance.lanes(self.wavelengths);
        self.remember_first(branch, hit, albedo);
        let lobe = DiffuseLobe { ns: hit.ns, ng: hit.ng };
        let guide = self.photons.and_then(|pass| self.take_photons(pass, branch, hit, albedo));
        self.radiance += branch.throughput * albedo * self.strays_on(hit);
        let glow = self.glow_before(branch, hit.ng);
        let pdf_w = |wi: Vec3| match (&guide, &glow) {
            (None, None) => lobe.pdf_w(wi),
            (None, Some(glow)) => glow.pdf_w(wi, lobe.pdf_w(wi)),
            (Some(guide), _) => lobe.weighted_pdf_w(wi, |direction| guide.relative(direction)),
        };
        // Beyond the last vertex at which photons are asked for, the light of lamps is theirs.
        let lamps = self.photons.is_none() || branch.lookups_left > 0;
        branch.lookups_left = branch.lookups_left.saturating_sub(1);
        let lit = DIRECT && (lamps || self.sky_is_for_paths()) && self.looks_for_lights(branch.medium);
        if lit {
            let receiver = Receiver {
                position: hit.point.position,
                normal: Some(*hit),
                medium: branch.medium,
                insides: branch.insides,
                leaves: hit.triangle,
                interactions: branch.interactions,
                carried: branch.carried,
                weight: branch.weight(),
            };
            let response = |wi: Vec3| (albedo * lobe.pdf_w(wi), pdf_w(wi));
            let direct = self.direct(&receiver, lamps, response, &mut branch.stream);
            self.radiance += branch.throughput * direct;
        }
        let u12 = [u[1], u[2]];
        let wi = match (&guide, &glow) {
            (None, None) => lobe.sample(u12),
            (None, Some(glow)) => glow.sample(u12, |u| lobe.sample(u)),
            (Some(guide), _) => lobe.above(guide.sample(u12)),
        };
        let own = pdf_w(wi);
        branch.throughput *= if guide.is_some() { albedo * (lobe.pdf_w(wi) / own) } else { albedo };
        let vertex = LitVertex { position: hit.point.position, pdf_w: own, lamps };
        let looked = match (lit, self.photons) {
            (true, _) => self.looked(branch, vertex, wi),
            // Nothing was looked for, yet light that comes straight is none of the photons': chance has all of it.
            (false, Some(_)) if lamps => Looked::Straight(LitVertex { pdf_w: f32::INFINITY, ..vertex }),
            _ => Looked::Not,
        };
        branch.arrival = Arrival { specular_from_eye: false, looked };
        branch.leave(hit, wi);
        let fate = branch.interacted(u[3]);
        let own_share = lobe.pdf_w(wi) / own;
        self.of_mixture(branch, fate, glow.as_ref(), own_share)
    }

    /// Adds the light of photons at a diffuse surface where the path asks for them; tells how the directions of final
    /// gathering are drawn, where that begins here.
    fn take_photons(
        &mut self,
        pass: &PhotonPass,
        branch: &Branch,
        hit: &SurfaceHit,
        albedo: Lanes,
    ) -> Option<Guide> {
        if branch.lookups_left == 0 {
            return None;
        }
        let mut reflected = photon::reflected(pass.kernel, &pass.caustic, hit);
        let is_last = branch.lookups_left == 1;
        if is_last {
            reflected += photon::reflected(pass.kernel, &pass.global, hit);
        }
        self.radiance += branch.throughput * albedo * reflected;
        (pass.guide && !is_last && !pass.global.is_empty()).then(|| Guide::new(&pass.global, hit))
    }

    fn reflect_on_metal(
        &mut self,
        branch: &mut Branch,
        hit: &SurfaceHit,
        eta: &LaneCurve,
        k: &LaneCurve,
        u: [f32; 4],
    ) -> Fate {
        let wo = -branch.direction;
        let n = self.index(branch.medium);
        let index = [eta, k].map(|curve| curve.lanes(self.wavelengths) / n);
        let mut normal = hit.ns;
        let mut wi = reflect(wo, normal);
        if wi.dot(hit.ng) <= 0.0 {
            normal = hit.ng;
            wi = reflect(wo, normal);
        }
        let reflectance = fresnel::conductor(wo.dot(normal), index[0], index[1]);
        self.remember_first(branch, hit, reflectance);
        branch.throughput *= reflectance;
        branch.arrival.looked = Looked::Not;
        branch.leave(hit, wi);
        branch.interacted(u[3])
    }

    /// The path runs into a light.
    fn arrive(&mut self, branch: &Branch, hit: &SurfaceHit, radiance: &LaneCurve) {
        self.remember_first(branch, hit, Lanes::ONE);
        let is_for_photons = self.photons.is_some() && !branch.arrival.counts_lights();
        if !hit.from_front || is_for_photons {
            return;
        }
        let weight = match (branch.arrival.looked, &self.frame.lights.area) {
            (Looked::Through(weight), _) => weight,
            (Looked::Straight(vertex), Some(area)) => {
                let distance = (hit.point.position - vertex.position).length();
                balance(vertex.pdf_w, area.pdf_w(hit.triangle, branch.direction, distance))
            }
            _ => 1.0,
        };
        self.radiance += branch.throughput * radiance.lanes(self.wavelengths) * weight;
    }

    fn check_label(&mut self, branch: &Branch, pair: &MediumPair, hit: &SurfaceHit) {
        if !cfg!(floe_without_guards) && pair.crossed(hit.from_front).0 != branch.medium {
            self.scratch.counters.label_mismatches += 1;
        }
    }

    /// Index of a medium on each lane.
    #[inline]
    pub(super) fn index(&self, medium: MediumId) -> Lanes {
        self.scratch.media[medium.0 as usize].n
    }

    /// (n_a / n_b)^2 on the way from a into b.
    #[inline]
    pub(super) fn index_factor(&self, a: MediumId, b: MediumId) -> Lanes {
        let ratio = self.index(a) / self.index(b);
        ratio * ratio
    }
}

impl Branch {
    /// Starts again from an interface along `direction`, at the very point: [`Sample::nearest`] tells by the labels which
    /// sheets rounding has put on the wrong side of it.
    pub(super) fn go_on(&mut self, hit: &SurfaceHit, direction: Vec3) {
        self.origin = hit.point.position;
        self.direction = direction;
        self.leaves = hit.triangle;
    }

    /// Starts again from an opaque surface along `direction`.
    pub(super) fn leave(&mut self, hit: &SurfaceHit, direction: Vec3) {
        self.origin = hit.point.spawn(hit.ng, direction);
        self.direction = direction;
        self.leaves = hit.triangle;
    }

    /// Roulette, which looks at the factors, takes that of lane 0 for all: what it does with others is right, too.
    pub(super) fn enter(&mut self, medium: MediumId, index_factor: Lanes) {
        self.medium = medium;
        self.throughput *= index_factor;
        self.index_factor *= index_factor.x;
    }

    /// Takes a share of the path with numbers of its own.
    fn split_off(&mut self, share: f32, branch: u32) {
        self.throughput *= share;
        self.share *= share;
        self.splits_left -= 1;
        self.stream = self.stream.fork(branch);
    }
}
