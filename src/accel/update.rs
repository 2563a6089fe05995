//! From the hierarchy of one frame to that of the next: refitted where the triangles are the same, else built.
//!
//! Refitting keeps the tree and moves its boxes, which overlap more and more as the surface moves on. How much slower
//! rays become is told by the cost ([`Accel::cost`]) relative to that of the tree as it was built; above
//! [`REBUILD_ABOVE`] it is built anew. Hits depend on neither.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::leaf::Leaf;
use super::{Accel, Connectivity, TriangleId};

/// A tree that costs this many times what it did when it was built is built again.
///
/// What rays lose to a tree that was refitted rather than built, on a sheet of 200 thousand triangles (the mean of
/// camera, secondary and shadow rays):
///
/// | cost ratio | twisted | sheared | churned |
/// |---|---|---|---|
/// | 1.02 | | 1 % | 0 % |
/// | 1.04 to 1.07 | | 2 % | 2 % |
/// | 1.11 | 4 % | 5 % | |
/// | 1.17 to 1.25 | 10 % | 8 % | 7 % |
/// | 1.29 to 1.32 | 13 % | 11 % | |
/// | 1.5 | | | 12 % |
/// | 1.8 to 1.9 | 21 % | | 18 % |
///
/// A build takes as long as a few hundred thousand rays on the same thread, and a frame traces ten million or more: it
/// pays as soon as a few percent are lost for certain.
pub const REBUILD_ABOVE: f32 = 1.1;

/// What became of the hierarchy of the frame before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Hierarchy {
    /// There was none, or its triangles were others.
    Built,
    /// Its triangles were the same and it still fits.
    Refitted,
    /// Its triangles were the same but it had become too costly.
    Rebuilt,
}

impl Hierarchy {
    /// One word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Built => "built",
            Self::Refitted => "refitted",
            Self::Rebuilt => "rebuilt",
        }
    }
}

/// What [`Accel::update`] did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Update {
    /// What became of the hierarchy.
    pub hierarchy: Hierarchy,
    /// Its cost after refitting, relative to that when it was built; `None` when nothing was refitted.
    pub cost_ratio: Option<f32>,
}

impl Accel {
    /// Makes the hierarchy that of other positions and, unless the connectivity is the same, other triangles.
    ///
    /// The first `still` triangles never change, neither their indices nor their positions.
    pub fn update(
        &mut self,
        positions: &[Vec3],
        triangles: &[[u32; 3]],
        still: usize,
        connectivity: &Connectivity,
    ) -> Update {
        if *connectivity == Connectivity::New {
            self.rebuild(positions, triangles, still);
            return Update { hierarchy: Hierarchy::Built, cost_ratio: None };
        }
        let built = self.built_cost.unwrap_or_else(|| self.cost());
        self.built_cost = Some(built);
        match connectivity {
            Connectivity::Reordered(new_ids) => self.renumber(new_ids, positions, triangles),
            _ => self.refit(positions, triangles),
        }
        let cost = self.cost();
        // What was built over a single line or point cost nothing and is worth nothing once there is more.
        let cost_ratio = if cost > 0.0 { cost / built } else { 1.0 };
        let hierarchy = if cost_ratio > REBUILD_ABOVE {
            self.rebuild(positions, triangles, still);
            Hierarchy::Rebuilt
        } else {
            Hierarchy::Refitted
        };
        Update { hierarchy, cost_ratio: Some(cost_ratio) }
    }

    /// Becomes a copy of another hierarchy in the memory that this one has.
    pub fn copy_from(&mut self, other: &Self) {
        let Self { nodes, leaves, ids, bounds, triangles, built_cost, still, motion: _ } = other;
        self.motion = None;
        self.nodes.clone_from(nodes);
        self.leaves.clone_from(leaves);
        self.ids.clone_from(ids);
        (self.bounds, self.triangles, self.built_cost) = (*bounds, *triangles, *built_cost);
        self.still.clone_from(still);
        self.settle_memory();
    }

