//! Bad frames, odd geometry and extreme settings: an error that says what to mend, or a finite picture; never a panic,
//! never half a picture, and never a word less about the other frames.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod small;

use std::time::{Duration, Instant};

use floe::driver::error::Blame;
use floe::driver::{FrameRecord, Job, RenderError, RenderOptions, RenderReport, Status};
use floe::mesh::{Interface, RawMesh, Region};
use glam::DVec3;
use small::{Folder, cube, cuboid, joined, labelled, ply, scene, shipped_frame};

/// Water with air around it.
fn water(mesh: RawMesh) -> RawMesh {
    labelled(mesh, 0, 1)
}

/// Renders one mesh.
fn render(tables: &str, mesh: &RawMesh) -> (Folder, RenderReport) {
    let folder = Folder::with_scene(&scene(tables));
    folder.frame(1, mesh);
    let report = folder.render(RenderOptions::default());
    (folder, report)
}

/// Renders one mesh, which must give a finite picture; its record and its pixels' red, row by row.
fn picture(tables: &str, mesh: &RawMesh) -> (FrameRecord, Vec<f32>) {
    let (folder, mut report) = render(tables, mesh);
    assert!(report.failures.is_empty(), "{:?}", report.failures);
    let record = report.frames.remove(0);
    assert_eq!((record.status, record.counters.non_finite), (Status::Complete, 0));
    (record, red(&folder, "out/frame_0001.exr"))
}

/// The red channel of a picture of which every channel is finite.
fn red(folder: &Folder, name: &str) -> Vec<f32> {
    let image = exr::prelude::read_all_flat_layers_from_file(folder.path(name)).unwrap();
    let channels = &image.layer_data[0].channel_data.list;
    for channel in channels {
        let finite = channel.sample_data.values_as_f32().all(f32::is_finite);
        assert!(finite || channel.name.eq("Z"), "{name} channel {}", channel.name);
    }
    channels.iter().find(|c| c.name.eq("R")).unwrap().sample_data.values_as_f32().collect()
}

