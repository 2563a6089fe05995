//! Ambient occlusion: the cosine-weighted part of the hemisphere over the first surface that nothing covers.
//!
//! ```text
//! A = (1 / pi) integral of V(wi) cos(wi, n) over the hemisphere
//! ```
//! Every surface counts as opaque, index-matched or not; the sky is white. A quick look at a mesh.

use super::{EyeSample, FirstHit, Scratch};
use crate::accel::Ignored;
use crate::geometry::{Frame as Basis, Ray};
use crate::sampling::{SampleStream, warp};
use crate::scene::frame::Frame;
use crate::spectrum::Lanes;

/// Ambient occlusion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AmbientOcclusion;

impl AmbientOcclusion {
    pub(super) fn trace(
        self,
        frame: &Frame,
        scratch: &mut Scratch,
        ray: &Ray,
        mut stream: SampleStream,
    ) -> EyeSample {
        scratch.counters.rays += 1;
        let Some(hit) = frame.accel.closest(ray, Ignored::NOTHING) else {
            return EyeSample { radiance: Lanes::ONE, first: None };
        };
        let hit = frame.geometry.surface_hit(&hit, ray.direction, ray.time);
        let u = stream.next4();
        let local = warp::cosine_hemisphere([u[0], u[1]]);
        let mut wi = Basis::around(hit.ns).to_world(local).normalize();
        if wi.dot(hit.ng) <= 0.0 {
            wi = Basis::around(hit.ng).to_world(local).normalize();
        }
        scratch.counters.shadow_rays += 1;
        let shadow = Ray::new(hit.point.spawn(hit.ng, wi), wi).at_time(ray.time);
        let open = !frame.accel.occluded(&shadow, Ignored::one(hit.triangle));
        let position = hit.point.position;
        let motion = frame.geometry.motion(hit.triangle, position, ray.time);
        let first = FirstHit { distance: hit.t, position, normal: hit.ns, albedo: Lanes::ONE, motion };
        EyeSample { radiance: if open { Lanes::ONE } else { Lanes::ZERO }, first: Some(first) }
    }
}