    /// Refits with other indices: `new_ids` has the new one of each old one. `triangles` are the new ones, which may
    /// begin at other corners.
    fn renumber(&mut self, new_ids: &[TriangleId], positions: &[Vec3], triangles: &[[u32; 3]]) {
        self.motion = None;
        let first = self.still.leaves;
        for (leaf, ids) in self.leaves.iter_mut().zip(&mut self.ids).skip(first) {
            let ids = &mut ids[..leaf.len()];
            ids.iter_mut().for_each(|id| *id = new_ids[*id as usize]);
            // The same triangles have the same vertices, as many as before.
            if let Some(renewed) = Leaf::over(ids, positions, triangles) {
                *leaf = renewed;
            }
        }
        self.refit_nodes();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::Ignored;
    use crate::geometry::Ray;

    /// A sheet of n x n squares in the plane z = 0, lifted by a function of its points.
    fn sheet(n: u32, z: impl Fn(f32, f32) -> f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let row = n + 1;
        let at = |i: u32| Vec3::new((i % row) as f32, (i / row) as f32, 0.0);
        let positions = (0..row * row).map(at).map(|p| p.with_z(z(p.x, p.y))).collect();
        let corners = (0..n * n).map(|i| i / n * row + i % n);
        let triangles = corners.flat_map(|i| [[i, i + 1, i + row + 1], [i, i + row + 1, i + row]]).collect();
        (positions, triangles)
    }

    fn assert_alike(a: &Accel, b: &Accel) {
        for i in 0..400_u32 {
            let origin = Vec3::new((i % 20) as f32 + 0.37, (i / 20) as f32 + 0.21, 30.0);
            let ray = Ray::new(origin, Vec3::new(0.01, 0.02, -1.0).normalize());
            assert_eq!(a.closest(&ray, Ignored::NOTHING), b.closest(&ray, Ignored::NOTHING));
        }
    }

    #[test]
    fn a_wave_is_refitted_and_a_shuffle_rebuilt() {
        let (flat, triangles) = sheet(20, |_, _| 0.0);
        let mut accel = Accel::build_over(&flat, &triangles, 0);
        let (wave, _) = sheet(20, |x, y| 0.05 * (x + 0.5 * y).sin());
        let update = accel.update(&wave, &triangles, 0, &Connectivity::Same);
        assert_eq!(update.hierarchy, Hierarchy::Refitted);
        assert!((0.9..REBUILD_ABOVE).contains(&update.cost_ratio.unwrap()), "{update:?}");
        accel.validate(&wave, &triangles).unwrap();
        assert_alike(&accel, &Accel::build(&wave, &triangles));
        // Every vertex goes where another was: neighbours in the tree are none any more.
        let shuffled: Vec<Vec3> = (0..wave.len()).map(|i| wave[i * 200 % wave.len()]).collect();
        let update = accel.update(&shuffled, &triangles, 0, &Connectivity::Same);
        assert_eq!(update.hierarchy, Hierarchy::Rebuilt);
        assert!(update.cost_ratio.unwrap() > 2.0, "{update:?}");
        accel.validate(&shuffled, &triangles).unwrap();
        // From here the cost is relative to the new tree.
        let update = accel.update(&shuffled, &triangles, 0, &Connectivity::Same);
        assert_eq!((update.hierarchy, update.cost_ratio), (Hierarchy::Refitted, Some(1.0)));
    }

    #[test]
    fn what_was_a_line_is_built_again_when_it_is_a_sheet() {
        let (sheet, triangles) = sheet(20, |_, _| 0.0);
        let line: Vec<Vec3> = sheet.iter().map(|p| Vec3::X * p.y).collect();
        let mut accel = Accel::build(&line, &triangles);
        let mut hierarchy =
            |positions: &[Vec3]| accel.update(positions, &triangles, 0, &Connectivity::Same).hierarchy;
        assert_eq!(hierarchy(&line), Hierarchy::Refitted);
        assert_eq!((hierarchy(&sheet), hierarchy(&sheet)), (Hierarchy::Rebuilt, Hierarchy::Refitted));
    }

    #[test]
    fn a_sea_to_the_horizon_hides_no_decay() {
        let (mut positions, mut triangles) = sheet(20, |_, _| 0.0);
        let count = positions.len();
        let corner = |i: u32| count as u32 + i;
        positions
            .extend([(-1e5, -1e5), (1e5, -1e5), (1e5, 1e5), (-1e5, 1e5)].map(|(x, y)| Vec3::new(x, y, -1.0)));
        triangles.extend([[corner(0), corner(1), corner(2)], [corner(0), corner(2), corner(3)]]);
        let mut accel = Accel::build_over(&positions, &triangles, 0);
        let mut shuffled = positions.clone();
        (0..count).for_each(|i| shuffled[i] = positions[i * 200 % count]);
        let update = accel.update(&shuffled, &triangles, 0, &Connectivity::Same);
        assert_eq!(update.hierarchy, Hierarchy::Rebuilt, "{update:?}");
    }

    #[test]
    fn slow_decay_adds_up_over_frames() {
        let (flat, triangles) = sheet(20, |_, _| 0.0);
        let mut accel = Accel::build_over(&flat, &triangles, 0);
        let sheared = |k: f32| flat.iter().map(|p| *p + Vec3::Z * k * ((p.x * 37.0).sin() + p.y)).collect();
        let decisions: Vec<Hierarchy> = (1..40)
            .map(|k| {
                let positions: Vec<Vec3> = sheared(0.1 * k as f32);
                accel.update(&positions, &triangles, 0, &Connectivity::Same).hierarchy
            })
            .collect();
        assert_eq!(decisions[0], Hierarchy::Refitted, "a step costs little");
        assert!(decisions.contains(&Hierarchy::Rebuilt), "many do not: {decisions:?}");
    }

    #[test]
    fn another_order_has_its_own_indices() {
        let (positions, triangles) = sheet(20, |x, y| 0.3 * (x * y).cos());
        let mut turned: Vec<[u32; 3]> = triangles.iter().rev().map(|&[a, b, c]| [b, c, a]).collect();
        turned.swap(3, 700);
        let mut accel = Accel::build_over(&positions, &triangles, 0);
        let connectivity = Connectivity::between(&triangles, &turned);
        let update = accel.update(&positions, &turned, 0, &connectivity);
        assert_eq!((update.hierarchy, update.cost_ratio), (Hierarchy::Refitted, Some(1.0)));
        accel.validate(&positions, &turned).unwrap();
        assert_alike(&accel, &Accel::build(&positions, &turned));
    }

    #[test]
    fn a_copy_is_the_same_tree_and_nothing_at_all_is_no_matter() {
        let (positions, triangles) = sheet(8, |_, _| 0.0);
        let source = Accel::build_over(&positions, &triangles, 0);
        let mut copy = Accel::build_over(&positions[..4], &[[0, 1, 2]], 0);
        copy.copy_from(&source);
        copy.validate(&positions, &triangles).unwrap();
        assert_eq!(copy.cost(), source.cost());
        let mut empty = Accel::default();
        let update = empty.update(&[], &[], 0, &Connectivity::Same);
        assert_eq!((update.hierarchy, update.cost_ratio), (Hierarchy::Refitted, Some(1.0)));
        assert_eq!(empty.update(&positions, &triangles, 0, &Connectivity::New).hierarchy, Hierarchy::Built);
        empty.validate(&positions, &triangles).unwrap();
    }

    #[test]
    fn still_triangles_keep_their_part_of_the_tree() {
        let (mut positions, mut triangles) = sheet(12, |_, _| -3.0);
        let (still, first) = (triangles.len(), positions.len() as u32);
        // A floor of another scale, too.
        positions.extend([(-1e4, -1e4), (1e4, -1e4), (0.0, 1e4)].map(|(x, y)| Vec3::new(x, y, -5.0)));
        triangles.push([first, first + 1, first + 2]);
        let still = still + 1;
        let with_waves = |n: u32, k: f32| {
            let (wave, moving) = sheet(n, |x, y| (k * (x + y)).sin());
            let (mut positions, mut triangles) = (positions.clone(), triangles.clone());
            let offset = positions.len() as u32;
            positions.extend(wave);
            triangles.extend(moving.into_iter().map(|t| t.map(|i| i + offset)));
            (positions, triangles)
        };
        let (positions, triangles) = with_waves(20, 0.5);
        let mut accel = Accel::build_over(&positions, &triangles, still);
        accel.validate(&positions, &triangles).unwrap();
        assert_alike(&accel, &Accel::build(&positions, &triangles));
        let part = |accel: &Accel| {
            let (nodes, leaves) = (accel.still.nodes, accel.still.leaves);
            assert!(nodes > 1 && leaves > 0);
            // Their text is that of every byte that counts.
            format!("{:?}", (&accel.nodes[1..nodes], &accel.leaves[..leaves], &accel.ids[..leaves]))
        };
        let before = part(&accel);
        for (n, k) in [(20, 0.6), (9, 0.4), (30, 0.2), (0, 0.0)] {
            let (positions, triangles) = with_waves(n, k);
            let mut copy = Accel::default();
            copy.copy_from(&accel);
            let connectivity = if n == 20 { Connectivity::Same } else { Connectivity::New };
            copy.update(&positions, &triangles, still, &connectivity);
            copy.validate(&positions, &triangles).unwrap();
            assert_eq!(part(&copy), before);
            assert_alike(&copy, &Accel::build(&positions, &triangles));
            accel = copy;
        }
    }

    #[test]
    fn a_rebuilt_tree_is_that_of_a_new_one() {
        let (flat, triangles) = sheet(20, |_, _| 0.0);
        let (wave, _) = sheet(20, |x, y| (x * 0.7).sin() * y);
        for still in [0, 100, triangles.len()] {
            let mut positions = wave.clone();
            for corner in triangles[..still].iter().flatten() {
                positions[*corner as usize] = flat[*corner as usize];
            }
            let mut accel = Accel::build_over(&flat, &triangles, still);
            accel.rebuild(&positions, &triangles, still);
            let new = Accel::build_over(&positions, &triangles, still);
            assert_eq!(format!("{accel:?}"), format!("{new:?}"));
        }
    }
}
