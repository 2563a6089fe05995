//! The light of several suns is the sum of what each brings alone, and a sun in two halves is that sun.

use floe::integrator::Integrator;
use glam::DVec3;

use crate::agreement::waves;
use crate::common::mesh::{cuboid, parallelogram, sphere};
use crate::common::render::{Prepared, Rendered};
use crate::common::scene::SceneFolder;
use crate::seeds::{Means, Seeds, assert_agree, with_radius};
use crate::walled;

const HIGH: &str = "direction = [0.3, 0.1, 0.9]\nangular_diameter = 0.53\nirradiance = [3, 2, 1]\n";
const HALF: &str = "direction = [0.3, 0.1, 0.9]\nangular_diameter = 0.53\nirradiance = [1.5, 1, 0.5]\n";
const LOW: &str = "direction = [-0.5, -0.4, 0.7]\nangular_diameter = 4\nirradiance = [0.5, 1, 3]\n";

/// Suns that stand in one scene, and those whose scenes add up to it.
const SUMS: [(&str, [&str; 2], &[&str]); 2] =
    [("two suns", [HIGH, LOW], &[HIGH, LOW]), ("two halves", [HALF, HALF], &[HIGH])];

fn under(suns: &[&str], folder: &SceneFolder, text: &str) -> Prepared {
    let suns: String = suns.iter().map(|sun| format!("[[sun]]\n{sun}")).collect();
    folder.scene(&format!("{text}{suns}"))
}

/// Paths are the same under any suns, so each pixel is the sum of the others but for rounding: of fewer than 500 terms, none
/// below zero, in single precision.
fn assert_adds_up(name: &str, folder: &SceneFolder, text: &str) {
    for (sum, together, apart) in SUMS {
        let picture = |suns: &[&str]| -> Rendered {
            let picture = under(suns, folder, text).render(8, 1);
            assert_eq!(picture.counters.photons, 0, "{name}: photons are not the same");
            picture
        };
        let whole = picture(&together);
        let parts: Vec<Rendered> = apart.iter().map(|sun| picture(&[sun])).collect();
        let [width, height] = [whole.image.width, whole.image.height];
        let mut worst = 0.0_f64;
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            let added = parts.iter().map(|part| part.rgb(x, y)).sum::<DVec3>();
            let off = (whole.rgb(x, y) - added).abs() / added.max(DVec3::splat(1e-9));
            worst = worst.max(off.max_element());
        }
        let least = parts.iter().map(|part| part.mean().0.min_element()).fold(f64::INFINITY, f64::min);
        println!("{name}, {sum}: {worst:.1e} apart, means from {least:.4} on");
        assert!(worst < 500.0 * f64::from(f32::EPSILON), "{name}, {sum}: {worst}");
        assert!(least > 0.01, "{name}, {sum}: {least} shows too little");
    }
}

/// A floor, a mirror and a window of smoke, in the open: of each sun what is scattered, what is mirrored and its shadow.
#[test]
fn paths_in_the_open_add_up() {
    let folder = SceneFolder::new()
        .mesh("floor.ply", &parallelogram(DVec3::new(-9.0, -9.0, 0.0), DVec3::X * 18.0, DVec3::Y * 18.0))
        .mesh("mirror.ply", &parallelogram(DVec3::new(-1.0, 0.9, 0.1), DVec3::X, DVec3::Z))
        .mesh("smoke.ply", &cuboid(DVec3::new(0.1, 0.0, 0.2), DVec3::new(0.9, 0.6, 0.8)));
    for integrator in ["path", "single-scattering", "fog"] {
        let text = format!(
            "[media.smoke]\nabsorption = 0.5\nscattering = 2\n\
             [[surfaces]]\nmesh = \"smoke.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"smoke\"\n\
             material = {{ kind = \"null\" }}\n\
             [[surfaces]]\nmesh = \"mirror.ply\"\nmaterial = {{ kind = \"conductor\", eta = 0.2, k = 3 }}\n\
             [[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = [0.7, 0.5, 0.3] }}\n\
             [camera]\neye = [0, -2, 1.2]\ntarget = [0, 0.2, 0.3]\nvertical_fov = 50\nresolution = [32, 24]\n\
             [render]\nintegrator = \"{integrator}\"\n"
        );
        assert_adds_up(integrator, &folder, &text);
    }
}

