//! Neighbouring triangles with the vertices that they share.
//!
//! Triangles of a surface share most of their vertices: four neighbours have six, not twelve. A leaf holds up to
//! eight vertices once and says for each corner which it is. Vertices are sheared into the space of the ray before
//! they are handed to the triangles, so that both memory and arithmetic are spent once a vertex.

use glam::{Vec3, Vec3A, Vec4};

use super::TriangleId;
use super::moving::{Change, Unchanged};
use crate::geometry::Bounds;
use crate::geometry::machine::{Eight, Lanes};
use crate::geometry::nearness::squared_distances;
use crate::geometry::triangle::{EdgeHit, GREATEST_NUMERATOR, LEAST_NUMERATOR, RayCast};

/// Up to eight triangles over up to eight vertices: two cache lines.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Leaf {
    /// By axis.
    vertices: [Eight; 3],
    /// Which vertex the first, second and third corners of the triangles are.
    corners: [[u8; 8]; 3],
    /// Number of triangles; the lanes behind them repeat the last one.
    count: u8,
}

/// Triangles of a leaf that a ray may meet.
pub(super) struct Candidates {
    mask: u32,
    edges: [Eight; 3],
    t_numerators: Eight,
}

/// Which triangles a leaf holds; apart from the vertices, since only hits ask for it.
pub(super) type LeafIds = [TriangleId; Leaf::MOST];

/// A ray as leaves see it.
#[derive(Clone, Copy)]
pub(super) struct LeafRay<L> {
    origin: [L; 3],
    shear: [L; 3],
    axes: [usize; 3],
}

impl Leaf {
    /// Triangles, and vertices, at most.
    pub const MOST: usize = 8;
    /// In lanes without a triangle.
    pub const NO_TRIANGLE: TriangleId = TriangleId::MAX;

    /// A leaf over `ids`, or nothing when they have too many vertices or are too many.
    pub fn over(ids: &[TriangleId], positions: &[Vec3], triangles: &[[u32; 3]]) -> Option<Self> {
        let mut shared = SharedVertices::default();
        for &id in ids {
            shared.add(triangles[id as usize])?;
        }
        let mut leaf = Self { vertices: [Eight([0.0; 8]); 3], corners: shared.corners, count: shared.count };
        for (i, &index) in shared.vertices[..shared.used].iter().enumerate() {
            leaf.set_vertex(i, positions[index as usize]);
        }
        leaf.fill_unused(shared.used);
        Some(leaf)
    }

    /// Moves the vertices; `triangles` has the corners in the order in which the leaf was made.
    pub fn refit(&mut self, ids: &LeafIds, positions: &[Vec3], triangles: &[[u32; 3]]) {
        // Vertices are numbered as they appear.
        let mut used = 0;
        for lane in 0..self.len() {
            let corners = triangles[ids[lane] as usize];
            for (corner, vertex) in corners.into_iter().enumerate() {
                if usize::from(self.corners[corner][lane]) == used {
                    self.set_vertex(used, positions[vertex as usize]);
                    used += 1;
                }
            }
        }
        self.fill_unused(used);
    }

    /// Repeats the last vertex, so that all lie within the bounds.
    fn fill_unused(&mut self, used: usize) {
        for of_axis in &mut self.vertices {
            let last = of_axis.0[used.clamp(1, Self::MOST) - 1];
            of_axis.0[used..].fill(last);
        }
    }

    /// The box around the triangles.
    pub fn bounds(&self) -> Bounds {
        self.bounds_at(Unchanged)
    }

    /// The box around the triangles after a change.
    pub fn bounds_at(&self, change: impl Change<Self>) -> Bounds {
        let halves = [0, 1, 2].map(|axis| {
            let [a, b, c, d, e, f, g, h] =
                std::array::from_fn(|i| change.number(self, |leaf| leaf.vertices[axis].0[i]));
            [Vec4::new(a, b, c, d), Vec4::new(e, f, g, h)]
        });
        Bounds {
            min: Vec3::from_array(halves.map(|[a, b]| a.min(b).min_element())),
            max: Vec3::from_array(halves.map(|[a, b]| a.max(b).max_element())),
        }
    }

    fn set_vertex(&mut self, index: usize, p: Vec3) {
        for axis in 0..3 {
            self.vertices[axis].0[index] = p[axis];
        }
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        usize::from(self.count)
    }

    /// The vertices of the triangle in a lane.
    pub fn triangle(&self, lane: usize, change: impl Change<Self>) -> [Vec3; 3] {
        self.turned_triangle(lane, change, [0, 1, 2]).map(Vec3::from)
    }

    /// The vertices of the triangle in a lane, their coordinates in the order of `axes`.
    #[inline(always)]
    pub fn turned_triangle(&self, lane: usize, change: impl Change<Self>, axes: [usize; 3]) -> [Vec3A; 3] {
        let vertex = |corner: usize| {
            let vertex = usize::from(self.corners[corner][lane] & 7);
            let coordinate = |axis: usize| change.number(self, |leaf| leaf.vertices[axis].0[vertex]);
            Vec3A::new(coordinate(axes[0]), coordinate(axes[1]), coordinate(axes[2]))
        };
        [vertex(0), vertex(1), vertex(2)]
    }

