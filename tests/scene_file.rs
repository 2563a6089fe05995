//! The scene file: what is right is read as written, what is wrong is named with its place and its cure.

use std::path::Path;

use floe::mesh::Region;
use floe::optics::RefractiveIndex;
use floe::optics::phase::{HenyeyGreenstein, Isotropic, PhaseFunction};
use floe::scene::description::*;
use floe::spectrum::Spectrum;
use glam::{DVec3, Vec3};
use proptest::prelude::*;

mod scene_file {
    mod camera;
    mod daylight;
    mod models;
    mod phases;
}

fn parse(text: &str) -> Result<SceneDescription, SceneError> {
    SceneDescription::parse(text, Path::new("folder/s.toml"))
}

fn example(name: &str) -> SceneDescription {
    let Some(example) = EXAMPLES.iter().find(|example| example.name == name) else {
        panic!("no example {name}")
    };
    parse(example.text).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn every_example_is_read() {
    for Example { name, .. } in EXAMPLES {
        assert_eq!(example(name).directory, Path::new("folder"));
    }
}

#[test]
fn an_empty_file_has_every_default() {
    let scene = example("empty");
    assert_eq!(scene.frames, None);
    assert_eq!(scene.regions.into_iter().collect::<Vec<_>>(), [(Region(0), "air".to_owned())]);
    assert_eq!(scene.media.keys().collect::<Vec<_>>(), ["air"]);
    let air = &scene.media["air"];
    assert_eq!((&air.ior, &air.absorption), (&RefractiveIndex::Constant(1.0), &None));
    assert_eq!(
        (&air.scattering, &air.phase),
        (&Spectrum::Constant(0.0), &PhaseFunction::Isotropic(Isotropic).into())
    );
    assert_eq!((scene.domain, scene.surfaces.len(), scene.suns.len()), (None, 0, 0));
    assert_eq!(scene.sky, SkyDescription::Constant(Spectrum::Constant(0.0)));
    assert_eq!(scene.camera.placement, None);
    assert_eq!((scene.camera.up, scene.camera.fov), (Vec3::Z, FieldOfView::Vertical(40.0)));
    assert_eq!(scene.camera.resolution, [640, 360]);
    let render = scene.render;
    assert_eq!((render.integrator, render.filter), (IntegratorKind::Auto, FilterKind::Box));
    assert_eq!((render.samples, render.max_depth, render.split, render.seed), (64, 0, 1, 0));
    assert_eq!((render.similarity, render.dispersion, render.seed_mode), (0, false, None));
    assert_eq!(
        scene.output,
        OutputDescription { path: None, png: true, exposure: 0.0, denoise: false, aovs: vec![] }
    );
    assert_eq!(SceneDescription::parse("", Path::new("s.toml")).unwrap().directory, Path::new("."));
}

#[test]
fn a_whole_scene_is_read_as_written() {
    let scene = example("sea and ice");
    let frames = scene.frames.unwrap();
    assert_eq!((frames.path.as_str(), frames.fps, frames.scale), ("frames/frame_####.ply", 24.0, 1.0));
    let domain = scene.domain.unwrap();
    assert_eq!((domain.sides, domain.bottom, domain.top), (Wall::Extend, Wall::Open, Wall::Keep));
    assert_eq!((domain.min, domain.max), (DVec3::new(-1.0, -1.0, -0.8), DVec3::new(1.0, 1.0, 0.8)));
    assert_eq!(domain.reflectance, Spectrum::Constant(0.5));
    let sea = &scene.media["sea"];
    let absorption = AbsorptionDescription::Spectrum(Spectrum::Rgb([0.35, 0.07, 0.03]));
    assert_eq!((&sea.ior, &sea.absorption), (&RefractiveIndex::Constant(1.33), &Some(absorption)));
    assert_eq!(sea.phase, PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g: 0.9 }).into());
    assert_eq!((scene.render.similarity, scene.render.seed_mode), (2, Some(SeedMode::Sequence)));
    assert!(scene.render.dispersion);
    let sun = &scene.suns[0];
    assert!((sun.direction.length() - 1.0).abs() < 1e-6 && sun.direction.x / sun.direction.y > 1.99);
    let placement = Placement { eye: DVec3::new(1.1, 2.3, 2.3), target: DVec3::new(0.0, 0.5, 0.0) };
    assert_eq!(scene.camera.placement, Some(placement));
    assert_eq!(
        (scene.camera.shutter, scene.camera.aperture, scene.camera.focus_distance),
        (0.5, 0.02, Some(3.5))
    );
    assert_eq!(scene.camera.turntable, Some(TurntableDescription { degrees_per_frame: 3.0, frame: 0.0 }));
    assert!(scene.output.denoise);
    assert_eq!(
        scene.output.aovs,
        [Aov::Albedo, Aov::Normal, Aov::Position, Aov::Depth, Aov::Motion, Aov::Variance, Aov::Samples]
    );
    assert_eq!((scene.render.target_error, scene.render.confidence), (Some(0.02), 0.9));
}

