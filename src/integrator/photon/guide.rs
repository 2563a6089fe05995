//! Directions of photons as importance for final gathering `[JENSEN95]`.
//!
//! Photons around a point say where its light comes from. Their flux is summed over [`CELLS`] cells of the cosine lobe
//! that all hold the same part of it; half of the gathered directions follow these sums, the other half the cosine:
//!
//! ```text
//! p(wi) = p_cosine(wi) q(cell),   q = 1/2 + 1/2 CELLS flux(cell) / flux
//! ```

use std::f32::consts::PI;

use glam::Vec3;

use super::map::PhotonMap;
use crate::geometry::Frame;
use crate::geometry::elementary::{atan2, sin_cos};
use crate::scene::geometry::SurfaceHit;

/// Steps of the squared sine of the polar angle, and of the azimuth.
const RINGS: usize = 4;
const SECTORS: usize = 8;
/// Cells of the lobe.
const CELLS: usize = RINGS * SECTORS;
/// Fewer photons than this say nothing.
const FEWEST: u32 = 8;

/// How directions at one point are drawn.
pub(in crate::integrator) struct Guide {
    frame: Frame,
    /// q of each cell; the sum is [`CELLS`].
    relative: [f32; CELLS],
}

impl Guide {
    /// From the photons of a map around a surface point.
    pub(in crate::integrator) fn new(map: &PhotonMap, hit: &SurfaceHit) -> Self {
        let frame = Frame::around(hit.ns);
        let (mut flux, mut total, mut count) = ([0.0_f32; CELLS], 0.0, 0);
        map.each_around(hit.point.position, 0.0, |photon, _, _| {
            let local = frame.to_local(-photon.direction);
            if photon.normal.dot(hit.ng) > 0.0 && local.z > 0.0 {
                let own = photon.flux.element_sum();
                flux[cell_of(local)] += own;
                total += own;
                count += 1;
            }
        });
        let relative = if count < FEWEST || total <= 0.0 {
            [1.0; CELLS]
        } else {
            flux.map(|own| 0.5 + 0.5 * CELLS as f32 * own / total)
        };
        Self { frame, relative }
    }

    /// A direction about the shading normal.
    pub(in crate::integrator) fn sample(&self, u: [f32; 2]) -> Vec3 {
        let mut rest = u[0] * CELLS as f32;
        let mut cell = 0;
        while cell + 1 < CELLS && rest >= self.relative[cell] {
            rest -= self.relative[cell];
            cell += 1;
        }
        let within = (rest / self.relative[cell]).clamp(0.0, 1.0 - f32::EPSILON * 0.5);
        let squared_sine = ((cell / SECTORS) as f32 + u[1]) / RINGS as f32;
        let (sin_phi, cos_phi) = sin_cos(2.0 * PI * ((cell % SECTORS) as f32 + within) / SECTORS as f32);
        let sine = squared_sine.sqrt();
        let local = Vec3::new(sine * cos_phi, sine * sin_phi, (1.0 - squared_sine).max(0.0).sqrt());
        self.frame.to_world(local).normalize()
    }

    /// q of a direction.
    pub(in crate::integrator) fn relative(&self, wi: Vec3) -> f32 {
        self.relative[cell_of(self.frame.to_local(wi))]
    }
}

fn cell_of(local: Vec3) -> usize {
    let squared_sine = local.x * local.x + local.y * local.y;
    let ring = ((squared_sine * RINGS as f32) as usize).min(RINGS - 1);
    let turn = atan2(local.y, local.x) / (2.0 * PI);
    let sector = ((if turn < 0.0 { turn + 1.0 } else { turn } * SECTORS as f32) as usize).min(SECTORS - 1);
    ring * SECTORS + sector
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::offset::SurfacePoint;
    use crate::integrator::photon::map::Photon;
    use crate::optics::medium::MediumId;
    use crate::spectrum::Lanes;

    fn hit() -> SurfaceHit {
        let point = SurfacePoint { position: Vec3::ZERO, error: Vec3::ZERO };
        let n = Vec3::new(0.3, -0.2, 0.9).normalize();
        SurfaceHit { triangle: 0, t: 1.0, point, ng: n, ns: n, from_front: true }
    }

    fn guide(photons: u32) -> Guide {
        let photon = |i: u32| Photon {
            position: Vec3::ZERO,
            direction: -(hit().ng + Vec3::new(0.5, 0.2 * (i % 3) as f32, 0.0)).normalize(),
            normal: hit().ng,
            medium: MediumId(0),
            flux: Lanes::splat(1.0 + i as f32),
            scattered: true,
            spread: 1.0,
        };
        Guide::new(&PhotonMap::new(&(0..photons).map(photon).collect::<Vec<_>>(), 1.0), &hit())
    }

    /// Cells of samples have the probabilities that `relative` states, within the strata of the numbers.
    #[test]
    fn samples_follow_the_cells() {
        for (photons, greatest) in [(3, 1.0), (60, 5.0)] {
            let guide = guide(photons);
            assert!((guide.relative.iter().sum::<f32>() - CELLS as f32).abs() < 1e-4);
            assert!(guide.relative.iter().copied().fold(0.0, f32::max) >= greatest);
            let (n, mut counts) = (1024, [0.0_f32; CELLS]);
            for i in 0..n * n {
                let u = [(i % n) as f32 + 0.5, (i / n) as f32 + 0.5].map(|x| x / n as f32);
                let wi = guide.sample(u);
                assert!(wi.dot(hit().ns) > -1e-6);
                counts[cell_of(guide.frame.to_local(wi))] += 1.0 / (n * n) as f32;
            }
            for (count, relative) in counts.iter().zip(guide.relative) {
                // One of 1024 strata, and what rounding puts beyond the border of a cell.
                assert!((count - relative / CELLS as f32).abs() < 2e-3, "{count} {relative}");
            }
        }
    }
}
