//! What a path does at the surface of a medium of which nothing but a half space is seen ([`crate::optics::half_space`]).
//!
//! The path has come in through the interface and would walk among the particles until it came out next to where it is.
//! Instead it leaves the half space where it stands, at the cosine mu0 with the normal, and meets the interface from within:
//!
//! ```text
//! reflected with F(mu0): back into the half space, of which only mu0 matters
//! transmitted with 1 - F(mu0): on along w, n_o sin = n_i sin0, n being the indices outside and inside
//! ```
//! Lights outside are looked for through the interface at each turn, the sun too. With n_i^2 mu0 dw0 = n_o^2 (w . m) dw
//! value and density of a direction w outside are
//!
//! ```text
//! value(w) = f_r mu0 (1 - F) (w . m) / mu0,       pdf_w(w) = pdf_w(w0) (1 - F) (n_o / n_i)^2 (w . m) / mu0
//! ```
//! The normal m, the shading normal or the geometric one, is that by which the path came in. Directions that dip under the surface
//! are mirrored at it, as those of diffuse surfaces are ([`super::diffuse`]).

use glam::Vec3;

use super::direct::Receiver;
use super::path::{Arrival, Branch, Fate, LitVertex, Looked, Sample};
use crate::geometry::Frame as Basis;
use crate::geometry::elementary::sin_cos_of_turn;
use crate::optics::fresnel;
use crate::optics::half_space::{HalfSpaceLanes, Reflection};
use crate::optics::medium::MediumId;
use crate::scene::geometry::SurfaceHit;
use crate::spectrum::Lanes;

/// The interface over a half space.
pub(super) struct Cover {
    /// Outer and inner medium.
    pub(super) media: (MediumId, MediumId),
    /// By which the path came in, on the outer side.
    pub(super) normal: Vec3,
    /// The geometric one there.
    pub(super) ng: Vec3,
    /// Inner over outer index as far as they bend light: 1 where it passes straight through.
    pub(super) eta: f32,
    /// What radiance is multiplied by on its way in besides the 1 / eta^2 that it is compressed by.
    pub(super) gain: Lanes,
}

impl Cover {
    /// Value and density of a direction outside for a path of this throughput.
    fn response(&self, reflection: &Reflection, throughput: Lanes, wi: Vec3) -> (Lanes, f32) {
        if wi.dot(self.ng) <= 0.0 {
            return (Lanes::ZERO, 0.0);
        }
        let (value, pdf_w) = self.part(reflection, throughput, wi.dot(self.normal));
        if self.normal == self.ng {
            return (value, pdf_w);
        }
        let (other, other_w) = self.part(reflection, throughput, self.mirrored(wi).dot(self.normal));
        (value + other, pdf_w + other_w)
    }

    /// The same for what leaves at this cosine, mirrored or not.
    fn part(&self, reflection: &Reflection, throughput: Lanes, cos: f32) -> (Lanes, f32) {
        let way = fresnel::dielectric(cos, self.eta);
        if cos <= 0.0 || way.cos_t <= 0.0 {
            return (Lanes::ZERO, 0.0);
        }
        let passed = (1.0 - way.reflectance) * cos / way.cos_t;
        let pdf_w = reflection.pdf_w(way.cos_t, throughput) * passed / (self.eta * self.eta);
        (reflection.value(way.cos_t) * (self.gain * passed), pdf_w)
    }

    /// The direction outside at a cosine and a fraction of a turn about the normal.
    fn direction(&self, cos: f32, turn: f32) -> Vec3 {
        let sine = ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt();
        let (sin, cosine) = sin_cos_of_turn(turn);
        let local = Vec3::new(sine * cosine, sine * sin, cos);
        let wi = Basis::around(self.normal).to_world(local).normalize();
        if wi.dot(self.ng) > 0.0 { wi } else { self.mirrored(wi) }
    }

    fn mirrored(&self, direction: Vec3) -> Vec3 {
        direction - 2.0 * direction.dot(self.ng) * self.ng
    }
}

impl Sample<'_> {
    /// The half space that a path meets in a medium.
    #[inline]
    pub(super) fn half_space(&self, medium: MediumId) -> Option<HalfSpaceLanes> {
        self.frame.half_space(medium).map(|half_space| half_space.lanes(self.wavelengths))
    }

    /// Goes on with a path that has come into a half space at the cosine `mu` until it is out again.
    #[inline(never)]
    pub(super) fn turn_back(
        &mut self,
        branch: &mut Branch,
        hit: &SurfaceHit,
        cover: &Cover,
        half_space: &HalfSpaceLanes,
        mut mu: f32,
    ) -> Fate {
        let (outer, inner) = cover.media;
        let position = hit.point.position;
        let lit = self.frame.needs.direct_light && self.looks_for_lights(outer);
        loop {
            if self.is_spent(branch) {
                return Fate::Ends;
            }
            let reflection = half_space.along(mu);
            let throughput = branch.throughput;
            if lit {
                let receiver = Receiver {
                    position,
                    normal: Some(*hit),
                    medium: outer,
                    insides: branch.insides,
                    leaves: hit.triangle,
                    interactions: branch.interactions,
                    carried: branch.carried,
                    weight: branch.weight(),
                };
                let response = |wi: Vec3| cover.response(&reflection, throughput, wi);
                let direct = self.direct(&receiver, true, response, &mut branch.stream);
                self.radiance += throughput * direct;
            }
            let u = branch.stream.next4();
            let Some((mu0, weight)) = reflection.sample(throughput, u[0], &mut branch.stream) else {
                return Fate::Ends;
            };
            branch.throughput *= weight;
            let way = fresnel::dielectric(mu0, 1.0 / cover.eta);
            if u[2] < way.reflectance {
                mu = mu0;
                if branch.interacted(u[3]) == Fate::Ends {
                    return Fate::Ends;
                }
                continue;
            }
            let wi = cover.direction(way.cos_t, u[1]);
            branch.go_on(hit, wi);
            branch.enter(outer, self.index_factor(inner, outer));
            let looked = if lit {
                let pdf_w = cover.response(&reflection, throughput, wi).1;
                self.looked(branch, LitVertex { position, pdf_w, lamps: true }, wi)
            } else {
                Looked::Not
            };
            branch.arrival = Arrival { specular_from_eye: false, looked };
            self.scratch.around.outward = -hit.ng;
            return branch.interacted(u[3]);
        }
    }
}
