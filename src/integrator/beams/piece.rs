//! Parts of a triangle, each a triangle in its barycentric weights.

use glam::DVec2;

/// A part of a triangle, by the weights of the second and the third corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) corners: [DVec2; 3],
    /// How often it was cut into four for it, or into halves.
    pub(super) cuts: u32,
}

/// Points closer to an edge than this are on it, in weights; roots are known to about 1e-12.
const ON_EDGE: f64 = 1e-9;

impl Piece {
    /// The triangle.
    pub(super) const WHOLE: Self = Self { corners: [DVec2::ZERO, DVec2::X, DVec2::Y], cuts: 0 };

    pub(super) fn centre(&self) -> DVec2 {
        (self.corners[0] + self.corners[1] + self.corners[2]) / 3.0
    }

    /// Its area, where that of the triangle is a half.
    pub(super) fn area(&self) -> f64 {
        let [a, b, c] = self.corners;
        0.5 * (b - a).perp_dot(c - a).abs()
    }

    /// A point of it, evenly spread as that of the unit square is.
    pub(super) fn at(&self, square: [f32; 2]) -> DVec2 {
        let [u, v] = square.map(f64::from);
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        let [a, b, c] = self.corners;
        a + (b - a) * u + (c - a) * v
    }

    /// The middles of the edges opposite to the corners.
    pub(super) fn middles(&self) -> [DVec2; 3] {
        let [a, b, c] = self.corners;
        [0.5 * (b + c), 0.5 * (c + a), 0.5 * (a + b)]
    }

    /// Four of half the size, of the same orientation but for the one in the middle, which is turned.
    pub(super) fn cut(&self) -> [Self; 4] {
        let ([a, b, c], [bc, ca, ab]) = (self.corners, self.middles());
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [bc, ca, ab]]
            .map(|corners| Self { corners, cuts: self.cuts + 1 })
    }

    /// Two halves, parted at the middle of the edge opposite to a corner.
    pub(super) fn halves(&self, corner: usize) -> [Self; 2] {
        let (middle, [a, b, c]) = (self.middles()[corner], self.corners);
        let halves = match corner {
            0 => [[a, b, middle], [a, middle, c]],
            1 => [[a, b, middle], [middle, b, c]],
            _ => [[a, middle, c], [middle, b, c]],
        };
        halves.map(|corners| Self { corners, cuts: self.cuts + 1 })
    }

    /// True for a point within, and for one on those edges that it crosses inwards when it moves a little as told.
    pub(super) fn holds(&self, point: DVec2, moves: DVec2) -> bool {
        let [a, b, c] = self.corners;
        let area = (b - a).perp_dot(c - a);
        [(b, c), (c, a), (a, b)].into_iter().all(|(from, to)| {
            let weight = (to - from).perp_dot(point - from) / area;
            if weight.abs() <= ON_EDGE { (to - from).perp_dot(moves) / area > 0.0 } else { weight > 0.0 }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Inner points, points on inner edges and on corners of pieces: each is held once, whichever way it moves.
    #[test]
    fn pieces_share_out_a_triangle() {
        let pieces: Vec<Piece> = Piece::WHOLE.cut().iter().flat_map(Piece::cut).collect();
        let halves: Vec<Piece> = (0..5)
            .fold(vec![Piece::WHOLE], |all, i| all.iter().flat_map(|p| p.halves((i + 1) % 3)).collect());
        for i in 1..16 {
            for j in 1..16 - i {
                let point = DVec2::new(f64::from(i), f64::from(j)) / 16.0;
                for moves in [DVec2::new(1.0, 0.3), DVec2::new(-0.2, 1.0), DVec2::new(-0.7, -1.1)] {
                    for pieces in [&pieces, &halves] {
                        let held = pieces.iter().filter(|piece| piece.holds(point, moves)).count();
                        assert_eq!(held, 1, "{point} {moves}");
                    }
                }
            }
        }
    }

    /// Points of a grid over the unit square lie in the piece, as many in each quarter of it, within those on the edges.
    #[test]
    fn points_of_a_piece_are_even() {
        let piece = Piece::WHOLE.halves(1)[1].cut()[2];
        let n = 64;
        let all = (0..n * n).map(|i| piece.at([i % n, i / n].map(|k| (k as f32 + 0.25) / n as f32)));
        let all: Vec<DVec2> = all.collect();
        for (part, share) in piece.cut().iter().map(|part| (*part, 0.25)).chain([(piece, 1.0)]) {
            let count = all.iter().filter(|point| part.holds(**point, DVec2::new(1.0, 0.3))).count();
            let expected = share * f64::from(n * n);
            assert!((count as f64 - expected).abs() <= f64::from(2 * n), "{count} for {expected}");
        }
        assert!((4.0 * piece.cut()[3].area() / piece.area() - 1.0).abs() < 1e-12);
        assert_eq!(piece.area(), 0.5 / 8.0);
    }
}
