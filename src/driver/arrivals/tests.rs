//! Folders in disorder, files that go, and files that are too large.

use super::*;

const QUIET: Duration = Duration::from_millis(10);

fn arrivals(folder: &Path, pattern: &str) -> Arrivals<'static> {
    Arrivals::new(folder, pattern, Rules::new(QUIET))
}

fn number(n: u32) -> FrameNumber {
    FrameNumber::from(n)
}

#[test]
fn no_size_is_too_large_to_be_told() {
    for size in [u64::MAX, i64::MAX as u64, isize::MAX as u64] {
        assert_eq!(room_for(size).unwrap_err().kind(), ErrorKind::OutOfMemory);
    }
    assert!(room_for(9).unwrap().capacity() >= 9);
}

#[test]
fn disorder_is_told_once_after_the_patience_and_forgotten_when_it_is_mended() {
    let folder = tempfile::tempdir().unwrap();
    let mut arrivals = arrivals(folder.path(), "a_#.ply");
    std::fs::write(folder.path().join("a_1.ply"), "").unwrap();
    std::fs::write(folder.path().join("a_01.ply"), "").unwrap();
    assert_eq!(arrivals.scan(QUIET).unwrap(), None);
    assert!(!arrivals.is_clear());
    assert_eq!(arrivals.changed(), QUIET);
    assert!(arrivals.scan(QUIET * 30).unwrap().unwrap().contains("frame 1 is there twice"));
    assert_eq!(arrivals.scan(QUIET * 60).unwrap(), None);
    std::fs::remove_file(folder.path().join("a_1.ply")).unwrap();
    assert_eq!(arrivals.scan(QUIET * 70).unwrap(), None);
    assert!(arrivals.is_clear() && arrivals.take_trouble().is_none());
}

#[test]
fn a_drawn_frame_counts_when_its_file_is_gone() {
    let folder = tempfile::tempdir().unwrap();
    let mut arrivals = arrivals(folder.path(), "a_#.ply");
    for n in 1..=3 {
        std::fs::write(folder.path().join(format!("a_{n}.ply")), "").unwrap();
    }
    arrivals.scan(QUIET).unwrap();
    assert!(!arrivals.is_done_up_to(number(3)));
    for n in [1, 3] {
        let arrival = arrivals.get_mut(number(n)).unwrap();
        arrival.drawn = Some(Fingerprint([0; 16]));
        arrival.readiness.drawn(arrival.readiness.signature());
    }
    for n in 1..=3 {
        std::fs::remove_file(folder.path().join(format!("a_{n}.ply"))).unwrap();
    }
    arrivals.scan(QUIET * 2).unwrap();
    assert!(arrivals.is_done_up_to(number(3)) && !arrivals.is_done_up_to(number(2)));
    // What comes back is a frame like any other.
    std::fs::write(folder.path().join("a_3.ply"), "").unwrap();
    arrivals.scan(QUIET * 3).unwrap();
    assert!(!arrivals.is_done_up_to(number(3)));
}

/// The folder with the file that says that all is done, and the one to listen to.
#[test]
fn the_folder_is_above_what_varies() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir_all(folder.path().join("cut/0.1")).unwrap();
    for (pattern, wanted) in [
        ("cut/*/surface.vtp", "cut"),
        ("cut/#/surface.vtp", "cut"),
        ("t_####/x.vtp", ""),
        ("cut", "cut"),
        ("cut/a_####.ply", "cut"),
        ("later/*.ply", "later"),
        ("later/t_##/x/y.vtp", "later"),
        ("", ""),
    ] {
        let found = arrivals(folder.path(), pattern).folder();
        assert_eq!(found.components().as_path(), folder.path().join(wanted), "{pattern}");
    }
}
