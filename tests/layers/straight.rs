//! Beer and Lambert's law along straight rays: media of index 1 that only absorb, and no chance anywhere.

use floe::integrator::{PreparedLight, Scratch};
use floe::sampling::{SampleSeed, SampleStream};
use floe::spectrum::Wavelengths;
use glam::{DQuat, DVec3, EulerRot};

use crate::common::mesh::{TestMesh, cuboid, sphere};
use crate::common::render::Prepared;
use crate::common::scene::SceneFolder;

const WATER: f64 = 0.7;
const ICE: f64 = 1.9;
const GLASS: f64 = 0.2;

/// Where a line is within a convex mesh, by every triangle in double precision.
fn span(mesh: &TestMesh, origin: DVec3, direction: DVec3) -> Option<[f64; 2]> {
    let hits: Vec<f64> = mesh
        .triangles
        .iter()
        .filter_map(|t| {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
            let (p, q) = (direction.cross(c - a), (origin - a).cross(b - a));
            let scale = 1.0 / (b - a).dot(p);
            let (u, v) = ((origin - a).dot(p) * scale, direction.dot(q) * scale);
            (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| (c - a).dot(q) * scale)
        })
        .collect();
    let ends =
        [hits.iter().copied().fold(f64::INFINITY, f64::min), hits.iter().copied().fold(-1.0, f64::max)];
    (ends[1] > ends[0].max(0.0)).then(|| [ends[0].max(0.0), ends[1]])
}

/// Optical depth along a ray through bodies, the strongest first.
fn depth(bodies: &[(&TestMesh, f64)], origin: DVec3, direction: DVec3) -> f64 {
    let spans: Vec<_> = bodies.iter().map(|(mesh, sigma)| (span(mesh, origin, direction), *sigma)).collect();
    let mut ends: Vec<f64> = spans.iter().filter_map(|(span, _)| *span).flatten().collect();
    ends.sort_by(f64::total_cmp);
    ends.windows(2)
        .map(|pair| {
            let middle = 0.5 * (pair[0] + pair[1]);
            let holds = |span: &Option<[f64; 2]>| span.is_some_and(|s| s[0] < middle && middle < s[1]);
            let strongest = spans.iter().find(|(span, _)| holds(span));
            strongest.map_or(0.0, |(_, sigma)| sigma * (pair[1] - pair[0]))
        })
        .sum()
}

/// The radiance along every ray against the closed form; `bodies` are the strongest first.
///
/// A crossing is off by some roundings of distances of 6 m, 2e-6 times sigma for each of six crossings, over the cosine:
/// less than 5e-5 of the radiance, unless a ray grazes a face or passes within rounding of an edge. One ray of a thousand
/// may. Distances of hundreds of metres are rounded in proportion.
fn check(name: &str, scene: &Prepared, bodies: &[(&TestMesh, f64)]) {
    let frame = &scene.frame;
    let mut scratch = Scratch::default();
    let wavelengths = Wavelengths::for_mode(frame.mode, 0.5);
    let camera = &frame.views.opening;
    let tolerance = 1e-5 * (camera.eye().as_dvec3() + frame.origin).length().max(5.0);
    let [width, height] = camera.resolution();
    let (mut off, mut within, mut worst) = (0, 0, 0.0_f64);
    for i in 0..width * height {
        let point = [(i % width) as f32 + 0.5, (i / width) as f32 + 0.5];
        let stream = SampleStream::new(SampleSeed::new(1), i, 0, 0);
        let ray = camera.ray(point[0], point[1]);
        let found = scene.sampling.integrator.sample(
            frame,
            &mut scratch,
            &ray,
            &wavelengths,
            stream,
            PreparedLight::default(),
        );
        let depth = depth(bodies, ray.origin.as_dvec3() + frame.origin, ray.direction.as_dvec3());
        let error = (f64::from(found.radiance.max_element()) / (-depth).exp() - 1.0).abs();
        within += u32::from(depth > 0.0);
        off += u32::from(error > tolerance);
        worst = worst.max(error);
    }
    println!("{name}: {within} rays within, {off} off, at worst by {worst:.1e}");
    assert!(within > width * height / 6, "{name}: {within} rays meet something");
    assert!(off <= width * height / 1000, "{name}: {off} rays are off, at worst by {worst}");
    assert_eq!(scratch.counters.label_mismatches, 0, "{name}");
    assert_eq!(scratch.counters.escaped_inside, 0, "{name}");
}

fn scene(folder: &SceneFolder, eye: &str, meshes: &str) -> Prepared {
    let fov = if eye == FAR { 0.8 } else { 45.0 };
    folder.scene(&format!(
        "[sky]\nradiance = 1\n[media.water]\nabsorption = {WATER}\n[media.ice]\nabsorption = {ICE}\n\
         [media.glass]\nabsorption = {GLASS}\n\
         [camera]\neye = {eye}\ntarget = [0.1, 0.05, 0]\nvertical_fov = {fov}\nresolution = [90, 90]\n{meshes}"
    ))
}

