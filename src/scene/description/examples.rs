//! Scene files that use every key, for tests to walk.

/// A scene file with its name.
#[derive(Clone, Copy, Debug)]
pub struct Example {
    /// What messages call it.
    pub name: &'static str,
    /// The file's text.
    pub text: &'static str,
}

/// Scene files that are right. Together they use every key and every form of value.
pub const EXAMPLES: [Example; 15] = [
    Example { name: "empty", text: "" },
    Example { name: "sea and ice", text: SEA_AND_ICE },
    Example { name: "spectral", text: SPECTRAL },
    Example { name: "surfaces", text: SURFACES },
    Example { name: "several meshes", text: MESHES },
    Example { name: "automatic camera", text: AUTOMATIC_CAMERA },
    Example { name: "plain numbers", text: PLAIN_NUMBERS },
    Example { name: "phase functions", text: PHASE_FUNCTIONS },
    Example { name: "turbid", text: TURBID },
    Example { name: "moving camera", text: MOVING_CAMERA },
    Example { name: "models", text: MODELS },
    Example { name: "clear sky", text: CLEAR_SKY },
    Example { name: "summer afternoon", text: SUMMER_AFTERNOON },
    Example { name: "measured sun", text: MEASURED_SUN },
    Example { name: "sun and moon", text: SUN_AND_MOON },
];

const SEA_AND_ICE: &str = r#"
[frames]
path = "frames/frame_####.ply"
fps = 24
scale = 1.0
up = "z"
normals = "smooth"
velocity = "auto"
inside = 1

[regions]
0 = "air"
1 = "sea"
2 = "ice"

[domain]
box = [[-1, -1, -0.8], [1, 1, 0.8]]
walls = { sides = "extend", bottom = "open" }

[media.air]
ior = 1.0

[media.sea]
ior = 1.33
absorption = [0.35, 0.07, 0.03]
scattering = [0.10, 0.11, 0.12]
phase = { kind = "henyey-greenstein", g = 0.9 }

[media.ice]
ior = 1.31
absorption = [0.25, 0.1, 0.06]
scattering = 8.0
phase = { kind = "henyey-greenstein", g = 0.86 }

[sun]
direction = [0.4, 0.2, 0.9]
angular_diameter = 0.53
irradiance = [1.0, 0.95, 0.85]

[sky]
radiance = [0.6, 0.7, 0.8]

[camera]
eye = [1.1, 2.3, 2.3]
target = [0.0, 0.5, 0.0]
up = [0, 0, 1]
vertical_fov = 40
shutter = 0.5
aperture = 0.02
focus_distance = 3.5
turntable = { frames_per_turn = 120, frame = 0 }
resolution = [640, 360]

[render]
integrator = "auto"
samples = 64
target_error = 0.02
confidence = 0.9
max_depth = 0
split = 1
similarity = 2
dispersion = true
seed = 0
seed_mode = "sequence"
filter = "box"

[output]
path = "out/frame_####.exr"
png = true
exposure = 0.5
denoise = true
aovs = ["albedo", "N", "P", "Z", "motion", "variance", "samples"]
"#;

const SPECTRAL: &str = r#"
[frames]
path = "frames"
up = "-y"
normals = "file"
velocity = "momentum"
inside = 4

[regions]
4 = "water"
-7 = "glass"
999 = "ice"

[domain]
box = [[0, 0, 0], [1, 1, 1]]
walls = { sides = "opaque", bottom = "opaque", top = "open" }
reflectance = { wavelength = [400, 700], value = [0.2, 0.4] }

[media.water]
ior = { table = "water", temperature = 10, salinity = 35 }
absorption = { table = "water" }

[media.ice]
ior = { table = "ice" }
absorption = { table = "ice" }
phase = { kind = "isotropic" }

[media.glass]
ior = { wavelength = [400, 550, 700], n = [1.53, 1.52, 1.51], k = [0, 1e-8, 0] }
absorption = { wavelength = [400.5], value = [0.1] }
scattering = { wavelength = [400, 700], value = [1, 0] }

[sun]
direction = [0, -1, 0]
irradiance = { blackbody = 5778, illuminance = 100000 }

[sky]
radiance = { blackbody = 1500 }

[render]
integrator = "path"
filter = "blackman-harris"
seed = 18446744073709551615
seed_mode = "static"
"#;

const SURFACES: &str = r#"
[media.water]
ior = 1.33

