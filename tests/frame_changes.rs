//! What one frame leaves to the next: a hierarchy that is refitted or not, surfaces that stand still, and no trace in the
//! pictures, the messages or their order.
#![allow(clippy::unwrap_used)]

mod small;

use std::collections::BTreeMap;
use std::sync::Mutex;

use floe::accel::{Hierarchy, REBUILD_ABOVE};
use floe::driver::{FrameRecord, Job, Observer, RenderOptions, RenderReport};
use floe::mesh::{Interface, RawMesh, Region, read};
use floe::sequence::{FrameNumber, FrameSelection};
use glam::DVec3;
use small::{Folder, cube, cuboid, joined, labelled, scene, shipped_frame, shipped_scene, without_marks};

use Hierarchy::{Built, Rebuilt, Refitted};

/// The triangles backwards, every third begun at its second corner, every third at its third.
fn reordered(mesh: &RawMesh) -> RawMesh {
    let mut turned = mesh.clone();
    turned.triangles.iter_mut().enumerate().for_each(|(i, triangle)| triangle.rotate_left(i % 3));
    turned.triangles.reverse();
    turned.interfaces.iter_mut().for_each(|interfaces| interfaces.reverse());
    turned
}

/// A little wave in all vertices inside the shipped box.
fn moved(mesh: &RawMesh, time: f64) -> RawMesh {
    let mut mesh = mesh.clone();
    for p in mesh.positions.iter_mut().filter(|p| p.abs().max_element() < 0.79) {
        p.z += 0.01 * (time * (1.0 + p.x * p.y)).sin();
    }
    mesh
}

/// Frames 0, 1, 2, ... of a scene.
fn sequence(scene: &str, meshes: &[RawMesh]) -> Folder {
    let folder = Folder::with_scene(scene);
    for (number, mesh) in (0..).zip(meshes) {
        folder.frame(number, mesh);
    }
    folder
}

fn options(frames: Option<&str>, threads: usize) -> RenderOptions {
    let frames = frames.map(|range| FrameSelection::parse(range).unwrap());
    RenderOptions { frames, threads: Some(threads), keep_going: true, ..RenderOptions::default() }
}

fn pictures(folder: &Folder) -> BTreeMap<String, Vec<u8>> {
    let names = folder.files().into_iter().filter(|name| name.ends_with(".exr"));
    names.map(|name| (name.clone(), folder.read(&name))).collect()
}

/// Renders all frames in one run, and each in a run of its own: the same bytes, on one thread and on two. Returns what
/// became of the hierarchies.
fn decisions(folder: &Folder) -> Vec<Hierarchy> {
    let report = folder.render(options(None, 2));
    assert!(report.failures.is_empty(), "{:?}", report.failures);
    let together = pictures(folder);
    let made: Vec<_> = report.frames.iter().map(|record| record.hierarchy.unwrap()).collect();
    let again = folder.render(options(None, 1));
    assert_eq!(pictures(folder), together, "one thread");
    assert_eq!(again.frames.iter().map(|record| record.hierarchy.unwrap()).collect::<Vec<_>>(), made);
    for record in &report.frames {
        let alone = folder.render(options(Some(&record.frame), 2));
        assert_eq!(alone.frames[0].hierarchy, Some(Built));
    }
    assert_eq!(pictures(folder), together, "alone");
    made
}

#[test]
fn the_same_triangles_are_refitted_whatever_their_order() {
    let mesh = read(&shipped_frame(0)).unwrap();
    let mut corners = moved(&mesh, 1.0);
    corners.triangles.iter_mut().for_each(|triangle| triangle.rotate_left(1));
    let order = reordered(&moved(&mesh, 2.0));
    let frames = [mesh.clone(), corners, order.clone(), reordered(&moved(&order, 3.0)), moved(&mesh, 3.0)];
    let folder = sequence(&shipped_scene(2), &frames);
    assert_eq!(decisions(&folder), [Built, Refitted, Refitted, Refitted, Refitted]);
    for line in &folder.ledger("out/ledger.jsonl")[1..5] {
        assert_eq!((&line["hierarchy"], &line["refitted"]), (&"refitted".into(), &true.into()), "{line}");
        let ratio = line["cost_ratio"].as_f64().unwrap();
        assert!((0.9..1.1).contains(&ratio), "a little wave: {ratio}");
        let [bytes, each] =
            ["accel_bytes", "accel_bytes_per_triangle"].map(|key| line[key].as_f64().unwrap());
        assert!((each * line["triangles"].as_f64().unwrap() - bytes).abs() < 1e-6 * bytes);
    }
}

