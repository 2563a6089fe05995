//! Which picture is compared with which.

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::error::CompareError;
use crate::film::exr_layers::{StoredPicture, read_layers};
use crate::sequence::{
    FrameFile, FrameNumber, SequenceError, discover, discover_pictures, format_numbers, is_sequence,
};

/// A picture and its reference.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pair {
    /// The number of both, of sequences.
    pub number: Option<FrameNumber>,
    /// The candidate.
    pub a: PathBuf,
    /// The reference.
    pub b: PathBuf,
}

/// Pictures and their references, and which of either have no partner.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pairs {
    /// By their numbers.
    pub pairs: Vec<Pair>,
    /// Frames that A, and that B, does not have and the other has.
    pub missing: [Vec<FrameNumber>; 2],
}

impl Pairs {
    /// Two pictures, or those of two folders or patterns that have the same number.
    ///
    /// # Errors
    /// When there is nothing to compare.
    pub fn find(a: &Path, b: &Path) -> Result<Self, CompareError> {
        let many = [a, b].map(|path| is_sequence(Path::new(""), &path.to_string_lossy()));
        match many {
            [true, true] => Self::of_sequences(a, b),
            [true, false] => Err(CompareError::ManyAndOne { many: a.into(), one: b.into() }),
            [false, true] => Err(CompareError::ManyAndOne { many: b.into(), one: a.into() }),
            [false, false] => Ok(Self {
                pairs: vec![Pair { number: None, a: a.into(), b: b.into() }],
                missing: [Vec::new(), Vec::new()],
            }),
        }
    }

    fn of_sequences(a: &Path, b: &Path) -> Result<Self, CompareError> {
        let [of_a, of_b] = [pictures(a)?, pictures(b)?];
        let numbers = |of: &BTreeMap<FrameNumber, PathBuf>| of.keys().copied().collect::<Vec<_>>();
        let lacking = |of: &BTreeMap<FrameNumber, PathBuf>, all: &BTreeMap<FrameNumber, PathBuf>| {
            numbers(all).into_iter().filter(|number| !of.contains_key(number)).collect()
        };
        let pair = |(number, b): (&FrameNumber, &PathBuf)| {
            let a = of_a.get(number)?.clone();
            Some(Pair { number: Some(*number), a, b: b.clone() })
        };
        let pairs: Vec<Pair> = of_b.iter().filter_map(pair).collect();
        if pairs.is_empty() {
            let [a_frames, b_frames] = [&of_a, &of_b].map(|of| format_numbers(&numbers(of)));
            return Err(CompareError::NothingInCommon { a: a.into(), a_frames, b: b.into(), b_frames });
        }
        Ok(Self { pairs, missing: [lacking(&of_a, &of_b), lacking(&of_b, &of_a)] })
    }
}

/// The numbered pictures of a folder or a pattern; there is at least one.
fn pictures(of: &Path) -> Result<BTreeMap<FrameNumber, PathBuf>, CompareError> {
    let found = if of.is_dir() {
        discover_pictures(of, "exr")
    } else {
        discover(Path::new(""), &of.to_string_lossy())
    };
    let nothing = || CompareError::NoPictures { path: of.into() };
    match found {
        Ok(files) => Ok(files.into_iter().map(|FrameFile { number, path }| (number, path)).collect()),
        Err(SequenceError::NothingFound { .. }) => Err(nothing()),
        Err(SequenceError::Io { source, .. }) if source.kind() == ErrorKind::NotFound => Err(nothing()),
        Err(error) => Err(error.into()),
    }
}

impl Pair {
    /// Both pictures, of one size.
    ///
    /// # Errors
    /// When one is missing, is damaged or is no picture, or they differ in size.
    pub fn read(&self) -> Result<[StoredPicture; 2], CompareError> {
        let [a, b] = [read(&self.a)?, read(&self.b)?];
        let [a_size, b_size] = [&a, &b].map(|picture| [picture.width, picture.height]);
        if a_size == b_size {
            Ok([a, b])
        } else {
            Err(CompareError::Size { a: self.a.clone(), a_size, b: self.b.clone(), b_size })
        }
    }
}

fn read(path: &Path) -> Result<StoredPicture, CompareError> {
    let unreadable = |reason: String| CompareError::Unreadable { path: path.into(), reason };
    let bytes = std::fs::read(path).map_err(|error| match error.kind() {
        ErrorKind::NotFound => CompareError::Missing { path: path.into() },
        _ => unreadable(error.to_string()),
    })?;
    read_layers(&bytes).map_err(unreadable)
}
