//! Thick media that are seen from outside only: what happens deep in them may be simplified.
//!
//! ```text
//! tau* = sigma_s (1 - g) d,   least sigma_s of all lanes, d the least edge of the box around the medium's interfaces
//! ```
//! Where tau* is [`THICK`] or more, scattering is replaced by what is similar to it ([`crate::optics::similarity`]).
//! Media of varying density are left alone: somewhere they are thin.
//!
//! Media that absorb and let next to nothing through lead their walks to the surface ([`crate::optics::dwivedi`]), which changes no expectation.

use super::geometry::Geometry;
use super::surface::{MediumPair, Surface};
use crate::geometry::Bounds;
use crate::optics::dwivedi;
use crate::optics::medium::{Medium, MediumId};
use crate::optics::similarity::Reduction;
use crate::spectrum::LaneCurve;

/// The reduced optical size from which on media are reduced; measured, see [`crate::integrator`].
pub const THICK: f32 = 4.0;

/// Reduced albedos, greatest of all lanes, whose walks are led to the surface; measured, see [`crate::integrator`].
const LED: std::ops::RangeInclusive<f32> = 0.7..=0.998;
/// kappa d from which on they are: light falls off as exp(-kappa z). Walks to the far side get weights like its inverse.
const OPAQUE: f32 = 10.0;

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
        if is_thick(medium, endless[id.0 as usize], || extents(id)) {
            let share = *alpha as f32;
            medium.sigma_s =
                medium.sigma_s.combined(&LaneCurve::Constant(share), |sigma_s, alpha| sigma_s * alpha);
            medium.phase = phase.clone();
            reduced.push(Reduced { medium: medium.name.clone(), order, alpha: *alpha });
        }
    }
    reduced
}

/// The media of a frame whose walks are worth leading to the surface.
pub(super) fn led(media: &[Medium], endless: &[bool], extents: impl Fn(MediumId) -> f32) -> Vec<bool> {
    let is_led = |(medium, id): (&Medium, MediumId)| {
        is_worth_leading(medium) && (endless[id.0 as usize] || is_opaque(medium, extents(id)))
    };
    media.iter().zip((0..).map(MediumId)).map(is_led).collect()
}

/// True where much is absorbed, but not nearly all.
fn is_worth_leading(medium: &Medium) -> bool {
    let rest = 1.0 - medium.phase.mean_cosine();
    let albedo = |s: f32, a: f32| if s > 0.0 { s * rest / (s * rest + a) } else { 0.0 };
    let albedo = medium.sigma_s.combined(&medium.sigma_a, albedo).maximum();
    medium.density.is_homogeneous() && medium.phase.is_sampled_exactly() && LED.contains(&albedo)
}

/// True where walks that are led the wrong way do not matter: next to no light gets through.
fn is_opaque(medium: &Medium, extent: f32) -> bool {
    let rest = 1.0 - medium.phase.mean_cosine();
    let kappa = medium.sigma_s.combined(&medium.sigma_a, |s, a| dwivedi::decay(s * rest, a));
    kappa.minimum() * extent >= OPAQUE
}

/// True where the reduced optical size is [`THICK`] or more.
fn is_thick(medium: &Medium, is_endless: bool, extent: impl Fn() -> f32) -> bool {
    let per_metre = medium.sigma_s.minimum() * (1.0 - medium.phase.mean_cosine());
    let extent = if is_endless || per_metre <= 0.0 { f32::INFINITY } else { extent() };
    per_metre > 0.0 && per_metre * extent >= THICK
}

/// The least edge of the box around the interfaces of a medium in metres; 0 without any.
pub(super) fn least_extent(id: MediumId, geometry: &Geometry, surfaces: &[Surface]) -> f32 {
    bounds_of(id, geometry, surfaces).size().min_element()
}

/// The box around the interfaces of a medium.
pub(super) fn bounds_of(id: MediumId, geometry: &Geometry, surfaces: &[Surface]) -> Bounds {
    let is_of = |pair: &MediumPair| pair.front == id || pair.back == id;
    let own: Vec<bool> = surfaces.iter().map(|s| s.pair().is_some_and(is_of)).collect();
    let corners = (0..geometry.triangles.len() as u32)
        .filter(|&triangle| own[geometry.surfaces[triangle as usize].0 as usize])
        .flat_map(|triangle| geometry.vertices(triangle));
    Bounds::of_points(corners)
}
