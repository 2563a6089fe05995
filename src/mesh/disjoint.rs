//! Disjoint sets over the numbers 0, 1, 2, ..., merged one pair at a time.

/// A partition of `0..len` that only ever gets coarser; the least member stands for its set.
///
/// The representative depends on the partition alone and not on the order of the merges.
#[derive(Clone, Debug)]
pub struct DisjointSets {
    parents: Vec<u32>,
}

impl DisjointSets {
    /// Every number below `len` in a set of its own.
    pub fn new(len: u32) -> Self {
        Self { parents: (0..len).collect() }
    }

    /// The least member of the set that holds `member`.
    pub fn find(&mut self, member: u32) -> u32 {
        let mut at = member as usize;
        while self.parents[at] as usize != at {
            // Path halving: every second node on the way is hung one step higher.
            let above = self.parents[self.parents[at] as usize];
            self.parents[at] = above;
            at = above as usize;
        }
        at as u32
    }

    /// Makes one set of the sets that hold `a` and `b`.
    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.parents[a.max(b) as usize] = a.min(b);
    }

    /// The number of each member's set, 0, 1, 2, ... in order of their least members, and how many sets there are.
    pub fn into_numbers(mut self) -> (Vec<u32>, usize) {
        let mut count = 0;
        for member in 0..self.parents.len() {
            // A parent is less than its member, and so numbered already.
            let parent = self.parents[member] as usize;
            self.parents[member] = if parent == member { count } else { self.parents[parent] };
            count += u32::from(parent == member);
        }
        (self.parents, count as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_member_stands_for_its_set_whatever_the_order() {
        let pairs = [(7, 3), (1, 2), (3, 9), (2, 7)];
        for order in [[0, 1, 2, 3], [3, 2, 1, 0], [2, 0, 3, 1]] {
            let mut sets = DisjointSets::new(10);
            for i in order {
                sets.join(pairs[i].0, pairs[i].1);
            }
            let found: Vec<u32> = (0..10).map(|member| sets.find(member)).collect();
            assert_eq!(found, [0, 1, 1, 1, 4, 5, 6, 1, 8, 1]);
            assert_eq!(sets.into_numbers(), (vec![0, 1, 1, 1, 2, 3, 4, 1, 5, 1], 6));
        }
    }
}
