//! Path tracing in which the sun is found through one refracting interface, whichever way it is bent there.
//!
//! A path that turns at a point x behind an interface would have to run into a disc of half a degree by chance. Instead a
//! direction w to the disc is drawn at x, and all triangles of interfaces through which its light is bent to x are found. Each
//! adds what an eye path would see that goes there from x along -d:
//!
//! ```text
//! L = f (1 - F) T E |dw_x / dw| (n_x / n_i)^2 = f (1 - F) T E  2A |d . n_g| (cos_i / cos_t) / (d_z |det(dg / d(u, v))|)
//! ```
//! with f the phase function, or the BRDF times its cosine, E the irradiance of the sun, T what media leave on both sides, n_g the
//! normal of the triangle of area A, and g, by which rays miss x, as in the page of the patch. It follows from
//! dw_x = 2A |d . n_g| / r^2 d(u, v), Snell's law in the form n_i^2 cos_i dw = n_x^2 cos_t dw_t, and g = 0 for fixed x. With flat
//! normals it is the flux through the triangle over the area that it falls on. Flat water has E cos_i (1 - F) / cos_t.
//!
//! | step | page |
//! |---|---|
//! | once a frame: where each triangle can send light of the whole disc | `spread.rs` |
//! | a hierarchy over these, asked for a point | `index.rs` |
//! | all solutions g = 0 in a triangle | `patch.rs`, `roots.rs` |
//! | what they bring, and what is in the way | `light.rs` |
//!
//! Nishita and Nakamae `[NISHITA94]` follow the volumes that triangles sweep, Walter, Zhao, Holzschuch and Bala `[WALTER09]` the
//! paths from a point; this is the second for light of one direction. Each vertex draws a point of the disc of its own, so what
//! goes to infinity at a caustic is smoothed as the disc smooths it. Nothing is blurred and nothing is left from pass to pass.
//!
//! What is found so has one refracting interface between the vertex and the sun, and otherwise only index-matched boundaries.
//! Light that is bent twice or reflected on its way, as that through meshes that overlap others, is that of photons
//! ([`super::strays`]). A path that
//! sees the disc through interfaces alone has it as before, and one that was lit never sees it: nothing counts twice.

mod index;
mod light;
mod patch;
pub(super) mod roots;
mod spread;

use glam::DVec3;

use crate::geometry::triangle::scaled_normal;
use crate::optics::medium::MediumId;
use crate::scene::frame::Frame;
use crate::scene::surface::{MediumPair, Surface};
use crate::spectrum::Wavelengths;
use index::{Index, Reach};
use patch::SunFrame;
use spread::{Fan, angle};

/// The triangles that bend light of the sun, and where they can send it.
#[derive(Clone, Debug)]
pub struct Beams {
    sun: SunFrame,
    beams: Vec<Beam>,
    index: Index,
    /// Media that these reach, by [`MediumId`].
    reached: Vec<bool>,
}

/// A triangle that bends light about its interpolated normals, or about its own.
#[derive(Clone, Copy, Debug)]
struct Beam {
    triangle: u32,
    /// The sun is on its front.
    front: bool,
    shaded: bool,
}

/// Wavelengths at which indices are looked up: so many times four.
const STEPS: u32 = 16;

impl Beams {
    /// Those of a frame; `None` without any.
    pub fn new(frame: &Frame) -> Option<Self> {
        let sun = frame.lights.sun.as_ref()?;
        let gatherer = Gatherer {
            frame,
            sun: SunFrame::new(sun.direction()),
            alpha: f64::from(sun.half_angle()),
            indices: indices(frame),
        };
        let mut beams = Vec::new();
        let mut reaches = Vec::new();
        let mut reached = vec![false; frame.media.len()];
        for triangle in 0..frame.geometry.triangles.len() as u32 {
            let Surface::Interface(pair) = frame.surface(triangle) else { continue };
            for front in [true, false] {
                let (outer, inner) = pair.crossed(front);
                if pair.matched || !frame.lit[outer.0 as usize] || frame.reflects_beyond(pair, front) {
                    continue;
                }
                gatherer.beams(triangle, pair, front, |beam, reach| {
                    reached[inner.0 as usize] = true;
                    beams.push(beam);
                    reaches.push(reach);
                });
            }
        }
        let depth = 0.5 * frame.accel.bounds().size().max_element();
        let index = Index::new(&reaches, depth);
        let own = Self { sun: gatherer.sun, beams, index, reached };
        (!own.beams.is_empty()).then_some(own)
    }

    /// True where light is looked for in a medium.
    pub(super) fn reach(&self, medium: MediumId) -> bool {
        self.reached[medium.0 as usize]
    }

