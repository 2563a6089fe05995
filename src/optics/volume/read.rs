//! Reads a grid's file of any known format.

use std::path::Path;

use super::error::{Fault, VolumeError};
use super::{Volume, npy, nrrd};

/// Reads a grid from a file; its first bytes tell the format.
///
/// # Errors
/// [`VolumeError`] when the file cannot be read, is of no known format, or its contents are wrong.
pub fn read(path: &Path) -> Result<Volume, VolumeError> {
    let bytes = std::fs::read(path).map_err(|source| VolumeError::Io { path: path.to_owned(), source })?;
    read_bytes(&bytes, path)
}

/// Reads a grid from the contents of a file; `path` is only named in messages.
///
/// # Errors
/// [`VolumeError`] when the contents are of no known format or wrong.
pub fn read_bytes(bytes: &[u8], path: &Path) -> Result<Volume, VolumeError> {
    let volume = if bytes.starts_with(npy::MAGIC) {
        npy::read(bytes)
    } else if bytes.starts_with(nrrd::MAGIC) {
        nrrd::read(bytes)
    } else {
        let problem = "the file starts neither as .npy nor as .nrrd".to_owned();
        Err(Fault::Unsupported(problem, "write the grid with numpy.save, or as NRRD with its data attached"))
    };
    volume.map_err(|fault| fault.in_file(path))
}
