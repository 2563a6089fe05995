//! `floe render`

use std::path::PathBuf;

use clap::Args;

use super::exit::Exit;
use super::progress::Progress;
use crate::driver::{FrameRecord, Job, RenderOptions, RenderReport, render};
use crate::sequence::{FrameSelection, format_numbers};

#[derive(Debug, Args)]
pub struct RenderArguments {
    /// A scene file, or a folder with scene.toml or with frames
    scene: PathBuf,
    /// Only these frames: 7,9,20 or 1-100 or 1-100x2
    #[arg(long, value_name = "RANGE", value_parser = FrameSelection::parse, allow_hyphen_values = true)]
    frames: Option<FrameSelection>,
    /// Name of the pictures: a file, or a pattern such as shots/frame_####.exr
    #[arg(long, short, value_name = "PATTERN")]
    output: Option<String>,
    /// Samples a pixel
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    samples: Option<u32>,
    /// Seed of every random number
    #[arg(long, value_name = "S")]
    seed: Option<u64>,
    /// Threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Render the other frames when one is bad
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
        output: arguments.output.clone(),
        samples: arguments.samples,
        seed: arguments.seed,
        threads: arguments.threads.map(usize::from),
        keep_going: arguments.keep_going,
    };
    let progress = Progress::new(arguments.quiet);
    let report = Job::open(&arguments.scene).and_then(|job| {
        if let Some(scene) = &job.written_scene {
            eprintln!("wrote {}: edit it to change camera, light and media", scene.display());
        }
        render(&job, &options, &progress)
    });
    progress.finish();
    match report {
        Ok(report) => {
            print!("{}", summary(&report));
            report.failures.iter().map(|(_, error)| Exit::from(error)).max().unwrap_or(Exit::Complete)
        }
        Err(error) => {
            eprintln!("error: {error}");
            Exit::from(&error)
        }
    }
}

/// Frames, time, estimated error, rare events, what is left out.
fn summary(report: &RenderReport) -> String {
    let done: Vec<&FrameRecord> = report.frames.iter().filter(|r| r.error.is_none()).collect();
    let mut text = format!("{} of {} frames", done.len(), report.frames.len() + report.skipped);
    text += &format!(" in {:.1} s", report.seconds);
    if !done.is_empty() {
        text += &format!(" ({:.2} s a frame)", report.seconds / report.frames.len() as f64);
    }
    let errors: Vec<f64> = done.iter().filter_map(|r| r.relative_error.map(|e| e.estimate)).collect();
    if !errors.is_empty() {
        let mean = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
        let worst = errors.iter().fold(0.0_f64, |a, &b| a.max(b));
        text += &format!("; estimated relative error {:.2} % (worst {:.2} %)", 100.0 * mean, 100.0 * worst);
    }
    text.push('\n');
    if !report.failures.is_empty() {
        let failed: Vec<_> = report.failures.iter().map(|(number, _)| *number).collect();
        text += &format!("without a picture: frames {}", format_numbers(&failed));
        if report.skipped > 0 {
            text += &format!("; {} not tried (--keep-going renders them)", report.skipped);
        }
        text.push('\n');
    }
    let mut left_out: Vec<&String> = report.frames.iter().flat_map(|r| &r.left_out).collect();
    left_out.dedup();
    left_out.iter().for_each(|part| text += &format!("left out: {part}\n"));
    if let Some(first) = done.first() {
        let folder = first.output.parent().unwrap_or(&first.output);
        text += &format!("pictures in {}, ledger {}\n", folder.display(), report.ledger.display());
    }
    text
}
