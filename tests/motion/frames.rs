//! Sequences: other triangles from frame to frame, velocities from the next frame, threads.

use floe::driver::{Job, RenderOptions};
use floe::mesh::RawMesh;
use floe::study::{SeedModeStudy, study_seed_modes};
use glam::{DVec3, Vec3};

use crate::small::{Folder, cuboid, joined, labelled, ply, scene, without_marks};

const CAMERA: &str = "[camera]\neye = [{ frame = 0, eye = [0.4, -4, 0.9] }, { frame = 2, eye = [-0.6, -3.8, 1.2] }]\n\
                      target = [0, 0, 0]\nvertical_fov = 40\nresolution = [32, 18]\nshutter = 0.5\naperture = 0.1\n";
const OUTPUT: &str = "[output]\naovs = [\"motion\", \"Z\"]\n";

/// PLY text with velocities: those of a body that moves along.
fn moving(mesh: &RawMesh, velocity: Vec3) -> String {
    let text = ply(mesh).replacen(
        "property double z\n",
        "property double z\nproperty float vx\nproperty float vy\nproperty float vz\n",
        1,
    );
    let head = text.find("end_header\n").unwrap() + "end_header\n".len();
    let vertices = mesh.positions.len();
    let with = |(i, line): (usize, &str)| match i < vertices {
        true => format!("{line} {} {} {}\n", velocity.x, velocity.y, velocity.z),
        false => format!("{line}\n"),
    };
    text[..head].to_owned() + &text[head..].lines().enumerate().map(with).collect::<String>()
}

fn body(at: DVec3) -> RawMesh {
    labelled(cuboid(at - 0.5, at + 0.5), 0, 1)
}

/// Three frames: the second has one cube more, the third is the first moved on.
fn sequence(text: &str) -> Folder {
    let folder = Folder::with_scene(text);
    let one = body(DVec3::ZERO);
    let two = joined(body(DVec3::X * 0.1), &labelled(cuboid(DVec3::splat(0.8), DVec3::splat(1.1)), 0, 2));
    for (number, mesh) in [one, two, body(DVec3::X * 0.2)].iter().enumerate() {
        folder.write(&format!("frames/frame_{number:04}.ply"), moving(mesh, Vec3::new(24.0 * 0.8, 0.0, 6.0)));
    }
    folder
}

fn pictures(folder: &Folder, options: RenderOptions) -> Vec<Vec<u8>> {
    let report = folder.render(options);
    assert!(report.failures.is_empty(), "{:?}", report.failures);
    report.frames.iter().map(|frame| std::fs::read(&frame.output).unwrap()).collect()
}

#[test]
fn frames_are_the_same_on_any_number_of_threads_and_alone() {
    let folder = sequence(&(scene(CAMERA) + OUTPUT));
    let all = pictures(&folder, RenderOptions { threads: Some(1), ..RenderOptions::default() });
    assert_eq!(pictures(&folder, RenderOptions { threads: Some(4), ..RenderOptions::default() }), all);
    for (number, picture) in all.iter().enumerate() {
        let frames = floe::sequence::FrameSelection::parse(&number.to_string()).unwrap();
        let alone = RenderOptions { frames: Some(frames), ..RenderOptions::default() };
        assert_eq!(pictures(&folder, alone)[0], *picture, "frame {number}");
    }
    let closed = sequence(&(scene(&CAMERA.replace("shutter = 0.5", "shutter = 0")) + OUTPUT));
    let still = pictures(&closed, RenderOptions::default());
    assert!(still.iter().zip(&all).all(|(still, open)| still != open));
}

fn warnings(folder: &Folder) -> Vec<String> {
    let report = folder.render(RenderOptions::default());
    assert!(report.failures.is_empty(), "{:?}", report.failures);
    report.frames.iter().map(|frame| frame.warnings.join("\n")).collect()
}

const OPEN: &str =
    "[camera]\neye = [0.4, -4, 0.9]\ntarget = [0, 0, 0]\nresolution = [16, 9]\nshutter = 0.5\n";
const FRAMES: &str = "[frames]\npath = \"frames/frame_####.ply\"\nvelocity = \"frames\"\n";

/// Frames 0 and 1 have the same triangles and the body goes on by 0.3: the first frame is that of a file with velocities.
/// The second has no next one with the same triangles, in the third a vertex jumps, and the last has nothing after it.
#[test]
fn velocities_follow_from_the_next_frame_where_its_vertices_are_the_same() {
    let way = DVec3::new(0.25, 0.0, 0.125);
    let folder = Folder::with_scene(&scene(&format!("{FRAMES}{OPEN}")));
    let last = joined(body(way), &labelled(cuboid(DVec3::splat(0.9), DVec3::splat(1.1)), 0, 2));
    let mut jumped = last.clone();
    let corner = jumped.positions.iter().position(|p| *p == way + 0.5).unwrap();
    jumped.positions[corner].z += 9.0;
    for (number, mesh) in [body(DVec3::ZERO), body(way), last, jumped].iter().enumerate() {
        folder.frame(number as u32, mesh);
    }
    let told = warnings(&folder);
    assert_eq!(told[0], "");
    assert!(told[1].contains("the next frame has other triangles; nothing in it moves"), "{told:?}");
    assert!(told[2].contains("jump from their neighbours"), "{told:?}");
    assert!(told[3].contains("there is no next frame"), "{told:?}");
    let followed = without_marks(folder.read("out/frame_0000.exr"));
    let folder = Folder::with_scene(&scene(OPEN));
    folder.write("frames/frame_0000.ply", moving(&body(DVec3::ZERO), (way * 24.0).as_vec3()));
    folder.render(RenderOptions::default());
    assert!(without_marks(folder.read("out/frame_0000.exr")) == followed);
}

#[test]
fn files_without_velocities_are_told_and_rendered() {
    let folder = Folder::with_scene(&scene(OPEN));
    folder.frame(0, &body(DVec3::ZERO));
    assert!(warnings(&folder)[0].contains("the file has no velocities"));
    let silent = Folder::with_scene(&scene(&format!("{}{OPEN}", FRAMES.replace("\"frames\"", "\"none\""))));
    silent.frame(0, &body(DVec3::ZERO));
    assert_eq!(warnings(&silent), [""]);
    let pictures = [&silent, &folder].map(|f| without_marks(f.read("out/frame_0000.exr")));
    assert!(pictures[0] == pictures[1]);
}

/// Bodies that go on without velocities in their files: with `frames` as the source of velocities they are blurred, so the
/// study measures other pictures than with `none`.
#[test]
fn studies_follow_vertices_too() {
    let measured = |velocity: &str| {
        let frames = format!("[frames]\npath = \"frames/frame_####.ply\"\nvelocity = \"{velocity}\"\n");
        let folder = Folder::with_scene(&scene(&format!("{frames}{OPEN}")));
        for number in 0..8 {
            folder.frame(number, &body(DVec3::X * 0.2 * f64::from(number)));
        }
        let job = Job::open(&folder.path("scene.toml")).unwrap();
        study_seed_modes(&job, &SeedModeStudy::default(), |_| ()).unwrap()
    };
    assert_ne!(measured("frames"), measured("none"));
}
