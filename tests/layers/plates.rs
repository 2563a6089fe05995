//! Bodies much wider than thick, and bodies that move among others that do not.

use glam::DVec3;

use crate::common::mesh::{Moving, cuboid};
use crate::common::scene::SceneFolder;

const DARK: &str = "[media.ink]\nabsorption = 2000\n[sky]\nradiance = 1\n";

/// A film of 1 mm over 1.2 km lets exp(-2) through, whatever else overlaps it where nobody looks: the rounding of its
/// height has nothing to do with how far it goes. Rays within 4 degrees of the normal are 0.25 % longer in it at most.
#[test]
fn films_do_not_vanish() {
    let folder = SceneFolder::new()
        .mesh("film.ply", &cuboid(DVec3::new(-600.0, -600.0, -0.001), DVec3::new(600.0, 600.0, 0.0)))
        .mesh("floe.ply", &cuboid(DVec3::new(300.0, 300.0, -0.5), DVec3::new(301.0, 301.0, 0.5)));
    let scene = |more: &str| {
        folder.scene(&format!(
            "{DARK}[camera]\neye = [0, 0, 2]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nvertical_fov = 8\n\
             resolution = [16, 16]\n[[meshes]]\npath = \"film.ply\"\ninside = \"ink\"\n{more}"
        ))
    };
    let alone = scene("");
    let among = scene("[[meshes]]\npath = \"floe.ply\"\ninside = \"ink\"\n");
    assert_eq!([alone.frame.needs.layers, among.frame.needs.layers], [false, true]);
    for scene in [alone, among] {
        let mean = scene.render(4, 1).mean().0.x;
        assert!((mean / (-2.0_f64).exp() - 1.0).abs() < 0.006, "{mean}");
    }
}

/// The first mesh has velocities, the second has none: that one stands still, and is told.
#[test]
fn meshes_without_velocities_stand_among_those_that_move() {
    let moving = cuboid(DVec3::splat(-1.0), DVec3::splat(0.5)).moving_ply(|_| DVec3::X * 24.0);
    let folder = SceneFolder::new()
        .file("water_0001.ply", moving.as_bytes())
        .mesh("ice_0001.ply", &cuboid(DVec3::ZERO, DVec3::ONE));
    for order in [["water", "ice"], ["ice", "water"]] {
        let meshes = order.map(|name| format!("[[meshes]]\npath = \"{name}_####.ply\"\ninside = \"ink\"\n"));
        let scene = folder.scene(&format!(
            "{DARK}[frames]\n[camera]\neye = [0, -6, 1]\ntarget = [0, 0, 0]\nresolution = [16, 9]\nshutter = 1\n{}",
            meshes.concat()
        ));
        assert!(scene.frame.needs.motion && scene.frame.needs.layers);
        let geometry = &scene.frame.geometry;
        assert_eq!(geometry.motions.len(), geometry.positions.len());
        assert_eq!(scene.render(4, 1).counters.label_mismatches, 0);
    }
}
