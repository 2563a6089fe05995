//! How a watch begins and ends: nothing there yet, restarts, and what it is told to wait for.

use std::time::Duration;

use floe::driver::watch::{End, Phase};
use floe::driver::{RenderError, WatchOptions, watch};
use floe::sequence::FrameNumber;

use super::small::{Folder, scene};
use super::{QUIET, Witness, contents, drawn_of, hash, options, picture, watched};

fn frame(number: usize) -> String {
    format!("frames/frame_{number:04}.ply")
}

fn numbers(list: &[u32]) -> Vec<FrameNumber> {
    list.iter().map(|n| FrameNumber::from(*n)).collect()
}

#[test]
fn a_second_watch_draws_only_what_has_changed() {
    let folder = Folder::with_scene(&scene(""));
    for number in 0..4 {
        folder.write(&frame(number), contents(number));
    }
    folder.write("frames/DONE", "");
    let first = watched(&folder, &options(&folder), &Witness::default());
    assert_eq!((first.finished, first.drawn), (4, numbers(&[0, 1, 2, 3])));
    // Another date is no other mesh; other bytes are; so are pictures that are gone or damaged.
    folder.write(&frame(0), contents(0));
    folder.write(&frame(1), contents(9));
    std::fs::remove_file(picture(&folder, 2)).unwrap();
    let bytes = folder.read("out/frame_0003.exr");
    folder.write("out/frame_0003.exr", &bytes[..bytes.len() - 7]);
    std::fs::remove_file(folder.path("out/latest.png")).unwrap();
    let witness = Witness::default();
    let second = watched(&folder, &options(&folder), &witness);
    assert_eq!((second.finished, second.drawn), (3, numbers(&[0, 1, 2, 3])));
    assert_eq!(drawn_of(&picture(&folder, 1)), Some(hash(&contents(9))));
    assert_eq!(folder.read("out/latest.png"), folder.read("out/frame_0003.png"));
    // With nothing left to do there still is a newest picture.
    std::fs::remove_file(folder.path("out/latest.png")).unwrap();
    assert_eq!(watched(&folder, &options(&folder), &Witness::default()).finished, 0);
    assert_eq!(folder.read("out/latest.png"), folder.read("out/frame_0003.png"));
}

/// Neither folder nor scene is there; what is drawn is byte for byte what `floe render` makes of the same files.
#[test]
fn a_folder_that_is_not_there_yet_gets_a_scene_from_its_first_whole_frame() {
    let folder = Folder::new();
    let path = folder.path("sim");
    let output = folder.path("out/frame_####.exr").to_str().unwrap().to_owned();
    let mut options = options(&folder);
    options.render.samples = Some(2);
    let witness = Witness::default();
    // The scene would go to the current directory, which tests share.
    folder.write(
        "later.toml",
        scene("[frames]\npath = \"frames/frame_####.ply\"\n")
            .replace("eye = [0.4, -4, 0.9]\ntarget = [0, 0, 0]\n", ""),
    );
    let report = std::thread::scope(|scope| {
        let watching = scope.spawn(|| watch(&path, &options, &witness).unwrap());
        std::thread::sleep(QUIET * 4);
        std::fs::create_dir(&path).unwrap();
        folder.write("sim/frames/frame_0002.ply", &contents(2)[..300]);
        std::fs::copy(folder.path("later.toml"), path.join("scene.toml")).unwrap();
        std::thread::sleep(QUIET * 4);
        folder.write("sim/frames/frame_0001.ply", contents(1));
        std::thread::sleep(QUIET * 4);
        folder.write("sim/frames/frame_0002.ply", contents(2));
        folder.write("sim/frames/DONE", "");
        watching.join().unwrap()
    });
    assert_eq!((report.ended, report.drawn), (End::DoneFile, numbers(&[1, 2])));
    let phases = witness.phases.lock().unwrap();
    let waited =
        phases.iter().any(|s| matches!(&s.phase, Phase::Waiting(what) if what.starts_with("the folder")));
    assert!(waited, "{phases:?}");
    let warnings = witness.warnings.lock().unwrap();
    let told = |text: &&String| text.contains("frames frame 1,") && text.contains("write eye = [");
    assert_eq!(warnings.iter().filter(told).count(), 1, "{warnings:?}");
    let watched: Vec<Vec<u8>> = [1, 2].map(|n| std::fs::read(picture(&folder, n)).unwrap()).into();
    let job = floe::driver::Job::open(&path).unwrap();
    let again = floe::driver::RenderOptions { output: Some(output), samples: Some(2), ..Default::default() };
    floe::driver::render(&job, &again, &Witness::default()).unwrap();
    let rendered: Vec<Vec<u8>> = [1, 2].map(|n| std::fs::read(picture(&folder, n)).unwrap()).into();
    assert!(watched == rendered, "the same frames, other bytes");
}

