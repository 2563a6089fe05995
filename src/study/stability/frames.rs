//! What one frame leaves to the next where both have little in common, and what moves far while the shutter is open.

use glam::{DVec3, Vec3};

use super::bodies::{LABELS, LOSSLESS, Make, WHITE, furnace, joined};
use super::shapes::{Shape, cuboid, sphere};
use super::{Case, Group, Measurement, Reference, Scene, render};
use crate::mesh::{Interface, RawMesh, Region};
use crate::study::StudyError;

/// The group.
pub(super) const GROUP: Group = Group {
    name: "frames",
    parameter: "widths of the body that it moves by in a frame",
    about: "Frames after empty, distant or otherwise labelled ones; what moves far in a frame.",
    cases,
};

const JUMPS: [f64; 4] = [0.0, 1e-3, 10.0, 1e6];

/// The mesh of a frame, and of the one before it.
const PAIRS: [(&str, Make, Make); 4] = [
    ("after an empty frame", RawMesh::default, || body(0.0)),
    ("empty, after one that is not", || body(0.0), RawMesh::default),
    ("after one of other labels", other_labels, || body(0.0)),
    ("after one of other triangles", || sphere(DVec3::ZERO, 0.7, 2).labelled(0, 1), || body(0.0)),
];

fn cases() -> Vec<Case> {
    let jumps = JUMPS.map(|jump| {
        let measure = move || as_alone(body(jump), body(0.0));
        Case::new(&GROUP, "pixels unlike those of the frame alone: after a jump", jump, measure).quick()
    });
    let pairs = PAIRS.iter().map(|&(name, before, mesh)| {
        let name = format!("pixels unlike those of the frame alone: {name}");
        Case::new(&GROUP, name, 0.0, move || as_alone(before(), mesh())).quick()
    });
    let blurred = LOSSLESS.iter().flat_map(|&(name, media)| {
        JUMPS.map(|jump| {
            let measure = move || blurred(jump, media);
            Case::new(&GROUP, format!("white furnace, {name}, while the shutter is open"), jump, measure)
                .quick()
        })
    });
    jumps.into_iter().chain(pairs).chain(blurred).collect()
}

/// Water and ice that share a face, elsewhere by so many of their widths.
fn body(jump: f64) -> RawMesh {
    let part = |min: DVec3, max: DVec3| {
        let Shape { positions, triangles } = cuboid(min, max).askew();
        let by = DVec3::new(0.3, 1.6, 0.1) * jump;
        Shape { positions: positions.iter().map(|&p| p + by).collect(), triangles }
    };
    let left = part(DVec3::splat(-0.8), DVec3::new(0.0, 0.8, 0.8));
    let right = part(DVec3::new(0.0, -0.8, -0.8), DVec3::splat(0.8));
    joined([left.labelled(0, 1), right.labelled(0, 2)])
}

fn other_labels() -> RawMesh {
    let swapped = |region: Region| if region == Region::OUTSIDE { region } else { Region(3 - region.0) };
    let mut mesh = body(0.0);
    for Interface { front, back } in mesh.interfaces.iter_mut().flatten() {
        (*front, *back) = (swapped(*front), swapped(*back));
    }
    mesh
}

/// How many pixels differ by a bit where the frame is not the first.
fn as_alone(before: RawMesh, mesh: RawMesh) -> Result<Measurement, StudyError> {
    let text = format!(
        "{LABELS}[media.water]\nior = 1.33\nabsorption = 0.8\nscattering = 1\n[media.ice]\nior = 1.31\nscattering = 5\n{WHITE}"
    );
    let before = Scene::new().frame(before).prepare(&text)?;
    let scene = Scene::new().frame(mesh);
    let alone = scene.render(&text)?;
    let after = render(&scene.prepare_after(&text, Some(&before.frame))?);
    let pixels = alone.image.pixels.iter().zip(&after.image.pixels);
    let differ = pixels.filter(|(a, b)| a.rgb != b.rgb).count();
    Ok(Measurement::new(Reference::Invariance, 0.0, differ as f64).of(&after))
}

/// A body that is here when the shutter opens, and elsewhere half a frame later.
fn blurred(jump: f64, media: &str) -> Result<Measurement, StudyError> {
    let [here, there] = [body(0.0), body(jump)];
    let way = |(from, to): (&DVec3, &DVec3)| ((*to - *from) * 24.0).as_vec3();
    let velocities: Vec<Vec3> = here.positions.iter().zip(&there.positions).map(way).collect();
    let mesh = RawMesh { velocities: Some(velocities), ..here };
    let view = WHITE.replace("[camera]\n", "[camera]\nshutter = 0.5\n");
    Ok(furnace(&Scene::new().frame(mesh).render(&format!("{LABELS}{media}{view}"))?))
}
