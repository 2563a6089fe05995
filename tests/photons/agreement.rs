//! Photons and eye paths find the same light where both can.

use floe::integrator::Integrator;
use glam::DVec3;

use crate::common::mesh::{TestMesh, cuboid, parallelogram, sphere};
use crate::common::render::Prepared;
use crate::common::scene::SceneFolder;
use crate::seeds::{Seeds, assert_agree, with_radius};

const GRID: [u32; 2] = [4, 3];
const VIEW: &str =
    "[camera]\neye = [0.4, -2.6, 1.9]\ntarget = [0, 0, 0.25]\nvertical_fov = 38\nresolution = [32, 24]\n";

fn floor() -> TestMesh {
    parallelogram(DVec3::new(-3.0, -3.0, 0.0), DVec3::X * 6.0, DVec3::Y * 6.0)
}

/// A lamp that is large enough for chance to find it.
fn lamp() -> TestMesh {
    parallelogram(DVec3::new(-1.0, -1.0, 3.0), DVec3::Y * 2.0, DVec3::X * 2.0)
}

fn scene(folder: &SceneFolder, text: &str) -> Prepared {
    folder.scene(&format!(
        "[[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = [0.7, 0.5, 0.3] }}\n\
         [[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = {{ kind = \"emitter\", radiance = [4, 5, 6] }}\n{VIEW}{text}"
    ))
}

/// The same scene by eye paths, and by photons at radius 0 with each of some settings.
fn compare(folder: &SceneFolder, text: &str, settings: &[(&str, &str)], radius: f32, samples: [u32; 2]) {
    let by_paths = Seeds::render(&scene(folder, text), samples[1], 4, GRID).means();
    for (name, photons) in settings {
        let render =
            format!("{text}[render]\nintegrator = \"photon\"\nphotons = {{ count = 20000, {photons} }}\n");
        let [near, middle, wide] = [1.0, 2.0, 4.0].map(|factor| {
            let scene = with_radius(scene(folder, &render), factor * radius);
            Seeds::render(&scene, samples[0], 4, GRID)
        });
        let by_photons = Seeds::extrapolated(&near, &middle, &wide).means();
        assert_agree(name, &by_photons, &by_paths, 0.05);
    }
}

/// A glass ball in the light of a clear sky whose sun is dark, since paths have no sun through glass.
#[test]
fn a_ball_under_a_clear_sky() {
    let folder = SceneFolder::new()
        .mesh("floor.ply", &floor())
        .mesh("ball.ply", &sphere(DVec3::new(0.0, 0.0, 0.7), 0.6, 2));
    let text = format!(
        "[[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 0.6 }}\n{VIEW}\
         [media.glass]\nior = 1.5\n[[surfaces]]\nmesh = \"ball.ply\"\nfront = \"air\"\nback = \"glass\"\n\
         material = {{ kind = \"dielectric\" }}\n[sun]\nelevation = 35\nazimuth = 60\nirradiance = 0\n\
         [sky]\nradiance = {{ model = \"hosek-wilkie\", turbidity = 4 }}\n"
    );
    let by_paths = Seeds::render(&folder.scene(&text), 1024, 4, GRID).means();
    let render = format!(
        "{text}[render]\nintegrator = \"photon\"\n\
         photons = {{ count = 20000, sky = true, final_gather = false }}\n"
    );
    let [near, middle, wide] = [1.0, 2.0, 4.0]
        .map(|factor| Seeds::render(&with_radius(folder.scene(&render), factor * 0.03), 64, 4, GRID));
    let by_photons = Seeds::extrapolated(&near, &middle, &wide).means();
    assert_agree("clear sky", &by_photons, &by_paths, 0.05);
}

/// Eight triangles around each half of the ball: normals that lean far from those of the facets, so that many
/// directions are decided by one normal or the other.
#[test]
fn a_ball_with_interpolated_normals() {
    let folder = SceneFolder::new()
        .mesh("floor.ply", &floor())
        .mesh("lamp.ply", &lamp())
        .mesh("ball.ply", &sphere(DVec3::new(0.0, 0.0, 0.7), 0.6, 1));
    let ball = "[media.glass]\nior = 1.5\n[[surfaces]]\nmesh = \"ball.ply\"\nnormals = \"smooth\"\nfront = \"air\"\n\
                back = \"glass\"\nmaterial = { kind = \"dielectric\" }\n";
    compare(&folder, ball, &[("ball", "")], 0.03, [64, 1024]);
}

