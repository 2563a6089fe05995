//! How much a mesh file may claim.
//!
//! Nothing is allocated because a file says so: a declared count is first compared with the bytes that are there.

use super::error::{Fault, Place};

/// Most triangles of a mesh: corners are numbered with 32 bits.
pub(super) const MAX_TRIANGLES: usize = (u32::MAX / 3) as usize;

/// Most vertices of a mesh: their indices have 32 bits.
pub(super) const MAX_VERTICES: usize = u32::MAX as usize;

/// The most bytes that a gzip file may expand to: 64 MiB and a hundred times its own size.
///
/// Binary meshes shrink to between a half and a fifth, the most regular text to a thirtieth. Deflate reaches a
/// thousandth only on runs of one byte, which no mesh is.
pub(super) fn decompressed_limit(compressed: usize) -> u64 {
    (64 << 20) + 100 * compressed as u64
}

/// Refuses a count that the remaining bytes cannot hold, or that 32-bit indices cannot number.
///
/// `least_bytes` is the least size of one element; `most` the greatest count for any size of file.
pub(super) fn check_count(
    name: &str,
    count: usize,
    least_bytes: usize,
    remaining: usize,
    most: usize,
) -> Result<(), Fault> {
    let needed = count as u128 * least_bytes as u128;
    if needed > remaining as u128 {
        let fit = remaining / least_bytes.max(1);
        return Err(Fault::malformed(
            Place::element(name, fit),
            format!(
                "the file ends early: {count} are declared, at most {fit} fit in the {remaining} bytes left"
            ),
            "the file is truncated or its header wrong; write it again",
        ));
    }
    if count > most {
        return Err(Fault::too_large(
            Place::element(name, most),
            format!("{count} are declared, at most {most} can be numbered"),
            "split the mesh into several files",
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::error::Blame;

    #[test]
    fn counts_beyond_the_file_are_refused_without_overflow() {
        assert!(check_count("vertex", 10, 12, 120, MAX_VERTICES).is_ok());
        let fault = check_count("vertex", 10, 12, 119, MAX_VERTICES).unwrap_err();
        assert_eq!((fault.blame, fault.place), (Blame::Malformed, Place::element("vertex", 9)));
        assert!(check_count("face", usize::MAX, usize::MAX, usize::MAX, MAX_TRIANGLES).is_err());
    }

    #[test]
    fn counts_beyond_the_indices_are_refused() {
        let fault = check_count("vertex", 11, 1, 1000, 10).unwrap_err();
        assert_eq!(fault.blame, Blame::TooLarge);
    }
}
