//! Scattering that has been computed, kept on disk for the next run.
//!
//! An entry has the name of the SHA-256 of all that it follows from: radii, numbers, indices and coefficients at the
//! wavelengths used, and the version of what computes it. It begins with the SHA-256 of its name and content, so one that is
//! damaged, cut short or renamed is noticed and computed anew. It is written under another name first and then takes its own
//! in one step: any number of processes may share a folder. A folder that is missing or cannot be written is no error, and
//! nothing goes into the home of the user, which nodes of a farm may not have.

use std::ffi::OsString;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use super::{MixtureError, Scattering};

/// The variable that names the folder, and the one that names the folder of all caches.
const VARIABLES: [&str; 2] = ["FLOE_CACHE", "XDG_CACHE_HOME"];
/// Bytes of a SHA-256.
const CHECKSUM: usize = 32;
/// No entry is longer.
const LONGEST: u64 = 1 << 26;

/// Keeps scattering on disk, so that the next run has it at once.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cache {
    folder: Option<PathBuf>,
}

/// What an entry follows from.
pub(super) type Key = [u8; CHECKSUM];

impl Cache {
    /// Keeps nothing.
    pub fn off() -> Self {
        Self { folder: None }
    }

    /// Keeps entries in a folder, which is made when it is missing.
    pub fn in_folder(folder: &Path) -> Self {
        Self { folder: Some(folder.to_path_buf()) }
    }

    /// The folder that `FLOE_CACHE` names (`off`: none), else `floe` in the one that `XDG_CACHE_HOME` names, else one of
    /// this user's among the temporary files.
    pub fn of_user() -> Self {
        Self::named(VARIABLES.map(std::env::var_os), &std::env::temp_dir())
    }

    /// That of values of the variables.
    fn named([own, all]: [Option<OsString>; 2], temporary: &Path) -> Self {
        match (own, all.map(PathBuf::from)) {
            (Some(own), _) if own == "off" => Self::off(),
            (Some(own), _) if !own.is_empty() => Self::in_folder(Path::new(&own)),
            // By the convention a path that is not absolute counts for nothing.
            (_, Some(all)) if all.is_absolute() => Self::in_folder(&all.join("floe")),
            _ => Self { folder: folder_of_user(temporary) },
        }
    }

    /// Where entries are, if they are kept.
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// The entry of a key, or else what is computed, which becomes the entry.
    pub(super) fn remembered(
        &self,
        key: &Key,
        compute: impl FnOnce() -> Result<Scattering, MixtureError>,
    ) -> Result<Scattering, MixtureError> {
        let Some(folder) = &self.folder else { return compute() };
        let name: String = key.iter().map(|byte| format!("{byte:02x}")).collect();
        let path = folder.join(name + ".optics");
        if let Some(found) = read(&path, key) {
            return Ok(found);
        }
        let computed = compute()?;
        // What cannot be kept is computed again the next time.
        let _ = write(folder, &path, key, &computed);
        Ok(computed)
    }
}

/// An entry, if it is whole.
fn read(path: &Path, key: &Key) -> Option<Scattering> {
    if fs::metadata(path).ok()?.len() > LONGEST {
        return None;
    }
    let bytes = fs::read(path).ok()?;
    let (checksum, content) = bytes.split_at_checked(CHECKSUM)?;
    if checksum != seal(key, content) {
        return None;
    }
    postcard::from_bytes(content).ok()
}

fn write(folder: &Path, path: &Path, key: &Key, scattering: &Scattering) -> std::io::Result<()> {
    let content = postcard::to_stdvec(scattering).map_err(std::io::Error::other)?;
    fs::create_dir_all(folder)?;
    let mut file = tempfile::Builder::new().prefix(".floe-").suffix(".tmp").tempfile_in(folder)?;
    file.write_all(&seal(key, &content))?;
    file.write_all(&content)?;
    file.persist(path).map(|_| ()).map_err(|failure| failure.error)
}

fn seal(key: &Key, content: &[u8]) -> Key {
    Sha256::new().chain_update(key).chain_update(content).finalize().into()
}

/// A folder of temporary files that belongs to this user and that nobody else can write.
#[cfg(unix)]
fn folder_of_user(temporary: &Path) -> Option<PathBuf> {
    use std::os::unix::fs::{DirBuilderExt, MetadataExt};
    let user = tempfile::tempfile_in(temporary).ok()?.metadata().ok()?.uid();
    let folder = temporary.join(format!("floe-{user}"));
    // One that is there already is looked at below, as is one that cannot be made.
    let _ = fs::DirBuilder::new().mode(0o700).create(&folder);
    let found = fs::symlink_metadata(&folder).ok()?;
    (found.is_dir() && found.uid() == user && found.mode() & 0o022 == 0).then_some(folder)
}

/// The system's folder of temporary files is this user's own.
#[cfg(not(unix))]
fn folder_of_user(temporary: &Path) -> Option<PathBuf> {
    Some(temporary.join("floe"))
}

#[cfg(test)]
mod tests {
    use super::super::{Bulk, EnsemblePhase};
    use super::*;

    const KEY: Key = [7; CHECKSUM];

