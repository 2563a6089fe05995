//! The frame files that a pattern, a glob or a folder stands for.
//!
//! A pattern says where the number is. In a folder or under a glob it is the last run of digits of the stem
//! (the name without `.gz` and extension); `iter_12.5` has the decimal number 12.5, but `v2.0001` and
//! `a.1.0001` end in frame 1, since what follows a letter or a dot is a version. Signs are read by patterns
//! only.

use std::fs;
use std::path::{Path, PathBuf};

use super::output::split_path;
use super::pattern::NamePattern;
use super::{FrameFile, FrameNumber, SequenceError, glob};

/// Extensions of files that may be frames of a folder or a glob; each may be followed by `.gz`.
const MESH_EXTENSIONS: [&str; 3] = ["ply", "obj", "dsc"];

/// Finds the frames of a sequence in ascending order of their numbers.
///
/// `pattern` is relative to `base` and may be a folder, a file name with a place for the number, a glob in
/// the file name, or one file. Files that are hidden or still being written (`.name`, `.tmp`, `.part`) are
/// never frames.
///
/// # Errors
/// Everything in [`SequenceError`] that concerns files: nothing found, a number twice, several sequences, a
/// number out of range, a pattern that cannot be used, or a folder that cannot be read.
pub fn discover(base: &Path, pattern: &str) -> Result<Vec<FrameFile>, SequenceError> {
    let whole = join(base, pattern);
    if pattern.is_empty() || whole.is_dir() {
        return in_folder(&whole, |_| true, "meshes (.ply, .obj, .dsc, also with .gz)".to_owned());
    }
    let (folder, name) = split_path(pattern);
    refuse_place_in_folder(base, pattern, folder)?;
    let folder = if folder.is_empty() { base.to_owned() } else { base.join(folder) };
    match NamePattern::find(name)? {
        Some(_) if glob::is_glob(name) => Err(SequenceError::Pattern {
            pattern: pattern.to_owned(),
            reason: "it has both a place for the number and `*` or `?`: keep one of the two".to_owned(),
        }),
        Some(place) => by_place(&folder, name, &place),
        None if glob::is_glob(name) => {
            in_folder(&folder, |n| glob::matches(name, n), format!("meshes named `{name}`"))
        }
        None if whole.is_file() => single_file(whole, name),
        None => {
            Err(SequenceError::NothingFound { folder, wanted: format!("`{pattern}`, a file or a folder") })
        }
    }
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
    numbered(folder, is_picture, format!("pictures (.{extension})"))
}

/// `base` itself when the rest is empty: joining would add a separator.
fn join(base: &Path, rest: &str) -> PathBuf {
    if rest.is_empty() { base.to_owned() } else { base.join(rest) }
}

/// Numbers and wildcards stand in the file name only, unless a folder of that very name exists.
fn refuse_place_in_folder(base: &Path, pattern: &str, folder: &str) -> Result<(), SequenceError> {
    let has_place = |part: &str| glob::is_glob(part) || !matches!(NamePattern::find(part), Ok(None));
    if !base.join(folder).is_dir() && folder.split(std::path::is_separator).any(has_place) {
        return Err(SequenceError::Pattern {
            pattern: pattern.to_owned(),
            reason: "the number, `*` and `?` stand in the file name only: write the folder out".to_owned(),
        });
    }
    Ok(())
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
    let number = match Name::split(name) {
        Some(name) => parse_number(name.digits, &path)?,
        None => FrameNumber::ONE,
    };
    Ok(vec![FrameFile { number, path }])
}

/// The meshes of a folder whose names are wanted.
fn in_folder(
    folder: &Path,
    wanted: impl Fn(&str) -> bool,
    wanted_words: String,
) -> Result<Vec<FrameFile>, SequenceError> {
    numbered(folder, |name| is_mesh(name) && wanted(name), wanted_words)
}

