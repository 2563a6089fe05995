//! Mesh files: good ones of every format, a corpus of bad ones, and what chance makes of both.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::fs;
use std::panic;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use floe::mesh::canonical::canonical;
use floe::mesh::topology::topology;
use floe::mesh::{
    FORMATS, Format, MeshError, MeshWarning, RawMesh, Region, VelocityName, prepare, read, read_bytes,
    read_with,
};
use glam::DVec3;
use proptest::prelude::*;

/// The files of a folder and of the folders in it, in the order of their names.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    for entry in entries {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn data(folder: &str) -> Vec<PathBuf> {
    files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(folder))
}

/// Every good file holds the unit cube; those without labels get the same ones from `prepare`.
#[test]
fn every_format_gives_the_same_cube() {
    let paths = data("meshes");
    let expected =
        read(&paths.iter().find(|path| path.ends_with("cube_little.ply")).unwrap().clone()).unwrap();
    let expected = canonical(&expected);
    assert_eq!((expected.positions.len(), expected.triangles.len()), (8, 12));
    for path in &paths {
        let mesh = read(path).unwrap_or_else(|error| panic!("{error}"));
        let (mesh, warnings) = prepare(mesh, Region(1), path).unwrap();
        assert!(warnings.iter().all(|w| matches!(w, MeshWarning::Welded { .. })), "{}", path.display());
        assert_eq!(canonical(&mesh), expected, "{}", path.display());
    }
    for format in FORMATS {
        assert!(paths.iter().any(|path| Format::of(path) == Some(format)), "no example of {format:?}");
    }
}

#[test]
fn normals_are_read_where_every_corner_has_one() {
    for path in data("meshes") {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let mesh = read(&path).unwrap();
        assert_eq!(mesh.normals.is_some(), name.starts_with("cube_normals"), "{name}");
        let Some(normals) = mesh.normals else { continue };
        let corners = normals.corners.as_ref().unwrap_or(&mesh.triangles);
        for (triangle, corners) in mesh.triangles.iter().zip(corners) {
            for (&vertex, &normal) in triangle.iter().zip(corners) {
                // The cube's corner normals point along its diagonals; files have six digits.
                let diagonal = (2.0 * mesh.positions[vertex as usize] - 1.0).normalize().as_vec3();
                assert!((normals.values[normal as usize] - diagonal).length() < 1e-5, "{name}");
            }
        }
    }
}

#[test]
fn malformed_files_are_refused_with_help() {
    let paths = data("malformed");
    assert!(paths.len() >= 40, "the corpus has {} files", paths.len());
    for path in paths {
        let started = Instant::now();
        let result = panic::catch_unwind(|| read(&path));
        let Ok(result) = result else { panic!("{}: panicked", path.display()) };
        let Err(error) = result else { panic!("{}: was accepted", path.display()) };
        let message = error.to_string();
        let name = path.file_name().unwrap().to_string_lossy();
        assert!(message.contains(&*name), "no file name: {message}");
        assert!(message.contains("; ") && message.len() > path.as_os_str().len() + 30, "no help: {message}");
        assert!(
            !message.contains('\n') && message.len() < path.as_os_str().len() + 300,
            "too long: {message}"
        );
        assert!(error.is_bad_data(), "{message}");
        // Reading takes microseconds; a reader that believes a count of 10^12 takes hours.
        assert!(started.elapsed() < Duration::from_secs(2), "slow: {message}");
    }
}

#[test]
fn messages_name_the_place() {
    let message = |name: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/malformed").join(name);
        read(&path).unwrap_err().to_string()
    };
    for (name, place) in [
        ("vertices_cut.ply", "vertex 4: "),
        ("faces_cut.ply", "face 11: "),
        ("faces_cut_ascii.ply", "face 7: "),
        ("nan.ply", "vertex 3: "),
        ("nan_ascii.ply", "line 14: "),
        ("index_8.ply", "face 0: vertex index 8"),
        ("index_9.obj", "line 9: index 9"),
        ("nan.obj", "line 9: "),
        ("word.obj", "line 9: "),
        ("label_missing.dsc", "line 10: "),
        ("three_share_a_face.dsc", "lines 9, 10, 11"),
        ("repeated.dsc", "line 11: the tetrahedron of line 9"),
        ("points_2e9.vtk", "point 20: the file ends early: 2000000000 are declared"),
        ("points_170e6_binary.vtk", "point 8: the file ends early: 170000000 are declared"),
        ("word.vtk", "line 6: 'one' is not a number"),
        ("nan.vtk", "point 7: the coordinates [1, 1, NaN]"),
        ("index_8.vtk", "polygon 0: vertex index 8"),
        ("section_binary.vtk", "byte 172: 'polygns' where a section begins"),
        ("tetrahedra.vtk", "cell 0: a cell of type 10 (tetrahedron)"),
        ("tetrahedra.vtk", "extract the surface"),
        ("label_fraction.vtk", "cell 2: label 0.5"),
        ("offsets_fall.vtk", "offset 2: 3, behind 4"),
        ("points_2e9.vtp", "line 5: array 'Points': 24 numbers, but 6000000000 are declared"),
        ("inline_2e9.vtp", "line 5: array 'Points': 1999999996 bytes are announced"),
        ("zlib_total_2e9.vtp", "line 5: array 'Points': compressed bytes hold 1999999992, more than 671"),
        ("appended_offset.vtp", "line 5: array 'Points': offset 5000, but"),
        ("tag_mismatch.vtp", "line 6: no XML"),
        ("two_pieces.vtp", "line 11: a second piece"),
        ("word.stl", "line 6: 'up' is not a coordinate"),
        ("binary_2e9.stl", "the file has 984 bytes, a binary one of 40000000 triangles has 2000000084"),
        ("nan_binary.stl", "triangle 0: "),
        ("vertices_2e9.bobj", "vertex 9: the file ends early: 166666666 are declared"),
        ("index_8.bobj", "triangle 0: vertex index 8"),
    ] {
        assert!(message(name).contains(place), "{place:?} is not in: {}", message(name));
    }
}

