//! Meshes in memory are rendered as meshes in files: the same bytes, warnings and errors.
#![allow(clippy::unwrap_used)]

mod small;

use std::path::Path;
use std::sync::Mutex;

use floe::accel::Hierarchy;
use floe::driver::{Interrupt, Observer, RenderError, RenderOptions, Renderer, Status};
use floe::glam::{DVec3, Vec3};
use floe::mesh::{Interface, MeshSlices, Positions, RawMesh, Region};
use small::{Folder, cube, cuboid, joined, labelled, scene, without_marks};

const CAMERA: &str = "[camera]\neye = [0.4, -4, 0.9]\ntarget = [0, 0, 0]\nvertical_fov = 40\nresolution = [24, 16]\nshutter = 0.5\n";
const OUTPUT: &str = "[output]\naovs = [\"motion\", \"variance\", \"N\"]\n";

/// Ice in water that sways and turns: the same triangles as long as there is one `floe` of ice, others with two.
fn swaying(time: f64, floes: u32) -> RawMesh {
    let ice = |x: f64| labelled(cuboid(DVec3::new(x, -0.2, -0.2), DVec3::new(x + 0.3, 0.2, 0.2)), 1, 2);
    let water = labelled(cube(), 0, 1);
    let mut mesh = (0..floes).fold(water, |mesh, i| joined(mesh, &ice(-0.4 + 0.5 * f64::from(i))));
    let velocity = |p: DVec3| DVec3::new(-p.y, p.x, 0.3 * p.x * p.z);
    mesh.velocities = Some(mesh.positions.iter().map(|&p| velocity(p).as_vec3()).collect());
    for p in &mut mesh.positions {
        *p += velocity(*p) * time;
    }
    mesh
}

/// Frames 3, 4 and 5: the last one has other triangles.
fn frames() -> [(u32, RawMesh); 3] {
    [(3, swaying(0.0, 1)), (4, swaying(0.1, 1)), (5, swaying(0.2, 2))]
}

fn options(threads: usize) -> RenderOptions {
    RenderOptions { threads: Some(threads), ..RenderOptions::default() }
}

fn renderer(text: &str) -> Renderer {
    Renderer::parse(text, Path::new("scene.toml"), options(1)).unwrap()
}

/// A mesh by way of the arrays of a simulator.
fn from_slices(mesh: &RawMesh) -> RawMesh {
    let positions: Vec<[f64; 3]> = mesh.positions.iter().map(DVec3::to_array).collect();
    let velocities: Option<Vec<[f32; 3]>> =
        mesh.velocities.as_ref().map(|all| all.iter().map(Vec3::to_array).collect());
    let labels: Option<Vec<[i32; 2]>> =
        mesh.interfaces.as_ref().map(|all| all.iter().map(|i| [i.front.0, i.back.0]).collect());
    let slices = MeshSlices {
        positions: Positions::Double(&positions),
        velocities: velocities.as_deref(),
        triangles: &mesh.triangles,
        labels: labels.as_deref(),
    };
    slices.into()
}

#[test]
fn frames_in_memory_have_the_bytes_of_frames_in_files() {
    let text = scene(&format!("{CAMERA}{OUTPUT}[media.water]\nior = 1.33\nscattering = 1\n"));
    let folder = Folder::with_scene(&text);
    for (number, mesh) in &frames() {
        folder.frame(*number, mesh);
    }
    let report = folder.render(options(2));
    assert!(report.failures.is_empty(), "{:?}", report.failures);
    for threads in [1, 2] {
        let mut renderer = Renderer::open(&folder.path("scene.toml"), options(threads)).unwrap();
        for ((number, mesh), file) in frames().into_iter().zip(&report.frames) {
            let is_copied = number == 4;
            let mesh = if is_copied { from_slices(&mesh) } else { mesh };
            let rendered = renderer.render(number, mesh, &()).unwrap();
            let name = format!("frame_{number:04}");
            rendered.write(&folder.path(&format!("memory/{name}.exr"))).unwrap();
            for ending in ["exr", "png"] {
                let [there, here] =
                    ["out", "memory"].map(|place| folder.read(&format!("{place}/{name}.{ending}")));
                let is_equal = match ending {
                    "exr" => without_marks(there) == without_marks(here),
                    _ => there == here,
                };
                assert!(is_equal, "{name}.{ending} on {threads} threads");
            }
            let record = &rendered.record;
            assert_eq!(record.status, Status::Complete);
            assert_eq!(record.relative_error, file.relative_error);
            assert_eq!(record.counters, file.counters);
            assert_eq!((record.hierarchy, &record.interfaces), (file.hierarchy, &file.interfaces));
            let colours: Vec<[f32; 4]> = rendered.rgba().collect();
            assert_eq!(colours.len(), 24 * 16);
            assert_eq!(colours[5][..3], rendered.image.pixels[5].rgb.to_array());
        }
    }
    let made: Vec<Hierarchy> = report.frames.iter().map(|frame| frame.hierarchy.unwrap()).collect();
    assert_eq!((made[0], made[2]), (Hierarchy::Built, Hierarchy::Built));
    assert_ne!(made[1], Hierarchy::Built, "its triangles are those of the frame before");
    let moved = |frame: &[u8]| without_marks(frame.to_vec());
    assert_ne!(moved(&folder.read("out/frame_0003.exr")), moved(&folder.read("out/frame_0004.exr")));
}