/// Turbid water over a floor, with waves too flat to mirror light back into it, and the camera in it.
fn tank(render: &str) -> (SceneFolder, String) {
    let floor = parallelogram(DVec3::new(-2.0, -2.0, 0.0), DVec3::X * 4.0, DVec3::Y * 4.0);
    let folder = SceneFolder::new().mesh("surface.ply", &waves()).mesh("floor.ply", &floor);
    // They stand where the surface ends: photons would leave the turbid water beyond them at its open sides.
    let (folder, walls) = walled(folder, 2.0, 1.2);
    let text = format!(
        "[media.water]\nior = 1.33\nabsorption = [0.3, 0.2, 0.1]\nscattering = 0.3\n\
         phase = {{ kind = \"henyey-greenstein\", g = 0.7 }}\n[media.glass]\nior = 1.6\n\
         [[surfaces]]\nmesh = \"surface.ply\"\nfront = \"air\"\nback = \"water\"\nmaterial = {{ kind = \"dielectric\" }}\n\
         [[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 0.5 }}\n\
         [camera]\neye = [0, -0.6, 0.7]\ntarget = [0, 0.1, 0]\nvertical_fov = 60\nresolution = [32, 24]\n\
         {walls}[render]\n{render}"
    );
    (folder, text)
}

/// Means of the parts of a picture, whose random numbers `numbers` tells apart from those of others.
fn means(mut scene: Prepared, numbers: i64) -> Means {
    scene.sampling.seed.frame = numbers;
    // A blur that stays is the same for all.
    Seeds::render(&with_radius(scene, 0.03), 16, 4, [4, 3]).means()
}

fn assert_means_add_up(folder: &SceneFolder, text: &str, photons: bool) {
    for (sum, together, apart) in SUMS {
        let scene = under(&together, folder, text);
        let name = format!("{}, {sum}", scene.sampling.integrator.name());
        assert!(!matches!(scene.sampling.integrator, Integrator::Path(_)), "{name}");
        assert_eq!(scene.render(1, 1).counters.photons > 0, photons, "{name}: photons");
        let whole = means(scene, 1);
        let parts = apart.iter().zip(2..).map(|(sun, k)| means(under(&[sun], folder, text), k));
        let added = parts.reduce(|a, b| a.into_iter().zip(b).map(plus).collect()).unwrap();
        assert_agree(&name, &whole, &added, 0.04);
    }
}

/// How often a vertex looks, and where it sends paths, goes by the brightest sun.
#[test]
fn beams_add_up() {
    let (folder, text) = tank("integrator = \"beams\"\n");
    assert_means_add_up(&folder, &text, false);
}

/// Photons of several suns are other photons; with a ball of glass in the water beams are not without them either.
#[test]
#[ignore = "takes a minute"]
fn photons_add_up() {
    for render in [
        "integrator = \"beams\"\nphotons = { count = 20000 }\n",
        "integrator = \"photon\"\nphotons = { count = 40000, final_gather = false }\n",
    ] {
        let (folder, text) = tank(render);
        let folder = folder.mesh("ball.ply", &sphere(DVec3::new(0.0, 0.3, 0.3), 0.25, 2));
        let ball = "[[surfaces]]\nmesh = \"ball.ply\"\nfront = \"water\"\nback = \"glass\"\n\
                    material = { kind = \"dielectric\" }\n";
        assert_means_add_up(&folder, &format!("{ball}{text}"), true);
    }
}

/// The sum of two means, and its standard error.
fn plus(((a, a_se), (b, b_se)): ((DVec3, DVec3), (DVec3, DVec3))) -> (DVec3, DVec3) {
    (a + b, (a_se * a_se + b_se * b_se).map(f64::sqrt))
}