    /// Triangles through which light is looked for; those whose own normal may be taken for the interpolated one twice.
    pub fn len(&self) -> usize {
        self.beams.len()
    }

    /// True without triangles.
    pub fn is_empty(&self) -> bool {
        self.beams.is_empty()
    }

    /// Bytes that they occupy.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.beams) + self.index.bytes()
    }
}

/// Least and greatest index of each medium over wavelength.
fn indices(frame: &Frame) -> Vec<[f64; 2]> {
    let of_medium = |medium: &crate::optics::medium::Medium| {
        let all = (0..STEPS).flat_map(|i| {
            let at = (i as f32 + 0.5) / STEPS as f32;
            medium.lanes(&Wavelengths::for_mode(frame.mode, 0.25 * at)).n.to_array()
        });
        let (least, most) = all.fold((f32::MAX, 0.0_f32), |(l, m), n| (l.min(n), m.max(n)));
        // Between two of the wavelengths, and beyond the last, it may be a little off.
        let beyond = 0.2 * (most - least);
        [f64::from(least - beyond), f64::from(most + beyond)]
    };
    frame.media.iter().map(of_medium).collect()
}

struct Gatherer<'a> {
    frame: &'a Frame,
    sun: SunFrame,
    alpha: f64,
    indices: Vec<[f64; 2]>,
}

impl Gatherer<'_> {
    /// The beams of one side of a triangle.
    fn beams(&self, triangle: u32, pair: &MediumPair, front: bool, mut add: impl FnMut(Beam, Reach)) {
        let side = if front { 1.0 } else { -1.0 };
        let geometry = &self.frame.geometry;
        let times = [self.frame.views.time(0.0), self.frame.views.time(1.0)];
        let corners = times.map(|time| geometry.vertices_at(triangle, time));
        let local = corners.map(|v| v.map(|p| self.sun.local(p)));
        let eta = self.eta(pair, front);
        let own = self.own_normals(triangle, times, side);
        let Some(flat) = Fan::new(&own, self.alpha, eta).filter(Fan::is_lit) else { return };
        let points = || local.into_iter().flatten();
        let beam = Beam { triangle, front, shaded: false };
        let normals = times.map(|time| geometry.shading_normals(triangle, time));
        let [Some(first), Some(last)] = normals else {
            add(beam, Reach::new(points(), &flat.slopes()));
            return;
        };
        let normals: Vec<DVec3> = first.into_iter().chain(last).map(|n| self.sun.local(n) * side).collect();
        let fan = Fan::new(&normals, self.alpha, eta);
        if let Some(fan) = fan.filter(Fan::is_lit) {
            add(Beam { shaded: true, ..beam }, Reach::new(points(), &fan.slopes()));
        }
        if !fan.is_some_and(|fan| is_sound(&fan, &flat)) {
            add(beam, Reach::new(points(), &flat.slopes()));
        }
    }

    fn eta(&self, pair: &MediumPair, front: bool) -> [f64; 2] {
        let (outer, inner) = pair.crossed(front);
        let [outer, inner] = [outer, inner].map(|id| self.indices[id.0 as usize]);
        [outer[0] / inner[1], outer[1] / inner[0]]
    }

    /// Vectors whose cone holds the triangle's normal at all times: while its corners move evenly it is quadratic in time, with
    /// these Bernstein coefficients.
    fn own_normals(&self, triangle: u32, [first, last]: [f32; 2], side: f64) -> [DVec3; 3] {
        let at = |time: f32| {
            let v = self.frame.geometry.vertices_at(triangle, time);
            self.sun.local(scaled_normal(&v)).normalize_or_zero() * side
        };
        if first == last {
            return [at(first); 3];
        }
        let scaled = |time: f32| {
            self.sun.local(scaled_normal(&self.frame.geometry.vertices_at(triangle, time))) * side
        };
        let [start, middle, end] = [first, 0.5 * (first + last), last].map(scaled);
        [start, 2.0 * middle - 0.5 * (start + end), end]
    }
}

/// True when no ray of the sun can be bent about the triangle's own normal in the place of interpolated ones: the normals, the
/// light and what is reflected about them on the far side all keep to their side of the triangle.
fn is_sound(shading: &Fan, own: &Fan) -> bool {
    let quarter = std::f64::consts::FRAC_PI_2 - 1e-4;
    let lean = angle(shading.normal, own.normal) + shading.phi + own.phi;
    let sun = angle(own.normal, DVec3::NEG_Z) + own.phi + own.alpha;
    let lit = angle(shading.normal, DVec3::NEG_Z) + shading.phi + shading.alpha;
    lean + shading.steepest() < quarter && sun < quarter && lit < quarter
}
