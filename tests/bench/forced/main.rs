//! What leaving out saves: each part that a shipped scene does without, forced in. `cargo bench --bench forced`.
//!
//! A scene is rendered as it is and with one part forced in, in turns on one thread. The table has the ratio of the least
//! CPU seconds of light transport and of the greatest memory in use from reading the frame to the finished pixels.
//! Parts that take no light out of the picture leave its pixels as they were, or as they were but for other random
//! numbers; what is forced by another integrator, an open shutter or a lens makes another picture.

#![allow(clippy::print_stdout)] // the table is what it is for
#![allow(clippy::unwrap_used)] // a bench that cannot open its scene has nothing to say

mod heap;
mod parts;

use cpu_time::ProcessTime;
use floe::driver::Job;
use floe::driver::tiles::{Sampling, render_pixels};
use parts::{PARTS, Part, SCENES, Scene};

/// Renders of each kind; the least of their seconds counts.
const TURNS: usize = 5;

/// What a render takes.
#[derive(Clone, Copy)]
struct Cost {
    seconds: f64,
    bytes: usize,
}

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    println!("| scene | left out | time, times | memory, times | MB |");
    println!("|---|---|---|---|---|");
    for scene in &SCENES {
        for part in PARTS.iter().filter(|part| part.is_left_out(scene)) {
            let (plain, forced) = pool.install(|| in_turns(scene, part));
            println!(
                "| {} | {} | {:.3} | {:.2} | {:.1} to {:.1} |",
                scene.name,
                part.name,
                forced.seconds / plain.seconds,
                forced.bytes as f64 / plain.bytes as f64,
                plain.bytes as f64 * 1e-6,
                forced.bytes as f64 * 1e-6,
            );
        }
    }
}

fn in_turns(scene: &Scene, part: &Part) -> (Cost, Cost) {
    let mut costs = [Cost { seconds: f64::INFINITY, bytes: 0 }; 2];
    for _ in 0..TURNS {
        for (cost, forced) in costs.iter_mut().zip([None, Some(part)]) {
            let this = render(scene, forced);
            *cost = Cost { seconds: cost.seconds.min(this.seconds), bytes: this.bytes };
        }
    }
    (costs[0], costs[1])
}

fn render(scene: &Scene, forced: Option<&Part>) -> Cost {
    let folder = tempfile::tempdir().unwrap();
    let job =
        Job::open(&scene.write(folder.path(), forced)).unwrap_or_else(|e| panic!("{}: {e}", scene.name));
    let task =
        job.tasks().into_iter().find(|task| scene.frame.is_none_or(|n| task.number == n.into())).unwrap();
    heap::begin();
    let meshes = task.read(&job.world).unwrap_or_else(|e| panic!("{e}")).meshes;
    let mut frame = job.world.assemble(task.number, meshes, None).unwrap_or_else(|e| panic!("{e}")).frame;
    if let Some(force) = forced.and_then(|part| part.need) {
        force(&mut frame.needs);
    }
    let sampling = Sampling::new(&job.world.description.render);
    let before = ProcessTime::now();
    let (image, _) = render_pixels(&frame, &sampling, &|_, _| ());
    let seconds = before.elapsed().as_secs_f64();
    assert!(image.pixels.iter().all(|p| p.rgb.is_finite()));
    Cost { seconds, bytes: heap::greatest() }
}
