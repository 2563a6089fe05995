//! Dense three-dimensional grids of numbers, as files hold them.
//!
//! [`read()`] takes NumPy's `.npy` and NRRD's `.nrrd`; the first index (NumPy) or axis (NRRD) is x. Nothing is allocated
//! because a file says so: declared sizes are first compared with the bytes that are there. The values are relative
//! densities, so each has to be finite and not negative.

mod error;
mod npy;
mod nrrd;
mod numbers;
mod read;

pub use error::VolumeError;
pub use read::{read, read_bytes};

/// A grid of numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Volume {
    /// Cells along x, y and z, none of them 0.
    pub size: [usize; 3],
    /// A value for each cell; x runs fastest.
    pub values: Vec<f32>,
}