#[test]
fn other_triangles_are_built() {
    let mesh = labelled(cube(), 0, 1);
    let mut flipped = mesh.clone();
    flipped.triangles[5].swap(1, 2);
    flipped.interfaces.as_mut().unwrap()[5] = Interface { front: Region(1), back: Region(0) };
    let mut fewer = mesh.clone();
    fewer.triangles.truncate(10);
    fewer.interfaces.as_mut().unwrap().truncate(10);
    let tables = "[render]\nintegrator = \"ambient-occlusion\"\nsamples = 4\n";
    let folder = sequence(&scene(tables), &[mesh.clone(), flipped, mesh.clone(), fewer, mesh]);
    assert_eq!(decisions(&folder), [Built; 5]);
    let line = &folder.ledger("out/ledger.jsonl")[1];
    assert_eq!((&line["hierarchy"], &line["refitted"]), (&"built".into(), &false.into()));
    assert!(line["cost_ratio"].is_null());
}

#[test]
fn other_labels_on_the_same_triangles_are_another_picture() {
    let [water, ice] = [1, 2].map(|label| labelled(cube(), 0, label));
    let folder = sequence(&scene(""), &[water.clone(), ice, reordered(&water)]);
    assert_eq!(decisions(&folder), [Built, Refitted, Refitted]);
    let pictures = pictures(&folder);
    assert_ne!(pictures["out/frame_0000.exr"], pictures["out/frame_0001.exr"], "ice scatters");
}

#[test]
fn a_tree_that_fits_no_longer_is_built_again() {
    let mesh = read(&shipped_frame(0)).unwrap();
    let mut scrambled = mesh.clone();
    let count = mesh.positions.len();
    // 101 is prime and the number of vertices no multiple of it: each goes where another was.
    assert_ne!(count % 101, 0);
    (0..count).for_each(|i| scrambled.positions[i] = mesh.positions[i * 101 % count]);
    let tables = "[render]\nintegrator = \"ambient-occlusion\"\nsamples = 2\n";
    let folder = sequence(&scene(tables), &[mesh.clone(), scrambled.clone(), reordered(&scrambled), mesh]);
    let made = decisions(&folder);
    assert_eq!(made[..3], [Built, Rebuilt, Refitted]);
    let ledger = folder.ledger("out/ledger.jsonl");
    let ratio = |line: usize| ledger[line]["cost_ratio"].as_f64().unwrap();
    assert!(ratio(1) > f64::from(REBUILD_ABOVE), "{}", ratio(1));
    assert_eq!((ratio(2), &ledger[1]["refitted"]), (1.0, &false.into()));
}

/// Everything that an observer hears but tiles, in order.
#[derive(Default)]
struct Heard(Mutex<Vec<String>>);

impl Heard {
    fn add(&self, text: String) {
        self.0.lock().unwrap().push(text);
    }
}

impl Observer for Heard {
    fn frame(&self, number: FrameNumber) {
        self.add(format!("frame {number}"));
    }

    fn warning(&self, text: &str) {
        let name = text.split(": ").next().unwrap().rsplit('/').next().unwrap();
        self.add(format!("warning {name}"));
    }

    fn finished(&self, record: &FrameRecord) {
        let what = if record.error.is_some() { "failed" } else { "finished" };
        self.add(format!("{what} {}", record.frame));
    }
}

/// Cubes, of which frame 2 warns of a hole, and `bad` is no mesh.
fn with_a_bad_frame(bad: u32) -> Folder {
    let mesh = labelled(cube(), 0, 1);
    let mut open = mesh.clone();
    open.triangles.truncate(10);
    open.interfaces.as_mut().unwrap().truncate(10);
    let folder = sequence(&scene(""), &[mesh.clone(), mesh.clone(), open, mesh]);
    folder.write(&format!("frames/frame_{bad:04}.ply"), "no mesh");
    folder
}

