//! Thick media that are seen from outside only: what happens deep in them may be simplified.
//!
//! ```text
//! tau* = sigma_s (1 - g) d,   least sigma_s of all lanes, d the least edge of the box around the medium's interfaces
//! ```
//! Where tau* is [`THICK`] or more, scattering is replaced by what is similar to it ([`crate::optics::similarity`]).
//! Media of varying density are left alone: somewhere they are thin.

use super::geometry::Geometry;
use super::surface::{MediumPair, Surface};
use crate::geometry::Bounds;
use crate::optics::medium::{Medium, MediumId};
use crate::optics::similarity::Reduction;
use crate::spectrum::LaneCurve;

/// The reduced optical size from which on media are reduced; measured, see [`crate::integrator`].
pub const THICK: f32 = 4.0;

/// A medium whose scattering was replaced in a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduced {
    /// Its name.
    pub medium: String,
    /// The order of the similarity relations.
    pub order: u32,
    /// The share of collisions that is left.
    pub alpha: f64,
}

/// Reduces the thick media of a frame, those that have a reduction.
pub(super) fn reduce(
    media: &mut [Medium],
    reductions: &[Option<Reduction>],
    order: u32,
    endless: &[bool],
    extents: impl Fn(MediumId) -> f32,
) -> Vec<Reduced> {
    let mut reduced = Vec::new();
    for ((medium, reduction), id) in media.iter_mut().zip(reductions).zip((0..).map(MediumId)) {
        let Some(Reduction { alpha, phase }) = reduction else { continue };
        if medium.sigma_s.is_zero() || !medium.density.is_homogeneous() {
            continue;
        }
        let extent = if endless[id.0 as usize] { f32::INFINITY } else { extents(id) };
        let per_metre = medium.sigma_s.minimum() * (1.0 - medium.phase.mean_cosine());
        if per_metre > 0.0 && per_metre * extent >= THICK {
            let share = *alpha as f32;
            medium.sigma_s =
                medium.sigma_s.combined(&LaneCurve::Constant(share), |sigma_s, alpha| sigma_s * alpha);
            medium.phase = phase.clone();
            reduced.push(Reduced { medium: medium.name.clone(), order, alpha: *alpha });
        }
    }
    reduced
}

/// The least edge of the box around the interfaces of a medium in metres; 0 without any.
pub(super) fn least_extent(id: MediumId, geometry: &Geometry, surfaces: &[Surface]) -> f32 {
    let is_of = |pair: &MediumPair| pair.front == id || pair.back == id;
    let own: Vec<bool> =
        surfaces.iter().map(|s| matches!(s, Surface::Interface(pair) if is_of(pair))).collect();
    let corners = (0..geometry.triangles.len() as u32)
        .filter(|&triangle| own[geometry.surfaces[triangle as usize].0 as usize])
        .flat_map(|triangle| geometry.vertices(triangle));
    Bounds::of_points(corners).size().min_element()
}
