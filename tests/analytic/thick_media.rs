//! Media so thick that paths collide thousands of times.

use floe::optics::phase::{HenyeyGreenstein, Isotropic, MediumPhase, PhaseFunction};
use floe::spectrum::Wavelengths;
use glam::DVec3;

use super::estimates::assert_mean;
use crate::common::mesh::{cuboid, sphere};
use crate::common::render::{Prepared, Rendered};
use crate::common::scene::SceneFolder;

/// A layer of 1 m, open below a black tray that reaches up to its surface: light comes from above only.
///
/// What gets to the tray's walls through the layer has come 20 m to the side.
pub fn tray() -> SceneFolder {
    let layer = cuboid(DVec3::new(-25.0, -25.0, -1.0), DVec3::new(25.0, 25.0, 0.0));
    let mut tray = cuboid(DVec3::new(-20.0, -20.0, -3.0), DVec3::new(20.0, 20.0, 0.0));
    // Without its top.
    tray.triangles.retain(|t| t.iter().any(|&v| tray.positions[v as usize].z < -1.0));
    SceneFolder::new().mesh("layer.ply", &layer).mesh("tray.ply", &tray)
}

pub const LAYER: &str = "[[surfaces]]\nmesh = \"layer.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"milk\"\n\
                         material = { kind = \"dielectric\" }\n[sky]\nradiance = 1\n";
pub const TRAY: &str = "[[surfaces]]\nmesh = \"tray.ply\"\nnormals = \"flat\"\n\
                        material = { kind = \"diffuse\", reflectance = 0 }\n";
/// Straight up from between the layer and the tray, straight down from above; all rays are parallel to 1e-5.
pub const BELOW: &str =
    "[camera]\neye = [0.3, 0.2, -2]\ntarget = [0.3, 0.2, 0]\nup = [0, 1, 0]\nvertical_fov = 0.001\n";
pub const ABOVE: &str =
    "[camera]\neye = [0.3, 0.2, 2]\ntarget = [0.3, 0.2, 0]\nup = [0, 1, 0]\nvertical_fov = 0.001\n";

/// Makes every flight of every path traced, as it is where media glow: nothing does, so nothing else changes.
pub fn trace_every_flight(scene: &mut Prepared) {
    scene.frame.needs.emission = true;
}

/// Panics unless two pictures have the same mean within five standard errors of the difference.
pub fn assert_same_mean(name: &str, a: &Rendered, b: &Rendered, most: f64) {
    let ((mean, se), (other, other_se)) = (a.mean(), b.mean());
    let deviation = DVec3::from_array((se * se + other_se * other_se).to_array().map(f64::sqrt));
    println!("{name}: {mean:.6} and {other:.6} +- {deviation:.6}");
    assert!((deviation / other).max_element() <= most, "{name}: {deviation} shows too little");
    assert!((mean - other).abs().cmple(5.0 * deviation + 1e-6).all(), "{name}: {mean} is not {other}");
}

/// Half of the walks leave after a few collisions, one in 600 after half a million on the other side. None is lost: the
/// late roulette begins at collision 65,536 and gives those that it leaves a weight.
#[test]
fn a_layer_of_a_thousand_free_paths_that_absorbs_nothing_is_white() {
    let scene =
        tray().scene(&format!("[media.milk]\nscattering = 1000\n{LAYER}{ABOVE}resolution = [16, 16]\n"));
    let picture = scene.render(8, 0);
    println!("{:?}", picture.counters);
    assert_eq!((picture.counters.cut, picture.counters.trapped), (0, 0));
    assert!(picture.counters.untraced > 9 * picture.counters.rays, "{:?}", picture.counters);
    assert_mean("tau 1000", &picture, DVec3::ONE, 1e-2);
}

/// What a thick layer of albedo 1 lets through to a view straight on, lit evenly from the other side, is known but for
/// terms like exp(-tau): Chandrasekhar's H(1) = 2.9078 for isotropic scattering, and Milne's 0.7104 twice.
///
/// ```text
/// T = H(1) / (sqrt(3) (tau + 1.4209)),   its mean over the cosine: 4 / (3 (tau + 1.4209))
/// ```
#[test]
fn a_thick_layer_transmits_what_milne_says() {
    for (tau, samples) in [(20.0, 256), (100.0, 512)] {
        let scene = tray()
            .scene(&format!("[media.milk]\nscattering = {tau}\n{LAYER}{TRAY}{BELOW}resolution = [16, 16]\n"));
        let transmitted = 2.9078 / (3.0_f64.sqrt() * (tau + 1.4209));
        let name = format!("transmittance, tau {tau}");
        assert_mean(&name, &scene.render(samples, 0), DVec3::splat(transmitted), 0.05 * transmitted);
    }
}

