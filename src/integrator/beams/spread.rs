//! Where a triangle can send the light of the sun: bounds of the slopes of its refracted rays.
//!
//! The normals of a triangle lie in a cone of half angle phi about n0, the directions to the disc in one of alpha about s0. On
//! the way from (s0, n0) to any of them the refracted direction turns by no more than
//!
//! ```text
//! beta = L_n phi + L_s alpha,     L_n = |1 - eta cos_i / cos_t|,     L_s = max(eta, eta cos_i / cos_t)
//! ```
//! at the greatest angle of incidence, which is phi + alpha above that of s0 and n0: with theta_t' = eta cos_i / cos_t, turning
//! the normal in the plane of incidence turns the refracted ray by 1 - theta_t' of it, across that plane by cos_t of as
//! much; turning the incident ray turns it by theta_t' and by eta. Where the index varies over wavelength the arc between
//! the directions at both ends is added. A cone of half angle beta about the direction D has slopes
//!
//! ```text
//! tan(psi - a) to tan(psi + a),   psi = atan2(D_s, D_z),   sin(a) = sin(beta) / sqrt(D_s^2 + D_z^2)
//! ```
//! No refraction turns light by more than pi/2 - asin(min(eta, 1 / eta)), which bounds all slopes, also where nothing else does.

use std::f64::consts::FRAC_PI_2;

use glam::{DVec2, DVec3};

/// Bounds of slopes, each from the least to the greatest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slopes {
    pub(super) least: DVec2,
    pub(super) most: DVec2,
}

/// Rounding of what bounds are computed from: single precision has 6e-8.
const ROUNDING: f64 = 1e-6;

/// Normals of a triangle and directions to the sun's disc, in the frame of the sun.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fan {
    /// The middle of the normals.
    pub(super) normal: DVec3,
    /// Half angle of the cone about it that holds all of them.
    pub(super) phi: f64,
    /// Half angle of the disc.
    pub(super) alpha: f64,
    /// Least and greatest index on the side of the sun over that beyond.
    pub(super) eta: [f64; 2],
}

impl Fan {
    /// Of normals that need not have unit length; none where they have no common side.
    pub(super) fn new(normals: &[DVec3], alpha: f64, eta: [f64; 2]) -> Option<Self> {
        let normal = normals.iter().map(|n| n.normalize_or_zero()).sum::<DVec3>().try_normalize()?;
        let phi = normals.iter().map(|n| angle(normal, *n)).fold(0.0, f64::max) + ROUNDING;
        (phi < FRAC_PI_2).then_some(Self { normal, phi, alpha: alpha + ROUNDING, eta })
    }

    /// Least and greatest angle of incidence; none where all light comes from behind.
    fn incidence(&self) -> Option<[f64; 2]> {
        let middle = angle(self.normal, DVec3::NEG_Z);
        let wide = self.phi + self.alpha;
        (middle - wide < FRAC_PI_2).then(|| [(middle - wide).max(0.0), (middle + wide).min(FRAC_PI_2)])
    }

    /// True where some light of the disc arrives from the side of some normal.
    pub(super) fn is_lit(&self) -> bool {
        self.incidence().is_some()
    }

    /// The greatest angle between a refracted ray and the normal that it is bent about.
    pub(super) fn steepest(&self) -> f64 {
        let sine = libm::sin(self.incidence().map_or(FRAC_PI_2, |at| at[1])) * self.eta[1];
        if sine < 1.0 { libm::asin(sine) } else { FRAC_PI_2 }
    }

    /// Bounds of all slopes of refracted rays.
    pub(super) fn slopes(&self) -> Slopes {
        let turned = self.eta.map(|eta| FRAC_PI_2 - libm::asin(eta.min(1.0 / eta)));
        let widest = turned[0].max(turned[1]) + self.alpha;
        let bound = if widest < FRAC_PI_2 - ROUNDING { libm::tan(widest) } else { f64::MAX };
        let all = Slopes { least: DVec2::splat(-bound), most: DVec2::splat(bound) };
        match self.cone().and_then(|(direction, beta)| slopes_of_cone(direction, beta)) {
            None => all,
            Some(own) => Slopes { least: own.least.max(all.least), most: own.most.min(all.most) },
        }
    }

    /// A cone that holds the refracted rays; none near total reflection or where light comes from behind.
    fn cone(&self) -> Option<(DVec3, f64)> {
        let [_, greatest] = self.incidence()?;
        let middle = refracted(self.normal, 0.5 * (self.eta[0] + self.eta[1]))?;
        let mut beta = 0.0_f64;
        for eta in self.eta {
            let (sine, cos_i) = (eta * libm::sin(greatest), libm::cos(greatest));
            if sine >= 1.0 - ROUNDING {
                return None;
            }
            let by_ray = eta * cos_i / ((1.0 - sine) * (1.0 + sine)).sqrt();
            let own = (1.0 - by_ray).abs().max((1.0 - eta).abs()) * self.phi
                + by_ray.max(eta) * self.alpha
                + angle(middle, refracted(self.normal, eta)?);
            beta = beta.max(own);
        }
        Some((middle, beta + ROUNDING))
    }
}

