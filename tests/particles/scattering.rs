//! The scattering of a mixture is the same on any number of threads, cold or remembered.

use floe::optics::particles::{Cache, Scattering};

use crate::mixtures::{sea, sea_ice};

fn on_threads(count: usize) -> Scattering {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
    pool.install(|| sea().scattering(&Cache::off()).unwrap())
}

#[test]
fn threads_change_nothing() {
    let one = on_threads(1);
    assert!(one == on_threads(2) && one == on_threads(5));
}

#[test]
fn what_is_remembered_is_what_was_computed() {
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::in_folder(folder.path());
    let computed = sea_ice().scattering(&cache).unwrap();
    let entry = std::fs::read_dir(folder.path()).unwrap().next().unwrap().unwrap().path();
    let written = std::fs::metadata(&entry).unwrap().modified().unwrap();
    assert_eq!(sea_ice().scattering(&cache).unwrap(), computed);
    assert_eq!(std::fs::metadata(&entry).unwrap().modified().unwrap(), written, "it was read");
    // Half an entry, as a full disk leaves it elsewhere.
    let whole = std::fs::read(&entry).unwrap();
    std::fs::write(&entry, &whole[..whole.len() / 2]).unwrap();
    assert_eq!(sea_ice().scattering(&cache).unwrap(), computed);
    assert_eq!(std::fs::read(&entry).unwrap(), whole);
    // Another mixture is another entry.
    let mut other = sea_ice();
    other.species[0].volume_fraction *= 2.0;
    assert_ne!(other.scattering(&cache).unwrap(), computed);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
}
