//! Whole pictures are told from missing, stale and damaged ones.

use std::fs;
use std::path::Path;

use floe::driver::{Fingerprint, PictureState, RenderOptions, read_identity};
use floe::film::exr_seal::check_seal;

use super::small::{Folder, cube, labelled, scene};

/// A folder with the picture of frame 1, and its fingerprint.
fn rendered() -> (Folder, Fingerprint) {
    let folder = Folder::with_scene(&scene(""));
    folder.frame(1, &labelled(cube(), 0, 1));
    folder.render(RenderOptions::default());
    let identity = read_identity(&folder.path("out/frame_0001.exr")).unwrap();
    (folder, identity.fingerprint)
}

fn is_corrupt(path: &Path, fingerprint: &Fingerprint) -> bool {
    matches!(PictureState::of(path, fingerprint), PictureState::Corrupt(_))
}

#[test]
fn every_state_is_told() {
    let (folder, fingerprint) = rendered();
    let picture = folder.path("out/frame_0001.exr");
    assert_eq!(PictureState::of(&picture, &fingerprint), PictureState::Complete);
    assert_eq!(PictureState::of(&picture, &Fingerprint([7; 16])), PictureState::Stale);
    assert_eq!(PictureState::of(&folder.path("out/frame_0002.exr"), &fingerprint), PictureState::Missing);
    for other in ["scene.toml", "out/frame_0001.png", "frames"] {
        assert!(is_corrupt(&folder.path(other), &fingerprint), "{other}");
    }
}

/// Each byte in memory, and some in files.
#[test]
fn every_cut_and_every_damaged_byte_is_noticed() {
    let (folder, fingerprint) = rendered();
    let whole = folder.read("out/frame_0001.exr");
    let path = folder.path("damaged.exr");
    let check = |bytes: &[u8], at: usize, what: &str| {
        assert!(check_seal(bytes).is_err(), "{what} {at} of {} bytes", whole.len());
        if at.is_multiple_of(100) {
            fs::write(&path, bytes).unwrap();
            assert!(is_corrupt(&path, &fingerprint), "{what} {at} of {} bytes", whole.len());
        }
    };
    assert_eq!(check_seal(&whole), Ok(()));
    let mut damaged = whole.clone();
    for at in 0..whole.len() {
        check(&whole[..at], at, "cut at");
        damaged[at] ^= 1 << (at % 8);
        check(&damaged, at, "damaged at");
        damaged[at] = whole[at];
    }
}
