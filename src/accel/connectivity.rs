//! Whether the triangles of a frame are those of the frame before.
//!
//! What counts is the set of oriented triangles over the same vertex numbers, each begun at its least vertex: a file
//! may list them in another order and begin them at another corner. (One that repeats a vertex may be taken for another
//! one when it is begun elsewhere; it has no area and is not drawn.) Positions play no part, nor does what lies on
//! either side. Simulators number a new vertex like one that was deleted, so that equal numbers need not be the same
//! vertex; a hierarchy does not mind, since hits do not depend on it.
//!
//! Time is linear; it is least where triangles keep their places. Where it would not be, as among thousands of copies of
//! one triangle, the triangles count as others.

use super::TriangleId;
use crate::mesh::canonical::least_first;

/// How the triangles of a frame relate to those that a hierarchy was made for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Connectivity {
    /// They are others.
    New,
    /// They are the same at the same places, begun at the same corners.
    Same,
    /// They are the same at other places or begun at other corners: the new index of each old one.
    Reordered(Vec<TriangleId>),
}

impl Connectivity {
    /// Compares triangles with those of the frame before.
    pub fn between(old: &[[u32; 3]], new: &[[u32; 3]]) -> Self {
        if old == new {
            return Self::Same;
        }
        if old.len() != new.len() {
            return Self::New;
        }
        let is_moved = |&i: &usize| least_first(old[i]) != least_first(new[i]);
        let moved: Vec<TriangleId> = (0..old.len()).filter(is_moved).map(|i| i as TriangleId).collect();
        let Some(mut places) = Places::of(old, &moved) else { return Self::New };
        let mut new_ids: Vec<TriangleId> = (0..old.len() as TriangleId).collect();
        for to in moved {
            let Some(from) = places.take(least_first(new[to as usize])) else { return Self::New };
            new_ids[from as usize] = to;
        }
        Self::Reordered(new_ids)
    }
}

/// Where triangles are: a hash table with linear probing.
struct Places<'a> {
    triangles: &'a [[u32; 3]],
    /// Twice as many slots as triangles, at least, and a power of two of them.
    slots: Vec<TriangleId>,
    /// How many more slots may be looked at.
    looks: usize,
}

impl<'a> Places<'a> {
    const FREE: TriangleId = TriangleId::MAX;
    const TAKEN: TriangleId = TriangleId::MAX - 1;
    /// Slots that may be looked at for each triangle, on average: half full and well mixed they are about two to put one
    /// in and three to take one out.
    const MOST_LOOKS: usize = 64;

    /// Nothing when it takes too long.
    fn of(triangles: &'a [[u32; 3]], ids: &[TriangleId]) -> Option<Self> {
        let slots = vec![Self::FREE; (2 * ids.len()).next_power_of_two()];
        let looks = Self::MOST_LOOKS * ids.len();
        let mut places = Self { triangles, slots, looks };
        for &id in ids {
            let mut slot = places.first_slot(least_first(triangles[id as usize]));
            while places.slots[slot] != Self::FREE {
                slot = places.after(slot)?;
            }
            places.slots[slot] = id;
        }
        Some(places)
    }

    /// The index of a triangle that was not taken before; nothing either when it takes too long.
    fn take(&mut self, triangle: [u32; 3]) -> Option<TriangleId> {
        let mut slot = self.first_slot(triangle);
        loop {
            match self.slots[slot] {
                Self::FREE => return None,
                id if id != Self::TAKEN && least_first(self.triangles[id as usize]) == triangle => {
                    self.slots[slot] = Self::TAKEN;
                    return Some(id);
                }
                _ => slot = self.after(slot)?,
            }
        }
    }

    fn first_slot(&self, triangle: [u32; 3]) -> usize {
        const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;
        let mixed = |hash: u64, index: u32| (hash ^ u64::from(index)).wrapping_mul(FACTOR).rotate_left(29);
        triangle.into_iter().fold(FACTOR, mixed) as usize & (self.slots.len() - 1)
    }

