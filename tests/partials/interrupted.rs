//! Partials whose runs are broken off.

use std::fs;
use std::process::{Child, Command};
use std::thread::sleep;
use std::time::Duration;

use super::command::{command, edit, floe, pictures};
use super::small::Folder;
use super::sunny;

fn send(child: &Child, signal: &str) {
    let id = child.id().to_string();
    // It may have ended by itself meanwhile.
    let _ = Command::new("sh").args(["-c", "kill -$0 $1 2>/dev/null", signal, &id]).status().unwrap();
}

/// Frame 1 with so many samples that it takes a while.
fn lengthy(integrator: &str, samples: u32) -> Folder {
    let folder = sunny(integrator, samples);
    edit(&folder, "resolution = [16, 9]", "resolution = [40, 30]");
    folder
}

/// Breaks the run of the later samples off until it has come to its end.
fn broken_off(integrator: &str, samples: u32) {
    let [range, rest] = [format!("5..{samples}"), "0..5".to_owned()];
    let alone = lengthy(integrator, samples);
    floe(&alone, &["render", "boxes", "--frames", "1"]).ended(0);
    let folder = lengthy(integrator, samples);
    let part =
        ["render", "boxes", "--frames", "1", "--resume", "--checkpoint-every", "0.1s", "--samples-range"];
    let checkpoint = folder.path(&format!("out/boxes/.frame_0001.5-{samples}.checkpoint"));
    for signal in ["TERM", "KILL"] {
        let mut child = command(&folder, &[&part[..], &[&range]].concat()).spawn().unwrap();
        let before = fs::metadata(&checkpoint).and_then(|found| found.modified()).ok();
        while fs::metadata(&checkpoint).and_then(|found| found.modified()).ok() == before {
            assert_eq!(child.try_wait().unwrap(), None, "it ended without a checkpoint");
            sleep(Duration::from_millis(5));
        }
        send(&child, signal);
        let code = child.wait().unwrap().code();
        assert_eq!(code, (signal == "TERM").then_some(75), "{signal}");
        assert!(checkpoint.exists() && !folder.files().iter().any(|name| name.ends_with(".partial")));
    }
    // A checkpoint is of its own samples only.
    let name = |range: &str| folder.path(&format!("out/boxes/.frame_0001.{range}.checkpoint"));
    fs::copy(&checkpoint, name("0-5")).unwrap();
    floe(&folder, &[&part[..], &[&rest]].concat()).ended(0).says(&["0-5.checkpoint", "begins anew"]);
    floe(&folder, &[&part[..], &[&range]].concat()).ended(0);
    assert_eq!(folder.leftovers(), [""; 0]);
    floe(&folder, &["merge", "boxes"]).ended(0);
    assert!(pictures(&folder) == pictures(&alone), "other bytes of {integrator}");
}

#[test]
fn paths_that_were_broken_off_end_as_the_same_bytes() {
    broken_off("path", 1500);
}

#[test]
fn photon_passes_that_were_broken_off_end_as_the_same_bytes() {
    broken_off("photon", 300);
}