[[surfaces]]
mesh = "bottom_####.ply"
normals = "flat"
transform = { scale = 0.01, translate = [0, 0, -1.5] }
material = { kind = "diffuse", reflectance = [0.5, 0.4, 0.3] }

[[surfaces]]
mesh = "tank.obj"
front = "water"
back = "air"
material = { kind = "dielectric" }

[[surfaces]]
mesh = "mist.ply"
front = "air"
back = "water"
material = { kind = "null" }

[[surfaces]]
mesh = "mirror.ply"
material = { kind = "conductor", eta = [0.2, 0.9, 1.1], k = 3 }

[[surfaces]]
mesh = "lamp.ply"
material = { kind = "emitter", radiance = { blackbody = 2700 } }

[[surfaces]]
mesh = "floor.ply"
material = { kind = "diffuse" }

[sky]
radiance = { image = "sky.exr" }

[camera]
eye = [0, -4, 1]
target = [0, 0, 0]
horizontal_fov = 60.5

[render]
integrator = "ambient-occlusion"
filter = "gaussian"
"#;

const MESHES: &str = r#"
[frames]
scale = 0.001
normals = "flat"

[media.sea]
ior = 1.33

[media.ice]
ior = 1.31

[media.glass]
ior = 1.5

[[meshes]]
path = "water_####.ply"
inside = "sea"

[[meshes]]
path = "floes"
regions = { 1 = "ice", 2 = "sea" }
priority = 1
normals = "smooth"
transform = { scale = 0.01, translate = [0, 0, 0.1] }

[[meshes]]
path = "tank.obj"
inside = "glass"
priority = 2
"#;

const AUTOMATIC_CAMERA: &str = r#"
frames = { path = "frames/iter_*.dsc", normals = "flat", up = "y", velocity = "frames" }
camera = { resolution = [1920, 1080], vertical_fov = 30 }
render.integrator = "photon"
render.photons = { count = 50000, radius = 0.1, volume_radius = 0.2, shrink = 0.8, kernel = "cone", final_gather = false, guide = false, sky = true }
output.png = false
"#;

const PLAIN_NUMBERS: &str = r#"
[media.fog]
scattering = 1_000
absorption = 0x10

[sky]
radiance = { wavelength = [380, 780], value = [1, +2.5e-1] }

[render]
integrator = "fog"
"#;

const PHASE_FUNCTIONS: &str = r#"
[media]
even = { scattering = 1, phase = { kind = "isotropic" } }
linear = { scattering = 1, phase = { kind = "linear-anisotropic", a = -0.5 } }
gas = { scattering = 1, phase = { kind = "rayleigh" } }
haze = { scattering = 1, phase = { kind = "hazy" } }
smog = { scattering = 1, phase = { kind = "murky", form = "nishita" } }
fog = { scattering = 1, phase = { kind = "murky", form = "normalised" } }
milk = { scattering = 1, phase = { kind = "henyey-greenstein", g = -0.9999 } }
dust = { scattering = 1, phase = { kind = "two-term-henyey-greenstein", share = 0.9, g1 = 0.8, g2 = -0.3 } }
cloud = { scattering = 1, phase = { kind = "cornette-shanks", g = 0.7 } }
space = { scattering = 1, phase = { kind = "draine", g = 0.5, alpha = 1.5 } }
lobe = { scattering = 1, phase = { kind = "schlick", k = 0.7 } }
fit = { scattering = 1, phase = { kind = "two-term-schlick", fit = "murky" } }
lobes = { scattering = 1, phase = { kind = "two-term-schlick", share = 0.5, k1 = 0.7, k2 = -0.7 } }
snow = { scattering = 1, phase = { kind = "diffuse-spheres" } }
bubbles = { scattering = 1, phase = { kind = "specular-spheres", ior = 0.75 } }
silver = { scattering = 1, phase = { kind = "specular-spheres", ior = 0.13, k = 3.2 } }
smoke = { scattering = 1, phase = { kind = "sakas", n = 4 } }
glow = { scattering = 1, phase = { kind = "gaussian", gamma = 10 } }
ocean = { scattering = 1, phase = { kind = "fournier-forand", ior = 1.1, mu = 3.5835 } }
coast = { scattering = 1, phase = { kind = "fournier-forand", backscatter = 0.0183 } }
measured = { scattering = 1, phase = { kind = "tabulated", angle = [0, 10, 90, 180], value = [1e6, 30, 1, 2] } }

[media.plankton]
scattering = 1
phase = { kind = "henyey-greenstein", g = { wavelength = [400, 700], value = [0.96, 0.92] } }