fn mesh(path: &str, inside: &str, more: &str) -> String {
    format!("[[meshes]]\npath = \"{path}\"\ninside = \"{inside}\"\n{more}\n")
}

/// So far away that distances along rays are rounded to more than what parts coincident faces.
const FAR: &str = "[155, -210, 85]";

/// From outside, from within the overlap, and from the one body alone.
const EYES: [&str; 4] =
    ["[3.1, -4.2, 1.7]", "[0.41, 0.32, 0.13]", "[-0.71, -0.6, -0.33]", "[1.21, 0.9, 0.52]"];

#[test]
fn the_mesh_of_higher_priority_absorbs_where_two_overlap() {
    let water = cuboid(DVec3::splat(-1.0), DVec3::new(1.0, 1.0, 0.8));
    let ice = cuboid(DVec3::new(-0.2, -0.3, -0.5), DVec3::new(1.4, 1.2, 1.3));
    let folder = SceneFolder::new().mesh("water.ply", &water).mesh("ice.ply", &ice);
    let (wet, cold) = ((&water, WATER), (&ice, ICE));
    for eye in EYES {
        for (name, first, second, bodies) in [
            ("ice wins", "priority = 1", "priority = 2", [cold, wet]),
            ("water wins", "priority = 2", "priority = -3", [wet, cold]),
            ("the first wins", "", "", [wet, cold]),
        ] {
            let meshes = mesh("water.ply", "water", first) + &mesh("ice.ply", "ice", second);
            let scene = scene(&folder, eye, &meshes);
            assert!(scene.frame.needs.layers);
            check(&format!("{name} from {eye}"), &scene, &bodies);
        }
    }
}

#[test]
fn three_round_bodies_and_one_within_another() {
    let water = sphere(DVec3::ZERO, 1.3, 2);
    let ice = sphere(DVec3::new(0.9, 0.4, 0.2), 0.8, 1);
    let glass = sphere(DVec3::new(0.3, 0.2, -0.1), 0.5, 2);
    let folder = SceneFolder::new().mesh("water.ply", &water).mesh("ice.ply", &ice).mesh("glass.ply", &glass);
    let meshes = mesh("glass.ply", "glass", "priority = 5")
        + &mesh("water.ply", "water", "priority = 1")
        + &mesh("ice.ply", "ice", "priority = 3");
    for eye in EYES {
        check(eye, &scene(&folder, eye, &meshes), &[(&glass, GLASS), (&ice, ICE), (&water, WATER)]);
    }
}

/// A body of air in water is a hole.
#[test]
fn a_bubble_is_a_mesh_of_air() {
    let water = cuboid(DVec3::splat(-1.0), DVec3::splat(1.0));
    let bubble = sphere(DVec3::new(0.2, 0.1, 0.9), 0.4, 2);
    let folder = SceneFolder::new().mesh("water.ply", &water).mesh("bubble.ply", &bubble);
    let meshes = mesh("water.ply", "water", "") + &mesh("bubble.ply", "air", "priority = 1");
    for eye in EYES {
        check(eye, &scene(&folder, eye, &meshes), &[(&bubble, 0.0), (&water, WATER)]);
    }
}

/// Faces of two boxes on each other, of other triangles, along the axes and off them: neither a gap nor a doubling.
#[test]
fn faces_on_each_other_leave_no_gap() {
    for turn in [DQuat::IDENTITY, DQuat::from_euler(EulerRot::XYZ, 0.3, 0.5, 0.7)] {
        let turned = |mut mesh: TestMesh| {
            mesh.positions.iter_mut().for_each(|p| *p = turn * *p);
            mesh
        };
        let water = turned(cuboid(DVec3::splat(-1.0), DVec3::new(0.2, 1.0, 1.0)));
        let ice = turned(cuboid(DVec3::new(0.2, -0.7, -1.0), DVec3::new(1.1, 1.0, 0.6)));
        let folder = SceneFolder::new().mesh("water.ply", &water).mesh("ice.ply", &ice);
        for order in [["priority = 1", ""], ["", "priority = 1"]] {
            let meshes = mesh("water.ply", "water", order[0]) + &mesh("ice.ply", "ice", order[1]);
            for eye in EYES.into_iter().chain([FAR]) {
                check(eye, &scene(&folder, eye, &meshes), &[(&ice, ICE), (&water, WATER)]);
            }
        }
    }
}

#[test]
fn meshes_apart_are_interfaces_like_any_other() {
    let (left, right) = (sphere(DVec3::X * -1.1, 0.9, 2), sphere(DVec3::X * 1.1, 0.9, 2));
    let folder = SceneFolder::new().mesh("left.ply", &left).mesh("right.ply", &right);
    let meshes = mesh("left.ply", "water", "") + &mesh("right.ply", "ice", "");
    let scene = scene(&folder, EYES[0], &meshes);
    assert!(!scene.frame.needs.layers && scene.frame.layers.is_empty());
    check("apart", &scene, &[(&left, WATER), (&right, ICE)]);
}