#[test]
fn a_bad_frame_in_the_middle_is_named_and_leaves_the_others_alone() {
    let text = ply(&water(cube()));
    let binary = std::fs::read(shipped_frame(0)).unwrap();
    let count = |element: &str, count: &str| {
        let at = text.find(&format!("element {element} ")).unwrap();
        let end = at + text[at..].find('\n').unwrap();
        format!("{}element {element} {count}{}", &text[..at], &text[end..]).into_bytes()
    };
    let with_x = |value: f32| {
        let header = b"end_header\n";
        let vertices = binary.windows(header.len()).position(|bytes| bytes == header).unwrap() + header.len();
        // The second vertex, each having six numbers.
        let mut bytes = binary.clone();
        bytes[vertices + 24..][..4].copy_from_slice(&value.to_le_bytes());
        bytes
    };
    let bad: [(&str, Vec<u8>, Blame, &[&str]); 17] = [
        ("nothing", Vec::new(), Blame::Data, &["empty"]),
        ("no mesh", b"solid box\n".to_vec(), Blame::Data, &["ply"]),
        ("half a header", text.as_bytes()[..60].to_vec(), Blame::Data, &["end_header"]),
        ("half a text", text.as_bytes()[..text.len() * 3 / 4].to_vec(), Blame::Data, &["truncated"]),
        ("half of binary data", binary[..binary.len() / 2].to_vec(), Blame::Data, &["truncated"]),
        ("no last byte", binary[..binary.len() - 1].to_vec(), Blame::Data, &["truncated"]),
        ("NaN", text.replacen("-0.8", "nan", 1).into_bytes(), Blame::Data, &["line 12: ", "finite"]),
        ("infinity", text.replacen("-0.8", "inf", 1).into_bytes(), Blame::Data, &["line 12: ", "finite"]),
        ("NaN in binary data", with_x(f32::NAN), Blame::Data, &["vertex 1", "NaN", "finite"]),
        ("infinity in binary data", with_x(f32::NEG_INFINITY), Blame::Data, &["vertex 1", "inf", "finite"]),
        ("far out in binary data", with_x(1e30), Blame::Data, &["vertex 1", "e30 m", "frames.scale"]),
        ("far out", text.replacen("-0.8", "-1e300", 1).into_bytes(), Blame::Data, &["vertex 0", "1e300 m"]),
        ("an index too many", text.replace("3 0 2 3", "3 0 2 8").into_bytes(), Blame::Data, &["face 0", "8"]),
        (
            "a negative index",
            text.replace("3 0 2 3", "3 0 2 -1").into_bytes(),
            Blame::Data,
            &["face 0", "-1"],
        ),
        ("many vertices", count("vertex", "4000000000"), Blame::Data, &["4000000000"]),
        ("too many faces", count("face", "99999999999999999999"), Blame::Data, &["99999999999999999999"]),
        (
            "a label without a medium",
            ply(&labelled(cube(), 0, 7)).into_bytes(),
            Blame::Configuration,
            &["label 7", "[regions]", "scene.toml"],
        ),
    ];
    for (name, bytes, blame, words) in bad {
        let folder = Folder::with_scene(&scene(""));
        folder.frame(1, &water(cube())).frame(3, &water(cube())).write("frames/frame_0002.ply", bytes);
        let report = folder.render(RenderOptions { keep_going: true, ..RenderOptions::default() });
        let [(number, error)] = &report.failures[..] else { panic!("{name}: {:?}", report.failures) };
        let message = error.to_string();
        assert_eq!((number.to_string().as_str(), error.blame()), ("2", blame), "{name}: {message}");
        for word in ["frame_0002.ply"].iter().chain(words) {
            assert!(message.contains(word), "{name}: no \"{word}\" in: {message}");
        }
        let pictures: Vec<_> = folder.files().into_iter().filter(|f| f.starts_with("out/")).collect();
        let [one, three] =
            ["1", "3"].map(|n| [format!("out/frame_000{n}.exr"), format!("out/frame_000{n}.png")]);
        assert_eq!(pictures, [one.as_slice(), &three, &["out/ledger.jsonl".into()]].concat(), "{name}");
        let ledger = folder.ledger("out/ledger.jsonl");
        assert_eq!(ledger[1]["error"], message, "{name}");
    }
}

#[test]
fn without_triangles_there_is_the_sky_and_a_warning() {
    let (record, red) = picture("", &water(RawMesh::default()));
    assert!(red.iter().all(|&r| r == 0.6), "{red:?}");
    assert!(
        record.warnings[0].contains("frame_0001.ply: the mesh has no triangles"),
        "{:?}",
        record.warnings
    );
}

#[test]
fn inputs_beside_the_frames_are_missed_by_name() {
    let tables = [
        ("[sky]\nradiance = { image = \"clouds.exr\" }\n", "clouds.exr"),
        ("[[surfaces]]\nmesh = \"bottom.ply\"\nmaterial = { kind = \"diffuse\" }\n", "bottom.ply"),
    ];
    for (table, name) in tables {
        let folder = Folder::with_scene(&scene(table));
        folder.frame(1, &water(cube()));
        let error = Job::open(&folder.path("scene.toml")).unwrap_err();
        assert_eq!(error.blame(), Blame::Missing, "{error}");
        assert!(error.to_string().contains(name), "{error}");
        folder.write(name, "neither a picture nor a mesh");
        let error = Job::open(&folder.path("scene.toml")).unwrap_err();
        assert_eq!(error.blame(), Blame::Data, "{error}");
        assert!(error.to_string().contains(name), "{error}");
    }
}

