//! `floe report`

use std::path::{Path, PathBuf};

use clap::Args;

use super::exit::Exit;
use super::files::write;
use super::settings::output_pattern;
use super::streams::{print, say};
use crate::driver::ledgers::Ledgers;
use crate::driver::picture::picture_path;
use crate::driver::{Job, RenderError};
use crate::sequence::{FrameNumber, FrameSelection};
use crate::study::report::{SequenceReport, csv, diagram, text};

#[derive(Debug, Args)]
pub struct ReportArguments {
    /// A scene file or a folder whose frames were rendered, or a folder of pictures with their ledgers
    scene: PathBuf,
    /// Only these frames: 7,9,20 or 1-100 or 1-100x2 (also 1-100:2)
    #[arg(long, value_name = "RANGE", value_parser = FrameSelection::parse, allow_hyphen_values = true)]
    frames: Option<FrameSelection>,
    /// Name of the pictures, as it was given to render [default: as render has it]
    #[arg(long, short, value_name = "PATTERN", value_parser = output_pattern)]
    output: Option<String>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Write the frames into a table of comma-separated values
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Draw error against run time
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
}

/// Where pictures are, and which frames there ought to be.
struct Pictures {
    folder: PathBuf,
    pattern: Option<String>,
    expected: Vec<FrameNumber>,
}

/// Prints what the ledgers beside pictures tell.
pub fn run(arguments: &ReportArguments) -> Exit {
    let pictures = match find(arguments) {
        Ok(pictures) => pictures,
        Err(error) => {
            say(&format!("error: {error}"));
            return Exit::from(&error);
        }
    };
    let shown = if pictures.folder.as_os_str().is_empty() { Path::new(".") } else { &pictures.folder };
    let mut ledgers = match Ledgers::in_folder(&pictures.folder) {
        Ok(ledgers) => ledgers,
        Err(error) => {
            say(&format!("error: {error}; check who may read it"));
            return Exit::Missing;
        }
    };
    if ledgers.files.is_empty() {
        say(&format!(
            "error: there is no ledger.jsonl in {}: render first, merge partials if there are any, or name the folder of the \
             pictures",
            shown.display()
        ));
        return Exit::Missing;
    }
    if let Some(pattern) = &pictures.pattern {
        ledgers.keep_pictures(|number| picture_path(pattern, number));
    }
    let is_wanted = |number| arguments.frames.as_ref().is_none_or(|frames| frames.contains(number));
    let report = SequenceReport::new(&ledgers, &pictures.expected, is_wanted);
    let title = pictures.pattern.unwrap_or_else(|| shown.display().to_string());
    tell(arguments, &report, &title)
}

fn tell(arguments: &ReportArguments, report: &SequenceReport, title: &str) -> Exit {
    let written = arguments.csv.as_ref().map_or(Exit::Complete, |file| write(file, &csv(report)));
    let drawn = match (&arguments.svg, diagram(report, title)) {
        (Some(file), Some(plot)) => write(file, &plot.svg()),
        (Some(file), None) => {
            say(&format!("warning: no picture has a known error, so there is no {}", file.display()));
            Exit::Complete
        }
        (None, _) => Exit::Complete,
    };
    let json = || serde_json::to_string_pretty(report).unwrap_or_default() + "\n";
    print(&if arguments.json { json() } else { text(report) }).max(written).max(drawn)
}

/// A folder with ledgers and without a scene is one of pictures; anything else is what `render` takes.
fn find(arguments: &ReportArguments) -> Result<Pictures, RenderError> {
    let path = &arguments.scene;
    let has_ledgers = || Ledgers::in_folder(path).map_or(true, |ledgers| !ledgers.files.is_empty());
    if path.is_dir() && !path.join("scene.toml").exists() && has_ledgers() {
        return Ok(Pictures {
            folder: path.clone(),
            pattern: arguments.output.clone(),
            expected: Vec::new(),
        });
    }
    let job = Job::open(path)?;
    let numbers: Vec<FrameNumber> = job.tasks().iter().map(|task| task.number).collect();
    let expected = match &arguments.frames {
        None => numbers,
        Some(frames) => {
            let absent = frames.absent(&numbers);
            let wanted = numbers.into_iter().filter(|number| frames.contains(*number));
            wanted.chain(absent).collect()
        }
    };
    let pattern = arguments.output.clone().unwrap_or_else(|| job.output_pattern());
    let first = picture_path(&pattern, FrameNumber::ONE);
    let folder = first.parent().unwrap_or(Path::new("")).to_path_buf();
    Ok(Pictures { folder, pattern: Some(pattern), expected })
}
