//! The efficiencies of many spheres at once, each to the same bits as alone.
//!
//! Spheres of like size go side by side, as many as wide registers hold twice over: while one half waits for a division
//! the other goes on. Groups are spread over the threads, the longest first.

use rayon::prelude::*;

use super::coefficients::SideBySide;
use super::efficiencies::Sums;
use super::sphere::magnitude;
use super::{Coefficients, Efficiencies, Sphere};
use crate::geometry::machine::{Work, in_wide_registers};

/// Spheres side by side.
pub(super) const LANES: usize = 16;

/// Terms beyond which spheres go alone: many would not have the memory near the processor.
pub(super) const LONGEST: usize = 20_000;

/// Efficiencies of spheres, in their order.
pub fn efficiencies(spheres: &[Sphere]) -> Vec<Efficiencies> {
    let order = from_the_largest(spheres);
    let groups: Vec<Vec<Efficiencies>> = order
        .par_chunks(LANES)
        .map_init(SideBySide::default, |memory, group| of_group(spheres, group, memory))
        .collect();
    let mut found: Vec<(usize, Efficiencies)> = order.into_iter().zip(groups.into_iter().flatten()).collect();
    found.sort_unstable_by_key(|(place, _)| *place);
    found.into_iter().map(|(_, efficiencies)| efficiencies).collect()
}

/// Places of the spheres, those of the largest first.
pub(super) fn from_the_largest(spheres: &[Sphere]) -> Vec<usize> {
    let sizes: Vec<f64> = spheres.iter().map(|s| magnitude(s.x())).collect();
    let mut order: Vec<usize> = (0..spheres.len()).collect();
    order.sort_by(|&i, &j| sizes[j].total_cmp(&sizes[i]));
    order
}

fn of_group(spheres: &[Sphere], places: &[usize], memory: &mut SideBySide<LANES>) -> Vec<Efficiencies> {
    if spheres[places[0]].number_of_terms() > LONGEST {
        return places.iter().map(|&i| Coefficients::new(spheres[i]).efficiencies()).collect();
    }
    let group = filled(spheres, places);
    let sums = in_wide_registers(Summing { group: &group, memory });
    group.iter().take(places.len()).enumerate().map(|(lane, s)| sums.efficiencies(lane, s)).collect()
}

/// A sphere in every lane: the last of few fills the lanes that are left.
pub(super) fn filled(spheres: &[Sphere], places: &[usize]) -> [Sphere; LANES] {
    std::array::from_fn(|lane| spheres[places[lane.min(places.len() - 1)]])
}

/// Coefficients of a group, which stay in the memory, and their sums.
pub(super) struct Summing<'a> {
    pub group: &'a [Sphere; LANES],
    pub memory: &'a mut SideBySide<LANES>,
}

impl Work for Summing<'_> {
    type Output = Sums<LANES>;

    #[inline(always)]
    fn run(self) -> Sums<LANES> {
        self.memory.compute(self.group);
        let mut sums = Sums::new();
        for (i, terms) in self.memory.terms.iter().enumerate() {
            sums.add(i as f64 + 1.0, terms);
        }
        sums
    }
}