#[test]
fn spectra_in_every_form() {
    let scene = example("spectral");
    assert_eq!(scene.regions[&Region(-7)], "glass");
    assert_eq!(scene.regions[&Region(0)], "air");
    let frames = scene.frames.unwrap();
    assert_eq!((frames.inside, frames.up), (Region(4), Axis { index: 1, negative: true }));
    assert_eq!(frames.velocity, VelocityDescription::Property("momentum".into()));
    assert_eq!(scene.camera.up, -Vec3::Y);
    let water = &scene.media["water"];
    assert_eq!(water.ior, RefractiveIndex::Water { temperature: 10.0, salinity: 35.0 });
    assert_eq!(water.absorption, Some(AbsorptionDescription::Water));
    assert_eq!(scene.media["ice"].ior, RefractiveIndex::Ice);
    let glass = RefractiveIndex::Table {
        wavelengths: vec![400.0, 550.0, 700.0],
        n: vec![1.53, 1.52, 1.51],
        k: vec![0.0, 1e-8, 0.0],
    };
    assert_eq!(scene.media["glass"].ior, glass);
    let irradiance = Spectrum::Blackbody { temperature: 5778.0, luminance: 100_000.0 / 683.0 };
    assert_eq!(scene.suns[0].irradiance, irradiance);
    assert_eq!(scene.sky, SkyDescription::Constant(Spectrum::Planck { temperature: 1500.0 }));
    assert_eq!(scene.render.seed, u64::MAX);
    assert_eq!(example("plain numbers").render.integrator, IntegratorKind::Fog);
    let fog = &example("plain numbers").media["fog"];
    assert_eq!(fog.scattering, Spectrum::Constant(1000.0));
    assert_eq!(fog.absorption, Some(AbsorptionDescription::Spectrum(Spectrum::Constant(16.0))));
}

#[test]
fn photons_have_defaults_and_can_be_told() {
    let photons = example("automatic camera").render.photons;
    assert_eq!(
        (photons.count, photons.radius, photons.volume_radius, photons.shrink),
        (50_000, Some(0.1), Some(0.2), 0.8)
    );
    assert_eq!((photons.kernel, photons.final_gather), (KernelKind::Cone, false));
    assert_eq!((photons.guide, photons.sky), (false, Some(true)));
    let default = example("empty").render.photons;
    assert_eq!((default.count, default.radius, default.volume_radius), (0, None, None));
    assert_eq!((default.kernel, default.final_gather), (KernelKind::Epanechnikov, true));
    assert_eq!((default.guide, default.sky), (true, None));
}

#[test]
fn media_in_every_notation() {
    let scene = example("turbid");
    assert_eq!(
        (scene.render.integrator, scene.render.forced_scattering),
        (IntegratorKind::SingleScattering, 2)
    );
    let media = scene.media;
    assert_eq!(media["lava"].emission, Spectrum::Planck { temperature: 1500.0 });
    let (min, max) = (DVec3::new(-1.0, -1.0, 0.0), DVec3::new(1.0, 1.0, 4.0));
    let grid = DensityDescription::Grid { file: "plume_####.npy".to_owned(), min, max };
    assert_eq!((&media["flame"].density, &media["flame"].emission), (&grid, &Spectrum::Rgb([9.0, 4.0, 1.0])));
    let river = &media["river"];
    assert_eq!(river.absorption, Some(AbsorptionDescription::Water));
    assert_eq!(river.scattering, Spectrum::Rgb([400.0, 420.0, 440.0].map(|v: f32| v * 0.05)));
    assert_eq!(river.density, DensityDescription::Stratified { depth: -0.5, surface: -1.2 });
    let values = [9000.0, 7000.0].map(|v: f32| v * 1e-4).to_vec();
    let soot = Spectrum::Table { wavelengths: vec![400.0, 700.0], values };
    assert_eq!(media["soot"].absorption, Some(AbsorptionDescription::Spectrum(soot)));
    let milk = &media["milk"];
    let extinction = ExtinctionDescription {
        extinction: Spectrum::Rgb([80.0, 90.0, 100.0]),
        albedo: Spectrum::Constant(0.999),
        // Nearer to a thousandth than what 0.999 in single precision leaves of 1.
        absorbed: Spectrum::Constant(0.001),
    };
    assert_eq!((&milk.extinction, &milk.absorption), (&Some(extinction), &None));
    assert_eq!(milk.density, DensityDescription::Stratified { depth: 2.0, surface: 0.0 });
}

#[test]
fn surfaces_and_their_materials() {
    let scene = example("surfaces");
    let [bottom, tank, mist, mirror, lamp, floor] = scene.surfaces.as_slice() else { panic!() };
    assert_eq!((bottom.scale, bottom.translate.z, bottom.normals), (0.01, -1.5, NormalsDescription::Flat));
    assert_eq!((tank.scale, tank.translate, tank.normals), (1.0, DVec3::ZERO, NormalsDescription::Smooth));
    let (water, air) = ("water".to_owned(), "air".to_owned());
    assert_eq!(tank.material, MaterialDescription::Dielectric { front: water.clone(), back: air.clone() });
    assert_eq!(mist.material, MaterialDescription::Null { front: air, back: water });
    let eta = Spectrum::Rgb([0.2, 0.9, 1.1]);
    assert_eq!(mirror.material, MaterialDescription::Conductor { eta, k: Spectrum::Constant(3.0) });
    let radiance = Spectrum::Planck { temperature: 2700.0 };
    assert_eq!(lamp.material, MaterialDescription::Emitter { radiance });
    assert_eq!(floor.material, MaterialDescription::Diffuse { reflectance: Spectrum::Constant(0.5) });
    assert_eq!(scene.sky, SkyDescription::Image { image: "sky.exr".to_owned() });
    assert_eq!(scene.camera.fov, FieldOfView::Horizontal(60.5));
}

