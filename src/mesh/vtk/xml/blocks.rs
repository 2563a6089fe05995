//! The bytes of an array, encoded and compressed or not.
//!
//! ```text
//! bytes, data                                                       not compressed
//! blocks, block size, size of the last, compressed sizes .., data   compressed by zlib, block by block
//! ```
//! The numbers in front are all of the file's `header_type`; a last size of 0 is that of the others. Base64
//! encodes such a header apart from the data of compressed arrays and together with that of others; where
//! writers encode it apart there too, its padding shows it.

use std::borrow::Cow;
use std::io::Read;

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use flate2::bufread::ZlibDecoder;

use crate::mesh::error::{Fault, Place};
use crate::mesh::vtk::number::{ByteOrder, unsigned};

const WRITE_AGAIN: &str = "the file is truncated or damaged; write it again";

/// Takes groups from within a text, whose end is no end of the encoding.
const ENGINE: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

/// How a file stores its arrays.
#[derive(Clone, Debug)]
pub(super) struct Storage {
    pub order: ByteOrder,
    /// Bytes of a number of a header.
    pub header: usize,
    pub zlib: bool,
}

/// An array and all that follows it.
#[derive(Clone, Debug)]
pub(super) enum Encoded<'a> {
    Raw(&'a [u8]),
    Base64(Cow<'a, [u8]>),
}

impl<'a> Encoded<'a> {
    /// Base64 with any white space in it.
    pub fn base64(text: &'a str) -> Self {
        let text = text.trim();
        if text.as_bytes().iter().any(u8::is_ascii_whitespace) {
            return Self::Base64(Cow::Owned(text.bytes().filter(|b| !b.is_ascii_whitespace()).collect()));
        }
        Self::Base64(Cow::Borrowed(text.as_bytes()))
    }

    /// The first `count` bytes, which were encoded as one or begin what was, and where the next ones begin.
    fn bytes(&self, from: usize, count: usize) -> Result<(Cow<'_, [u8]>, usize), Fault> {
        let (data, length) = match self {
            Self::Raw(data) => (*data, Some(count)),
            Self::Base64(text) => (text.as_ref(), count.div_ceil(3).checked_mul(4)),
        };
        let end = length.and_then(|length| from.checked_add(length));
        let Some(run) = end.and_then(|end| data.get(from..end)) else {
            let left = data.len().saturating_sub(from);
            let problem = format!("{count} bytes are announced, the {left} that are left hold fewer");
            return Err(Fault::malformed(Place::File, problem, WRITE_AGAIN));
        };
        let end = from + run.len();
        if let Self::Raw(_) = self {
            return Ok((Cow::Borrowed(run), end));
        }
        let decoded = ENGINE
            .decode(run)
            .map_err(|error| Fault::malformed(Place::File, format!("no base64: {error}"), WRITE_AGAIN))?;
        if decoded.len() < count {
            let problem = format!("base64 ends after {} bytes of {count}", decoded.len());
            return Err(Fault::malformed(Place::File, problem, WRITE_AGAIN));
        }
        Ok((Cow::Owned(decoded), end))
    }
}

/// The bytes of an array, which must be `expected` many and, decompressed, at most `limit`.
pub(super) fn read(
    encoded: Encoded,
    storage: &Storage,
    expected: usize,
    limit: u64,
) -> Result<Vec<u8>, Fault> {
    let (first, after) = encoded.bytes(0, storage.header)?;
    let announced = unsigned(&first[..storage.header], storage.order);
    if storage.zlib {
        return decompressed(&encoded, storage, announced, expected, limit);
    }
    check_size(u128::from(announced), expected)?;
    // Where base64 goes on, the last group of the header begins the data.
    let apart = first.len() == storage.header;
    let (from, skipped) = if apart { (after, 0) } else { (0, storage.header) };
    // What is beyond all numbers is beyond the bytes that are there.
    let (bytes, _) = encoded.bytes(from, skipped.saturating_add(expected))?;
    Ok(bytes[skipped..][..expected].to_vec())
}

fn check_size(announced: u128, expected: usize) -> Result<(), Fault> {
    if announced == expected as u128 {
        return Ok(());
    }
    let problem = format!("{announced} bytes, but the counts of the piece need {expected}");
    Err(Fault::malformed(Place::File, problem, WRITE_AGAIN))
}

fn decompressed(
    encoded: &Encoded,
    storage: &Storage,
    blocks: u64,
    expected: usize,
    limit: u64,
) -> Result<Vec<u8>, Fault> {
    let length = blocks.checked_add(3).and_then(|n| usize::try_from(n).ok()?.checked_mul(storage.header));
    let Some(length) = length else {
        let problem = format!("{blocks} compressed blocks");
        return Err(Fault::malformed(Place::File, problem, WRITE_AGAIN));
    };
    let (header, from) = encoded.bytes(0, length)?;
    let numbers = header[..length].chunks_exact(storage.header).map(|bytes| unsigned(bytes, storage.order));
    let numbers = Vec::from_iter(numbers);
    let (block, last, sizes) = (numbers[1], numbers[2], &numbers[3..]);
    let last = if last == 0 { block } else { last };
    let total = u128::from(block) * u128::from(blocks.saturating_sub(1)) + u128::from(last);
    check_size(if blocks == 0 { 0 } else { total }, expected)?;
    if expected as u64 > limit {
        let problem = format!("compressed bytes hold {expected}, more than {limit}");
        let cure = "no mesh shrinks that much; write the file without compression if it really is one";
        return Err(Fault::too_large(Place::File, problem, cure));
    }
    let compressed =
        sizes.iter().try_fold(0_usize, |sum, &size| sum.checked_add(usize::try_from(size).ok()?));
    let (data, _) = encoded.bytes(from, compressed.unwrap_or(usize::MAX))?;
    let mut rest = &data[..];
    let mut bytes = Vec::new();
    for (index, &size) in sizes.iter().enumerate() {
        let (run, after) = rest.split_at(size as usize);
        let wanted = if index + 1 == sizes.len() { last } else { block };
        inflate(run, wanted, &mut bytes).map_err(|problem| {
            Fault::malformed(Place::File, format!("compressed block {index}: {problem}"), WRITE_AGAIN)
        })?;
        rest = after;
    }
    Ok(bytes)
}

/// Appends what a block holds, which must be `wanted` bytes.
fn inflate(block: &[u8], wanted: u64, bytes: &mut Vec<u8>) -> Result<(), String> {
    let before = bytes.len();
    let result = ZlibDecoder::new(block).take(wanted.saturating_add(1)).read_to_end(bytes);
    match result {
        Err(error) => Err(error.to_string()),
        Ok(_) if (bytes.len() - before) as u64 != wanted => {
            Err(format!("{} bytes or more, {wanted} are announced", bytes.len() - before))
        }
        Ok(_) => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use base64::engine::general_purpose::STANDARD as WRITER;

    use super::*;

    fn decoded(encoded: Encoded, header: usize, expected: usize) -> Result<Vec<u8>, String> {
        let storage = Storage { order: ByteOrder::Little, header, zlib: false };
        read(encoded, &storage, expected, 1000).map_err(|fault| fault.problem)
    }

    #[test]
    fn data_of_any_length_follows_its_header_in_base64() {
        for length in 0..40_usize {
            let data: Vec<u8> = (0..length as u8).collect();
            for header in [(length as u32).to_le_bytes().to_vec(), (length as u64).to_le_bytes().to_vec()] {
                let together = WRITER.encode([&header[..], &data].concat());
                let apart = WRITER.encode(&header) + &WRITER.encode(&data);
                let spaced = format!(" {}\n {} ", &together[..4], &together[4..]);
                for text in [&together, &apart, &spaced] {
                    assert_eq!(decoded(Encoded::base64(text), header.len(), length).as_ref(), Ok(&data));
                }
                let raw = [&header[..], &data, b"more"].concat();
                assert_eq!(decoded(Encoded::Raw(&raw), header.len(), length), Ok(data.clone()));
                assert!(
                    decoded(
                        Encoded::Raw(&raw[..header.len() + length.saturating_sub(1)]),
                        header.len(),
                        length + 1
                    )
                    .is_err()
                );
            }
        }
    }

    #[test]
    fn announced_sizes_are_compared_before_anything_is_read() {
        let text = WRITER.encode([&2_000_000_000_u32.to_le_bytes()[..], &[7; 20]].concat());
        let problem = decoded(Encoded::base64(&text), 4, 20).unwrap_err();
        assert_eq!(problem, "2000000000 bytes, but the counts of the piece need 20");
        let problem = decoded(Encoded::base64(&text), 4, 2_000_000_000).unwrap_err();
        assert_eq!(problem, "2000000004 bytes are announced, the 32 that are left hold fewer");
    }
    #[test]
    fn sizes_at_the_end_of_all_numbers_are_refused() {
        for expected in [usize::MAX, usize::MAX - 7, usize::MAX - 8, usize::MAX / 3] {
            let bytes = [&(expected as u64).to_le_bytes()[..], &[0; 10]].concat();
            let text = WRITER.encode(&bytes);
            for encoded in [Encoded::base64(&text), Encoded::Raw(&bytes)] {
                let problem = decoded(encoded, 8, expected).unwrap_err();
                assert!(problem.contains("bytes are announced"), "{problem}");
            }
        }
    }
}
