//! Gathers neighbouring triangles into leaves before there is a tree.
//!
//! As in locally ordered clustering `[MEISTER18]`, what is sorted along a space-filling curve is merged in passes: each
//! cluster looks for the neighbour with which it would have the least box, and two that choose each other become one.
//! Only those are neighbours that fit into one leaf together. The tree over the clusters is four times smaller than one
//! over triangles, and as much faster to make. Time is that of sorting.

use obvhs::aabb::Aabb;

use super::TriangleId;
use super::leaf::Leaf;
use super::scales::Scale;
use super::soup::Soup;

/// How many clusters on either side are looked at; 4 and 8 took longer and made no faster tree.
const REACH: usize = 2;

/// Two clusters merge when the area of their common box is at most this many times the sum of theirs. Between 1.5 and 4
/// the speed of rays differed by less than could be measured; the more merge, the less memory.
const MERGE_BELOW: f32 = 4.0;

/// Passes end when one merges fewer than one cluster in this many.
const WORTH_A_PASS: usize = 50;

/// Triangles of a leaf to be.
#[derive(Clone, Copy)]
pub(super) struct Cluster {
    aabb: Aabb,
    area: f32,
    vertex_count: u8,
    triangle_count: u8,
    /// Each vertex once; the rest repeats the first.
    vertices: [u32; Leaf::MOST],
    ids: [TriangleId; Leaf::MOST],
}

/// The partner that a cluster would like best.
#[derive(Clone, Copy)]
struct Choice {
    area: f32,
    partner: usize,
}

impl Cluster {
    fn of_triangle(corners: [u32; 3], id: TriangleId, aabb: Aabb) -> Self {
        let mut cluster = Self {
            aabb,
            area: aabb.half_area(),
            vertex_count: 1,
            triangle_count: 1,
            vertices: [corners[0]; Leaf::MOST],
            ids: [id; Leaf::MOST],
        };
        cluster.add(&corners);
        cluster
    }

    /// Adds those vertices that are not there yet; there must be places for them.
    fn add(&mut self, vertices: &[u32]) {
        for vertex in vertices {
            if !self.vertices.contains(vertex) {
                self.vertices[usize::from(self.vertex_count)] = *vertex;
                self.vertex_count += 1;
            }
        }
    }

    fn own_vertices(&self) -> &[u32] {
        &self.vertices[..usize::from(self.vertex_count)]
    }

    fn fits_with(&self, other: &Self) -> bool {
        let new = other.own_vertices().iter().filter(|&v| !self.vertices.contains(v)).count();
        usize::from(self.triangle_count + other.triangle_count) <= Leaf::MOST
            && usize::from(self.vertex_count) + new <= Leaf::MOST
    }

    fn merge(&mut self, other: &Self) {
        self.aabb = self.aabb.union(&other.aabb);
        self.area = self.aabb.half_area();
        self.add(other.own_vertices());
        let first = usize::from(self.triangle_count);
        self.ids[first..][..other.ids().len()].copy_from_slice(other.ids());
        self.triangle_count += other.triangle_count;
    }

    /// Its triangles.
    pub fn ids(&self) -> &[TriangleId] {
        &self.ids[..usize::from(self.triangle_count)]
    }

    /// The box around them.
    pub fn aabb(&self) -> Aabb {
        self.aabb
    }
}

impl Choice {
    const NOBODY: Self = Self { area: f32::INFINITY, partner: usize::MAX };

    /// Of equal areas, as in a regular grid, those count whose indices differ in the last bit only: else in a row
    /// everyone would choose the next one and nobody would be chosen back.
    fn is_worse_than(self, area: f32, mine: usize, partner: usize) -> bool {
        area < self.area || (area == self.area && mine ^ 1 == partner)
    }
}

/// The clusters of a scale's triangles.
pub(super) fn clusters(soup: Soup, scale: &Scale) -> Vec<Cluster> {
    let of_index = |i: usize| {
        let id = scale.ids[i];
        Cluster::of_triangle(soup.triangles[id as usize], id, scale.boxes[i])
    };
    let mut clusters: Vec<Cluster> =
        along_curve(&scale.boxes).into_iter().map(|(_, i)| of_index(i as usize)).collect();
    loop {
        let before = clusters.len();
        let choices = choose(&clusters);
        merge_mutual(&mut clusters, &choices);
        if (before - clusters.len()) * WORTH_A_PASS < before {
            return clusters;
        }
    }
}

