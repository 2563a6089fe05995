//! Nine kinds of writer.

use std::collections::{BTreeMap, BTreeSet};

use floe::driver::watch::{End, Order};
use floe::sequence::FrameNumber;

use super::simulator::{CUT, DROPPED, MANNERS, Manner, REWRITTEN, Simulation};
use super::small::{Folder, scene};
use super::{QUIET, Witness, contents, drawn_of, hash, options, picture, watched};

const FRAMES: usize = 8;

/// Watches a simulation and asserts that every picture ever finished is of whole contents, and that in the end there is
/// one of each last contents. Returns what the watch told.
fn survives(manner: Manner, order: Order) -> Witness {
    let folder = Folder::with_scene(&scene(""));
    let simulation = Simulation {
        folder: folder.path("frames"),
        frames: (0..FRAMES).map(contents).collect(),
        manner,
        pause: QUIET / 5,
        stall: QUIET * 25,
    };
    let witness = Witness::default();
    let options = floe::driver::WatchOptions { order, ..options(&folder) };
    let (report, truth) = std::thread::scope(|scope| {
        let watching = scope.spawn(|| watched(&folder, &options, &witness));
        let truth = simulation.run();
        (watching.join().unwrap(), truth)
    });
    assert_eq!(report.ended, End::DoneFile);
    let numbers: Vec<FrameNumber> = truth.keys().map(|n| FrameNumber::from(*n as u32)).collect();
    assert_eq!(report.drawn, numbers, "{manner:?}: {report:?}");
    let found: BTreeMap<usize, String> =
        (0..FRAMES).filter_map(|n| Some((n, drawn_of(&picture(&folder, n))?))).collect();
    let wanted: BTreeMap<usize, String> = truth.iter().map(|(n, bytes)| (*n, hash(bytes))).collect();
    assert_eq!(found, wanted, "{manner:?}");
    let whole: BTreeSet<String> = simulation.frames.iter().map(|bytes| hash(bytes)).collect();
    let drawn = witness.hashes.lock().unwrap().clone();
    assert!(drawn.is_subset(&whole), "{manner:?}: a picture of incomplete bytes");
    assert_eq!(folder.leftovers(), [""; 0], "{manner:?}");
    let latest = folder.read("out/latest.png");
    assert!(
        latest == folder.read("out/frame_0007.png") || manner == Manner::Mixed || manner == Manner::Shuffled
    );
    witness
}

#[test]
fn every_manner_of_writing() {
    for manner in MANNERS.into_iter().filter(|manner| *manner != Manner::Mixed) {
        let witness = survives(manner, Order::Oldest);
        let failed = witness.failed.lock().unwrap();
        let stalled = failed.iter().all(|(frame, _)| frame == "3");
        assert!(failed.is_empty() || (manner == Manner::Stalling && stalled), "{manner:?}: {failed:?}");
    }
}

/// A hole, a crash, a stall beyond all patience and a rewritten frame at once.
#[test]
fn all_at_once() {
    let witness = survives(Manner::Mixed, Order::Newest);
    let drawn = witness.drawn.lock().unwrap();
    let finished =
        |n: usize| drawn.iter().filter(|(frame, preview)| *frame == n.to_string() && !preview).count();
    assert_eq!((finished(DROPPED), finished(CUT)), (0, 0));
    assert!((1..=2).contains(&finished(REWRITTEN)), "{drawn:?}");
    // Told once, as a frame that is cut for ever.
    let failed = witness.failed.lock().unwrap();
    assert_eq!(failed.iter().filter(|(frame, _)| *frame == CUT.to_string()).count(), 1, "{failed:?}");
}

/// Every frame is previewed before it is finished, and nothing is finished while one waits for its preview. Whatever the
/// order, `latest.png` is the newest frame.
#[test]
fn previews_come_first() {
    for order in [Order::Oldest, Order::Newest] {
        let folder = Folder::with_scene(&scene(""));
        for number in 0..4 {
            folder.write(&format!("frames/frame_{number:04}.ply"), contents(number));
        }
        folder.write("frames/DONE", "");
        let witness = Witness::default();
        watched(&folder, &floe::driver::WatchOptions { order, ..options(&folder) }, &witness);
        let drawn = witness.drawn.lock().unwrap().clone();
        let found: Vec<String> = drawn.iter().map(|(frame, preview)| format!("{frame}{preview}")).collect();
        let mut wanted = ["0true", "1true", "2true", "3true", "0false", "1false", "2false", "3false"];
        if order == Order::Newest {
            wanted[..4].reverse();
            wanted[4..].reverse();
        }
        assert_eq!(found, wanted);
        assert!(folder.read("out/latest.png") == folder.read("out/frame_0003.png"), "{order:?}");
        // The ledger has both, and the page draws its curve of them.
        let ledger = folder.ledger("out/ledger.jsonl");
        assert_eq!(ledger.iter().filter(|line| line["status"] == "preview").count(), 4);
    }
}

/// Text formats do not say how long they are: no prefix that could be one is taken before the longer quiet.
#[test]
fn text_that_grows_is_waited_for() {
    let folder = Folder::with_scene(&scene("[frames]\npath = \"frames/frame_####.obj\"\n"));
    let obj = "v -1 -1 -1\nv 1 -1 -1\nv 0 1 -1\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
    let witness = Witness::default();
    let options = floe::driver::WatchOptions { quiet: QUIET * 4, ..options(&folder) };
    std::thread::scope(|scope| {
        let watching = scope.spawn(|| watched(&folder, &options, &witness));
        // Each of the four faces is a whole line, and so each of the prefixes a whole file.
        for (end, _) in obj.match_indices('\n') {
            folder.write("frames/frame_0001.obj", &obj[..=end]);
            // More than the quiet time, less than what an open surface waits for: 20 times that.
            std::thread::sleep(QUIET * 6);
        }
        folder.write("frames/DONE", "");
        watching.join().unwrap();
    });
    assert_eq!(*witness.hashes.lock().unwrap(), BTreeSet::from([hash(obj.as_bytes())]));
}
