//! The cases of the state machine, with times told.

use super::*;
use proptest::prelude::*;

const QUIET: Duration = Duration::from_millis(500);

fn rules() -> Rules {
    Rules::new(QUIET)
}

fn at(millis: u64) -> Duration {
    Duration::from_millis(millis)
}

/// The signature of `size` bytes written at a time that is no whole second.
fn signature(size: u64) -> Signature {
    let modified = Some(SystemTime::UNIX_EPOCH + Duration::from_millis(1_700_000_000_123));
    Signature {
        size,
        modified,
        changed: (1_700_000_000, 123_000_000),
        identity: (1, 2),
        others: Others::default(),
    }
}

/// A look at an unchanged file.
fn look(millis: u64, size: u64, found: Option<Proof>) -> Look {
    Look { at: at(millis), end: at(millis), before: signature(size), after: Some(signature(size)), found }
}

#[test]
fn a_proven_file_is_accepted_after_the_quiet_time() {
    let mut file = Readiness::new(signature(9), at(0));
    assert_eq!(file.due(&rules()), Some(at(500)));
    assert_eq!(file.judge(&look(499, 9, Some(Proof::Proven)), &rules()), Verdict::NotYet);
    assert_eq!(file.judge(&look(500, 9, Some(Proof::Proven)), &rules()), Verdict::Accepted);
    assert!(file.is_settled());
    assert_eq!(file.due(&rules()), None);
}

#[test]
fn less_proof_takes_more_quiet() {
    for (proof, millis) in [(Proof::Plausible, 2000), (Proof::Doubtful, 10_000)] {
        let mut file = Readiness::new(signature(9), at(0));
        assert_eq!(file.judge(&look(600, 9, Some(proof)), &rules()), Verdict::NotYet);
        assert_eq!(file.due(&rules()), Some(at(millis)));
        assert_eq!(file.judge(&look(millis - 1, 9, Some(proof)), &rules()), Verdict::NotYet);
        assert_eq!(file.judge(&look(millis, 9, Some(proof)), &rules()), Verdict::Accepted);
    }
}

/// Also of a long stall: whatever is written after it starts all over.
#[test]
fn what_cannot_be_read_is_told_once_after_the_patience_and_again_when_it_changes() {
    let mut file = Readiness::new(signature(9), at(0));
    let mut told = 0;
    for millis in (0..60_000).step_by(100) {
        if file.due(&rules()).is_some_and(|due| due <= at(millis)) {
            let verdict = file.judge(&look(millis, 9, None), &rules());
            assert!(verdict != Verdict::Accepted);
            told += u32::from(verdict == Verdict::Refused);
        }
        if millis < 10_000 {
            assert_eq!((told, file.is_settled()), (0, false));
        }
    }
    assert_eq!((told, file.is_settled()), (1, true));
    assert!(file.seen(signature(10), at(60_000)));
    assert!(!file.is_settled());
    assert_eq!(file.due(&rules()), Some(at(60_500)));
    assert_eq!(file.judge(&look(60_500, 10, Some(Proof::Proven)), &rules()), Verdict::Accepted);
}

#[test]
fn it_is_looked_at_three_times_and_no_more() {
    let mut file = Readiness::new(signature(9), at(0));
    let mut looks = Vec::new();
    for millis in (0..100_000).step_by(10) {
        if file.due(&rules()).is_some_and(|due| due <= at(millis)) {
            file.judge(&look(millis, 9, None), &rules());
            looks.push(millis);
        }
    }
    assert_eq!(looks, [500, 2000, 10_000]);
}

#[test]
fn a_change_while_it_is_read_starts_all_over() {
    for after in [Some(signature(12)), None] {
        let mut file = Readiness::new(signature(9), at(0));
        // A large file: reading it took longer than the quiet time, and it may have changed at the end of that.
        let torn = Look { after, end: at(6000), ..look(5000, 9, Some(Proof::Proven)) };
        assert_eq!(file.judge(&torn, &rules()), Verdict::Changed);
        assert_eq!(file.due(&rules()), Some(at(6500)));
    }
}

/// The listing of a network file system may be older than what is opened.
#[test]
fn what_is_opened_has_to_be_what_was_seen() {
    let mut file = Readiness::new(signature(9), at(0));
    assert_eq!(file.judge(&look(5000, 10, Some(Proof::Proven)), &rules()), Verdict::Changed);
    assert_eq!(file.signature(), signature(10));
    assert_eq!(file.judge(&look(5400, 10, Some(Proof::Proven)), &rules()), Verdict::NotYet);
    assert_eq!(file.judge(&look(5500, 10, Some(Proof::Proven)), &rules()), Verdict::Accepted);
}

