//! Rendering that is told to stop between any two samples, again and again, ends as the same bits.

use std::sync::atomic::{AtomicU64, Ordering};

use floe::driver::Job;
use floe::driver::accumulation::Accumulation;
use floe::driver::tiles::{Control, Sampling, accumulate, render_pixels};

use super::command::{boxes, edit};
use super::numbers::Numbers;

/// Asks to stop after so many questions, and to save at every so many.
struct Impatient {
    left: AtomicU64,
    rests: u64,
}

impl Control for Impatient {
    fn stops(&self) -> bool {
        let left = self.left.load(Ordering::Relaxed);
        left == 0 || self.left.fetch_sub(1, Ordering::Relaxed) == 1
    }

    /// Never twice in a row, so that it goes on.
    fn wants_save(&self) -> bool {
        self.left.load(Ordering::Relaxed) % self.rests == 1
    }

    fn save(&self, _: &Accumulation) {
        self.left.fetch_sub(1, Ordering::Relaxed);
    }
}

/// Wants a save whenever it is asked, and stops where saves come without a pixel between them.
struct Restless(AtomicU64);

impl Control for Restless {
    fn stops(&self) -> bool {
        // More than there are pixels.
        self.0.load(Ordering::Relaxed) > 37 * 19
    }

    fn wants_save(&self) -> bool {
        true
    }

    fn save(&self, _: &Accumulation) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }
}

fn check(integrator: &str, seed: u64) {
    let folder = boxes(1, "[sun]\ndirection = [0.3, -0.2, 0.9]\nirradiance = 2\n");
    edit(&folder, "resolution = [16, 9]", "resolution = [37, 19]");
    let photons = "photons = { count = 60 }";
    edit(&folder, "samples = 4", &format!("samples = 4\nintegrator = \"{integrator}\"\n{photons}"));
    let job = Job::open(&folder.path("boxes/scene.toml")).unwrap();
    let task = &job.tasks()[0];
    let frame = job.world.assemble(task.number, task.read(&job.world).unwrap().meshes, None).unwrap().frame;
    let sampling = Sampling::new(&job.world.description.render);
    let alone = render_pixels(&frame, &sampling, &|_, _| ());
    let mut restless = Accumulation::new(frame.views.opening.resolution());
    let ends = accumulate(&mut restless, &frame, &sampling, &Restless(AtomicU64::new(0)));
    assert!(ends && restless.finish() == alone, "{integrator} with saves all the time");
    let (mut numbers, mut stops) = (Numbers(seed), 0);
    for threads in [1, 1, 2, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut accumulation = Accumulation::new(frame.views.opening.resolution());
        loop {
            let control =
                Impatient { left: AtomicU64::new(1 + numbers.below(400)), rests: 2 + numbers.below(100) };
            if pool.install(|| accumulate(&mut accumulation, &frame, &sampling, &control)) {
                break;
            }
            // What is there when it stops is all that a run has which goes on from a checkpoint.
            accumulation = accumulation.clone();
            stops += 1;
            assert!(stops < 5000, "it does not get on");
        }
        assert!(accumulation.finish() == alone, "{integrator} on {threads} threads");
    }
    assert!(stops > 20, "{integrator} was told to stop {stops} times only");
}

#[test]
fn path_tracing_may_stop_between_any_two_samples() {
    check("path", 3);
}

#[test]
fn photon_mapping_may_stop_between_any_two_samples() {
    check("photon", 4);
}
