//! Sends samples of the lights through the interfaces, to learn where light comes from beneath them.

use super::parts::Parts;
use super::surface::Surface;
use crate::accel::{Accel, Ignored};
use crate::geometry::Ray;
use crate::light::beneath::{Beneath, BeneathCells};
use crate::light::{LightSample, Lights};
use crate::optics::fresnel;
use crate::optics::medium::{Medium, MediumId};
use crate::optics::refraction::refract;
use crate::sampling::seed::unit_float;
use crate::sampling::{sobol, warp};
use crate::spectrum::Wavelengths;

/// Triangles of the interfaces that are asked, evenly among all.
const TRIANGLES: usize = 4096;
/// Samples of each kind of light, shared among them.
const SAMPLES: usize = 32_768;

/// What the question is put to.
pub(super) struct Asked<'a> {
    pub parts: &'a Parts,
    pub media: &'a [Medium],
    pub lights: &'a Lights,
    /// Media from which lights are seen straight.
    pub lit: &'a [bool],
    pub accel: &'a Accel,
    pub wavelengths: Wavelengths,
}

/// A triangle between a medium from which lights are seen straight and one from which they are not.
struct Window {
    triangle: u32,
    above: MediumId,
    below: MediumId,
    front_is_above: bool,
}

impl Asked<'_> {
    /// Where light comes from in each medium from which none is seen straight.
    pub fn beneath(&self) -> Vec<Option<Beneath>> {
        let mut cells: Vec<Option<BeneathCells>> = vec![None; self.media.len()];
        let shine = self.lights.area.is_some() || self.lights.environment.is_sampled();
        if shine && self.has_receivers() {
            let triangles = self.parts.geometry.triangles.len() as u32;
            let windows = || (0..triangles).filter_map(|triangle| self.window(triangle));
            let step = windows().count().div_ceil(TRIANGLES).max(1);
            let asked: Vec<Window> = windows().step_by(step).collect();
            for (i, window) in asked.iter().cycle().take(SAMPLES).enumerate() {
                self.look_through(window, i as u32, cells[window.below.0 as usize].get_or_insert_default());
            }
        }
        cells.iter().map(|c| c.as_ref().and_then(BeneathCells::finish)).collect()
    }

    /// True when anything there scatters light: in clear water over nothing no vertex looks for lights.
    fn has_receivers(&self) -> bool {
        let diffuse = self.parts.surfaces.iter().any(|s| matches!(s, Surface::Diffuse { .. }));
        diffuse || self.media.iter().zip(self.lit).any(|(medium, lit)| !lit && !medium.sigma_s.is_zero())
    }

    fn window(&self, triangle: u32) -> Option<Window> {
        let surface = self.parts.geometry.surfaces[triangle as usize];
        let pair = self.parts.surfaces[surface.0 as usize].pair()?;
        let front_is_above = self.lit[pair.front.0 as usize];
        if pair.matched || front_is_above == self.lit[pair.back.0 as usize] {
            return None;
        }
        let (above, below) = pair.crossed(front_is_above);
        Some(Window { triangle, above, below, front_is_above })
    }

    /// Adds sample `i` of the light that goes on beyond a triangle. Triangles count alike: those that reach to the horizon are not near
    /// what is looked at.
    fn look_through(&self, window: &Window, i: u32, cells: &mut BeneathCells) {
        let [a, b, c] = self.parts.geometry.vertices(window.triangle);
        let side = if window.front_is_above { 1.0 } else { -1.0 };
        let normal = (b - a).cross(c - a).normalize_or_zero() * side;
        let [u, v] = [0, 1].map(|set| sobol::scrambled4(i, set).map(unit_float));
        let weights = warp::triangle([v[0], v[1]]);
        let point = a * weights.x + b * weights.y + c * weights.z;
        let index = |id: MediumId| self.media[id.0 as usize].n;
        let eta_t_over_i = index(window.below) / index(window.above);
        let mut add = |light: &LightSample| {
            let cos = light.wi.dot(normal);
            let ignored = Ignored([window.triangle, light.triangle.unwrap_or(u32::MAX)]);
            let way = Ray { t_max: light.distance, ..Ray::new(point, light.wi) };
            let Some(direction) = refract(light.wi, normal, eta_t_over_i) else { return };
            if cos > 0.0 && light.pdf_w > 0.0 && !self.accel.occluded(&way, ignored) {
                let passed = 1.0 - fresnel::dielectric(cos, eta_t_over_i).reflectance;
                let power = passed * cos * light.radiance.element_sum() / light.pdf_w;
                cells.add(-direction, f64::from(power));
            }
        };
        let lamps = self.lights.area.as_ref();
        let lamp = lamps.and_then(|area| area.sample(point, [u[0], u[1], u[2]], &self.wavelengths));
        let sky = self.lights.environment.sample([u[0], u[1]], &self.wavelengths);
        lamp.iter().chain(&sky).for_each(&mut add);
    }
}
