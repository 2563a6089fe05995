//! The picture of a frame as it is on the disk: there, missing, of something else, or damaged.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::fingerprint::{Fingerprint, Identity};
use crate::film::exr_seal::{check_seal, text_attribute};
use crate::scene::description::SceneDescription;
use crate::sequence::{FrameNumber, output_path};

/// Name of the attribute with the fingerprint.
pub const FINGERPRINT: &str = "floe:fingerprint";

/// Name of the attribute with the hash of the frame's meshes.
pub const MESH_HASH: &str = "floe:meshHash";

/// Name of the attribute with the time, in seconds, after which the frame was cut; only where it was.
pub const TIME_BUDGET: &str = "floe:timeBudget";

/// Longest header that is looked at, in bytes; those of floe have some 2,000.
const LONGEST_HEADER: u64 = 64 << 10;

/// What is there under a picture's name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PictureState {
    /// Nothing.
    Missing,
    /// The picture, whole.
    Complete,
    /// The picture of a frame whose time was up, which was so long: the file is whole, but more samples were asked for.
    Cut(Duration),
    /// A whole picture of another scene, other settings or another mesh.
    Stale,
    /// A file that is damaged, or no picture of floe's; with what is wrong.
    Corrupt(String),
}

impl PictureState {
    /// Looks at a picture, every byte of it.
    pub fn of(path: &Path, fingerprint: &Fingerprint) -> Self {
        let bytes = match std::fs::read(path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == ErrorKind::NotFound => return Self::Missing,
            Err(error) => return Self::Corrupt(format!("it cannot be read: {error}")),
        };
        match check_seal(&bytes) {
            Err(reason) => Self::Corrupt(reason.into()),
            Ok(()) if text_attribute(&bytes, FINGERPRINT) == Some(&fingerprint.to_string()) => {
                time_budget(&bytes).map_or(Self::Complete, Self::Cut)
            }
            Ok(()) => Self::Stale,
        }
    }

    /// Whether a run that gives each frame so much time has nothing to add.
    pub fn is_enough(&self, time_budget: Option<Duration>) -> bool {
        match self {
            Self::Complete => true,
            Self::Cut(spent) => time_budget.is_some_and(|budget| budget <= *spent),
            Self::Missing | Self::Stale | Self::Corrupt(_) => false,
        }
    }
}

/// The time after which a frame was cut, if it was.
fn time_budget(bytes: &[u8]) -> Option<Duration> {
    Duration::try_from_secs_f64(text_attribute(bytes, TIME_BUDGET)?.parse().ok()?).ok()
}

/// Which frame of which scene a picture says it is; `None` when it does not say, or cannot be read. Only its header
/// is read, so the picture may be damaged.
pub fn read_identity(path: &Path) -> Option<Identity> {
    let mut header = Vec::new();
    File::open(path).ok()?.take(LONGEST_HEADER).read_to_end(&mut header).ok()?;
    let digits = text_attribute(&header, FINGERPRINT)?;
    let bits = u128::from_str_radix(digits, 16).ok()?.to_be_bytes();
    let mesh_hash = text_attribute(&header, MESH_HASH)?.to_owned();
    (digits.len() == 32).then_some(Identity { fingerprint: Fingerprint(bits), mesh_hash })
}

/// Where the PNG of a picture is, if the scene wants any.
pub(super) fn png_path(scene: &SceneDescription, picture: &Path) -> Option<PathBuf> {
    scene.output.png.then(|| picture.with_extension("png"))
}

/// Where a picture without noise is.
pub(super) fn denoised_path(picture: &Path) -> PathBuf {
    picture.with_extension("denoised.exr")
}

/// Where the picture of a frame is.
pub fn picture_path(pattern: &str, number: FrameNumber) -> PathBuf {
    PathBuf::from(output_path(pattern, number))
}
