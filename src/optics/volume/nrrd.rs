//! NRRD with its data attached: raw and gzip encodings, `float`, `double` and `uint8`, either byte order `[NRRD]`.
//!
//! Unsigned bytes are shares of 255. Spacings, directions and the like are passed over: the scene file says where the
//! grid is. Axis 0, the fastest, is x.

use std::io::{self, Read};

use flate2::read::MultiGzDecoder;

use super::Volume;
use super::error::{Fault, excerpt};
use super::numbers::{Layout, Scalar};

/// What a file starts with.
pub(super) const MAGIC: &[u8] = b"NRRD";

/// Longest header that is read.
const LONGEST_HEADER: usize = 1 << 16;

/// How the numbers are packed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Encoding {
    Raw,
    Gzip,
}

/// A type of numbers before the byte order is known.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Type {
    U8,
    F32,
    F64,
}

/// A line of the header with its number.
type Line<'t> = (usize, &'t str);

/// What the header has said so far.
#[derive(Default)]
struct Header {
    kind: Option<Type>,
    dimension: Option<usize>,
    size: Option<Vec<usize>>,
    encoding: Option<Encoding>,
    big_endian: Option<bool>,
}

/// Reads the contents of a file.
pub(super) fn read(bytes: &[u8]) -> Result<Volume, Fault> {
    let (lines, data) = lines(bytes)?;
    let mut header = Header::default();
    for (number, line) in lines {
        header.take(line).map_err(|fault| fault.at_line(number))?;
    }
    let (layout, encoding) = header.layout()?;
    match encoding {
        Encoding::Raw => layout.volume(data),
        Encoding::Gzip => layout.volume(&decompressed(data, layout.bytes()?)?),
    }
}

/// The numbered lines of the header behind the first, and the bytes behind the empty line that ends it.
fn lines(bytes: &[u8]) -> Result<(Vec<Line<'_>>, &[u8]), Fault> {
    let mut lines = Vec::new();
    let (mut start, mut number) = (0, 0);
    loop {
        number += 1;
        let rest = &bytes[start..bytes.len().min(LONGEST_HEADER)];
        let Some(length) = rest.iter().position(|&b| b == b'\n') else {
            let problem = format!("line {number}: no empty line ends the header");
            return Err(Fault::Malformed(problem, "the file is truncated; write it again"));
        };
        let line = rest[..length].strip_suffix(b"\r").unwrap_or(&rest[..length]);
        start += length + 1;
        if line.is_empty() {
            return Ok((lines, &bytes[start..]));
        }
        let line = std::str::from_utf8(line).map_err(|_| {
            Fault::Malformed(format!("line {number}: not text"), "write an NRRD header in UTF-8")
        })?;
        match number {
            1 if !matches!(line, "NRRD0001" | "NRRD0002" | "NRRD0003" | "NRRD0004" | "NRRD0005") => {
                let problem = format!("line 1: `{}`", excerpt(line));
                return Err(Fault::Unsupported(problem, "the versions NRRD0001 to NRRD0005 are read"));
            }
            1 => (),
            _ => lines.push((number, line)),
        }
    }
}

impl Header {
    /// A line of the header.
    fn take(&mut self, line: &str) -> Result<(), Fault> {
        if line.starts_with('#') || line.contains(":=") {
            return Ok(());
        }
        let Some((field, value)) = line.split_once(": ") else {
            let problem = format!("`{}` is not of the form `field: value`", excerpt(line));
            return Err(Fault::Malformed(problem, "repair the header"));
        };
        let value = value.trim();
        match field {
            "type" => set(&mut self.kind, field, kind(value)?),
            "dimension" => set(&mut self.dimension, field, count(value)?),
            "sizes" => {
                let sizes = value.split_whitespace().map(count).collect::<Result<_, _>>()?;
                set(&mut self.size, field, sizes)
            }
            "encoding" => set(&mut self.encoding, field, encoding(value)?),
            "endian" => set(&mut self.big_endian, field, endian(value)?),
            "data file" | "datafile" => {
                let problem = format!("the data is in another file, `{}`", excerpt(value));
                Err(Fault::Unsupported(problem, "write header and data as one .nrrd"))
            }
            "line skip" | "lineskip" | "byte skip" | "byteskip" if value != "0" => {
                let problem = format!("{field}: {}", excerpt(value));
                Err(Fault::Unsupported(problem, "write the data right behind the header"))
            }
            _ => Ok(()),
        }
    }