#[test]
fn any_part_of_the_signature_tells_a_change() {
    let old = signature(9);
    let news = [
        Signature { size: 8, ..old },
        Signature { modified: None, ..old },
        Signature { changed: (1_700_000_000, 124_000_000), ..old },
        Signature { identity: (1, 3), ..old },
        old.with(Others::of(&[PathBuf::from("missing")])),
    ];
    for new in news {
        let mut file = Readiness::new(old, at(0));
        file.judge(&look(1000, 9, Some(Proof::Proven)), &rules());
        assert!(!file.seen(old, at(1100)) && file.is_settled());
        assert!(file.seen(new, at(1200)) && !file.is_settled());
    }
}

/// A file beside the mesh that comes, grows or goes.
#[test]
fn other_files_are_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("velocity1.bobj");
    let others = || Others::of(std::slice::from_ref(&path));
    let mut found = vec![others()];
    for contents in ["a", "ab"] {
        std::fs::write(&path, contents).unwrap();
        found.push(others());
    }
    assert!(found[0] != found[1] && found[1] != found[2] && found[0] != found[2]);
    assert_eq!(others(), found[2]);
    assert_eq!(Others::of(&[]), Others::default());
}

/// Two writes within a second of such a file system look the same: longer quiet passes the second.
#[test]
fn whole_seconds_take_longer_quiet() {
    let coarse = Signature {
        modified: Some(SystemTime::UNIX_EPOCH + Duration::from_secs(1_700_000_000)),
        changed: (1_700_000_000, 0),
        ..signature(9)
    };
    let file = Readiness::new(coarse, at(0));
    assert!(file.due(&rules()).unwrap() > at(2000));
    // A copy with the date of its source (cp -p) on a finer file system.
    let file = Readiness::new(Signature { changed: (1_700_000_000, 5), ..coarse }, at(0));
    assert_eq!(file.due(&rules()), Some(at(500)));
}

#[test]
fn failures_wait_for_a_change_or_for_their_time() {
    let mut file = Readiness::new(signature(9), at(0));
    file.judge(&look(500, 9, Some(Proof::Proven)), &rules());
    file.failed(signature(9), Some(at(3000)));
    assert!(file.is_settled());
    assert_eq!(file.due(&rules()), Some(at(3000)));
    assert_eq!(file.judge(&look(3000, 9, Some(Proof::Proven)), &rules()), Verdict::Accepted);
    file.failed(signature(9), None);
    assert_eq!(file.due(&rules()), None);
    assert!(file.seen(signature(11), at(4000)));
    // The news of a picture of the old bytes does not hide that the file is another one.
    file.drawn(signature(9));
    file.failed(signature(9), None);
    assert_eq!(file.due(&rules()), Some(at(4500)));
}

/// A watch may be told to take no file for whole.
#[test]
fn the_longest_quiet_is_no_overflow() {
    let rules = Rules::new(Duration::MAX);
    assert_eq!(rules.patience(), Duration::MAX);
    assert_eq!(Readiness::new(signature(9), at(1)).due(&rules), Some(Duration::MAX));
}

#[test]
fn a_preview_leaves_the_file_wanted() {
    let mut file = Readiness::new(signature(9), at(0));
    let look = look(500, 9, Some(Proof::Proven));
    assert_eq!(file.judge(&look, &rules()), Verdict::Accepted);
    file.wanted_again(&look);
    assert_eq!(file.due(&rules()), Some(at(500)));
    assert!(!file.is_settled());
}

proptest! {
    /// Whatever a writer does and whenever it is looked at, nothing is accepted that changed within the quiet time.
    #[test]
    fn nothing_is_accepted_that_is_not_quiet(
        steps in proptest::collection::vec((0u64..1500, 0u64..4, 0usize..4), 1..60)
    ) {
        let mut file = Readiness::new(signature(0), at(0));
        let (mut now, mut size, mut written) = (0, 0, 0);
        for (pause, event, proof) in steps {
            now += pause;
            match event {
                // Seen by a scan, or not before the file is opened.
                0 | 1 => {
                    (size, written) = (size + 1, now);
                    if event == 0 {
                        file.seen(signature(size), at(now));
                    }
                }
                _ => {
                    let found = [None, Some(Proof::Proven), Some(Proof::Plausible), Some(Proof::Doubtful)][proof];
                    if file.judge(&look(now, size, found), &rules()) == Verdict::Accepted {
                        let least = [500, 2000, 10_000][found.unwrap() as usize];
                        prop_assert!(now - written >= least, "{} ms", now - written);
                    }
                }
            }
        }
    }
}
