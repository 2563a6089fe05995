//! The frame files that a pattern, a glob or a folder stands for.
//!
//! A pattern says where the number is, in the file name or in the name of a folder above it. In a folder or
//! under a glob it is the last number of the stem, as [`Name`] cuts it; a folder may also hold a folder for
//! each time (`0.05/surface.vtp`, as OpenFOAM samples surfaces). Signs are read by patterns only.

use std::fs::{self, DirEntry, FileType};
use std::path::{Path, PathBuf};

use super::name::{Name, is_frame_name, split_extension};
use super::output::{has_place, split_path};
use super::pattern::NamePattern;
use super::{FrameFile, FrameNumber, SequenceError, folders, glob, name};

/// Finds the frames of a sequence in ascending order of their numbers.
///
/// `pattern` is relative to `base` and may be a folder, a path with a place for the number, a path with a glob, or
/// one file; place and glob stand in one part of the path. Files that are hidden or still being written (`.name`,
/// `.tmp`, `.part`) are never frames.
///
/// # Errors
/// Everything in [`SequenceError`] that concerns files: nothing found, a number twice, several sequences, a
/// number out of range, a pattern that cannot be used, or a folder that cannot be read.
pub fn discover(base: &Path, pattern: &str) -> Result<Vec<FrameFile>, SequenceError> {
    let whole = join(base, pattern);
    if pattern.is_empty() || whole.is_dir() {
        let mut candidates = meshes(&whole, |_| true)?;
        candidates.extend(folders::of_times(&whole)?);
        return in_sequence(&whole, &candidates, name::WANTED);
    }
    let (folder, name) = split_path(pattern);
    if let Some(frames) = folders::by_pattern(base, pattern)? {
        return Ok(frames);
    }
    let folder = if folder.is_empty() { base.to_owned() } else { base.join(folder) };
    match NamePattern::find(name)? {
        Some(_) if glob::is_glob(name) => Err(SequenceError::Pattern {
            pattern: pattern.to_owned(),
            reason: "it has both a place for the number and `*` or `?`: keep one of the two".to_owned(),
        }),
        Some(place) => by_place(&folder, name, &place),
        None if glob::is_glob(name) => {
            let candidates = meshes(&folder, |n| glob::matches(name, n))?;
            in_sequence(&folder, &candidates, &format!("meshes named `{name}`"))
        }
        None if whole.is_file() => single_file(whole, name),
        None => {
            Err(SequenceError::NothingFound { folder, wanted: format!("`{pattern}`, a file or a folder") })
        }
    }
}

/// Whether [`discover`] looks for more than the one file of this name.
pub fn is_sequence(base: &Path, pattern: &str) -> bool {
    has_place(pattern)
        || glob::is_glob(split_path(pattern).1)
        || folders::is_pattern(base, pattern)
        || join(base, pattern).is_dir()
}

/// The folder whose entries tell which frames [`discover`] finds; it need not be there.
pub fn listed_folder(base: &Path, pattern: &str) -> PathBuf {
    let whole = join(base, pattern);
    if pattern.is_empty() || whole.is_dir() {
        return whole;
    }
    folders::above(base, pattern).unwrap_or_else(|| join(base, split_path(pattern).0))
}

/// Finds the numbered pictures of a folder, of one extension, in ascending order; denoised copies are not among them.
///
/// # Errors
/// Those of [`discover`].
pub fn discover_pictures(folder: &Path, extension: &str) -> Result<Vec<FrameFile>, SequenceError> {
    let is_picture = |name: &str| {
        let (stem, end) = split_extension(name);
        end.eq_ignore_ascii_case(extension) && !stem.ends_with(".denoised")
    };
    in_sequence(folder, &candidates(folder, is_picture)?, &format!("pictures (.{extension})"))
}

/// `base` itself when the rest is empty: joining would add a separator.
fn join(base: &Path, rest: &str) -> PathBuf {
    if rest.is_empty() { base.to_owned() } else { base.join(rest) }
}

/// The files whose names have a number at the place of the pattern.
fn by_place(folder: &Path, name: &str, place: &NamePattern) -> Result<Vec<FrameFile>, SequenceError> {
    let mut frames = Vec::new();
    for (file, path) in list(folder)? {
        let Some(digits) = place.number_text(&file) else {
            continue;
        };
        frames.push(FrameFile { number: parse_number(digits, &path)?, path });
    }
    if frames.is_empty() {
        return Err(SequenceError::NothingFound { folder: folder.to_owned(), wanted: format!("`{name}`") });
    }
    in_order(frames)
}

/// One file that is named outright: its number is the one in its name, or 1.
fn single_file(path: PathBuf, name: &str) -> Result<Vec<FrameFile>, SequenceError> {
    let number = match Name::of(split_extension(name).0) {
        Some(name) => parse_number(name.digits, &path)?,
        None => FrameNumber::ONE,
    };
    Ok(vec![FrameFile { number, path }])
}

