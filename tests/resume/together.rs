//! Workers that draw the same frames at the same time, some of which are killed.

use std::thread::sleep;
use std::time::{Duration, Instant};

use super::command::{command, floe, pictures};
use super::interrupted::lengthy;
use super::numbers::Numbers;

const WORKER: [&str; 5] = ["render", "boxes", "--resume", "--checkpoint-every", "0.02"];

/// Whatever has its final name at any moment is whole, and what the dead leave is found by the next run.
#[test]
fn a_worker_that_is_killed_does_no_harm_to_another_on_the_same_frames() {
    let alone = lengthy("path", 64, "");
    let start = Instant::now();
    floe(&alone, &["render", "boxes"]).ended(0);
    let whole = start.elapsed().as_millis() as u64;
    let alone = pictures(&alone);
    let mut numbers = Numbers(5);
    for round in 0..5 {
        let folder = lengthy("path", 64, "");
        let [mut victim, survivor] = [(); 2].map(|()| command(&folder, &WORKER).spawn().unwrap());
        sleep(Duration::from_millis(numbers.below(2 * whole)));
        // On Unix that is SIGKILL.
        victim.kill().unwrap();
        victim.wait().unwrap();
        for (name, bytes) in pictures(&folder) {
            assert!(bytes == alone[&name], "{name} of round {round} is no whole picture");
        }
        let output = survivor.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        assert!(pictures(&folder) == alone, "round {round}");
        floe(&folder, &WORKER).ended(0).prints(&["3 of 3 frames were there already"]);
        assert!(pictures(&folder) == alone);
        assert_eq!(folder.leftovers(), [""; 0]);
    }
}
