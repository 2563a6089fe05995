//! Where nothing absorbs, meshes that overlap vanish in white surroundings.

use glam::DVec3;

use crate::common::mesh::{cuboid, sphere};
use crate::common::scene::SceneFolder;

/// As the furnaces of one mesh: each of some hundred scatterings multiplies the throughput by a weight of relative error
/// 2^-24 or so, of either sign.
#[test]
fn overlapping_bodies_vanish_in_white_surroundings() {
    let folder = SceneFolder::new()
        .mesh("a.ply", &cuboid(DVec3::splat(-0.7), DVec3::splat(0.6)))
        .mesh("b.ply", &sphere(DVec3::splat(0.4), 0.6, 4))
        .mesh("c.ply", &cuboid(DVec3::new(-0.7, -0.2, -0.9), DVec3::new(0.6, 0.8, 0.2)));
    for (iors, scattering, lamps) in [
        ([1.33, 1.5, 1.31], 0, 0),
        ([1.33, 1.0, 2.4], 5, 0),
        ([1.0, 1.0, 1.0], 40, 0),
        ([1.5, 1.33, 1.0], 3, 2),
    ] {
        let scene = folder.scene(&format!(
            "[sky]\nradiance = 1\n[media.a]\nior = {}\n[media.b]\nior = {}\nscattering = {scattering}\n[media.c]\nior = {}\n\
             scattering = 1\nphase = {{ kind = \"henyey-greenstein\", g = 0.7 }}\n\
             [[meshes]]\npath = \"a.ply\"\ninside = \"a\"\nnormals = \"flat\"\npriority = 2\n\
             [[meshes]]\npath = \"b.ply\"\ninside = \"b\"\nnormals = \"flat\"\npriority = 7\n\
             [[meshes]]\npath = \"c.ply\"\ninside = \"c\"\nnormals = \"flat\"\n\
             [camera]\neye = [1.2, -3.5, 0.8]\ntarget = [0, 0, 0]\nvertical_fov = 40\nresolution = [24, 24]\n\
             [render]\nforced_scattering = {lamps}\n",
            iors[0], iors[1], iors[2]
        ));
        let picture = scene.render(64, 0);
        let (mean, error) = picture.mean();
        let (worst, at) = picture.worst_deviation(DVec3::ONE);
        println!(
            "{iors:?} {scattering}: {mean:.6} +- {error:.6}, worst {worst:.1e} at {at:?}, {:?}",
            picture.counters
        );
        assert!(worst < 2e-5, "{iors:?} {scattering}: off by {worst} at {at:?}");
        assert_eq!(picture.counters.label_mismatches, 0);
    }
}