/// A block of turbid water whose top is a steep wave of few triangles with interpolated normals.
#[test]
fn a_steep_wave_with_interpolated_normals() {
    let (top, rest) = wavy_block(6);
    let folder = SceneFolder::new()
        .mesh("floor.ply", &floor())
        .mesh("lamp.ply", &lamp())
        .mesh("top.ply", &top)
        .mesh("rest.ply", &rest);
    let water = "[media.water]\nior = 1.33\nabsorption = [0.6, 0.2, 0.1]\nscattering = [0.5, 1, 2]\n\
                 phase = { kind = \"henyey-greenstein\", g = 0.5 }\n\
                 [[surfaces]]\nmesh = \"top.ply\"\nnormals = \"smooth\"\nfront = \"air\"\nback = \"water\"\n\
                 material = { kind = \"dielectric\" }\n\
                 [[surfaces]]\nmesh = \"rest.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"water\"\n\
                 material = { kind = \"dielectric\" }\n";
    let settings = [
        ("wave, gathering", "final_gather = true"),
        ("wave, gathering without a guide, constant kernel", "guide = false, kernel = \"constant\""),
        ("wave, photons at once, cone", "final_gather = false, kernel = \"cone\""),
    ];
    compare(&folder, water, &settings, 0.03, [24, 512]);
}

/// The block from 0.05 to a wave around 0.5: its top, and its sides and bottom, with the same vertices at the rim.
fn wavy_block(cells: u32) -> (TestMesh, TestMesh) {
    let n = cells + 1;
    let at = |i: u32, j: u32| {
        let (x, y) =
            (f64::from(i) / f64::from(cells) * 1.6 - 0.8, f64::from(j) / f64::from(cells) * 1.6 - 0.8);
        DVec3::new(x, y, 0.5 + 0.14 * (4.0 * x + 0.5).sin() * (3.0 * y).cos())
    };
    let mut top = TestMesh::default();
    top.positions.extend((0..n * n).map(|k| at(k % n, k / n)));
    for (i, j) in (0..cells).flat_map(|j| (0..cells).map(move |i| (i, j))) {
        let k = j * n + i;
        top.triangles.extend([[k, k + 1, k + n + 1], [k, k + n + 1, k + n]]);
    }
    let rim: Vec<u32> = (0..cells)
        .chain((0..cells).map(|j| j * n + cells))
        .chain((0..cells).map(|i| n * n - 1 - i))
        .chain((0..cells).map(|j| (cells - j) * n))
        .collect();
    let mut rest = TestMesh::default();
    for &k in &rim {
        let p = top.positions[k as usize];
        rest.positions.extend([p, DVec3::new(p.x, p.y, 0.05)]);
    }
    let count = rim.len() as u32;
    rest.positions.push(DVec3::new(0.0, 0.0, 0.05));
    for k in 0..count {
        let next = (k + 1) % count;
        rest.triangles.extend([[2 * k, 2 * k + 1, 2 * next + 1], [2 * k, 2 * next + 1, 2 * next]]);
        rest.triangles.push([2 * k + 1, 2 * count, 2 * next + 1]);
    }
    (top, rest)
}

/// A sky that photons carry instead of eye paths, a glowing medium of varying density, a mirror, four wavelengths.
#[test]
fn a_sky_of_photons_and_everything_else() {
    let mirror =
        parallelogram(DVec3::new(-1.2, 0.9, 0.05), DVec3::new(2.4, 0.3, 0.0), DVec3::new(0.0, 0.1, 0.9));
    let folder = SceneFolder::new()
        .mesh("floor.ply", &floor())
        .mesh("lamp.ply", &lamp())
        .mesh("mirror.ply", &mirror)
        .mesh("cube.ply", &cuboid(DVec3::new(-0.5, -0.5, 0.1), DVec3::new(0.4, 0.3, 0.7)));
    let text = "[media.water]\nior = 1.2\nabsorption = 0.5\n\
                scattering = { wavelength = [400, 700], value = [3, 1] }\nemission = 0.2\n\
                density = { stratified = 0.5, surface = 0.6 }\n\
                [[surfaces]]\nmesh = \"cube.ply\"\nfront = \"air\"\nback = \"water\"\nnormals = \"flat\"\n\
                material = { kind = \"dielectric\" }\n\
                [[surfaces]]\nmesh = \"mirror.ply\"\nmaterial = { kind = \"conductor\", eta = 0.2, k = 3 }\n\
                [sky]\nradiance = [0.6, 0.8, 1]\n";
    let settings = [("sky by photons", "sky = true"), ("sky by paths", "sky = false")];
    compare(&folder, text, &settings, 0.03, [48, 512]);
}

