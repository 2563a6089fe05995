//! Single meshes that trees find hard.

use floe::accel::{Accel, Ignored};
use floe::geometry::Ray;
use floe::sampling::{SampleSeed, SampleStream, warp};
use glam::Vec3;

use crate::brute_force::assert_agrees;
use crate::meshes::Mesh;

/// Rays of all directions from around the origin, for a mesh of size `scale`.
fn rays(count: u32, scale: f32) -> impl Iterator<Item = Ray> {
    (0..count).map(move |i| {
        let u = SampleStream::new(SampleSeed::new(2), i, 0, 0).next4();
        Ray::new(Vec3::new(u[2], u[3], 0.1) * (0.3 * scale), warp::sphere([u[0], u[1]]))
    })
}

#[test]
fn refitted_and_rebuilt_trees_answer_alike_to_the_last_bit() {
    let mesh = Mesh::jittered_blob(4);
    let moved = |p: &Vec3| *p + 0.2 * Vec3::new(p.y * p.y, p.z, p.x * p.y);
    let moved =
        Mesh { positions: mesh.positions.iter().map(moved).collect(), triangles: mesh.triangles.clone() };
    let (refitted, rebuilt) = (moved.refitted(mesh.built()), moved.built());
    for ray in rays(20_000, 1.0) {
        assert_eq!(refitted.closest(&ray, Ignored::NOTHING), rebuilt.closest(&ray, Ignored::NOTHING));
    }
}

#[test]
fn identical_triangles_give_a_bounded_tree_and_the_lowest_index() {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let shared = Mesh { positions, triangles: vec![[0, 1, 2]; 5000] };
    let down = Ray::new(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z);
    for mesh in [shared.unshared(), shared] {
        let accel = mesh.built();
        assert_eq!(accel.closest(&down, Ignored::NOTHING).unwrap().triangle, 0);
        assert_eq!(accel.closest(&down, Ignored::one(0)).unwrap().triangle, 1);
        assert_eq!(accel.closest(&down, Ignored([1, 0])).unwrap().triangle, 2);
        assert_agrees(&accel, &mesh, &down);
    }
}

#[test]
fn the_lower_index_wins_wherever_the_others_are() {
    // Two sheets in one place, the triangles of the first in another order.
    let sheet = Mesh::blob(4);
    let count = sheet.triangles.len() as u32;
    let place = |i: u32| i * 797 % count;
    let again = (0..count).map(|i| sheet.triangles[place(i) as usize]);
    let triangles = again.chain(sheet.triangles.iter().copied()).collect();
    let mesh = Mesh { positions: sheet.positions.clone(), triangles };
    let (accel, alone) = (mesh.built(), sheet.built());
    for ray in rays(20_000, 1.0) {
        let both = accel.closest(&ray, Ignored::NOTHING).unwrap();
        let one = alone.closest(&ray, Ignored::NOTHING).unwrap();
        assert_eq!((place(both.triangle), both.t), (one.triangle, one.t));
    }
}

#[test]
fn nothing_and_one_triangle() {
    let down = Ray::new(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z);
    let nothing = Mesh { positions: vec![], triangles: vec![] }.built();
    assert!(nothing.closest(&down, Ignored::NOTHING).is_none() && !nothing.occluded(&down, Ignored::NOTHING));
    let mesh = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]] };
    let one = mesh.built();
    assert!(one.occluded(&down, Ignored::NOTHING) && !one.occluded(&down, Ignored::one(0)));
    assert!(!one.occluded(&Ray { t_max: 0.5, ..down }, Ignored::NOTHING));
    // Leaves have room for more triangles, and what is there must not be met instead.
    assert!(!one.occluded(&down, Ignored([0, 7])) && one.closest(&down, Ignored([0, 7])).is_none());
    one.each_hit(&down, Ignored([0, 7]), |hit| panic!("{hit:?}"));
    assert_agrees(&one, &mesh, &down);
}

#[test]
fn a_fan_of_a_thousand_is_met_at_its_centre() {
    let mesh = Mesh::fan(1000);
    let accel = mesh.built();
    let centre = mesh.positions[0];
    for ray in rays(500, 1.0) {
        let origin = centre + ray.direction;
        let ray = Ray::new(origin, (centre - origin).normalize());
        assert_agrees(&accel, &mesh, &ray);
        assert_agrees(&accel, &mesh, &Ray::new(centre, ray.direction));
    }
}

#[test]
fn triangles_without_common_vertices_have_leaves_of_two() {
    let shared = Mesh::jittered_blob(4);
    let soup = shared.unshared();
    let (together, apart) = (shared.built(), soup.built());
    // Two triangles have six of the eight vertices of a leaf, whose neighbours have three leaves of the same size.
    assert!(apart.bytes() > 3 * together.bytes() / 2, "{} {}", apart.bytes(), together.bytes());
    for ray in rays(20_000, 1.0) {
        assert_eq!(apart.closest(&ray, Ignored::NOTHING), together.closest(&ray, Ignored::NOTHING));
    }
    rays(100, 1.0).for_each(|ray| assert_agrees(&apart, &soup, &ray));
}

#[test]
fn everything_may_become_a_point_and_something_again() {
    let mesh = Mesh::blob(4);
    let point = mesh.placed(0.0, Vec3::new(0.1, 0.2, 0.3));
    let accel: Accel = point.refitted(mesh.built());
    assert!(rays(1000, 1.0).all(|ray| !accel.occluded(&ray, Ignored::NOTHING)));
    let accel = mesh.refitted(accel);
    assert!(rays(1000, 1.0).all(|ray| accel.occluded(&ray, Ignored::NOTHING)));
    point.built();
}
