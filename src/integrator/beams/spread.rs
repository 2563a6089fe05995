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
//!
//! Where normals turn little the slopes at the corners tell more. With m = sum l_i m_i, n = m / |m|, tau the greatest distance
//! of two m_i over the least |m|, mu = w . n and c = cos_t, along a line of the triangle
//!
//! ```text
//! |n'| <= tau,   |n''| <= sqrt(5) tau^2,   d = -eta w + f n,   f = eta mu - c,   f' = eta (1 - eta mu / c),   f'' = eta^2 (eta^2 - 1) / c^3
//! |d'| <= sqrt(f^2 + f'^2) tau,   |d''| <= (|f''| + (2 + sqrt(5)) |f'| + sqrt(5) |f|) tau^2
//! |e''| <= |d''| / d_z^2 + 2 |d'|^2 / d_z^3,      |e - sum l_i e_i| <= max |e''| / 4
//! ```
//! for the slope e = d_st / d_z, as |d| = 1 and half the sum of l_i l_j |m_i - m_j|^2 over all pairs is below a quarter of tau^2.
//! All of f, f', f'' and 1 / d_z are greatest at the greatest angle of incidence.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec2, DVec3};

/// Bounds of slopes, each from the least to the greatest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slopes {
    pub(super) least: DVec2,
    pub(super) most: DVec2,
}

impl Slopes {
    /// Those of all refracted rays, whatever the normals are.
    pub(super) fn widest(eta: [f64; 2], alpha: f64) -> Self {
        let turned = eta.map(|eta| FRAC_PI_2 - libm::asin(eta.min(1.0 / eta)));
        let widest = turned[0].max(turned[1]) + alpha;
        let bound = if widest < FRAC_PI_2 - ROUNDING { libm::tan(widest) } else { f64::MAX };
        Self { least: DVec2::splat(-bound), most: DVec2::splat(bound) }
    }
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
    /// tau of the head.
    tau: f64,
    /// Least and greatest slope of rays from the middle of the disc about the normals that it was made of.
    corners: [DVec2; 2],
}

impl Fan {
    /// Of normals that need not have unit length; none where they have no common side.
    pub(super) fn new(normals: &[DVec3], alpha: f64, eta: [f64; 2]) -> Option<Self> {
        let normal = normals.iter().map(|n| n.normalize_or_zero()).sum::<DVec3>().try_normalize()?;
        let phi = normals.iter().map(|n| angle(normal, *n)).fold(0.0, f64::max) + ROUNDING;
        if phi >= FRAC_PI_2 {
            return None;
        }
        let shortest = normals.iter().map(|n| n.dot(normal)).fold(f64::MAX, f64::min);
        let pairs = normals.iter().flat_map(|a| normals.iter().map(|b| a.distance(*b)));
        let tau = pairs.fold(0.0, f64::max) / shortest + ROUNDING;
        let mut corners = [DVec2::MAX, DVec2::MIN];
        for n in normals {
            for eta in eta {
                let slope = slope_about(n.normalize_or_zero(), eta);
                corners = [corners[0].min(slope), corners[1].max(slope)];
            }
        }
        Some(Self { normal, phi, alpha: alpha + ROUNDING, eta, tau, corners })
    }

    /// Least and greatest angle of incidence; none where all light comes from behind.
    fn incidence(&self) -> Option<[f64; 2]> {
        let middle = angle(self.normal, DVec3::NEG_Z);
        let wide = self.phi + self.alpha;
        (middle - wide < FRAC_PI_2).then(|| [(middle - wide).max(0.0), (middle + wide).min(FRAC_PI_2)])
    }

    /// True where some light of the disc arrives from the side of some normal.
    pub(super) fn faces_the_sun(&self) -> bool {
        self.incidence().is_some()
    }

    /// True where some light of the disc arrives from the side of some normal and may be refracted.
    pub(super) fn is_lit(&self) -> bool {
        self.incidence().is_some_and(|[least, _]| self.eta[0] * libm::sin(least) < 1.0)
    }

