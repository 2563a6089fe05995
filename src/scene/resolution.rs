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

use crate::geometry::Bounds;
use crate::optics::medium::Medium;

/// Below it no flight in ten million is led astray: what is finer is not asked for.
const FINE: f32 = 1e-5;

/// The roughness of the media of a frame that scatter, the greatest of all; 0 where it does not matter. `boxes` are those
/// around the media.
pub(super) fn roughness(media: &[Medium], boxes: &[Bounds]) -> f32 {
    let of_medium = |(medium, bounds): (&Medium, &Bounds)| {
        let sigma_t = medium.sigma_s.combined(&medium.sigma_a, |s, a| s + a).maximum();
        let found = if medium.sigma_s.is_zero() { 0.0 } else { roughness_within(bounds, sigma_t) };
        if found > FINE { found } else { 0.0 }
    };
    media.iter().zip(boxes).map(of_medium).fold(0.0, f32::max)
}

fn roughness_within(bounds: &Bounds, sigma_t: f32) -> f32 {
    if bounds.is_empty() {
        return 0.0;
    }
    f32::EPSILON * sigma_t * bounds.min.abs().max(bounds.max.abs()).max_element()
}
