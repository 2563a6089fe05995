//! All rays that a triangle bends from a point of the sun's disc to a point behind it.
//!
//! g of [`super::patch`] is zero for these. Over a piece of the triangle it is taken for the quadratic q through its values
//! at the corners and the middles of the edges, in Bernstein form:
//!
//! ```text
//! q(l) = sum_ij b_ij l_i l_j,   b_ii = g_i,   b_ij = 2 g(middle) - (g_i + g_j) / 2
//! ```
//! Where the box of the b_ij, wider by their distance from the linear interpolant, does not hold 0 there is no root. The
//! determinant of the Jacobian of q is quadratic, too. Where all its Bernstein coefficients have one sign, and none is
//! small beside the greatest, the map has no fold and Newton's method finds its one root; other pieces, and those where it does
//! not get anywhere, are cut into four. So
//! both roots at a fold within a triangle are found, unless they are closer than 2^-[`MOST_CUTS`] of it.
//!
//! A root on an edge belongs to the triangle into which an infinitesimal shift of the point by [`SHIFT`] moves it, which is
//! one of two neighbours, or one of all around a corner; at a fold along an edge it is both or none, as on its two sides.

use glam::{DVec2, DVec3};

use super::index::Reach;
use super::patch::{Aim, Pass};
use super::piece::Piece;
use super::spread::{Fan, angle};

/// A ray that meets the point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Root {
    /// Weights of the second and the third corner.
    pub(super) uv: DVec2,
    pub(super) pass: Pass,
}

/// Pieces are cut so often.
const MOST_CUTS: u32 = 6;
/// And no more pieces are looked at: at a focus all rays meet the point.
const MOST_PIECES: u32 = 400;
/// Over pieces whose normals differ by more than this, in radians, the miss is not taken for quadratic.
pub(super) const STRAIGHT: f64 = 0.4;
/// Greatest over least coefficient of the determinant where no fold is feared.
const STEADY: f64 = 16.0;
/// Roots closer than this are the same, found from two pieces.
const SAME: f64 = 1e-8;
/// No edge of a scene has this very direction.
const SHIFT: DVec2 = DVec2::new(1.0, 0.618_033_988_749_895);

/// Finds all roots in a piece of a triangle.
pub(super) fn find(aim: &Aim, whole: &Piece, roots: &mut Vec<Root>) {
    roots.clear();
    if aim.patch.is_flat() {
        // Linear: one step is all.
        add(&newton(aim, whole.centre()), whole, roots);
        return;
    }
    // Each cut puts four in the place of one.
    // A piece was cut into halves: two of these are worth one of ours.
    let mut pieces = [Piece { cuts: whole.cuts / 2, ..*whole }; 3 * MOST_CUTS as usize + 1];
    let (mut waiting, mut looks) = (1, 0);
    while waiting > 0 {
        (waiting, looks) = (waiting - 1, looks + 1);
        let piece = pieces[waiting];
        let is_last = piece.cuts == MOST_CUTS || looks > MOST_PIECES;
        let is_known = aim.patch.turn(&piece) < STRAIGHT;
        let found = match piece.look(aim) {
            _ if !is_known && !is_last && piece.reaches(aim) => Search::Lost,
            _ if !is_known && !is_last => Search::Outside,
            Look::Nothing => Search::Outside,
            Look::Steady(start) => newton(aim, start),
            Look::Folded if is_last => newton(aim, piece.centre()),
            Look::Folded => Search::Lost,
        };
        add(&found, whole, roots);
        if matches!(found, Search::Lost) && !is_last {
            pieces[waiting..waiting + 4].copy_from_slice(&piece.cut());
            waiting += 4;
        }
    }
}

fn add(found: &Search, whole: &Piece, roots: &mut Vec<Root>) {
    let Search::Found(root) = *found else { return };
    if is_within(&root, whole) && roots.iter().all(|other| other.uv.distance_squared(root.uv) > SAME * SAME) {
        roots.push(root);
    }
}

