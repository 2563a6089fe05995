//! The scene file as plain data: what it says, checked, with every default filled in.
//!
//! [`SceneDescription::from_file`] reads it. Each kind of table has a file here that reads it; unknown keys,
//! wrong types and numbers out of range are errors with line and column and what to write instead.
//! [`default_scene`] writes the scene of a folder that has none. Values that depend on other files (meshes,
//! images) are checked where those are read.

mod allowed;
mod camera;
mod coefficients;
mod daylight;
mod density;
mod document;
mod domain;
mod error;
mod examples;
mod framed;
mod frames;
mod framing;
mod material;
mod media;
mod meshes;
mod models;
mod nearest;
mod output;
mod phase;
mod regions;
mod render;
mod scene;
mod settings;
mod sky;
mod spectral_phase;
mod spectrum_value;
mod sun;
mod sun_place;
mod surfaces;
mod value;

pub use camera::{CameraDescription, CameraKey, FieldOfView, Placement, TurntableDescription};
pub use daylight::Daylight;
pub use error::{Place, SceneError};
pub use examples::{EXAMPLES, Example};
pub use framed::default_scene;
pub use framing::automatic_placement;
pub use meshes::{MeshContents, MeshDescription};
pub use models::{Model, ModelKind, ModelPhase};
pub use nearest::suggestion;

use std::collections::BTreeMap;
use std::path::PathBuf;

use glam::{DVec3, Vec3};

use crate::light::ClearAir;
use crate::mesh::Region;
use crate::optics::RefractiveIndex;
use crate::optics::phase::MediumPhase;
use crate::spectrum::Spectrum;

/// Everything that a scene file says.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneDescription {
    /// The scene file; messages name it.
    pub file: PathBuf,
    /// The folder that input paths are relative to (the scene file's).
    pub directory: PathBuf,
    /// The simulated frames; `None` makes the scene one still frame, number 1.
    pub frames: Option<FramesDescription>,
    /// The meshes of a frame, where `frames.path` does not name it.
    pub meshes: Vec<MeshDescription>,
    /// Medium names by label; label 0 is "air" unless the file says otherwise.
    pub regions: BTreeMap<Region, String>,
    /// The simulated box and its walls.
    pub domain: Option<DomainDescription>,
    /// Media by name. "air" (index 1, clear) is there unless the file defines it.
    pub media: BTreeMap<String, MediumDescription>,
    /// Meshes that the simulator did not write.
    pub surfaces: Vec<SurfaceDescription>,
    /// The discs of suns, the one that lights a clear sky first.
    pub suns: Vec<SunDescription>,
    /// Light from everywhere else.
    pub sky: SkyDescription,
    /// The camera.
    pub camera: CameraDescription,
    /// How to render.
    pub render: RenderDescription,
    /// Where to and in which form.
    pub output: OutputDescription,
}

/// `[frames]`
#[derive(Clone, Debug, PartialEq)]
pub struct FramesDescription {
    /// Pattern (`####`, `%04d`, `$F4`), glob, or folder, relative to the scene file; empty where `[[meshes]]` have theirs.
    pub path: String,
    /// Frames a second (24).
    pub fps: f64,
    /// Metres per unit of the frame files (1).
    pub scale: f64,
    /// The direction called up (z).
    pub up: Axis,
    /// Where shading normals come from (smooth).
    pub normals: NormalsDescription,
    /// Where velocities come from (auto).
    pub velocity: VelocityDescription,
    /// The label inside closed meshes that carry no labels (1).
    pub inside: Region,
}

/// Where the velocities of vertices come from, which motion blur needs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum VelocityDescription {
    /// From the frame files, under any name that simulators are known to use.
    #[default]
    Auto,
    /// From nowhere: nothing moves within a frame.
    None,
    /// From the next frame, where its triangles are the same in the same order.
    Frames,
    /// From the frame files, under this name.
    Property(String),
}

/// A signed coordinate axis, as in `up = "z"` or `up = "-y"`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axis {
    /// 0, 1, 2 for x, y, z.
    pub index: usize,
    /// True for the negative direction.
    pub negative: bool,
}

impl Axis {
    /// The default up.
    pub const Z: Self = Self { index: 2, negative: false };

    /// The unit vector.
    pub fn vector(self) -> Vec3 {
        let mut v = Vec3::ZERO;
        v[self.index] = if self.negative { -1.0 } else { 1.0 };
        v
    }
}

/// Where shading normals come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NormalsDescription {
    /// Averaged over the faces between the same two regions, never across a triple line.
    #[default]
    Smooth,
    /// The faces' own.
    Flat,
    /// The file's, where they are finite and agree with the face.
    File,
}

/// `[domain]`: the faces on the planes of the simulated box.
#[derive(Clone, Debug, PartialEq)]
pub struct DomainDescription {
    /// Least corner, in the frame files' units.
    pub min: DVec3,
    /// Greatest corner, in the frame files' units.
    pub max: DVec3,
    /// The four walls that stand upright.
    pub sides: Wall,
    /// The wall below; never [`Wall::Extend`]: below extended sides it is open unless it is opaque.
    pub bottom: Wall,
    /// The wall above; kept unless named, never [`Wall::Extend`].
    pub top: Wall,
    /// Reflectance of opaque walls (0.5).
    pub reflectance: Spectrum,
}

