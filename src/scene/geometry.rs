//! The triangles of one frame, all meshes in one list.

use glam::Vec3;

use super::surface::SurfaceId;
use crate::accel::Hit;
use crate::geometry::offset::SurfacePoint;
use crate::geometry::triangle::scaled_normal;

/// Triangles, their shading normals and what they are.
#[derive(Clone, Debug, Default)]
pub struct Geometry {
    /// Vertices in metres from the scene's origin.
    pub positions: Vec<Vec3>,
    /// Three vertices a triangle.
    pub triangles: Vec<[u32; 3]>,
    /// What each triangle is.
    pub surfaces: Vec<SurfaceId>,
    /// Shading normals.
    pub normals: Vec<Vec3>,
    /// Three indices into `normals` a triangle, or [`Geometry::FLAT`].
    pub corners: Vec<[u32; 3]>,
    /// What vertices move by in a frame, in metres; empty where nothing moves.
    pub motions: Vec<Vec3>,
    /// What shading normals change by in a frame; empty where none does.
    pub normal_changes: Vec<Vec3>,
}

/// Where and how a ray meets a surface.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceHit {
    /// Which triangle.
    pub triangle: u32,
    /// Distance along the ray in metres.
    pub t: f32,
    /// The point, with the bound of its rounding error.
    pub point: SurfacePoint,
    /// Unit normal of the triangle, on the side that the ray comes from.
    pub ng: Vec3,
    /// Shading normal on the same side; `ng` where the two disagree about the ray.
    pub ns: Vec3,
    /// True when the ray comes from the front.
    pub from_front: bool,
}

impl Geometry {
    /// Marks a triangle without shading normals.
    pub const FLAT: [u32; 3] = [u32::MAX; 3];

    /// Becomes a copy of another geometry in the memory that this one has.
    pub fn copy_from(&mut self, other: &Self) {
        let Self { positions, triangles, surfaces, normals, corners, motions, normal_changes } = other;
        self.positions.clone_from(positions);
        self.triangles.clone_from(triangles);
        self.surfaces.clone_from(surfaces);
        self.normals.clone_from(normals);
        self.corners.clone_from(corners);
        self.motions.clone_from(motions);
        self.normal_changes.clone_from(normal_changes);
    }

    /// The three vertices of a triangle when the shutter opens.
    #[inline]
    pub fn vertices(&self, triangle: u32) -> [Vec3; 3] {
        self.triangles[triangle as usize].map(|i| self.positions[i as usize])
    }

    /// The three vertices of a triangle at a time in frames: rounded as the hierarchy does it, so that both have the same.
    #[inline]
    pub fn vertices_at(&self, triangle: u32, time: f32) -> [Vec3; 3] {
        if self.motions.is_empty() { self.vertices(triangle) } else { self.moved_vertices(triangle, time) }
    }

    #[cold]
    #[inline(never)]
    fn moved_vertices(&self, triangle: u32, time: f32) -> [Vec3; 3] {
        self.triangles[triangle as usize]
            .map(|i| self.positions[i as usize] + self.motions[i as usize] * time)
    }

    /// The right-hand unit normal of a triangle at a time in frames.
    pub fn normal(&self, triangle: u32, time: f32) -> Vec3 {
        unit_normal(&self.vertices_at(triangle, time))
    }

    /// What a point of a triangle moves by in a frame, in metres.
    pub fn motion(&self, triangle: u32, point: Vec3, time: f32) -> Vec3 {
        if self.motions.is_empty() {
            return Vec3::ZERO;
        }
        let v = self.vertices_at(triangle, time);
        let normal = unit_normal(&v);
        let part = |a: Vec3, b: Vec3| (a - point).cross(b - point).dot(normal);
        let weights = Vec3::new(part(v[1], v[2]), part(v[2], v[0]), part(v[0], v[1]));
        let [a, b, c] = self.triangles[triangle as usize].map(|i| self.motions[i as usize]);
        let mixed = (a * weights.x + b * weights.y + c * weights.z) / weights.element_sum();
        if mixed.is_finite() { mixed } else { (a + b + c) / 3.0 }
    }

    /// Leaves no motions where all vertices stand still.
    pub(super) fn settle_motions(&mut self) {
        if self.motions.iter().all(|motion| *motion == Vec3::ZERO) {
            self.motions.clear();
            self.normal_changes.clear();
        }
    }

