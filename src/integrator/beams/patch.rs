//! A triangle of an interface as the sun's rays are bent by it.
//!
//! All is in the frame of the sun, (s, t) across its light and z along it, in double precision. With p and the interpolated
//! normal m linear in (u, v), n = m / |m| and w the direction to a point of the disc, the light goes on along
//!
//! ```text
//! d = -eta w + (eta mu - c) n,     mu = w . n,   c = sqrt(1 - eta^2 (1 - mu^2)),   eta = n_i / n_t       (Snell)
//! e = (d_s, d_t) / d_z                                                                the slope of a ray
//! g(u, v) = (x - p)_st - (x - p)_z e                                                  by which it misses x
//! ```
//! A single refraction turns light by less than a right angle, so d_z > 0 wherever the triangle is. Derivatives follow from
//! dn = (dm - n (n . dm)) / |m| and dc = eta^2 mu dmu / c.

use glam::{DMat2, DVec2, DVec3, Vec3};

use super::piece::Piece;
use crate::geometry::Frame as Basis;

/// The frame of the sun.
#[derive(Clone, Copy, Debug)]
pub(super) struct SunFrame {
    s: DVec3,
    t: DVec3,
    along: DVec3,
}

impl SunFrame {
    /// About the direction to the middle of the disc.
    pub(super) fn new(to_sun: Vec3) -> Self {
        let n = to_sun.as_dvec3().normalize();
        let rough = Basis::around(to_sun).s.as_dvec3();
        let s = (rough - n * n.dot(rough)).normalize();
        Self { s, t: n.cross(s), along: -n }
    }

    pub(super) fn local(&self, v: Vec3) -> DVec3 {
        self.turned(v.as_dvec3())
    }

    fn turned(&self, v: DVec3) -> DVec3 {
        DVec3::new(v.dot(self.s), v.dot(self.t), v.dot(self.along))
    }

    pub(super) fn world(&self, v: DVec3) -> Vec3 {
        (self.s * v.x + self.t * v.y + self.along * v.z).as_vec3()
    }
}

/// A triangle with its normals on the side of the sun.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    corner: DVec3,
    edges: [DVec3; 2],
    normal: DVec3,
    bends: [DVec3; 2],
    /// Their cross product, of twice the area.
    across: DVec3,
}

impl Patch {
    /// From corners and, where they are interpolated, normals; `side` is 1 when the right-hand normal is on the side of the
    /// sun and -1 otherwise.
    pub(super) fn new(frame: &SunFrame, v: &[Vec3; 3], normals: Option<[Vec3; 3]>, side: f64) -> Self {
        let [a, b, c] = v.map(|p| frame.local(p));
        let world = v.map(|p| p.as_dvec3());
        // In the world, whose handedness is that of the normals.
        let across = frame.turned((world[1] - world[0]).cross(world[2] - world[0])) * side;
        let (normal, bends) = match normals {
            Some(normals) => {
                let [a, b, c] = normals.map(|n| frame.local(n) * side);
                (a, [b - a, c - a])
            }
            None => (across.normalize_or(DVec3::NEG_Z), [DVec3::ZERO; 2]),
        };
        Self { corner: a, edges: [b - a, c - a], normal, bends, across }
    }

    /// True when all rays go on in the same direction.
    pub(super) fn is_flat(&self) -> bool {
        self.bends == [DVec3::ZERO; 2]
    }

    /// By how much the normals at the corners of a piece differ, at most.
    pub(super) fn turn(&self, piece: &Piece) -> f64 {
        let [a, b, c] = piece.corners.map(|uv| self.normal(uv));
        a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a)).sqrt()
    }

    /// The interpolated normal, of any length.
    pub(super) fn normal(&self, uv: DVec2) -> DVec3 {
        self.normal + self.bends[0] * uv.x + self.bends[1] * uv.y
    }

    /// From (u, v) to a point: rounding is that of how far it is from the triangle, not from the origin.
    fn way(&self, x: DVec3, uv: DVec2) -> DVec3 {
        (x - self.corner) - (self.edges[0] * uv.x + self.edges[1] * uv.y)
    }

    pub(super) fn at(&self, uv: DVec2) -> DVec3 {
        self.corner + self.edges[0] * uv.x + self.edges[1] * uv.y
    }
}

/// A ray of the sun behind a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bent {
    /// Direction of travel.
    pub(super) direction: DVec3,
    cos_i: f64,
    cos_t: f64,
    normal: DVec3,
    length: f64,
}

