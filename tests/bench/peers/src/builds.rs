//! The rows of builds and refits, on one thread.

use std::rc::Rc;

use floe::accel::{Accel, Ignored};
use floe::geometry::Ray;

use crate::embree::{Device, Kind, RayHit, Scene, padded};
use crate::meshes::Mesh;
use crate::ratio;
use crate::timing::{median, time};

/// A build and a refit of each, in turns; the cells of the two rows.
///
/// # Errors
/// Embree's.
pub fn rows(device: Option<&Rc<Device>>, mesh: &Mesh, passes: usize) -> Result<[String; 2], String> {
    let mut ours = [Vec::new(), Vec::new()];
    let mut theirs = [Vec::new(), Vec::new()];
    let moved = mesh.moved();
    for _ in 0..passes {
        let (build, mut accel) = time(|| Accel::build(&mesh.positions, &mesh.triangles));
        ours[0].push(build);
        ours[1].push(time(|| accel.refit(&moved, &mesh.triangles)).0);
        let Some(device) = device else { continue };
        let (positions, triangles) = (padded(&mesh.positions), mesh.triangles.clone());
        let (build, scene) = time(|| Scene::build(device, Kind::Robust, positions, triangles));
        theirs[0].push(build);
        drop(scene?);
        let (positions, triangles) = (padded(&mesh.positions), mesh.triangles.clone());
        let mut scene = Scene::build(device, Kind::RobustRefit, positions, triangles)?;
        scene.set_positions(&moved);
        let (refit, done) = time(|| scene.update());
        done?;
        theirs[1].push(refit);
        check_same(mesh, &accel, &scene)?;
    }
    Ok([0, 1].map(|row| {
        let mine = 1e3 * median(&ours[row]);
        if theirs[row].is_empty() {
            return format!("| - | {mine:.1} | - |");
        }
        format!("| {:.1} | {mine:.1} | {} |", 1e3 * median(&theirs[row]), ratio(&theirs[row], &ours[row]))
    }))
}

/// Whether both refits moved the surface to the same place, as the ray in the middle of the image sees it.
fn check_same(mesh: &Mesh, accel: &Accel, scene: &Scene) -> Result<(), String> {
    let ray = Ray::new(mesh.eye, -mesh.eye.normalize());
    let ours = accel.closest(&ray, Ignored::NOTHING).map(|hit| hit.t);
    let theirs = scene.closest(&RayHit::new(&ray));
    match (ours, theirs) {
        (Some(a), Some(b)) if (a - b).abs() < 1e-4 * a => Ok(()),
        _ => Err(format!("after refits a ray meets the mesh {} at {ours:?} and at {theirs:?}", mesh.name)),
    }
}
