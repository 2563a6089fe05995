//! What several commands are told in the same words: the scene, its frames, and what takes the place of its settings.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::driver::{RenderError, RenderOptions, check_pictures};
use crate::sequence::{Deal, FrameSelection, Shard};

#[derive(Debug, Args)]
pub struct Settings {
    /// A scene file, or a folder with scene.toml or with frames
    pub scene: PathBuf,
    /// Only these frames: 7,9,20 or 1-100 or 1-100x2 (also 1-100:2)
    #[arg(long, value_name = "RANGE", value_parser = FrameSelection::parse, allow_hyphen_values = true)]
    frames: Option<FrameSelection>,
    /// Only the I-th of N shards of these frames, from 1/N to N/N: one for each machine
    #[arg(long, value_name = "I/N", allow_hyphen_values = true)]
    shard: Option<Shard>,
    /// How frames are dealt out to shards
    #[arg(long, value_enum, value_name = "HOW", requires = "shard", default_value_t)]
    shard_by: ShardBy,
    /// Name of the pictures: shot.exr for one, shots/frame_####.exr (also %04d, $F4) for several
    /// (default: output.path of the scene, else out/NAME/frame_####.exr with the NAME of the folder)
    #[arg(long, short, value_name = "PATTERN", value_parser = output_pattern)]
    pub output: Option<String>,
    /// Samples a pixel, at most with a target [default: render.samples of the scene]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    samples: Option<u32>,
    /// Stop a frame when its relative error is at most so much, such as 0.02 or 2%, and sample its tiles as they need
    /// [default: render.target_error of the scene]
    #[arg(long, value_name = "E", value_parser = target_error)]
    target_error: Option<f64>,
    /// Seed of every random number [default: render.seed of the scene]
    #[arg(long, value_name = "S")]
    seed: Option<u64>,
}

/// How frames are dealt out.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum ShardBy {
    /// One frame to each shard in turns
    #[default]
    RoundRobin,
    /// A run of neighbours to each
    Blocks,
}

impl Settings {
    /// What they ask of a run.
    pub fn options(&self) -> RenderOptions {
        let deal = match self.shard_by {
            ShardBy::RoundRobin => Deal::Turns,
            ShardBy::Blocks => Deal::Blocks,
        };
        RenderOptions {
            frames: self.frames.clone(),
            shard: self.shard.map(|shard| shard.dealt(deal)),
            output: self.output.clone(),
            samples: self.samples,
            target_error: self.target_error,
            seed: self.seed,
            ..RenderOptions::default()
        }
    }
}

/// A relative error, as a number or in per cent.
pub(super) fn target_error(text: &str) -> Result<f64, String> {
    let (number, unit) = text.strip_suffix('%').map_or((text, 1.0), |number| (number.trim_end(), 100.0));
    let error = number.parse::<f64>().ok().map(|number| number / unit);
    error.filter(|error| (1e-6..=1.0).contains(error)).ok_or_else(|| {
        format!("`{text}` is no relative error: write a number from 0.000001 to 1, such as 0.02 or 2%")
    })
}

/// A name for pictures; how many there will be is not known yet.
pub(super) fn output_pattern(text: &str) -> Result<String, RenderError> {
    check_pictures(text, 1).map(|()| text.into())
}
