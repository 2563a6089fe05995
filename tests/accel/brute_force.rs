//! What a ray meets, found by asking every triangle.

use floe::accel::{Accel, Hit, Ignored, TriangleId};
use floe::geometry::Ray;
use floe::geometry::triangle::RayCast;

use crate::meshes::Mesh;

/// The nearest triangle, the lowest index among those at the same distance.
fn closest(mesh: &Mesh, ray: &Ray, ignored: Option<TriangleId>) -> Option<Hit> {
    let cast = RayCast::new(ray);
    let mut best: Option<Hit> = None;
    for triangle in (0..mesh.triangles.len() as TriangleId).filter(|&id| Some(id) != ignored) {
        let t_max = best.map_or(ray.t_max, |b| b.t);
        if let Some(found) = cast.triangle(&mesh.vertices(triangle as usize), t_max)
            && best.is_none_or(|b| found.t < b.t)
        {
            let (t, barycentric, from_front) = (found.t, found.barycentric, found.from_front);
            best = Some(Hit { triangle, t, barycentric, from_front });
        }
    }
    best
}

type Bits = (TriangleId, [u32; 4], bool);

/// Every bit of a hit.
fn bits(hit: Option<Hit>) -> Option<Bits> {
    hit.map(|Hit { triangle, t, barycentric: b, from_front }| {
        (triangle, [t, b.x, b.y, b.z].map(f32::to_bits), from_front)
    })
}

/// Checks that the hierarchy answers like brute force, bit by bit: without an end, with an end before, at and behind the
/// hit, and with the triangle that is hit left out.
pub fn assert_agrees(accel: &Accel, mesh: &Mesh, ray: &Ray) {
    let found = assert_same(accel, mesh, ray, None);
    let Some(Hit { triangle, t, .. }) = found else { return };
    assert_same(accel, mesh, ray, Some(triangle));
    for t_max in [t.next_down(), t, t.next_up()] {
        assert_same(accel, mesh, &Ray { t_max, ..*ray }, None);
    }
    let at_the_end = Ray { t_max: t, ..*ray };
    assert_eq!(bits(accel.closest(&at_the_end, Ignored::NOTHING)), bits(found), "an end at the hit: {ray:?}");
}

fn assert_same(accel: &Accel, mesh: &Mesh, ray: &Ray, left_out: Option<TriangleId>) -> Option<Hit> {
    let expected = closest(mesh, ray, left_out);
    let ignored = left_out.map_or(Ignored::NOTHING, Ignored::one);
    let found = accel.closest(ray, ignored);
    assert_eq!(bits(found), bits(expected), "{found:?} is not {expected:?} without {left_out:?}: {ray:?}");
    assert_eq!(
        accel.occluded(ray, ignored),
        expected.is_some(),
        "{expected:?} without {left_out:?}: {ray:?}"
    );
    expected
}
