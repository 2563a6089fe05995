//! The hierarchy against brute force, aimed rays against leaks, and independence of the tree.

#![allow(clippy::unwrap_used)] // a test that cannot go on fails

use floe::accel::{Accel, Hit, Ignored};
use floe::geometry::Ray;
use floe::geometry::triangle::RayCast;
use floe::sampling::{SampleSeed, SampleStream, warp};
use glam::Vec3;
use proptest::prelude::*;

/// A closed, bumpy sphere of 8 * 4^levels triangles.
fn blob(levels: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut positions = vec![Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z];
    let mut triangles =
        vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    for _ in 0..levels {
        let mut midpoints = std::collections::BTreeMap::new();
        let mut middle = |a: u32, b: u32, positions: &mut Vec<Vec3>| {
            *midpoints.entry((a.min(b), a.max(b))).or_insert_with(|| {
                positions.push((positions[a as usize] + positions[b as usize]).normalize());
                positions.len() as u32 - 1
            })
        };
        let mut finer = Vec::new();
        for [a, b, c] in triangles {
            let (ab, bc, ca) =
                (middle(a, b, &mut positions), middle(b, c, &mut positions), middle(c, a, &mut positions));
            finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    for p in &mut positions {
        let bump = 1.0 + 0.1 * (7.0 * p.x).sin() * (5.0 * p.y).cos() + 0.05 * (11.0 * p.z).sin();
        *p *= bump;
    }
    (positions, triangles)
}

fn built(positions: &[Vec3], triangles: &[[u32; 3]]) -> Accel {
    let accel = Accel::build(positions, triangles);
    accel.validate(positions, triangles).unwrap();
    accel
}

fn brute_force(positions: &[Vec3], triangles: &[[u32; 3]], ray: &Ray) -> Option<Hit> {
    let cast = RayCast::new(ray);
    let mut best: Option<Hit> = None;
    for (id, t) in triangles.iter().enumerate() {
        let t_max = best.map_or(ray.t_max, |b| b.t);
        if let Some(found) = cast.triangle(&t.map(|i| positions[i as usize]), t_max)
            && best.is_none_or(|b| found.t < b.t)
        {
            let (t, barycentric, from_front) = (found.t, found.barycentric, found.from_front);
            best = Some(Hit { triangle: id as u32, t, barycentric, from_front });
        }
    }
    best
}

/// Rays from a few points inside at vertices, edge midpoints and random points of edges; counts those that miss.
fn leaks(positions: &[Vec3], triangles: &[[u32; 3]], centre: Vec3, radius: f32, rays: u32) -> u32 {
    let accel = built(positions, triangles);
    let seed = SampleSeed { seed: 1, frame: 0 };
    (0..rays)
        .filter(|&i| {
            let mut stream = SampleStream::new(seed, i, 0, 0);
            let u = stream.next4();
            let origin = centre + warp::sphere([u[0], u[1]]) * (0.5 * radius * u[2]);
            let triangle = triangles[(i as usize * 7919) % triangles.len()];
            let [a, b] = [positions[triangle[0] as usize], positions[triangle[1] as usize]];
            let target = match i % 3 {
                0 => a,
                1 => a + (b - a) * 0.5,
                _ => a + (b - a) * u[3],
            };
            let ray = Ray::new(origin, (target - origin).normalize());
            accel.closest(&ray, Ignored::NOTHING).is_none()
        })
        .count() as u32
}

#[test]
fn two_million_rays_at_edges_and_vertices_never_leak() {
    let (unit, triangles) = blob(6);
    for (scale, offset) in [(1.0, Vec3::ZERO), (1e-3, Vec3::ZERO), (1.0, Vec3::splat(1000.0))] {
        let positions: Vec<Vec3> = unit.iter().map(|&p| p * scale + offset).collect();
        assert_eq!(leaks(&positions, &triangles, offset, scale, 667_000), 0, "scale {scale} offset {offset}");
    }
}

#[test]
fn refitted_and_rebuilt_trees_answer_alike_to_the_last_bit() {
    let (positions, triangles) = blob(4);
    let moved: Vec<Vec3> =
        positions.iter().map(|p| *p + 0.2 * Vec3::new(p.y * p.y, p.z, p.x * p.y)).collect();
    let mut refitted = built(&positions, &triangles);
    refitted.refit(&moved, &triangles);
    refitted.validate(&moved, &triangles).unwrap();
    let rebuilt = built(&moved, &triangles);
    for i in 0..20_000 {
        let u = SampleStream::new(SampleSeed { seed: 2, frame: 0 }, i, 0, 0).next4();
        let ray = Ray::new(Vec3::new(u[2], u[3], 0.1) * 0.3, warp::sphere([u[0], u[1]]));
        assert_eq!(refitted.closest(&ray, Ignored::NOTHING), rebuilt.closest(&ray, Ignored::NOTHING));
    }
}

#[test]
fn identical_triangles_give_a_bounded_tree_and_the_lowest_index() {
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let triangles = vec![[0, 1, 2]; 5000];
    let accel = built(&positions, &triangles);
    let hit = accel.closest(&Ray::new(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z), Ignored::NOTHING).unwrap();
    assert_eq!(hit.triangle, 0);
    let hit = accel.closest(&Ray::new(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z), Ignored::one(0)).unwrap();
    assert_eq!(hit.triangle, 1);
}

#[test]
fn nothing_and_one_triangle() {
    let down = Ray::new(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z);
    assert!(built(&[], &[]).closest(&down, Ignored::NOTHING).is_none());
    let one = built(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]]);
    assert!(one.occluded(&down, Ignored::NOTHING) && !one.occluded(&down, Ignored::one(0)));
    assert!(!one.occluded(&Ray { t_max: 0.5, ..down }, Ignored::NOTHING));
}

fn coordinate() -> impl Strategy<Value = f32> {
    // A coarse lattice makes ties, slivers, coplanar and degenerate triangles common.
    (-4_i32..=4).prop_map(|i| i as f32 * 0.25)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn the_tree_agrees_with_brute_force_on_lattice_soup(
        points in prop::collection::vec((coordinate(), coordinate(), coordinate()), 3..120),
        exponent in -12_i32..12,
        directions in prop::collection::vec((coordinate(), coordinate(), coordinate()), 20)
    ) {
        let scale = 10.0_f32.powi(exponent / 2);
        let positions: Vec<Vec3> = points.iter().map(|&(x, y, z)| Vec3::new(x, y, z) * scale).collect();
        let triangles: Vec<[u32; 3]> =
            (0..positions.len() as u32 - 2).map(|i| [i, i + 1, i + 2]).collect();
        let accel = built(&positions, &triangles);
        for &(x, y, z) in &directions {
            let d = Vec3::new(x, y, z);
            prop_assume!(d != Vec3::ZERO);
            let ray = Ray::new(Vec3::new(0.125, -0.25, 0.5) * scale - d * (3.0 * scale), d.normalize());
            let want = brute_force(&positions, &triangles, &ray);
            prop_assert_eq!(accel.closest(&ray, Ignored::NOTHING), want);
            prop_assert_eq!(accel.occluded(&ray, Ignored::NOTHING), want.is_some());
        }
    }
}
