//! Triangles that the sun does not shine on.
//!
//! Where water is closed behind the walls of a basin, most of what could bend light lies in the dark. A piece is in the shade
//! of an opaque triangle when rays from its corners to the corners of a square around the disc all meet that triangle: where
//! a ray meets a plane is linear in where it begins, and projective in its direction, so that all other rays meet it between.

use glam::{DVec3, Vec3};

use super::piece::Piece;
use crate::accel::Ignored;
use crate::geometry::{Frame as Basis, Ray};
use crate::light::Sun;
use crate::scene::frame::Frame;
use crate::scene::surface::Surface;

/// What stands between the sun and the surfaces of a frame.
pub(super) struct Shade<'a> {
    /// None where nothing casts a shadow for certain.
    frame: Option<&'a Frame>,
    to_sun: Vec3,
    /// Directions to a square around the disc.
    square: [DVec3; 4],
}

/// Rays must meet a triangle so far from its edges, in barycentric weights.
const WITHIN: f64 = 1e-5;

impl<'a> Shade<'a> {
    pub(super) fn new(frame: &'a Frame, sun: &Sun) -> Self {
        let to_sun = sun.direction();
        let square = square_around(to_sun, sun.half_angle());
        let stands = frame.views.time(0.0) == frame.views.time(1.0);
        let has_any = (0..frame.geometry.triangles.len() as u32).any(|id| is_opaque(frame, id));
        Self { frame: Some(frame).filter(|_| stands && has_any), to_sun, square }
    }

    /// True for a piece of a triangle that no light of the disc comes to.
    pub(super) fn covers(&self, triangle: u32, piece: &Piece) -> bool {
        let Some(frame) = self.frame else { return false };
        let [a, b, c] = frame.geometry.vertices(triangle).map(|p| p.as_dvec3());
        let at = |weights: glam::DVec2| a + (b - a) * weights.x + (c - a) * weights.y;
        let corners = piece.corners.map(at);
        let ray = Ray::new(at(piece.centre()).as_vec3(), self.to_sun).at_time(frame.views.time(0.0));
        let mut is_covered = false;
        frame.accel.each_hit(&ray, Ignored::one(triangle), |hit| {
            is_covered = is_opaque(frame, hit.triangle) && self.is_between(frame, hit.triangle, &corners);
            is_covered
        });
        is_covered
    }

    fn is_between(&self, frame: &Frame, triangle: u32, corners: &[DVec3; 3]) -> bool {
        let v = frame.geometry.vertices(triangle).map(|p| p.as_dvec3());
        stops_all(&v, corners, &self.square)
    }
}

/// Directions to the corners of a square that holds the disc, a little wider than it.
fn square_around(to_sun: Vec3, half_angle: f32) -> [DVec3; 4] {
    let basis = Basis::around(to_sun);
    let wide = 1.001 * f64::from(libm::tanf(half_angle));
    [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)]
        .map(|(a, b)| to_sun.as_dvec3() + wide * (a * basis.s.as_dvec3() + b * basis.t.as_dvec3()))
}

/// True where all rays from between these corners along what is between these directions meet a triangle.
fn stops_all(v: &[DVec3; 3], corners: &[DVec3; 3], square: &[DVec3; 4]) -> bool {
    corners.iter().all(|&from| square.iter().all(|&along| meets(v, from, along)))
}

fn is_opaque(frame: &Frame, triangle: u32) -> bool {
    matches!(
        frame.surface(triangle),
        Surface::Diffuse { .. } | Surface::Conductor { .. } | Surface::Emitter { .. }
    )
}

/// True where a ray meets a triangle well within its edges.
fn meets([a, b, c]: &[DVec3; 3], from: DVec3, along: DVec3) -> bool {
    let (ab, ac) = (*b - *a, *c - *a);
    let across = along.cross(ac);
    let volume = ab.dot(across);
    let u = (from - *a).dot(across) / volume;
    let side = (from - *a).cross(ab);
    let (v, t) = (along.dot(side) / volume, ac.dot(side) / volume);
    // Not a number, of a ray in the plane, is none of these.
    u > WITHIN && v > WITHIN && u + v < 1.0 - WITHIN && t > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{SampleSeed, SampleStream, warp};

    #[test]
    fn rays_meet_triangles_in_front_of_them() {
        let v = [DVec3::new(0.0, 0.0, 1.0), DVec3::new(1.0, 0.0, 1.0), DVec3::new(0.0, 1.0, 1.0)];
        let along = DVec3::new(0.1, -0.1, 1.0);
        assert!(meets(&v, DVec3::new(0.2, 0.4, 0.0), along));
        assert!(!meets(&v, DVec3::new(0.2, 0.4, 2.0), along), "behind it");
        assert!(!meets(&v, DVec3::new(0.6, 0.6, 0.0), along), "beside it");
        assert!(!meets(&v, DVec3::new(0.2, 0.05, 0.0), along), "beyond the edge that the ray leans across");
        assert!(!meets(&v, DVec3::new(0.2, 0.4, 1.0), DVec3::X), "within its plane");
    }

    /// Small pieces near the edges of the shadows of triangles, under discs half a degree to 10 degrees wide: of one that is in
    /// the shade no ray from any point of it to any point of the disc gets past. Many are, and many are not.
    #[test]
    fn nothing_of_the_disc_is_seen_from_the_shade() {
        let (mut shaded, mut cases) = (0, 0);
        for i in 0..20_000 {
            let mut stream = SampleStream::new(SampleSeed::new(23), i, 0, 0);
            let mut numbers = || stream.next4();
            let mut vector =
                || DVec3::from_array(numbers().map(f64::from)[..3].try_into().unwrap()) * 2.0 - 1.0;
            let to_sun = vector().as_vec3().normalize();
            let half_angle = [0.0046_f32, 0.02, 0.09][i as usize % 3];
            let v = [vector(), vector(), vector()];
            let (middle, far) = ((v[0] + v[1] + v[2]) / 3.0, 0.05 + vector().x.abs());
            let below = middle + 0.4 * vector() - to_sun.as_dvec3() * far;
            let corners = [0; 3].map(|_| below + 0.05 * vector());
            cases += 1;
            if !stops_all(&v, &corners, &square_around(to_sun, half_angle)) {
                continue;
            }
            shaded += 1;
            let basis = Basis::around(to_sun);
            for _ in 0..20 {
                let [a, b, x, y] = numbers().map(f64::from);
                let (a, b) = if a + b > 1.0 { (1.0 - a, 1.0 - b) } else { (a, b) };
                let from = corners[0] + (corners[1] - corners[0]) * a + (corners[2] - corners[0]) * b;
                let rim = 1.0 - libm::cosf(half_angle);
                let along = basis.to_world(warp::cone([x as f32, y as f32], rim)).as_dvec3();
                assert!(meets(&v, from, along), "{i}: {from} {along}");
            }
        }
        assert!(shaded * 20 > cases && shaded * 2 < cases, "{shaded} of {cases}");
    }
}
