//! Files of results.

use std::path::Path;

use super::exit::Exit;
use super::streams::say;
use crate::driver::RenderError;
use crate::film::write::write_atomically;

/// Writes results, and says why when they cannot be written.
pub fn write(file: &Path, text: &str) -> Exit {
    match write_atomically(file, text.as_bytes()) {
        Ok(()) => Exit::Complete,
        Err(error) => {
            say(&format!("error: {error}"));
            Exit::from(&RenderError::from(error))
        }
    }
}