    /// How much later than at its own line a ray's parallels meet the plane of a triangle, in metres for each metre beside
    /// the line: t(offset) = t - slope . offset. Its length is the tangent of the angle with the normal.
    pub fn slope(&self, triangle: u32, direction: Vec3, time: f32) -> Vec3 {
        let n = self.normal(triangle, time);
        let cos = n.dot(direction);
        let beside = n - cos * direction;
        beside / if cos.abs() < 1e-6 { 1e-6_f32.copysign(cos) } else { cos }
    }

    /// The interpolated normal on the side that a hit is seen from, whatever that says of it; `ng`, the triangle's
    /// normal on that side, without shading normals. At a time in frames.
    #[inline]
    pub fn interpolated_normal(&self, hit: &Hit, ng: Vec3, time: f32) -> Vec3 {
        let moves = !self.normal_changes.is_empty();
        mixed(hit, ng, if moves { self.moved_normals(hit, time) } else { self.corner_normals(hit) })
    }

    /// Point and normals at a hit of a ray with unit `direction`, at a time in frames.
    #[inline]
    pub fn surface_hit(&self, hit: &Hit, direction: Vec3, time: f32) -> SurfaceHit {
        if !self.motions.is_empty() {
            return self.moved_surface_hit(hit, direction, time);
        }
        surface_hit(hit, direction, &self.vertices(hit.triangle), self.corner_normals(hit))
    }

    // Apart, so that it does not weigh on what stands still.
    #[cold]
    #[inline(never)]
    fn moved_surface_hit(&self, hit: &Hit, direction: Vec3, time: f32) -> SurfaceHit {
        let normals = self.moved_normals(hit, time);
        surface_hit(hit, direction, &self.vertices_at(hit.triangle, time), normals)
    }

    /// True where normals are interpolated over a triangle.
    #[inline]
    pub fn is_smooth(&self, triangle: u32) -> bool {
        self.corners[triangle as usize] != Self::FLAT
    }

    /// The shading normals at the corners of a triangle at a time in frames, if it has any.
    pub fn shading_normals(&self, triangle: u32, time: f32) -> Option<[Vec3; 3]> {
        let corners = self.corners[triangle as usize];
        let at = |i: u32| {
            let change = self.normal_changes.get(i as usize).map_or(Vec3::ZERO, |change| *change * time);
            self.normals[i as usize] + change
        };
        (corners != Self::FLAT).then(|| corners.map(at))
    }

    /// The shading normals at the corners of a triangle when the shutter opens, if it has any.
    #[inline(always)]
    fn corner_normals(&self, hit: &Hit) -> Option<[Vec3; 3]> {
        let corners = self.corners[hit.triangle as usize];
        (corners != Self::FLAT).then(|| corners.map(|i| self.normals[i as usize]))
    }

    fn moved_normals(&self, hit: &Hit, time: f32) -> Option<[Vec3; 3]> {
        let mut normals = self.corner_normals(hit)?;
        if !self.normal_changes.is_empty() {
            let corners = self.corners[hit.triangle as usize];
            (0..3).for_each(|k| normals[k] += self.normal_changes[corners[k] as usize] * time);
        }
        Some(normals)
    }
}

/// The interpolated normal on the side that a hit is seen from, or `ng`.
#[inline(always)]
fn mixed(hit: &Hit, ng: Vec3, normals: Option<[Vec3; 3]>) -> Vec3 {
    let Some([a, b, c]) = normals else { return ng };
    let side = if hit.from_front { 1.0 } else { -1.0 };
    let mixed = a * hit.barycentric.x + b * hit.barycentric.y + c * hit.barycentric.z;
    mixed.normalize_or(ng * side) * side
}

#[inline(always)]
fn surface_hit(hit: &Hit, direction: Vec3, v: &[Vec3; 3], normals: Option<[Vec3; 3]>) -> SurfaceHit {
    let side = if hit.from_front { 1.0 } else { -1.0 };
    let ng = unit_normal(v) * side;
    let ns = mixed(hit, ng, normals);
    let ns = if ns.dot(direction) < 0.0 && ns.dot(ng) > 0.0 { ns } else { ng };
    SurfaceHit {
        triangle: hit.triangle,
        t: hit.t,
        point: SurfacePoint::on_triangle(v, hit.barycentric),
        ng,
        ns,
        from_front: hit.from_front,
    }
}

/// The right-hand normal; in double precision where single precision underflows.
#[inline(always)]
fn unit_normal(v: &[Vec3; 3]) -> Vec3 {
    let n = scaled_normal(v);
    let squared = n.length_squared();
    if squared > 1e-30 && squared.is_finite() {
        return n / squared.sqrt();
    }
    let d = v.map(|p| p.as_dvec3());
    (d[1] - d[0]).cross(d[2] - d[0]).normalize_or(glam::DVec3::Z).as_vec3()
}