fn choose(clusters: &[Cluster]) -> Vec<Choice> {
    let mut choices = vec![Choice::NOBODY; clusters.len()];
    for (i, mine) in clusters.iter().enumerate() {
        for (j, other) in clusters.iter().enumerate().skip(i + 1).take(REACH) {
            let area = mine.aabb.union(&other.aabb).half_area();
            let (better_for_mine, better_for_other) =
                (choices[i].is_worse_than(area, i, j), choices[j].is_worse_than(area, j, i));
            let wanted =
                (better_for_mine || better_for_other) && area <= MERGE_BELOW * (mine.area + other.area);
            if wanted && mine.fits_with(other) {
                if better_for_mine {
                    choices[i] = Choice { area, partner: j };
                }
                if better_for_other {
                    choices[j] = Choice { area, partner: i };
                }
            }
        }
    }
    choices
}

/// Merges those that choose each other, in the place of the first.
fn merge_mutual(clusters: &mut Vec<Cluster>, choices: &[Choice]) {
    let mut kept = 0;
    for i in 0..clusters.len() {
        let partner = choices[i].partner;
        let mutual = choices.get(partner).is_some_and(|choice| choice.partner == i);
        if mutual && partner < i {
            continue;
        }
        let mut cluster = clusters[i];
        if mutual {
            cluster.merge(&clusters[partner]);
        }
        clusters[kept] = cluster;
        kept += 1;
    }
    clusters.truncate(kept);
}

/// Morton codes and indices of the boxes, in rising order.
fn along_curve(boxes: &[Aabb]) -> Vec<(u64, u32)> {
    const CELLS: f32 = (1 << 20) as f32;
    let around = boxes.iter().fold(Aabb::INVALID, |all, aabb| all.union(aabb));
    let scale = CELLS / around.diagonal().max_element().max(f32::MIN_POSITIVE);
    let code = |aabb: &Aabb| {
        let [x, y, z] = ((aabb.center() - around.min) * scale).to_array().map(|x| spread(x as u32));
        x | y << 1 | z << 2
    };
    let mut order: Vec<(u64, u32)> = boxes.iter().zip(0..).map(|(aabb, i)| (code(aabb), i)).collect();
    order.sort_unstable();
    order
}

/// Two zeros between each two of the lowest 21 bits.
fn spread(x: u32) -> u64 {
    let x = u64::from(x & 0x1f_ffff);
    let x = (x | x << 32) & 0x001f_0000_0000_ffff;
    let x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    let x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    let x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn bits_are_spread() {
        for bit in 0..21 {
            assert_eq!(spread(1 << bit), 1 << (3 * bit));
        }
        assert_eq!(spread(0x1f_ffff), 0x1249_2492_4924_9249);
    }

    /// Where all boxes are alike, too, clusters become about as large as leaves allow: two squares share an edge.
    #[test]
    fn a_regular_grid_has_full_clusters() {
        let n = 64;
        let at = |i: u32| Vec3::new((i % (n + 1)) as f32, (i / (n + 1)) as f32, 0.0);
        let positions: Vec<Vec3> = (0..(n + 1) * (n + 1)).map(at).collect();
        let corners = (0..n * n).map(|i| i / n * (n + 1) + i % n);
        let triangles: Vec<[u32; 3]> =
            corners.flat_map(|i| [[i, i + 1, i + n + 2], [i, i + n + 2, i + n + 1]]).collect();
        let soup = Soup { positions: &positions, triangles: &triangles };
        let scales = Scale::all(soup, 0..triangles.len(), 1);
        let clusters = clusters(soup, &scales[0]);
        let mut ids: Vec<TriangleId> = clusters.iter().flat_map(|c| c.ids().to_vec()).collect();
        ids.sort_unstable();
        assert_eq!(ids, (0..triangles.len() as u32).collect::<Vec<_>>(), "each triangle is in one cluster");
        let mean = triangles.len() as f32 / clusters.len() as f32;
        assert!(mean > 3.5, "{mean} triangles a cluster");
    }
}
