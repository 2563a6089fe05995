//! The PNGs beside the pictures, which two workers write.

use std::path::Path;
use std::sync::{Mutex, PoisonError};

use crate::film::FilmError;
use crate::film::write::write_atomically;

/// Keeps a preview from taking the place of a finished picture.
#[derive(Debug, Default)]
pub(super) struct Showcase(Mutex<()>);

impl Showcase {
    /// Shows a preview of a picture that is not there; one of what the file was before stays until the next is finished.
    pub fn preview(&self, picture: &Path, png: &[u8]) -> Result<(), FilmError> {
        let _turn = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if picture.exists() {
            return Ok(());
        }
        write_atomically(&picture.with_extension("png"), png)
    }

    /// Has the last word on a picture that is there by now: a preview may have been on its way before it was.
    pub fn finished(&self, picture: &Path, png: &[u8]) -> Result<(), FilmError> {
        let _turn = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let path = picture.with_extension("png");
        if std::fs::read(&path).is_ok_and(|shown| shown == png) {
            return Ok(());
        }
        write_atomically(&path, png)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_preview_outlives_the_finished_picture() {
        let folder = tempfile::tempdir().unwrap();
        let (picture, png) = (folder.path().join("a.exr"), folder.path().join("a.png"));
        let shown = || std::fs::read(&png).unwrap();
        let showcase = Showcase::default();
        showcase.preview(&picture, b"preview").unwrap();
        assert_eq!(shown(), b"preview");
        // The picture and its PNG come between the preview's look and its writing.
        std::fs::write(&picture, "").unwrap();
        showcase.finished(&picture, b"finished").unwrap();
        assert_eq!(shown(), b"finished");
        showcase.preview(&picture, b"late").unwrap();
        assert_eq!(shown(), b"finished");
    }
}
