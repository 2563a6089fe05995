//! The partials of a frame: which there are, and whether together they are all of its samples, once each.

use std::path::{Path, PathBuf};

use super::accumulation::Accumulation;
use super::error::RenderError;
use super::ledger::BeamRecord;
use super::partial::{self, Label, Took, Wanted};
use super::samples_range::SamplesRange;

/// The partials of a picture, by their names, in the order of their samples.
pub(super) fn partials_beside(picture: &Path) -> Vec<PathBuf> {
    among(picture, &names_in(folder_of(picture)))
}

/// Those of a picture among the names in its folder.
pub(super) fn among(picture: &Path, names: &[String]) -> Vec<PathBuf> {
    let range = |name: &String| SamplesRange::of_partial(name, picture);
    let mut found: Vec<_> = names.iter().filter_map(|name| Some((range(name)?, name))).collect();
    found.sort_unstable();
    found.into_iter().map(|(_, name)| picture.with_file_name(name)).collect()
}

/// Names of partials in a folder; none when it cannot be read.
pub(super) fn names_in(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    names.filter(|name| name.ends_with(".partial")).collect()
}

/// The folder of a picture.
pub(super) fn folder_of(picture: &Path) -> &Path {
    picture.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."))
}

/// All samples of a frame, put together.
pub(super) struct Merged {
    pub sums: Accumulation,
    pub beams: BeamRecord,
    /// What all parts took.
    pub took: Took,
}

/// The labels of partials that are all of a frame.
///
/// # Errors
/// What is foreign, twice or missing, by name.
pub(super) fn labels(
    wanted: &Wanted,
    picture: &Path,
    partials: &[PathBuf],
) -> Result<Vec<Label>, RenderError> {
    let mut labels: Vec<Label> = Vec::new();
    for path in partials {
        let label = partial::read_label(path).and_then(|label| wanted.check(&label).map(|()| label));
        let label = label.map_err(|problem| foreign(path, problem))?;
        if path != &label.range.partial_of(picture) {
            let problem =
                format!("holds samples {}, not those that its name says: give it its name back", label.range);
            return Err(foreign(path, problem));
        }
        let shared = labels.iter().find_map(|other| Some((other.range, other.range.shared(label.range)?)));
        if let Some((range, shared)) = shared {
            let other = range.partial_of(picture);
            let problem = format!("has samples {shared}, as {} has too: remove one of both", other.display());
            return Err(foreign(path, problem));
        }
        labels.push(label);
    }
    let gaps = SamplesRange::gaps(labels.iter().map(|label| label.range).collect(), wanted.samples);
    match gaps.as_slice() {
        [] => Ok(labels),
        [first, ..] => Err(RenderError::NoSamples {
            picture: picture.into(),
            gaps: gaps.iter().map(ToString::to_string).collect::<Vec<_>>().join(", "),
            samples: wanted.samples,
            first: *first,
        }),
    }
}

/// Adds all samples of a frame up, from one file after the other.
///
/// # Errors
/// Those of [`labels`], and what is damaged, by name.
pub(super) fn merged(wanted: &Wanted, picture: &Path) -> Result<Merged, RenderError> {
    let partials = partials_beside(picture);
    let labels = labels(wanted, picture, &partials)?;
    let mut all = Merged {
        sums: Accumulation::of_range(wanted.resolution, 0),
        beams: BeamRecord::default(),
        took: Took::default(),
    };
    for (path, label) in partials.iter().zip(&labels) {
        let contents = partial::read(path, label).map_err(|problem| foreign(path, problem))?;
        if !all.sums.add(&contents.parts, contents.counters, label.range) {
            let problem = "is damaged: its sums are not those of its samples; remove it, and render it again";
            return Err(foreign(path, problem.into()));
        }
        // All have built the same.
        let beam_seconds = all.beams.beam_seconds + contents.beams.beam_seconds;
        all.beams = BeamRecord { beam_seconds, ..contents.beams };
        all.took += contents.took;
    }
    Ok(all)
}

/// Removes the partials of a frame whose picture is there; those of anything else are not ours to remove.
pub(super) fn remove_partials(wanted: &Wanted, picture: &Path) {
    for path in partials_beside(picture) {
        if partial::read_label(&path).is_ok_and(|label| wanted.check(&label).is_ok()) {
            let _ = std::fs::remove_file(path);
        }
    }
}

fn foreign(path: &Path, problem: String) -> RenderError {
    RenderError::Partial { path: path.into(), problem }
}
