//! `floe encode`

use std::path::{Path, PathBuf};

use clap::Args;

use super::exit::Exit;
use super::streams::{print, say};
use crate::driver::{Interrupt, RenderError};
use crate::film::write::write_atomically;
use crate::movie::{EncodeOptions, FRAME_RATES, MovieError, Pictures, contact_sheet, encode};
use crate::sequence::format_numbers;

#[derive(Debug, Args)]
pub struct EncodeArguments {
    /// A scene whose pictures are there, a folder of pictures, or the pattern of their names. An EXR without a PNG that is
    /// up to date is shown at output.exposure of the scene, or at 0 where no scene is given
    pictures: PathBuf,
    /// The movie: .mp4, .webm or .gif [default: movie.mp4 beside the pictures]
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Frames a second [default: frames.fps of the scene, else framesPerSecond of the first EXR, else 24]
    #[arg(long, value_name = "N", value_parser = frames_a_second)]
    fps: Option<f64>,
    /// Quality, less is better: up to 51 for .mp4 [default: 18], up to 63 for .webm [default: 30]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(0..=63))]
    crf: Option<u8>,
    /// Write a PNG with all pictures small and numbered, and a movie only with --output
    #[arg(long, value_name = "FILE", value_parser = png_file)]
    contact_sheet: Option<PathBuf>,
    /// Pictures in a row of the contact sheet [default: as many as make it about square]
    #[arg(long, value_name = "N", requires = "contact_sheet", value_parser = clap::value_parser!(u32).range(1..))]
    columns: Option<u32>,
}

/// Makes a movie, a contact sheet, or both.
pub fn run(arguments: &EncodeArguments) -> Exit {
    match make(arguments) {
        Ok(text) => print(&text),
        Err(error) => {
            say(&format!("error: {error}"));
            exit(error)
        }
    }
}

fn make(arguments: &EncodeArguments) -> Result<String, MovieError> {
    let pictures = Pictures::find(&arguments.pictures)?;
    let folder = pictures.files[0].path.parent().unwrap_or(Path::new(""));
    let output = arguments.output.clone().unwrap_or_else(|| folder.join("movie.mp4"));
    let options = EncodeOptions { output, fps: arguments.fps, crf: arguments.crf };
    let wants_movie = arguments.contact_sheet.is_none() || arguments.output.is_some();
    if wants_movie {
        options.check()?;
    }
    if !pictures.unfinished.is_empty() {
        let numbers = format_numbers(&pictures.unfinished);
        say(&format!(
            "warning: PNGs without a picture (.exr), which may be previews, are left out: {numbers}"
        ));
    }
    let mut text = String::new();
    if let Some(sheet) = &arguments.contact_sheet {
        write_atomically(sheet, &contact_sheet(&pictures, arguments.columns)?)?;
        text += &format!("{} pictures in {}\n", pictures.files.len(), sheet.display());
    }
    if wants_movie {
        let interrupt = Interrupt::default();
        #[cfg(unix)]
        super::signals::obey(&interrupt);
        let frames = encode(&pictures, &options, &interrupt, |warning| say(&format!("warning: {warning}")))?;
        let fps = options.fps.unwrap_or(pictures.fps);
        text += &format!("{frames} frames at {fps} a second in {}\n", options.output.display());
    }
    Ok(text)
}

fn exit(error: MovieError) -> Exit {
    match error {
        MovieError::Scene(error) => Exit::from(&error),
        MovieError::Sequence(error) => Exit::from(&RenderError::from(error)),
        MovieError::Film(error) => Exit::from(&RenderError::from(error)),
        MovieError::NoPictures { .. } => Exit::Missing,
        MovieError::Picture { .. } | MovieError::Size { .. } | MovieError::Gap { .. } => Exit::BadData,
        MovieError::NoFfmpeg { .. } | MovieError::Ffmpeg { .. } => Exit::Internal,
        MovieError::UnknownKind { .. } | MovieError::Quality { .. } => Exit::Usage,
        MovieError::Interrupted => Exit::Interrupted,
    }
}

fn frames_a_second(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|fps| FRAME_RATES.contains(fps));
    number.ok_or_else(|| "write a number from 0.001 to 1000".into())
}

fn png_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let is_png = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("png"));
    if is_png { Ok(path) } else { Err(format!("write a name that ends with .png, such as {text}.png")) }
}
