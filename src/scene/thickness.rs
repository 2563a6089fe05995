//! How thick a body is for its surface.
//!
//! ```text
//! w = 6 V / S,   V = sum of a . (b x c) / 6,   S = sum of |(b - a) x (c - a)| / 2
//! ```
//! over the triangles a, b, c around a medium: the diameter of a ball, the edge of a cube, and three times the thickness of a
//! shell. The box around spray tells nothing of its drops, and the box around a shell nothing of what it is made of.
//!
//! Of a surface that does not close, whose areas sum to a vector of some length, the volume is not known.

use glam::DVec3;

use super::geometry::Geometry;
use super::surface::Surface;
use crate::geometry::Bounds;
use crate::optics::medium::MediumId;

/// Areas that sum to a greater share of their magnitudes are not closed.
const CLOSED: f64 = 1e-3;

/// The w of the head in metres, or infinity where there is no volume; `bounds` is the box around the medium.
pub(super) fn thickness(id: MediumId, geometry: &Geometry, surfaces: &[Surface], bounds: &Bounds) -> f32 {
    // +1 where the right-hand normal points out of the medium.
    let sign = |surface: &Surface| match surface.pair() {
        Some(pair) => f64::from(i8::from(pair.back == id) - i8::from(pair.front == id)),
        None => 0.0,
    };
    let signs: Vec<f64> = surfaces.iter().map(sign).collect();
    let centre = bounds.centre().as_dvec3();
    let (mut volume, mut surface, mut areas) = (0.0, 0.0, DVec3::ZERO);
    for triangle in 0..geometry.triangles.len() as u32 {
        let sign = signs[geometry.surfaces[triangle as usize].0 as usize];
        if sign != 0.0 {
            let [a, b, c] = geometry.vertices(triangle).map(|p| p.as_dvec3() - centre);
            let area = (b - a).cross(c - a) * (0.5 * sign);
            volume += a.dot(area) / 3.0;
            surface += area.length();
            areas += area;
        }
    }
    let is_closed = areas.length() <= CLOSED * surface;
    if is_closed && volume > 0.0 { (6.0 * volume / surface) as f32 } else { f32::INFINITY }
}
