//! A frame that is not done yet, on the disk: `.frame_0001.checkpoint` beside `frame_0001.exr`.
//!
//! ```text
//! head (what kind of file, sizes of what is in it), fingerprint, tiles, counters and seconds, seal
//! ```
//!
//! Sums are there bit by bit, so a frame that goes on ends as the same bytes. The file is replaced in one step and
//! belongs to one fingerprint: what another scene, mesh or version left behind is never taken for this frame's.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use super::accumulation::{Accumulation, TilePart};
use super::fingerprint::Fingerprint;
use super::sealed::{self, layout};
use crate::film::FilmError;
use crate::integrator::Counters;

/// What a file begins with.
fn head() -> String {
    format!("floe checkpoint 3 {}\n", layout())
}

/// The checkpoint of a picture.
#[derive(Clone, Debug)]
pub(super) struct Checkpoint {
    path: PathBuf,
    fingerprint: Fingerprint,
}

impl Checkpoint {
    /// That of a picture, which need not be there.
    pub fn of(picture: &Path, fingerprint: Fingerprint) -> Self {
        Self { path: Self::path_beside(picture), fingerprint }
    }

    /// Where the checkpoint of a picture is.
    pub fn path_beside(picture: &Path) -> PathBuf {
        let stem = picture.file_stem().unwrap_or_default().to_string_lossy();
        picture.with_file_name(format!(".{stem}.checkpoint"))
    }

    /// Whether it is there and of this fingerprint, by its first bytes.
    pub fn is_there(&self) -> bool {
        let mut wanted = head().into_bytes();
        wanted.extend(self.fingerprint.0);
        let mut start = vec![0; wanted.len()];
        File::open(&self.path).and_then(|mut file| file.read_exact(&mut start)).is_ok() && start == wanted
    }

    /// A hash of the samples in that of a picture, whatever time they took; `None` where there is none.
    pub fn samples_beside(picture: &Path) -> Option<[u8; sealed::SEAL]> {
        let bytes = std::fs::read(Self::path_beside(picture)).ok()?;
        let samples = bytes.len().checked_sub(sealed::SEAL + size_of::<f64>())?;
        Some(Sha256::digest(&bytes[..samples]).into())
    }

    /// Replaces it by a frame that has taken so many seconds.
    ///
    /// # Errors
    /// When it cannot be written; the one before it is left then.
    pub fn save(&self, accumulation: &Accumulation, seconds: f64) -> Result<(), FilmError> {
        let contents = (&accumulation.parts, &accumulation.counters, seconds);
        let head = [head().as_bytes(), &self.fingerprint.0].concat();
        sealed::write(&self.path, &head, &contents)
    }

    /// Puts what it holds into an accumulation and tells the seconds that this took; `None` when there is none.
    ///
    /// # Errors
    /// Why one that is there is of no use, in words; the accumulation is as it was then.
    pub fn load(&self, accumulation: &mut Accumulation) -> Result<Option<f64>, String> {
        let bytes = match std::fs::read(&self.path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(self.says(&format!("cannot be read: {error}"))),
        };
        let (parts, counters, seconds) = self.decode(&bytes).map_err(|reason| self.says(reason))?;
        if accumulation.restore(parts, counters) {
            Ok(Some(seconds))
        } else {
            Err(self.says("is of a picture of another size"))
        }
    }

    fn decode(&self, bytes: &[u8]) -> Result<Contents, &'static str> {
        let damaged = "is damaged";
        let body = sealed::unsealed(bytes).ok_or(damaged)?;
        let body = body.strip_prefix(head().as_bytes()).ok_or("was left by another version")?;
        let body = body.strip_prefix(&self.fingerprint.0).ok_or("is of another scene, mesh or frame")?;
        match postcard::take_from_bytes(body) {
            Ok((contents, [])) => Ok(contents),
            _ => Err(damaged),
        }
    }

    fn says(&self, reason: &str) -> String {
        format!("{}: the checkpoint {reason}; the frame begins anew", self.path.display())
    }

    /// Takes it away, whatever it is; a frame that is done needs none.
    pub fn remove(&self) {
        let _ = std::fs::remove_file(&self.path);
    }

    /// Takes away that of a picture which is whole, left by a run that was killed in between.
    pub fn remove_beside(picture: &Path) {
        let _ = std::fs::remove_file(Self::path_beside(picture));
    }
}