/// The files of a folder whose names are wanted; the numbers are found in the names.
fn numbered(
    folder: &Path,
    wanted: impl Fn(&str) -> bool,
    wanted_words: String,
) -> Result<Vec<FrameFile>, SequenceError> {
    let files: Vec<(String, PathBuf)> = list(folder)?.into_iter().filter(|(name, _)| wanted(name)).collect();
    let mut frames = Vec::new();
    let mut sequence: Option<(Name<'_>, &str)> = None;
    for (file, path) in &files {
        let Some(name) = Name::split(file) else { continue };
        let (known, known_file) = sequence.get_or_insert((name, file));
        if (known.prefix, known.suffix) != (name.prefix, name.suffix) {
            return Err(SequenceError::SeveralSequences {
                folder: folder.to_owned(),
                first: known.pattern(known_file),
                second: name.pattern(file),
            });
        }
        frames.push(FrameFile { number: parse_number(name.digits, path)?, path: path.clone() });
    }
    match (frames.is_empty(), files.as_slice()) {
        (false, _) => in_order(frames),
        (true, []) => Err(SequenceError::NothingFound { folder: folder.to_owned(), wanted: wanted_words }),
        (true, [(_, path)]) => Ok(vec![FrameFile { number: FrameNumber::ONE, path: path.clone() }]),
        (true, [(first, _), (second, _), ..]) => Err(SequenceError::Unnumbered {
            folder: folder.to_owned(),
            first: first.clone(),
            second: second.clone(),
        }),
    }
}

/// Sorts by number and refuses numbers that are there twice.
fn in_order(mut frames: Vec<FrameFile>) -> Result<Vec<FrameFile>, SequenceError> {
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
fn list(folder: &Path) -> Result<Vec<(String, PathBuf)>, SequenceError> {
    // An empty path is the current folder.
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let io = |source| SequenceError::Io { folder: folder.to_owned(), source };
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(io)? {
        let entry = entry.map_err(io)?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let unfinished = [".tmp", ".part"].iter().any(|end| name.to_ascii_lowercase().ends_with(end));
        // `Path::is_file` follows links: frames are often linked in from elsewhere.
        if !name.starts_with('.') && !unfinished && entry.path().is_file() {
            files.push((name, entry.path()));
        }
    }
    files.sort_unstable();
    Ok(files)
}

fn parse_number(digits: &str, path: &Path) -> Result<FrameNumber, SequenceError> {
    digits.parse().map_err(|_| SequenceError::Number { path: path.to_owned(), digits: digits.to_owned() })
}

/// A name without `.gz` and without its extension, and the extension.
fn split_extension(name: &str) -> (&str, &str) {
    let gz = name.len() >= 3
        && name.is_char_boundary(name.len() - 3)
        && name[name.len() - 3..].eq_ignore_ascii_case(".gz");
    let bare = if gz { &name[..name.len() - 3] } else { name };
    bare.rsplit_once('.').unwrap_or((bare, ""))
}

fn is_mesh(name: &str) -> bool {
    let (_, extension) = split_extension(name);
    MESH_EXTENSIONS.iter().any(|known| extension.eq_ignore_ascii_case(known))
}

/// The stem of a file name, cut at its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Name<'n> {
    prefix: &'n str,
    digits: &'n str,
    suffix: &'n str,
}

impl<'n> Name<'n> {
    /// Cuts a file name at the last number of its stem; `None` when it has no digits.
    fn split(file: &'n str) -> Option<Self> {
        let (stem, _) = split_extension(file);
        let end = stem.rfind(|c: char| c.is_ascii_digit())? + 1;
        let whole = run_start(&stem[..end]);
        let start = decimal_start(stem, whole).unwrap_or(whole);
        Some(Self { prefix: &stem[..start], digits: &stem[start..end], suffix: &stem[end..] })
    }

    /// The pattern that names the sequence of this file.
    fn pattern(&self, file: &str) -> String {
        let extension = &file[split_extension(file).0.len()..];
        let width = self.digits.split('.').next().map_or(1, str::len);
        format!("{}{}{}{extension}", self.prefix, "#".repeat(width), self.suffix)
    }
}

/// Where the digits at the end of `text` start.
fn run_start(text: &str) -> usize {
    text.trim_end_matches(|c: char| c.is_ascii_digit()).len()
}

/// Where a decimal number starts whose decimals start at `decimals`; `None` when it is a whole number.
fn decimal_start(stem: &str, decimals: usize) -> Option<usize> {
    let before = stem[..decimals].strip_suffix('.')?;
    let start = run_start(before);
    let version = before[..start].chars().next_back().is_some_and(|c| c.is_alphabetic() || c == '.');
    (start < before.len() && !version).then_some(start)
}

#[cfg(test)]
mod tests;
