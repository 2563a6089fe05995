//! Files that are either whole or not there.
//!
//! The bytes go to a hidden temporary file in the destination's folder, are forced to the disk, and then take the
//! destination's name in one step. A reader, a crash or a full disk never leaves half a picture behind. The file gets
//! the rights of an ordinary new file (0666 less the umask), not those of a private temporary one.
//!
//! A process that is killed leaves its temporary file. Writers hold a lock on theirs, which the system takes from the
//! dead, so [`remove_abandoned`] knows which ones nobody will finish. Where a file system has no locks, all are left.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

use super::error::FilmError;

/// A file that is on the disk but has not its name yet; dropping it removes it.
#[derive(Debug)]
pub struct StagedFile {
    temporary: NamedTempFile,
    destination: PathBuf,
}

impl StagedFile {
    /// Writes the bytes beside their destination, making folders that are missing.
    ///
    /// # Errors
    /// [`FilmError::CannotCreate`] for the folder or the temporary file, [`FilmError::CannotWrite`] for the bytes.
    pub fn new(destination: &Path, bytes: &[u8]) -> Result<Self, FilmError> {
        Self::written(destination, |file| file.write_all(bytes))
    }

    /// As [`new`](Self::new), with the bytes that `write` writes.
    ///
    /// # Errors
    /// Those of [`new`](Self::new).
    pub fn written(
        destination: &Path,
        write: impl FnOnce(&mut File) -> std::io::Result<()>,
    ) -> Result<Self, FilmError> {
        let folder = folder_of(destination);
        fs::create_dir_all(folder)
            .map_err(|source| FilmError::CannotCreate { path: folder.to_path_buf(), source })?;
        let mut temporary = locked_file(folder)
            .map_err(|source| FilmError::CannotCreate { path: destination.to_path_buf(), source })?;
        write(temporary.as_file_mut())
            .and_then(|()| temporary.flush())
            .and_then(|()| temporary.as_file().sync_all())
            .map_err(|source| FilmError::CannotWrite { path: destination.to_path_buf(), source })?;
        Ok(Self { temporary, destination: destination.to_path_buf() })
    }

    /// Where it is before it has its name, for another program to write to.
    pub fn path(&self) -> &Path {
        self.temporary.path()
    }

    /// Gives the file its name, in place of whatever file has it.
    ///
    /// # Errors
    /// [`FilmError::CannotWrite`], such as when a folder has the name; the temporary file is gone then.
    pub fn commit(self) -> Result<(), FilmError> {
        let Self { temporary, destination } = self;
        match temporary.persist(&destination) {
            Ok(_) => Ok(()),
            Err(failure) => Err(FilmError::CannotWrite { path: destination, source: failure.error }),
        }
    }
}

/// Writes a file in one step.
///
/// # Errors
/// Those of [`StagedFile::new`] and [`StagedFile::commit`].
pub fn write_atomically(destination: &Path, bytes: &[u8]) -> Result<(), FilmError> {
    StagedFile::new(destination, bytes)?.commit()
}

/// Removes the temporary files in the folder of a picture whose writers are dead.
pub fn remove_abandoned(picture: &Path) {
    let Ok(entries) = fs::read_dir(folder_of(picture)) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let is_temporary =
            name.to_str().is_some_and(|name| name.starts_with(PREFIX) && name.ends_with(SUFFIX));
        if is_temporary
            && let Ok(file) = File::open(entry.path())
            && file.try_lock().is_ok()
        {
            // The lock is held meanwhile: a writer that has just made the file finds out in `locked_file`.
            let _ = fs::remove_file(entry.path());
        }
    }
}

fn folder_of(file: &Path) -> &Path {
    match file.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    }
}

/// A temporary file with a lock on it.
fn locked_file(folder: &Path) -> std::io::Result<NamedTempFile> {
    loop {
        let file = temporary_file(folder)?;
        // Without locks nobody removes anything.
        let is_locked = file.as_file().lock().is_ok();
        if !is_locked || file.path().exists() {
            return Ok(file);
        }
    }
}

const PREFIX: &str = ".floe-";
const SUFFIX: &str = ".tmp";

fn temporary_file(folder: &Path) -> std::io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries(folder: &Path) -> Vec<String> {
        let names = fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.collect();
        names.sort();
        names
    }

    #[test]
    fn folders_are_made_and_old_files_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a/b/shot.0001.exr");
        write_atomically(&path, b"old and longer").unwrap();
        write_atomically(&path, b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(entries(path.parent().unwrap()), ["shot.0001.exr"]);
    }

    #[test]
    fn nothing_is_left_when_the_destination_is_a_folder() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("shot.exr")).unwrap();
        let error = write_atomically(&folder.path().join("shot.exr"), b"bytes").unwrap_err();
        assert!(
            matches!(&error, FilmError::CannotWrite { path, .. } if path.ends_with("shot.exr")),
            "{error}"
        );
        assert_eq!(entries(folder.path()), ["shot.exr"]);
    }

    #[test]
    fn a_file_in_place_of_the_folder_is_named() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("out"), b"").unwrap();
        let error = write_atomically(&folder.path().join("out/shot.exr"), b"bytes").unwrap_err();
        assert!(matches!(&error, FilmError::CannotCreate { path, .. } if path.ends_with("out")), "{error}");
        assert_eq!(entries(folder.path()), ["out"]);
    }

    #[test]
    fn a_staged_file_that_is_dropped_leaves_nothing_and_keeps_the_old_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("shot.exr");
        write_atomically(&path, b"old").unwrap();
        drop(StagedFile::new(&path, b"new").unwrap());
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(entries(folder.path()), ["shot.exr"]);
    }

    #[test]
    fn only_the_files_of_the_dead_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        let picture = folder.path().join("shot.exr");
        let alive = StagedFile::new(&picture, b"alive").unwrap();
        for name in [".floe-dead.tmp", ".floe-other", "floe-.tmp", ".other.tmp"] {
            fs::write(folder.path().join(name), b"").unwrap();
        }
        remove_abandoned(&picture);
        assert_eq!(entries(folder.path()).len(), 4, "{:?}", entries(folder.path()));
        alive.commit().unwrap();
        assert_eq!(entries(folder.path()), [".floe-other", ".other.tmp", "floe-.tmp", "shot.exr"]);
        remove_abandoned(&folder.path().join("no such folder/shot.exr"));
    }

    #[cfg(unix)]
    #[test]
    fn rights_are_those_of_an_ordinary_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("ordinary"), b"").unwrap();
        write_atomically(&folder.path().join("ours"), b"").unwrap();
        let mode = |name: &str| fs::metadata(folder.path().join(name)).unwrap().permissions().mode();
        assert_eq!(mode("ours"), mode("ordinary"));
    }
}