#[test]
fn walls_below_a_surface_that_goes_on() {
    let walls = |walls: &str| {
        let text = format!("[domain]\nbox = [[0, 0, 0], [1, 1, 1]]\nwalls = {{ {walls} }}\n");
        let domain = parse(&text).unwrap().domain.unwrap();
        (domain.sides, domain.bottom, domain.top)
    };
    assert_eq!(walls(""), (Wall::Keep, Wall::Keep, Wall::Keep));
    assert_eq!(walls("sides = 'extend'"), (Wall::Extend, Wall::Open, Wall::Keep));
    assert_eq!(walls("sides = 'extend', bottom = 'extend'"), (Wall::Extend, Wall::Open, Wall::Keep));
    assert_eq!(walls("sides = 'extend', bottom = 'opaque'"), (Wall::Extend, Wall::Opaque, Wall::Keep));
    assert_eq!(walls("sides = 'open', top = 'opaque'"), (Wall::Open, Wall::Keep, Wall::Opaque));
}

/// A text that is wrong, the line and column of the fault, and a part of what the message says.
type Wrong = (&'static str, usize, usize, &'static str);

/// Keys and tables.
#[rustfmt::skip]
const WRONG_KEYS: &[Wrong] = &[
    ("[media.sea]\nscatering = 1", 2, 1, "unknown key `scatering` in [media.sea]; did you mean `scattering`?"),
    ("\n[meda.sea]\nior = 1.3", 2, 2, "unknown key `meda` in the scene file; did you mean `media`?"),
    ("path = 'x'\n[sky]\nradiance = 1", 1, 1, "unknown key `path` in the scene file: the known keys are `frames`"),
    ("[frames]\npath = 'f'\nmomentum = 'auto'", 3, 1, "unknown key `momentum` in [frames]: the known keys are"),
    ("[media.a]\ndensity = { stratified = 1, surfaces = 0 }", 2, 29, "unknown key `surfaces` in [media.a.density]"),
    ("[media.a]\ndensity = { grid = 'a.npy', box = [[0, 0, 0], [1, 1, 1]], surface = 0 }", 2, 59, "unknown key `surface`"),
    ("[media.a]\ndensity = { grid = 'a.npy' }", 2, 11, "[media.a.density] has no `box`: write the least and the"),
    ("[media.a]\nalbedo = 0.5", 1, 1, "[media.a] has no `extinction`: `albedo` is a share of it"),
    ("[media.a]\nextinction = 0.5", 1, 1, "[media.a] has no `albedo`: write the share of scattering"),
    ("[media.a]\nmass_scattering = 5", 1, 1, "[media.a] has no `mass_concentration`: mass coefficients need it"),
    ("[render]\nsample = 4", 2, 1, "did you mean `samples`?"),
    ("[render]\nlimit = 0.1", 2, 1, "unknown key `limit` in [render]"),
    ("[camera]\neye = [1, 1, 1]\ntarget = [0, 0, 0]\nlens = 1", 4, 1, "unknown key `lens` in [camera]"),
    ("[camera]\ntarget = [0, 0, 0]\neyes = [1, 1, 1]", 3, 1, "unknown key `eyes` in [camera]; did you mean `eye`?"),
    ("[media.sea]\nzz = 1\nior = 1\naa = 2", 2, 1, "unknown key `zz`"),
    ("[media.a]\nphase = { kind = 'isotropic', g = 0.5 }", 2, 31, "unknown key `g` in [media.a.phase]"),
    ("[media.a]\nior = { table = 'ice', salinity = 1 }", 2, 24, "unknown key `salinity` in [media.a.ior]"),
    ("[sky]\nradiance = { image = 'a.exr', scale = 2 }", 2, 31, "unknown key `scale` in [sky.radiance]"),
    ("[sky]\nradiance = { blackbody = 900, illuminance = 2 }", 2, 31, "unknown key `illuminance`"),
    ("[[surfaces]]\nmesh = 'a.ply'\nmaterial = { kind = 'diffuse', reflectanse = 1 }", 3, 32,
     "unknown key `reflectanse` in surfaces[0].material; did you mean `reflectance`?"),
    ("[frames]\nfps = 24", 1, 1, "[frames] has no `path`: write a pattern"),
    ("[[meshes]]\ninside = 'air'", 1, 1, "meshes[0] has no `path`: write a pattern such as \"water_####.ply\""),
    ("[[meshes]]\npath = 'a.ply'\nprioritie = 1", 3, 1, "unknown key `prioritie` in meshes[0]; did you mean `priority`?"),
    ("[camera]\neye = [1, 1, 1]", 1, 1, "[camera] has no `target`"),
    ("[camera]\ntarget = [1, 1, 1]", 1, 1, "[camera] has no `eye`"),
    ("[sky]", 1, 1, "[sky] has no `radiance`"),
    ("[domain]", 1, 1, "[domain] has no `box`"),
    ("[[surfaces]]\nmaterial = { kind = 'null' }", 1, 1, "surfaces[0] has no `mesh`"),
    ("[[surfaces]]\nmesh = 'a.ply'", 1, 1, "surfaces[0] has no `material`"),
    ("[[surfaces]]\nmesh = 'a.ply'\nmaterial = {}", 3, 12, "surfaces[0].material has no `kind`"),
    ("[[surfaces]]\nmesh = 'a'\nmaterial = { kind = 'emitter' }", 3, 12, "surfaces[0].material has no `radiance`"),
    ("[[surfaces]]\nmesh = 'a'\nfront = 'air'\nmaterial = { kind = 'null' }", 1, 1,
     "surfaces[0] has no `back`: write the medium"),
    ("[[surfaces]]\nmesh = 'a'\nmaterial = { kind = 'conductor', eta = 1 }", 3, 12, "surfaces[0].material has no `k`"),
    ("[media.a]\nphase = { kind = 'henyey-greenstein' }", 2, 9, "[media.a.phase] has no `g`"),
    ("[media.a]\nphase = { kind = 'two-term-schlick', k1 = 0.1 }", 2, 9, "has no `share`"),
    ("[media.a]\nphase = { kind = 'fournier-forand', ior = 1.1 }", 2, 9, "has no `mu`"),
    ("[media.a]\nior = { n = [1.3] }", 2, 7, "[media.a.ior] has no `wavelength`"),
];