#[test]
fn until_waits_for_gaps_a_little_and_for_the_frame_as_long_as_it_takes() {
    let folder = Folder::with_scene(&scene(""));
    let options = WatchOptions { until: Some(FrameNumber::from(3)), done_file: None, ..options(&folder) };
    for number in [0, 1, 3] {
        folder.write(&frame(number), contents(number));
    }
    let report = std::thread::scope(|scope| {
        let watching = scope.spawn(|| watched(&folder, &options, &Witness::default()));
        // Frame 3 came before frame 2: 8 quiet times are less than the patience of 20.
        std::thread::sleep(QUIET * 8);
        folder.write(&frame(2), contents(2));
        watching.join().unwrap()
    });
    assert_eq!((report.ended, report.drawn), (End::Until, numbers(&[0, 1, 2, 3])));
}

#[test]
fn samples_that_frames_would_share_are_told() {
    let folder = Folder::with_scene(&scene("[render]\nsamples = 4\nseed_mode = \"sequence\"\n"));
    folder.write("frames/DONE", "");
    let mut options = options(&folder);
    options.render.samples = Some(16);
    let witness = Witness::default();
    watched(&folder, &options, &witness);
    let warnings = witness.warnings.lock().unwrap();
    assert_eq!(warnings.iter().filter(|text| text.contains("16 samples a pixel reach")).count(), 1);
}

#[test]
fn silence_ends_it_only_when_told() {
    let folder = Folder::with_scene(&scene(""));
    let timeout = QUIET * 30;
    let options = WatchOptions { idle_timeout: Some(timeout), ..options(&folder) };
    let start = std::time::Instant::now();
    let report = watched(&folder, &options, &Witness::default());
    assert_eq!((report.ended, report.drawn.len()), (End::Idle, 0));
    assert!(start.elapsed() >= timeout);
}

#[test]
fn a_request_ends_it_and_says_what_is_left() {
    let folder = Folder::with_scene(&scene("[render]\nsamples = 2000000\n"));
    folder.write(&frame(1), contents(1));
    let options = options(&folder);
    let start = std::time::Instant::now();
    let report = std::thread::scope(|scope| {
        let watching = scope.spawn(|| watched(&folder, &options, &Witness::default()));
        std::thread::sleep(Duration::from_millis(400));
        options.render.interrupt.request();
        watching.join().unwrap()
    });
    assert_eq!((report.ended, report.expected_more), (End::Interrupted, true));
    assert_eq!(report.pending, numbers(&[1]));
    // The frame takes minutes; what is told to stop has 2 s, on a busy machine more.
    assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
}

/// The exit code tells that the frame is bad; to wait for it would be to wait for ever.
#[test]
fn until_a_frame_that_is_bad_ends() {
    let folder = Folder::with_scene(&scene(""));
    let options = WatchOptions { until: Some(FrameNumber::from(2)), done_file: None, ..options(&folder) };
    folder.write(&frame(1), contents(1));
    folder.write(&frame(2), &contents(2)[..300]);
    let report = watched(&folder, &options, &Witness::default());
    assert_eq!((report.ended, report.drawn), (End::Until, numbers(&[1])));
    assert_eq!(report.failures.iter().map(|(number, _)| *number).collect::<Vec<_>>(), numbers(&[2]));
}

