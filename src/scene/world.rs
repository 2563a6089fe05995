//! What all frames of a sequence share: media, lights, the camera, the origin.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use glam::DVec3;

use super::camera_path::CameraPath;
use super::density;
use super::description::{
    FramesDescription, IntegratorKind, MaterialDescription, MediumDescription, MeshDescription, Placement,
    SceneDescription, SkyDescription, SurfaceDescription,
};
use super::error::FrameError;
use super::inputs::{ContentHash, Inputs};
use super::modelled;
use super::parts::Parts;
use super::surface::MediumPair;
use crate::light::{ClearSky, Environment, Sun};
use crate::mesh::{Region, VelocityName};
use crate::optics::density::Density;
use crate::optics::medium::{Medium, MediumId};
use crate::optics::medium_reduction::MediumReduction;
use crate::optics::phase::MediumPhase;
use crate::sequence::{FrameNumber, SequenceError, frame_path, has_place, is_sequence};
use crate::spectrum::{LaneCurve, LaneMode, Role, Spectrum};

/// A scene without the meshes that change.
#[derive(Clone, Debug)]
pub struct World {
    /// The scene file.
    pub description: SceneDescription,
    /// What the lanes of paths stand for.
    pub mode: LaneMode,
    /// The point that coordinates are relative to, in metres; the same for every frame.
    pub origin: DVec3,
    /// Where the camera is in which frame.
    pub camera: CameraPath,
    /// Media by [`MediumId`]; the first is that of region 0.
    pub media: Vec<Medium>,
    /// What takes the place of the media's scattering in frames where they are thick, if the scene asks for it.
    pub(super) reductions: Vec<Option<MediumReduction>>,
    /// The sky.
    pub environment: Environment,
    /// The suns.
    pub suns: Vec<Sun>,
    /// Hashes of the files that every frame is made of: sky, grids and surfaces, in the order of the scene.
    pub contents: Vec<ContentHash>,
    /// The `[[surfaces]]` and `[[meshes]]` that are the same in every frame, those without a pattern, ready for rays.
    pub(super) still: Parts,
    names: BTreeMap<String, MediumId>,
}

impl World {
    /// Prepares everything but the meshes that change. `placement` is where the camera goes when the scene does not say.
    ///
    /// # Errors
    /// When a picture of the sky or a mesh that is the same in every frame cannot be read, or has no place here.
    pub fn new(description: SceneDescription, placement: Placement) -> Result<Self, FrameError> {
        Self::of_inputs(description, placement, Inputs::default())
    }

    /// As [`World::new`]; files that are among the `inputs` are not read.
    ///
    /// # Errors
    /// Those of [`World::new`].
    pub fn of_inputs(
        mut description: SceneDescription,
        placement: Placement,
        mut inputs: Inputs,
    ) -> Result<Self, FrameError> {
        let mode = lane_mode(&description);
        let placement = *description.camera.placement.get_or_insert(placement);
        let origin = snapped(placement.eye);
        let camera = CameraPath::new(&description.camera, placement, origin);
        let (mut media, names) = media_of(&description, mode)?;
        for medium in &mut media {
            let density = &description.media[&medium.name].density;
            medium.density = density::still(density, &description, origin, &mut inputs)?;
        }
        let environment = environment_of(&description, mode, &mut inputs)?;
        let suns = description.suns.iter().map(|sun| {
            let irradiance = sun.irradiance.prepare(Role::Illuminant, mode);
            Sun::new(sun.direction, sun.angular_diameter, irradiance)
        });
        let suns = suns.collect();
        let order = description.render.similarity as usize;
        let reductions = media.iter().map(|medium| MediumReduction::of(&medium.phase, order)).collect();
        let (still, contents) = (Parts::default(), Vec::new());
        let mut world = Self {
            description,
            mode,
            origin,
            camera,
            media,
            reductions,
            environment,
            suns,
            contents,
            still,
            names,
        };
        world.still = world.still_parts(&mut inputs)?;
        world.contents = inputs.hashes();
        Ok(world)
    }

