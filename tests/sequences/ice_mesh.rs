//! The mesh of `sequences/under_ice`: a sea under ice, in a box, every triangle with the labels of its two sides.

use std::collections::{HashMap, HashSet};

use super::ice_cover::{Body, Point, above, below, wave, within_ice};
use super::outlined::{Outlined, outlined};

const AIR: u8 = 0;
const SEA: u8 = 1;
const BERG: u8 = 2;
const COVER: u8 = 3;
/// Height of the bottom of the box.
const BOTTOM: f64 = -8.0;

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Layer {
    Water,
    Above,
    Below,
    Bottom,
}

struct Builder {
    level: Outlined,
    index: HashMap<(usize, Layer), u16>,
    positions: Vec<[f32; 3]>,
    /// Vertices, the label in front and that behind.
    faces: Vec<([u16; 3], [u8; 2])>,
}

impl Builder {
    /// The vertex of a layer at one of the level; on outlines the layers meet.
    fn vertex(&mut self, v: usize, layer: Layer) -> u16 {
        let ice = matches!(layer, Layer::Above | Layer::Below);
        let layer = if ice && self.level.within[v] <= 0.0 { Layer::Water } else { layer };
        *self.index.entry((v, layer)).or_insert_with(|| {
            let p: Point = self.level.at[v];
            let place = match layer {
                Layer::Water => [p[0], p[1], wave(p)],
                Layer::Above => above(p),
                Layer::Below => below(p),
                Layer::Bottom => [p[0], p[1], BOTTOM],
            };
            self.positions.push(place.map(|c| c as f32));
            u16::try_from(self.positions.len() - 1).unwrap()
        })
    }

    fn sheet(&mut self, t: [usize; 3], layer: Layer, labels: [u8; 2]) {
        let face = t.map(|v| self.vertex(v, layer));
        self.faces.push((face, labels));
    }

    /// The surface of the water, or both sides of the ice.
    fn level(&mut self) {
        for t in self.level.triangles.clone() {
            if t.iter().all(|&v| self.level.within[v] <= 0.0) {
                self.sheet(t, Layer::Water, [AIR, SEA]);
                continue;
            }
            let centroid = [0, 1].map(|k| t.iter().map(|&v| self.level.at[v][k]).sum::<f64>() / 3.0);
            let ice = if within_ice(centroid).1 == Body::Berg { BERG } else { COVER };
            self.sheet(t, Layer::Above, [AIR, ice]);
            self.sheet(t, Layer::Below, [ice, SEA]);
        }
    }

    /// Sides and bottom of the box.
    fn sides(&mut self) {
        let edges: HashSet<(usize, usize)> =
            (self.level.triangles.iter()).flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]).collect();
        let mut rim: Vec<_> = edges.iter().filter(|&&(a, b)| !edges.contains(&(b, a))).collect();
        rim.sort_unstable();
        self.positions.push([0.0, 0.0, BOTTOM as f32]);
        let centre = (self.positions.len() - 1) as u16;
        for &&(a, b) in &rim {
            let [top, below, deep] = [Layer::Above, Layer::Below, Layer::Bottom]
                .map(|layer| [self.vertex(a, layer), self.vertex(b, layer)]);
            let ice = [[top[1], top[0], below[0]], [top[1], below[0], below[1]]];
            let sea =
                [[below[1], below[0], deep[0]], [below[1], deep[0], deep[1]], [deep[1], deep[0], centre]];
            self.faces.extend(ice.map(|t| (t, [AIR, COVER])));
            self.faces.extend(sea.map(|t| (t, [AIR, SEA])));
        }
    }

    fn ply(&self) -> Vec<u8> {
        let mut out = format!(
            "ply\nformat binary_little_endian 1.0\n\
             comment an iceberg in a cover of ice, metres: air 0, sea 1, iceberg 2, cover 3\n\
             element vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
             element face {}\nproperty list uchar ushort vertex_indices\n\
             property uchar label_front\nproperty uchar label_back\nend_header\n",
            self.positions.len(),
            self.faces.len()
        )
        .into_bytes();
        out.extend(self.positions.iter().flatten().flat_map(|c| c.to_le_bytes()));
        for (triangle, labels) in &self.faces {
            out.push(3);
            out.extend(triangle.iter().flat_map(|v| v.to_le_bytes()));
            out.extend(labels);
        }
        out
    }
}

/// The mesh as a binary PLY file.
pub fn ice_mesh() -> Vec<u8> {
    let mut builder =
        Builder { level: outlined(), index: HashMap::new(), positions: Vec::new(), faces: Vec::new() };
    builder.level();
    builder.sides();
    builder.ply()
}