/// Frame 2 is drawn and taken away before frame 1 comes.
#[test]
fn until_a_frame_that_is_drawn_and_gone_ends() {
    let folder = Folder::with_scene(&scene("[frames]\npath = \"frames/*.ply\"\n"));
    let options = WatchOptions { until: Some(FrameNumber::from(2)), done_file: None, ..options(&folder) };
    folder.write(&frame(1), &contents(1)[..300]);
    folder.write(&frame(2), contents(2));
    let report = std::thread::scope(|scope| {
        let watching = scope.spawn(|| watched(&folder, &options, &Witness::default()));
        while !picture(&folder, 2).exists() {
            std::thread::sleep(QUIET / 5);
        }
        std::fs::remove_file(folder.path(&frame(2))).unwrap();
        folder.write(&frame(1), contents(1));
        watching.join().unwrap()
    });
    assert_eq!((report.ended, report.drawn), (End::Until, numbers(&[1, 2])));
}

#[test]
fn folders_of_times_have_the_done_file_above_them() {
    let folder = Folder::with_scene(&scene("[frames]\npath = \"cut/*/surface.ply\"\n"));
    folder.write("cut/1/surface.ply", contents(1));
    folder.write("cut/2/surface.ply", contents(2));
    folder.write("cut/DONE", "");
    let options = WatchOptions { idle_timeout: Some(Duration::from_secs(20)), ..options(&folder) };
    let report = watched(&folder, &options, &Witness::default());
    assert_eq!((report.ended, report.drawn), (End::DoneFile, numbers(&[1, 2])));
}

/// Only `DONE` is as early as the frame; the floor comes within the patience.
#[test]
fn other_files_may_come_after_the_done_file() {
    let surface =
        "[[surfaces]]\nmesh = \"floor_####.ply\"\nmaterial = { kind = \"diffuse\", reflectance = 0.5 }\n";
    let folder = Folder::with_scene(&scene(surface));
    folder.write(&frame(1), contents(1));
    folder.write("frames/DONE", "");
    let options = options(&folder);
    let report = std::thread::scope(|scope| {
        let watching = scope.spawn(|| watched(&folder, &options, &Witness::default()));
        std::thread::sleep(QUIET * 8);
        folder.write("floor_0001.ply", contents(0));
        watching.join().unwrap()
    });
    assert_eq!((report.ended, report.drawn), (End::DoneFile, numbers(&[1])));
}

/// A floor that is whole in the end, but was half written, or another one, when the frame was drawn.
#[test]
fn other_files_that_change_are_drawn_again() {
    let folder = Folder::with_scene(&scene(
        "[[surfaces]]\nmesh = \"floor_####.obj\"\nmaterial = { kind = \"diffuse\", reflectance = 0.5 }\n",
    ));
    let floor = |z: f64| format!("v -9 -9 {z}\nv 9 -9 {z}\nv 9 9 {z}\nv -9 9 {z}\nf 1 2 3\nf 1 3 4\n");
    folder.write("floor_0001.obj", floor(-1.5));
    folder.write(&frame(1), contents(1));
    let options = options(&folder);
    let report = std::thread::scope(|scope| {
        let watching = scope.spawn(|| watched(&folder, &options, &Witness::default()));
        while !picture(&folder, 1).exists() {
            std::thread::sleep(QUIET / 5);
        }
        folder.write("floor_0001.obj", floor(-1.2));
        folder.write("frames/DONE", "");
        watching.join().unwrap()
    });
    assert_eq!((report.ended, report.drawn, report.finished), (End::DoneFile, numbers(&[1]), 2));
    let watched = folder.read("out/frame_0001.exr");
    folder.render(floe::driver::RenderOptions::default());
    assert!(watched == folder.read("out/frame_0001.exr"), "a picture of the floor that was");
}

