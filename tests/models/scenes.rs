//! Models as scenes have them: what paths look up, what users are told, energy.

use floe::optics::water::natural::{NaturalWater, PRESETS};
use floe::spectrum::{LaneMode, Wavelengths};
use glam::DVec3;

use crate::common::mesh::cuboid;
use crate::common::render::Prepared;
use crate::common::scene::SceneFolder;
use crate::{bulk, deviation};

/// A cube of 1 m of a medium before a white sky.
fn cube(medium: &str) -> (SceneFolder, String) {
    let folder = SceneFolder::new().mesh("cube.ply", &cuboid(DVec3::splat(-0.5), DVec3::splat(0.5)));
    let text = format!(
        "[media.fluid]\n{medium}\n[[surfaces]]\nmesh = \"cube.ply\"\nnormals = \"flat\"\nfront = \"air\"\n\
         back = \"fluid\"\nmaterial = {{ kind = \"dielectric\" }}\n[sky]\nradiance = 1\n\
         [camera]\neye = [2, -3, 1]\ntarget = [0, 0, 0]\nvertical_fov = 20\nresolution = [16, 12]\n"
    );
    (folder, text)
}

fn scene(medium: &str) -> Prepared {
    let (folder, text) = cube(medium);
    folder.scene(&text)
}

/// Paths see the curves in between the wavelengths that were computed, and the host's absorption at every nanometre.
/// The bounds are three times what was measured: the bits do not depend on the machine.
#[test]
fn paths_look_up_what_was_computed() {
    let scene = scene("model = 'natural-water'\npreset = 'north-sea'");
    assert_eq!(scene.frame.mode, LaneMode::Spectral);
    let medium = scene.frame.media.iter().find(|m| m.name == "fluid").unwrap();
    let lambda = [397.0, 512.0, 603.0, 741.0];
    let lanes = Wavelengths { lambda: lambda.map(|l| l as f32), pdf: [1.0; 4] };
    let found = [medium.sigma_a.lanes(&lanes), medium.sigma_s.lanes(&lanes)];
    let north_sea = PRESETS.iter().find(|(name, _)| *name == "north-sea").unwrap().1;
    assert!(deviation(f64::from(medium.n), north_sea.mixture().host.index.n(589.3)) < 1e-6);
    let expected = bulk(&north_sea.mixture(), &lambda);
    for i in 0..4 {
        let [a, s] = [expected.sigma_a[i], expected.sigma_s[i]];
        let off = [deviation(f64::from(found[0][i]), a), deviation(f64::from(found[1][i]), s)];
        println!("{} nm: {:.1e} of absorption, {:.1e} of scattering", lambda[i], off[0], off[1]);
        assert!(off[0] < 2.6e-4 && off[1] < 9e-5, "{} nm: {off:?}", lambda[i]);
    }
    let clear = NaturalWater::SEA.mixture();
    assert_eq!(bulk(&clear, &lambda).sigma_s, [0.0; 4]);
}

/// What absorbs nothing sends back all, whatever the wavelengths of a path weigh.
#[test]
fn particles_that_absorb_nothing_are_white_in_white_surroundings() {
    for phase in ["lorenz-mie", "henyey-greenstein"] {
        let scene = scene(&format!(
            "model = 'particles'\nior = 1.33\nphase = '{phase}'\n\
             species = [{{ ior = 1.5, volume_fraction = 1e-6, \
             sizes = {{ kind = 'log-normal', median_um = 0.5, deviation = 0.3 }} }}]"
        ));
        let (mean, se) = scene.render(256, 0).mean();
        println!("{phase}: {mean:.5} +- {se:.5}");
        let off = (mean - DVec3::ONE).abs();
        // 4.5 standard errors, and the rounding of sums of four lanes as colours.
        assert!(off.cmple(4.5 * se + 1e-4).all(), "{phase}: {mean} +- {se}");
    }
}

#[test]
fn milk_is_whiter_than_water_and_both_are_lit() {
    let brightness = |medium: &str| {
        let rendered = scene(medium).render(16, 0);
        (0..12).flat_map(|y| (0..16).map(move |x| (x, y))).map(|(x, y)| rendered.rgb(x, y)).sum::<DVec3>()
            / 192.0
    };
    let [water, milk] = ["natural-water", "milk"].map(|model| brightness(&format!("model = '{model}'")));
    println!("water {water:.3}, milk {milk:.3}");
    assert!(water.min_element() > 0.0 && water.x < water.z, "water is blue: {water}");
    assert!(milk.y > 0.8 && milk.x > milk.z, "milk is bright, and yellowish: {milk}");
}

#[test]
fn what_cannot_be_computed_is_named_with_its_medium() {
    let (folder, text) = cube(
        "model = 'particles'\nior = 1.33\nspecies = [{ name = 'moon', ior = 1e9, volume_fraction = 1e-6, \
         sizes = { kind = 'table', radius_um = [3000], number = [1] } }]",
    );
    let message = folder.refused(&text).to_string();
    for part in ["scene.toml: [media.fluid]: moon, radius ", "geometrical optics"] {
        assert!(message.contains(part), "{message}");
    }
}