#[test]
fn a_surface_that_is_missing_in_one_frame_fails_that_frame() {
    let table =
        "[[surfaces]]\nmesh = \"boat_####.ply\"\nmaterial = { kind = \"diffuse\", reflectance = 0.5 }\n";
    let folder = Folder::with_scene(&scene(table));
    folder.frame(1, &water(cube())).frame(2, &water(cube()));
    folder.write("boat_0002.ply", ply(&cuboid(DVec3::splat(-1.0), DVec3::splat(-0.9))));
    let report = folder.render(RenderOptions { keep_going: true, ..RenderOptions::default() });
    let [(_, error)] = &report.failures[..] else { panic!("{:?}", report.failures) };
    assert!(error.blame() == Blame::Missing && error.to_string().contains("boat_0001.ply"), "{error}");
    assert_eq!(report.frames[1].status, Status::Complete);
}

#[test]
fn a_domain_that_does_not_fit_says_so() {
    let table =
        "[domain]\nbox = [[-5, -5, -5], [5, 5, 5]]\nwalls = { sides = \"extend\", bottom = \"open\" }\n";
    let (record, _) = picture(table, &water(cube()));
    let text = record.warnings.join("\n");
    assert!(text.contains("no face lies on the sides") && text.contains("box is"), "{text}");
    for walls in ["{ sides = \"extend\", bottom = \"keep\" }", "{ bottom = \"extend\" }"] {
        let table = format!("[domain]\nbox = [[-0.8, -0.8, -0.8], [0.8, 0.8, 0.8]]\nwalls = {walls}\n");
        let folder = Folder::with_scene(&scene(&table));
        folder.frame(1, &water(cube()));
        let error = match Job::open(&folder.path("scene.toml")) {
            Err(error) => error,
            Ok(_) => folder.render(RenderOptions::default()).failures.remove(0).1,
        };
        assert_eq!(error.blame(), Blame::Configuration, "{error}");
        assert!(error.to_string().contains("bottom"), "{error}");
    }
}

#[test]
fn coordinates_beyond_single_precision_are_refused() {
    let (_, report) = render(
        "[frames]\npath = \"frames/frame_####.ply\"\nscale = 1e12\n",
        &water(cuboid(DVec3::splat(-1e9), DVec3::splat(1e9))),
    );
    let [(_, error)] = &report.failures[..] else { panic!("{:?}", report.failures) };
    assert!(error.to_string().contains("frames.scale"), "{error}");
}

/// A cube of which every face is split into 2 x 64 slivers, a thousandth of a millimetre wide at one end.
fn slivers() -> RawMesh {
    let mut mesh = RawMesh::default();
    for [a, b, c] in cube().triangles {
        let [a, b, c] = [a, b, c].map(|v| cube().positions[v as usize]);
        let first = mesh.positions.len() as u32;
        let along = (0..=32).map(|k| b.lerp(c, f64::from(k) / 32.0));
        mesh.positions.push(a);
        mesh.positions.extend(along);
        mesh.triangles.extend((1..=32).map(|k| [first, first + k, first + k + 1]));
    }
    mesh
}

