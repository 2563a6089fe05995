//! One picture, and what it took.

use std::time::Instant;

use cpu_time::ProcessTime;

use crate::driver::Interrupt;
use crate::driver::accumulation::Accumulation;
use crate::driver::tiles::{Control, Sampling, accumulate};
use crate::film::FrameImage;
use crate::sampling::SampleSeed;
use crate::scene::description::RenderDescription;
use crate::scene::frame::Frame;

/// When to break off.
#[derive(Clone, Debug, Default)]
pub(super) struct Watch {
    /// What a user asks for.
    pub interrupt: Interrupt,
    /// When time is up.
    pub deadline: Option<Instant>,
}

impl Watch {
    pub fn is_late(&self) -> bool {
        self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
    }
}

impl Control for Watch {
    fn stops(&self) -> bool {
        self.interrupt.is_requested() || self.is_late()
    }
}

/// A picture.
pub(super) struct Run {
    pub image: FrameImage,
    /// Seconds on the clock.
    pub seconds: f64,
    /// Seconds of all processors in this process.
    pub cpu_seconds: f64,
    /// Rays of paths, of photons and towards lights.
    pub rays: u64,
}

impl Run {
    /// Renders a picture; `None` when it is broken off.
    pub fn of(
        frame: &Frame,
        settings: &RenderDescription,
        (samples, seed): (u32, u64),
        watch: &Watch,
    ) -> Option<Self> {
        // A budget is a budget, whatever the scene says of when it is enough.
        let sampling =
            Sampling { samples, seed: SampleSeed::new(seed), target: None, ..Sampling::new(settings) };
        let mut accumulation = Accumulation::new(frame.views.opening.resolution());
        let (clock, cpu) = (Instant::now(), ProcessTime::now());
        let stopped_by = accumulate(&mut accumulation, frame, &sampling, watch);
        let (seconds, cpu_seconds) = (clock.elapsed().as_secs_f64(), cpu.elapsed().as_secs_f64());
        stopped_by.map(|_| {
            let (image, counters) = accumulation.finish();
            Self { image, seconds, cpu_seconds, rays: counters.rays + counters.shadow_rays }
        })
    }
}
