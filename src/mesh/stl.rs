//! Stereolithography files (STL): triangles without shared vertices, binary or as text.
//!
//! ```text
//! 80 bytes, uint32 count, count x (float32 normal[3], float32 corners[3][3], uint16)     least byte first
//! solid NAME  { facet normal X Y Z  outer loop  3 x { vertex X Y Z }  endloop  endfacet }  endsolid NAME
//! ```
//! Binary files may begin with `solid` too. What tells them apart is their length, which their count gives.
//! Vertices of the same position are joined, which is exact: writers repeat the bits of a vertex. Normals of
//! facets say no more than the order of the corners does, and are passed over. (The crate `stl_io` takes every
//! binary file that begins with `solid` for a text, and names no place in its errors.)

use glam::DVec3;

use super::error::{Fault, Place};
use super::limits::{MAX_TRIANGLES, check_count};
use super::words::Words;
use super::{RawMesh, weld};

/// What stands before the triangles of a binary file.
const HEADER: usize = 84;

/// Bytes of a triangle in a binary file.
const RECORD: usize = 50;

const CURE: &str = "a text has 'solid', facets of three vertices each, and 'endsolid'; write the file again";

/// Reads an STL file.
pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, Fault> {
    let count = bytes.get(80..HEADER).map(|c| u32::from_le_bytes([c[0], c[1], c[2], c[3]]) as usize);
    let positions = match count {
        Some(count) if bytes.len() as u64 == (HEADER + RECORD * count) as u64 => {
            read_binary(&bytes[HEADER..], count)?
        }
        _ if is_text(bytes) => read_text(bytes)?,
        _ => return Err(wrong_length(bytes.len(), count)),
    };
    let triangles = (0..positions.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    let mut mesh = RawMesh { positions, triangles, ..RawMesh::default() };
    weld(&mut mesh);
    Ok(mesh)
}

/// Whether a file begins as a text: the headers of binary ones are filled up with zeros or run into numbers.
fn is_text(bytes: &[u8]) -> bool {
    let head = bytes[..bytes.len().min(1024)].trim_ascii_start();
    let begins = head.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    begins && !head.iter().any(|&byte| byte.is_ascii_control() && !byte.is_ascii_whitespace())
}

fn wrong_length(length: usize, count: Option<usize>) -> Fault {
    let problem = match count {
        Some(count) => {
            let expected = HEADER as u64 + RECORD as u64 * count as u64;
            format!("the file has {length} bytes, a binary one of {count} triangles has {expected}")
        }
        None => format!("the file has {length} bytes, the header of a binary one has {HEADER}"),
    };
    Fault::malformed(Place::File, problem, "the file is truncated or no STL file; write it again")
}

fn read_binary(records: &[u8], count: usize) -> Result<Vec<DVec3>, Fault> {
    check_count("triangle", count, RECORD, records.len(), MAX_TRIANGLES)?;
    let mut positions = Vec::with_capacity(3 * count);
    for (index, record) in records.chunks_exact(RECORD).enumerate() {
        for corner in record[12..48].chunks_exact(12) {
            let axis = |k: usize| {
                f64::from(f32::from_le_bytes([corner[k], corner[k + 1], corner[k + 2], corner[k + 3]]))
            };
            let position = DVec3::new(axis(0), axis(4), axis(8));
            if !position.is_finite() {
                let problem = format!("the coordinates {position} are not finite");
                let cure = "the simulation or its writer failed here; coordinates must be finite";
                return Err(Fault::invalid(Place::element("triangle", index), problem, cure));
            }
            positions.push(position);
        }
    }
    Ok(positions)
}

/// Reads the solids of a text, of which there may be several.
fn read_text(bytes: &[u8]) -> Result<Vec<DVec3>, Fault> {
    let mut words = Words::new(bytes, CURE);
    let mut positions = Vec::new();
    while let Some(word) = words.next() {
        if !word.eq_ignore_ascii_case(b"solid") {
            return Err(words.not("'solid'", word));
        }
        words.rest_of_line();
        loop {
            let word = words.value("'facet' or 'endsolid'")?;
            if word.eq_ignore_ascii_case(b"endsolid") {
                words.rest_of_line();
                break;
            }
            if !word.eq_ignore_ascii_case(b"facet") {
                return Err(words.not("'facet' or 'endsolid'", word));
            }
            read_facet(&mut words, &mut positions)?;
        }
    }
    if positions.len() / 3 > MAX_TRIANGLES {
        let problem = format!("more than {MAX_TRIANGLES} triangles");
        return Err(Fault::too_large(Place::File, problem, "split the mesh into several files"));
    }
    Ok(positions)
}

fn read_facet(words: &mut Words, positions: &mut Vec<DVec3>) -> Result<(), Fault> {
    expect(words, "normal")?;
    for _ in 0..3 {
        words.number("a number of the normal")?;
    }
    expect(words, "outer")?;
    expect(words, "loop")?;
    for _ in 0..3 {
        expect(words, "vertex")?;
        positions.push(DVec3::new(words.coordinate()?, words.coordinate()?, words.coordinate()?));
    }
    expect(words, "endloop")?;
    expect(words, "endfacet")
}

fn expect(words: &mut Words, keyword: &str) -> Result<(), Fault> {
    let expected = format!("'{keyword}'");
    let word = words.value(&expected)?;
    if word.eq_ignore_ascii_case(keyword.as_bytes()) { Ok(()) } else { Err(words.not(&expected, word)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A binary file of two triangles that share an edge.
    fn binary(header: &[u8]) -> Vec<u8> {
        let mut file = header.to_vec();
        file.resize(80, b' ');
        file.extend(2_u32.to_le_bytes());
        for corners in [
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0_f32]],
            [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [-0.0, 1.0, 0.0]],
        ] {
            file.extend([0; 12]);
            file.extend(corners.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
            file.extend([0; 2]);
        }
        file
    }

    #[test]
    fn binary_files_that_begin_as_texts_are_binary() {
        for header in ["", "solid", "solid made by something", "SOLID\n facet normal"] {
            let mesh = read(&binary(header.as_bytes())).unwrap();
            assert_eq!(mesh.triangles, [[0, 1, 2], [1, 3, 2]], "{header}");
            assert_eq!(mesh.positions.len(), 4);
        }
    }

    #[test]
    fn a_count_that_the_length_denies_is_named() {
        let mut file = binary(b"solid");
        file[80..84].copy_from_slice(&40_000_000_u32.to_le_bytes());
        let fault = read(&file).unwrap_err();
        assert_eq!(
            fault.problem,
            "the file has 184 bytes, a binary one of 40000000 triangles has 2000000084"
        );
        file.truncate(50);
        assert!(read(&file).is_err());
    }

    #[test]
    fn texts_may_hold_several_solids() {
        let facet =
            "FACET NORMAL nan 0 1 outer loop vertex 0 0 0 vertex 1. 0 0 vertex 0 1e0 0 endloop endfacet";
        let text = format!("  solid a b c\n{facet}\nendsolid a b c\nsolid\n{facet} {facet}\nendsolid\n");
        let mesh = read(text.as_bytes()).unwrap();
        assert_eq!((mesh.positions.len(), mesh.triangles.len()), (3, 3));
        let fault = read(text.replace("1e0", "1e999").as_bytes()).unwrap_err();
        assert_eq!(fault.place, Place::Line(2));
        let cut = text.rfind("endsolid").unwrap();
        assert!(read(&text.as_bytes()[..cut]).unwrap_err().problem.contains("ends where"));
    }
}
