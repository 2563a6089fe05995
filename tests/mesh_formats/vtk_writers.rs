//! Writers of VTK's two kinds of files in every encoding, laid out as VTK itself writes them.

use std::fmt::Write as _;
use std::io::Write as _;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;

use crate::sample::Sample;

/// How a legacy file is written.
#[derive(Clone, Copy, Debug)]
pub struct Legacy {
    pub version: &'static str,
    pub binary: bool,
    /// An unstructured grid instead of polygons.
    pub grid: bool,
}

impl Legacy {
    pub const ALL: [Self; 8] = [
        Self::of("4.2", false, false),
        Self::of("4.2", true, false),
        Self::of("5.1", false, false),
        Self::of("5.1", true, false),
        Self::of("4.2", false, true),
        Self::of("4.2", true, true),
        Self::of("5.1", false, true),
        Self::of("5.1", true, true),
    ];

    const fn of(version: &'static str, binary: bool, grid: bool) -> Self {
        Self { version, binary, grid }
    }
}

/// How an XML file is written.
#[derive(Clone, Copy, Debug)]
pub struct Xml {
    pub encoding: Encoding,
    pub zlib: bool,
    pub big: bool,
    /// Headers of 64 bits.
    pub wide: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    Ascii,
    Inline,
    /// As [`Self::Inline`], the header apart from the data.
    InlineApart,
    AppendedRaw,
    AppendedBase64,
}

/// Numbers of a type that both kinds of files have.
enum Numbers {
    I32(Vec<i32>),
    I64(Vec<i64>),
    F32(Vec<f32>),
}

impl Numbers {
    fn floats(vectors: &[[f32; 3]]) -> Self {
        Self::F32(vectors.as_flattened().to_vec())
    }

    fn text(&self) -> String {
        let words: Vec<String> = match self {
            Self::I32(values) => values.iter().map(ToString::to_string).collect(),
            Self::I64(values) => values.iter().map(ToString::to_string).collect(),
            Self::F32(values) => values.iter().map(ToString::to_string).collect(),
        };
        // Nine numbers a line, with a space behind each.
        words.chunks(9).map(|line| line.join(" ") + " \n").collect()
    }

    fn bytes(&self, big: bool) -> Vec<u8> {
        macro_rules! bytes {
            ($values:expr) => {
                $values.iter().flat_map(|x| if big { x.to_be_bytes() } else { x.to_le_bytes() }).collect()
            };
        }
        match self {
            Self::I32(values) => bytes!(values),
            Self::I64(values) => bytes!(values),
            Self::F32(values) => bytes!(values),
        }
    }
}

const METADATA: &str =
    "METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 2.00514 \n\n";

/// A legacy file; one line stands before the faces, and counts where cells are counted.
pub fn legacy(sample: &Sample, how: Legacy) -> Vec<u8> {
    let mut file = format!(
        "# vtk DataFile Version {}\nwritten by a test\n{}\nDATASET {}\n",
        how.version,
        if how.binary { "BINARY" } else { "ASCII" },
        if how.grid { "UNSTRUCTURED_GRID" } else { "POLYDATA" },
    )
    .into_bytes();
    let put = |file: &mut Vec<u8>, header: &str, numbers: Numbers| {
        file.extend(header.as_bytes());
        if how.binary {
            file.extend(numbers.bytes(true));
            file.push(b'\n');
        } else {
            file.extend(numbers.text().into_bytes());
        }
    };
    let points = sample.positions.len();
    put(&mut file, "FIELD FieldData 1\nTIME 1 1 float\n", Numbers::F32(vec![0.25]));
    put(&mut file, &format!("POINTS {points} float\n"), Numbers::floats(&sample.positions));
    file.extend(METADATA.bytes());
    let line = vec![0, 1];
    let cells: Vec<&Vec<u32>> = std::iter::once(&line).chain(&sample.faces).collect();
    let lists: &[(&str, &[&Vec<u32>])] =
        if how.grid { &[("CELLS", &cells)] } else { &[("LINES", &cells[..1]), ("POLYGONS", &cells[1..])] };
    for (keyword, list) in lists {
        let corners: usize = list.iter().map(|cell| cell.len()).sum();
        if how.version.starts_with('5') {
            let (offsets, connectivity) = runs(list, true);
            file.extend(format!("{keyword} {} {corners}\n", list.len() + 1).bytes());
            put(&mut file, "OFFSETS vtktypeint64\n", Numbers::I64(offsets));
            put(&mut file, "CONNECTIVITY vtktypeint64\n", Numbers::I64(connectivity));
        } else {
            let counted = list.iter().flat_map(|cell| {
                std::iter::once(cell.len() as i32).chain(cell.iter().map(|&index| index as i32))
            });
            let header = format!("{keyword} {} {}\n", list.len(), corners + list.len());
            put(&mut file, &header, Numbers::I32(counted.collect()));
        }
    }
    if how.grid {
        let types = cells.iter().map(|cell| [3, 5, 9, 7][cell.len().min(5) - 2]).collect();
        put(&mut file, &format!("CELL_TYPES {}\n", cells.len()), Numbers::I32(types));
    }
    put_arrays(sample, &mut file, how, put);
    file
}

