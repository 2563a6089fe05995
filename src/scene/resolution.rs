//! How rough coordinates are, measured by free paths.
//!
//! ```text
//! roughness = 2^-23 x sigma_t,   x the greatest coordinate in metres, sigma_t the greatest extinction of all lanes
//! ```
//! A particle that is nearer to a surface than coordinates are rounded may come to lie beyond it, and the path finds out when it
//! comes back. So labels disagree in sound frames, too, in proportion to the roughness: see [`Frame::roughness`] and
//! [`Counters::too_many_mismatches`].
//!
//! [`Frame::roughness`]: super::frame::Frame::roughness
//! [`Counters::too_many_mismatches`]: crate::integrator::Counters::too_many_mismatches

use super::geometry::Geometry;
use super::surface::Surface;
use super::thick;
use crate::geometry::Bounds;
use crate::optics::medium::{Medium, MediumId};

/// Below it no flight in ten million is led astray: what is finer is not asked for.
const FINE: f32 = 1e-5;

/// The roughness of the media of a frame that scatter, the greatest of all; 0 where it does not matter.
pub(super) fn roughness(media: &[Medium], geometry: &Geometry, surfaces: &[Surface], all: &Bounds) -> f32 {
    let matters = |of: f32| if of > FINE { of } else { 0.0 };
    let of_medium = |(medium, id): (&Medium, MediumId)| {
        let sigma_t = medium.sigma_s.combined(&medium.sigma_a, |s, a| s + a).maximum();
        if medium.sigma_s.is_zero() || matters(roughness_within(all, sigma_t)) == 0.0 {
            return 0.0;
        }
        matters(roughness_within(&thick::bounds_of(id, geometry, surfaces), sigma_t))
    };
    media.iter().zip((0..).map(MediumId)).map(of_medium).fold(0.0, f32::max)
}

fn roughness_within(bounds: &Bounds, sigma_t: f32) -> f32 {
    if bounds.is_empty() {
        return 0.0;
    }
    f32::EPSILON * sigma_t * bounds.min.abs().max(bounds.max.abs()).max_element()
}
