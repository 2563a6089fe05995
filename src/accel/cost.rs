//! What a ray costs: the surface-area measure of the tree as it stands.
//!
//! ```text
//! cost = sum over boxes B of  area(B in R) / area(R)
//! ```
//! is the mean number of boxes that a random line through the region R enters `[MACDONALD90]`, nodes and leaves alike.
//! With R the whole, a sea that goes on to the horizon would hide everything: its triangles are a million times larger
//! than those in view. So R is where the triangles are: on each axis the leaves' middle half, made twice as long.

use glam::Vec3;

use super::{Accel, Child, Node};
use crate::geometry::Bounds;

impl Accel {
    /// The mean number of boxes that a line through where the triangles are enters; 0 without triangles.
    pub fn cost(&self) -> f32 {
        let region = self.busy_region();
        let area = f64::from(region.half_area());
        let part = |bounds: Bounds| f64::from(common(bounds, region).half_area()) / area;
        // A region without area: all triangles lie on one axis, and no tree is better than another.
        if area > 0.0 { self.boxes().map(|(_, bounds)| part(bounds)).sum::<f64>() as f32 } else { 0.0 }
    }

    fn boxes(&self) -> impl Iterator<Item = (Child, Bounds)> {
        self.nodes.iter().flat_map(|node| {
            let lanes = (0..Node::WIDTH).filter(|&lane| node.children[lane] != Child::NOTHING);
            lanes.map(|lane| (node.children[lane], node.bounds(lane)))
        })
    }

    /// On each axis the middle half of the leaves, twice as long, within the bounds.
    fn busy_region(&self) -> Bounds {
        let leaves = self.boxes().filter(|(child, _)| child.as_leaf().is_some());
        let mut centres: Vec<Vec3> = leaves.map(|(_, bounds)| bounds.centre()).collect();
        if centres.is_empty() {
            return Bounds::EMPTY;
        }
        let mut region = self.bounds;
        for axis in 0..3 {
            let mut quartile = |of_four: usize| {
                let place = (centres.len() - 1) * of_four / 4;
                centres.select_nth_unstable_by(place, |a, b| a[axis].total_cmp(&b[axis])).1[axis]
            };
            let (low, high) = (quartile(1), quartile(3));
            let margin = 0.5 * (high - low);
            region.min[axis] = region.min[axis].max(low - margin);
            region.max[axis] = region.max[axis].min(high + margin);
        }
        region
    }
}

fn common(a: Bounds, b: Bounds) -> Bounds {
    Bounds { min: a.min.max(b.min), max: a.max.min(b.max) }
}
