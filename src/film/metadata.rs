//! What an image file says about its frame besides the pixels.
//!
//! Nothing here depends on when, where or how fast a frame was made: the same frame is the same file everywhere.

use glam::Mat4;

use super::error::FilmError;

/// Prefix of the attributes that no standard names.
pub const ATTRIBUTE_PREFIX: &str = "floe:";

/// Longest name of an attribute in bytes, its prefix included; longer ones make files that older readers refuse.
pub const ATTRIBUTE_NAME_LIMIT: usize = 31;

/// What the header of a frame's OpenEXR file says.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageMetadata {
    /// Number of the frame.
    pub frame_number: i32,
    /// Frames a second.
    pub fps: f64,
    /// From the world (metres) to the camera, acting on column vectors. OpenEXR's camera space is left-handed: x to
    /// the right, y up, z in the direction of view.
    pub world_to_camera: Mat4,
    /// From the world (metres) to the image plane, acting on column vectors; x and y after division by w are (0, 0)
    /// in the upper left corner and (1, 1) in the lower right one.
    pub world_to_ndc: Mat4,
    /// Names and values of further attributes, written as text. [`ATTRIBUTE_PREFIX`] is added where it is missing.
    pub attributes: Vec<(String, String)>,
}

impl ImageMetadata {
    /// Names with their prefix, and values.
    ///
    /// # Errors
    /// [`FilmError::Attribute`] for a name that is empty, too long, not printable ASCII, or there twice.
    pub fn prefixed_attributes(&self) -> Result<Vec<(String, &str)>, FilmError> {
        let mut named: Vec<(String, &str)> = Vec::with_capacity(self.attributes.len());
        for (name, value) in &self.attributes {
            let bare = name.strip_prefix(ATTRIBUTE_PREFIX).unwrap_or(name);
            let full = format!("{ATTRIBUTE_PREFIX}{bare}");
            let fault = if bare.is_empty() {
                Some("is empty")
            } else if full.len() > ATTRIBUTE_NAME_LIMIT {
                Some("is longer than 31 bytes with its prefix")
            } else if !bare.bytes().all(|b| b.is_ascii_graphic()) {
                Some("has characters that are not printable ASCII")
            } else if named.iter().any(|(other, _)| *other == full) {
                Some("is there twice")
            } else {
                None
            };
            match fault {
                Some(reason) => return Err(FilmError::Attribute { name: full, reason }),
                None => named.push((full, value)),
            }
        }
        Ok(named)
    }
}

/// Frames a second as a fraction; `None` when it is not positive or beyond what the format holds.
///
/// Rates next to n 1000 / 1001 (23.976, 29.97, 59.94) are taken for these; others are rounded to 1/1000.
pub fn frame_rate(fps: f64) -> Option<(i32, u32)> {
    if !(0.001..=1e6).contains(&fps) {
        return None;
    }
    let nominal = fps.round();
    if fps != nominal && nominal >= 1.0 && (fps - nominal * 1000.0 / 1001.0).abs() < 0.005 {
        return Some((nominal as i32 * 1000, 1001));
    }
    let thousandths = (fps * 1000.0).round() as i32;
    let divisor = greatest_common_divisor(thousandths, 1000);
    Some((thousandths / divisor, (1000 / divisor) as u32))
}

fn greatest_common_divisor(a: i32, b: i32) -> i32 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

/// Hours, minutes, seconds and frames of a non-drop time code; frame 0 is 00:00:00:00 and a day wraps.
///
/// Counts `fps` rounded to whole frames in a second `[SMPTE12M]`. `None` outside 1 to 30 frames a second, which is all
/// that a time code holds.
pub fn time_code(frame_number: i32, fps: f64) -> Option<[u8; 4]> {
    let rate = fps.round();
    if !(1.0..=30.0).contains(&rate) {
        return None;
    }
    let rate = rate as i64;
    let frames = i64::from(frame_number).rem_euclid(24 * 3600 * rate);
    let seconds = frames / rate;
    Some([seconds / 3600, seconds / 60 % 60, seconds % 60, frames % rate].map(|part| part as u8))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with_attributes(attributes: &[&str]) -> ImageMetadata {
        ImageMetadata {
            frame_number: 1,
            fps: 24.0,
            world_to_camera: Mat4::IDENTITY,
            world_to_ndc: Mat4::IDENTITY,
            attributes: attributes.iter().map(|name| (String::from(*name), String::from("value"))).collect(),
        }
    }

    #[test]
    fn rates_become_the_fractions_that_broadcasters_use() {
        let cases = [
            (24.0, Some((24, 1))),
            (23.976, Some((24_000, 1001))),
            (29.97, Some((30_000, 1001))),
            (59.94, Some((60_000, 1001))),
            (12.5, Some((25, 2))),
            (0.1, Some((1, 10))),
            (0.0, None),
            (-24.0, None),
            (f64::NAN, None),
            (f64::INFINITY, None),
        ];
        for (fps, fraction) in cases {
            assert_eq!(frame_rate(fps), fraction, "{fps}");
        }
    }

    #[test]
    fn time_codes_count_whole_frames() {
        assert_eq!(time_code(0, 24.0), Some([0, 0, 0, 0]));
        assert_eq!(time_code(23, 24.0), Some([0, 0, 0, 23]));
        assert_eq!(time_code(24 * 3661 + 5, 24.0), Some([1, 1, 1, 5]));
        assert_eq!(time_code(30, 29.97), Some([0, 0, 1, 0]));
        assert_eq!(time_code(-1, 25.0), Some([23, 59, 59, 24]));
        assert_eq!(time_code(i32::MAX, 1.0).map(|code| code[3]), Some(0));
        assert_eq!(time_code(1, 60.0), None);
        assert_eq!(time_code(1, f64::NAN), None);
    }

    #[test]
    fn names_get_their_prefix_once() {
        let metadata = with_attributes(&["scene", "floe:seed"]);
        let names: Vec<String> =
            metadata.prefixed_attributes().unwrap().into_iter().map(|(n, _)| n).collect();
        assert_eq!(names, ["floe:scene", "floe:seed"]);
    }

    #[test]
    fn names_that_the_format_cannot_hold_are_errors() {
        let longest = "x".repeat(ATTRIBUTE_NAME_LIMIT - ATTRIBUTE_PREFIX.len());
        assert!(with_attributes(&[&longest]).prefixed_attributes().is_ok());
        let too_long = format!("{longest}x");
        for names in [&[""][..], &["floe:"], &[&too_long], &["a b"], &["mod\u{e8}le"], &["seed", "floe:seed"]]
        {
            let error = with_attributes(names).prefixed_attributes().unwrap_err();
            assert!(matches!(error, FilmError::Attribute { .. }), "{names:?}: {error}");
        }
    }
}