/// Wavelengths that part, of photons and of the eye paths that meet them: through the ball light comes to the floor, and
/// through it the floor is seen. What both were thinned for must not count twice.
#[test]
#[ignore = "takes half a minute"]
fn wavelengths_that_bend_their_own_ways() {
    let folder = SceneFolder::new()
        .mesh("floor.ply", &floor())
        .mesh("lamp.ply", &lamp())
        .mesh("ball.ply", &sphere(DVec3::new(0.0, 0.0, 0.7), 0.6, 2));
    let ball = "[media.glass]\nior = { wavelength = [380, 780], n = [1.8, 1.3] }\n\
                absorption = 0.1\nscattering = 0.2\n\
                [[surfaces]]\nmesh = \"ball.ply\"\nnormals = \"smooth\"\nfront = \"air\"\n\
                back = \"glass\"\nmaterial = { kind = \"dielectric\" }\n";
    let render = |more: &str| {
        let scene = scene(&folder, &format!("{ball}[render]\ndispersion = true\n{more}"));
        assert!(scene.frame.needs.dispersive);
        scene
    };
    let by_paths = Seeds::render(&render(""), 2048, 4, GRID).means();
    for (name, more) in
        [("parted, gathering", "final_gather = true"), ("parted, photons at once", "final_gather = false")]
    {
        let photons = format!("integrator = \"photon\"\nphotons = {{ count = 20000, {more} }}\n");
        let [near, middle, wide] = [1.0, 2.0, 4.0]
            .map(|factor| Seeds::render(&with_radius(render(&photons), factor * 0.03), 96, 4, GRID));
        let by_photons = Seeds::extrapolated(&near, &middle, &wide).means();
        assert_agree(name, &by_photons, &by_paths, 0.05);
    }
}

/// All that is done over wavelength at once: computed coefficients and phase functions, indices that part the lanes, the light
/// of a clear sky.
#[test]
fn a_turbid_block_that_disperses_under_a_clear_sky() {
    let folder = SceneFolder::new()
        .mesh("floor.ply", &floor())
        .mesh("cube.ply", &cuboid(DVec3::new(-0.5, -0.5, 0.1), DVec3::new(0.4, 0.3, 0.7)));
    let text = format!(
        "[[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 0.6 }}\n{VIEW}\
         [media.sea]\nmodel = \"particles\"\nior = {{ wavelength = [380, 780], n = [1.5, 1.3] }}\nabsorption = 0.1\n\
         species = [{{ ior = 1.6, volume_fraction = 1e-6, sizes = {{ kind = \"log-normal\", median_um = 0.3, deviation = 0.3 }} }}]\n\
         [[surfaces]]\nmesh = \"cube.ply\"\nfront = \"air\"\nback = \"sea\"\nnormals = \"flat\"\n\
         material = {{ kind = \"dielectric\" }}\n[sun]\nelevation = 35\nazimuth = 60\nirradiance = 0\n\
         [sky]\nradiance = {{ model = \"hosek-wilkie\", turbidity = 4 }}\n[render]\ndispersion = true\n"
    );
    let scene = folder.scene(&text);
    assert!(
        scene.frame.needs.dispersive && scene.frame.media.iter().any(|medium| medium.phase.one().is_none())
    );
    let by_paths = Seeds::render(&scene, 1024, 4, GRID).means();
    let render = format!(
        "{text}integrator = \"photon\"\nphotons = {{ count = 20000, sky = true, final_gather = false }}\n"
    );
    let [near, middle, wide] = [1.0, 2.0, 4.0]
        .map(|factor| Seeds::render(&with_radius(folder.scene(&render), factor * 0.03), 160, 4, GRID));
    let by_photons = Seeds::extrapolated(&near, &middle, &wide).means();
    assert_agree("all over wavelength", &by_photons, &by_paths, 0.05);
}

/// Lobes from backward ones to narrow peaks: some lanes of a pass take an angle for part of a peak, others do not.
#[test]
fn phase_functions_that_differ_from_wavelength_to_wavelength() {
    let folder = SceneFolder::new()
        .mesh("floor.ply", &floor())
        .mesh("lamp.ply", &lamp())
        .mesh("cube.ply", &cuboid(DVec3::new(-0.5, -0.5, 0.1), DVec3::new(0.4, 0.3, 0.7)));
    let text = "[media.milk]\nior = 1.2\nabsorption = 0.2\n\
                scattering = { wavelength = [400, 700], value = [5, 2] }\n\
                phase = { kind = \"henyey-greenstein\", g = { wavelength = [450, 600], value = [-0.4, 0.9] } }\n\
                [[surfaces]]\nmesh = \"cube.ply\"\nfront = \"air\"\nback = \"milk\"\nnormals = \"flat\"\n\
                material = { kind = \"dielectric\" }\n";
    compare(&folder, text, &[("phases over wavelength", "")], 0.03, [48, 512]);
}

