//! A dense grid of relative densities in a box.
//!
//! The values belong to the centres of equal cells and are linear in between along each axis (trilinear); in the outer
//! half cells they go on unchanged, and outside of the box there is nothing.
//!
//! Between eight neighbouring centres the density along a ray is a cubic, so Simpson's second rule is its exact integral:
//!
//! ```text
//! length = sum over the lattice cells of (t_3 - t_0) / 8 (rho(t_0) + 3 rho(t_1) + 3 rho(t_2) + rho(t_3)),   t_i at thirds
//! ```
//!
//! Rays go from block to block of 8 x 8 x 8 lattice cells, step over those that are empty, and from cell to cell in the
//! others. The free flight stops in the cell in which the length is reached and solves its quartic there.

use glam::{DVec3, IVec3, Vec3, Vec4};

use super::super::volume::Volume;
use crate::geometry::Ray;

/// Lattice cells along the edge of a block.
const BLOCK: i32 = 8;

/// A grid placed in the scene.
#[derive(Clone, Debug)]
pub struct GridDensity {
    /// Least corner of the box in metres from the scene's origin.
    min: Vec3,
    /// Cells a metre along each axis.
    per_metre: Vec3,
    /// Centres along each axis, with one more before and behind that repeats its neighbour.
    size: IVec3,
    /// x runs fastest.
    values: Vec<f32>,
    /// Blocks along each axis.
    blocks: IVec3,
    /// The greatest value that each block sees.
    majorants: Vec<f32>,
}

/// A part of a ray that lies in one cell of a lattice.
#[derive(Clone, Copy)]
struct Span {
    cell: IVec3,
    start: f32,
    end: f32,
}

/// The cells of a lattice that a ray crosses, in order.
struct Walk {
    cell: IVec3,
    step: IVec3,
    size: IVec3,
    /// Distance of the next boundary along each axis.
    next: Vec3,
    /// Distance between boundaries along each axis.
    pitch: Vec3,
    at: f32,
    end: f32,
}

/// The density between eight centres.
struct Corners([f32; 8]);

impl GridDensity {
    /// Places a volume in the box from `min` to `max`, in metres from the scene's origin.
    pub fn new(volume: &Volume, min: DVec3, max: DVec3) -> Self {
        let inner = IVec3::from_array(volume.size.map(|n| n as i32));
        let size = inner + 2;
        let mut values = Vec::with_capacity(size.as_i64vec3().element_product() as usize);
        for z in 0..size.z {
            for y in 0..size.y {
                for x in 0..size.x {
                    let p = (IVec3::new(x, y, z) - 1).clamp(IVec3::ZERO, inner - 1);
                    values.push(volume.values[index(p, inner)]);
                }
            }
        }
        let blocks = (size - 1 + (BLOCK - 1)) / BLOCK;
        let mut grid = Self {
            min: min.as_vec3(),
            per_metre: (inner.as_dvec3() / (max - min)).as_vec3(),
            size,
            values,
            blocks,
            majorants: Vec::new(),
        };
        for z in 0..blocks.z {
            for y in 0..blocks.y {
                for x in 0..blocks.x {
                    grid.majorants.push(grid.majorant(IVec3::new(x, y, z)));
                }
            }
        }
        grid
    }

    /// The greatest density anywhere.
    pub fn maximum(&self) -> f32 {
        self.majorants.iter().copied().fold(0.0, f32::max)
    }

    /// Cells along each axis.
    pub fn cells(&self) -> [u32; 3] {
        (self.size - 2).as_uvec3().to_array()
    }

    /// The greatest value at the corners of a block's cells.
    fn majorant(&self, block: IVec3) -> f32 {
        let first = block * BLOCK;
        let last = (first + BLOCK).min(self.size - 1);
        let mut greatest = 0.0_f32;
        for z in first.z..=last.z {
            for y in first.y..=last.y {
                for x in first.x..=last.x {
                    greatest = greatest.max(self.values[index(IVec3::new(x, y, z), self.size)]);
                }
            }
        }
        greatest
    }

    /// Density times distance over a ray up to its `t_max`.
    pub fn length(&self, ray: &Ray) -> f32 {
        let mut sum = 0.0;
        self.each_span(ray, |span, values| {
            sum += (span.end - span.start) * mean(values);
            true
        });
        sum
    }

    /// The distance at which the length reaches a value; infinite when it never does.
    pub fn distance(&self, ray: &Ray, length: f32) -> f32 {
        let mut distance = f32::INFINITY;
        let mut left = length;
        self.each_span(&Ray { t_max: f32::INFINITY, ..*ray }, |span, values| {
            let extent = span.end - span.start;
            let part = extent * mean(values);
            if part >= left && part > 0.0 {
                distance = span.start + extent * Cubic::through(values).reach(left / extent);
                return false;
            }
            left -= part;
            true
        });
        distance
    }

    /// Calls `visit` for the part of a ray in each lattice cell of blocks that are not empty, with the densities at its
    /// ends and thirds, until it returns false.
    #[inline]
    fn each_span(&self, ray: &Ray, mut visit: impl FnMut(Span, Vec4) -> bool) {
        let q = Ray {
            origin: (ray.origin - self.min) * self.per_metre + 0.5,
            direction: ray.direction * self.per_metre,
            ..*ray
        };
        let Some((start, end)) = self.clip(&q) else { return };
        let cells = self.size - 1;
        for block in Walk::new(&q, start, end, BLOCK, self.blocks) {
            if self.majorants[index(block.cell, self.blocks)] == 0.0 {
                continue;
            }
            for span in Walk::new(&q, block.start, block.end, 1, cells) {
                if !visit(span, self.corners(span.cell).values(&q, &span)) {
                    return;
                }
            }
        }
    }

