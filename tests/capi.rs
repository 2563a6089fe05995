//! The library for C: what the README says builds, the example draws, and C sees what Rust does.
//!
//! A library of its own is built, as the README tells, which takes a minute the first time. Without gcc nothing is tested.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod small;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

use floe::driver::{RenderOptions, Renderer};
use floe::glam::{DVec3, Vec3};
use floe::mesh::RawMesh;
use small::{Folder, labelled};

const README: &str = include_str!("../README.md");

const SCENE: &str = "[regions]\n1 = 'water'\n[media.water]\nior = 1.33\nabsorption = 0.5\n[sky]\nradiance = 1\n\
                     [camera]\neye = [0.4, -4, 0.9]\ntarget = [0, 0, 0]\nresolution = [24, 16]\nshutter = 0.5\n";

/// The folder of the shared library; `None` where there is no gcc.
static LIBRARY: LazyLock<Option<PathBuf>> = LazyLock::new(|| {
    if Command::new("gcc").arg("--version").output().is_err() {
        return None;
    }
    let line = README.lines().find(|line| line.starts_with("cargo rustc ")).unwrap();
    let arguments = line.split('#').next().unwrap().split_whitespace().skip(1);
    succeeded(Command::new(env!("CARGO")).args(arguments));
    Some(Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("release"))
});

fn succeeded(command: &mut Command) -> Output {
    let output = command.current_dir(env!("CARGO_MANIFEST_DIR")).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {}\n{said}", output.status);
    output
}

/// A program of one file; `None` where there is no gcc.
fn built(source: &str, folder: &Folder) -> Option<PathBuf> {
    let Some(library) = LIBRARY.as_deref() else {
        println!("there is no gcc: nothing is tested");
        return None;
    };
    let program = folder.path("program");
    let mut gcc = Command::new("gcc");
    gcc.args(["-std=c11", "-O1", "-Wall", "-Wextra", "-Werror", "-Iinclude", source, "-o"]).arg(&program);
    gcc.arg("-L").arg(library).args(["-lfloe", "-lm", "-pthread"]);
    gcc.arg(format!("-Wl,-rpath,{}", library.display()));
    succeeded(&mut gcc);
    Some(program)
}

/// The box of `check.c`.
fn growing(frame: u32) -> RawMesh {
    let size = DVec3::splat(0.25 + f64::from(frame) / 8.0);
    let mut mesh = labelled(small::cuboid(-size, size), 0, 1);
    mesh.triangles = [
        [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4]],
        [[2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]],
    ]
    .concat();
    mesh.velocities = Some(mesh.positions.iter().map(|p| p.as_vec3().signum()).collect::<Vec<Vec3>>());
    mesh
}

#[test]
#[ignore = "builds the library once more, which takes a minute"]
fn c_has_the_pixels_of_rust_and_its_errors_have_words() {
    let folder = Folder::new();
    let Some(check) = built("tests/capi/check.c", &folder) else { return };
    succeeded(Command::new(check).arg(SCENE).arg(folder.path("")));
    let mut renderer = Renderer::parse(SCENE, Path::new("scene"), RenderOptions::default()).unwrap();
    let mut expected = Vec::new();
    for frame in 3..=4 {
        let rendered = renderer.render(frame, growing(frame), &()).unwrap();
        expected.extend(rendered.rgba().flatten().flat_map(f32::to_ne_bytes));
    }
    for scene in 0..2 {
        assert!(folder.read(&format!("pixels_{scene}")) == expected, "the pixels of scene {scene}");
    }
    assert!(folder.files().iter().any(|name| name == "picture.exr"), "{:?}", folder.files());
    assert_eq!(folder.leftovers(), Vec::<String>::new());
}

/// Of what C hands over nothing is read that is not there, and what scenes had is free in the end.
#[test]
#[ignore = "builds the library once more, which takes a minute"]
fn valgrind_finds_nothing() {
    let folder = Folder::new();
    let Some(check) = built("tests/capi/check.c", &folder) else { return };
    if Command::new("valgrind").arg("--version").output().is_err() {
        return println!("there is no valgrind: nothing is tested");
    }
    let mut valgrind = Command::new("valgrind");
    valgrind.args(["--error-exitcode=9", "--leak-check=full"]);
    valgrind.args(["--show-leak-kinds=definite", "--errors-for-leak-kinds=definite"]);
    succeeded(valgrind.arg(check).arg(SCENE).arg(folder.path("")));
}

#[test]
#[ignore = "builds the library once more, which takes a minute"]
fn the_example_in_c_draws_a_surface_that_moves() {
    let folder = Folder::new();
    let Some(example) = built("examples/c/animated_surface.c", &folder) else { return };
    succeeded(Command::new(example).arg(folder.path("out")).args(["2", "16"]));
    let pictures = ["out/frame_0001.png", "out/frame_0002.png"].map(|name| folder.read(name));
    assert!(pictures[0].starts_with(b"\x89PNG") && pictures[0] != pictures[1]);
}
