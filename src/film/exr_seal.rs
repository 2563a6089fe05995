//! Tells whether an OpenEXR file is the one that was written, to the last byte.
//!
//! A file that was cut short or damaged may still open: its header is whole, decoders fill in what is missing, and rows
//! that did not compress carry no checksum. So a file holds a checksum of all its other bytes,
//!
//! ```text
//! floe:checksum = first 128 bits of SHA-256(every byte before its value, every byte behind it)
//! ```
//!
//! in hexadecimal. Reading it decodes nothing, so nothing in the bytes can do harm.

use std::ops::Range;

use sha2::{Digest, Sha256};

use super::exr_header::{PREAMBLE, attribute_end};

/// Name of the attribute with the checksum.
pub const CHECKSUM: &str = "floe:checksum";

/// What stands in place of the checksum before it is known: as many digits.
pub(super) const UNKNOWN: &str = "00000000000000000000000000000000";

/// The magic number and the version of a single-part file of scan lines, long names allowed or not.
const MAGIC: [u8; 5] = [0x76, 0x2f, 0x31, 0x01, 2];

/// Writes the checksum into a finished file; `None` when it has no place for it.
pub(super) fn seal(file: &mut [u8]) -> Option<()> {
    let place = value_place(file, CHECKSUM)?;
    let checksum = checksum(file, &place);
    (place.len() == checksum.len()).then(|| file[place].copy_from_slice(checksum.as_bytes()))
}

/// Checks that every byte is as it was written.
///
/// # Errors
/// What is wrong, in words.
pub fn check_seal(file: &[u8]) -> Result<(), &'static str> {
    if !file.starts_with(&MAGIC) {
        return Err("it is not an OpenEXR file");
    }
    let place = value_place(file, CHECKSUM).ok_or("its header has no checksum or ends early")?;
    if &file[place.clone()] == checksum(file, &place).as_bytes() {
        Ok(())
    } else {
        Err("its checksum does not match: it was cut short, damaged, or changed by another program")
    }
}

/// The text of an attribute; `None` when there is none, or the bytes are no header. The bytes may end with the header.
pub fn text_attribute<'a>(file: &'a [u8], name: &str) -> Option<&'a str> {
    if !file.starts_with(&MAGIC) {
        return None;
    }
    std::str::from_utf8(&file[value_place(file, name)?]).ok()
}

fn checksum(file: &[u8], place: &Range<usize>) -> String {
    let digest = Sha256::new().chain_update(&file[..place.start]).chain_update(&file[place.end..]).finalize();
    digest.iter().take(UNKNOWN.len() / 2).map(|byte| format!("{byte:02x}")).collect()
}

/// Where the value of a text attribute is.
fn value_place(file: &[u8], name: &str) -> Option<Range<usize>> {
    let wanted = format!("{name}\0string\0");
    let mut at = PREAMBLE;
    while *file.get(at)? != 0 {
        let end = attribute_end(file, at)?;
        if file[at..end].starts_with(wanted.as_bytes()) {
            return Some(at + wanted.len() + size_of::<u32>()..end);
        }
        at = end;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn file(attributes: &[(&str, &str)], pixels: &[u8]) -> Vec<u8> {
        let mut bytes = [&MAGIC[..], &[0; 3]].concat();
        for (name, value) in attributes {
            bytes.extend(format!("{name}\0string\0").into_bytes());
            bytes.extend((value.len() as u32).to_le_bytes());
            bytes.extend(value.as_bytes());
        }
        bytes.push(0);
        [&bytes, pixels].concat()
    }

    fn sealed() -> Vec<u8> {
        let mut file = file(&[("floe:a", "1"), (CHECKSUM, UNKNOWN), ("floe:b", "2")], b"pixels");
        seal(&mut file).unwrap();
        file
    }

    #[test]
    fn every_cut_and_every_changed_byte_is_noticed() {
        let whole = sealed();
        assert_eq!(check_seal(&whole), Ok(()));
        for length in 0..whole.len() {
            assert!(check_seal(&whole[..length]).is_err(), "{length} bytes");
        }
        for at in 0..whole.len() {
            let mut damaged = whole.clone();
            damaged[at] ^= 4;
            assert!(check_seal(&damaged).is_err(), "byte {at}");
        }
        assert!(check_seal(&[&whole[..], b"x"].concat()).is_err());
    }

    #[test]
    fn text_is_found_by_its_name() {
        let whole = sealed();
        assert_eq!(text_attribute(&whole, "floe:a"), Some("1"));
        assert_eq!(text_attribute(&whole, "floe:b"), Some("2"));
        assert_eq!(text_attribute(&whole, "floe:c"), None);
        assert_eq!(seal(&mut file(&[("floe:a", "1")], b"")), None);
        assert_eq!(seal(&mut file(&[(CHECKSUM, "1")], b"")), None);
    }

    proptest! {
        #[test]
        fn nothing_panics(bytes in prop::collection::vec(any::<u8>(), 0..200), cut in 0..90_usize) {
            let _ = (check_seal(&bytes), text_attribute(&bytes, CHECKSUM), seal(&mut bytes.clone()));
            let mixed = [&sealed()[..cut], &bytes].concat();
            let _ = (check_seal(&mixed), text_attribute(&mixed, "floe:b"), seal(&mut mixed.clone()));
        }
    }
}