/// Tiles, counters, and the seconds that they took.
type Contents = (Vec<TilePart>, Counters, f64);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{FilmSample, PixelAccumulator};
    use glam::Vec3;

    const FINGERPRINT: Fingerprint = Fingerprint([3; 16]);

    /// A frame of 20 x 3 pixels in two tiles, the first of them half done.
    fn begun() -> Accumulation {
        let mut begun = Accumulation::new([20, 3]);
        let mut sum = PixelAccumulator::new();
        sum.add(1, &FilmSample::of_sky(Vec3::new(0.1, f32::MIN_POSITIVE / 4.0, -0.3)));
        begun.parts[0].pixels = vec![sum.finish(); 7];
        begun.parts[0].counters.rays = u64::MAX;
        begun.parts[1].sums = vec![sum.clone(); 12];
        begun.parts[1].passes = 5;
        begun.parts[1].ahead = 11;
        begun.counters.photons = 8;
        begun
    }

    #[test]
    fn what_was_saved_comes_back() {
        let folder = tempfile::tempdir().unwrap();
        let checkpoint = Checkpoint::of(&folder.path().join("a.1.exr"), FINGERPRINT);
        let mut loaded = Accumulation::new([20, 3]);
        assert_eq!((checkpoint.load(&mut loaded), checkpoint.is_there()), (Ok(None), false));
        checkpoint.save(&begun(), 2.5).unwrap();
        assert!(folder.path().join(".a.1.checkpoint").is_file());
        assert_eq!((checkpoint.load(&mut loaded), checkpoint.is_there()), (Ok(Some(2.5)), true));
        assert_eq!(loaded, begun());
        let samples = || Checkpoint::samples_beside(&folder.path().join("a.1.exr")).unwrap();
        let before = samples();
        checkpoint.save(&loaded, 3.5).unwrap();
        assert_eq!(samples(), before, "more time, and nothing else");
        loaded.parts[1].passes += 1;
        checkpoint.save(&loaded, 3.5).unwrap();
        assert_ne!(samples(), before);
        checkpoint.remove();
        assert!(!checkpoint.is_there());
    }

    #[test]
    fn another_frame_and_another_size_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let picture = folder.path().join("a.exr");
        Checkpoint::of(&picture, FINGERPRINT).save(&begun(), 2.5).unwrap();
        let other = Checkpoint::of(&picture, Fingerprint([4; 16]));
        let mut loaded = Accumulation::new([20, 3]);
        assert!(other.load(&mut loaded).unwrap_err().contains("another scene, mesh or frame"));
        assert!(!other.is_there());
        let mut larger = Accumulation::new([20, 4]);
        let error = Checkpoint::of(&picture, FINGERPRINT).load(&mut larger).unwrap_err();
        assert!(error.contains("another size"), "{error}");
        assert_eq!((loaded, larger), (Accumulation::new([20, 3]), Accumulation::new([20, 4])));
    }

    #[test]
    fn damage_is_noticed_at_every_byte() {
        let folder = tempfile::tempdir().unwrap();
        let checkpoint = Checkpoint::of(&folder.path().join("a.exr"), FINGERPRINT);
        checkpoint.save(&begun(), 2.5).unwrap();
        let whole = std::fs::read(&checkpoint.path).unwrap();
        assert!(checkpoint.decode(&whole).is_ok());
        for at in 0..whole.len() {
            assert!(checkpoint.decode(&whole[..at]).is_err(), "{at}");
            let mut damaged = whole.clone();
            damaged[at] ^= 1;
            assert!(checkpoint.decode(&damaged).is_err(), "{at}");
        }
    }

    /// With a checksum that is right the rest may still be anything.
    #[test]
    fn contents_that_are_none_are_refused() {
        let checkpoint = Checkpoint::of(Path::new("a.exr"), FINGERPRINT);
        for contents in [&[][..], &[255; 40], &[1, 255, 255, 255, 255, 15], b"text"] {
            let mut bytes = [head().as_bytes(), &FINGERPRINT.0, contents].concat();
            bytes.extend(Sha256::digest(&bytes));
            assert_eq!(checkpoint.decode(&bytes).unwrap_err(), "is damaged", "{contents:?}");
        }
    }
}
