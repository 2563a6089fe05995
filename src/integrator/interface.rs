//! Where light goes at a smooth interface, for eye paths and, adjoint to them, for photons.
//!
//! An eye path that leaves along `wo` bends about the shading normal when both of its ways, reflection and refraction,
//! then lie on the proper sides of the surface; else about the geometric one. Photons must follow exactly the reversed
//! ways: a photon that arrives from `wi` may leave along the directions `wo` from which an eye path would have come to
//! `wi`, at most one about each normal on each side. Each carries its share of the flux and Veach's correction for
//! shading normals `[VEACH97 eq. 5.19]`,
//!
//! ```text
//! F |wi . m| |wo . ng| / (|wi . ng| |wo . m|),      F the reflectance, or 1 less it, and m the normal that is used
//! ```
//! which follows from Snell's law: n_o^2 |wo . m| d(wo) = n_i^2 |wi . m| d(wi) turns the flux of radiance that the eye
//! path measures into that of the photon. With flat normals the shares sum to 1.

use glam::Vec3;

use crate::optics::fresnel;
use crate::optics::refraction::{reflect, refract};

/// Reflected and refracted directions at an interface; no refraction is total reflection.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ways {
    pub(super) reflectance: f32,
    pub(super) reflected: Vec3,
    pub(super) refracted: Option<Vec3>,
    /// True when they are about the shading normal.
    pub(super) shaded: bool,
}

/// Both ways about the shading normal `ns`; about the geometric one when either would end up on the wrong side, or when
/// `ns` itself is not on the side of `wo`.
#[inline]
pub(super) fn ways(wo: Vec3, ns: Vec3, ng: Vec3, eta_t_over_i: f32) -> Ways {
    let about = |normal: Vec3, shaded: bool| Ways {
        reflectance: fresnel::dielectric(wo.dot(normal), eta_t_over_i).reflectance,
        reflected: reflect(wo, normal),
        refracted: refract(wo, normal, eta_t_over_i),
        shaded,
    };
    if ns == ng || wo.dot(ns) <= 0.0 || ns.dot(ng) <= 0.0 {
        return about(ng, false);
    }
    let shaded = about(ns, true);
    let sound = shaded.reflected.dot(ng) > 0.0 && shaded.refracted.is_none_or(|d| d.dot(ng) < 0.0);
    if sound { shaded } else { about(ng, false) }
}

/// A way for photons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PhotonWay {
    /// New direction of travel.
    pub(super) direction: Vec3,
    /// True when it goes on beyond the interface.
    pub(super) crosses: bool,
    /// Flux along it over the flux that arrives.
    pub(super) share: f32,
}

/// All ways of a photon that arrives from `wi`, with the interpolated normal `ns` and `ng` on that side; unused entries
/// have a share of 0.
pub(super) fn photon_ways(wi: Vec3, ns: Vec3, ng: Vec3, eta_t_over_i: f32) -> [PhotonWay; 4] {
    let none = PhotonWay { direction: wi, crosses: false, share: 0.0 };
    let mut ways = [none; 4];
    let pairs = [(ns, true), (ng, false)];
    for (pair, (normal, shaded)) in ways.chunks_exact_mut(2).zip(pairs) {
        let is_useless = shaded && (ns == ng || wi.dot(ns) <= 0.0 || ns.dot(ng) <= 0.0);
        if is_useless {
            continue;
        }
        let reflectance = fresnel::dielectric(wi.dot(normal), eta_t_over_i).reflectance;
        pair[0] = reversed(wi, reflect(wi, normal), reflectance, normal, (ns, ng), eta_t_over_i, shaded);
        if let Some(wo) = refract(wi, normal, eta_t_over_i) {
            pair[1] = reversed(wi, wo, 1.0 - reflectance, normal, (ns, ng), eta_t_over_i, shaded);
        }
    }
    ways
}