impl Bent {
    /// True where light arrives from the side of the normal.
    pub(super) fn is_lit(&self) -> bool {
        self.cos_i > 0.0
    }
}

/// A triangle, a point of the disc, and the point that is to be lit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Aim<'a> {
    pub(super) patch: &'a Patch,
    /// The point.
    pub(super) x: DVec3,
    /// Direction to the point of the disc.
    pub(super) to_sun: DVec3,
    /// Index on the side of the sun over that beyond.
    pub(super) eta: f64,
}

/// How a ray passes the point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pass {
    /// g of the head.
    pub(super) miss: DVec2,
    /// Its derivatives by u and v, as columns.
    pub(super) jacobian: DMat2,
    pub(super) bent: Bent,
    /// How far along the light the point lies behind the triangle.
    pub(super) depth: f64,
}

impl Aim<'_> {
    /// The refracted ray at (u, v); none where it is reflected totally. Where light arrives from behind the same formulas go on,
    /// so that what is smooth over a triangle stays so ([`Bent::is_lit`]).
    fn bent(&self, uv: DVec2) -> Option<Bent> {
        let patch = self.patch;
        let mixed = patch.normal(uv);
        let length = mixed.length();
        let normal = mixed / length;
        let cos_i = self.to_sun.dot(normal);
        let squared = 1.0 - self.eta * self.eta * (1.0 - cos_i * cos_i);
        let cos_t = squared.sqrt();
        let direction = -self.eta * self.to_sun + (self.eta * cos_i - cos_t) * normal;
        // Not a number, of a normal that vanishes, is none either.
        (squared > 0.0 && direction.z > 0.0).then_some(Bent { direction, cos_i, cos_t, normal, length })
    }

    /// By how much the ray at (u, v) misses the point.
    pub(super) fn miss(&self, uv: DVec2) -> Option<DVec2> {
        let d = self.bent(uv)?.direction;
        let way = self.patch.way(self.x, uv);
        Some(way.truncate() - d.truncate() * (way.z / d.z))
    }

    /// The same with all that depends on it.
    pub(super) fn pass(&self, uv: DVec2) -> Option<Pass> {
        let bent = self.bent(uv)?;
        let way = self.patch.way(self.x, uv);
        let d = bent.direction;
        let slope = d.truncate() / d.z;
        let column = |k: usize| {
            let edge = self.patch.edges[k];
            let turned = self.turned(&bent, self.patch.bends[k]);
            let slope_by = (turned.truncate() - slope * turned.z) / d.z;
            -edge.truncate() + slope * edge.z - slope_by * way.z
        };
        let jacobian = DMat2::from_cols(column(0), column(1));
        Some(Pass { miss: way.truncate() - slope * way.z, jacobian, bent, depth: way.z })
    }

    /// What the direction changes by with the normal.
    fn turned(&self, bent: &Bent, bend: DVec3) -> DVec3 {
        let n = bent.normal;
        let dn = (bend - n * n.dot(bend)) / bent.length;
        let by_cos = self.eta - self.eta * self.eta * bent.cos_i / bent.cos_t;
        (by_cos * self.to_sun.dot(dn)) * n + (self.eta * bent.cos_i - bent.cos_t) * dn
    }

    /// From where light is bent at (u, v) towards the point; none where it is reflected totally, or comes from behind.
    pub(super) fn source(&self, uv: DVec2) -> Option<DVec3> {
        let way = self.patch.way(self.x, uv);
        let (direction, normal) = (way.normalize(), self.patch.normal(uv).normalize());
        let cos_t = -direction.dot(normal);
        let across = -(direction + cos_t * normal) / self.eta; // Snell
        let squared = 1.0 - across.length_squared();
        (way.z > 0.0 && cos_t > 0.0 && squared > 0.0).then(|| across + squared.sqrt() * normal)
    }

    /// Solid angle of directions to the sun from which light comes to the point, over the area in (u, v) that bends it there.
    pub(super) fn sun_by_place(&self, pass: &Pass) -> f64 {
        let Bent { direction, cos_i, cos_t, .. } = pass.bent;
        let by_slope = direction.z.powi(3) * pass.jacobian.determinant().abs() / pass.depth.powi(2);
        by_slope * cos_t / (cos_i * self.eta * self.eta)
    }

    /// Irradiance across a ray at the point over that across the sun's light before the interface, without what is lost.
    pub(super) fn gathered(&self, pass: &Pass) -> f64 {
        let Bent { direction, cos_i, cos_t, .. } = pass.bent;
        let through = direction.dot(self.patch.across).abs() * cos_i / cos_t;
        through / (direction.z * pass.jacobian.determinant().abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A patch like those of waves, and a point half a metre behind it.
    fn wave() -> (SunFrame, Patch) {
        let frame = SunFrame::new(Vec3::new(0.3, -0.2, 0.8).normalize());
        let v = [Vec3::new(0.0, 0.0, 0.01), Vec3::new(0.1, 0.0, 0.0), Vec3::new(0.02, 0.09, 0.02)];
        let normals = [Vec3::new(0.1, 0.0, 1.0), Vec3::new(-0.2, 0.1, 1.0), Vec3::new(0.0, -0.2, 1.0)];
        (frame, Patch::new(&frame, &v, Some(normals.map(Vec3::normalize)), 1.0))
    }

    fn aim<'a>(frame: &SunFrame, patch: &'a Patch, x: Vec3) -> Aim<'a> {
        let to_sun = frame.local(Vec3::new(0.31, -0.2, 0.8)).normalize();
        Aim { patch, x: frame.local(x), to_sun, eta: 0.75 }
    }

    /// Central differences of step h are right to h^2 of the third derivative, 1e-10 here.
    #[test]
    fn derivatives_are_those_of_the_miss() {
        let (frame, patch) = wave();
        let aim = aim(&frame, &patch, Vec3::new(-0.1, 0.1, -0.5));
        let (uv, h) = (DVec2::new(0.3, 0.25), 1e-5);
        let pass = aim.pass(uv).unwrap();
        assert!((pass.miss - aim.miss(uv).unwrap()).length() < 1e-15);
        for (axis, column) in
            [DVec2::X, DVec2::Y].into_iter().zip([pass.jacobian.x_axis, pass.jacobian.y_axis])
        {
            let by = (aim.miss(uv + axis * h).unwrap() - aim.miss(uv - axis * h).unwrap()) / (2.0 * h);
            assert!((by - column).length() < 1e-8, "{by} {column}");
        }
    }

    /// What goes through a small piece of the triangle falls onto what its rays sweep at the point: the ratio of the two is
    /// the irradiance, whatever the normals are. With the triangle's own normal a projection of the sun's light is added.
    #[test]
    fn flux_through_a_piece_arrives_behind_it() {
        let (frame, patch) = wave();
        let aim = aim(&frame, &patch, Vec3::new(-0.1, 0.1, -0.5));
        let (uv, h) = (DVec2::new(0.3, 0.25), 1e-5);
        let pass = aim.pass(uv).unwrap();
        // Where the rays of three corners cross the plane of constant depth through the point.
        let at = |uv: DVec2| -aim.miss(uv).unwrap();
        let corners = [at(uv), at(uv + DVec2::X * h), at(uv + DVec2::Y * h)];
        let swept = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]).abs();
        // n_t^2 cos_t dw_t = n_i^2 cos_i dw_i at each point of the triangle, seen from the point.
        let d = pass.bent.direction;
        let flux = d.dot(patch.across).abs() * h * h * pass.bent.cos_i / pass.bent.cos_t;
        let expected = flux / (swept * d.z);
        assert!((aim.gathered(&pass) / expected - 1.0).abs() < 1e-3, "{} {expected}", aim.gathered(&pass));
    }

    /// A ray back from where a ray goes comes from where that came from, and how its source turns with the place is what central
    /// differences of step h tell, to h^2 of the third derivative.
    #[test]
    fn sources_turn_with_the_place_as_densities_say() {
        let (frame, patch) = wave();
        let (uv, h) = (DVec2::new(0.3, 0.25), 1e-5);
        for eta in [0.75, 1.3] {
            let aim = Aim { eta, ..aim(&frame, &patch, Vec3::ZERO) };
            let d = aim.pass(uv).unwrap().bent.direction;
            let aim = Aim { x: patch.at(uv) + d * (0.7 / d.z), ..aim };
            assert!((aim.source(uv).unwrap() - aim.to_sun).length() < 1e-14);
            let by =
                |step: DVec2| (aim.source(uv + step).unwrap() - aim.source(uv - step).unwrap()) / (2.0 * h);
            let expected = by(DVec2::X * h).cross(by(DVec2::Y * h)).length();
            let own = aim.sun_by_place(&aim.pass(uv).unwrap());
            assert!((own / expected - 1.0).abs() < 1e-7, "{eta}: {own} {expected}");
        }
    }
}
