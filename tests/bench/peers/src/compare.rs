//! The rows of rays: the same rays through both, in turns.

use std::hint::black_box;
use std::ops::Range;

use floe::accel::{Accel, Ignored};

use crate::embree::{RayHit, Scene};
use crate::rays::{Query, RaySet};
use crate::timing::{in_turns, median};
use crate::{ratio, tracing};

/// The distances of rays that hit both ways may differ by this fraction.
const SAME: f32 = 1e-4;

/// Embree's trees over one mesh.
pub struct Scenes {
    /// Built with `RTC_SCENE_FLAG_ROBUST`.
    pub robust: Scene,
    /// Built without.
    pub fast: Scene,
}

/// Times one set of rays; the cells of its row.
pub fn row(accel: &Accel, scenes: Option<&Scenes>, set: &RaySet, passes: usize) -> String {
    let count = set.rays.len();
    let rate = |seconds: &[f64]| 1e-6 * count as f64 / median(seconds);
    let hits = 100.0 * tracing::trace(accel, set, 0..count) as f64 / count as f64;
    let mut ours = |range| tracing::trace(accel, set, range);
    let Some(scenes) = scenes else {
        let seconds = in_turns(count, passes, &mut [&mut ours]);
        return format!("| - | - | {:.2} | - | {hits:.0} % | - | - |", rate(&seconds[0]));
    };
    let templates: Vec<RayHit> = set.rays.iter().map(RayHit::new).collect();
    let (hit_or_miss, distance) = disagreement(accel, &scenes.robust, set, &templates);
    let mut robust = |range| trace(&scenes.robust, set.query, &templates, range);
    let mut fast = |range| trace(&scenes.fast, set.query, &templates, range);
    let seconds = in_turns(count, passes, &mut [&mut robust, &mut fast, &mut ours]);
    let share = |rays: usize| format!("{:.1e}", rays as f64 / count as f64);
    format!(
        "| {:.2} | {:.2} | {:.2} | {} | {hits:.0} % | {} | {} |",
        rate(&seconds[0]),
        rate(&seconds[1]),
        rate(&seconds[2]),
        ratio(&seconds[0], &seconds[2]),
        share(hit_or_miss),
        share(distance)
    )
}

/// Embree's counterpart of [`tracing::trace`].
fn trace(scene: &Scene, query: Query, templates: &[RayHit], range: Range<usize>) -> usize {
    let rays = templates[range].iter();
    match query {
        Query::Closest => rays.filter(|ray| black_box(scene.closest(ray)).is_some()).count(),
        Query::Occluded => rays.filter(|ray| black_box(scene.occluded(ray))).count(),
    }
}

/// Rays that hit in one and miss in the other, and rays that hit at different distances.
fn disagreement(accel: &Accel, scene: &Scene, set: &RaySet, templates: &[RayHit]) -> (usize, usize) {
    let (mut hit_or_miss, mut distance) = (0, 0);
    for (ray, template) in set.rays.iter().zip(templates) {
        if set.query == Query::Occluded {
            hit_or_miss += usize::from(accel.occluded(ray, Ignored::NOTHING) != scene.occluded(template));
            continue;
        }
        match (accel.closest(ray, Ignored::NOTHING), scene.closest(template)) {
            (Some(ours), Some(theirs)) => {
                distance += usize::from((ours.t - theirs).abs() > SAME * ours.t.max(theirs));
            }
            (None, None) => {}
            _ => hit_or_miss += 1,
        }
    }
    (hit_or_miss, distance)
}
