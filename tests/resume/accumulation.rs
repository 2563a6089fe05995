//! Rendering that is told to stop between any two samples, again and again, ends as the same bits.

use std::sync::atomic::{AtomicU64, Ordering};

use floe::driver::accumulation::Accumulation;
use floe::driver::tiles::{Control, Sampling, accumulate, render_pixels};
use floe::driver::{Job, StoppedBy};
use floe::scene::frame::Frame;

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
struct Restless {
    saves: AtomicU64,
    most: u64,
}

impl Control for Restless {
    fn stops(&self) -> bool {
        self.saves.load(Ordering::Relaxed) > self.most
    }

    fn wants_save(&self) -> bool {
        true
    }

    fn save(&self, _: &Accumulation) {
        self.saves.fetch_add(1, Ordering::Relaxed);
    }
}

/// Has all the time that it takes.
struct Unhurried;

impl Control for Unhurried {}

/// Has no time but for one round.
struct Hasty;

impl Control for Hasty {
    fn seconds_left(&self) -> Option<f64> {
        Some(0.0)
    }
}

/// A frame of 37 x 19 pixels, and how it is sampled.
fn small(integrator: &str, more: &str) -> (Frame, Sampling) {
    let folder = boxes(1, "[sun]\ndirection = [0.3, -0.2, 0.9]\nirradiance = 2\n");
    edit(&folder, "resolution = [16, 9]", "resolution = [37, 19]");
    let photons = "photons = { count = 60 }";
    let render = format!("{more}\nintegrator = \"{integrator}\"\n{photons}");
    edit(&folder, "samples = 4", &render);
    let job = Job::open(&folder.path("boxes/scene.toml")).unwrap();
    let task = &job.tasks()[0];
    let frame = job.world.assemble(task.number, task.read(&job.world).unwrap().meshes, None).unwrap().frame;
    (frame, Sampling::new(&job.world.description.render))
}

fn check(integrator: &str, more: &str, rungs: u64, seed: u64) {
    let (frame, sampling) = small(integrator, more);
    let alone = render_pixels(&frame, &sampling, &|_, _| ());
    let mut restless = Accumulation::new(frame.views.opening.resolution());
    let ends = accumulate(
        &mut restless,
        &frame,
        &sampling,
        &Restless { saves: AtomicU64::new(0), most: 37 * 19 * rungs },
    );
    assert!(ends.is_some() && restless.finish() == alone, "{integrator} with saves all the time");
    let (mut numbers, mut stops) = (Numbers(seed), 0);
    for threads in [1, 1, 2, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut accumulation = Accumulation::new(frame.views.opening.resolution());
        loop {
            let control =
                Impatient { left: AtomicU64::new(1 + numbers.below(400)), rests: 2 + numbers.below(100) };
            if pool.install(|| accumulate(&mut accumulation, &frame, &sampling, &control)).is_some() {
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
    check("path", "samples = 4", 1, 3);
}

#[test]
fn photon_mapping_may_stop_between_any_two_samples() {
    check("photon", "samples = 4", 1, 4);
}

#[test]
fn beams_with_photons_beside_them_may_stop_between_any_two_samples() {
    check("beams", "samples = 4", 1, 7);
}

/// Each pixel has a rest after every rung: 16, 24, 32, 48, 64 samples.
#[test]
fn halves_may_stop_between_any_two_samples() {
    check("path", "samples = 64\ntarget_error = 0.006", 5, 5);
}

#[test]
fn photon_passes_with_a_target_may_stop_too() {
    check("photon", "samples = 24\ntarget_error = 0.1", 1, 6);
}

/// What has no time left has a round more each time that it goes on; where pixels were begun one after the other before,
/// they are gone on with so.
#[test]
fn rounds_under_a_time_budget_end_as_the_same_bits() {
    for more in ["samples = 30", "samples = 64\ntarget_error = 0.004"] {
        let (frame, sampling) = small("path", more);
        let alone = render_pixels(&frame, &sampling, &|_, _| ());
        for questions in [0, 300] {
            let mut accumulation = Accumulation::new(frame.views.opening.resolution());
            if questions > 0 {
                let control = Impatient { left: AtomicU64::new(questions), rests: 1 << 40 };
                assert_eq!(accumulate(&mut accumulation, &frame, &sampling, &control), None);
            }
            let mut cuts = 0;
            while accumulate(&mut accumulation, &frame, &sampling, &Hasty) == Some(StoppedBy::Time) {
                cuts += 1;
                let (image, _) = accumulation.clone().finish();
                assert!(image.pixels.iter().all(|pixel| pixel.samples >= 4), "a round at least");
                // With a target no round is begun when no time is left.
                if sampling.target.is_some() {
                    break;
                }
            }
            assert!(cuts > 0);
            assert!(accumulate(&mut accumulation, &frame, &sampling, &Unhurried).is_some());
            assert!(accumulation.finish() == alone, "{more} after {questions} questions");
        }
    }
}