/// Texts that are not TOML, and wrong types.
#[rustfmt::skip]
const WRONG_TYPES: &[Wrong] = &[
    ("[media.sea\nior = 1", 1, 11, "this is not TOML: "),
    ("[sky]\nradiance = 1\nradiance = 2", 3, 1, "this is not TOML: duplicate key"),
    ("[sky]\nradiance = ", 2, 12, "this is not TOML: "),
    ("frames = 3", 1, 10, "frames: 3: write a table [frames]"),
    ("media = [1]", 1, 9, "media: [1]: write tables such as [media.sea]"),
    ("[media]\nsea = 1.33", 2, 7, "media.sea: 1.33: write a table such as [media.sea]"),
    ("surfaces = { mesh = 'a' }", 1, 12, "surfaces: { mesh = 'a' }: write tables with the heading [[surfaces]]"),
    ("meshes = 3", 1, 10, "meshes: 3: write tables with the heading [[meshes]]"),
    ("[frames]\npath = 'f'\n[[meshes]]\npath = 'a.ply'", 2, 8, "frames.path: 'f': the files are those of [[meshes]]: make this one"),
    ("[domain]\nbox = [[0, 0, 0], [1, 1, 1]]\n[[meshes]]\npath = 'a.ply'", 1, 1, "a domain is that of the one mesh of frames.path"),
    ("[[meshes]]\npath = 'a.ply'\ninside = 'sea'", 3, 10, "meshes[0].inside: 'sea': what is inside needs a medium [media.sea]"),
    ("[[meshes]]\npath = 'a.ply'\ninside = 'air'\nregions = { 1 = 'air' }", 3, 10, "the mesh has `regions` too"),
    ("[[meshes]]\npath = 'a.ply'\nregions = { 0 = 'air' }", 3, 11, "label 0 is the outside of the mesh: leave it out"),
    ("[[meshes]]\npath = 'a.ply'\npriority = 1.5", 3, 12, "meshes[0].priority: 1.5: write a whole number from"),
    ("[frames]\npath = 7", 2, 8, "frames.path: 7: write a pattern such as"),
    ("[frames]\npath = ' '", 2, 8, "frames.path: ' ': write a pattern"),
    ("[frames]\npath = 'é'\nfps = '24'", 3, 7, "frames.fps: '24': write a number"),
    ("[frames]\npath = 'f'\nup = 'w'", 3, 6, "frames.up: 'w': write one of `x`, `y`, `z`, `-x`, `-y` and `-z`"),
    ("[frames]\npath = 'f'\nnormals = 'smoth'", 3, 11, "frames.normals: 'smoth': did you mean `smooth`?"),
    ("[frames]\npath = 'f'\nvelocity = false", 3, 12, "frames.velocity: false: write \"auto\", \"none\", \"frames\" or"),
    ("[frames]\npath = 'f'\ninside = 1.0", 3, 10, "frames.inside: 1.0: write a whole number"),
    ("[media.a]\nior = 'water'", 2, 7, "media.a.ior: 'water': write a number, { table = \"water\" }"),
    ("[media.a]\nior = [1, 1, 1]", 2, 7, "media.a.ior: [1, 1, 1]: write a number, {"),
    ("[media.a]\nior = { table = 'wather' }", 2, 17, "media.a.ior.table: 'wather': did you mean `water`?"),
    ("[media.a]\nabsorption = { table = 'milk' }", 2, 24, "'milk': write one of `water` and `ice`"),
    ("[media.a]\nscattering = true", 2, 14, "media.a.scattering: true: write a number, [r, g, b], or {"),
    ("[media.a]\nscattering = [1, 2]", 2, 14, "media.a.scattering: [1, 2]: write a number, [r, g, b]"),
    ("[media.a]\nphase = 'lorenz-mie'", 2, 9, "media.a.phase: 'lorenz-mie': write { kind = \"isotropic\" }"),
    ("[media.a]\nphase = { kind = 'mie' }", 2, 18, "write one of `isotropic`, `henyey-greenstein`, `two-term-henyey-greenstein`, `cornette-shanks`"),
    ("[sky]\nradiance = { image = 3 }", 2, 22, "sky.radiance.image: 3: write an EXR or HDR file in quotes"),
    ("[camera]\neye = [1, 2]\ntarget = [0, 0, 0]", 2, 7, "camera.eye: [1, 2]: write three numbers"),
    ("[camera]\neye = [[1, 2, 3], [3, 4, 5]]\ntarget = [0, 0, 0]", 2, 7,
     "camera.eye: [[1, 2, 3], [3, 4, 5]]: write three numbers"),
    ("[camera]\neye = [1, 'a', 3]\ntarget = [0, 0, 0]", 2, 11, "camera.eye[1]: 'a': write a number"),
    ("[camera]\nresolution = 640", 2, 14, "camera.resolution: 640: write width and height in pixels"),
    ("[camera]\nresolution = [640, 360, 1]", 2, 14, "write width and height in pixels"),
    ("[render]\nsamples = 64.0", 2, 11, "render.samples: 64.0: write a whole number from 1 to 4294967295"),
    ("[render]\nintegrator = 'bidirectional'", 2, 14, "write one of `auto`, `path`, `photon`, `beams`, `single-scattering`, `fog` and `ambient-occlusion`"),
    ("[render]\nseed_mode = 'frames'", 2, 13, "did you mean `frame`?"),
    ("[output]\ndenoise = 'yes'", 2, 11, "output.denoise: 'yes': write true or false"),
    ("[render]\nseed_mode = 1", 2, 13, "write one of `frame`, `sequence` and `static` in quotes"),
    ("[render]\nphotons = 1000", 2, 11, "write a table such as { count = 100000, final_gather = true }"),
    ("[render]\nphotons = { number = 1 }", 2, 13, "unknown key `number`"),
    ("[render]\nfilter = 1979-05-27", 2, 10, "write one of `box`, `gaussian` and `blackman-harris` in quotes"),
    ("[output]\npng = 'yes'", 2, 7, "output.png: 'yes': write true or false"),
    ("[output]\naovs = 'N'", 2, 8, "output.aovs: 'N': write a list such as"),
    ("[output]\naovs = ['N', 'velocity']", 2, 14, "output.aovs[1]: 'velocity': write one of `albedo`"),
    ("[output]\naovs = ['N', 'Z', 'N']", 2, 19, "output.aovs[2]: 'N': this layer is there twice: keep it once"),
    ("[output]\npath = ''", 2, 8, "output.path: '': write a pattern such as"),
];