/// A file that may be a frame.
#[derive(Debug)]
pub(super) struct Candidate {
    /// What the number stands in: the stem of the file's name, or the name of a folder.
    pub stem: String,
    /// What stands behind it: the extension, or a separator and the rest of the path.
    pub rest: String,
    pub path: PathBuf,
}

/// The meshes of a folder whose names are wanted.
fn meshes(folder: &Path, wanted: impl Fn(&str) -> bool) -> Result<Vec<Candidate>, SequenceError> {
    candidates(folder, |name| is_frame_name(name) && wanted(name))
}

/// The files of a folder whose names are wanted.
fn candidates(folder: &Path, wanted: impl Fn(&str) -> bool) -> Result<Vec<Candidate>, SequenceError> {
    let candidate = |(name, path): (String, PathBuf)| {
        let (stem, rest) = name.split_at(split_extension(&name).0.len());
        Candidate { stem: stem.to_owned(), rest: rest.to_owned(), path }
    };
    let files = list(folder)?.into_iter().filter(|(name, _)| wanted(name));
    Ok(files.map(candidate).collect())
}

/// The frames among files that belong to one sequence; their numbers are found in the names.
pub(super) fn in_sequence(
    folder: &Path,
    files: &[Candidate],
    wanted: &str,
) -> Result<Vec<FrameFile>, SequenceError> {
    let mut frames = Vec::new();
    let mut sequence: Option<(Name<'_>, &Candidate)> = None;
    for file in files {
        let Some(name) = Name::of(&file.stem) else { continue };
        let (known, known_file) = sequence.get_or_insert((name, file));
        // The same frames may come in several formats, but not from several files of one folder.
        let constant =
            |file: &Candidate| file.rest.contains(std::path::is_separator).then(|| file.rest.clone());
        if (known.prefix, known.suffix) != (name.prefix, name.suffix)
            || constant(known_file) != constant(file)
        {
            return Err(SequenceError::SeveralSequences {
                folder: folder.to_owned(),
                first: known.pattern(&known_file.rest),
                second: name.pattern(&file.rest),
            });
        }
        frames.push(FrameFile { number: parse_number(name.digits, &file.path)?, path: file.path.clone() });
    }
    let name = |file: &Candidate| format!("{}{}", file.stem, file.rest);
    match (frames.is_empty(), files) {
        (false, _) => in_order(frames),
        (true, []) => {
            Err(SequenceError::NothingFound { folder: folder.to_owned(), wanted: wanted.to_owned() })
        }
        (true, [file]) => Ok(vec![FrameFile { number: FrameNumber::ONE, path: file.path.clone() }]),
        (true, [first, second, ..]) => Err(SequenceError::Unnumbered {
            folder: folder.to_owned(),
            first: name(first),
            second: name(second),
        }),
    }
}

/// Sorts by number and refuses numbers that are there twice.
pub(super) fn in_order(mut frames: Vec<FrameFile>) -> Result<Vec<FrameFile>, SequenceError> {
    frames.sort_unstable();
    match frames.windows(2).find(|pair| pair[0].number == pair[1].number) {
        Some(pair) => Err(SequenceError::DuplicateNumber {
            number: pair[0].number,
            first: pair[0].path.clone(),
            second: pair[1].path.clone(),
        }),
        None => Ok(frames),
    }
}

/// Names and paths of the finished files of a folder, by name.
pub(super) fn list(folder: &Path) -> Result<Vec<(String, PathBuf)>, SequenceError> {
    list_if(folder, Kind::File)
}

/// What an entry of a folder is.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    File,
    Folder,
}

impl Kind {
    /// Whether an entry is of this kind. Links are followed, since frames are often linked in from elsewhere; of other
    /// entries the listing itself tells, so that a thousand machines do not ask a file server about ten thousand each.
    fn is(self, entry: &DirEntry) -> bool {
        let is = |kind: FileType| match self {
            Self::File => kind.is_file(),
            Self::Folder => kind.is_dir(),
        };
        match entry.file_type() {
            Ok(kind) if !kind.is_symlink() => is(kind),
            _ => fs::metadata(entry.path()).is_ok_and(|found| is(found.file_type())),
        }
    }
}

/// Names and paths of what a folder holds, by name, but for what is hidden or unfinished.
pub(super) fn list_if(folder: &Path, kind: Kind) -> Result<Vec<(String, PathBuf)>, SequenceError> {
    // An empty path is the current folder.
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let io = |source| SequenceError::Io { folder: folder.to_owned(), source };
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(io)? {
        let entry = entry.map_err(io)?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let unfinished = [".tmp", ".part"].iter().any(|end| name.to_ascii_lowercase().ends_with(end));
        if !name.starts_with('.') && !unfinished && kind.is(&entry) {
            found.push((name, entry.path()));
        }
    }
    found.sort_unstable();
    Ok(found)
}

pub(super) fn parse_number(digits: &str, path: &Path) -> Result<FrameNumber, SequenceError> {
    FrameNumber::from_time(digits)
        .map_err(|_| SequenceError::Number { path: path.to_owned(), digits: digits.to_owned() })
}

#[cfg(test)]
mod tests;
