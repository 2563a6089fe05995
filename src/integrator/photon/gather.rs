//! Density estimation: the radiance that photons stand for, on a surface and along a ray.
//!
//! ```text
//! surface:  L = (albedo / pi) sum_p flux_p k(d_p / r) / (pi r^2)                              [JENSEN96 eq. 6]
//! ray:      L = sum_p p(omega_p -> eye) T(t_p) flux_p k(d_p / r) / (pi r^2)                   [JAROSZ08 eq. 17]
//! ```
//! r is the photon's reach. On a surface d is the distance to the photon, along a ray it is that of the photon to the ray,
//! at distance t. On a surface a photon counts on the side where it has arrived, in a medium only there.

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use super::PhotonPass;
use super::kernel::profile;
use super::map::{Photon, PhotonMap};
use super::peak::is_peak;
use crate::geometry::Ray;
use crate::integrator::path::{Branch, Sample};
use crate::optics::phase::Deflection;
use crate::scene::description::KernelKind;
use crate::scene::geometry::SurfaceHit;
use crate::spectrum::Lanes;

/// Photons on a surface that is turned farther away than this cosine belong to another part of it.
const SAME_SIDE: f32 = 0.5;

/// Radiance that a surface of albedo 1 reflects of the photons of a map.
pub(in crate::integrator) fn reflected(kind: KernelKind, map: &PhotonMap, hit: &SurfaceHit) -> Lanes {
    let mut sum = Lanes::ZERO;
    map.each_around(hit.point.position, 0.0, |photon, squared, reach| {
        if photon.normal.dot(hit.ng) > SAME_SIDE {
            sum += photon.flux * kernel(kind, squared, reach);
        }
    });
    sum * FRAC_1_PI
}

/// K in 1/m^2.
#[inline]
fn kernel(kind: KernelKind, squared: f32, reach: f32) -> f32 {
    let inverse = 1.0 / (reach * reach);
    profile(kind, squared * inverse) * (FRAC_1_PI * inverse)
}

/// Beyond the ends of a ray photons are looked for over so many of their reaches: a ray that meets a plane at less than
/// 1.8 degrees would reach farther, but surfaces are no planes so far.
const STEEPEST: f32 = 32.0;

impl Sample<'_> {
    /// Radiance that arrives at the start of a ray from the photons of photon mapping that are scattered into it; `end` as in
    /// [`Self::gathered`].
    pub(in crate::integrator) fn scattered_in(
        &self,
        pass: &PhotonPass,
        branch: &Branch,
        ray: &Ray,
        end: Option<u32>,
    ) -> Lanes {
        let medium = self.scratch.media[branch.medium.0 as usize];
        let left = |photon: &Photon, value: f32, length: f32| {
            let is_for_paths = is_peak(value) && (photon.scattered || !branch.arrival.specular_from_eye);
            if is_for_paths { Lanes::ZERO } else { medium.transmittance(length) }
        };
        self.gathered((&pass.volume, pass.kernel), branch, ray, end, left)
    }

    /// Radiance that arrives at the start of a ray from photons scattered into it; `end` is the triangle that it ends on,
    /// unless that is hidden: there the ray that goes on takes what this one does not. `left` is what is left of it behind so
    /// many metres of density 1, for a photon and the greatest value of the phase function.
    ///
    /// Where a ray begins or ends at a surface that it meets obliquely, photons beside its line may lie before the one or
    /// behind the other and yet in the medium. No other ray takes the part of their flux that the kernel spreads beyond
    /// the surface: it belongs to the end of this one. Light comes to the eye from where a photon is, so its way through
    /// the medium begins at the plane of the surface before it, not at that of the ray's start.
    pub(in crate::integrator) fn gathered(
        &self,
        (map, kind): (&PhotonMap, KernelKind),
        branch: &Branch,
        ray: &Ray,
        end: Option<u32>,
        left: impl Fn(&Photon, f32, f32) -> Lanes,
    ) -> Lanes {
        if map.is_empty() {
            return Lanes::ZERO;
        }
        let described = self.frame.medium(branch.medium);
        let phase = described.phase.at(self.wavelengths);
        let geometry = &self.frame.geometry;
        let is_start = |&triangle: &u32| triangle != u32::MAX && !self.is_hidden(branch, triangle);
        let start = Some(branch.leaves).filter(is_start);
        let slopes =
            [start, end].map(|triangle| triangle.map(|id| geometry.slope(id, ray.direction, ray.time)));
        let beyond = slopes.map(|slope| slope.map_or(0.0, Vec3::length).min(STEEPEST));
        let before = slopes[0].unwrap_or(Vec3::ZERO);
        let mut sum = Lanes::ZERO;
        map.each_around_ray(ray, beyond, |photon, along, squared, reach| {
            if photon.medium != branch.medium {
                return;
            }
            let beside = photon.position - ray.at(along);
            let t_max = (along + before.dot(beside)).clamp(0.0, ray.t_max);
            let length = described.density.length(&Ray { t_max, ..*ray });
            let value = phase.value(Deflection::between(photon.direction, -ray.direction));
            let left = left(photon, value.max_element(), length);
            sum += photon.flux * left * (value * kernel(kind, squared, reach));
        });
        sum
    }
}
