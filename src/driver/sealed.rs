//! Files of sums: a head, what follows in the encoding of postcard, and a seal, which is the SHA-256 of all before it.
//!
//! They appear in one step. Sums are there bit by bit, so what is made of them is the same on any machine.

use std::fs::File;
use std::io::Write;
use std::path::Path;

use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::film::write::StagedFile;
use crate::film::{FilmError, HalfSums, Pixel, PixelAccumulator};
use crate::integrator::Counters;

/// Bytes of the seal.
pub(super) const SEAL: usize = 32;

/// Sizes of what is in such files, for their heads: pixels of another size are those of another build.
pub(super) fn layout() -> String {
    let sizes =
        [size_of::<Pixel>(), size_of::<PixelAccumulator>(), size_of::<HalfSums>(), size_of::<Counters>()];
    format!("{sizes:?}")
}

/// Replaces a file in one step.
///
/// # Errors
/// When it cannot be written; the one before it is left then.
pub(super) fn write(path: &Path, head: &[u8], contents: &impl Serialize) -> Result<(), FilmError> {
    StagedFile::written(path, |file| {
        let mut hashed = Hashed { file, hasher: Sha256::new() };
        hashed.write_all(head)?;
        let mut buffered = std::io::BufWriter::with_capacity(1 << 16, hashed);
        postcard::to_io(contents, &mut buffered).map_err(std::io::Error::other)?;
        let Hashed { file, hasher } = buffered.into_inner()?;
        file.write_all(&hasher.finalize())
    })?
    .commit()
}

/// What is before the seal; `None` when that is not right.
pub(super) fn unsealed(bytes: &[u8]) -> Option<&[u8]> {
    let (body, seal) = bytes.split_last_chunk::<SEAL>()?;
    (Sha256::digest(body).as_slice() == seal).then_some(body)
}

/// Hashes what it writes.
struct Hashed<'a> {
    file: &'a mut File,
    hasher: Sha256,
}

impl Write for Hashed<'_> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let written = self.file.write(bytes)?;
        self.hasher.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.file.flush()
    }
}
