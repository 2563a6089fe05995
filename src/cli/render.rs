//! `floe render`

use std::path::PathBuf;

use clap::Args;

use super::exit::Exit;
use super::progress::Progress;
use super::streams::{print, say};
use super::summary::summary;
use crate::driver::{Job, RenderError, RenderOptions, check_pictures, preview, render};
use crate::sequence::{FrameSelection, SequenceError};

#[derive(Debug, Args)]
pub struct RenderArguments {
    /// A scene file, or a folder with scene.toml or with frames
    scene: PathBuf,
    /// Only these frames: 7,9,20 or 1-100 or 1-100x2 (also 1-100:2)
    #[arg(long, value_name = "RANGE", value_parser = FrameSelection::parse, allow_hyphen_values = true)]
    frames: Option<FrameSelection>,
    /// Name of the pictures: shot.exr for one, shots/frame_####.exr (also %04d, $F4) for several
    /// (default: output.path of the scene, else out/NAME/frame_####.exr with the NAME of the folder)
    #[arg(long, short, value_name = "PATTERN", value_parser = output_pattern)]
    output: Option<String>,
    /// Samples a pixel [default: render.samples of the scene]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    samples: Option<u32>,
    /// Seed of every random number [default: render.seed of the scene]
    #[arg(long, value_name = "S")]
    seed: Option<u64>,
    /// Threads that render; one more makes the next frame ready [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// A quarter of the size, at most 16 samples, into the folder `preview` beside the pictures
    #[arg(long)]
    preview: bool,
    /// Write pictures without noise too, as frame_0001.denoised.exr beside each (also output.denoise of the scene)
    #[arg(long)]
    denoise: bool,
    /// Go on with the other frames when one fails; the exit code still tells
    #[arg(long)]
    keep_going: bool,
    /// Only warnings, errors and the summary
    #[arg(long, short)]
    quiet: bool,
}

/// Renders and says what became of it.
pub fn run(arguments: &RenderArguments) -> Exit {
    let options = RenderOptions {
        frames: arguments.frames.clone(),
        output: match (&arguments.output, arguments.preview) {
            (Some(pattern), true) => Some(preview::place(pattern)),
            (pattern, _) => pattern.clone(),
        },
        samples: arguments.samples,
        seed: arguments.seed,
        threads: arguments.threads.map(usize::from),
        keep_going: arguments.keep_going,
        denoise: arguments.denoise,
    };
    let progress = Progress::new(arguments.quiet);
    let open = if arguments.preview { preview::open } else { Job::open };
    let report = open(&arguments.scene).and_then(|job| {
        if let Some(scene) = &job.written_scene {
            say(&format!("wrote {}: edit it to change camera, light and media", scene.display()));
        }
        render(&job, &options, &progress)
    });
    progress.finish();
    match report {
        Ok(report) => {
            let printed = print(&summary(&report));
            report.failures.iter().map(|(_, error)| Exit::from(error)).fold(printed, Exit::max)
        }
        Err(error) => {
            say(&format!("error: {error}"));
            match error {
                RenderError::Sequence(SequenceError::NoPlace { .. }) if arguments.output.is_some() => {
                    Exit::Usage
                }
                error => Exit::from(&error),
            }
        }
    }
}

/// A name for pictures; how many there will be is not known yet.
fn output_pattern(text: &str) -> Result<String, RenderError> {
    check_pictures(text, 1).map(|()| text.into())
}