fn watched(folder: &Folder, keep_going: bool) -> (RenderReport, Vec<String>) {
    let heard = Heard::default();
    let options = RenderOptions { keep_going, threads: Some(2), ..RenderOptions::default() };
    let report = folder.render_watched(options, &heard);
    (report, heard.0.into_inner().unwrap())
}

#[test]
fn a_bad_frame_is_told_in_its_turn() {
    let folder = with_a_bad_frame(1);
    let (report, heard) = watched(&folder, true);
    assert_eq!(
        heard,
        [
            "frame 0",
            "finished 0",
            "frame 1",
            "failed 1",
            "frame 2",
            "warning frame_0002.ply",
            "finished 2",
            "frame 3",
            "finished 3"
        ]
    );
    assert_eq!((report.frames.len(), report.failures.len(), report.skipped), (4, 1, 0));
    let ledger = folder.ledger("out/ledger.jsonl");
    let told: Vec<_> = ledger.iter().map(|line| (line["frame"].as_str(), line["status"].as_str())).collect();
    let (complete, failed) = (Some("complete"), Some("failed"));
    assert_eq!(
        told,
        [(Some("0"), complete), (Some("1"), failed), (Some("2"), complete), (Some("3"), complete)]
    );
    assert!(ledger[1]["hierarchy"].is_null());

    let folder = with_a_bad_frame(1);
    let (report, heard) = watched(&folder, false);
    assert_eq!(heard, ["frame 0", "finished 0", "frame 1", "failed 1"]);
    assert_eq!((report.frames.len(), report.failures.len(), report.skipped), (2, 1, 2));
    assert_eq!(folder.ledger("out/ledger.jsonl").len(), 2);
}

/// Frame 0 cannot be rendered while frame 1, which is no mesh, is made ready.
#[test]
fn what_comes_after_a_failure_is_not_told() {
    let mut contradiction = labelled(cube(), 0, 1);
    for interface in contradiction.interfaces.as_mut().unwrap().iter_mut().take(6) {
        interface.back = Region(2);
    }
    let folder = with_a_bad_frame(1);
    folder.frame(0, &contradiction);
    let (report, heard) = watched(&folder, false);
    assert_eq!(heard, ["frame 0", "warning frame_0000.ply", "failed 0"]);
    assert_eq!((report.failures.len(), report.skipped), (1, 3));
    let (report, heard) = watched(&folder, true);
    assert_eq!(heard[..5], ["frame 0", "warning frame_0000.ply", "failed 0", "frame 1", "failed 1"]);
    assert_eq!((report.failures.len(), report.skipped), (2, 0));
}

/// Mends frame 2 as soon as frame 0 is done.
struct Mender<'a>(&'a Folder, RawMesh);

impl Observer for Mender<'_> {
    fn finished(&self, record: &FrameRecord) {
        if record.frame == "0" {
            self.0.frame(2, &self.1);
        }
    }
}

#[test]
fn no_frame_is_read_while_the_one_before_the_last_is_rendered() {
    let folder = with_a_bad_frame(2);
    let report = folder.render_watched(options(None, 2), &Mender(&folder, labelled(cube(), 0, 1)));
    assert!(report.failures.is_empty(), "{:?}", report.failures);
    assert_eq!(report.frames.len(), 4);
}

#[test]
fn after_a_bad_frame_the_hierarchy_before_it_is_refitted() {
    let mesh = labelled(cube(), 0, 1);
    let folder = sequence(&scene(""), &[mesh.clone(), mesh.clone(), reordered(&mesh)]);
    folder.write("frames/frame_0001.ply", "no mesh");
    let report = folder.render(options(None, 2));
    let made: Vec<_> = report.frames.iter().map(|record| record.hierarchy).collect();
    assert_eq!(made, [Some(Built), None, Some(Refitted)]);
}