fn put_arrays(sample: &Sample, file: &mut Vec<u8>, how: Legacy, put: impl Fn(&mut Vec<u8>, &str, Numbers)) {
    let points = sample.positions.len();
    file.extend(format!("POINT_DATA {points}\n").bytes());
    put(file, "SCALARS pressure float\nLOOKUP_TABLE default\n", Numbers::F32(vec![0.5; points]));
    if let Some(velocities) = &sample.velocities {
        let velocities = Numbers::floats(velocities);
        match (how.grid, how.binary) {
            (false, _) => put(file, "VECTORS U float\n", velocities),
            (true, false) => {
                put(file, &format!("FIELD FieldData 1\nvelocity 3 {points} float\n"), velocities)
            }
            (true, true) => put(file, "SCALARS velocity float 3\nLOOKUP_TABLE default\n", velocities),
        }
        file.extend(METADATA.bytes());
    }
    if let Some(labels) = &sample.labels {
        let cells = labels.len() + 1;
        let side =
            |side: usize| Numbers::I32(std::iter::once(-9).chain(labels.iter().map(|l| l[side])).collect());
        file.extend(format!("CELL_DATA {cells}\nFIELD FieldData 2\n").bytes());
        put(file, &format!("label_front 1 {cells} int\n"), side(0));
        put(file, &format!("label_back 1 {cells} int\n"), side(1));
    }
}

/// Where each cell ends (and the first begins), and the corners of all.
fn runs(cells: &[&Vec<u32>], from_0: bool) -> (Vec<i64>, Vec<i64>) {
    let connectivity = cells.iter().flat_map(|cell| cell.iter().map(|&index| i64::from(index))).collect();
    let mut end = 0;
    let ends = cells.iter().map(|cell| {
        end += cell.len() as i64;
        end
    });
    ((if from_0 { Some(0) } else { None }).into_iter().chain(ends).collect(), connectivity)
}

/// An XML file; one line stands before the faces.
pub fn xml(sample: &Sample, how: Xml) -> Vec<u8> {
    let mut file = Pieces { how, text: String::new(), appended: Vec::new() };
    let _ = write!(
        file.text,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"{}\" header_type=\"{}\"{}>\n  \
         <PolyData>\n    <FieldData>\n    </FieldData>\n    <Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" \
         NumberOfLines=\"1\" NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n",
        if how.big { "BigEndian" } else { "LittleEndian" },
        if how.wide { "UInt64" } else { "UInt32" },
        if how.zlib { " compressor=\"vtkZLibDataCompressor\"" } else { "" },
        sample.positions.len(),
        sample.faces.len(),
    );
    file.text += "      <PointData Vectors=\"U\">\n";
    if let Some(velocities) = &sample.velocities {
        file.array("alpha.water", 1, Numbers::F32(vec![0.5; velocities.len()]));
        file.array("U", 3, Numbers::floats(velocities));
    }
    file.text += "      </PointData>\n      <CellData>\n";
    if let Some(labels) = &sample.labels {
        for (side, name) in ["label_front", "label_back"].into_iter().enumerate() {
            file.array(
                name,
                1,
                Numbers::I32(std::iter::once(-9).chain(labels.iter().map(|l| l[side])).collect()),
            );
        }
    }
    file.text += "      </CellData>\n      <Points>\n";
    file.array("Points", 3, Numbers::floats(&sample.positions));
    file.text += "      </Points>\n";
    let line = vec![0, 1];
    let faces: Vec<&Vec<u32>> = sample.faces.iter().collect();
    for (name, cells) in [("Verts", &[][..]), ("Lines", &[&line]), ("Strips", &[]), ("Polys", &faces)] {
        let (ends, connectivity) = runs(cells, false);
        let _ = writeln!(file.text, "      <{name}>");
        file.array("connectivity", 1, Numbers::I64(connectivity));
        file.array("offsets", 1, Numbers::I64(ends));
        let _ = writeln!(file.text, "      </{name}>");
    }
    file.text += "    </Piece>\n  </PolyData>\n";
    file.finish()
}