    /// The greatest angle between a refracted ray and the normal that it is bent about.
    pub(super) fn steepest(&self) -> f64 {
        let sine = libm::sin(self.incidence().map_or(FRAC_PI_2, |at| at[1])) * self.eta[1];
        if sine < 1.0 { libm::asin(sine) } else { FRAC_PI_2 }
    }

    /// Bounds of all slopes of refracted rays.
    pub(super) fn slopes(&self) -> Slopes {
        let of_cone = self.cone().and_then(|(direction, beta)| slopes_of_cone(direction, beta));
        let of_corners = self.bends().map(|bends| {
            let [least, most] = self.corners;
            let beyond = bends.bulge + bends.by_ray + ROUNDING;
            Slopes { least: least - beyond, most: most + beyond }
        });
        let all = Slopes::widest(self.eta, self.alpha);
        of_cone
            .into_iter()
            .chain(of_corners)
            .fold(all, |all, own| Slopes { least: own.least.max(all.least), most: own.most.min(all.most) })
    }

    /// How far slopes are from what is linear between the corners, at most; infinite where nothing tells.
    pub(super) fn bulge(&self) -> f64 {
        self.bends().map_or(f64::INFINITY, |bends| bends.bulge)
    }

    /// How far the slopes of all rays of the disc are from that, at most.
    pub(super) fn loose(&self) -> f64 {
        self.bends().map_or(f64::INFINITY, |bends| bends.bulge + bends.by_ray)
    }

    /// Slopes of the rays from the middle of the disc about a normal, at both ends of the index.
    pub(super) fn slopes_about(&self, normal: DVec3) -> [DVec2; 2] {
        self.eta.map(|eta| slope_about(normal.normalize_or_zero(), eta))
    }

    /// What curves and widens the slopes; none near total reflection.
    fn bends(&self) -> Option<Bends> {
        let greatest = (angle(self.normal, DVec3::NEG_Z) + self.phi + self.alpha).min(PI);
        let (sin, mu) = (libm::sin(greatest.min(FRAC_PI_2)), libm::cos(greatest));
        let mut all = Bends { bulge: 0.0, by_ray: 0.0 };
        for eta in self.eta {
            let least_squared = 1.0 - eta * eta * sin * sin;
            if least_squared < 1e-3 {
                return None;
            }
            // Where normals face away from the sun c grows again, and what bounds the rest goes on.
            let (least_c, c) = (least_squared.sqrt(), (1.0 - eta * eta * (1.0 - mu * mu)).sqrt());
            let f = eta * mu - c;
            let f1 = eta * (1.0 - eta * mu / c);
            let f2 = eta * eta * (eta * eta - 1.0) / least_c.powi(3);
            let d_z = eta - f * mu - self.alpha;
            if d_z < 0.1 {
                return None;
            }
            let root = 5.0_f64.sqrt();
            let d2 = f2.abs() + (2.0 + root) * f1.abs() + root * f.abs();
            let e2 = d2 / d_z.powi(2) + 2.0 * (f * f + f1 * f1) / d_z.powi(3);
            let by_ray = eta.max(eta * mu.max(0.0) / least_c) * self.alpha / d_z.powi(2);
            all = Bends {
                bulge: all.bulge.max(0.25 * e2 * self.tau * self.tau),
                by_ray: all.by_ray.max(by_ray),
            };
        }
        Some(all)
    }

    /// A cone that holds the refracted rays; none near total reflection.
    ///
    /// Where the middle normal faces away from the sun, the nearest one that light still grazes takes its place.
    fn cone(&self) -> Option<(DVec3, f64)> {
        let [_, greatest] = self.incidence()?;
        let normal = self.normal.with_z(self.normal.z.min(0.0)).try_normalize()?;
        let phi = self.phi + angle(self.normal, normal);
        let middle = refracted(normal, 0.5 * (self.eta[0] + self.eta[1]))?;
        let mut beta = 0.0_f64;
        for eta in self.eta {
            let (sine, cos_i) = (eta * libm::sin(greatest), libm::cos(greatest));
            if sine >= 1.0 - ROUNDING {
                return None;
            }
            let cos_t = ((1.0 - sine) * (1.0 + sine)).sqrt();
            let by_ray = eta * cos_i / cos_t;
            // A normal that one point of the disc grazes may face away from another.
            let from_behind =
                if greatest < FRAC_PI_2 { 0.0 } else { 1.0 + eta * libm::sin(self.alpha) / cos_t };
            let own = (1.0 - by_ray).abs().max((1.0 - eta).abs()).max(from_behind) * phi
                + by_ray.max(eta) * self.alpha
                + angle(middle, refracted(normal, eta)?);
            beta = beta.max(own);
        }
        Some((middle, beta + ROUNDING))
    }
}

