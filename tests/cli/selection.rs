//! `--frames` in every form that users and schedulers write.

use super::small::{cuboid, labelled, ply};
use super::{boxes, floe, melt, pictures};

#[test]
fn frames_are_chosen_in_every_form() {
    for (selection, chosen) in [
        ("2", vec![2]),
        ("0,2", vec![0, 2]),
        ("1-2", vec![1, 2]),
        ("0-2x2", vec![0, 2]),
        ("0-9:2", vec![0, 2]),
    ] {
        let folder = melt();
        floe(&folder, &["render", "melt", "--frames", selection]).ended(0);
        let expected: Vec<String> = chosen.iter().map(|n| format!("out/melt/frame_000{n}.exr")).collect();
        assert_eq!(pictures(&folder), expected, "{selection}");
    }
}

/// As Open Job Description and Slurm send them, verbatim.
#[test]
fn frames_of_schedulers_are_taken_as_they_come() {
    let folder = boxes(0, "");
    for (number, name) in [(-5, "-5"), (-3, "-3"), (-1, "-1"), (7, "7"), (9, "9"), (20, "20")] {
        let size = 0.5 + 0.01 * f64::from(number);
        let cube = cuboid(glam::DVec3::splat(-size), glam::DVec3::splat(size));
        let mesh = labelled(cube, 0, 1);
        folder.write(&format!("boxes/frames/frame_{name}.ply"), ply(&mesh));
    }
    for (arguments, frames) in [
        (&["--frames", "7,9,20"][..], "7,9,20"),
        (&["--frames", "-5--1"], "-5--1x2"),
        (&["--frames=-5--1:2"], "-5--1x2"),
        (&["--frames", "-3,7"], "-3,7"),
        (&["--frames", "-5"], "-5"),
        (&["--frames", "1-100x2"], "7,9"),
        (&["--frames", "1-100:2,20"], "7,9,20"),
    ] {
        let outcome = floe(&folder, &[&["render", "boxes"], arguments].concat()).ended(0);
        assert!(outcome.stdout.contains(&format!(" ({frames}) in ")), "{arguments:?} {outcome:#?}");
    }
}