    /// The media of one frame: those with a grid for each frame get theirs.
    pub(super) fn media_at(
        &self,
        number: FrameNumber,
        inputs: &mut Inputs,
    ) -> Result<Vec<Medium>, FrameError> {
        let mut media = self.media.clone();
        for medium in &mut media {
            let description = &self.description.media[&medium.name].density;
            let density = density::of_frame(description, &self.description, self.origin, number, inputs)?;
            if let Some(density) = density {
                medium.density = density;
            }
        }
        Ok(media)
    }

    /// The `[[surfaces]]` that have a mesh for each frame, with that of one frame.
    pub(super) fn surfaces_of_frame(
        &self,
        number: FrameNumber,
    ) -> impl Iterator<Item = Result<(&SurfaceDescription, PathBuf), SequenceError>> {
        let own = self.description.surfaces.iter().filter(|s| has_place(&s.mesh));
        own.map(move |s| Ok((s, self.description.directory.join(frame_path(&s.mesh, number)?))))
    }

    /// The grids that only one frame has.
    pub(super) fn grids_of_frame(
        &self,
        number: FrameNumber,
    ) -> impl Iterator<Item = Result<PathBuf, SequenceError>> {
        let media = self.description.media.values();
        media.filter_map(move |m| density::file_of_frame(&m.density, &self.description, number))
    }

    fn still_parts(&self, inputs: &mut Inputs) -> Result<Parts, FrameError> {
        let mut parts = Parts { warnings: self.media_warnings(), ..Parts::default() };
        for surface in self.description.surfaces.iter().filter(|s| !has_place(&s.mesh)) {
            let path = self.description.directory.join(&surface.mesh);
            parts.add_surface(self, surface, inputs.mesh(&path, &VelocityName::Nothing)?, &path)?;
        }
        for (which, mesh) in self.meshes(true) {
            let path = self.description.directory.join(&mesh.path);
            parts.add_body(self, which, inputs.mesh(&path, &VelocityName::Nothing)?, &path)?;
        }
        Ok(parts)
    }

    /// What is to be known of what media are made of.
    fn media_warnings(&self) -> Vec<String> {
        let told = self.description.media.iter().flat_map(|(name, medium)| {
            medium.warnings().into_iter().map(move |text| format!("[media.{name}] {text}"))
        });
        told.collect()
    }

    /// The medium that fills a region.
    pub fn medium_of_region(&self, region: Region, path: &Path) -> Result<MediumId, FrameError> {
        self.description.regions.get(&region).and_then(|name| self.medium_of_name(name)).ok_or_else(|| {
            FrameError::NoMedium { path: path.into(), label: region.0, scene: self.description.file.clone() }
        })
    }

    /// The boundary between two media.
    pub(super) fn pair_of(&self, front: MediumId, back: MediumId) -> MediumPair {
        let medium = |id: MediumId| &self.media[id.0 as usize];
        MediumPair { front, back, matched: medium(front).is_matched_with(medium(back)) }
    }

    /// The `[[meshes]]` that are the same in every frame, or the others, with their places in the scene file.
    pub(super) fn meshes(&self, still: bool) -> impl Iterator<Item = (usize, &MeshDescription)> {
        let directory = &self.description.directory;
        let meshes = self.description.meshes.iter().enumerate();
        meshes.filter(move |(_, mesh)| is_sequence(directory, &mesh.path) != still)
    }

    /// The medium of a name in `[media]`.
    pub fn medium_of_name(&self, name: &str) -> Option<MediumId> {
        self.names.get(name).copied()
    }

    /// `[frames]`, if the scene has any.
    pub fn frames(&self) -> Option<&FramesDescription> {
        self.description.frames.as_ref()
    }