/// What is known of a piece.
enum Look {
    Nothing,
    /// At most one root, about here.
    Steady(DVec2),
    Folded,
}

impl Piece {
    /// False where the bounds of [`Fan`] tell that no ray of the piece comes to the point.
    fn reaches(&self, aim: &Aim) -> bool {
        let normals = self.corners.map(|uv| aim.patch.normal(uv));
        let alpha = angle(aim.to_sun, DVec3::NEG_Z);
        let Some(fan) = Fan::new(&normals, alpha, [aim.eta; 2]) else { return true };
        let (places, slopes) = (self.corners.map(|uv| aim.patch.at(uv)), fan.slopes());
        fan.is_lit() && Reach::new(places.into_iter(), &slopes, DVec2::ZERO).reaches(aim.x)
    }

    fn look(&self, aim: &Aim) -> Look {
        let (at, between) = (self.corners.map(|uv| aim.miss(uv)), self.middles().map(|uv| aim.miss(uv)));
        let all = || at.iter().chain(&between);
        if all().all(Option::is_none) {
            return Look::Nothing;
        }
        let ([Some(a), Some(b), Some(c)], [Some(bc), Some(ca), Some(ab)]) = (at, between) else {
            // A part of it reflects totally.
            return if self.reaches(aim) { Look::Folded } else { Look::Nothing };
        };
        let control = |middle: DVec2, p: DVec2, q: DVec2| 2.0 * middle - 0.5 * (p + q);
        let [bc, ca, ab] = [control(bc, b, c), control(ca, c, a), control(ab, a, b)];
        let bulge = |control: DVec2, p: DVec2, q: DVec2| (control - 0.5 * (p + q)).abs();
        let margin = bulge(bc, b, c).max(bulge(ca, c, a)).max(bulge(ab, a, b));
        let [least, most] = [DVec2::min, DVec2::max].map(|f| [b, c, bc, ca, ab].into_iter().fold(a, f));
        // The rounding of differences of coordinates.
        let margin = margin + 1e-13 * aim.x.abs().max_element();
        if (least - margin).cmpgt(DVec2::ZERO).any() || (most + margin).cmplt(DVec2::ZERO).any() {
            return Look::Nothing;
        }
        if has_fold([[ab - a, ca - a], [b - ab, bc - ab], [bc - ca, c - ca]]) {
            return Look::Folded;
        }
        let (along, across) = (b - a, c - a);
        let weights = DVec2::new(across.perp_dot(a), a.perp_dot(along)) / along.perp_dot(across);
        let is_near = weights.is_finite() && weights.abs().max_element() < 2.0;
        let [p, q, r] = self.corners;
        Look::Steady(if is_near { p + (q - p) * weights.x + (r - p) * weights.y } else { self.centre() })
    }
}

/// True unless the determinant is steady, given half the derivatives at the three corners.
fn has_fold(at: [[DVec2; 2]; 3]) -> bool {
    let det = |i: usize, j: usize| 0.5 * (at[i][0].perp_dot(at[j][1]) + at[j][0].perp_dot(at[i][1]));
    let all = [det(0, 0), det(1, 1), det(2, 2), det(0, 1), det(1, 2), det(2, 0)];
    let (least, most) = all.iter().fold((f64::MAX, f64::MIN), |(l, m), d| (l.min(*d), m.max(*d)));
    !(least > 0.0 && most < STEADY * least || most < 0.0 && least > STEADY * most)
}

/// Where Newton's method gets to.
enum Search {
    Found(Root),
    /// No root is in the triangle.
    Outside,
    Lost,
}

/// Newton's method from a point of the triangle.
fn newton(aim: &Aim, start: DVec2) -> Search {
    let mut uv = start;
    for _ in 0..24 {
        let Some(pass) = aim.pass(uv) else { return Search::Lost };
        let step = -(pass.jacobian.inverse() * pass.miss);
        if !step.is_finite() {
            return Search::Lost;
        }
        uv += step;
        let outside = -uv.min_element().min(1.0 - uv.x - uv.y);
        let moved = step.abs().max_element();
        if outside > 2.0 {
            return Search::Lost;
        }
        if outside > 0.05 + 8.0 * moved {
            return Search::Outside;
        }
        if moved < 1e-11 {
            return Search::Found(Root { uv, pass });
        }
    }
    Search::Lost
}

