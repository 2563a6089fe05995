//! `floe compare`

use std::path::{Path, PathBuf};

use clap::Args;

use super::exit::Exit;
use super::streams::{print, say};
use crate::driver::RenderError;
use crate::film::exr_layers::StoredPicture;
use crate::film::write::write_atomically;
use crate::sequence::{FrameNumber, SequenceError, check_output_pattern, format_numbers, output_path};
use crate::study::compare::report::{Entry, Report};
use crate::study::compare::{CompareError, Comparison, Limits, Pair, Pairs, Verdict, compare, difference};

#[derive(Debug, Args)]
pub struct CompareArguments {
    /// The candidate: an EXR file, a folder of them, or the pattern of their names
    a: PathBuf,
    /// The reference: the same. Frames of sequences are matched by their numbers
    b: PathBuf,
    /// Greatest mean relMSE. With this or --max-flip only these limits decide, and the z-test if --significance is given
    #[arg(long, value_name = "E", value_parser = limit)]
    max_relmse: Option<f64>,
    /// Greatest mean FLIP, from 0 to 1
    #[arg(long, value_name = "E", value_parser = limit)]
    max_flip: Option<f64>,
    /// Probability that the z-test, over all frames, takes noise for a difference [default: 0.001]
    #[arg(long, value_name = "P", value_parser = significance)]
    significance: Option<f64>,
    /// Write where they differ: .png (FLIP as colours) or .exr (A - B, relative, flip); of sequences with #### in the name
    #[arg(long, value_name = "FILE", value_parser = difference_file)]
    difference: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Compares, prints, and ends with 1 if anything differs.
pub fn run(arguments: &CompareArguments) -> Exit {
    let pairs = match find(arguments) {
        Ok(pairs) => pairs,
        Err(error) => {
            say(&format!("error: {error}"));
            return exit(error);
        }
    };
    let (entries, mut worst) = entries(arguments, &pairs.pairs);
    for (name, other, numbers) in [("A", "B", &pairs.missing[0]), ("B", "A", &pairs.missing[1])] {
        if !numbers.is_empty() {
            say(&format!("error: frames that {other} has are not in {name}: {}", format_numbers(numbers)));
            worst = worst.max(Exit::Missing);
        }
    }
    let report = Report { entries, missing: pairs.missing };
    if report.differs() {
        worst = worst.max(Exit::Different);
    }
    // One picture that could not be read has been told.
    let is_empty =
        matches!(&report.entries[..], [Entry { pair: Pair { number: None, .. }, outcome: Err(_) }]);
    match (arguments.json, is_empty) {
        (true, _) => print(&report.json()).max(worst),
        (false, true) => worst,
        (false, false) => print(&report.text()).max(worst),
    }
}

/// What each pair shows, and the worst that kept one from being compared.
fn entries(arguments: &CompareArguments, pairs: &[Pair]) -> (Vec<Entry>, Exit) {
    let mut worst = Exit::Complete;
    let entry = |pair: &Pair| {
        let outcome = pair_outcome(arguments, pair, pairs.len()).map_err(|error| {
            let text = error.to_string();
            let frame = pair.number.map(|number| format!("frame {number}: ")).unwrap_or_default();
            say(&format!("error: {frame}{text}"));
            worst = worst.max(exit(error));
            text
        });
        Entry { pair: pair.clone(), outcome }
    };
    (pairs.iter().map(entry).collect(), worst)
}

fn find(arguments: &CompareArguments) -> Result<Pairs, CompareError> {
    let pairs = Pairs::find(&arguments.a, &arguments.b)?;
    if let Some(file) = &arguments.difference {
        check_output_pattern(&file.to_string_lossy(), pairs.pairs.len())?;
    }
    Ok(pairs)
}

fn pair_outcome(
    arguments: &CompareArguments,
    pair: &Pair,
    frames: usize,
) -> Result<(Comparison, Verdict), CompareError> {
    let limits = Limits {
        max_relmse: arguments.max_relmse,
        max_flip: arguments.max_flip,
        significance: arguments.significance,
    };
    let [a, b] = pair.read()?;
    let found = compare(&a, &b);
    if let Some(file) = &arguments.difference {
        let number = pair.number.unwrap_or(FrameNumber::ONE);
        write_difference(&output_path(&file.to_string_lossy(), number), &a, &b, &found)?;
    }
    let verdict = limits.judge(&found, frames);
    Ok((found, verdict))
}

fn write_difference(
    file: &str,
    a: &StoredPicture,
    b: &StoredPicture,
    found: &Comparison,
) -> Result<(), CompareError> {
    let path = Path::new(file);
    let bytes = if ends_with(path, "png") {
        difference::png(found, path)?
    } else {
        difference::exr(a, b, found, path)?
    };
    Ok(write_atomically(path, &bytes)?)
}

fn exit(error: CompareError) -> Exit {
    match error {
        // Names are given on the command line here.
        CompareError::Sequence(SequenceError::NoPlace { .. } | SequenceError::Pattern { .. }) => Exit::Usage,
        CompareError::Sequence(error) => Exit::from(&RenderError::from(error)),
        CompareError::Film(error) => Exit::from(&RenderError::from(error)),
        CompareError::Missing { .. }
        | CompareError::NoPictures { .. }
        | CompareError::NothingInCommon { .. } => Exit::Missing,
        CompareError::Unreadable { .. } | CompareError::Size { .. } => Exit::BadData,
        CompareError::ManyAndOne { .. } => Exit::Usage,
    }
}

fn limit(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|limit: &f64| *limit >= 0.0);
    number.ok_or_else(|| "write a number that is not negative, such as 0.001".into())
}

fn significance(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|p: &f64| *p > 0.0 && *p < 1.0);
    number.ok_or_else(|| "write a probability between 0 and 1, such as 0.001".into())
}

fn difference_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    if ends_with(&path, "png") || ends_with(&path, "exr") {
        Ok(path)
    } else {
        Err(format!("write a name that ends with .png or .exr, such as {text}.png"))
    }
}

fn ends_with(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension))
}
