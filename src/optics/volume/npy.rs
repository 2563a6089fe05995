//! NumPy's `.npy`: versions 1 to 3, single and double precision, either byte order, C and Fortran order `[NPY]`.
//!
//! The header is a Python dictionary of three entries; exactly these are read, in any order.

use super::Volume;
use super::error::{Fault, excerpt};
use super::numbers::{Layout, Scalar};

/// What a file starts with.
pub(super) const MAGIC: &[u8] = b"\x93NUMPY";

const WRITE_AGAIN: &str = "the file is truncated or not written by NumPy; write it again with numpy.save";
const SCALARS: &str = "convert the array with .astype('float32')";

/// Reads the contents of a file.
pub(super) fn read(bytes: &[u8]) -> Result<Volume, Fault> {
    let (header, data) = header(bytes)?;
    layout(header)?.volume(data)
}

/// The header's text, and what follows it.
fn header(bytes: &[u8]) -> Result<(&str, &[u8]), Fault> {
    let early =
        || Fault::Malformed(format!("the header ends early, after {} bytes", bytes.len()), WRITE_AGAIN);
    let rest = bytes.get(MAGIC.len()..).ok_or_else(early)?;
    let (length, rest) = match rest {
        [1, 0, a, b, rest @ ..] => (usize::from(u16::from_le_bytes([*a, *b])), rest),
        [2 | 3, 0, a, b, c, d, rest @ ..] => (u32::from_le_bytes([*a, *b, *c, *d]) as usize, rest),
        [major, minor, ..] if !matches!((major, minor), (1..=3, 0)) => {
            let problem = format!("format version {major}.{minor}");
            return Err(Fault::Unsupported(problem, "versions 1.0, 2.0 and 3.0 are read"));
        }
        _ => return Err(early()),
    };
    let text = rest.get(..length).ok_or_else(|| {
        let problem = format!("a header of {length} bytes is declared, {} are left", rest.len());
        Fault::Malformed(problem, WRITE_AGAIN)
    })?;
    let text = std::str::from_utf8(text)
        .map_err(|_| Fault::Malformed("the header is not text".to_owned(), WRITE_AGAIN))?;
    Ok((text, &rest[length..]))
}

/// `{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4, 5), }`
fn layout(header: &str) -> Result<Layout, Fault> {
    let wrong = |part: &str| {
        let problem = format!("header `{}`: no array is described by `{}`", excerpt(header), excerpt(part));
        Fault::Malformed(problem, WRITE_AGAIN)
    };
    let inside = header.trim().strip_prefix('{').and_then(|h| h.strip_suffix('}'));
    let mut rest = inside.ok_or_else(|| wrong(header))?.trim_start();
    let (mut scalar, mut x_fastest, mut size) = (None, None, None);
    while !rest.is_empty() {
        let (key, after) = quoted(rest).ok_or_else(|| wrong(rest))?;
        let value = after.trim_start().strip_prefix(':').ok_or_else(|| wrong(rest))?.trim_start();
        rest = match key {
            "descr" if scalar.is_none() => {
                let (descr, after) = quoted(value).ok_or_else(|| unsupported_type(value))?;
                scalar = Some(scalar_of(descr)?);
                after
            }
            "fortran_order" if x_fastest.is_none() => {
                let (fortran, after) = boolean(value).ok_or_else(|| wrong(value))?;
                x_fastest = Some(fortran);
                after
            }
            "shape" if size.is_none() => {
                let (shape, after) = shape(value).ok_or_else(|| wrong(value))?;
                size = Some(three_axes(&shape)?);
                after
            }
            _ => return Err(wrong(rest)),
        };
        rest = rest.trim_start();
        rest = match rest.strip_prefix(',') {
            Some(after) => after.trim_start(),
            None if rest.is_empty() => rest,
            None => return Err(wrong(rest)),
        };
    }
    match (size, scalar, x_fastest) {
        (Some(size), Some(scalar), Some(x_fastest)) => Ok(Layout { size, scalar, x_fastest }),
        _ => Err(wrong(header)),
    }
}

