//! Files that are either whole or not there.
//!
//! The bytes go to a hidden temporary file in the destination's folder, are forced to the disk, and then take the
//! destination's name in one step. A reader, a crash or a full disk never leaves half a picture behind. The file gets
//! the rights of an ordinary new file (0666 less the umask), not those of a private temporary one.
//!
//! A process that is killed leaves its temporary file. Its name tells who writes it, so [`remove_abandoned`] knows which
//! ones nobody will finish: those of the dead of this machine, and of other machines those a day old.

use std::fs::{self, DirEntry, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;

use tempfile::{Builder, NamedTempFile};

use super::error::FilmError;
use super::maker::{Maker, SUFFIX, is_temporary, maker_of};

/// A file that nothing was written to for so long is not being written, whatever the clocks of two machines say.
const OLD: Duration = Duration::from_secs(24 * 3600);

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
        let mut temporary = temporary_file(folder)
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

/// Removes the temporary files in the folder of a picture that nobody will finish.
pub fn remove_abandoned(picture: &Path) {
    let Ok(entries) = fs::read_dir(folder_of(picture)) else { return };
    for entry in entries.flatten().filter(is_abandoned) {
        let _ = fs::remove_file(entry.path());
    }
}

fn is_abandoned(entry: &DirEntry) -> bool {
    let name = entry.file_name();
    let Some(name) = name.to_str().filter(|name| is_temporary(name)) else { return false };
    match maker_of(name) {
        // Of no version that tells who it is.
        None => true,
        Some(maker) if maker == Maker::this() => false,
        Some(maker) => is_ours(entry) && maker.is_dead() || is_old(entry),
    }
}

/// Whether a file is of this user: processes of others may be hidden.
#[cfg(target_os = "linux")]
fn is_ours(entry: &DirEntry) -> bool {
    use std::os::linux::fs::MetadataExt;
    let users = [fs::metadata("/proc/self"), entry.metadata()].map(|found| found.map(|found| found.st_uid()));
    matches!(users, [Ok(us), Ok(maker)] if us == maker)
}

#[cfg(not(target_os = "linux"))]
fn is_ours(_: &DirEntry) -> bool {
    true
}

fn is_old(entry: &DirEntry) -> bool {
    let written = entry.metadata().and_then(|found| found.modified());
    written.is_ok_and(|written| written.elapsed().is_ok_and(|age| age > OLD))
}

fn folder_of(file: &Path) -> &Path {
    match file.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    }
}

fn temporary_file(folder: &Path) -> std::io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    let prefix = Maker::this().prefix();
    builder.prefix(&prefix).suffix(SUFFIX);
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

    /// Of another machine nobody knows who is dead, but a day is long.
    #[cfg(target_os = "linux")]
    #[test]
    fn only_what_nobody_will_finish_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        let picture = folder.path().join("shot.exr");
        let alive = StagedFile::new(&picture, b"alive").unwrap();
        let own = alive.path().file_name().unwrap().to_str().unwrap().to_owned();
        let this = Maker::this().to_string();
        let (machine, _) = this.split_once('-').unwrap();
        // Numbers of processes end before 2^22, and none starts at 0.
        let dead = format!(".floe-{machine}-4194305-7-a.tmp");
        let again = format!(".floe-{machine}-{}-0-a.tmp", std::process::id());
        let [elsewhere, old] = ["b", "c"].map(|name| format!(".floe-0011223344556677-1-2-{name}.tmp"));
        for name in
            [&*dead, &again, &elsewhere, &old, ".floe-nobody.tmp", ".floe-other", "floe-.tmp", ".other.tmp"]
        {
            fs::write(folder.path().join(name), b"").unwrap();
        }
        let yesterday = std::time::SystemTime::now() - OLD - Duration::from_secs(1);
        File::options().write(true).open(folder.path().join(&old)).unwrap().set_modified(yesterday).unwrap();
        remove_abandoned(&picture);
        let mut left =
            vec![own, elsewhere.clone(), ".floe-other".into(), "floe-.tmp".into(), ".other.tmp".into()];
        left.sort();
        assert_eq!(entries(folder.path()), left);
        alive.commit().unwrap();
        assert_eq!(fs::read(&picture).unwrap(), b"alive");
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