/// Slopes of a cone; none where it reaches a right angle from the sun's light.
fn slopes_of_cone(direction: DVec3, beta: f64) -> Option<Slopes> {
    if beta >= FRAC_PI_2 {
        return None;
    }
    let range = |across: f64| {
        let sine = libm::sin(beta) / (across * across + direction.z * direction.z).sqrt();
        let wide = if sine < 1.0 { libm::asin(sine) } else { FRAC_PI_2 };
        let psi = libm::atan2(across, direction.z);
        let ends = [psi - wide, psi + wide];
        ends.iter().all(|end| end.abs() < FRAC_PI_2 - ROUNDING).then(|| ends.map(libm::tan))
    };
    let ([a, b], [c, d]) = (range(direction.x)?, range(direction.y)?);
    Some(Slopes { least: DVec2::new(a, c), most: DVec2::new(b, d) })
}

/// Where light from the middle of the disc goes on behind a normal.
fn refracted(normal: DVec3, eta: f64) -> Option<DVec3> {
    let cos_i = -normal.z;
    let squared = 1.0 - eta * eta * (1.0 - cos_i * cos_i);
    (cos_i > 0.0 && squared > 0.0)
        .then(|| DVec3::new(0.0, 0.0, eta) + (eta * cos_i - squared.sqrt()) * normal)
}

/// The angle between two vectors, exact for small ones.
pub(super) fn angle(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

#[cfg(test)]
mod tests {
    use super::super::patch::{Aim, Patch, SunFrame};
    use super::*;
    use crate::sampling::{SampleSeed, SampleStream};
    use glam::Vec3;

    /// No ray of any point of the disc through any point of a triangle leaves the bounds, at indices on both sides of 1 and
    /// normals that lean up to a right angle from the sun and from each other; and the bounds are not idle: rays come near
    /// them.
    #[test]
    fn slopes_hold_all_rays() {
        let (mut rays, mut filled) = (0_u32, 0.0_f64);
        let mut finite = 0_u32;
        for i in 0..3000 {
            let mut stream = SampleStream::new(SampleSeed::new(5), i, 0, 0);
            let mut vector = || {
                let [x, y, z, w] = stream.next4();
                (Vec3::new(x, y, z) * 2.0 - 1.0, w)
            };
            let frame = SunFrame::new(vector().0.normalize());
            let leans = [0.01, 0.1, 0.5][i as usize % 3];
            let (middle, eta) = vector();
            let eta = [0.75, 0.4 + f64::from(eta), 1.2][i as usize / 3 % 3];
            let normals = [0; 3].map(|_| (middle.normalize() + leans * vector().0).normalize());
            let corners = [0; 3].map(|_| vector().0);
            let local = normals.map(|n| frame.local(n));
            let alpha = [0.0046, 0.1][i as usize / 9 % 2];
            let Some(fan) = Fan::new(&local, alpha, [eta * 0.99, eta * 1.01]) else { continue };
            let slopes = fan.slopes();
            let patch = Patch::new(&frame, &corners, Some(normals), 1.0);
            let (mut least, mut most) = (DVec2::MAX, DVec2::MIN);
            for k in 0..40_u32 {
                let [a, b, turn, out] = SampleStream::new(SampleSeed::new(6), i, k, 0).next4().map(f64::from);
                let uv = if k < 3 {
                    [DVec2::ZERO, DVec2::X, DVec2::Y][k as usize]
                } else {
                    DVec2::new(a * (1.0 - b), b)
                };
                let off = libm::tan(alpha * out.sqrt());
                let (sin, cos) = (libm::sin(6.3 * turn), libm::cos(6.3 * turn));
                let to_sun = DVec3::new(off * cos, off * sin, -1.0).normalize();
                let aim = Aim { patch: &patch, x: DVec3::ZERO, to_sun, eta: eta * (0.99 + 0.02 * out) };
                let Some(pass) = aim.pass(uv) else { continue };
                let d = pass.bent.direction;
                let slope = d.truncate() / d.z;
                assert!(d.z > 0.0 && fan.is_lit(), "{i}: {d}");
                assert!(
                    slope.cmpge(slopes.least).all() && slope.cmple(slopes.most).all(),
                    "{i}: {slope} {slopes:?}"
                );
                (least, most) = (least.min(slope), most.max(slope));
                rays += 1;
            }
            let wide = (slopes.most - slopes.least).max_element();
            if (most - least).min_element() > 0.0 && wide < 10.0 {
                finite += 1;
                filled += (most - least).max_element() / wide;
            }
        }
        assert!(rays > 30_000 && finite > 500, "{rays} {finite}");
        assert!(filled / f64::from(finite) > 0.2, "{}", filled / f64::from(finite));
    }
}