/// What the faces on a plane of the simulated box are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wall {
    /// An interface like any other.
    #[default]
    Keep,
    /// An index-matched boundary: the region changes, nothing bends or reflects, L / n^2 holds.
    Open,
    /// A diffuse wall.
    Opaque,
    /// The surface goes on flat to the horizon, fluid below it without end.
    Extend,
}

/// `[media.NAME]`
#[derive(Clone, Debug, PartialEq)]
pub struct MediumDescription {
    /// Refractive index.
    pub ior: RefractiveIndex,
    /// Absorption in 1/m; `None` takes what the index's table implies (4 pi k / lambda), or nothing.
    pub absorption: Option<AbsorptionDescription>,
    /// Scattering in 1/m.
    pub scattering: Spectrum,
    /// What takes the place of absorption and scattering.
    pub extinction: Option<ExtinctionDescription>,
    /// Radiance of an endless depth, seen from a medium of index 1 (0).
    pub emission: Spectrum,
    /// Phase function of the scattering.
    pub phase: MediumPhase,
    /// Where the medium is how dense.
    pub density: DensityDescription,
    /// What takes the place of index, coefficients and phase function.
    pub model: Option<Model>,
}

/// `extinction = ..`, `albedo = ..`
#[derive(Clone, Debug, PartialEq)]
pub struct ExtinctionDescription {
    /// Absorption and scattering together, in 1/m.
    pub extinction: Spectrum,
    /// The share of scattering in it.
    pub albedo: Spectrum,
    /// The share of absorption: 1 less that, with its digits where that is next to 1.
    pub absorbed: Spectrum,
}

/// `density = ..`, relative: both coefficients are multiplied by it.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum DensityDescription {
    /// 1 everywhere.
    #[default]
    Homogeneous,
    /// exp((height - surface) / depth), heights along `frames.up`.
    Stratified {
        /// Distance in metres over which the density falls to 1/e: downwards, or upwards when negative.
        depth: f64,
        /// Height at which the density is 1, in metres (0).
        surface: f64,
    },
    /// A file of densities.
    Grid {
        /// The file (.npy or .nrrd) or per-frame pattern, relative to the scene file.
        file: String,
        /// Least corner of the box that it fills, in metres.
        min: DVec3,
        /// Greatest corner, in metres.
        max: DVec3,
    },
}

/// `absorption = ..`
#[derive(Clone, Debug, PartialEq)]
pub enum AbsorptionDescription {
    /// Coefficients in 1/m.
    Spectrum(Spectrum),
    /// Measured absorption of pure water: `{ table = "water" }`.
    Water,
    /// Measured absorption of pure ice: `{ table = "ice" }`.
    Ice,
}

/// `[[surfaces]]`
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceDescription {
    /// Mesh file or per-frame pattern, relative to the scene file.
    pub mesh: String,
    /// Where shading normals come from.
    pub normals: NormalsDescription,
    /// Metres per unit of the file.
    pub scale: f64,
    /// Added after scaling, in metres.
    pub translate: DVec3,
    /// What the surface is.
    pub material: MaterialDescription,
}

/// `material = { kind = .. }`, with the media of the two sides where the kind has any.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialDescription {
    /// Lambertian on both sides.
    Diffuse {
        /// Reflectance in [0, 1].
        reflectance: Spectrum,
    },
    /// A smooth boundary between two media.
    Dielectric {
        /// Medium on the front.
        front: String,
        /// Medium on the back.
        back: String,
    },
    /// A boundary that changes the medium and bends nothing.
    Null {
        /// Medium on the front.
        front: String,
        /// Medium on the back.
        back: String,
    },
    /// A smooth metal of complex index eta + i k relative to vacuum.
    Conductor {
        /// Real part.
        eta: Spectrum,
        /// Imaginary part.
        k: Spectrum,
    },
    /// One-sided (front) light; opaque and black otherwise.
    Emitter {
        /// Emitted radiance.
        radiance: Spectrum,
    },
}

/// `[sun]`, or one of several `[[sun]]`
#[derive(Clone, Debug, PartialEq)]
pub struct SunDescription {
    /// Unit vector towards the sun.
    pub direction: Vec3,
    /// Horizontal unit vector that azimuths count from, clockwise seen from above.
    pub north: Vec3,
    /// Diameter of the disc in degrees (0.53).
    pub angular_diameter: f32,
    /// Irradiance on a plane perpendicular to the direction.
    pub irradiance: Spectrum,
}

/// `[sky]`
#[derive(Clone, Debug, PartialEq)]
pub enum SkyDescription {
    /// The same radiance from everywhere; 0 when the file has no `[sky]`.
    Constant(Spectrum),
    /// A latitude-longitude picture (EXR or HDR), its top towards `frames.up`.
    Image {
        /// The file, relative to the scene file.
        image: String,
    },
    /// A clear sky by day, whose light comes from the scene's first sun: `{ model = "hosek-wilkie" }`.
    Clear(ClearAir),
}