    /// The part of a ray in lattice coordinates within the box.
    fn clip(&self, q: &Ray) -> Option<(f32, f32)> {
        let (least, greatest) = (Vec3::splat(0.5), self.size.as_vec3() - 1.5);
        let (mut start, mut end) = (0.0_f32, q.t_max);
        for axis in 0..3 {
            let (o, d) = (q.origin[axis], q.direction[axis]);
            if d == 0.0 {
                if o < least[axis] || o > greatest[axis] {
                    return None;
                }
                continue;
            }
            let (a, b) = ((least[axis] - o) / d, (greatest[axis] - o) / d);
            start = start.max(a.min(b));
            end = end.min(a.max(b));
        }
        (start < end).then_some((start, end))
    }

    fn corners(&self, cell: IVec3) -> Corners {
        let at = index(cell, self.size);
        let (row, slice) = (self.size.x as usize, self.size.x as usize * self.size.y as usize);
        let v = &self.values[at..];
        Corners([v[0], v[1], v[row], v[row + 1], v[slice], v[slice + 1], v[slice + row], v[slice + row + 1]])
    }
}

/// Place of (x, y, z) in a list in which x runs fastest.
fn index(p: IVec3, size: IVec3) -> usize {
    (p.z as usize * size.y as usize + p.y as usize) * size.x as usize + p.x as usize
}

impl Walk {
    /// The cells of edge `edge` between two distances along a ray in lattice coordinates.
    fn new(q: &Ray, start: f32, end: f32, edge: i32, size: IVec3) -> Self {
        let scale = 1.0 / edge as f32;
        let cell = (q.at(start) * scale).floor().as_ivec3().clamp(IVec3::ZERO, size - 1);
        let step = q.direction.cmpge(Vec3::ZERO);
        let ahead = Vec3::select(step, Vec3::ONE, Vec3::ZERO);
        let still = q.direction.cmpeq(Vec3::ZERO);
        let boundary = (cell.as_vec3() + ahead) * edge as f32;
        let next = Vec3::select(still, Vec3::INFINITY, (boundary - q.origin) / q.direction);
        let pitch = Vec3::select(still, Vec3::INFINITY, (edge as f32 / q.direction).abs());
        let step = IVec3::select(step, IVec3::ONE, IVec3::NEG_ONE);
        Self { cell, step, size, next, pitch, at: start, end }
    }
}

impl Iterator for Walk {
    type Item = Span;

    #[inline]
    fn next(&mut self) -> Option<Span> {
        if self.at >= self.end {
            return None;
        }
        let axis = self.next.min_position();
        // By rounding a boundary may lie behind; the span is empty then.
        let reached = self.next[axis].clamp(self.at, self.end);
        let span = Span { cell: self.cell, start: self.at, end: reached };
        self.next[axis] += self.pitch[axis];
        self.cell[axis] += self.step[axis];
        self.at = if self.cell[axis] < 0 || self.cell[axis] >= self.size[axis] {
            // The last cell takes what rounding has left of the ray.
            self.end
        } else {
            reached
        };
        Some(span)
    }
}

impl Corners {
    /// The densities at the ends and thirds of a span, by the lanes.
    #[inline]
    fn values(&self, q: &Ray, span: &Span) -> Vec4 {
        let t = Vec4::splat(span.start) + Vec4::new(0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0) * (span.end - span.start);
        let start = q.origin - span.cell.as_vec3();
        let along = |o: f32, d: f32| (Vec4::splat(o) + t * d).max(Vec4::ZERO).min(Vec4::ONE);
        let (x, y, z) =
            (along(start.x, q.direction.x), along(start.y, q.direction.y), along(start.z, q.direction.z));
        let c = &self.0;
        let edge = |i: usize| Vec4::splat(c[i]) + x * (c[i + 1] - c[i]);
        let mix = |a: Vec4, b: Vec4, t: Vec4| a + (b - a) * t;
        mix(mix(edge(0), edge(2), y), mix(edge(4), edge(6), y), z)
    }
}

/// Simpson's second rule, which is exact for cubics as the first is.
#[inline]
fn mean(values: Vec4) -> f32 {
    values.dot(Vec4::new(0.125, 0.375, 0.375, 0.125))
}

/// c_0 + c_1 s + c_2 s^2 + c_3 s^3 on [0, 1].
struct Cubic([f32; 4]);

impl Cubic {
    /// The cubic with these values at 0, 1/3, 2/3 and 1 (Lagrange).
    fn through(values: Vec4) -> Self {
        let [a, b, c, d] = values.to_array();
        Self([
            a,
            -5.5 * a + 9.0 * b - 4.5 * c + d,
            9.0 * a - 22.5 * b + 18.0 * c - 4.5 * d,
            -4.5 * a + 13.5 * b - 13.5 * c + 4.5 * d,
        ])
    }

    fn value(&self, s: f32) -> f32 {
        let [a, b, c, d] = self.0;
        ((d * s + c) * s + b) * s + a
    }

    /// Integral from 0 to s.
    fn integral(&self, s: f32) -> f32 {
        let [a, b, c, d] = self.0;
        (((d / 4.0 * s + c / 3.0) * s + b / 2.0) * s + a) * s
    }

    /// Where the integral reaches a value: Newton's method within a bracket.
    fn reach(&self, value: f32) -> f32 {
        let (mut low, mut high) = (0.0_f32, 1.0_f32);
        let mut s = (value / self.integral(1.0)).clamp(0.0, 1.0);
        // Newton's steps double their digits; those that leave the bracket halve it.
        for _ in 0..12 {
            let off = self.integral(s) - value;
            if off > 0.0 {
                high = s
            } else {
                low = s
            }
            let newton = s - off / self.value(s);
            s = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
        }
        s
    }
}

#[cfg(test)]
mod tests;