/// How far slopes are from those of the middle of the disc, linear between the corners.
struct Bends {
    /// Because normals turn.
    bulge: f64,
    /// Because the disc is wide.
    by_ray: f64,
}

/// The slope of a ray from the middle of the disc behind a normal, also of one that faces away.
pub(super) fn slope_about(normal: DVec3, eta: f64) -> DVec2 {
    let mu = -normal.z;
    let c = (1.0 - eta * eta * (1.0 - mu * mu)).max(0.0).sqrt();
    let d = DVec3::new(0.0, 0.0, eta) + (eta * mu - c) * normal;
    d.truncate() / d.z
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
pub(super) fn refracted(normal: DVec3, eta: f64) -> Option<DVec3> {
    let cos_i = -normal.z;
    let squared = 1.0 - eta * eta * (1.0 - cos_i * cos_i);
    (cos_i >= 0.0 && squared > 0.0)
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

    /// The same for fans of any index, of three normals or six, of any length, and discs up to 17 degrees wide on each side.
    #[test]
    fn slopes_hold_all_rays_of_any_fan() {
        let (mut lost, mut rays) = (0_u32, 0_u32);
        for i in 0..100_000_u32 {
            let mut stream = SampleStream::new(SampleSeed::new(77), i, 0, 0);
            let mut numbers = || stream.next4().map(f64::from);
            let vector = |[x, y, z, _]: [f64; 4]| DVec3::new(x, y, z) * 2.0 - 1.0;
            let lean = [0.01, 0.05, 0.2, 0.5, 1.0][i as usize % 5];
            let alpha = [0.0046, 0.05, 0.1, 0.3][i as usize / 5 % 4];
            let towards_sun = if i % 2 == 0 { 1.2 } else { 0.0 };
            let middle = (vector(numbers()) - DVec3::Z * towards_sun).normalize();
            let [at, wide, ..] = numbers();
            let (eta, wide) = (0.4 + 2.1 * at, 0.03 * wide);
            let range = [eta * (1.0 - wide), eta * (1.0 + wide)];
            let normals: Vec<DVec3> = (0..if i % 4 < 2 { 6 } else { 3 })
                .map(|_| (middle + lean * vector(numbers())).normalize() * (0.8 + 0.4 * numbers()[0]))
                .collect();
            let Some(fan) = Fan::new(&normals, alpha, range) else { continue };
            let slopes = fan.slopes();
            for k in 0..40 {
                let mixed = normals.iter().map(|n| *n * numbers()[0].powi(2)).sum::<DVec3>();
                let normal = normals.get(k).copied().unwrap_or(mixed).normalize();
                let [x, y, out, along] = numbers();
                let off = (DVec2::new(x, y) - 0.5).normalize() * libm::tan(alpha * out.sqrt());
                let to_sun = off.extend(-1.0).normalize();
                let (eta, mu) = (range[0] + (range[1] - range[0]) * along, to_sun.dot(normal));
                let squared = 1.0 - eta * eta * (1.0 - mu * mu);
                if !(mu > 0.0 && squared > 0.0) {
                    continue;
                }
                let d = -eta * to_sun + (eta * mu - squared.sqrt()) * normal;
                let slope = d.truncate() / d.z;
                let holds = slope.cmpge(slopes.least).all() && slope.cmple(slopes.most).all();
                rays += 1;
                lost += u32::from(!(d.z > 0.0 && fan.is_lit() && holds));
            }
        }
        assert!(lost == 0 && rays > 1_000_000, "{lost} of {rays}");
    }

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
                let Some(pass) = aim.pass(uv).filter(|pass| pass.bent.is_lit()) else { continue };
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