/// Numbers out of range.
#[rustfmt::skip]
const WRONG_NUMBERS: &[Wrong] = &[
    ("[media.a]\nior = 0", 2, 7, "media.a.ior: 0: write a number above 0"),
    ("[media.a]\nior = -1.33", 2, 7, "media.a.ior: -1.33: write a number above 0"),
    ("[media.a]\nior = nan", 2, 7, "media.a.ior: nan: write a number above 0"),
    ("[media.a]\nior = 1e-300", 2, 7, "media.a.ior: 1e-300: write a number above 0, in single precision"),
    ("[media.a]\nabsorption = inf", 2, 14, "write a number that is not below 0"),
    ("[media.a]\nabsorption = 1e300", 2, 14, "write a number that is not below 0, in single precision"),
    ("[media.a]\nabsorption = [1, -0.5, 0]", 2, 18, "media.a.absorption[1]: -0.5: write a number that is not below"),
    ("[media.a]\nphase = { kind = 'henyey-greenstein', g = 1 }", 2, 43, "media.a.phase.g: 1: write a number between"),
    ("[media.a]\nphase = { kind = 'henyey-greenstein', g = 0.999999999 }", 2, 43, "in single precision"),
    ("[media.a]\nphase = { kind = 'linear-anisotropic', a = 1.5 }", 2, 44, "write a number from -1 to 1"),
    ("[media.a]\nphase = { kind = 'cornette-shanks', g = 0.999999 }", 2, 41, "from -0.99999 to 0.99999"),
    ("[media.a]\nphase = { kind = 'draine', g = 0.5, alpha = -1 }", 2, 45, "write a number from 0 to 1000"),
    ("[media.a]\nphase = { kind = 'sakas', n = -1 }", 2, 31, "write a number from 0 to 1000"),
    ("[media.a]\nphase = { kind = 'gaussian', gamma = 1e9 }", 2, 38, "write a number from 0 to 1e8"),
    ("[media.a]\nphase = { kind = 'two-term-schlick', fit = 'milky' }", 2, 44, "write one of `rayleigh`, `hazy`"),
    ("[media.a]\nphase = { kind = 'specular-spheres', ior = 1 }", 2, 9, "reflect nothing: change ior"),
    ("[media.a]\nphase = { kind = 'fournier-forand', ior = 1.5, mu = 3.5 }", 2, 43, "relative to water from 1.01"),
    ("[media.a]\nphase = { kind = 'fournier-forand', ior = 1.1, mu = 3 }", 2, 53, "sizes, from 3.05 to 4.95"),
    ("[media.a]\nphase = { kind = 'fournier-forand', backscatter = 0.5 }", 2, 51, "from 0.0001 to 0.2"),
    ("[media.a]\nphase = { kind = 'tabulated', angle = [0, 9, 9], value = [1, 1, 1] }", 2, 46, "must rise strictly"),
    ("[media.a]\nphase = { kind = 'tabulated', angle = [0, 181], value = [1, 1] }", 2, 43, "from 0 to 180 degrees"),
    ("[media.a]\nphase = { kind = 'tabulated', angle = [0, 9], value = [1] }", 2, 55, "1 numbers for 2 angles"),
    ("[media.a]\nphase = { kind = 'tabulated', angle = [0, 9], value = [0, 0] }", 2, 9, "leave no light to scatter"),
    ("[media.a]\nior = { table = 'water', temperature = 400 }", 2, 40, "write a temperature from -10 to 100"),
    ("[media.a]\nior = { table = 'water', salinity = -1 }", 2, 37, "write a salinity from 0 to 35"),
    ("[media.a]\nior = { wavelength = [400, 500], n = [1.3] }", 2, 38, "1 numbers for 2 wavelengths: write one for"),
    ("[media.a]\nior = { wavelength = [400], n = [1.3], k = [-1] }", 2, 45, "media.a.ior.k[0]: -1: write a number"),
    ("[media.a]\nabsorption = { wavelength = [500, 500], value = [1, 1] }", 2, 35,
     "media.a.absorption.wavelength[1]: 500: wavelengths must rise strictly"),
    ("[media.a]\nabsorption = { wavelength = [0.5], value = [1] }", 2, 30, "write a wavelength from 1 to 1e6"),
    ("[media.a]\nabsorption = { wavelength = [], value = [] }", 2, 29, "write rising wavelengths in nanometres"),
    ("[media.a]\nextinction = 1\nalbedo = 1.5", 3, 10, "media.a.albedo: 1.5: write a number from 0 to 1"),
    ("[media.a]\nmass_scattering = 1\nmass_concentration = -1", 3, 22, "write a number that is not below 0"),
    ("[media.a]\nmass_scattering = 1e30\nmass_concentration = 1e30", 2, 19, "times `mass_concentration` it leaves single"),
    ("[media.a]\nabsorption = 1\nemission = -1", 3, 12, "media.a.emission: -1: write a number that is not below 0"),
    ("[media.a]\ndensity = { stratified = 0 }", 2, 26, "media.a.density.stratified: 0: write the depth in metres"),
    ("[media.a]\ndensity = { stratified = inf }", 2, 26, "write a number from -1e12 to 1e12"),
    ("[media.a]\ndensity = 2", 2, 11, "media.a.density: 2: write { stratified = 0.5, surface = 0.0 } or { grid"),
    ("[media.a]\ndensity = {}", 2, 11, "media.a.density: {}: write { stratified = 0.5, surface = 0.0 } or { grid"),
    ("[media.a]\ndensity = { grid = 3, box = [[0, 0, 0], [1, 1, 1]] }", 2, 20, "write the name of a .npy or .nrrd file"),
    ("[frames]\npath = 'f'\nscale = 0", 3, 9, "frames.scale: 0: write a number from 1e-12"),
    ("[frames]\npath = 'f'\nfps = -24", 3, 7, "frames.fps: -24: write a number above 0"),
    ("[domain]\nbox = [[0, 0, 0], [1, 1, nan]]", 2, 26, "domain.box[1][2]: nan: write a number from -1e12"),
    ("[domain]\nbox = [[0, 0, 0], [1, 1, 1]]\nreflectance = 1.5", 3, 15, "domain.reflectance: 1.5: write a number"),
    ("[[surfaces]]\nmesh = 'a'\nmaterial = { kind = 'conductor', eta = 0, k = 1 }", 3, 40, "write a number above 0"),
    ("[[surfaces]]\nmesh = 'a'\nmaterial = { kind = 'diffuse' }\ntransform = { scale = -1 }", 4, 23,
     "surfaces[0].transform.scale: -1"),
    ("[sky]\nradiance = { blackbody = 0 }", 2, 26, "sky.radiance.blackbody: 0: write a temperature from 1 to 1e6"),
    ("[camera]\nup = [0, 0, 0]", 2, 6, "camera.up: [0, 0, 0]: write a direction that is not zero"),
    ("[camera]\nvertical_fov = 180", 2, 16, "camera.vertical_fov: 180: write an angle between 0 and 180 degrees"),
    ("[camera]\nresolution = [0, 360]", 2, 15, "camera.resolution[0]: 0: write a whole number from 1 to 65536"),
    ("[camera]\nresolution = [640, 65537]", 2, 20, "camera.resolution[1]: 65537: write a whole number from 1"),
    ("[render]\nsamples = 0", 2, 11, "render.samples: 0: write a whole number from 1"),
    ("[render]\ntarget_error = 0", 2, 16, "write a relative error from 0.000001 to 1, such as 0.02 for 2 %"),
    ("[render]\nconfidence = 95", 2, 14, "render.confidence: 95: write a confidence from 0.5 to 0.9999"),
    ("[render]\nseed = -1", 2, 8, "render.seed: -1: write a whole number from 0 to 18446744073709551615"),
    ("[render]\nseed = 18446744073709551616", 2, 8, "render.seed: 18446744073709551616: write a whole number"),
    ("[render]\nsimilarity = 5", 2, 14, "render.similarity: 5: write a whole number from 0 to 4"),
    (
        "[render]\nsimilarity = \"high\"",
        2,
        14,
        "render.similarity: \"high\": write a whole number from 0 to 4",
    ),
    ("[render]\nsimilarity = 1.5", 2, 14, "render.similarity: 1.5: write a whole number from 0 to 4"),
    ("[render]\ndispersion = 1", 2, 14, "render.dispersion: 1: write true or false"),
    ("[render]\nsplit = 17", 2, 9, "render.split: 17: write a whole number from 0 to 16"),
    ("[render]\nforced_scattering = 17", 2, 21, "render.forced_scattering: 17: write a whole number from 0 to 16"),
    ("[render]\nphotons = { count = 10000001 }", 2, 21, "render.photons.count: 10000001: write a whole number from 0 to 10000000"),
    ("[render]\nphotons = { radius = 0 }", 2, 22, "render.photons.radius: 0: write a length from 1e-9 to 1e9 metres"),
    ("[render]\nphotons = { volume_radius = nan }", 2, 29, "write a length from 1e-9 to 1e9 metres"),
    ("[render]\nphotons = { shrink = 1.5 }", 2, 22, "render.photons.shrink: 1.5: write a number from 0.01 to 1"),
    ("[render]\nphotons = { kernel = 'gaussian' }", 2, 22, "write one of `constant`, `cone` and `epanechnikov`"),
    ("[render]\nphotons = { guide = 1 }", 2, 21, "render.photons.guide: 1: write true or false"),
    ("[render]\nmax_depth = -1", 2, 13, "render.max_depth: -1: write a whole number from 0"),
    ("[output]\nexposure = 1000", 2, 12, "output.exposure: 1000: write a number of stops from -100 to 100"),
];

