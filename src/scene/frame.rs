//! One frame as rays see it.

use super::camera_path::{StartPlaces, Views};
use super::geometry::Geometry;
use super::layers::{Insides, Layers};
use super::needs::Needs;
use super::surface::{MediumPair, Surface};
use crate::accel::{Accel, Hit, Ignored};
use crate::geometry::Ray;
use crate::light::{Beneath, Lights};
use crate::optics::half_space::HalfSpace;
use crate::optics::medium::{Medium, MediumId};
use crate::sampling::SampleStream;
use crate::spectrum::{LaneCurve, LaneMode, Lanes, Wavelengths, film_rgb, wavelength};
use glam::{DVec3, Vec3};
use std::collections::BTreeMap;

/// Everything that the light transport of one frame reads.
#[derive(Clone, Debug)]
pub struct Frame {
    /// What the lanes of its paths stand for.
    pub mode: LaneMode,
    /// The point that coordinates are relative to, in metres.
    pub origin: DVec3,
    /// What the camera sees while the shutter is open.
    pub views: Views,
    /// Where the camera is.
    pub starts: StartPlaces,
    /// Media by [`MediumId`].
    pub media: Vec<Medium>,
    /// Media in which a ray that meets nothing ends in the dark: the extended sea.
    pub endless: Vec<bool>,
    /// Media from which a light may be seen without refraction in between.
    pub lit: Vec<bool>,
    /// Where compact lights are likely to be seen from media that are not among those, by [`MediumId`].
    pub beneath: Vec<Option<Beneath>>,
    /// Media whose walks are led to their surface ([`crate::optics::dwivedi`]), by [`MediumId`].
    pub led: Vec<bool>,
    /// What is seen of media that are too thick to walk through ([`super::half_spaces`]), by [`MediumId`]; empty without any.
    pub half_spaces: Vec<Option<HalfSpace>>,
    /// The rounding of coordinates over the free path, the greatest of all media that scatter; 0 where it does not matter.
    pub roughness: f32,
    /// All triangles.
    pub geometry: Geometry,
    /// What triangles are, by [`super::surface::SurfaceId`].
    pub surfaces: Vec<Surface>,
    /// The media of meshes that overlap; none where no meshes do.
    pub layers: Layers,
    /// The hierarchy over them.
    pub accel: Accel,
    /// The lights.
    pub lights: Lights,
    /// White light (D65) of luminance 1.
    pub white: LaneCurve,
    /// What the frame needs, and what is left out.
    pub needs: Needs,
}

impl Frame {
    /// A medium.
    #[inline]
    pub fn medium(&self, id: MediumId) -> &Medium {
        &self.media[id.0 as usize]
    }

    /// What is seen of a medium that is too thick to walk through.
    #[inline]
    pub fn half_space(&self, id: MediumId) -> Option<&HalfSpace> {
        self.half_spaces.get(id.0 as usize)?.as_ref()
    }

    /// True when a ray does not get into the medium beyond a boundary, which reflects it as a half space does.
    #[inline]
    pub fn reflects_beyond(&self, pair: &MediumPair, from_front: bool) -> bool {
        !self.half_spaces.is_empty() && self.half_space(pair.crossed(from_front).1).is_some()
    }

    /// What lanes of reflected white light look like, linear RGB.
    pub fn colour_of(&self, reflected: Lanes, wavelengths: &Wavelengths) -> Vec3 {
        film_rgb(self.mode, wavelengths, reflected * self.white.lanes(wavelengths))
    }

    /// The wavelengths of a sample of pixels or a pass of photons, by its number `w`; where they part it matters which of
    /// the four leads, and both choices are stratified together.
    pub fn wavelengths(&self, w: f32, stream: &mut SampleStream) -> Wavelengths {
        let [w, hero, ..] = if self.needs.dispersive { stream.next4() } else { [w, 0.0, 0.0, 0.0] };
        Wavelengths::for_mode(self.mode, wavelength::of_four(w, hero))
    }

    /// True where next-event estimation can find a light.
    #[inline]
    pub fn looks_for_lights(&self, id: MediumId) -> bool {
        self.lit[id.0 as usize] || self.beneath[id.0 as usize].is_some()
    }

    /// True when a ray in `medium` can meet what it has hit: an opaque surface, an interface of that medium, or a layer of
    /// what it is in.
    #[inline]
    pub fn is_boundary_of(&self, medium: MediumId, insides: Insides, hit: &Hit) -> bool {
        match self.surface(hit.triangle) {
            Surface::Interface(pair) => pair.crossed(hit.from_front).0 == medium,
            Surface::Layer(layer) => layer.is_met_in(insides, hit.from_front),
            _ => true,
        }
    }