#[test]
fn names_without_a_format_are_refused() {
    let error = read(Path::new("tests/data/meshes/cube.vtu")).unwrap_err();
    assert!(matches!(error, MeshError::Unsupported { .. }));
    assert!(error.to_string().contains(".ply"), "{error}");
}

/// All good files, loaded once for the random tests.
fn corpus() -> Vec<(PathBuf, Format, Vec<u8>)> {
    let load = |path: PathBuf| {
        let (format, bytes) = (Format::of(&path).unwrap(), fs::read(&path).unwrap());
        (path, format, bytes)
    };
    data("meshes").into_iter().map(load).collect()
}

/// Whatever is read must keep what the type promises, and be taken by `prepare`.
fn check(bytes: &[u8], format: Format, path: &Path) {
    if let Ok(mesh) = read_bytes(bytes, format, &VelocityName::Known, path) {
        assert!(mesh.positions.iter().all(|position| position.is_finite()));
        assert!(mesh.triangles.iter().flatten().all(|&index| (index as usize) < mesh.positions.len()));
        let (mesh, _) = prepare(mesh, Region(1), path).unwrap();
        let interfaces = mesh.interfaces.as_ref().unwrap();
        assert_eq!(interfaces.len(), mesh.triangles.len());
        assert!(interfaces.iter().all(|interface| interface.front != interface.back));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..Default::default() })]

    #[test]
    fn truncated_files_never_panic(file in 0..1000_usize, cut in 0.0..1.0) {
        thread_local!(static CORPUS: Vec<(PathBuf, Format, Vec<u8>)> = corpus());
        CORPUS.with(|corpus| {
            let (path, format, bytes) = &corpus[file % corpus.len()];
            check(&bytes[..(cut * bytes.len() as f64) as usize], *format, path);
        });
    }

    #[test]
    fn flipped_bytes_never_panic(
        file in 0..1000_usize,
        flips in prop::collection::vec((0.0..1.0, any::<u8>()), 1..6),
    ) {
        thread_local!(static CORPUS: Vec<(PathBuf, Format, Vec<u8>)> = corpus());
        CORPUS.with(|corpus| {
            let (path, format, bytes) = &corpus[file % corpus.len()];
            let mut bytes = bytes.clone();
            for (at, value) in flips {
                let at = (at * bytes.len() as f64) as usize;
                bytes[at] = value;
            }
            check(&bytes, *format, path);
        });
    }
}

/// How many triangles there are between each two labels.
fn by_labels(mesh: &RawMesh) -> BTreeMap<(i32, i32), usize> {
    let mut counts = BTreeMap::new();
    for interface in mesh.interfaces.iter().flatten() {
        *counts.entry((interface.front.0, interface.back.0)).or_insert(0) += 1;
    }
    counts
}

/// Area, volume and bounds.
fn measures(mesh: &RawMesh) -> ([f64; 2], [DVec3; 2]) {
    let (mut area, mut volume) = (0.0, 0.0);
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|index| mesh.positions[index as usize]);
        area += 0.5 * (b - a).cross(c - a).length();
        volume += a.dot(b.cross(c)) / 6.0;
        (min, max) = (min.min(a).min(b).min(c), max.max(a).max(b).max(c));
    }
    ([area, volume], [min, max])
}

/// The greatest speed, in units per second.
fn fastest(mesh: &RawMesh) -> Option<f32> {
    let speeds = mesh.velocities.as_ref()?.iter().map(|velocity| velocity.length());
    Some(speeds.fold(0.0, f32::max))
}

/// Reads a whole folder of meshes and prints what is in them.
#[test]
#[ignore = "reads the folder that the variable FLOE_MESHES names"]
fn every_mesh_of_a_folder_reads() {
    let folder = std::env::var_os("FLOE_MESHES").expect("set FLOE_MESHES to a folder of meshes");
    let mut failed = 0;
    for path in files(Path::new(&folder)).iter().filter(|path| Format::of(path).is_some()) {
        let started = Instant::now();
        let mesh = read_with(path, &VelocityName::Known);
        let read_time = started.elapsed();
        let result = mesh.and_then(|mesh| prepare(mesh, Region(1), path));
        let prepare_time = started.elapsed() - read_time;
        match result {
            Ok((mesh, warnings)) => {
                let report = topology(&mesh);
                let ([area, volume], [min, max]) = measures(&mesh);
                println!(
                    "{}: {} vertices, {} triangles {:?}, area {:.7e}, volume {:.7e}, bounds {} to {}, velocities up to {:?}, open {}, inconsistent {}, non-manifold {}, components {}, read in {:.1?}, prepared in {:.1?}",
                    path.display(),
                    mesh.positions.len(),
                    mesh.triangles.len(),
                    by_labels(&mesh),
                    area,
                    volume,
                    min,
                    max,
                    fastest(&mesh),
                    report.open_edges,
                    report.inconsistent_edges,
                    report.non_manifold_edges,
                    report.components,
                    read_time,
                    prepare_time,
                );
                for warning in warnings {
                    println!("    {warning}");
                }
            }
            Err(error) => {
                failed += 1;
                println!("{error}");
            }
        }
    }
    assert_eq!(failed, 0, "files that did not read");
}