    /// Frames a second; those of film for a still.
    pub fn fps(&self) -> f64 {
        self.frames().map_or(24.0, |frames| frames.fps)
    }
}

/// Metres. Far from zero a grid that went on growing would leave the eye kilometres from the origin, and with it all
/// that it sees on steps of millimetres.
const COARSEST_GRID: f64 = 0.125;

/// Coordinates are exact to f32 relative to this point: near the eye, on a grid of 1/256 of its distance from zero
/// or of [`COARSEST_GRID`], so that coordinates of like size keep their digits when it is subtracted.
fn snapped(eye: DVec3) -> DVec3 {
    let size = eye.abs().max_element();
    if size == 0.0 {
        return DVec3::ZERO;
    }
    let (_, exponent) = libm::frexp(size);
    let grid = libm::ldexp(1.0, exponent - 8).min(COARSEST_GRID);
    (eye / grid).round() * grid
}

/// Spectral as soon as one thing that is used is.
fn lane_mode(description: &SceneDescription) -> LaneMode {
    if description.render.integrator == IntegratorKind::AmbientOcclusion {
        return LaneMode::Rgb;
    }
    let bends = description.render.dispersion && description.media.values().any(|m| m.ior.disperses());
    let spectral = bends
        || description.media.values().any(medium_is_spectral)
        || description.surfaces.iter().any(|s| material_is_spectral(&s.material))
        || description.suns.iter().any(|sun| sun.irradiance.is_spectral())
        || match &description.sky {
            SkyDescription::Constant(sky) => sky.is_spectral(),
            SkyDescription::Image { .. } => false,
            SkyDescription::Clear(_) => true,
        }
        || description.domain.as_ref().is_some_and(|d| d.reflectance.is_spectral());
    if spectral { LaneMode::Spectral } else { LaneMode::Rgb }
}

fn material_is_spectral(material: &MaterialDescription) -> bool {
    match material {
        MaterialDescription::Diffuse { reflectance } => reflectance.is_spectral(),
        MaterialDescription::Conductor { eta, k } => eta.is_spectral() || k.is_spectral(),
        MaterialDescription::Emitter { radiance } => radiance.is_spectral(),
        MaterialDescription::Dielectric { .. } | MaterialDescription::Null { .. } => false,
    }
}

fn medium_is_spectral(medium: &MediumDescription) -> bool {
    let coefficients = match &medium.extinction {
        Some(given) => given.extinction.is_spectral() || given.albedo.is_spectral(),
        None => medium.absorbed().is_spectral() || medium.scattering.is_spectral(),
    };
    let phase = matches!(medium.phase, MediumPhase::Spectral(_));
    coefficients || phase || medium.emission.is_spectral() || medium.model.is_some()
}

fn media_of(
    description: &SceneDescription,
    mode: LaneMode,
) -> Result<(Vec<Medium>, BTreeMap<String, MediumId>), FrameError> {
    let outside = description.regions.get(&Region::OUTSIDE);
    let mut order: Vec<&String> = description.media.keys().collect();
    order.sort_by_key(|name| (Some(*name) != outside, *name));
    let media = order.iter().map(|name| medium_of(description, name, mode)).collect::<Result<_, _>>()?;
    let names = order.into_iter().cloned().zip((0..).map(MediumId)).collect();
    Ok((media, names))
}

fn medium_of(description: &SceneDescription, name: &str, mode: LaneMode) -> Result<Medium, FrameError> {
    let medium = &description.media[name];
    let ([sigma_a, sigma_s], phase) = match &medium.model {
        Some(model) => modelled::light_in(model, mode).map_err(|source| {
            let (scene, medium) = (description.file.clone(), name.to_owned());
            FrameError::Mixture { scene, medium, source: Box::new(source) }
        })?,
        None => (coefficients_of(medium, mode), medium.phase.clone()),
    };
    let n = medium.ior.for_rays();
    let disperses = description.render.dispersion && mode == LaneMode::Spectral && medium.ior.disperses();
    let index = match disperses {
        true => LaneCurve::sampled(|lambda| medium.ior.n(lambda)),
        false => LaneCurve::Constant(n),
    };
    Ok(Medium {
        name: name.into(),
        n,
        index,
        sigma_a,
        sigma_s,
        emission: medium.emission.prepare(Role::Illuminant, mode),
        phase,
        density: Density::default(),
    })
}

