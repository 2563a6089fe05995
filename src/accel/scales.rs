//! Divides triangles by size: those of a scene that reaches from ripples to the horizon do not belong into one tree,
//! whose cost measure would see the ripples as a point.

use std::ops::Range;

use obvhs::aabb::Aabb;

use super::TriangleId;
use super::soup::Soup;

/// Triangles more than this many times larger than the median have a tree of their own, and so on upwards.
const SCALE_STEP: f32 = 16.0;

/// The median is that of this many triangles, or up to twice as many, at even distances.
const SAMPLES: usize = 1 << 12;

/// Triangles of like size with their boxes.
pub(super) struct Scale {
    pub ids: Vec<TriangleId>,
    pub boxes: Vec<Aabb>,
}

impl Scale {
    /// The triangles of a part in rising order of size, in at most `most` scales.
    pub fn all(soup: Soup, part: Range<usize>, most: usize) -> Vec<Self> {
        let ids: Vec<TriangleId> = (part.start as TriangleId..part.end as TriangleId).collect();
        let boxes: Vec<Aabb> = ids.iter().map(|&id| soup.aabb(id)).collect();
        let Some(limit) = limit_of_first(&boxes) else { return Vec::new() };
        // Mostly there is one.
        if boxes.iter().all(|aabb| extent(aabb) <= limit) {
            return vec![Self { ids, boxes }];
        }
        let mut scales: Vec<Self> = (0..most).map(|_| Self { ids: Vec::new(), boxes: Vec::new() }).collect();
        for (id, aabb) in ids.into_iter().zip(boxes) {
            let mut limit = limit;
            let mut scale = 0;
            while extent(&aabb) > limit && limit > 0.0 && scale + 1 < most {
                limit *= SCALE_STEP;
                scale += 1;
            }
            scales[scale].ids.push(id);
            scales[scale].boxes.push(aabb);
        }
        scales.retain(|scale| !scale.ids.is_empty());
        scales
    }
}

/// The greatest extent in the first scale; nothing without boxes.
fn limit_of_first(boxes: &[Aabb]) -> Option<f32> {
    let mut extents: Vec<f32> = boxes.iter().step_by((boxes.len() / SAMPLES).max(1)).map(extent).collect();
    let middle = extents.len() / 2;
    if extents.is_empty() {
        return None;
    }
    let median = *extents.select_nth_unstable_by(middle, f32::total_cmp).1;
    Some(median * SCALE_STEP)
}

fn extent(aabb: &Aabb) -> f32 {
    aabb.diagonal().max_element()
}
