//! A run of rays through floe's hierarchy.

use std::hint::black_box;
use std::ops::Range;

use floe::accel::{Accel, Ignored};

use super::rays::{Query, RaySet};

/// Traces some rays of a set; the number of those that hit.
pub fn trace(accel: &Accel, set: &RaySet, range: Range<usize>) -> usize {
    let rays = set.rays[range].iter();
    match set.query {
        Query::Closest => {
            rays.filter(|ray| black_box(accel.closest(ray, Ignored::NOTHING)).is_some()).count()
        }
        Query::Occluded => rays.filter(|ray| black_box(accel.occluded(ray, Ignored::NOTHING))).count(),
    }
}