/// True for a root in a piece, or on those of its edges that belong to it.
fn is_within(root: &Root, piece: &Piece) -> bool {
    root.pass.depth > 0.0
        && root.pass.bent.is_lit()
        && piece.holds(root.uv, -(root.pass.jacobian.inverse() * SHIFT))
}

#[cfg(test)]
mod tests {
    use super::super::patch::{Patch, SunFrame};
    use super::*;
    use crate::sampling::{SampleSeed, SampleStream};
    use glam::Vec3;

    const ETA: f64 = 0.75;

    fn numbers(i: u32, k: u32) -> [f32; 4] {
        SampleStream::new(SampleSeed::new(11), i, k, 0).next4()
    }

    fn sun() -> (SunFrame, DVec3) {
        let frame = SunFrame::new(Vec3::new(0.3, -0.2, 0.8).normalize());
        (frame, frame.local(Vec3::new(0.302, -0.2, 0.8)).normalize())
    }

    fn normal(i: u32, k: u32, lean: f32) -> Vec3 {
        let [x, y, ..] = numbers(i, k);
        Vec3::new(lean * (2.0 * x - 1.0), lean * (2.0 * y - 1.0), 1.0).normalize()
    }

    /// Where the ray at (u, v) is so far behind the triangle.
    fn lit(patch: &Patch, to_sun: DVec3, uv: DVec2, depth: f64) -> DVec3 {
        let aim = Aim { patch, x: DVec3::ZERO, to_sun, eta: ETA };
        let pass = aim.pass(uv).unwrap();
        let d = pass.bent.direction;
        // The point at depth 0 of the frame, and the one on the same ray behind the triangle.
        let slope = (d.truncate() / d.z).extend(1.0);
        let on_triangle =
            DVec3::Z * -pass.depth + (-pass.miss).extend(0.0) + (slope * -pass.depth).with_z(0.0);
        on_triangle + slope * depth
    }

