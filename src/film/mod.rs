//! From samples to image files.
//!
//! ```text
//! filter -> (a path through the scene) -> accumulate -> tiles -> frame image -> error estimate
//!                                                                            -> OpenEXR (what was measured)
//!                                                                            -> tone map -> PNG (to look at)
//! ```
//!
//! * [`filter`] places the samples of a pixel so that each counts with weight one in its own pixel.
//! * [`accumulate`] takes means of exact sums and the variance of each mean from independent replicates.
//! * [`halves`] keeps the two halves of a pixel's samples apart where one decides about the other.
//! * [`frame_image`] cuts a frame into tiles and puts it together again; the order of the tiles has no influence.
//! * [`estimate`] says how far a frame is from the converged picture, with a confidence interval.
//! * [`denoise`](mod@denoise) takes the noise out of a copy, if that is asked for.
//! * [`exr`] and [`png`] encode; [`tonemap`] says how radiance becomes what a screen shows.
//! * [`exr_seal`] tells whether a file is whole.
//! * [`write`](mod@write) makes files appear whole or not at all.
//!
//! A file's bytes depend on its pixels and metadata alone, never on threads, host or time. Radiance is linear Rec. 709
//! RGB, and components may be negative: water is more saturated than a screen.

pub mod accumulate;
pub mod denoise;
pub mod error;
pub mod estimate;
mod exact;
pub mod exr;
mod exr_channels;
mod exr_header;
pub mod exr_layers;
pub mod exr_read;
pub mod exr_seal;
pub mod filter;
pub mod frame_image;
pub mod halves;
mod local_luminance;
mod maker;
pub mod metadata;
pub mod png;
#[cfg(test)]
mod splitmix;
mod sums;
pub mod tonemap;
mod variance_ratio;
pub mod write;
mod write_frame;

pub use accumulate::{FAR_DEPTH, FilmSample, Pixel, PixelAccumulator, REPLICATES};
pub use denoise::{DenoiseError, Denoiser};
pub use error::FilmError;
pub use estimate::{DEFAULT_CONFIDENCE, ErrorEstimate, LUMINANCE_FLOOR, estimate_error};
pub use filter::Filter;
pub use frame_image::{FrameImage, Tile, TileRect, tiles};
pub use halves::{HALVES, HalfSums, joined};
pub use metadata::ImageMetadata;
#[cfg(test)]
pub(crate) use splitmix::SplitMix;
pub use write_frame::{png_bytes, write_frame, write_png_of};
