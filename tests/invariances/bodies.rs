//! A scene of all kinds of boundaries that can be put anywhere: water and ice that share a face, over a diffuse floor, under a
//! lamp, the sun and the sky.

use floe::mesh::RawMesh;
use glam::{DQuat, DVec3};

use crate::common::render::{Prepared, prepare};
use crate::small::{Folder, cuboid, joined, labelled, ply};

/// Where a scene stands, how large it is and how it is turned.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    pub scale: f64,
    pub turn: DQuat,
    pub shift: DVec3,
}

impl Place {
    pub const HERE: Self = Self { scale: 1.0, turn: DQuat::IDENTITY, shift: DVec3::ZERO };

    pub fn of(&self, point: DVec3) -> DVec3 {
        self.turn * (point * self.scale) + self.shift
    }

    pub fn of_mesh(&self, mesh: &RawMesh) -> RawMesh {
        RawMesh { positions: mesh.positions.iter().map(|&p| self.of(p)).collect(), ..mesh.clone() }
    }
}

/// Water at the left, ice at the right, air around; where they touch they write a face each.
pub fn bodies() -> RawMesh {
    let water = labelled(cuboid(DVec3::new(-1.0, -0.8, -0.7), DVec3::new(0.0, 0.8, 0.6)), 0, 1);
    let ice = labelled(cuboid(DVec3::new(0.0, -0.8, -0.7), DVec3::new(1.1, 0.8, 0.6)), 0, 2);
    let turn = DQuat::from_rotation_z(0.4);
    let mut both = joined(water, &ice);
    both.positions.iter_mut().for_each(|p| *p = turn * *p);
    both
}

/// Coefficients in 1/m of a scene that is not scaled.
#[derive(Clone, Copy, Debug)]
pub struct Media {
    pub absorption: [f64; 2],
    pub scattering: [f64; 2],
}

pub const CLEAR: Media = Media { absorption: [0.4, 0.1], scattering: [0.0, 0.0] };
pub const TURBID: Media = Media { absorption: [0.2, 0.05], scattering: [1.0, 3.0] };

/// A square, seen from above when `up`, else from below.
fn square(half: f64, height: f64, up: bool) -> RawMesh {
    let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
    let positions = corners.map(|[x, y]| DVec3::new(x, y, height)).into();
    let triangles = if up { vec![[0, 1, 2], [0, 2, 3]] } else { vec![[0, 2, 1], [0, 3, 2]] };
    RawMesh { positions, triangles, ..RawMesh::default() }
}

/// The tables of the scene.
pub fn tables(place: Place, media: Media, more: &str) -> String {
    let point = |x, y, z| format!("{:?}", place.of(DVec3::new(x, y, z)).to_array());
    let way = |x, y, z| format!("{:?}", (place.turn * DVec3::new(x, y, z)).to_array());
    let [[water_a, ice_a], [water_s, ice_s]] =
        [media.absorption, media.scattering].map(|of| of.map(|k| k / place.scale));
    format!(
        "[frames]\npath = \"frames/frame_####.ply\"\nnormals = \"flat\"\n\
         [media.air]\nior = 1\n[media.water]\nior = 1.33\nabsorption = {water_a:?}\nscattering = {water_s:?}\n\
         phase = {{ kind = \"henyey-greenstein\", g = 0.7 }}\n\
         [media.ice]\nior = 1.31\nabsorption = {ice_a:?}\nscattering = {ice_s:?}\n\
         [[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = [0.8, 0.6, 0.4] }}\n\
         [[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = {{ kind = \"emitter\", radiance = [3, 2.5, 2] }}\n\
         [sky]\nradiance = [0.5, 0.6, 0.7]\n\
         [sun]\ndirection = {}\nirradiance = 1\nangular_diameter = 10\n\
         [camera]\neye = {}\ntarget = {}\nup = {}\nvertical_fov = 36\nresolution = [24, 18]\n{more}",
        way(0.4, 0.2, 0.9),
        point(0.7, -4.0, 1.9),
        point(0.0, 0.0, -0.1),
        way(0.0, 0.0, 1.0),
    )
}

/// The floor and the lamp.
pub fn around(folder: &Folder, place: Place) {
    for (name, mesh) in [("floor.ply", square(3.0, -0.9, true)), ("lamp.ply", square(1.0, 3.0, false))] {
        folder.write(name, ply(&place.of_mesh(&mesh)));
    }
}

/// The scene of these bodies, ready for rays.
pub fn scene(place: Place, media: Media, bodies: &RawMesh, more: &str) -> Prepared {
    scene_with_labels([1, 2], place, media, bodies, more)
}

/// The same with other labels of water and ice.
pub fn scene_with_labels(
    labels: [i32; 2],
    place: Place,
    media: Media,
    bodies: &RawMesh,
    more: &str,
) -> Prepared {
    let [water, ice] = labels;
    let regions = format!("[regions]\n0 = \"air\"\n{water} = \"water\"\n{ice} = \"ice\"\n");
    let folder = Folder::with_scene(&(tables(place, media, more) + &regions));
    folder.frame(1, &place.of_mesh(bodies));
    around(&folder, place);
    prepare(&folder.path("scene.toml"))
}