#[test]
fn degenerate_geometry_gives_finite_pictures() {
    let triangle = RawMesh {
        positions: vec![DVec3::new(-1.0, 0.0, -1.0), DVec3::new(1.0, 0.0, -1.0), DVec3::new(0.0, 0.1, 1.0)],
        triangles: vec![[0, 1, 2]],
        ..RawMesh::default()
    };
    let flat = cuboid(DVec3::new(-0.8, -0.8, 0.0), DVec3::new(0.8, 0.8, 0.0));
    let thin = cuboid(DVec3::new(-0.8, -0.8, 0.0), DVec3::new(0.8, 0.8, 1e-7));
    let tiny = cuboid(DVec3::splat(-1e-20), DVec3::splat(1e-20));
    let point = cuboid(DVec3::ZERO, DVec3::ZERO);
    let around = cuboid(DVec3::splat(-1e6), DVec3::splat(1e6));
    let at_eye = cuboid(DVec3::new(0.4, -4.0, 0.9), DVec3::splat(1.0));
    let unused = RawMesh { positions: [cube().positions, vec![DVec3::splat(1e9)]].concat(), ..cube() };
    for (name, mesh) in [
        ("one triangle", triangle),
        ("slivers", slivers()),
        ("no volume", flat),
        ("thinner than single precision at its distance", thin),
        ("tiny", tiny),
        ("a point", point),
        ("a million metres", around),
        ("a corner in the camera", at_eye),
        ("a far vertex that nothing uses", unused),
    ] {
        println!("{name}");
        picture("", &water(mesh.clone()));
        // Without labels a sheet of no thickness is neither open nor closed, and may be refused.
        let (_, report) = render("", &mesh);
        let refused = |error: &RenderError| matches!(error, RenderError::Mismatches { .. });
        assert!(report.failures.iter().all(|(_, error)| refused(error)), "{name}: {:?}", report.failures);
        picture("[render]\nintegrator = \"ambient-occlusion\"\nsamples = 4\n", &mesh);
    }
}

#[test]
fn faces_that_are_there_twice_are_no_second_surface() {
    let once = picture("", &water(cube())).1;
    let mut twice = water(cube());
    twice.triangles.extend(cube().triangles);
    twice.interfaces.as_mut().unwrap().extend_from_within(..);
    let (record, red) = picture("", &twice);
    assert_eq!(red, once);
    assert!(
        record.warnings.join("\n").contains("12 triangles that lie exactly on others"),
        "{:?}",
        record.warnings
    );
}

/// Two boxes that touch, each with its own closed surface: where they touch, water borders on ice.
#[test]
fn coincident_opposite_faces_are_one_boundary() {
    let left = water(cuboid(DVec3::splat(-0.8), DVec3::new(0.0, 0.8, 0.8)));
    let right = labelled(cuboid(DVec3::new(0.0, -0.8, -0.8), DVec3::splat(0.8)), 0, 2);
    let (record, _) = picture("", &joined(left, &right));
    assert_eq!(record.counters.label_mismatches, 0);
    let between: usize = ["1|2", "2|1"].iter().filter_map(|pair| record.interfaces.get(*pair)).sum();
    assert_eq!((between, record.interfaces["0|1"], record.interfaces["0|2"]), (2, 10, 10));
}

/// In a clear cube of index 3 a ray that meets all faces at more than 19.5 degrees stays inside for ever.
#[test]
fn total_internal_reflection_for_ever_ends_in_bounded_time() {
    let tables = "[frames]\npath = \"frames/frame_####.ply\"\nnormals = \"flat\"\n\n[media.water]\nior = 3\n\n[camera]\neye = [0.1, 0.2, 0.05]\ntarget = [1, 1.1, 0.9]\nvertical_fov = 20\nresolution = [16, 9]\n";
    let start = Instant::now();
    let (record, _) = picture(tables, &water(cube()));
    // 576 paths; one that is not ended would be 65,536 interactions long, 40 million in all.
    let rays = record.counters.rays / record.samples;
    assert!(
        (500..5000).contains(&rays),
        "{rays} rays a path: such paths end after 1024 interactions and 50 more"
    );
    assert!(start.elapsed() < Duration::from_secs(60), "{:?}", start.elapsed());
}

#[test]
fn extreme_settings_give_finite_pictures() {
    let one_pixel = "[camera]\neye = [0.4, -4, 0.9]\ntarget = [0, 0, 0]\nresolution = [1, 1]\n";
    let ribbon = "[camera]\neye = [0.4, -4, 0.9]\ntarget = [0, 0, 0]\nresolution = [37, 1]\n";
    for (tables, pixels) in [
        ("[render]\nsamples = 4\nmax_depth = 1\n", 144),
        ("[render]\nsamples = 4\nsplit = 8\n", 144),
        ("[render]\nsamples = 4\nfilter = \"blackman-harris\"\n", 144),
        ("[render]\nsamples = 4\nseed = 9223372036854775807\n", 144),
        ("[media.water]\nior = 1.33\nabsorption = 1e30\n", 144),
        ("[media.water]\nior = 1.33\nscattering = 1e6\nabsorption = 1e6\n", 144),
        ("[sky]\nradiance = 1e30\n", 144),
        (one_pixel, 1),
        (ribbon, 37),
    ] {
        println!("{tables}");
        assert_eq!(picture(tables, &water(cube())).1.len(), pixels);
    }
}

