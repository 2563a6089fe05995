//! Meshes far from zero, as in the coordinates of a survey.
//!
//! Positions are taken relative to a point near the eye in double precision, so an offset costs nothing; unless the file
//! holds numbers of single precision, which has to be told.

use std::fmt::Write as _;

use glam::DVec3;

use super::bodies::{LABELS, alike, gridded, told};
use super::shapes::{Shape, sphere};
use super::{Case, Group, Measurement, Picture, Scene};
use crate::study::StudyError;

/// The group.
pub(super) const GROUP: Group = Group {
    name: "offsets",
    parameter: "metres between zero and the mesh",
    about: "A mesh far from zero, from text and from binary files.",
    cases,
};

/// Makes the contents of a mesh file.
type Write = fn(&Shape) -> Vec<u8>;

/// Mesh files in double precision.
const FORMATS: [(&str, Write); 3] = [
    ("body.ply", |shape| shape.ply().into_bytes()),
    ("body.obj", |shape| obj(shape).into_bytes()),
    ("binary.ply", |shape| binary_ply(shape, "double", |x| x.to_le_bytes().to_vec())),
];

fn cases() -> Vec<Case> {
    let pictures = FORMATS.iter().flat_map(|&(name, write)| {
        [1e3, 1e5, 1e7].map(|offset| {
            let case = Case::new(&GROUP, format!("the same picture, {name}"), offset, move || {
                same(name, write, offset)
            });
            if offset == 1e7 { case.quick() } else { case }
        })
    });
    let warnings = [0.0, 1e3, 1e5, 1e6, 1e7].map(|offset| {
        Case::new(&GROUP, "a binary float file is told to have lost its detail", offset, move || lost(offset))
            .quick()
    });
    let frames = [1e3, 1e7].map(|offset| {
        Case::new(&GROUP, "the same picture, frames with labels", offset, move || labelled(offset)).quick()
    });
    pictures.chain(frames).chain(warnings).collect()
}

/// In a direction that no axis has.
fn at(offset: f64) -> DVec3 {
    DVec3::new(0.05, 1.0, 0.3) * offset
}

fn body(offset: f64) -> Shape {
    moved(&gridded(DVec3::splat(-0.7), DVec3::splat(0.6), &[0.0, 0.3, 1.0]).askew(), offset)
}

fn moved(shape: &Shape, offset: f64) -> Shape {
    let positions = shape.positions.iter().map(|&p| p + at(offset)).collect();
    Shape { positions, triangles: shape.triangles.clone() }
}

fn camera(offset: f64) -> String {
    let [eye, target] = [DVec3::new(0.7, -4.0, 1.5), DVec3::ZERO].map(|p| (p + at(offset)).to_array());
    format!(
        "[media.water]\nior = 1.33\nabsorption = [0.8, 0.4, 0.2]\nscattering = 1\n[sky]\nradiance = [0.5, 0.6, 0.7]\n\
         [sun]\ndirection = [0.4, 0.2, 0.9]\nirradiance = 1\nangular_diameter = 10\n\
         [camera]\neye = {eye:?}\ntarget = {target:?}\nvertical_fov = 30\nresolution = [24, 18]\n\
         [render]\nsamples = 16\n"
    )
}

fn same(name: &str, write: Write, offset: f64) -> Result<Measurement, StudyError> {
    let picture = |offset| -> Result<Picture, StudyError> {
        let scene = Scene::new().file(name, write(&body(offset)));
        scene.render(&format!(
            "[[surfaces]]\nmesh = \"{name}\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"water\"\n\
             material = {{ kind = \"dielectric\" }}\n{}",
            camera(offset)
        ))
    };
    Ok(alike(&picture(0.0)?, &picture(offset)?))
}

fn labelled(offset: f64) -> Result<Measurement, StudyError> {
    let picture = |offset| {
        let text = format!("{LABELS}[media.ice]\nior = 1.31\n{}", camera(offset));
        Scene::new().frame(body(offset).labelled(0, 1)).render(&text)
    };
    Ok(alike(&picture(0.0)?, &picture(offset)?))
}

/// A ball of 1 m of edges of 5 cm: single precision has steps of a hundredth of that from 4 km on.
fn lost(offset: f64) -> Result<Measurement, StudyError> {
    let ball = moved(&sphere(DVec3::ZERO, 1.0, 5), offset);
    let bytes = binary_ply(&ball, "float", |x| (x as f32).to_le_bytes().to_vec());
    let text = format!(
        "[[surfaces]]\nmesh = \"ball.ply\"\nnormals = \"flat\"\nmaterial = {{ kind = \"diffuse\" }}\n{}",
        camera(offset)
    );
    let prepared = Scene::new().file("ball.ply", bytes).prepare(&text)?;
    Ok(told(&prepared.warnings, "single precision", offset > 4000.0))
}

fn binary_ply(shape: &Shape, number: &str, bytes: fn(f64) -> Vec<u8>) -> Vec<u8> {
    let mut file = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty {number} x\nproperty {number} y\n\
         property {number} z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        shape.positions.len(),
        shape.triangles.len()
    )
    .into_bytes();
    file.extend(shape.positions.iter().flat_map(|p| p.to_array()).flat_map(bytes));
    for triangle in &shape.triangles {
        file.push(3);
        file.extend(triangle.iter().flat_map(|index| index.to_le_bytes()));
    }
    file
}

fn obj(shape: &Shape) -> String {
    let mut text = String::new();
    for p in &shape.positions {
        let _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z);
    }
    for [a, b, c] in &shape.triangles {
        let _ = writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1);
    }
    text
}