#[test]
fn a_scene_without_a_camera_frames_the_first_mesh() {
    let text =
        scene("[camera]\nresolution = [8, 8]\n[frames]\npath = \"frames/frame_####.ply\"\nscale = 0.1\n");
    let folder = Folder::with_scene(&text);
    folder.frame(1, &swaying(0.0, 1));
    folder.render(options(1));
    let mut renderer = renderer(&text);
    renderer.render(1, swaying(0.0, 1), &()).unwrap().write(&folder.path("memory.exr")).unwrap();
    let [there, here] = ["out/frame_0001.exr", "memory.exr"].map(|name| without_marks(folder.read(name)));
    assert!(there == here);
}

#[test]
fn a_mesh_that_makes_no_frame_is_not_what_the_camera_is_on() {
    let text = scene("[camera]\nresolution = [8, 8]\n");
    let good = || labelled(cube(), 0, 1);
    let mut wrong = labelled(cuboid(DVec3::splat(50.0), DVec3::splat(60.0)), 0, 1);
    wrong.interfaces.as_mut().unwrap()[0].back = Region(9);
    let mut tried = renderer(&text);
    tried.render(1, wrong, &()).unwrap_err();
    let after = tried.render(2, good(), &()).unwrap();
    assert_eq!(after.image, renderer(&text).render(2, good(), &()).unwrap().image);
}

#[test]
fn what_a_scene_may_leave_out_and_what_it_may_not_have() {
    let water = labelled(cube(), 0, 1);
    let with_frames = renderer(&scene("")).render(1, water.clone(), &()).unwrap();
    let text = scene("").replace("[frames]\npath = \"frames/frame_####.ply\"\n", "");
    assert!(!text.contains("[frames]"));
    let without = renderer(&text).render(1, water, &()).unwrap();
    assert_eq!(with_frames.image, without.image);
    let several = format!("{text}\n[[meshes]]\npath = \"tank.obj\"\ninside = \"ice\"\n");
    let refused = Renderer::parse(&several, Path::new("scene.toml"), options(1)).unwrap_err();
    assert!(matches!(refused, RenderError::MeshesInMemory { .. }), "{refused}");
}

/// Whatever is wrong costs one frame, and is told with its place and value.
#[test]
fn a_wrong_mesh_is_named_and_the_next_frame_is_as_ever() {
    let mut renderer = renderer(&scene(""));
    let good = || labelled(cube(), 0, 1);
    let before = renderer.render(1, good(), &()).unwrap();
    type Change = fn(&mut RawMesh);
    let wrong: [(&str, Change); 4] = [
        ("mesh in memory: vertex 3: the coordinates [0.8, NaN, -0.8] are not finite", |mesh| {
            mesh.positions[3].y = f64::NAN;
        }),
        ("mesh in memory: triangle 7: vertex index 8, but there are 8", |mesh| mesh.triangles[7][2] = 8),
        ("mesh in memory: label 5 has no medium; add `5 = \"NAME\"` to [regions] in scene.toml", |mesh| {
            mesh.interfaces.as_mut().unwrap()[2] = Interface { front: Region(0), back: Region(5) };
        }),
        ("mesh in memory: 11 pairs of labels for 12 triangles", |mesh| {
            mesh.interfaces.as_mut().unwrap().pop();
        }),
    ];
    for (message, change) in wrong {
        let mut mesh = good();
        change(&mut mesh);
        let error = renderer.render(2, mesh, &()).unwrap_err().to_string();
        assert!(error.starts_with(message), "{error}");
    }
    let again = renderer.render(1, good(), &()).unwrap();
    assert_eq!(again.image, before.image);
    assert_eq!(again.record.hierarchy, Some(Hierarchy::Refitted));
    renderer.forget();
    let anew = renderer.render(1, good(), &()).unwrap();
    assert_eq!((&anew.image, anew.record.hierarchy), (&before.image, Some(Hierarchy::Built)));
}

#[test]
fn velocities_that_are_not_there_are_told() {
    let text = scene(CAMERA);
    for velocity in ["auto", "frames"] {
        let frames = format!("[frames]\npath = \"memory\"\nvelocity = \"{velocity}\"\n");
        let text = text.replace("[frames]\npath = \"frames/frame_####.ply\"\n", &frames);
        let warnings = renderer(&text).render(1, labelled(cube(), 0, 1), &()).unwrap().record.warnings;
        let told = warnings.iter().filter(|text| text.contains("nothing in it moves")).count();
        assert_eq!(told, 1, "{velocity}: {warnings:?}");
    }
}

/// Stops at the first tile, and keeps what it hears.
struct Stopping(Interrupt, Mutex<Vec<String>>);

impl Observer for Stopping {
    fn tiles(&self, _done: usize, _of: usize) {
        self.0.request();
    }
    fn warning(&self, text: &str) {
        self.1.lock().unwrap().push(text.to_owned());
    }
}

#[test]
fn a_request_stops_one_frame_and_no_more() {
    let interrupt = Interrupt::default();
    let options = RenderOptions { interrupt: interrupt.clone(), ..options(1) };
    let text =
        scene("[camera]\neye = [0.4, -4, 0.9]\ntarget = [0, 0, 0]\nresolution = [64, 64]\nshutter = 0.5\n");
    let mut renderer = Renderer::parse(&text, Path::new("scene.toml"), options).unwrap();
    let stopping = Stopping(interrupt.clone(), Mutex::default());
    let mesh = || labelled(cube(), 0, 1);
    let error = renderer.render(1, mesh(), &stopping).unwrap_err();
    assert!(matches!(error, RenderError::Stopped { .. }), "{error}");
    assert!(stopping.1.lock().unwrap()[0].contains("no velocities"));
    renderer.render(2, mesh(), &()).unwrap();
    interrupt.request();
    assert!(renderer.render(3, mesh(), &()).is_err());
    renderer.render(3, mesh(), &()).unwrap();
}