[media.colloid]
scattering = 1
phase = { kind = "tabulated", wavelength = [450, 650], angle = [0, 90, 180], value = [[9, 1, 2], [2, 1, 2]] }
"#;

const TURBID: &str = r#"
[media.lava]
ior = 1.6
absorption = 40
emission = { blackbody = 1500 }

[media.flame]
absorption = 2
emission = [9, 4, 1]
density = { grid = "plume_####.npy", box = [[-1, -1, 0], [1, 1, 4]] }

[media.river]
ior = { table = "water", temperature = 15, salinity = 0 }
absorption = { table = "water" }
mass_scattering = [400, 420, 440]
mass_concentration = 0.05
density = { stratified = -0.5, surface = -1.2 }

[media.soot]
mass_absorption = { wavelength = [400, 700], value = [9000, 7000] }
mass_scattering = 1500
mass_concentration = 1e-4

[media.milk]
ior = 1.35
extinction = [80, 90, 100]
albedo = 0.999
emission = 0.0
density = { stratified = 2 }

[render]
integrator = "single-scattering"
seed_mode = "frame"
forced_scattering = 2
"#;

const MOVING_CAMERA: &str = r#"
[camera]
eye = [
    { frame = 1, eye = [4, 0, 1], target = [0, 0, 0.5], vertical_fov = 40 },
    { frame = 12.5, eye = [3, 2, 0.5], vertical_fov = 30, focus_distance = 2 },
    { frame = 30, eye = [0, 3, -0.2] },
]
target = [0, 0, 0]
vertical_fov = 50
turntable = { degrees_per_frame = -0.5 }
"#;

const MODELS: &str = r#"
[media.baltic]
model = "natural-water"
preset = "baltic"
temperature = 10
salinity = 8
cdom = 0.5
phase = "lorenz-mie"

[media.lake]
model = "natural-water"
temperature = 4
salinity = 0
mineral = 1e-7
algae = 2e-7
rock_flour = 1e-6
molecular_scattering = true
density = { stratified = 2 }

[media.ice]
model = "iceberg"
temperature = -5
salinity = 0
ice_density = 894

[media.waterline]
model = "iceberg"
preset = "green"
algae = 2e-6
phase = "henyey-greenstein"

[media.milk]
model = "milk"
preset = "semi"
protein = 3.3
homogenisation_pressure = 20

[media.cream]
model = "milk"
fat = 30
phase = { kind = "henyey-greenstein", g = 0.9 }

[media.paint]
model = "particles"
ior = { table = "water", temperature = 20, salinity = 0 }
absorption = [0.4, 0.1, 0.1]
emission = 0.0
species = [
    { name = "titania", ior = { wavelength = [400, 700], n = [2.9, 2.6], k = [1e-3, 0] }, volume_fraction = 1e-3, sizes = { kind = "log-normal", median_um = 0.1, deviation = 0.2 } },
    { name = "chalk", ior = 1.6, volume_fraction = 0.01, sizes = { kind = "power-law", exponent = 4, least_um = 0.1, greatest_um = 5 } },
    { ior = 1.0, volume_fraction = 1e-4, sizes = { kind = "table", radius_um = [10, 20, 50], number = [0, 3, 1] } },
]
"#;

const CLEAR_SKY: &str = r#"
[sun]
elevation = 35.5
azimuth = -120
north = [1, 0, 0]
angular_diameter = 0.5

[sky]
radiance = { model = "hosek-wilkie", turbidity = 2.5, ground_albedo = 0.3 }

[output]
exposure = -6
"#;

const SUMMER_AFTERNOON: &str = r#"
[sun]
date = "2026-06-21"
time = "14:30+02:00"
latitude = 55.7
longitude = 12.6

[sky]
radiance = { model = "hosek-wilkie" }
"#;

const MEASURED_SUN: &str = r#"
[sun]
date = "2024-02-29"
time = "18:15:30"
latitude = 40
longitude = -105.25
north = [0, 1, 1]
irradiance = { table = "astm-g173", scale = 0.5 }
"#;

const SUN_AND_MOON: &str = r#"
[[sun]]
elevation = 4
azimuth = 280

[[sun]]
direction = [0.5, 0.2, 0.4]
angular_diameter = 0.52
irradiance = { blackbody = 4100, illuminance = 0.2 }

[[sun]]
elevation = -10
azimuth = 90
irradiance = 0.1

[sky]
radiance = { model = "hosek-wilkie" }
"#;