    fn scattering(value: f64) -> Scattering {
        let row = || vec![value, 2.0 * value];
        let bulk = Bulk {
            wavelengths: row(),
            n: row(),
            sigma_a: row(),
            sigma_s: row(),
            g: row(),
            species: Vec::new(),
            relative_error: 1e-4,
        };
        let phase = EnsemblePhase { wavelengths: vec![value], angles: row(), values: vec![row()] };
        Scattering { bulk, phase }
    }

    /// What is remembered, and whether it was computed.
    fn ask(cache: &Cache, key: &Key, value: f64) -> (Scattering, bool) {
        let mut was_computed = false;
        let found = cache.remembered(key, || {
            was_computed = true;
            Ok(scattering(value))
        });
        (found.unwrap(), was_computed)
    }

    fn entry(folder: &Path) -> PathBuf {
        let mut entries = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
        let entry = entries.next().unwrap();
        assert_eq!(entries.next(), None, "one file, and nothing temporary");
        entry
    }

    #[test]
    fn what_was_computed_once_is_remembered_by_its_key() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::in_folder(&folder.path().join("new"));
        assert_eq!(ask(&cache, &KEY, 1.0 / 3.0), (scattering(1.0 / 3.0), true));
        assert_eq!(ask(&cache, &KEY, 0.0), (scattering(1.0 / 3.0), false));
        assert_eq!(ask(&cache, &[8; CHECKSUM], 5.0), (scattering(5.0), true));
        let failed = cache.remembered(&[9; CHECKSUM], || Err(MixtureError::Wavelength { value: 0.0 }));
        assert!(failed.is_err());
    }

    #[test]
    fn an_entry_that_is_cut_or_damaged_anywhere_is_computed_anew() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::in_folder(folder.path());
        ask(&cache, &KEY, 1.5);
        let path = entry(folder.path());
        let whole = fs::read(&path).unwrap();
        assert!(whole.len() > 100);
        for place in 0..whole.len() {
            let mut damaged = whole.clone();
            damaged[place] ^= 1 << (place % 8);
            for bytes in [&damaged[..], &whole[..place], &[&whole[..], &[0]].concat()] {
                fs::write(&path, bytes).unwrap();
                assert_eq!(ask(&cache, &KEY, 1.5), (scattering(1.5), true), "byte {place}");
                assert_eq!(fs::read(&path).unwrap(), whole);
            }
        }
        // Nor is that of another key taken.
        fs::rename(&path, folder.path().join("08".repeat(CHECKSUM) + ".optics")).unwrap();
        assert!(ask(&cache, &[8; CHECKSUM], 2.5).1);
    }

    #[test]
    fn without_a_folder_all_is_computed() {
        assert!(ask(&Cache::off(), &KEY, 1.0).1 && ask(&Cache::off(), &KEY, 1.0).1);
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, "not a folder").unwrap();
        let cache = Cache::in_folder(&file);
        assert!(ask(&cache, &KEY, 1.0).1 && ask(&cache, &KEY, 1.0).1);
        assert_eq!(fs::read(&file).unwrap(), b"not a folder");
    }

    #[test]
    fn variables_name_the_folder() {
        let temporary = tempfile::tempdir().unwrap();
        let named = |own: Option<&str>, all: Option<&str>| {
            Cache::named([own, all].map(|value| value.map(OsString::from)), temporary.path())
        };
        let of_user = named(None, None);
        for (own, all, cache) in [
            (Some("off"), Some("/caches"), Cache::off()),
            (Some("kept"), Some("/caches"), Cache::in_folder(Path::new("kept"))),
            (None, Some("/caches"), Cache::in_folder(Path::new("/caches/floe"))),
            (Some(""), Some("/caches"), Cache::in_folder(Path::new("/caches/floe"))),
            (None, Some("caches"), of_user.clone()),
            (Some(""), Some(""), of_user.clone()),
        ] {
            assert_eq!(named(own, all), cache, "{own:?} {all:?}");
        }
        assert!(of_user.folder().unwrap().starts_with(temporary.path()));
    }

    #[test]
    fn many_at_once_all_get_the_same() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::in_folder(folder.path());
        std::thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| {
                    for _ in 0..50 {
                        assert_eq!(ask(&cache, &KEY, 0.1).0, scattering(0.1));
                        // As if it had been damaged meanwhile.
                        let _ = fs::remove_file(folder.path().join("07".repeat(CHECKSUM) + ".optics"));
                    }
                });
            }
        });
        assert!(fs::read_dir(folder.path()).unwrap().count() <= 1);
    }

    #[cfg(unix)]
    #[test]
    fn the_folder_among_temporary_files_is_this_users_alone() {
        use std::os::unix::fs::PermissionsExt;
        let temporary = tempfile::tempdir().unwrap();
        let folder = folder_of_user(temporary.path()).unwrap();
        assert_eq!(fs::metadata(&folder).unwrap().permissions().mode() & 0o777, 0o700);
        assert_eq!(folder_of_user(temporary.path()), Some(folder.clone()));
        fs::set_permissions(&folder, fs::Permissions::from_mode(0o777)).unwrap();
        assert_eq!(folder_of_user(temporary.path()), None, "others can write it");
        fs::remove_dir(&folder).unwrap();
        let elsewhere = tempfile::tempdir().unwrap();
        std::os::unix::fs::symlink(elsewhere.path(), &folder).unwrap();
        assert_eq!(folder_of_user(temporary.path()), None, "a link");
        assert_eq!(folder_of_user(&temporary.path().join("missing")), None);
    }
}