/// The way to `wo`, if an eye path from there comes to `wi` about the same normal.
fn reversed(
    wi: Vec3,
    wo: Vec3,
    fresnel: f32,
    normal: Vec3,
    (ns, ng): (Vec3, Vec3),
    eta_t_over_i: f32,
    shaded: bool,
) -> PhotonWay {
    let reflects = wo.dot(normal) > 0.0;
    let nothing = PhotonWay { direction: wo, crosses: !reflects, share: 0.0 };
    let stays = wo.dot(ng) > 0.0;
    if stays != reflects {
        return nothing;
    }
    if ns != ng {
        let seen =
            if reflects { ways(wo, ns, ng, eta_t_over_i) } else { ways(wo, -ns, -ng, 1.0 / eta_t_over_i) };
        if seen.shaded != shaded {
            return nothing;
        }
    }
    let correction = wi.dot(normal) * wo.dot(ng) / (wi.dot(ng) * wo.dot(normal));
    PhotonWay { share: fresnel * correction.abs(), ..nothing }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{SampleSeed, SampleStream, warp};

    fn direction(i: u32, which: u32) -> Vec3 {
        let u = SampleStream::new(SampleSeed::new(3), i, which, 0).next4();
        let d = warp::sphere([u[0], u[1]]);
        Vec3::new(d.x, d.y, d.z.abs().max(1e-3)).normalize()
    }

    /// Normals that lean as far as those of coarse meshes do, and farther.
    fn normal(i: u32) -> Vec3 {
        (Vec3::Z + direction(i, 7) * [0.0, 0.3, 1.0, 3.0][i as usize % 4]).normalize()
    }

    /// The same way within the rounding of two refractions, which grows towards the critical angle.
    fn is_same(a: Vec3, b: Vec3) -> bool {
        a.distance(b) < 2e-3
    }

    /// Share, correction included, with which photons must follow a way of an eye path back.
    fn adjoint(fresnel: f32, wi: Vec3, wo: Vec3, normal: Vec3) -> f32 {
        fresnel * (wi.dot(normal) * wo.z / (wi.z * wo.dot(normal))).abs()
    }

    /// Every way of an eye path is found by the photon that arrives along it, with the share that the change of variables
    /// gives. Directions within 1e-3 of a decision (grazing, or the border between the normals) may fall on either side.
    #[test]
    fn photons_follow_every_way_of_eye_paths() {
        let (mut followed, mut missed, mut shaded) = (0, 0, 0);
        for i in 0..40_000 {
            let (wo, ns) = (direction(i, 0), normal(i));
            let eta = [1.33, 0.75, 1.000_01, 2.4][i as usize / 4 % 4];
            let eye = ways(wo, ns, Vec3::Z, eta);
            let used = if eye.shaded { ns } else { Vec3::Z };
            shaded += u32::from(eye.shaded);
            let mut check = |wi: Vec3, fresnel: f32, photon: [PhotonWay; 4], crosses: bool| {
                let expected = adjoint(fresnel, wi, wo, used);
                let found = photon.iter().any(|way| {
                    way.crosses == crosses
                        && is_same(way.direction, wo)
                        && (way.share - expected).abs() <= 2e-2 * expected + 1e-6
                });
                followed += u32::from(found);
                missed += u32::from(!found && expected > 1e-6);
            };
            check(eye.reflected, eye.reflectance, photon_ways(eye.reflected, ns, Vec3::Z, eta), false);
            if let Some(wi) = eye.refracted {
                check(wi, 1.0 - eye.reflectance, photon_ways(wi, -ns, -Vec3::Z, 1.0 / eta), true);
            }
        }
        assert!(followed > 60_000 && shaded > 10_000, "{followed} {shaded}");
        assert!(missed <= followed / 500, "{missed} of {followed} ways have no photon");
    }

    /// Every way of a photon is one of the eye path that comes back along it.
    #[test]
    fn eye_paths_follow_every_way_of_photons() {
        let (mut followed, mut missed) = (0, 0);
        for i in 0..40_000 {
            let (wi, ns) = (direction(i, 1), normal(i));
            let eta = [1.33, 0.75, 1.000_01, 2.4][i as usize / 4 % 4];
            for way in photon_ways(wi, ns, Vec3::Z, eta) {
                if way.share < 1e-6 {
                    continue;
                }
                let eye = if way.crosses {
                    ways(way.direction, -ns, -Vec3::Z, 1.0 / eta)
                } else {
                    ways(way.direction, ns, Vec3::Z, eta)
                };
                let back = if way.crosses { eye.refracted } else { Some(eye.reflected) };
                let found = back.is_some_and(|d| is_same(d, wi));
                followed += u32::from(found);
                missed += u32::from(!found);
            }
        }
        assert!(followed > 60_000, "{followed}");
        assert!(missed <= followed / 500, "{missed} of {followed} ways lead elsewhere");
    }

    #[test]
    fn flat_interfaces_share_all_the_flux() {
        for i in 0..10_000 {
            let wi = direction(i, 2);
            let total: f32 = photon_ways(wi, Vec3::Z, Vec3::Z, 1.33).iter().map(|way| way.share).sum();
            assert!((total - 1.0).abs() < 1e-5, "{wi}: {total}");
        }
    }
}
