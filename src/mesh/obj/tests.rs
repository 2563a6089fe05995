use super::*;
use crate::mesh::error::Blame;

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn read_text(text: &str) -> RawMesh {
    read(text.as_bytes()).unwrap()
}

#[test]
fn groups_share_their_vertices() {
    let mesh = read_text(&format!("{SQUARE}g a\nf 1 2 3\nusemtl m\ng b\nf 1 3 4\n"));
    assert_eq!(mesh.positions.len(), 4);
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
}

#[test]
fn coordinates_keep_double_precision() {
    let mesh = read_text("v 1000000.123456789 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_eq!(mesh.positions[0].x, 1_000_000.123_456_789);
}

#[test]
fn faces_may_come_before_their_vertices() {
    assert_eq!(read_text("f 3 2 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").positions[0], DVec3::Y);
}

#[test]
fn corners_have_their_own_normals() {
    let mesh = read_text(&format!("{SQUARE}vn 0 0 1\nvn 1 0 0\nf 1//1 2//2 3//1\nf 1//2 3//2 4//-1\n"));
    let normals = mesh.normals.unwrap();
    assert_eq!(normals.values, [Vec3::Z, Vec3::X]);
    assert_eq!(normals.corners, Some(vec![[0, 1, 0], [1, 1, 1]]));
}

#[test]
fn normals_that_some_corners_lack_are_left_out() {
    assert_eq!(read_text(&format!("{SQUARE}vn 0 0 1\nf 1//1 2//1 3//1\nf 1 3 4\n")).normals, None);
}

#[test]
fn a_file_without_faces_is_an_empty_mesh() {
    for text in ["# nothing\n", "o thing\nmtllib a.mtl\n", SQUARE, "\n"] {
        assert_eq!(read_text(text).triangles.len(), 0, "{text}");
    }
}

#[test]
fn errors_count_continued_lines() {
    let fault = read(format!("{SQUARE}f 1 \\\n 2 \\\n 3\nf 1 2 9\n").as_bytes()).unwrap_err();
    assert_eq!((fault.blame, fault.place), (Blame::Invalid, Place::Line(8)));
    let fault = read(format!("{SQUARE}f 1 \\\n 2 \\\n 3\nv a b c\n").as_bytes()).unwrap_err();
    assert_eq!((fault.blame, fault.place), (Blame::Malformed, Place::Line(8)));
}