/// The ball in which nothing is traced changes neither what comes back from a layer of optical depth 1000 nor what gets
/// through one that lets some light through, nor how many paths end at the scene's `max_depth`.
#[test]
fn walks_in_balls_agree_with_walks_of_which_every_flight_is_traced() {
    const FORWARD: &str = "phase = { kind = \"henyey-greenstein\", g = 0.86 }";
    let grey = format!("ior = 1.31\nscattering = 87\nabsorption = [0.08, 0.05, 0.005]\n{FORWARD}");
    let coloured = format!("ior = 1.31\nscattering = 87\nabsorption = [0.3, 0.05, 0.005]\n{FORWARD}");
    for (medium, is_grey, max_depth, view, samples) in [
        ("scattering = 999\nabsorption = 1", true, 0, ABOVE, 64),
        ("scattering = 300", true, 20, ABOVE, 128),
        ("scattering = [24, 22, 20]\nabsorption = [0.01, 0.1, 0.3]", false, 0, BELOW, 512),
        (&grey, true, 0, ABOVE, 128),
        (&coloured, false, 0, ABOVE, 128),
    ] {
        let mut scene = tray().scene(&format!(
            "[media.milk]\n{medium}\n{LAYER}{TRAY}{view}resolution = [16, 16]\n[render]\nmax_depth = {max_depth}\n"
        ));
        let milk = scene.frame.media.iter().find(|medium| medium.name == "milk");
        let drawn_ahead = milk.is_some_and(|milk| milk.lanes(&Wavelengths::RGB).grey().is_some());
        assert_eq!(drawn_ahead, is_grey, "{medium}");
        let balls = scene.render(samples, 0);
        trace_every_flight(&mut scene);
        let plain = scene.render(samples, 1);
        assert!(balls.counters.untraced > balls.counters.rays / 3 && plain.counters.untraced == 0);
        // Each path is one that ends so or is not: the variances of the two numbers are at most the numbers.
        let [ended, others] = [&balls, &plain].map(|picture| picture.counters.depth_limited as f64);
        assert!((ended - others).abs() <= 5.0 * (ended + others).sqrt(), "{medium}: {ended} {others}");
        assert_eq!(ended > 0.0, max_depth > 0);
        assert_same_mean(medium, &balls, &plain, 0.06);
    }
}

/// Half a metre deep, where nothing comes out after so few collisions: each path flies to all that it may turn at and
/// to the one at which it ends, however many of these flights are drawn at a time.
#[test]
fn walks_in_balls_end_at_the_depth_that_was_asked_for() {
    let within =
        "[camera]\neye = [0.3, 0.2, -0.5]\ntarget = [0.3, 0.2, 0]\nup = [0, 1, 0]\nvertical_fov = 1\n";
    for (phase, max_depth) in [("isotropic", 20), ("isotropic", 21), ("rayleigh", 25), ("rayleigh", 100)] {
        let mut scene = tray().scene(&format!(
            "[media.milk]\nscattering = 3000\nphase = {{ kind = \"{phase}\" }}\n{LAYER}{TRAY}{within}\
             resolution = [16, 16]\n[render]\nmax_depth = {max_depth}\n"
        ));
        let balls = scene.render(4, 0).counters;
        assert!(balls.untraced > 2 * balls.rays, "{balls:?}");
        trace_every_flight(&mut scene);
        for counters in [balls, scene.render(4, 0).counters] {
            assert_eq!(counters.depth_limited, 4 * 256, "{max_depth}: {counters:?}");
            assert_eq!(
                counters.rays + counters.untraced,
                4 * 256 * (max_depth + 1),
                "{max_depth}: {counters:?}"
            );
        }
    }
}

/// Without `render.similarity` nothing is replaced; with it only what is thick and scatters forward.
#[test]
fn only_thick_media_that_scatter_forward_are_reduced() {
    let folder = tray().mesh("ball.ply", &sphere(DVec3::new(0.0, 0.0, 3.0), 0.5, 2));
    let ball = "[[surfaces]]\nmesh = \"ball.ply\"\nfront = \"air\"\nback = \"ball\"\nmaterial = { kind = \"dielectric\" }\n";
    let hg = MediumPhase::One(PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g: 0.9 }));
    let phase = |milk: &str, ball_medium: &str, similarity: u32| {
        let scene = folder.scene(&format!(
            "[media.milk]\n{milk}\n[media.ball]\n{ball_medium}\n{ball}{LAYER}{ABOVE}resolution = [4, 4]\n\
             [render]\nsimilarity = {similarity}\n"
        ));
        let media = &scene.frame.media;
        let of = |name: &str| {
            let Some(medium) = media.iter().find(|m| m.name == name) else { panic!("no {name}") };
            (medium.phase.clone(), medium.sigma_s.maximum())
        };
        (of("milk"), of("ball"), scene.frame.needs.similarity)
    };
    let forward = |scattering| {
        format!("scattering = {scattering}\nphase = {{ kind = \"henyey-greenstein\", g = 0.9 }}")
    };
    let is_off = |scattering: f32| (hg.clone(), scattering);
    // The layer's least edge is 1 m and the ball's 1 m: reduced optical sizes of 100 and 0.1.
    assert_eq!(phase(&forward(1000), &forward(1), 0), (is_off(1000.0), is_off(1.0), false));
    let (milk, thin, reported) = phase(&forward(1000), &forward(1), 1);
    assert_eq!((milk.0, thin, reported), (PhaseFunction::Isotropic(Isotropic).into(), is_off(1.0), true));
    assert!((milk.1 - 100.0).abs() < 0.01, "{}", milk.1);
    let (milk, ball, _) = phase(&forward(1), &forward(1000), 3);
    assert_eq!(milk, is_off(1.0));
    assert!(matches!(ball.0, MediumPhase::One(PhaseFunction::Tabulated(_))) && ball.1 < 500.0);
    let (rayleigh, _, reported) = phase("scattering = 1000\nphase = { kind = \"rayleigh\" }", &forward(1), 4);
    assert_eq!((rayleigh.1, reported), (1000.0, false));
    let (varied, _, reported) = phase(&(forward(1000) + "\ndensity = { stratified = 3 }"), &forward(1), 1);
    assert_eq!((varied, reported), (is_off(1000.0), false));
}