/// The velocities come after the mesh, and the picture has them.
#[test]
fn velocities_beside_a_mesh_that_come_later_are_in_the_picture() {
    let camera = "[camera]\neye = [0.4, -4, 0.9]\ntarget = [0, 0, 0]\nresolution = [16, 9]\nshutter = 0.5\n";
    let frames = "[frames]\npath = \"frames/######.bobj\"\n";
    let folder = Folder::with_scene(&scene(&format!("{camera}{frames}")));
    let mesh = super::small::cube();
    let vectors = |list: Vec<[f32; 3]>| {
        let numbers = list.as_flattened().iter().flat_map(|c| c.to_le_bytes());
        [(list.len() as u32).to_le_bytes().to_vec(), numbers.collect()].concat()
    };
    let indices = mesh.triangles.as_flattened().iter().flat_map(|index| index.to_le_bytes());
    let triangles = [(mesh.triangles.len() as u32).to_le_bytes().to_vec(), indices.collect()].concat();
    let corners: Vec<[f32; 3]> = mesh.positions.iter().map(|p| p.as_vec3().to_array()).collect();
    let velocities = [vectors(vec![[9.0, 0.0, 0.0]; corners.len()]), 0u32.to_le_bytes().to_vec()].concat();
    folder.write("frames/000001.bobj", [vectors(corners), triangles].concat());
    let options = options(&folder);
    std::thread::scope(|scope| {
        let watching = scope.spawn(|| watched(&folder, &options, &Witness::default()));
        std::thread::sleep(QUIET * 6);
        folder.write("frames/velocity000001.bobj", velocities);
        folder.write("frames/DONE", "");
        assert_eq!(watching.join().unwrap().ended, End::DoneFile);
    });
    let watched = folder.read("out/frame_0001.exr");
    folder.render(floe::driver::RenderOptions::default());
    assert!(watched == folder.read("out/frame_0001.exr"), "a picture without velocities");
}

/// What `floe render` drew with the motion to the next frame, a watch does not draw without it.
#[test]
fn pictures_with_motion_stay() {
    let folder = Folder::with_scene(&scene(
        "[camera]\neye = [0.4, -4, 0.9]\ntarget = [0, 0, 0]\nresolution = [16, 9]\nshutter = 0.5\n\
         [frames]\npath = \"frames/frame_####.ply\"\nvelocity = \"frames\"\n",
    ));
    for number in 0..3 {
        folder.write(&frame(number), contents(number));
    }
    folder.write("frames/DONE", "");
    folder.render(floe::driver::RenderOptions::default());
    let watch = || watched(&folder, &options(&folder), &Witness::default());
    assert_eq!(watch().finished, 0);
    // Without the last frame nobody can say what the one before it moved to; with another one it can be said.
    std::fs::remove_file(folder.path(&frame(2))).unwrap();
    assert_eq!(watch().finished, 0);
    folder.write(&frame(1), contents(7));
    assert_eq!(watch().finished, 2);
}

#[test]
fn other_files_that_come_later_are_waited_for() {
    let surface =
        "[[surfaces]]\nmesh = \"floor_####.ply\"\nmaterial = { kind = \"diffuse\", reflectance = 0.5 }\n";
    let folder = Folder::with_scene(&scene(surface));
    folder.write(&frame(1), contents(1));
    let options = WatchOptions { until: Some(FrameNumber::from(1)), done_file: None, ..options(&folder) };
    let witness = Witness::default();
    let report = std::thread::scope(|scope| {
        let watching = scope.spawn(|| watched(&folder, &options, &witness));
        std::thread::sleep(QUIET * 8);
        folder.write("floor_0001.ply", contents(0));
        watching.join().unwrap()
    });
    assert_eq!((report.ended, report.failures.len()), (End::Until, 0));
    let failed = witness.failed.lock().unwrap();
    assert!(failed.iter().all(|(_, error)| error.contains("floor_0001.ply")), "{failed:?}");
}

#[test]
fn a_still_and_a_scene_that_is_not_there_are_errors() {
    let folder = Folder::new();
    folder.write("still.toml", "[camera]\neye = [0, -4, 0]\ntarget = [0, 0, 0]\n");
    let witness = Witness::default();
    let error = watch(&folder.path("still.toml"), &options(&folder), &witness).unwrap_err();
    assert!(matches!(error, RenderError::NothingToWatch { .. }), "{error}");
    let error = watch(&folder.path("missing.toml"), &options(&folder), &witness).unwrap_err();
    assert!(matches!(error, RenderError::NotFound { .. }), "{error}");
}