/// Absorption and scattering.
fn coefficients_of(medium: &MediumDescription, mode: LaneMode) -> [LaneCurve; 2] {
    match &medium.extinction {
        Some(given) => {
            let sigma_t = given.extinction.prepare(Role::Coefficient, mode);
            let albedo = given.albedo.prepare(Role::Reflectance, mode);
            let share = |share: &LaneCurve| sigma_t.combined(share, |t, share| t * share);
            // Over wavelength what a colour leaves of 1 is not the curve of what its numbers leave.
            let is_upsampled = mode == LaneMode::Spectral && matches!(given.albedo, Spectrum::Rgb(_));
            let absorbed = match is_upsampled {
                true => albedo.combined(&albedo, |a, _| 1.0 - a),
                false => given.absorbed.prepare(Role::Reflectance, mode),
            };
            [share(&absorbed), share(&albedo)]
        }
        None => [
            medium.absorbed().prepare(Role::Coefficient, mode),
            medium.scattering.prepare(Role::Coefficient, mode),
        ],
    }
}

impl MediumDescription {
    /// A medium without a model over wavelength, at a density of 1 everywhere.
    pub fn over_wavelength(&self) -> Medium {
        let [sigma_a, sigma_s] = coefficients_of(self, LaneMode::Spectral);
        Medium {
            name: String::new(),
            n: self.ior.for_rays(),
            index: LaneCurve::Constant(self.ior.for_rays()),
            sigma_a,
            sigma_s,
            emission: LaneCurve::Constant(0.0),
            phase: self.phase.clone(),
            density: Density::default(),
        }
    }
}

fn environment_of(
    description: &SceneDescription,
    mode: LaneMode,
    inputs: &mut Inputs,
) -> Result<Environment, FrameError> {
    let up = description.frames.as_ref().map_or(super::description::Axis::Z, |f| f.up).vector();
    match (&description.sky, description.suns.first()) {
        (SkyDescription::Constant(radiance), _) => {
            Ok(Environment::Constant(radiance.prepare(Role::Illuminant, mode)))
        }
        (SkyDescription::Image { image }, _) => {
            let picture = inputs.picture(&description.directory.join(image))?;
            Ok(Environment::image(picture, up, mode))
        }
        (SkyDescription::Clear(air), Some(sun)) => {
            let sky = ClearSky::new(*air, sun.direction, &sun.irradiance, up, mode);
            Ok(Environment::Clear(Box::new(sky)))
        }
        // No scene file says this: a clear sky without a sun is night.
        (SkyDescription::Clear(_), None) => Ok(Environment::Constant(LaneCurve::Constant(0.0))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_origin_is_near_the_eye_and_on_a_grid_of_a_power_of_two() {
        let surveyed = DVec3::new(500_000.37, 4_000_000.9, 31.5);
        for eye in [DVec3::new(1.1, 2.3, -2.3), surveyed, DVec3::splat(1e7 + 0.3), DVec3::splat(1e-5)] {
            let origin = snapped(eye);
            let size = eye.abs().max_element();
            assert!((eye - origin).abs().max_element() <= (size / 256.0).min(0.0625));
            // On the grid, so that the difference to a float of like size is a float.
            let bits = origin / libm::ldexp(1.0, libm::frexp(size).1 - 8).min(COARSEST_GRID);
            assert_eq!(bits, bits.round());
        }
        assert_eq!(snapped(DVec3::ZERO), DVec3::ZERO);
    }
}
