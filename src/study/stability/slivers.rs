//! Triangles that are hard to meet: very thin ones, such without area, and such that are there twice.

use glam::DVec3;

use super::bodies::{LABELS, LOSSLESS, WHITE, alike, furnace, gridded, joined};
use super::shapes::{Shape, cuboid};
use super::{Case, Group, Measurement, Picture, Reference, Scene};
use crate::mesh::RawMesh;
use crate::study::StudyError;

/// The group.
pub(super) const GROUP: Group = Group {
    name: "slivers",
    parameter: "length over width of the thinnest triangles",
    about: "A box that is cut into thin triangles, has some without area, or has all twice.",
    cases,
};

fn cases() -> Vec<Case> {
    let furnaces = LOSSLESS.iter().flat_map(|&(name, media)| {
        ASPECTS.map(|aspect| {
            let name = format!("white furnace, {name}");
            let case = Case::new(&GROUP, name, aspect, move || {
                Ok(furnace(&render(sliced(aspect).labelled(0, 1), media, WHITE)?))
            });
            if aspect == 1e6 { case.quick() } else { case }
        })
    });
    let dark = ASPECTS
        .map(|aspect| Case::new(&GROUP, "exp(-a d) through slivers", aspect, move || chord(aspect)).quick());
    let same = ASPECTS.map(|aspect| {
        Case::new(&GROUP, "the same picture as of large triangles", aspect, move || {
            Ok(alike(&over_sky(cuboid(MIN, MAX).askew())?, &over_sky(sliced(aspect).askew())?))
        })
    });
    let others = OTHERS.iter().flat_map(|&(name, change)| {
        LOSSLESS.map(|(of, media)| {
            Case::new(&GROUP, format!("white furnace, {of}: {name}"), 1.0, move || {
                Ok(furnace(&render(change(cuboid(MIN, MAX).labelled(0, 1)), media, WHITE)?))
            })
            .quick()
        })
    });
    furnaces.chain(dark).chain(same).chain(others).collect()
}

const ASPECTS: [f64; 4] = [1.0, 1e3, 1e6, 1e8];
const MIN: DVec3 = DVec3::splat(-0.8);
const MAX: DVec3 = DVec3::new(0.8, 0.7, 0.6);

/// Changes a mesh.
type Change = fn(RawMesh) -> RawMesh;

/// What is done to a box of which nothing may be seen.
const OTHERS: [(&str, Change); 4] = [
    ("triangles without area", with_flat_triangles),
    ("all faces twice", |mesh| joined([mesh.clone(), mesh])),
    ("all faces twice, once from behind", |mesh| joined([mesh.clone(), seen_from_behind(mesh)])),
    ("a body of no thickness in it", |mesh| {
        joined([mesh, cuboid(DVec3::new(-0.5, -0.5, 0.1), DVec3::new(0.5, 0.5, 0.1)).labelled(1, 2)])
    }),
];

/// A box with strips of this aspect at its edges and across its faces.
fn sliced(aspect: f64) -> Shape {
    let width = 0.2 / aspect;
    gridded(MIN, MAX, &[0.0, width, 0.45 - width, 0.45, 0.45 + width, 1.0 - width, 1.0])
}

/// Triangles of three points on a line, beside edges and across faces.
fn with_flat_triangles(mut mesh: RawMesh) -> RawMesh {
    for [a, b, c] in mesh.triangles.clone() {
        let middle = mesh.positions.len() as u32;
        mesh.positions.push(mesh.positions[a as usize].midpoint(mesh.positions[b as usize]));
        mesh.triangles.extend([[a, middle, b], [c, c, a]]);
    }
    if let Some(interfaces) = &mut mesh.interfaces {
        interfaces.resize(mesh.triangles.len(), interfaces[0]);
    }
    mesh
}

fn seen_from_behind(mut mesh: RawMesh) -> RawMesh {
    mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    for interface in mesh.interfaces.iter_mut().flatten() {
        std::mem::swap(&mut interface.front, &mut interface.back);
    }
    mesh
}

fn render(mesh: RawMesh, media: &str, view: &str) -> Result<Picture, StudyError> {
    Scene::new().frame(mesh).render(&format!("{LABELS}{media}{view}"))
}

fn over_sky(shape: Shape) -> Result<Picture, StudyError> {
    let media =
        "[media.water]\nior = 1.33\nabsorption = [0.8, 0.4, 0.2]\nscattering = 1\n[media.ice]\nior = 1.31\n";
    let view = "[sky]\nradiance = [0.5, 0.6, 0.7]\n[sun]\ndirection = [0.4, 0.2, 0.9]\nirradiance = 1\n\
                angular_diameter = 10\n[camera]\neye = [0.7, -4.0, 1.5]\ntarget = [0, 0, 0]\nvertical_fov = 30\n\
                resolution = [24, 18]\n[render]\nsamples = 16\n";
    render(shape.labelled(0, 1), media, view)
}

/// Rays along y through 1.5 m of what absorbs 1.3 / m, at the strips in the middle of the faces.
///
/// Both distances are rounded by some units of 2^-24 of at most 3 m, so the optical depth is off by 3e-6 at most.
fn chord(aspect: f64) -> Result<Measurement, StudyError> {
    let media = "[media.water]\nabsorption = 1.3\n[media.ice]\nior = 1.31\n";
    let middle = MIN * 0.55 + MAX * 0.45;
    let view = format!(
        "[sky]\nradiance = 1\n[camera]\neye = [{x}, -2, {z}]\ntarget = [{x}, 0, {z}]\nvertical_fov = 0.01\n\
         resolution = [24, 24]\n[render]\nsamples = 4\n",
        x = middle.x,
        z = middle.z
    );
    let picture = render(sliced(aspect).labelled(0, 1), media, &view)?;
    let expected = libm::exp(-1.3 * (MAX.y - MIN.y));
    let got = picture.farthest(expected);
    Ok(Measurement::new(Reference::ClosedForm, expected, got).of(&picture).tolerance(3e-6 * expected))
}