/// Values that do not go together.
#[rustfmt::skip]
const WRONG_RELATIONS: &[Wrong] = &[
    ("[media.\"\"]\nior = 1", 1, 8, "[media]: ``: a medium needs a name"),
    ("[media.a]\nemission = 1", 2, 12, "media.a.emission: 1: a medium emits as it absorbs, and this one absorbs nothing"),
    ("[media.a]\nabsorption = [0, 0, 0]\nscattering = 1\nemission = { blackbody = 900 }", 4, 12, "absorbs nothing"),
    ("[media.a]\nextinction = 2\nalbedo = 1\nemission = 1", 4, 12, "give it `absorption`, or remove `emission`"),
    ("[media.a]\nabsorption = 1\nextinction = 2\nalbedo = 1", 2, 14, "media.a.absorption: 1: `extinction` and `albedo` say"),
    ("[media.a]\nmass_concentration = 1\nextinction = 2\nalbedo = 1", 2, 22, "remove this or them"),
    ("[media.a]\nscattering = 1\nmass_scattering = 2\nmass_concentration = 1", 3, 19, "remove one of the two"),
    ("[media.a]\nabsorption = 1\nmass_concentration = 1", 3, 22, "nothing is multiplied by it"),
    ("[media.a]\ndensity = { stratified = 1, grid = 'a.npy' }", 2, 36, "remove one of `stratified` and `grid`"),
    ("[media.a]\ndensity = { grid = 'a.npy', box = [[0, 0, 0], [1, 0, 1]] }", 2, 35, "each coordinate of the first corner"),
    ("[regions]\n1 = 'see'\n[media.sea]", 2, 5,
     "regions.1: 'see': label 1 needs a medium [media.see], which is not there: did you mean `sea`?"),
    ("[regions]\n1 = 'oil'", 2, 5,
     "label 1 needs a medium [media.oil], which is not there: the media of this scene are `air`"),
    ("[regions]\nsea = 'air'", 2, 1, "[regions]: `sea`: write the label as a whole number"),
    ("[regions]\n1 = 'air'\n01 = 'air'", 3, 1, "[regions]: `01`: label 1 is there twice"),
    ("[regions]\n99999999999 = 'air'", 2, 1, "write the label as a whole number"),
    ("[frames]\npath = 'f'\ninside = 0", 3, 10, "frames.inside: 0: label 0 is the outside"),
    ("[domain]\nbox = [[0, 0, 0], [1, 0, 1]]", 2, 7, "each coordinate of the first corner must be below"),
    ("[domain]\nbox = [[0, 0, 0]]", 2, 7, "domain.box: [[0, 0, 0]]: write the least and the greatest corner"),
    ("[domain]\nbox = [[0, 0, 0], [1, 1, 1]]\nwalls = { sides = 'extend', bottom = 'keep' }", 3, 38,
     "with sides = \"extend\" the fluid goes on below: write \"open\" or \"opaque\""),
    ("[domain]\nbox = [[0, 0, 0], [1, 1, 1]]\nwalls = { bottom = 'extend' }", 3, 20, "only with sides = \"extend\""),
    ("[domain]\nbox = [[0, 0, 0], [1, 1, 1]]\nwalls = { top = 'extend' }", 3, 17, "'extend': the top cannot go on"),
    ("[domain]\nbox = [[0, 0, 0], [1, 1, 1]]\nwalls = { top = 'glass' }", 3, 17,
     "write one of `keep`, `open`, `opaque` and `extend`"),
    ("[[surfaces]]\nmesh = 'a'\nfront = 'air'\nmaterial = { kind = 'diffuse' }", 3, 9,
     "surfaces[0].front: 'air': an opaque surface has no media: remove `front` and `back`"),
    ("[[surfaces]]\nmesh = 'a'\nfront = 'air'\nback = 'watre'\nmaterial = { kind = 'dielectric' }\n[media.water]", 4, 8,
     "surfaces[0].back: 'watre': this side needs a medium [media.watre], which is not there: did you mean `water`?"),
    ("[[surfaces]]\nmesh = 'a'\nmaterial = { kind = 'diffuse' }\n[[surfaces]]\nmaterial = { kind = 'null' }\nmesh = ''", 6, 8, "surfaces[1].mesh: ''"),
    ("[[surfaces]]\nmesh = 'a'\nmaterial = { kind = 'glass' }", 3, 21, "write one of `diffuse`, `dielectric`"),
    ("[camera]\neye = [1, 1, 1]\ntarget = [1, 1, 1]", 3, 10, "the target is where the eye is: move one of them"),
    ("[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]", 3, 10, "the camera looks along its `up`"),
    ("[camera]\nvertical_fov = 40\nhorizontal_fov = 60", 3, 18, "there is a `vertical_fov` already: keep one"),
];

