//! Surfaces that lie on each other, touch, or go a little into each other.

use glam::DVec3;

use super::bodies::{LABELS, LOSSLESS, Make, WHITE, furnace, gridded, joined};
use super::shapes::{Shape, cuboid};
use super::{Case, Group, Measurement, Picture, Reference, Scene};
use crate::study::StudyError;

/// The group.
pub(super) const GROUP: Group = Group {
    name: "contacts",
    parameter: "metres that one surface goes into the other",
    about: "Bodies that share faces, edges or points, and water that goes into the glass around it.",
    cases,
};

/// Nothing, less than the rounding of coordinates, and what fluid simulators leave.
const DEPTHS: [f64; 4] = [0.0, 1e-7, 1e-5, 2e-3];

fn cases() -> Vec<Case> {
    let touching = TOUCHING.iter().flat_map(|&(name, bodies)| {
        LOSSLESS.map(|(of, media)| {
            Case::new(&GROUP, format!("white furnace, {of}: {name}"), 0.0, move || {
                Ok(furnace(&Scene::new().frame(bodies()).render(&format!("{LABELS}{media}{WHITE}"))?))
            })
            .quick()
        })
    });
    let poking = LOSSLESS.iter().flat_map(|&(of, media)| {
        DEPTHS.map(|depth| {
            Case::new(&GROUP, format!("white furnace, {of}: water into glass"), depth, move || {
                let media = format!("{media}[media.glass]\nior = 1.5\n");
                Ok(furnace(&in_glass(depth, &media, WHITE)?))
            })
            .quick()
        })
    });
    let dark = DEPTHS.map(|depth| {
        Case::new(&GROUP, "exp(-a d) through glass and water", depth, move || chord(depth)).quick()
    });
    touching.chain(poking).chain(dark).collect()
}

const MIN: DVec3 = DVec3::splat(-0.8);
const MAX: DVec3 = DVec3::splat(0.8);

fn left() -> Shape {
    cuboid(MIN, DVec3::new(0.0, 0.8, 0.8)).askew()
}

fn right() -> Shape {
    cuboid(DVec3::new(0.0, -0.8, -0.8), MAX).askew()
}

/// Bodies of one file that touch.
const TOUCHING: [(&str, Make); 6] = [
    ("water and ice write their common face each", || {
        joined([left().labelled(0, 1), right().labelled(0, 2)])
    }),
    ("two parts of the water do", || joined([left().labelled(0, 1), right().labelled(0, 1)])),
    ("two closed surfaces without labels do", || joined([left().unlabelled(), right().unlabelled()])),
    ("along an edge", || {
        let other = cuboid(DVec3::new(0.0, -0.8, 0.0), MAX).askew();
        joined([cuboid(MIN, DVec3::new(0.0, 0.8, 0.0)).askew().labelled(0, 1), other.labelled(0, 1)])
    }),
    ("at a point", || {
        let other = cuboid(DVec3::ZERO, MAX).askew();
        joined([cuboid(MIN, DVec3::ZERO).askew().labelled(0, 1), other.labelled(0, 2)])
    }),
    ("a body within another, the two sharing part of a face", || {
        let shares = [0.0, 0.5, 1.0];
        let inner = cuboid(DVec3::new(-0.8, -0.8, 0.0), DVec3::new(0.0, 0.0, 0.8)).askew();
        joined([gridded(MIN, MAX, &shares).askew().labelled(0, 1), inner.labelled(1, 2)])
    }),
];

/// A tank of glass, closed all around, with water that goes so far into its walls.
fn in_glass(depth: f64, media: &str, view: &str) -> Result<Picture, StudyError> {
    let hole = cuboid(MIN * 0.8, MAX * 0.8);
    let glass = joined([cuboid(MIN, MAX).unlabelled(), hole.turned().unlabelled()]);
    let into = DVec3::splat(depth);
    let water = gridded(MIN * 0.8 - into, (MAX * 0.8 + into).with_z(0.3), &[0.0, 0.4, 1.0]);
    let glass = Shape { positions: glass.positions, triangles: glass.triangles };
    let scene = Scene::new().mesh("glass.ply", &glass.askew()).mesh("water.ply", &water.askew());
    scene.render(&format!(
        "{media}[[meshes]]\npath = \"glass.ply\"\ninside = \"glass\"\npriority = 1\n\
         normals = \"flat\"\n[[meshes]]\npath = \"water.ply\"\ninside = \"water\"\nnormals = \"flat\"\n{view}"
    ))
}

/// Rays along the box's own y axis, through both walls of glass and the water between them, where nothing bends.
///
/// Distances of at most 4 m in f32 are off by 1e-6 m in all; layers that lie within 2^-19 of their distance from the
/// eye, 8e-6 m, may be taken for one.
fn chord(depth: f64) -> Result<Measurement, StudyError> {
    let media = "[media.water]\nabsorption = 0.9\n[media.glass]\nabsorption = 2\n";
    let [eye, target] = [DVec3::new(0.1, -3.0, 0.05), DVec3::new(0.1, 0.0, 0.05)];
    let turned = Shape { positions: vec![eye, target], triangles: Vec::new() }.askew();
    let view = format!(
        "[sky]\nradiance = 1\n[camera]\neye = {:?}\ntarget = {:?}\nvertical_fov = 0.01\nresolution = [8, 8]\n\
         [render]\nsamples = 4\n",
        turned.positions[0].to_array(),
        turned.positions[1].to_array()
    );
    let picture = in_glass(depth, media, &view)?;
    let expected = libm::exp(-2.0 * 0.32 - 0.9 * 1.28);
    let tolerance = expected * 2.0 * (1e-6 + 2.0 * 8e-6);
    let got = picture.farthest(expected);
    Ok(Measurement::new(Reference::ClosedForm, expected, got).of(&picture).tolerance(tolerance))
}
