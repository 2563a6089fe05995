//! Emitting triangles, one-sided, sampled by area times power.

use glam::Vec3;

use super::LightSample;
use crate::geometry::offset::SurfacePoint;
use crate::geometry::triangle::scaled_normal;
use crate::sampling::{Distribution1d, warp};
use crate::spectrum::{LaneCurve, Lanes, Wavelengths};

/// All emitting triangles of a scene.
#[derive(Clone, Debug)]
pub struct AreaLights {
    triangles: Vec<Emitter>,
    /// Entry of each emitting triangle by its index in the scene, sorted by index.
    by_id: Vec<(u32, u32)>,
    choice: Distribution1d,
}

#[derive(Clone, Debug)]
struct Emitter {
    id: u32,
    vertices: [Vec3; 3],
    normal: Vec3,
    /// Density per area of a point on this triangle, choice included.
    pdf_a: f32,
    radiance: LaneCurve,
}

/// One emitting triangle of a scene as it is handed over.
#[derive(Clone, Debug)]
pub struct EmitterTriangle {
    /// Index in the scene.
    pub id: u32,
    /// Vertices; light leaves on the side of the right-hand normal.
    pub vertices: [Vec3; 3],
    /// Emitted radiance.
    pub radiance: LaneCurve,
    /// How bright it counts when one is chosen, relative to the others.
    pub importance: f32,
}

/// A point on a light.
#[derive(Clone, Copy, Debug)]
pub struct EmitterPoint {
    /// Where a ray may start that leaves it, in metres from the scene's origin.
    pub position: Vec3,
    /// Unit normal on the bright side.
    pub normal: Vec3,
    /// Its triangle's place among the lights.
    pub entry: usize,
    /// Its triangle's index in the scene.
    pub triangle: u32,
    /// Emitted radiance.
    pub radiance: Lanes,
    /// Density of the point per area.
    pub pdf_a: f32,
}

impl AreaLights {
    /// `None` when nothing emits. Triangles in rising order of `id`.
    pub fn new(emitters: Vec<EmitterTriangle>) -> Option<Self> {
        let area = |e: &EmitterTriangle| 0.5 * scaled_normal(&e.vertices).length();
        let choice =
            Distribution1d::new(emitters.iter().map(|e| f64::from(area(e)) * f64::from(e.importance)))?;
        let triangles: Vec<Emitter> = emitters
            .into_iter()
            .enumerate()
            .map(|(entry, e)| Emitter {
                id: e.id,
                normal: scaled_normal(&e.vertices).normalize_or_zero(),
                pdf_a: choice.probability(entry) / area(&e).max(f32::MIN_POSITIVE),
                vertices: e.vertices,
                radiance: e.radiance,
            })
            .collect();
        let mut by_id: Vec<(u32, u32)> =
            triangles.iter().enumerate().map(|(entry, t)| (t.id, entry as u32)).collect();
        by_id.sort_unstable();
        Some(Self { triangles, by_id, choice })
    }

    /// A point on a light, seen from `from`, the triangle by the third number; `None` where it shows its dark side.
    pub fn sample(&self, from: Vec3, u: [f32; 3], wavelengths: &Wavelengths) -> Option<LightSample> {
        // The choice has a number of its own: among a million triangles its remainder would have no digits left.
        let (entry, _) = self.choice.sample(u[2]);
        let emitter = &self.triangles[entry];
        let b = warp::triangle([u[0], u[1]]);
        let point = emitter.vertices[0] * b.x + emitter.vertices[1] * b.y + emitter.vertices[2] * b.z;
        let towards = point - from;
        let distance = towards.length();
        let wi = towards / distance;
        let pdf_w = self.pdf_w_of(emitter, wi, distance)?;
        Some(LightSample {
            wi,
            distance,
            triangle: Some(emitter.id),
            radiance: emitter.radiance.lanes(wavelengths),
            pdf_w,
        })
    }

    /// A point from which a photon starts, the triangle by the third number.
    pub fn sample_point(&self, u: [f32; 3], wavelengths: &Wavelengths) -> EmitterPoint {
        let (entry, _) = self.choice.sample(u[2]);
        let emitter = &self.triangles[entry];
        let point = SurfacePoint::on_triangle(&emitter.vertices, warp::triangle([u[0], u[1]]));
        EmitterPoint {
            position: point.spawn(emitter.normal, emitter.normal),
            normal: emitter.normal,
            entry,
            triangle: emitter.id,
            radiance: emitter.radiance.lanes(wavelengths),
            pdf_a: emitter.pdf_a,
        }
    }

    /// Vertices and normal on the bright side of each emitting triangle, in the order of [`EmitterPoint::entry`].
    pub fn bright_sides(&self) -> impl Iterator<Item = ([Vec3; 3], Vec3)> {
        self.triangles.iter().map(|t| (t.vertices, t.normal))
    }

    /// Density per solid angle with which triangle `id`, seen at `distance` along `wi`, would have been sampled.
    pub fn pdf_w(&self, id: u32, wi: Vec3, distance: f32) -> f32 {
        self.by_id.binary_search_by_key(&id, |&(id, _)| id).map_or(0.0, |place| {
            let emitter = &self.triangles[self.by_id[place].1 as usize];
            self.pdf_w_of(emitter, wi, distance).unwrap_or(0.0)
        })
    }

    /// pdf_w = pdf_a r^2 / cos `[VEACH97 eq. 8.2]`.
    fn pdf_w_of(&self, emitter: &Emitter, wi: Vec3, distance: f32) -> Option<f32> {
        let cos = -wi.dot(emitter.normal);
        (cos > 0.0 && distance > 0.0 && distance.is_finite())
            .then(|| emitter.pdf_a * distance * distance / cos)
    }
}