    fn after(&mut self, slot: usize) -> Option<usize> {
        self.looks = self.looks.checked_sub(1)?;
        Some((slot + 1) & (self.slots.len() - 1))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Triangles over few vertices, so that some are there twice.
    fn triangles() -> impl Strategy<Value = Vec<[u32; 3]>> {
        let apart = prop::array::uniform3(0..6_u32).prop_map(|[a, b, c]| [a, 6 + b, 12 + c]);
        let turned = (apart, 0..3_usize).prop_map(|(mut triangle, by)| {
            triangle.rotate_left(by);
            triangle
        });
        prop::collection::vec(turned, 1..200)
    }

    proptest! {
        #[test]
        fn order_and_first_corner_do_not_matter(old in triangles(), seed in any::<u64>()) {
            let mut order: Vec<u32> = (0..old.len() as u32).collect();
            order.sort_by_key(|&i| u64::from(i + 1).wrapping_mul(seed | 1));
            let mut new = vec![[0; 3]; old.len()];
            for (i, triangle) in old.iter().enumerate() {
                let mut turned = *triangle;
                turned.rotate_left((seed >> (i % 60)) as usize % 3);
                new[order[i] as usize] = turned;
            }
            let new_ids = match Connectivity::between(&old, &new) {
                Connectivity::New => return Err(TestCaseError::fail("the same set")),
                Connectivity::Same => (0..old.len() as u32).collect(),
                Connectivity::Reordered(new_ids) => new_ids,
            };
            for (i, &id) in new_ids.iter().enumerate() {
                prop_assert_eq!(least_first(old[i]), least_first(new[id as usize]));
            }
            let mut all = new_ids;
            all.sort_unstable();
            prop_assert_eq!(all, (0..old.len() as u32).collect::<Vec<_>>(), "each place is taken once");
        }

        #[test]
        fn other_sets_are_new(old in triangles(), at in any::<prop::sample::Index>(), vertex in 18..20_u32) {
            let mut new = old.clone();
            new.reverse();
            let changed = at.index(new.len());
            new[changed][2] = vertex;
            prop_assert_eq!(Connectivity::between(&old, &new), Connectivity::New);
            new.pop();
            prop_assert_eq!(Connectivity::between(&old, &new), Connectivity::New);
        }
    }

    #[test]
    fn a_turned_triangle_is_another() {
        let old = [[0, 1, 2], [0, 2, 3]];
        assert_eq!(Connectivity::between(&old, &[[1, 2, 0], [2, 3, 0]]), Connectivity::Reordered(vec![0, 1]));
        assert_eq!(Connectivity::between(&old, &[[0, 1, 2], [0, 3, 2]]), Connectivity::New);
        assert_eq!(Connectivity::between(&old, &[[3, 0, 2], [0, 1, 2]]), Connectivity::Reordered(vec![1, 0]));
    }

    #[test]
    fn copies_without_number_take_no_time() {
        // Were they compared one by one, these would take hours.
        let (a, b) = (vec![[0, 1, 2]; 1 << 20], vec![[3, 4, 5]; 1 << 20]);
        let (old, new) = ([&*a, &*b].concat(), [&*b, &*a].concat());
        assert_eq!(Connectivity::between(&old, &new), Connectivity::New);
    }

    #[test]
    fn a_grid_in_any_order_is_recognised() {
        let n = 300;
        let corners = (0..n * n).map(|i| i / n * (n + 1) + i % n);
        let old: Vec<[u32; 3]> =
            corners.flat_map(|i| [[i, i + 1, i + n + 2], [i, i + n + 2, i + n + 1]]).collect();
        let count = old.len();
        for step in [1, 7, 601, count - 1] {
            let new: Vec<[u32; 3]> = (0..count).map(|i| old[(i * step + 5) % count]).collect();
            assert!(matches!(Connectivity::between(&old, &new), Connectivity::Reordered(_)), "step {step}");
        }
    }

    #[test]
    fn a_triangle_twice_is_not_another_twice() {
        let (a, b) = ([0, 1, 2], [3, 4, 5]);
        assert_eq!(Connectivity::between(&[a, a, b], &[a, b, b]), Connectivity::New);
        assert_eq!(Connectivity::between(&[], &[]), Connectivity::Same);
    }
}
