//! The reference scenes by photon mapping, extrapolated to radius 0 from three radii, four seeds each.

use floe::integrator::{Integrator, PhotonMapper};
use floe::scene::description::PhotonDescription;
use glam::DVec3;

use crate::common::reference::{scene, statistics};
use crate::common::render::Prepared;
use crate::seeds::{Means, Seeds, scores, with_radius};

/// The scene of a name, by photons.
pub fn by_photons(name: &str, count: u32) -> Prepared {
    let mut scene = scene(name);
    let Integrator::Path(path) = scene.sampling.integrator else { panic!("{name} is not path traced") };
    let settings = PhotonDescription { count, ..PhotonDescription::default() };
    scene.sampling.integrator = Integrator::Photon(PhotonMapper { path, settings });
    scene
}

fn check(name: &str, count: u32, samples: u32, radius: f32) {
    let [near, middle, wide] = [1.0, 2.0, 4.0].map(|factor| {
        let scene = with_radius(by_photons(name, count), factor * radius);
        Seeds::render(&scene, samples, 4, [4, 3])
    });
    let reference: Means = statistics(name)
        .blocks_mean
        .iter()
        .flatten()
        .zip(statistics(name).blocks_se.iter().flatten())
        .map(|(mean, se)| (DVec3::from_array(*mean), DVec3::from_array(*se)))
        .collect();
    let means = Seeds::extrapolated(&near, &middle, &wide).means();
    let (rms, worst) = scores(&means, &reference);
    println!("{name}: rms z {rms:.2}, worst {worst:.2}");
    for ((mean, se), (expected, expected_se)) in means.iter().zip(&reference) {
        println!("  {:.4} +- {:.4} of {:.4} +- {:.4}", mean.y, se.y, expected.y, expected_se.y);
    }
    assert!(rms < 1.5 && worst < 4.5, "{name}: rms z {rms:.2}, worst {worst:.2}");
}

#[test]
#[ignore = "a minute or more"]
fn s04_an_index_matched_box() {
    check("s04_iso_box_null", 100_000, 64, 0.01);
}

#[test]
#[ignore = "a minute or more"]
fn s06_turbid_water_under_waves() {
    check("s06_turbid_wavy", 60_000, 64, 0.02);
}

/// Within the scores of its blocks, and its caustic, the two brightest blocks, within 2 %.
#[test]
#[ignore = "a minute or more"]
fn s08_a_caustic() {
    check("s08_caustic", 100_000, 96, 0.01);
}