    /// Roots by cutting the triangle into many small ones, over which the miss is linear.
    fn by_force(aim: &Aim, steps: u32) -> usize {
        let at = |i: u32, j: u32| aim.miss(DVec2::new(f64::from(i), f64::from(j)) / f64::from(steps));
        let holds = |corners: [Option<DVec2>; 3]| {
            let [Some(a), Some(b), Some(c)] = corners else { return false };
            let sides = [a.perp_dot(b), b.perp_dot(c), c.perp_dot(a)];
            sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0)
        };
        let mut count = 0;
        for i in 0..steps {
            for j in 0..steps - i {
                count += usize::from(holds([at(i, j), at(i + 1, j), at(i, j + 1)]));
                if i + j + 1 < steps {
                    count += usize::from(holds([at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)]));
                }
            }
        }
        count
    }

    /// Normals that lean to all sides fold the light many times. A search through 10,000 small triangles finds as many roots,
    /// but where two lie within one of them, or one on an edge, which few of the points are near to.
    #[test]
    fn all_roots_are_found_at_folds_within_a_triangle() {
        let (frame, to_sun) = sun();
        let (mut several, mut wrong, mut with_roots, cases) = (0, 0, 0, 6000);
        let mut roots = Vec::new();
        for i in 0..cases {
            let lean = [0.1, 0.4, 1.0][i as usize % 3];
            let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
            let patch = Patch::new(&frame, &corners, Some([0, 1, 2].map(|k| normal(i, k, lean))), 1.0);
            let [u, v, depth, _] = numbers(i, 3).map(f64::from);
            let uv = DVec2::new(u * (1.0 - v), v);
            // Up to twice the distance at which such normals gather light.
            let x = lit(&patch, to_sun, uv, 6.0 * depth / f64::from(lean));
            let aim = Aim { patch: &patch, x, to_sun, eta: ETA };
            find(&aim, &Piece::WHOLE, &mut roots);
            assert!(roots.iter().any(|root| root.uv.distance(uv) < 1e-6), "{i}: {uv} is not among {roots:?}");
            let expected = by_force(&aim, 100);
            several += usize::from(expected > 1);
            with_roots += usize::from(expected > 0);
            wrong += usize::from(roots.len() != expected);
        }
        println!("{several} of {with_roots} points have several roots, {wrong} differ");
        assert!(several > 30, "{several}");
        assert!(wrong * 100 < with_roots, "{wrong}");
    }

    /// Rounding of coordinates does not keep the search from its end: small triangles far from the middle of the scene, which
    /// are as long as a hundred steps of single precision there.
    #[test]
    fn roots_are_found_far_from_the_middle() {
        let (frame, to_sun) = sun();
        let mut roots = Vec::new();
        let (mut lost, cases) = (0, 2000);
        for i in 0..cases {
            let far = Vec3::new(900.0, -700.0, 300.0);
            let edge = 100.0 * 6e-5;
            let corners = [far, far + Vec3::X * edge, far + Vec3::Y * edge];
            let normals = [0, 1, 2].map(|k| normal(i, k, 0.1));
            let patch = Patch::new(&frame, &corners, Some(normals), 1.0);
            let [u, v, depth, _] = numbers(i, 3).map(f64::from);
            let uv = DVec2::new(u * (1.0 - v), v);
            let bent =
                Aim { patch: &patch, x: DVec3::ZERO, to_sun, eta: ETA }.pass(uv).unwrap().bent.direction;
            let x = patch.at(uv) + bent * (30.0 * f64::from(edge) * depth);
            let aim = Aim { patch: &patch, x, to_sun, eta: ETA };
            find(&aim, &Piece::WHOLE, &mut roots);
            lost += usize::from(!roots.iter().any(|root| root.uv.distance(uv) < 1e-6));
        }
        assert_eq!(lost, 0, "of {cases}");
    }

    /// Six triangles around a corner: a point behind an edge, or behind the corner, is lit once.
    #[test]
    fn edges_and_corners_light_once() {
        let (frame, to_sun) = sun();
        let mut roots = Vec::new();
        for i in 0..300 {
            let corner = |k: u32| {
                let (sin, cos) = crate::geometry::elementary::sin_cos(k as f32 * std::f32::consts::FRAC_PI_3);
                let [a, b, ..] = numbers(i, 20 + k);
                Vec3::new(cos + 0.3 * a, sin + 0.3 * b, 0.1 * a)
            };
            let normals: Vec<Vec3> = (0..7).map(|k| normal(i, 30 + k, 0.05)).collect();
            let patches: Vec<Patch> = (0..6)
                .map(|k| {
                    let (j, turn) = ((k + 1) % 6, (i + k) as usize % 3);
                    let mut v = [Vec3::ZERO, corner(k), corner(j)];
                    let mut n = [normals[6], normals[k as usize], normals[j as usize]];
                    // Wherever the triangle begins.
                    v.rotate_left(turn);
                    n.rotate_left(turn);
                    Patch::new(&frame, &v, (i % 4 != 0).then_some(n), 1.0)
                })
                .collect();
            let first = (i as usize) % 6;
            let turn = (i as usize + first) % 3;
            for along in [0.0, 0.3, 0.8] {
                // On the edge from the middle to a corner of the first triangle.
                let mut weights = [1.0 - along, along, 0.0];
                weights.rotate_left(turn);
                let x = lit(&patches[first], to_sun, DVec2::new(weights[1], weights[2]), 2.0);
                let mut count = 0;
                for patch in &patches {
                    find(&Aim { patch, x, to_sun, eta: ETA }, &Piece::WHOLE, &mut roots);
                    count += roots.len();
                }
                // With flat triangles light crosses behind their edges, or leaves a gap.
                let is_smooth = i % 4 != 0;
                assert!(!is_smooth || count == 1, "{i}: {count} at {along}");
            }
        }
    }
}