    fn layout(self) -> Result<(Layout, Encoding), Fault> {
        let missing = |field: &str| {
            Fault::Malformed(format!("the header has no `{field}`"), "write the header with all its fields")
        };
        let size = self.size.ok_or_else(|| missing("sizes"))?;
        let dimension = self.dimension.ok_or_else(|| missing("dimension"))?;
        let size = match <[usize; 3]>::try_from(size) {
            Ok(size) if dimension == 3 => size,
            Ok(_) => return Err(not_three(dimension)),
            Err(size) => return Err(not_three(size.len())),
        };
        let order = || self.big_endian.ok_or_else(|| missing("endian"));
        let scalar = match self.kind.ok_or_else(|| missing("type"))? {
            Type::U8 => Scalar::U8,
            Type::F32 => Scalar::F32 { big_endian: order()? },
            Type::F64 => Scalar::F64 { big_endian: order()? },
        };
        let encoding = self.encoding.ok_or_else(|| missing("encoding"))?;
        Ok((Layout { size, scalar, x_fastest: true }, encoding))
    }
}

fn set<T>(place: &mut Option<T>, field: &str, value: T) -> Result<(), Fault> {
    match place.replace(value) {
        None => Ok(()),
        Some(_) => Err(Fault::Malformed(format!("`{field}` stands twice"), "keep one of them")),
    }
}

fn not_three(axes: usize) -> Fault {
    Fault::Invalid(format!("sizes: a grid of {axes} axes, not 3"), "write one density a cell, indexed x y z")
}

fn kind(value: &str) -> Result<Type, Fault> {
    match value {
        "uchar" | "unsigned char" | "uint8" | "uint8_t" => Ok(Type::U8),
        "float" => Ok(Type::F32),
        "double" => Ok(Type::F64),
        _ => {
            let problem = format!("type: {}", excerpt(value));
            Err(Fault::Unsupported(problem, "float, double and uint8 are read"))
        }
    }
}

fn encoding(value: &str) -> Result<Encoding, Fault> {
    match value {
        "raw" => Ok(Encoding::Raw),
        "gzip" | "gz" => Ok(Encoding::Gzip),
        _ => {
            let problem = format!("encoding: {}", excerpt(value));
            Err(Fault::Unsupported(problem, "raw and gzip are read"))
        }
    }
}

fn endian(value: &str) -> Result<bool, Fault> {
    match value {
        "big" => Ok(true),
        "little" => Ok(false),
        _ => Err(Fault::Malformed(format!("endian: {}", excerpt(value)), "write little or big")),
    }
}

fn count(text: &str) -> Result<usize, Fault> {
    let digits = !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    text.parse().ok().filter(|_| digits).ok_or_else(|| {
        Fault::Malformed(format!("`{}` is not a number of cells", excerpt(text)), "write a whole number")
    })
}

/// The data of a gzip stream that holds `expected` bytes; not more than one byte beyond them is ever unpacked.
fn decompressed(data: &[u8], expected: usize) -> Result<Vec<u8>, Fault> {
    let mut inside = Vec::new();
    let result = MultiGzDecoder::new(data).take(expected as u64 + 1).read_to_end(&mut inside);
    match result {
        Ok(_) => Ok(inside),
        Err(error) => {
            let how = if error.kind() == io::ErrorKind::UnexpectedEof { "ends early" } else { "is damaged" };
            let problem = format!("the gzip data {how}, after {} of {expected} bytes", inside.len());
            Err(Fault::Malformed(problem, "the file is truncated or damaged; write it again"))
        }
    }
}

