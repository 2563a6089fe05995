//! Sequences of a folder for each frame, all holding a file of the same name.
//!
//! ```text
//! postProcessing/cut/0.05/surface.vtp       the folder cut, cut/*/surface.vtp or cut/#/surface.vtp
//! postProcessing/cut/0.1/surface.vtp
//! ```
//! OpenFOAM samples surfaces so. The number is the one in the folder's name, with decimals where it is a time.

use std::path::{Path, PathBuf};

use super::frames::{Candidate, Kind, in_order, in_sequence, list, list_if, parse_number};
use super::name::{is_frame_name, is_time};
use super::pattern::NamePattern;
use super::{FrameFile, SequenceError, glob};

/// The meshes in those folders of a folder whose names are times.
pub(super) fn of_times(folder: &Path) -> Result<Vec<Candidate>, SequenceError> {
    let mut candidates = Vec::new();
    for (time, inside) in list_if(folder, Kind::Folder)? {
        if !is_time(&time) {
            continue;
        }
        let meshes = list(&inside)?.into_iter().filter(|(name, _)| is_frame_name(name));
        candidates.extend(meshes.map(|(name, path)| Candidate {
            stem: time.clone(),
            rest: format!("/{name}"),
            path,
        }));
    }
    Ok(candidates)
}

/// Whether a pattern has its number, or its glob, in the name of a folder.
pub(super) fn is_pattern(base: &Path, pattern: &str) -> bool {
    !matches!(Parts::of(base, pattern), Ok(None))
}

/// The folder that holds those that vary; `None` when the pattern has neither number nor glob in the name of a folder.
pub(super) fn above(base: &Path, pattern: &str) -> Option<PathBuf> {
    Parts::of(base, pattern).ok().flatten().map(|parts| base.join(parts.above))
}

/// The frames of a pattern whose number, or whose glob, stands in the name of a folder; `None` when it has
/// neither there.
pub(super) fn by_pattern(base: &Path, pattern: &str) -> Result<Option<Vec<FrameFile>>, SequenceError> {
    let Some(parts) = Parts::of(base, pattern)? else { return Ok(None) };
    let folder = base.join(&parts.above);
    let files =
        list_if(&folder, Kind::Folder)?.into_iter().map(|(name, path)| (name, path.join(&parts.below)));
    let files: Vec<(String, PathBuf)> = files.filter(|(_, path)| path.is_file()).collect();
    let Some(place) = parts.place else {
        let matching = files.into_iter().filter(|(name, _)| glob::matches(&parts.name, name));
        let candidate = |(stem, path)| Candidate { stem, rest: format!("/{}", parts.below), path };
        let candidates: Vec<Candidate> = matching.map(candidate).collect();
        return in_sequence(&folder, &candidates, &format!("files named `{pattern}`")).map(Some);
    };
    let mut frames = Vec::new();
    for (name, path) in files {
        if let Some(number) = place.number_text(&name) {
            frames.push(FrameFile { number: parse_number(number, &path)?, path });
        }
    }
    if frames.is_empty() {
        return Err(SequenceError::NothingFound { folder, wanted: format!("files named `{pattern}`") });
    }
    in_order(frames).map(Some)
}

/// A pattern around the name of the folder that varies.
struct Parts {
    above: String,
    name: String,
    /// Where the number stands in the name; a glob has none.
    place: Option<NamePattern>,
    below: String,
}

impl Parts {
    fn of(base: &Path, pattern: &str) -> Result<Option<Self>, SequenceError> {
        let refuse = |reason: &str| {
            Err(SequenceError::Pattern { pattern: pattern.to_owned(), reason: reason.to_owned() })
        };
        let varies = |part: &str| glob::is_glob(part) || !matches!(NamePattern::find(part), Ok(None));
        let mut above = String::new();
        let mut rest = pattern;
        // A folder of that very name is no pattern.
        while let Some((name, below)) = rest.split_once(std::path::is_separator) {
            let here = format!("{above}{name}");
            if !varies(name) || base.join(&here).is_dir() {
                above = here + "/";
                rest = below;
                continue;
            }
            if below.split(std::path::is_separator).any(varies) {
                return refuse(
                    "the number, `*` and `?` stand in one part of the path only: write the others out",
                );
            }
            let place = NamePattern::find(name)?;
            if place.is_some() && glob::is_glob(name) {
                return refuse("it has both a place for the number and `*` or `?`: keep one of the two");
            }
            return Ok(Some(Self { above, name: name.to_owned(), place, below: below.to_owned() }));
        }
        Ok(None)
    }
}

#[cfg(test)]
mod tests;