#[test]
fn every_wrong_text_is_named_with_its_place() {
    assert_wrong(&[WRONG_KEYS, WRONG_TYPES, WRONG_NUMBERS, WRONG_RELATIONS].concat());
}

fn assert_wrong(texts: &[Wrong]) {
    let mut failures = Vec::new();
    for (text, line, column, fragment) in texts {
        let message = parse(text).map_or_else(|error| error.to_string(), |_| "it was read".to_owned());
        if !message.starts_with(&format!("folder/s.toml:{line}:{column}: ")) || !message.contains(fragment) {
            failures.push(format!("{text}\n  expected {line}:{column}: {fragment}\n  but was {message}\n"));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn files_are_read_and_named() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| {
        let file = folder.path().join(name);
        std::fs::write(&file, bytes).unwrap();
        SceneDescription::from_file(&file)
    };
    let scene = write("good.toml", "# blå\n[sky]\nradiance = 1".as_bytes()).unwrap();
    assert_eq!((scene.directory.as_path(), scene.file), (folder.path(), folder.path().join("good.toml")));
    let crlf = write("crlf.toml", b"[sky]\r\nradiance = 1\r\nturbidity = 3\r\n").unwrap_err().to_string();
    assert!(crlf.contains("crlf.toml:3:1: unknown key `turbidity` in [sky]"), "{crlf}");
    let marked = write("bom.toml", b"\xef\xbb\xbf[sky]\nradiance = 1");
    assert!(marked.is_ok(), "{marked:?}");
    let latin = write("latin.toml", b"[sky]\n# bl\xe5\n").unwrap_err().to_string();
    assert!(
        latin.ends_with(
            "latin.toml:2:5: this is not TOML: the bytes here are not UTF-8: save the file as UTF-8"
        )
    );
    let long = write("mesh.ply", &vec![b' '; (16 << 20) + 1]).unwrap_err();
    assert!(matches!(long, SceneError::TooLong { .. }));
    let missing = SceneDescription::from_file(&folder.path().join("none.toml")).unwrap_err();
    assert!(matches!(missing, SceneError::Io { .. }) && missing.to_string().contains("none.toml"));
    assert!(matches!(SceneDescription::from_file(folder.path()), Err(SceneError::Io { .. })));
}

#[test]
fn deep_nesting_is_an_error_and_no_overflow() {
    let text = format!("[sky]\nradiance = {}1{}", "[".repeat(20_000), "]".repeat(20_000));
    assert!(parse(&text).is_err());
}

proptest! {
    /// Cuts and bends of a good scene never panic; whatever fails has a place.
    #[test]
    fn damaged_scenes_never_panic(
        which in 1usize..EXAMPLES.len(), at in 0.0..1.0f64, length in 0usize..12, with in "[\\PC\n]{0,6}",
    ) {
        let chars: Vec<char> = EXAMPLES[which].text.chars().collect();
        let start = (at * chars.len() as f64) as usize;
        let end = (start + length).min(chars.len());
        let kept = |range: &[char]| range.iter().collect::<String>();
        let text = kept(&chars[..start]) + &with + &kept(&chars[end..]);
        if let Err(error) = parse(&text) {
            prop_assert!(error.to_string().starts_with("folder/s.toml:"));
        }
    }
}