/// `[render]`
#[derive(Clone, Debug, PartialEq)]
pub struct RenderDescription {
    /// Which integrator (auto).
    pub integrator: IntegratorKind,
    /// Samples a pixel, at most where there is a target (64).
    pub samples: u32,
    /// Relative error at which a frame stops; `None` gives every pixel all samples.
    pub target_error: Option<f64>,
    /// Confidence of the intervals of estimated errors (0.95).
    pub confidence: f64,
    /// Interactions along a path; 0 is no limit (0).
    pub max_depth: u32,
    /// Both branches are followed on the first `split` interface hits (1).
    pub split: u32,
    /// Both what is scattered and what gets through are followed on the first so many ways through media (0).
    pub forced_scattering: u32,
    /// Order of the similarity relations that simplify scattering in thick media; 0 is exact (0).
    pub similarity: u32,
    /// Light of every wavelength bends at its own index (false).
    pub dispersion: bool,
    /// Seed of every random number (0).
    pub seed: u64,
    /// What frames share of their random numbers; `None` is `sequence` where that is possible, else `frame`.
    pub seed_mode: Option<SeedMode>,
    /// Pixel filter (box).
    pub filter: FilterKind,
    /// Photons of the photon integrator, and those beside beams.
    pub photons: PhotonDescription,
}

/// `render.photons`
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhotonDescription {
    /// Photons emitted in each pass; 0 is as many as there are pixels, from 10,000 to 1,000,000 (0).
    pub count: u32,
    /// First radius on surfaces in metres; `None` finds it from the photons.
    pub radius: Option<f32>,
    /// First radius around rays in media in metres; `None` finds it from the photons.
    pub volume_radius: Option<f32>,
    /// alpha of the shrinking radii, in (0, 1]; 1 keeps them (2/3).
    pub shrink: f32,
    /// How flux is spread (epanechnikov).
    pub kernel: KernelKind,
    /// Photons are asked for at the second diffuse surface of an eye path instead of the first (true).
    pub final_gather: bool,
    /// The directions of photons draw those of final gathering (true).
    pub guide: bool,
    /// Photons carry the light of the sky; `None` decides by the scene: where a medium scatters,
    /// or a small part of the sky has most of its light.
    pub sky: Option<bool>,
}

/// `render.photons.kernel`
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum KernelKind {
    /// The same within the radius.
    Constant,
    /// Falls linearly to the rim.
    Cone,
    /// Falls with the square of the distance: the least error for a given radius.
    #[default]
    Epanechnikov,
}

/// `render.integrator`
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum IntegratorKind {
    /// What suits the scene; at present path tracing.
    #[default]
    Auto,
    /// Volumetric path tracing.
    Path,
    /// Progressive photon mapping.
    Photon,
    /// Path tracing that finds the sun through one refracting interface, with photons for the rest of it.
    Beams,
    /// Paths that turn at one particle at most.
    SingleScattering,
    /// Paths that turn at none: an ambient radiance is scattered in.
    Fog,
    /// The open part of the hemisphere over what the camera sees.
    AmbientOcclusion,
}

/// `render.seed_mode`
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeedMode {
    /// Every frame has numbers of its own.
    Frame,
    /// Frames take one block after the other of the same low-discrepancy sequences.
    Sequence,
    /// Every frame has the same numbers.
    Static,
}

impl SeedMode {
    /// Every mode, by its name in the scene file.
    pub const ALL: [(&'static str, Self); 3] =
        [("frame", Self::Frame), ("sequence", Self::Sequence), ("static", Self::Static)];

    /// Its name in the scene file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Frame => "frame",
            Self::Sequence => "sequence",
            Self::Static => "static",
        }
    }
}

/// `render.filter`
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FilterKind {
    /// The pixel's own area.
    #[default]
    Box,
    /// A Gaussian of standard deviation 0.5 pixels within 1.5.
    Gaussian,
    /// The four-term Blackman-Harris window within 2 pixels.
    BlackmanHarris,
}

/// `[output]`
#[derive(Clone, Debug, PartialEq)]
pub struct OutputDescription {
    /// File or pattern relative to the current directory; `None` is `out/<folder>/frame_####.exr`.
    pub path: Option<String>,
    /// Also write a PNG beside each EXR (true).
    pub png: bool,
    /// Exposure of the PNG in stops (0; under a clear sky that of [`Daylight::exposure`]).
    pub exposure: f32,
    /// Also write each picture without its noise (false).
    pub denoise: bool,
    /// Extra layers of the EXR.
    pub aovs: Vec<Aov>,
}

/// `output.aovs`
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Aov {
    /// Colour of the first surface.
    Albedo,
    /// Shading normal of the first surface, in world coordinates.
    Normal,
    /// Position of the first surface, in metres.
    Position,
    /// Depth of the first surface along the viewing axis, in metres.
    Depth,
    /// Variance of the pixel's mean.
    Variance,
    /// Where the first surface goes until the next frame, in pixels.
    Motion,
    /// Samples in the pixel's mean.
    Samples,
}
