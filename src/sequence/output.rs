//! File names of single frames: pictures, and surfaces with one mesh a frame.
//!
//! The place of the number (`####`, `%04d`, `$F4`) stands in the file name, the last part of the path.
//! Padding grows with the number, and decimal numbers keep their decimals: frame 12.5 of `a_####.exr` is
//! `a_0012.5.exr`.

use super::pattern::NamePattern;
use super::{FrameNumber, SequenceError};

/// Whether the file name of a pattern has a place for the frame number.
pub fn has_place(pattern: &str) -> bool {
    // Two places are a place too; what uses the pattern reports that there is one too many.
    NamePattern::find(split_path(pattern).1).map_or(true, |place| place.is_some())
}

/// Checks that an output pattern can name `frames` frames.
///
/// # Errors
/// [`SequenceError::NoPlace`] when several frames would go to one file, [`SequenceError::Pattern`] when the
/// name is empty or has two places.
pub fn check_output_pattern(pattern: &str, frames: usize) -> Result<(), SequenceError> {
    let (folder, name) = split_path(pattern);
    if name.is_empty() {
        let reason = "it names a folder: add a file name such as frame_####.exr".to_owned();
        return Err(SequenceError::Pattern { pattern: pattern.to_owned(), reason });
    }
    if NamePattern::find(name)?.is_none() && frames > 1 {
        let example = match name.rsplit_once('.') {
            Some((stem, extension)) => format!("{folder}{stem}_####.{extension}"),
            None => format!("{folder}{name}_####.exr"),
        };
        return Err(SequenceError::NoPlace { pattern: pattern.to_owned(), frames, example });
    }
    Ok(())
}

/// The path of one frame's picture; a pattern without a place is returned as it is.
pub fn output_path(pattern: &str, number: FrameNumber) -> String {
    let (folder, name) = split_path(pattern);
    match NamePattern::find(name) {
        Ok(Some(place)) => format!("{folder}{}", place.expand(number)),
        Ok(None) | Err(_) => pattern.to_owned(),
    }
}

/// The path of a surface's mesh in one frame; a mesh without a place is the same in every frame.
///
/// # Errors
/// [`SequenceError::Pattern`] when the name has two places.
pub fn frame_path(pattern: &str, number: FrameNumber) -> Result<String, SequenceError> {
    NamePattern::find(split_path(pattern).1)?;
    Ok(output_path(pattern, number))
}

/// The folder with its separator, and the file name.
pub(super) fn split_path(path: &str) -> (&str, &str) {
    let end = path.rfind(std::path::is_separator).map_or(0, |separator| separator + 1);
    path.split_at(end)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(text: &str) -> FrameNumber {
        text.parse().unwrap()
    }

    #[test]
    fn padding_grows_and_folders_stay() {
        for (pattern, n, path) in [
            ("out/frame_####.exr", "7", "out/frame_0007.exr"),
            ("out/frame_####.exr", "123456", "out/frame_123456.exr"),
            ("frame_%04d.exr", "12.5", "frame_0012.5.exr"),
            ("frame_$F4.exr", "-3", "frame_-0003.exr"),
            ("frame_$F.exr", "30", "frame_30.exr"),
            ("shot#1/frame_%d.exr", "3", "shot#1/frame_3.exr"),
            ("still.exr", "3", "still.exr"),
        ] {
            assert_eq!(output_path(pattern, number(n)), path);
            assert_eq!(frame_path(pattern, number(n)).unwrap(), path);
        }
    }

    #[test]
    fn several_frames_need_a_place() {
        assert!(check_output_pattern("still.exr", 1).is_ok());
        assert!(check_output_pattern("out/frame_%04d.exr", 24).is_ok());
        let error = check_output_pattern("out/still.exr", 24).unwrap_err().to_string();
        assert_eq!(
            error,
            "the output `out/still.exr` has no place for the number of 24 frames: write for example `out/still_####.exr`"
        );
        assert!(check_output_pattern("shot#1/still.exr", 2).is_err());
        assert!(check_output_pattern("out/", 1).unwrap_err().to_string().contains("names a folder"));
        assert!(check_output_pattern("##_##.exr", 2).unwrap_err().to_string().contains("two places"));
        assert!(frame_path("##_##.ply", FrameNumber::ONE).is_err());
        assert!(has_place("a/b_####.ply") && !has_place("a#/b.ply"));
    }
}
