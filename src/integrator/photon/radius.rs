//! Radii of density estimation: the first one, and how it shrinks.
//!
//! ```text
//! r_(i+1)^2 / r_i^2 = (i + alpha) / (i + 1),   i = 1, 2, ..           [KNAUS11 eq. 15]
//! ```
//! The mean of all passes then converges: with alpha = 2/3 its bias falls as pass^(-1/3) and its variance as
//! pass^(-2/3). That holds for surfaces, and for beams in media too, since both blur over two dimensions.
//!
//! The first radius, unless the scene gives it, is the median distance of photons to the k-th nearest other one.

use super::map::{Photon, PhotonMap};

/// Photons that the first radius takes in on surfaces.
const NEIGHBOURS: f32 = 32.0;
/// Photons whose neighbours are looked at.
const PROBES: usize = 65;

/// Radii in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Radii {
    /// On surfaces, of light that only specular surfaces have turned.
    pub caustic: f32,
    /// On surfaces, of other light.
    pub global: f32,
    /// Around rays in media.
    pub volume: f32,
}

impl Radii {
    /// The radii of pass `pass`, counted from 0, that began as `self`.
    #[must_use]
    pub fn shrunk(self, pass: u32, alpha: f64) -> Self {
        let factor = shrinkage(pass, alpha) as f32;
        Self { caustic: self.caustic * factor, global: self.global * factor, volume: self.volume * factor }
    }
}

/// The product of the ratios of the first `pass` steps, as a ratio of gamma functions: it takes no loop, so that every
/// pass can be rendered alone.
fn shrinkage(pass: u32, alpha: f64) -> f64 {
    let i = f64::from(pass);
    let log = libm::lgamma(i + 1.0 + alpha) - libm::lgamma(1.0 + alpha) - libm::lgamma(i + 2.0);
    libm::exp(0.5 * log)
}

/// The median distance of photons to their k-th nearest neighbours, where k is 32 times `share`, as for [`holding`].
///
/// `share` is the number of photons over that of a whole pass.
pub(super) fn natural(photons: &[Photon], share: f32) -> Option<f32> {
    holding(photons, NEIGHBOURS * share)
}

/// The median distance of photons to their k-th nearest neighbours, where k is what is wanted (at least 4), scaled
/// to as many of a plane; `None` with too few photons. Where photons are spread unevenly those of spread 1 tell.
pub(in crate::integrator) fn holding(photons: &[Photon], wanted: f32) -> Option<f32> {
    let even: Vec<Photon> = photons.iter().filter(|p| p.spread < 1.5).copied().collect();
    let map = &PhotonMap::new(&even, 0.0);
    let k = (wanted.round() as usize).max(4);
    if map.len() <= 2 * k {
        return None;
    }
    let mut distances: Vec<f32> =
        (0..PROBES).map(|probe| kth_distance(map, probe * (map.len() - 1) / (PROBES - 1), k)).collect();
    distances.sort_unstable_by(f32::total_cmp);
    let median = distances[PROBES / 2];
    (median > 0.0).then_some(median * (wanted / k as f32).sqrt())
}

/// Distance of the photon in place `at` to the k-th nearest other: the ball grows until it holds enough.
fn kth_distance(map: &PhotonMap, at: usize, k: usize) -> f32 {
    let photons = map.photons();
    let centre = photons[at].position;
    // Neighbours on the curve are a first guess.
    let other = photons[if at + k < photons.len() { at + k } else { at - k }].position;
    let mut radius = centre.distance(other).max(1e-6 * centre.abs().max_element()).max(f32::MIN_POSITIVE);
    let mut squares = Vec::new();
    loop {
        squares.clear();
        map.each_around(centre, radius, |_, squared, _| squares.push(squared));
        if squares.len() > k || !radius.is_finite() {
            break;
        }
        radius *= 2.0;
    }
    squares.sort_unstable_by(f32::total_cmp);
    squares.get(k).copied().unwrap_or(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::medium::MediumId;
    use crate::spectrum::Lanes;
    use glam::Vec3;

    #[test]
    fn radii_shrink_as_the_recurrence_says() {
        for alpha in [0.5, 2.0 / 3.0, 1.0] {
            let mut squared = 1.0;
            for i in 1..200_u32 {
                let expected = shrinkage(i - 1, alpha);
                assert!((expected * expected / squared - 1.0).abs() < 1e-12, "{alpha} {i}");
                squared *= (f64::from(i) + alpha) / (f64::from(i) + 1.0);
            }
        }
        assert_eq!(shrinkage(1000, 1.0), 1.0);
        // r^2 falls as i^(alpha - 1).
        let fall = shrinkage(80_000, 2.0 / 3.0) / shrinkage(10_000, 2.0 / 3.0);
        assert!((fall - 8.0_f64.powf(-1.0 / 6.0)).abs() < 1e-4, "{fall}");
    }

    /// On a square lattice of spacing h a disc holds pi r^2 / h^2 points.
    #[test]
    fn the_first_radius_takes_in_its_photons() {
        let photon = |i: u32| Photon {
            position: Vec3::new((i % 100) as f32, (i / 100) as f32, 0.0),
            direction: Vec3::NEG_Z,
            normal: Vec3::Z,
            medium: MediumId(0),
            flux: Lanes::ONE,
            scattered: true,
            spread: 1.0,
        };
        let lattice: Vec<Photon> = (0..10_000).map(photon).collect();
        for share in [1.0, 0.5, 0.05] {
            let radius = natural(&lattice, share).unwrap();
            let held = std::f32::consts::PI * radius * radius;
            assert!((held / (32.0 * share) - 1.0).abs() < 0.3, "{share}: {held}");
        }
        assert!(natural(&[photon(1); 20], 1.0).is_none());
    }
}
