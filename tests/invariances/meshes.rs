//! Other names, orders and triangles of the same surface.

use floe::mesh::canonical::canonical;
use floe::mesh::{Interface, RawMesh, Region};
use floe::sampling::{SampleSeed, SampleStream};

use crate::bodies::{CLEAR, Media, Place, TURBID, bodies, scene, scene_with_labels};
use crate::common::render::Rendered;
use crate::pictures::{assert_alike, assert_same};

fn picture(media: Media, mesh: &RawMesh, samples: u32) -> Rendered {
    scene(Place::HERE, media, mesh, "").render(samples, 1)
}

/// The numbers below `count` in an order drawn by chance.
fn shuffled(count: usize, draw: u32) -> Vec<usize> {
    let key = |i: usize| SampleStream::new(SampleSeed::new(12), draw, i as u32, 0).next4()[0];
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&i, &j| key(i).total_cmp(&key(j)));
    order
}

/// The vertices and triangles in another order, each triangle beginning at another corner.
fn permuted(mesh: &RawMesh, draw: u32) -> RawMesh {
    let vertices = shuffled(mesh.positions.len(), 2 * draw);
    let triangles = shuffled(mesh.triangles.len(), 2 * draw + 1);
    let mut place = vec![0; vertices.len()];
    vertices.iter().enumerate().for_each(|(new, &old)| place[old] = new as u32);
    let turned = |&i: &usize| {
        let mut triangle = mesh.triangles[i].map(|v| place[v as usize]);
        triangle.rotate_left(i % 3);
        triangle
    };
    let interfaces = mesh.interfaces.as_ref().unwrap();
    RawMesh {
        positions: vertices.iter().map(|&old| mesh.positions[old]).collect(),
        triangles: triangles.iter().map(turned).collect(),
        interfaces: Some(triangles.iter().map(|&i| interfaces[i]).collect()),
        ..RawMesh::default()
    }
}

/// Every triangle as four.
fn split(mesh: &RawMesh) -> RawMesh {
    let mut fine = RawMesh { positions: mesh.positions.clone(), ..RawMesh::default() };
    let mut middle = |a: u32, b: u32| {
        fine.positions.push(mesh.positions[a as usize].midpoint(mesh.positions[b as usize]));
        fine.positions.len() as u32 - 1
    };
    for &[a, b, c] in &mesh.triangles {
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        fine.triangles.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
    }
    fine.interfaces = Some(mesh.interfaces.iter().flatten().flat_map(|&i| [i; 4]).collect());
    floe::mesh::weld(&mut fine);
    fine
}

#[test]
fn labels_are_names() {
    let renamed = |region: Region| match region {
        Region(1) => Region(902),
        Region(2) => Region(-7),
        other => other,
    };
    let mut mesh = bodies();
    for Interface { front, back } in mesh.interfaces.iter_mut().flatten() {
        (*front, *back) = (renamed(*front), renamed(*back));
    }
    for media in [CLEAR, TURBID] {
        let other = scene_with_labels([902, -7], Place::HERE, media, &mesh, "").render(8, 1);
        assert_same("labels", &picture(media, &bodies(), 8), &other);
    }
}

/// The order in a file decides which of two triangles a ray meets that goes through their edge, and at which corner a
/// triangle begins decides the last bits of where it is met; put into the order of [`canonical`] all are the same.
#[test]
fn the_order_in_the_file_does_not_matter() {
    let mesh = split(&bodies());
    for (name, media) in [("clear", CLEAR), ("turbid", TURBID)] {
        let expected = picture(media, &mesh, 16);
        for draw in 0..3 {
            let other = permuted(&mesh, draw);
            assert_alike(&format!("{name}, order {draw}"), &expected, &picture(media, &other, 16));
            assert_same(name, &picture(media, &canonical(&mesh), 4), &picture(media, &canonical(&other), 4));
        }
    }
}

#[test]
fn split_triangles_look_the_same() {
    for (name, media) in [("clear", CLEAR), ("turbid", TURBID)] {
        let expected = picture(media, &bodies(), 32);
        let once = split(&bodies());
        for (times, mesh) in [(1, &once), (2, &split(&once)), (3, &split(&split(&once)))] {
            assert_alike(&format!("{name}, split {times} times"), &expected, &picture(media, mesh, 32));
        }
    }
}