#[test]
fn depth_1_cuts_paths_and_counts_them() {
    let (record, _) = picture("[render]\nsamples = 4\nmax_depth = 1\n", &water(cube()));
    assert!(record.counters.depth_limited > 0 && record.counters.cut == 0);
}

#[test]
fn one_sample_has_no_known_error() {
    let (record, _) = picture("[render]\nsamples = 1\n", &water(cube()));
    assert!(record.relative_error.is_none());
    let (record, _) = picture("[render]\nsamples = 2\n", &water(cube()));
    assert!(record.relative_error.is_some());
}

#[test]
fn an_error_that_hangs_on_few_samples_is_told() {
    let lava = "[media.water]\nabsorption = 8\nscattering = 20\nemission = 3\n[sky]\nradiance = 0\n";
    let (record, _) = picture(lava, &water(cube()));
    assert!(record.warnings.join("\n").contains("(fireflies): it is"), "{:?}", record.warnings);
    let (record, _) = picture("", &water(cube()));
    assert!(record.warnings.is_empty(), "{:?}", record.warnings);
}

#[test]
fn a_mesh_that_is_inside_out_is_mended_with_a_warning() {
    let mut turned = cube();
    turned.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    let (record, red) = picture("", &turned);
    assert!(record.warnings.join("\n").contains("point inwards"), "{:?}", record.warnings);
    assert_eq!(record.counters.label_mismatches, 0);
    let (record, expected) = picture("", &cube());
    assert!(record.warnings.is_empty(), "{:?}", record.warnings);
    // The same surface; the order of a triangle's corners may change the last bits of where it is hit.
    let apart = red.iter().zip(&expected).filter(|(a, b)| (*a - *b).abs() > 1e-3).count();
    assert!(apart <= expected.len() / 20, "{apart} of {} pixels differ", expected.len());
}

#[test]
fn an_open_mesh_warns_with_the_place() {
    let mut open = water(cube());
    open.triangles.truncate(10);
    open.interfaces.as_mut().unwrap().truncate(10);
    let (_, report) = render("", &open);
    let warnings = report.frames[0].warnings.join("\n");
    assert!(
        warnings.contains("frame_0001.ply: the surface is open: 4 edges") && warnings.contains("0.8"),
        "{warnings}"
    );
}

/// A cube that says water on one side and ice on the other: a path enters the one and leaves the other.
#[test]
fn labels_that_contradict_each_other_fail_the_frame_without_a_picture() {
    let mut mesh = water(cube());
    for interface in mesh.interfaces.as_mut().unwrap().iter_mut().take(6) {
        *interface = Interface { front: Region::OUTSIDE, back: Region(2) };
    }
    let (folder, report) = render("", &mesh);
    let [(_, error)] = &report.failures[..] else { panic!("{:?}", report.failures) };
    assert_eq!(error.blame(), Blame::Data);
    assert!(
        error.to_string().contains("frame_0001.ply") && error.to_string().contains("no picture"),
        "{error}"
    );
    assert!(
        report.frames[0].warnings.join("\n").contains("contradicts itself"),
        "{:?}",
        report.frames[0].warnings
    );
    assert_eq!(folder.files(), ["frames/frame_0001.ply", "out/ledger.jsonl", "scene.toml"]);
    assert!(folder.ledger("out/ledger.jsonl")[0]["label_mismatches"].as_u64().unwrap() > 8);
}
