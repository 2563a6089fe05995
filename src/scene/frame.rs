//! One frame as rays see it.

use super::camera_path::{StartMedia, Views};
use super::geometry::Geometry;
use super::needs::Needs;
use super::surface::{MediumPair, Surface};
use crate::accel::{Accel, Hit, Ignored};
use crate::geometry::Ray;
use crate::light::{Beneath, Lights};
use crate::optics::medium::{Medium, MediumId};
use crate::spectrum::{LaneCurve, LaneMode, Lanes, Wavelengths, film_rgb};
use glam::{DVec3, Vec3};

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
    pub start_media: StartMedia,
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
    /// All triangles.
    pub geometry: Geometry,
    /// What triangles are, by [`super::surface::SurfaceId`].
    pub surfaces: Vec<Surface>,
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

    /// What lanes of reflected white light look like, linear RGB.
    pub fn colour_of(&self, reflected: Lanes, wavelengths: &Wavelengths) -> Vec3 {
        film_rgb(self.mode, wavelengths, reflected * self.white.lanes(wavelengths))
    }

    /// True where next-event estimation can find a light.
    #[inline]
    pub fn looks_for_lights(&self, id: MediumId) -> bool {
        self.lit[id.0 as usize] || self.beneath[id.0 as usize].is_some()
    }

    /// True when a ray in `medium` can meet what it has hit: an opaque surface, or an interface of that medium.
    #[inline]
    pub fn is_boundary_of(&self, medium: MediumId, hit: &Hit) -> bool {
        match self.surface(hit.triangle) {
            Surface::Interface(pair) => pair.crossed(hit.from_front).0 == medium,
            _ => true,
        }
    }

    /// The medium that an eye ray begins in.
    pub fn start_medium(&self, eye: &Ray) -> MediumId {
        match self.start_media {
            StartMedia::One(medium) => medium,
            StartMedia::Several => self.medium_at(eye.origin, eye.time),
        }
    }

    /// The medium at a point ([`medium_at`]).
    pub fn medium_at(&self, point: Vec3, time: f32) -> MediumId {
        let pair_of = |triangle: u32| match self.surface(triangle) {
            Surface::Interface(pair) => Some(*pair),
            _ => None,
        };
        medium_at(point, time, &self.accel, pair_of, MediumId(0))
    }

    /// What a triangle is.
    #[inline]
    pub fn surface(&self, triangle: u32) -> &Surface {
        &self.surfaces[self.geometry.surfaces[triangle as usize].0 as usize]
    }
}

/// The medium at a point: that on the near side of the nearest interface seen from there, looking through opaque
/// surfaces; `outside` where no interface is seen. `time` is in frames.
pub fn medium_at(
    point: Vec3,
    time: f32,
    accel: &Accel,
    pair_of: impl Fn(u32) -> Option<MediumPair>,
    outside: MediumId,
) -> MediumId {
    let directions = (0..26_u32).map(|i| {
        // A spiral over the sphere: no axis is special, so none is likely to graze a face of a box.
        let z = 1.0 - (2.0 * i as f32 + 1.0) / 26.0;
        let (sin, cos) = crate::geometry::elementary::sin_cos(2.399_963_2 * i as f32 + 0.3);
        let r = (1.0 - z * z).sqrt();
        Vec3::new(r * cos, r * sin, z)
    });
    let seen = directions
        .filter_map(|direction| nearest_interface(Ray::new(point, direction).at_time(time), accel, &pair_of));
    seen.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(outside, |(_, medium)| medium)
}

/// Distance and near medium of the first interface along a ray.
fn nearest_interface(
    mut ray: Ray,
    accel: &Accel,
    pair_of: &impl Fn(u32) -> Option<MediumPair>,
) -> Option<(f32, MediumId)> {
    let mut ignored = Ignored::NOTHING;
    let mut travelled = 0.0;
    // More opaque sheets than this in a row do not occur outside of contrived scenes.
    for _ in 0..64 {
        let hit = accel.closest(&ray, ignored)?;
        travelled += hit.t;
        if let Some(pair) = pair_of(hit.triangle) {
            return Some((travelled, pair.crossed(hit.from_front).0));
        }
        ray.origin = ray.at(hit.t);
        ignored = Ignored::one(hit.triangle);
    }
    None
}
