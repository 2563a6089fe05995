//! Meshes whose labels are wrong, or that have holes: what is told, and that no path goes on for ever.

use glam::DVec3;

use super::bodies::{LABELS, LOSSLESS, Make, WHITE, furnace, joined, told};
use super::picture::Spoilt;
use super::shapes::{Shape, cuboid};
use super::{Case, Group, Measurement, Reference, Scene, render};
use crate::mesh::{Interface, RawMesh, Region};
use crate::study::StudyError;

/// The group.
pub(super) const GROUP: Group = Group {
    name: "labels",
    parameter: "1 where it is wrong",
    about: "Labels that are swapped or disagree, and surfaces with holes: warnings and counts instead of a wrong picture.",
    cases,
};

/// Paths that no surface ends are ended by roulette far outside: after some thousand flights here. Without it they would
/// have 400,000 in the mean.
const MOST_FLIGHTS: f64 = 20_000.0;

/// A mesh, what a warning says of it, and whether rays have to notice.
struct Wrong {
    name: &'static str,
    mesh: Make,
    warning: &'static str,
    /// More labels disagree than in any sound frame, which then has no picture, or paths leave through holes.
    is_counted: bool,
}

const WRONG: [Wrong; 5] = [
    Wrong {
        name: "the outside within",
        mesh: || cube().labelled(1, 0),
        warning: "label 0, the outside, lies within",
        is_counted: true,
    },
    Wrong { name: "labels that disagree", mesh: half_ice, warning: "contradicts itself", is_counted: true },
    Wrong {
        name: "a face is missing",
        mesh: open,
        warning: "the surface is open: 4 edges",
        is_counted: true,
    },
    Wrong {
        name: "one triangle",
        mesh: || triangle().labelled(0, 1),
        warning: "the surface is open: 3 edges",
        is_counted: true,
    },
    Wrong {
        name: "no triangles",
        mesh: RawMesh::default,
        warning: "the mesh has no triangles",
        is_counted: false,
    },
];

/// Meshes that are right or can be mended, and how many warnings there are.
const SOUND: [(&str, Make, usize); 3] = [
    ("a box", || cube().labelled(0, 1), 0),
    // Of its own surface alone one might say that the outside lies within.
    ("a box with a bubble", || joined([cube().labelled(0, 1), bubble().labelled(0, 1)]), 0),
    ("a box inside out, without labels", || cube().turned().unlabelled(), 1),
];

fn cases() -> Vec<Case> {
    let wrong = WRONG.iter().flat_map(|wrong| {
        LOSSLESS.map(|(of, media)| {
            Case::new(&GROUP, format!("told, {of}: {}", wrong.name), 1.0, move || tells(wrong, media)).quick()
        })
    });
    let right = SOUND.iter().map(|&(name, mesh, warnings)| {
        let measure = move || sound(mesh(), warnings);
        Case::new(&GROUP, format!("warnings: {name}"), 0.0, measure).quick()
    });
    wrong.chain(right).collect()
}

fn cube() -> Shape {
    cuboid(DVec3::splat(-0.8), DVec3::splat(0.8)).askew()
}

fn bubble() -> Shape {
    cuboid(DVec3::splat(-0.3), DVec3::splat(0.3)).turned()
}

fn triangle() -> Shape {
    let positions = vec![DVec3::new(-1.0, 0.0, -1.0), DVec3::new(1.0, 0.0, -1.0), DVec3::new(0.0, 0.1, 1.0)];
    Shape { positions, triangles: vec![[0, 1, 2]] }
}

/// Water behind one half of the triangles, ice behind the other.
fn half_ice() -> RawMesh {
    let mut mesh = cube().labelled(0, 1);
    for interface in mesh.interfaces.iter_mut().flatten().take(6) {
        *interface = Interface { front: Region::OUTSIDE, back: Region(2) };
    }
    mesh
}

fn open() -> RawMesh {
    let Shape { positions, mut triangles } = cube();
    triangles.truncate(10);
    Shape { positions, triangles }.labelled(0, 1)
}

/// 1 if a warning tells of it, rays notice where they must, every number is finite and no path goes on for long.
fn tells(wrong: &Wrong, media: &str) -> Result<Measurement, StudyError> {
    let prepared = Scene::new().frame((wrong.mesh)()).prepare(&format!("{LABELS}{media}{WHITE}"))?;
    let picture = render(&prepared);
    let measured = told(&prepared.warnings, wrong.warning, true);
    let counters = picture.counters;
    let is_noticed = counters.too_many_mismatches(prepared.frame.roughness) || counters.escaped_inside > 8;
    let flights = (counters.rays + counters.untraced) as f64 / picture.samples as f64;
    let is_fine = picture.spoilt == Spoilt::default() && flights < MOST_FLIGHTS;
    let got = if is_noticed == wrong.is_counted && is_fine { measured.got } else { 0.0 };
    let note = format!("{}; {flights:.0} flights a sample, {counters:?}", measured.note);
    Ok(Measurement { got, note, ..measured })
}

/// The number of warnings about a mesh of which nothing may be seen.
fn sound(mesh: RawMesh, warnings: usize) -> Result<Measurement, StudyError> {
    let prepared = Scene::new().frame(mesh).prepare(&format!("{LABELS}{}{WHITE}", LOSSLESS[1].1))?;
    let picture = render(&prepared);
    let seen = furnace(&picture);
    let is_fine = (seen.got - seen.expected).abs() <= seen.tolerance;
    let got = if is_fine { prepared.warnings.len() as f64 } else { f64::NAN };
    let measured = Measurement::new(Reference::ClosedForm, warnings as f64, got).of(&picture);
    Ok(measured.note(prepared.warnings.join("; ")))
}