    /// The coordinates of the vertices along an axis.
    #[inline(always)]
    fn along<L: Lanes>(&self, change: impl Change<Self>, axis: usize) -> L {
        change.lanes(self, |leaf| &leaf.vertices[axis])
    }

    /// Squares of the distances from a point to the triangles; lanes behind them repeat the last.
    #[inline(always)]
    pub fn squared_distances<L: Lanes>(&self, change: impl Change<Self>, point: &[L; 3]) -> L {
        let x = self.along::<L>(change, 0).sub(point[0]);
        let y = self.along::<L>(change, 1).sub(point[1]);
        let z = self.along::<L>(change, 2).sub(point[2]);
        let [a, b, c] = &self.corners;
        squared_distances([
            [x.pick(a), y.pick(a), z.pick(a)],
            [x.pick(b), y.pick(b), z.pick(b)],
            [x.pick(c), y.pick(c), z.pick(c)],
        ])
    }

    /// The triangles that the ray may meet; none that it does meet is left out.
    #[inline(always)]
    pub fn candidates<L: Lanes>(&self, change: impl Change<Self>, ray: &LeafRay<L>) -> Option<Candidates> {
        let [kx, ky, kz] = ray.axes;
        let z = self.along::<L>(change, kz).sub(ray.origin[2]);
        let x = self.along::<L>(change, kx).sub(ray.origin[0]).sub(z.mul(ray.shear[0]));
        let y = self.along::<L>(change, ky).sub(ray.origin[1]).sub(z.mul(ray.shear[1]));
        let [a, b, c] = &self.corners;
        let (ax, bx, cx) = (x.pick(a), x.pick(b), x.pick(c));
        let (ay, by, cy) = (y.pick(a), y.pick(b), y.pick(c));
        let u = cx.mul(by).sub(cy.mul(bx));
        let v = ax.mul(cy).sub(ay.mul(cx));
        let w = bx.mul(ay).sub(by.mul(ax));
        let zero = L::splat(0.0);
        let (least, greatest) = (u.min(v).min(w), u.max(v).max(w));
        let negative = greatest.at_most(zero) & self.used();
        let positive = zero.at_most(least) & self.used();
        if negative | positive == 0 {
            return None;
        }
        // Behind the origin is what has a numerator of t with another sign than the denominator; where an edge
        // function is zero or the numerator out of range, even no number, the exact ones will tell.
        let t = u.mul(z.pick(a)).add(v.mul(z.pick(b))).add(w.mul(z.pick(c))).mul(ray.shear[2]);
        let within = |low: f32, high: f32| L::splat(low).at_most(t) & t.at_most(L::splat(high));
        let above = within(LEAST_NUMERATOR, GREATEST_NUMERATOR);
        let below = within(-GREATEST_NUMERATOR, -LEAST_NUMERATOR);
        let mask = negative & (!above | zero.at_most(greatest)) | positive & (!below | least.at_most(zero));
        let eight = |lanes: L| {
            let mut eight = Eight([0.0; 8]);
            lanes.store(&mut eight);
            eight
        };
        Some(Candidates { mask, edges: [eight(u), eight(v), eight(w)], t_numerators: eight(t) })
    }

    /// A bit for each triangle.
    #[inline(always)]
    fn used(&self) -> u32 {
        (1 << self.count) - 1
    }
}

impl Candidates {
    /// The next one, lowest first, with its lane.
    #[inline(always)]
    pub fn next(&mut self) -> Option<(usize, EdgeHit)> {
        if self.mask == 0 {
            return None;
        }
        let lane = self.mask.trailing_zeros() as usize & 7;
        self.mask &= self.mask - 1;
        let [u, v, w] = &self.edges;
        let edges = Vec3A::new(u.0[lane], v.0[lane], w.0[lane]);
        Some((lane, EdgeHit { edges, t_numerator: self.t_numerators.0[lane] }))
    }
}

impl<L: Lanes> LeafRay<L> {
    #[inline(always)]
    pub fn new(cast: &RayCast) -> Self {
        let (origin, shear) = (cast.origin, cast.shear);
        Self {
            origin: [L::splat(origin.x), L::splat(origin.y), L::splat(origin.z)],
            shear: [L::splat(shear.x), L::splat(shear.y), L::splat(shear.z)],
            axes: cast.turn.axes(),
        }
    }
}

/// The vertices of some triangles, each once.
#[derive(Default)]
struct SharedVertices {
    vertices: [u32; Leaf::MOST],
    used: usize,
    corners: [[u8; 8]; 3],
    count: u8,
}

impl SharedVertices {
    fn add(&mut self, triangle: [u32; 3]) -> Option<()> {
        let lane = usize::from(self.count);
        if lane >= Leaf::MOST {
            return None;
        }
        for (corner, index) in triangle.into_iter().enumerate() {
            let known = self.vertices[..self.used].iter().position(|&v| v == index);
            let place = known.unwrap_or(self.used);
            if known.is_none() {
                *self.vertices.get_mut(place)? = index;
                self.used += 1;
            }
            self.corners[corner][lane..].fill(place as u8);
        }
        self.count += 1;
        Some(())
    }
}
