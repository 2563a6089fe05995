//! Boxes of sheets, from which scenes are meshed exactly and overlapping.

use glam::{DQuat, DVec3, EulerRot};

use crate::common::mesh::{TestMesh, parallelogram};
use crate::common::render::Prepared;
use crate::common::scene::SceneFolder;
use crate::seeds::{Seeds, assert_agree};

/// The sides of a square tube of half width `r`, normals outwards.
pub fn sides(r: f64, low: f64, high: f64) -> TestMesh {
    let corners = [[-r, -r], [r, -r], [r, r], [-r, r]].map(|[x, y]| DVec3::new(x, y, low));
    let side =
        |i: usize| parallelogram(corners[i], corners[(i + 1) % 4] - corners[i], DVec3::Z * (high - low));
    joined((0..4).map(side))
}

/// A square, seen from above.
pub fn square(r: f64, height: f64) -> TestMesh {
    parallelogram(DVec3::new(-r, -r, height), DVec3::X * 2.0 * r, DVec3::Y * 2.0 * r)
}

/// A square with a square hole, seen from above.
pub fn frame(outer: f64, inner: f64, height: f64) -> TestMesh {
    let corners = |r: f64| [[-r, -r], [r, -r], [r, r], [-r, r]].map(|[x, y]| DVec3::new(x, y, height));
    let positions = [corners(outer), corners(inner)].concat();
    let side = |i: u32| [[i, (i + 1) % 4, 4 + (i + 1) % 4], [i, 4 + (i + 1) % 4, 4 + i]];
    TestMesh { positions, triangles: (0..4).flat_map(side).collect() }
}

pub fn joined(meshes: impl IntoIterator<Item = TestMesh>) -> TestMesh {
    let mut all = TestMesh::default();
    for mesh in meshes {
        let first = all.positions.len() as u32;
        all.positions.extend(&mesh.positions);
        all.triangles.extend(mesh.triangles.iter().map(|t| t.map(|i| i + first)));
    }
    all
}

/// Off the axes, so that rounding has its say.
pub fn turned(mut mesh: TestMesh) -> TestMesh {
    let turn = DQuat::from_euler(EulerRot::XYZ, 0.02, -0.03, 0.4);
    mesh.positions.iter_mut().for_each(|p| *p = turn * *p);
    mesh
}

/// Sheets by the media in front of them and behind.
pub type Sheets = Vec<([&'static str; 2], TestMesh)>;

/// The surfaces of a scene that is meshed exactly; their files are those of [`with_sheets`].
pub fn surfaces(sheets: &Sheets) -> String {
    let surface = |([front, back], _): &([&str; 2], TestMesh)| {
        format!(
            "[[surfaces]]\nmesh = \"{front}_{back}.ply\"\nnormals = \"flat\"\nfront = \"{front}\"\n\
             back = \"{back}\"\nmaterial = {{ kind = \"dielectric\" }}\n"
        )
    };
    sheets.iter().map(surface).collect()
}

pub fn with_sheets(folder: SceneFolder, sheets: &Sheets) -> SceneFolder {
    sheets.iter().fold(folder, |folder, ([front, back], mesh)| {
        folder.mesh(&format!("{front}_{back}.ply"), &turned(mesh.clone()))
    })
}

/// Two scenes that ought to look alike, of meshes that do not overlap and of such that do.
pub fn assert_alike(name: &str, [exact, overlapping]: &[Prepared; 2], grid: [u32; 2], samples: u32) {
    assert!(!exact.frame.needs.layers && overlapping.frame.needs.layers);
    let [expected, found] = [exact, overlapping]
        .map(|s| s.frame.medium(s.frame.start_of(&s.frame.views.opening.ray(0.0, 0.0)).medium).name.clone());
    assert_eq!(expected, found, "{name}: the medium of the camera");
    let [expected, found] = [exact, overlapping].map(|scene| Seeds::render(scene, samples, 4, grid).means());
    assert_agree(name, &found, &expected, 0.05);
}
