//! `[camera]`: keys, the turntable, shutter and lens.

use floe::scene::description::FieldOfView;
use glam::Vec3;

use crate::{Wrong, assert_wrong, example};

#[test]
fn a_camera_without_a_place_frames_the_first_frame() {
    let scene = example("automatic camera");
    assert_eq!(scene.camera.placement, None);
    assert_eq!((scene.camera.up, scene.camera.resolution), (Vec3::Y, [1920, 1080]));
    assert!(!scene.output.png);
}

#[test]
fn a_camera_moves_from_key_to_key() {
    let camera = example("moving camera").camera;
    assert_eq!(camera.keys.iter().map(|key| key.frame).collect::<Vec<_>>(), [1.0, 12.5, 30.0]);
    assert_eq!(camera.placement, Some(camera.keys[0].placement));
    let targets: Vec<f64> = camera.keys.iter().map(|key| key.placement.target.z).collect();
    assert_eq!(targets, [0.5, 0.0, 0.0]);
    let fields = camera.keys.iter().map(|key| key.fov);
    assert_eq!(fields.collect::<Vec<_>>(), [40.0, 30.0, 50.0].map(FieldOfView::Vertical));
    let focus: Vec<Option<f64>> = camera.keys.iter().map(|key| key.focus_distance).collect();
    assert_eq!(focus, [None, Some(2.0), None]);
    assert_eq!(camera.turntable.unwrap().degrees_per_frame, -0.5);
}

/// What is wrong with moving cameras, shutters and lenses.
#[rustfmt::skip]
const WRONG: &[Wrong] = &[
    ("[camera]\neye = [{ frame = 1, eye = [1, 1, 1], targets = [0, 0, 0] }]", 2, 38, "unknown key `targets` in camera.eye[0]; did you mean `target`?"),
    ("[camera]\neye = [{ frame = 1, eye = [1, 1, 1] }]", 2, 8, "camera.eye[0] has no `target`: write what the camera looks at"),
    ("[camera]\neye = [{ eye = [1, 1, 1] }]", 2, 8, "camera.eye[0] has no `frame`: write the number of the frame"),
    ("[camera]\neye = [{ frame = 1, eye = [1, 1, 1], target = [0, 0, 0] }, 7]", 2, 60, "camera.eye[1]: 7: write a key such as"),
    ("[camera]\nturntable = 7", 2, 13, "camera.turntable: 7: write a table such as { frames_per_turn = 120 }"),
    ("[camera]\nshutter = 1.5", 2, 11, "camera.shutter: 1.5: write a number from 0 to 1"),
    ("[camera]\naperture = -1", 2, 12, "camera.aperture: -1: write a number that is not below 0"),
    ("[camera]\nfocus_distance = 0", 2, 18, "camera.focus_distance: 0: write a length from 1e-9"),
    ("[camera]\nturntable = { frames_per_turn = 0.5 }", 2, 33, "a turn takes a frame or more"),
    ("[camera]\nturntable = { degrees_per_frame = 400 }", 2, 35, "write an angle from -360 to 360 degrees"),
    ("[camera]\nturntable = { frame = 1 }", 2, 13, "write either degrees_per_frame or frames_per_turn"),
    ("[camera]\ntarget = [0, 0, 0]\neye = [{ frame = 2, eye = [1, 1, 1] }, { frame = 2, eye = [1, 1, 2] }]", 3, 50,
     "camera.eye[1].frame: 2: the frames of the keys must rise"),
    ("[camera]\ntarget = [0, 0, 0]\neye = [{ frame = 2, eye = [1, 1, 1] }, { frame = 3, eye = [1, 1, 2], horizontal_fov = 9 }]", 3, 40,
     "write vertical_fov in all keys, or horizontal_fov in all"),
];

#[test]
fn every_wrong_camera_is_named_with_its_place() {
    assert_wrong(WRONG);
}