/// A text in quotes, and what follows.
fn quoted(text: &str) -> Option<(&str, &str)> {
    let quote = text.chars().next().filter(|c| matches!(c, '\'' | '"'))?;
    text[1..].split_once(quote)
}

fn boolean(text: &str) -> Option<(bool, &str)> {
    let is = |word| text.strip_prefix(word);
    is("True").map(|rest| (true, rest)).or_else(|| is("False").map(|rest| (false, rest)))
}

/// `(3, 4, 5)` with an optional last comma.
fn shape(text: &str) -> Option<(Vec<usize>, &str)> {
    let (inside, rest) = text.strip_prefix('(')?.split_once(')')?;
    let inside = inside.trim();
    let inside = inside.strip_suffix(',').unwrap_or(inside);
    if inside.is_empty() {
        return Some((Vec::new(), rest));
    }
    let digits = |n: &str| n.bytes().all(|b| b.is_ascii_digit()).then(|| n.parse().ok()).flatten();
    let sizes: Option<Vec<usize>> = inside.split(',').map(|n| digits(n.trim())).collect();
    Some((sizes?, rest))
}

fn three_axes(shape: &[usize]) -> Result<[usize; 3], Fault> {
    <[usize; 3]>::try_from(shape).map_err(|_| {
        let problem = format!("shape: an array of {} axes, not 3", shape.len());
        Fault::Invalid(problem, "write an array indexed [x, y, z]")
    })
}

fn scalar_of(descr: &str) -> Result<Scalar, Fault> {
    match descr {
        "<f4" => Ok(Scalar::F32 { big_endian: false }),
        ">f4" => Ok(Scalar::F32 { big_endian: true }),
        "<f8" => Ok(Scalar::F64 { big_endian: false }),
        ">f8" => Ok(Scalar::F64 { big_endian: true }),
        _ => Err(unsupported_type(descr)),
    }
}

