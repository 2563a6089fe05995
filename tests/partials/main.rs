//! Frames whose samples several runs draw: the picture is that of one run, and what does not fit is refused by name.
#![allow(clippy::unwrap_used)]

#[path = "../resume/command.rs"]
mod command;
#[cfg(unix)]
mod interrupted;
mod merged;
#[path = "../resume/numbers.rs"]
mod numbers;
mod refused;
#[path = "../small/mod.rs"]
mod small;
mod status;

use command::{boxes, floe};
use small::Folder;

const SUN: &str = "[sun]\ndirection = [0.3, -0.2, 0.9]\nirradiance = 2\n";

/// Two boxes of ice in the sun, with all layers.
fn sunny(integrator: &str, samples: u32) -> Folder {
    let render = format!(
        "[render]\nsamples = {samples}\nintegrator = \"{integrator}\"\nphotons = {{ count = 200 }}\n\
         [output]\naovs = [\"albedo\", \"N\", \"P\", \"Z\", \"motion\", \"variance\", \"samples\"]\n"
    );
    boxes(2, &(render + SUN))
}

/// Draws some samples of frame 1.
fn part(folder: &Folder, range: &str) {
    floe(folder, &["render", "boxes", "--frames", "1", "--samples-range", range]).ended(0);
}

const MERGE: [&str; 4] = ["merge", "boxes", "--frames", "1"];