impl Fault {
    fn at_line(self, number: usize) -> Self {
        let at = |problem: String| format!("line {number}: {problem}");
        match self {
            Self::Malformed(problem, cure) => Self::Malformed(at(problem), cure),
            Self::Invalid(problem, cure) => Self::Invalid(at(problem), cure),
            Self::Unsupported(problem, cure) => Self::Unsupported(at(problem), cure),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::Compression;
    use flate2::write::GzEncoder;

    use super::*;

    fn gzip(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    fn file(fields: &str, data: &[u8]) -> Vec<u8> {
        [b"NRRD0004\n# a comment\nkey:=value\n", fields.as_bytes(), b"\n\n", data].concat()
    }

    const FLOATS: &str = "type: float\ndimension: 3\nsizes: 2 3 1\nendian: little\nencoding: raw";

    #[test]
    fn every_type_order_and_encoding() {
        let numbers = [0.0, 0.25, 0.5, 0.75, 1.0, 1.25_f64];
        let le4: Vec<u8> = numbers.iter().flat_map(|v| (*v as f32).to_le_bytes()).collect();
        let be8: Vec<u8> = numbers.iter().flat_map(|v| v.to_be_bytes()).collect();
        let doubles = FLOATS.replace("float", "double").replace("little", "big");
        let packed = FLOATS.replace("raw", "gzip");
        for bytes in [file(FLOATS, &le4), file(&doubles, &be8), file(&packed, &gzip(&le4))] {
            let volume = read(&bytes).unwrap();
            assert_eq!((volume.size, volume.values), ([2, 3, 1], vec![0.0, 0.25, 0.5, 0.75, 1.0, 1.25]));
        }
        let bytes = "type: uint8\r\ndimension: 3\r\nsizes: 3 1 1\r\nspacings: 1 1 1\r\nencoding: raw\r";
        assert_eq!(
            read(&file(bytes, &[0, 51, 255])[..]).map(|v| v.values).unwrap_or_default(),
            vec![0.0, 0.2, 1.0]
        );
    }

    #[test]
    fn what_is_wrong_is_named() {
        let with = |from: &str, to: &str| file(&FLOATS.replace(from, to), &[0; 24]);
        let packed = FLOATS.replace("raw", "gzip");
        let whole = gzip(&[0; 24]);
        let cases: Vec<(Vec<u8>, &str)> = vec![
            (b"NRRD".to_vec(), "line 1: no empty line ends the header"),
            (b"NRRD0009\n\n".to_vec(), "line 1: `NRRD0009`"),
            (b"NRRD0004\nb\xff\n\n".to_vec(), "line 2: not text"),
            (b"NRRD0004\n\n".to_vec(), "the header has no `sizes`"),
            (with("float", "int16"), "line 4: type: int16; float, double and uint8"),
            (with("raw", "bzip2"), "encoding: bzip2; raw and gzip"),
            (with("little", "middle"), "endian: middle"),
            (with("endian: little\n", ""), "the header has no `endian`"),
            (with("2 3 1", "2 3"), "sizes: a grid of 2 axes, not 3"),
            (with("dimension: 3", "dimension: 4"), "a grid of 4 axes, not 3"),
            (with("2 3 1", "2 -3 1"), "line 6: `-3` is not a number of cells"),
            (with("2 3 1", "2 0 1"), "the grid has 2 x 0 x 1 cells"),
            (with("2 3 1", "99999 99999 99999"), "more than 1073741824"),
            (with("2 3 1", "2 3 2"), "24 bytes of data where 2 x 3 x 2 cells of 4 bytes take 48"),
            (with("raw", "raw\ndata file: a.raw"), "the data is in another file, `a.raw`"),
            (with("raw", "raw\nbyte skip: -1"), "byte skip: -1"),
            (with("raw", "raw\ntype: float"), "line 9: `type` stands twice"),
            (with("encoding: raw", "encoding raw"), "`encoding raw` is not of the form"),
            (file(&packed, &whole[..whole.len() - 9]), "the gzip data ends early"),
            (file(&packed, b"not gzip at all"), "the gzip data is damaged"),
            (file(&packed, &gzip(&vec![0; 1 << 20])), "25 bytes of data where 2 x 3 x 1 cells"),
        ];
        for (bytes, expected) in cases {
            let message = read(&bytes).unwrap_err().in_file(std::path::Path::new("p.nrrd")).to_string();
            assert!(
                message.starts_with("p.nrrd: ") && message.contains(expected),
                "{message}: not {expected}"
            );
        }
    }

    #[test]
    fn damage_is_never_a_panic() {
        let whole = file(FLOATS, &[0; 24]);
        assert!(read(&whole).is_ok());
        for at in 0..whole.len() {
            assert!(read(&whole[..at]).is_err());
            for byte in [0, b'\n', b':', b'9', 255] {
                let mut damaged = whole.clone();
                damaged[at] = byte;
                let _ = read(&damaged);
            }
        }
    }
}
