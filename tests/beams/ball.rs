//! The ball of water of s08 in the sun instead of its lamp: every way to the floor is bent twice, and that of photons.

use crate::common::reference::folder;
use crate::common::scene::SceneFolder;
use crate::seeds::{Means, Seeds, assert_agree, with_radius};

/// Beams and photons alone, both told at radius 0 by radii of 0.02, 0.04 and 0.08 m; scores as [`assert_agree`] judges them.
#[test]
fn s08_in_the_sun() {
    let read = |name: &str| std::fs::read(folder().join(format!("s08_caustic__{name}.ply"))).unwrap();
    let scenes = SceneFolder::new().file("sphere.ply", &read("sphere")).file("floor.ply", &read("floor"));
    let told = |render: &str| -> Means {
        let text = format!(
            "[media.water]\nior = 1.33\n\
             [[surfaces]]\nmesh = \"floor.ply\"\nnormals = \"flat\"\nmaterial = {{ kind = \"diffuse\", reflectance = 0.7 }}\n\
             [[surfaces]]\nmesh = \"sphere.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"water\"\n\
             material = {{ kind = \"dielectric\" }}\n\
             [sun]\ndirection = [0.5, 1, -0.2]\nangular_diameter = 0.53\nirradiance = 3\n\
             [camera]\neye = [0.6, 1.6, 3]\ntarget = [0.05, 0.35, 0]\nup = [0, 1, 0]\nhorizontal_fov = 45\n\
             resolution = [32, 24]\n[render]\n{render}"
        );
        let [near, middle, wide] = [0.02, 0.04, 0.08]
            .map(|radius| Seeds::render(&with_radius(scenes.scene(&text), radius), 24, 4, [4, 3]));
        Seeds::extrapolated(&near, &middle, &wide).means()
    };
    let beams = told("integrator = \"beams\"\nphotons = { count = 20000 }\n");
    let photons = told("integrator = \"photon\"\nphotons = { count = 40000, final_gather = false }\n");
    assert_agree("s08 in the sun", &beams, &photons, 0.05);
}