/// A lamp that stands in water, half in it and half in the air: no medium is that of all of it. A quarter of the light
/// below was lost where chance's weight counted an estimate that was not made.
#[test]
fn a_lamp_that_reaches_into_water() {
    let v = DVec3::new;
    let folder = SceneFolder::new()
        .mesh("floor.ply", &floor())
        .mesh("lamp.ply", &parallelogram(v(-0.2, 0.3, 0.06), v(0.0, 0.0, 1.0), v(0.5, 0.1, 0.0)).turned())
        .mesh("pool.ply", &cuboid(v(-0.7, -0.7, 0.05), v(0.7, 0.7, 0.5)))
        .mesh("inner.ply", &parallelogram(v(-0.69, -0.69, 0.06), v(1.38, 0.0, 0.0), v(0.0, 1.38, 0.0)));
    let text = "[media.water]\nior = 1.33\nabsorption = [0.5, 0.2, 0.1]\n\
                [[surfaces]]\nmesh = \"pool.ply\"\nfront = \"air\"\nback = \"water\"\nnormals = \"flat\"\n\
                material = { kind = \"dielectric\" }\n\
                [[surfaces]]\nmesh = \"inner.ply\"\nmaterial = { kind = \"diffuse\", reflectance = 0.5 }\n";
    let photons = "[render]\nintegrator = \"photon\"\nphotons = { count = 20000 }\n";
    let by_photons = with_radius(scene(&folder, &format!("{text}{photons}")), 0.02);
    let lower = |scene: &Prepared, samples| Seeds::render(scene, samples, 4, [4, 2]).means().split_off(4);
    assert_agree("lamp in water", &lower(&by_photons, 24), &lower(&scene(&folder, text), 512), 0.05);
}

/// As many photons as there are kinds of light, and fewer.
#[test]
fn few_photons_carry_all_the_light() {
    let folder = SceneFolder::new()
        .mesh("floor.ply", &floor())
        .mesh("lamp.ply", &lamp())
        .mesh("wall.ply", &parallelogram(DVec3::new(-1.5, 1.0, 0.0), DVec3::X * 3.0, DVec3::Z * 1.5));
    let wall = "[sun]\ndirection = [0.3, -0.6, 0.7]\nirradiance = 4\nangular_diameter = 10\n\
                [[surfaces]]\nmesh = \"wall.ply\"\nmaterial = { kind = \"diffuse\", reflectance = 0.8 }\n";
    let by_paths = Seeds::render(&scene(&folder, wall), 256, 4, [1, 1]).means();
    for count in [1, 4] {
        let photons = format!("photons = {{ count = {count}, final_gather = false, radius = 0.2 }}");
        let text = format!("{wall}[render]\nintegrator = \"photon\"\n{photons}\n");
        let by_photons = Seeds::render(&with_radius(scene(&folder, &text), 0.05), 800, 4, [1, 1]).means();
        assert_agree(&format!("{count} photons"), &by_photons, &by_paths, 0.05);
    }
}

/// Where nothing takes photons, no light emits them, or the air scatters, the pictures are those of eye paths.
#[test]
fn without_photons_there_is_path_tracing() {
    let folder = SceneFolder::new().mesh("cube.ply", &cuboid(DVec3::splat(-0.5), DVec3::splat(0.5)));
    let cube = "[media.water]\nior = 1.33\nabsorption = [1, 0.5, 0.2]\n[[surfaces]]\nmesh = \"cube.ply\"\nfront = \"air\"\n\
                back = \"water\"\nmaterial = { kind = \"dielectric\" }\n[sky]\nradiance = [1, 2, 3]\n";
    let turbid = cube.replace("absorption", "scattering = 2\nabsorption");
    let misty = format!("[media.air]\nscattering = 0.3\ndensity = {{ stratified = -2 }}\n{turbid}");
    let sun = "[sun]\ndirection = [0, 0, 1]\nirradiance = 1\n";
    for (text, lamp) in [(cube, sun), (turbid.as_str(), ""), (misty.as_str(), sun)] {
        let picture = |render: &str| {
            let scene = folder.scene(&format!("{text}{lamp}{VIEW}[render]\n{render}"));
            assert_eq!(matches!(scene.sampling.integrator, Integrator::Photon(_)), render.contains("photon"));
            let picture = scene.render(8, 0);
            assert_eq!(picture.counters.photons, 0);
            picture.image.pixels.iter().map(|p| p.rgb.to_array().map(f32::to_bits)).collect::<Vec<_>>()
        };
        assert_eq!(
            picture("integrator = \"photon\"\nphotons = { sky = false }\n"),
            picture("integrator = \"path\"\n")
        );
    }
}
