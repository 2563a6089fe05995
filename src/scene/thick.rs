//! Thick media that are seen from outside only: what happens deep in them may be simplified.
//!
//! ```text
//! tau* = sigma_s (1 - g) d,   least sigma_s of all lanes, d the least edge of the box around the medium's interfaces
//! ```
//! Where tau* is [`THICK`] or more, scattering is replaced by what is similar to it ([`crate::optics::similarity`]).
//! Media of varying density are left alone: somewhere they are thin.
//!
//! Media that absorb and let next to nothing through lead their walks to the surface ([`crate::optics::dwivedi`]), which changes no expectation;
//! not those whose phase function differs from wavelength to wavelength.

use super::geometry::Geometry;
use super::surface::Surface;
use crate::geometry::Bounds;
use crate::optics::dwivedi;
use crate::optics::medium::Medium;
use crate::optics::medium_reduction::MediumReduction;
use crate::optics::phase::PhaseFunction;

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
    /// The share of collisions that is left, the greatest of all wavelengths.
    pub alpha: f32,
}

/// Reduces the thick media of a frame, those that have a reduction.
pub(super) fn reduce(
    media: &mut [Medium],
    reductions: &[Option<MediumReduction>],
    order: u32,
    endless: &[bool],
    boxes: &[Bounds],
) -> Vec<Reduced> {
    let mut reduced = Vec::new();
    for ((medium, reduction), (endless, bounds)) in
        media.iter_mut().zip(reductions).zip(endless.iter().zip(boxes))
    {
        let Some(MediumReduction { alpha, phase }) = reduction else { continue };
        if medium.sigma_s.is_zero() || !medium.density.is_homogeneous() {
            continue;
        }
        if is_thick(medium, *endless, bounds) {
            medium.sigma_s = medium.sigma_s.combined(alpha, |sigma_s, alpha| sigma_s * alpha);
            medium.phase = phase.clone();
            reduced.push(Reduced { medium: medium.name.clone(), order, alpha: alpha.maximum() });
        }
    }
    reduced
}

/// The media of a frame whose walks are worth leading to the surface.
pub(super) fn led(media: &[Medium], endless: &[bool], boxes: &[Bounds]) -> Vec<bool> {
    let is_led = |(medium, (endless, bounds)): (&Medium, (&bool, &Bounds))| {
        is_worth_leading(medium) && (*endless || is_opaque(medium, bounds))
    };
    media.iter().zip(endless.iter().zip(boxes)).map(is_led).collect()
}

/// True where much is absorbed, but not nearly all.
fn is_worth_leading(medium: &Medium) -> bool {
    let albedo = |s: f32, a: f32| if s > 0.0 { s / (s + a) } else { 0.0 };
    let albedo = medium.reduced_scattering().combined(&medium.sigma_a, albedo).maximum();
    let is_drawn_exactly = medium.phase.one().is_some_and(PhaseFunction::is_sampled_exactly);
    medium.density.is_homogeneous() && is_drawn_exactly && LED.contains(&albedo)
}

/// True where walks that are led the wrong way do not matter: next to no light gets through.
fn is_opaque(medium: &Medium, bounds: &Bounds) -> bool {
    let kappa = medium.reduced_scattering().combined(&medium.sigma_a, dwivedi::decay);
    kappa.minimum() * bounds.size().min_element() >= OPAQUE
}

/// True where the reduced optical size is [`THICK`] or more.
fn is_thick(medium: &Medium, is_endless: bool, bounds: &Bounds) -> bool {
    let per_metre = medium.reduced_scattering().minimum();
    let extent = if is_endless { f32::INFINITY } else { bounds.size().min_element() };
    per_metre > 0.0 && per_metre * extent >= THICK
}

/// The boxes around the interfaces of the media that scatter, by their number; empty of all others, which nobody asks for.
pub(super) fn boxes(media: &[Medium], geometry: &Geometry, surfaces: &[Surface]) -> Vec<Bounds> {
    let mut boxes = vec![Bounds::EMPTY; media.len()];
    let scatters: Vec<bool> = media.iter().map(|medium| !medium.sigma_s.is_zero()).collect();
    if !scatters.contains(&true) {
        return boxes;
    }
    let sides = |surface: &Surface| match surface.pair() {
        Some(pair) => [pair.front, pair.back].map(|id| Some(id.0 as usize).filter(|&id| scatters[id])),
        None => [None; 2],
    };
    let sides: Vec<[Option<usize>; 2]> = surfaces.iter().map(sides).collect();
    for (triangle, surface) in (0..).zip(&geometry.surfaces) {
        for id in sides[surface.0 as usize].into_iter().flatten() {
            boxes[id] = geometry.vertices(triangle).into_iter().fold(boxes[id], Bounds::including);
        }
    }
    boxes
}