/// The text of an XML file and what is appended to it.
struct Pieces {
    how: Xml,
    text: String,
    appended: Vec<u8>,
}

impl Pieces {
    fn array(&mut self, name: &str, components: usize, numbers: Numbers) {
        let type_name = match numbers {
            Numbers::I32(_) => "Int32",
            Numbers::I64(_) => "Int64",
            Numbers::F32(_) => "Float32",
        };
        let head = format!(
            "        <DataArray type=\"{type_name}\" Name=\"{name}\" NumberOfComponents=\"{components}\""
        );
        let (header, data) = self.blocks(&numbers.bytes(self.how.big));
        let base64 = |apart: bool| {
            if apart || self.how.zlib {
                STANDARD.encode(&header) + &STANDARD.encode(&data)
            } else {
                STANDARD.encode([&header[..], &data].concat())
            }
        };
        let key = "<InformationKey name=\"L2_NORM_RANGE\" location=\"vtkDataArray\" length=\"1\">\n<Value index=\"0\">\n2\n</Value>\n</InformationKey>\n";
        let (format, inside) = match self.how.encoding {
            Encoding::Ascii => ("ascii", numbers.text()),
            Encoding::Inline => ("binary", base64(false)),
            Encoding::InlineApart => ("binary", base64(true)),
            Encoding::AppendedRaw | Encoding::AppendedBase64 => {
                let offset = self.appended.len();
                if self.how.encoding == Encoding::AppendedRaw {
                    self.appended.extend([header, data].concat());
                } else {
                    let text = base64(false);
                    self.appended.extend(text.bytes());
                }
                let _ =
                    writeln!(self.text, "{head} format=\"appended\" RangeMin=\"0\" offset=\"{offset}\"/>");
                return;
            }
        };
        let _ = writeln!(
            self.text,
            "{head} format=\"{format}\">\n          {inside}\n          {key}        </DataArray>"
        );
    }

    /// What stands before the data, and the data, compressed in blocks of 100 bytes where it is compressed.
    fn blocks(&self, bytes: &[u8]) -> (Vec<u8>, Vec<u8>) {
        let number = |n: usize| match (self.how.wide, self.how.big) {
            (false, false) => (n as u32).to_le_bytes().to_vec(),
            (false, true) => (n as u32).to_be_bytes().to_vec(),
            (true, false) => (n as u64).to_le_bytes().to_vec(),
            (true, true) => (n as u64).to_be_bytes().to_vec(),
        };
        if !self.how.zlib {
            return (number(bytes.len()), bytes.to_vec());
        }
        let blocks: Vec<Vec<u8>> = bytes
            .chunks(100)
            .map(|block| {
                let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
                encoder.write_all(block).unwrap();
                encoder.finish().unwrap()
            })
            .collect();
        let mut header = [number(blocks.len()), number(100), number(bytes.len() % 100)].concat();
        blocks.iter().for_each(|block| header.extend(number(block.len())));
        (header, blocks.concat())
    }

    fn finish(self) -> Vec<u8> {
        let encoding = match self.how.encoding {
            Encoding::AppendedRaw => "raw",
            Encoding::AppendedBase64 => "base64",
            _ => return (self.text + "</VTKFile>\n").into_bytes(),
        };
        let mut file = (self.text + &format!("  <AppendedData encoding=\"{encoding}\">\n   _")).into_bytes();
        file.extend(self.appended);
        file.extend(b"\n  </AppendedData>\n</VTKFile>\n");
        file
    }
}