    /// Where a point is at a time ([`place_of`]).
    pub fn place_of(&self, point: Vec3, time: f32) -> Place {
        place_of(point, time, &self.accel, |triangle| self.surface(triangle), &self.layers)
    }

    /// Where an eye ray begins.
    pub fn start_of(&self, eye: &Ray) -> Place {
        match self.starts {
            StartPlaces::One(place) => place,
            StartPlaces::Several => self.place_of(eye.origin, eye.time),
        }
    }

    /// The boundary between a medium and the one beyond it, seen from the front of its triangle or not.
    pub fn boundary(&self, before: MediumId, beyond: MediumId, from_front: bool) -> MediumPair {
        let (front, back) = if from_front { (before, beyond) } else { (beyond, before) };
        MediumPair { front, back, matched: self.medium(front).is_matched_with(self.medium(back)) }
    }

    /// What a triangle is.
    #[inline]
    pub fn surface(&self, triangle: u32) -> &Surface {
        &self.surfaces[self.geometry.surfaces[triangle as usize].0 as usize]
    }
}

/// Where something is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// The medium there.
    pub medium: MediumId,
    /// The meshes that it is in, of those that overlap.
    pub insides: Insides,
}

impl Place {
    /// Outside of everything.
    pub const OPEN_AIR: Self = Self { medium: MediumId(0), insides: Insides::NONE };
}

/// Where a point is: on the near side of the nearest interface seen from there, looking through opaque surfaces, and
/// so for each mesh that overlaps others; outside of those of which nothing is seen. `time` is in frames.
pub fn place_of<'s>(
    point: Vec3,
    time: f32,
    accel: &Accel,
    surface: impl Fn(u32) -> &'s Surface,
    layers: &Layers,
) -> Place {
    if !layers.is_empty() {
        return place_among_layers(point, time, accel, surface, layers);
    }
    let seen = directions()
        .filter_map(|direction| nearest_interface(Ray::new(point, direction).at_time(time), accel, &surface));
    let medium = seen.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(MediumId(0), |(_, medium)| medium);
    Place { medium, ..Place::OPEN_AIR }
}

fn directions() -> impl Iterator<Item = Vec3> {
    (0..26_u32).map(|i| {
        // A spiral over the sphere: no axis is special, so none is likely to graze a face of a box.
        let z = 1.0 - (2.0 * i as f32 + 1.0) / 26.0;
        let (sin, cos) = crate::geometry::elementary::sin_cos(2.399_963_2 * i as f32 + 0.3);
        let r = (1.0 - z * z).sqrt();
        Vec3::new(r * cos, r * sin, z)
    })
}

/// Distance and near medium of the first interface along a ray.
fn nearest_interface<'s>(
    mut ray: Ray,
    accel: &Accel,
    surface: &impl Fn(u32) -> &'s Surface,
) -> Option<(f32, MediumId)> {
    let mut ignored = Ignored::NOTHING;
    let mut travelled = 0.0;
    // More opaque sheets than this in a row do not occur outside of contrived scenes.
    for _ in 0..64 {
        let hit = accel.closest(&ray, ignored)?;
        travelled += hit.t;
        if let Surface::Interface(pair) = surface(hit.triangle) {
            return Some((travelled, pair.crossed(hit.from_front).0));
        }
        ray.origin = ray.at(hit.t);
        ignored = Ignored::one(hit.triangle);
    }
    None
}

/// Every triangle along the rays is asked for: faces that lie on each other must not hide one another.
fn place_among_layers<'s>(
    point: Vec3,
    time: f32,
    accel: &Accel,
    surface: impl Fn(u32) -> &'s Surface,
    layers: &Layers,
) -> Place {
    let mut interface = (f32::INFINITY, MediumId(0));
    // By all regions of a mesh, how far its nearest face is and which of them is on this side of it.
    let mut nearest: BTreeMap<Insides, (f32, Insides)> = BTreeMap::new();
    for direction in directions() {
        accel.each_hit(&Ray::new(point, direction).at_time(time), Ignored::NOTHING, |hit| {
            match surface(hit.triangle) {
                Surface::Interface(pair) if hit.t < interface.0 => {
                    interface = (hit.t, pair.crossed(hit.from_front).0);
                }
                Surface::Layer(layer) => {
                    let found = nearest.entry(layer.mesh).or_insert((f32::INFINITY, Insides::NONE));
                    if hit.t < found.0 {
                        *found = (hit.t, layer.near(hit.from_front));
                    }
                }
                _ => {}
            }
            false
        });
    }
    let insides = nearest.values().fold(Insides::NONE, |all, (_, near)| all.and(*near));
    let is_nearer = nearest.values().all(|(t, _)| interface.0 < *t) && interface.0.is_finite();
    Place { medium: if is_nearer { interface.1 } else { layers.medium(insides) }, insides }
}
