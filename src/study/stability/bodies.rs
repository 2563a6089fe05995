//! Meshes with labels, and what may be done to them without changing what they show.

use glam::{DQuat, DVec3, EulerRot};

use super::picture::Picture;
use super::shapes::Shape;
use super::{Measurement, Reference};
use crate::mesh::{Interface, RawMesh, Region, weld};

/// Makes a mesh.
pub(super) type Make = fn() -> RawMesh;

/// A box of squares between these shares of its edges, normals outwards.
pub(super) fn gridded(min: DVec3, max: DVec3, shares: &[f64]) -> Shape {
    let at = |q: DVec3| min * (1.0 - q) + max * q;
    let count = shares.len() as u32;
    let mut mesh = RawMesh::default();
    for (axis, side) in (0..3).flat_map(|axis| [(axis, 0.0), (axis, 1.0)]) {
        let first = mesh.positions.len() as u32;
        let point = |u: f64, v: f64| {
            let mut q = DVec3::ZERO;
            (q[axis], q[(axis + 1) % 3], q[(axis + 2) % 3]) = (side, u, v);
            at(q)
        };
        mesh.positions.extend(shares.iter().flat_map(|&u| shares.iter().map(move |&v| point(u, v))));
        for (i, j) in (1..count).flat_map(|i| (1..count).map(move |j| (i, j))) {
            let [a, b, c, d] = [[1, 1], [0, 1], [0, 0], [1, 0]].map(|[k, l]| first + (i - k) * count + j - l);
            let quad = if side == 1.0 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] };
            mesh.triangles.extend(quad);
        }
    }
    weld(&mut mesh);
    Shape { positions: mesh.positions, triangles: mesh.triangles }
}

/// The triangles of all.
pub(super) fn joined(meshes: impl IntoIterator<Item = RawMesh>) -> RawMesh {
    let mut all = RawMesh::default();
    for mesh in meshes {
        let first = all.positions.len() as u32;
        all.positions.extend(&mesh.positions);
        all.triangles.extend(mesh.triangles.iter().map(|t| t.map(|v| v + first)));
        if let Some(interfaces) = mesh.interfaces {
            all.interfaces.get_or_insert_default().extend(interfaces);
        }
    }
    all
}

impl Shape {
    /// With these labels on every triangle.
    pub(super) fn labelled(self, front: i32, back: i32) -> RawMesh {
        let interface = Interface { front: Region(front), back: Region(back) };
        let interfaces = Some(vec![interface; self.triangles.len()]);
        RawMesh { interfaces, ..self.unlabelled() }
    }

    /// Without labels.
    pub(super) fn unlabelled(self) -> RawMesh {
        RawMesh { positions: self.positions, triangles: self.triangles, ..RawMesh::default() }
    }

    /// Off the axes, so that rounding has its say.
    pub(super) fn askew(mut self) -> Self {
        let turn = DQuat::from_euler(EulerRot::XYZ, 0.02, -0.03, 0.4);
        self.positions.iter_mut().for_each(|p| *p = turn * *p);
        self
    }
}

/// `[frames]` with the labels 0 air, 1 water and 2 ice, as flat faces.
pub(super) const LABELS: &str = "[frames]\npath = \"frame_####.ply\"\nnormals = \"flat\"\n\
                                 [regions]\n0 = \"air\"\n1 = \"water\"\n2 = \"ice\"\n[media.air]\nior = 1\n";

/// Water and ice that lose no light, clear and turbid.
pub(super) const LOSSLESS: [(&str, &str); 2] = [
    ("clear", "[media.water]\nior = 1.33\n[media.ice]\nior = 1.31\n"),
    (
        "turbid",
        "[media.water]\nior = 1.33\nscattering = 2\nphase = { kind = \"henyey-greenstein\", g = 0.6 }\n\
         [media.ice]\nior = 1.31\nscattering = 10\n",
    ),
];

/// White surroundings, seen past what stands between -1 and 1.
pub(super) const WHITE: &str = "[sky]\nradiance = 1\n[camera]\neye = [1.2, -3.5, 0.8]\ntarget = [0, 0, 0]\n\
                                vertical_fov = 38\nresolution = [16, 16]\n[render]\nsamples = 16\n";

/// What is in white surroundings and loses no light is not seen in any pixel.
///
/// Each interaction multiplies the throughput by a weight of relative error 2^-24 or so, of either sign: a hundred of
/// them in the mean are off by some 1e-6, and no path of these scenes has more than a few hundred.
pub(super) fn furnace(picture: &Picture) -> Measurement {
    Measurement::new(Reference::ClosedForm, 1.0, picture.farthest(1.0)).of(picture).tolerance(2e-5)
}

/// Blocks of a picture in a row and in a column.
const BLOCKS: [u32; 2] = [4, 3];

/// Two pictures that ought to be the same but for noise and the rounding of f32, 1e-6 of the mean of a block for which
/// no pixel is noisy.
pub(super) fn alike(expected: &Picture, got: &Picture) -> Measurement {
    let size = [expected.image.width / BLOCKS[0], expected.image.height / BLOCKS[1]];
    let corners = (0..BLOCKS[1]).flat_map(|j| (0..BLOCKS[0]).map(move |i| [i * size[0], j * size[1]]));
    let of_block = |corner| {
        let [(a, a_se), (b, b_se)] = [expected, got].map(|picture| picture.block_mean(corner, size));
        let channels = (0..3).map(move |k| {
            let error = libm::hypot(a_se[k], b_se[k]);
            Measurement::new(Reference::Invariance, a[k], b[k]).standard_error(error).tolerance(1e-6 * a[k])
        });
        channels.collect::<Vec<_>>()
    };
    Measurement::worst(corners.flat_map(of_block)).of(got)
}

/// Whether one of the warnings says this: 1 or 0.
pub(super) fn told(warnings: &[String], text: &str, expected: bool) -> Measurement {
    let found = warnings.iter().find(|warning| warning.contains(text));
    let measured = Measurement::new(
        Reference::ClosedForm,
        f64::from(u8::from(expected)),
        f64::from(u8::from(found.is_some())),
    );
    measured.note(found.cloned().unwrap_or_else(|| warnings.join("; ")))
}