fn unsupported_type(descr: &str) -> Fault {
    Fault::Unsupported(format!("descr: numbers of type `{}`", excerpt(descr)), SCALARS)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(version: u8, header: &str, data: &[u8]) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend([version, 0]);
        let length = header.len() as u32;
        bytes.extend(&length.to_le_bytes()[..if version == 1 { 2 } else { 4 }]);
        bytes.extend(header.as_bytes());
        bytes.extend(data);
        bytes
    }

    fn dictionary(descr: &str, fortran: &str, shape: &str) -> String {
        format!("{{'descr': '{descr}', 'fortran_order': {fortran}, 'shape': {shape}, }}          \n")
    }

    /// The same numbers in every way of writing them down.
    #[test]
    fn every_order_type_and_version() {
        let numbers: Vec<f64> = (0..6).map(|i| f64::from(i) * 0.25).collect();
        for (descr, width) in [("<f4", 4), (">f4", 4), ("<f8", 8), (">f8", 8)] {
            let data: Vec<u8> = numbers
                .iter()
                .flat_map(|&v| match (width, descr.starts_with('>')) {
                    (4, true) => (v as f32).to_be_bytes().to_vec(),
                    (4, false) => (v as f32).to_le_bytes().to_vec(),
                    (_, true) => v.to_be_bytes().to_vec(),
                    (_, false) => v.to_le_bytes().to_vec(),
                })
                .collect();
            for version in [1, 2, 3] {
                let fortran = read(&file(version, &dictionary(descr, "True", "(2, 3, 1)"), &data)).unwrap();
                assert_eq!(
                    (fortran.size, fortran.values),
                    ([2, 3, 1], vec![0.0, 0.25, 0.5, 0.75, 1.0, 1.25])
                );
                let c = read(&file(version, &dictionary(descr, "False", "(2, 3, 1)"), &data)).unwrap();
                assert_eq!((c.size, c.values), ([2, 3, 1], vec![0.0, 0.75, 0.25, 1.0, 0.5, 1.25]));
            }
        }
    }

    #[test]
    fn what_is_wrong_is_named() {
        let good = dictionary("<f4", "False", "(1, 1, 2)");
        let nan = [f32::NAN.to_le_bytes(), 1.0_f32.to_le_bytes()].concat();
        let negative = [1.0_f32.to_le_bytes(), (-1.0_f32).to_le_bytes()].concat();
        let cases: Vec<(Vec<u8>, &str)> = vec![
            (MAGIC.to_vec(), "the header ends early, after 6 bytes"),
            ([MAGIC, &[1, 0, 9]].concat(), "the header ends early, after 9 bytes"),
            ([MAGIC, &[4, 0, 0, 0, 0, 0]].concat(), "format version 4.0"),
            (
                [MAGIC, &[2, 0, 255, 255, 255, 255, 1]].concat(),
                "a header of 4294967295 bytes is declared, 1 are left",
            ),
            (file(1, "\u{7f}", &[]), "no array is described by"),
            (file(1, &good, &[0; 7]), "7 bytes of data where 1 x 1 x 2 cells of 4 bytes take 8"),
            (file(1, &good, &[0; 9]), "9 bytes of data"),
            (file(1, &good, &nan), "the value of cell (0, 0, 0) is NaN"),
            (file(1, &good, &negative), "the value of cell (0, 0, 1) is -1e0"),
            (file(1, &dictionary("<i4", "False", "(1, 1, 2)"), &[0; 8]), "descr: numbers of type `<i4`"),
            (file(1, &dictionary("|O", "False", "(1, 1, 2)"), &[0; 8]), "descr: numbers of type `|O`"),
            (file(1, &dictionary("<f4", "False", "(2,)"), &[0; 8]), "an array of 1 axes, not 3"),
            (file(1, &dictionary("<f4", "False", "()"), &[0; 8]), "an array of 0 axes, not 3"),
            (file(1, &dictionary("<f4", "False", "(2, 0, 1)"), &[]), "the grid has 2 x 0 x 1 cells"),
            (file(1, &dictionary("<f4", "False", "(-2, 1, 1)"), &[]), "no array is described by `(-2, 1, 1)"),
            (file(1, &dictionary("<f4", "No", "(2, 1, 1)"), &[]), "no array is described by `No"),
            (
                file(1, &dictionary("<f4", "False", "(4294967296, 4294967296, 4294967296)"), &[]),
                "more than 1073741824",
            ),
            (file(1, "{'descr': '<f4', 'shape': (1, 1, 1)}", &[0; 4]), "no array is described by"),
            (
                file(1, "{'descr': '<f4', 'descr': '<f4'}", &[0; 4]),
                "no array is described by `'descr': '<f4'`",
            ),
            (file(1, "{'é': 1}", &[0; 4]), "no array is described by"),
        ];
        for (bytes, expected) in cases {
            let message = read(&bytes).unwrap_err().in_file(std::path::Path::new("p.npy")).to_string();
            assert!(
                message.starts_with("p.npy: ") && message.contains(expected),
                "{message}: not {expected}"
            );
        }
    }

    #[test]
    fn damage_is_never_a_panic() {
        let data: Vec<u8> = (0..24).flat_map(|i| (i as f32).to_le_bytes()).collect();
        let whole = file(1, &dictionary("<f4", "False", "(2, 3, 4)"), &data);
        assert!(read(&whole).is_ok());
        for at in 0..whole.len() {
            assert!(read(&whole[..at]).is_err());
            for byte in [0, b'\'', b'(', b'9', 255] {
                let mut damaged = whole.clone();
                damaged[at] = byte;
                let _ = read(&damaged);
            }
        }
    }
}