/// A scene with a floor, a lamp, a block of glass and one of the simulation's water, each from a mesh of the given names.
fn furnished(place: &str) -> String {
    let surface = |name: &str, rest: &str| format!("[[surfaces]]\nmesh = \"{name}{place}.ply\"\n{rest}\n");
    let media = "[media.glass]\nior = 1.5\n";
    [
        scene("[sky]\nradiance = 0.2\n"),
        media.into(),
        surface("floor", "material = { kind = \"diffuse\", reflectance = 0.5 }"),
        surface("glass", "front = \"air\"\nback = \"glass\"\nmaterial = { kind = \"dielectric\" }"),
        surface("lamp", "normals = \"flat\"\nmaterial = { kind = \"emitter\", radiance = 20 }"),
        surface("block", "front = \"air\"\nback = \"water\"\nmaterial = { kind = \"dielectric\" }"),
    ]
    .concat()
}

fn block(low: [f64; 3], high: [f64; 3]) -> RawMesh {
    cuboid(low.into(), high.into())
}

/// Two frames of water and ice between furniture, which stands still or has the same mesh for each frame.
fn furnished_sequence(still: bool) -> Folder {
    let water = labelled(block([-0.5, -0.5, -0.6], [0.1, 0.5, 0.0]), 0, 1);
    let ice = labelled(block([-0.4, -0.4, 0.1], [0.0, 0.4, 0.5]), 0, 2);
    let mesh = joined(water, &ice);
    let mut later = reordered(&mesh);
    later.positions.iter_mut().for_each(|p| *p += DVec3::new(0.02, 0.01, 0.03));
    let folder = sequence(&furnished(if still { "" } else { "_####" }), &[mesh, later]);
    let mut glass = block([0.2, -0.5, -0.6], [0.7, 0.2, 0.2]);
    glass.triangles.truncate(11);
    let furniture = [
        ("floor", block([-2.0, -2.0, -0.8], [2.0, 2.0, -0.7])),
        ("glass", glass),
        ("lamp", block([-0.2, -0.2, 0.9], [0.3, 0.3, 1.0])),
        ("block", block([0.3, 0.3, -0.6], [0.8, 0.8, -0.2])),
    ];
    for (name, mesh) in &furniture {
        for place in if still { &[""][..] } else { &["_0000", "_0001"] } {
            folder.write(&format!("{name}{place}.ply"), small::ply(mesh));
        }
    }
    folder
}

#[test]
fn still_surfaces_are_the_same_picture_as_surfaces_of_each_frame() {
    let still = furnished_sequence(true);
    assert_eq!(decisions(&still), [Built, Refitted]);
    let each = furnished_sequence(false);
    assert_eq!(decisions(&each), [Built, Refitted]);
    let drawn = |folder| pictures(folder).into_iter().map(|(name, bytes)| (name, without_marks(bytes)));
    assert!(drawn(&still).eq(drawn(&each)));
    let ledger = still.ledger("out/ledger.jsonl");
    assert_eq!(ledger[0]["triangles"], 12 * 3 + 11 + 24);
    for line in &ledger {
        let warnings = line["warnings"].as_array().unwrap();
        let of_glass = |warning: &&serde_json::Value| warning.as_str().unwrap().contains("glass.ply");
        let is_open = warnings.iter().filter(of_glass).count() == 1;
        assert!(is_open, "the glass is open, in every frame: {warnings:?}");
    }
}

#[test]
fn still_surfaces_come_first_and_are_read_once() {
    let folder = furnished_sequence(true);
    let job = Job::open(&folder.path("scene.toml")).unwrap();
    std::fs::remove_file(folder.path("floor.ply")).unwrap();
    let frames = [(0, None), (1, None)].map(|(number, mesh)| {
        let number = FrameNumber::from_integer(number).unwrap();
        job.world.assemble(number, mesh, None).unwrap().frame
    });
    let [a, b] = frames.map(|frame| frame.geometry);
    assert_eq!((a.triangles.len(), &a.triangles), (47, &b.triangles));
    let mesh = read(&folder.path("frames/frame_0000.ply")).unwrap();
    let mesh = Some(floe::scene::assembly::FrameMesh { path: "frame_0000.ply".into(), mesh });
    let full = job.world.assemble(FrameNumber::default(), mesh, None).unwrap().frame.geometry;
    assert_eq!(full.triangles[..47], a.triangles);
    assert_eq!(full.positions[..a.positions.len()], a.positions);
    assert_eq!(full.surfaces[..47], a.surfaces);
}
