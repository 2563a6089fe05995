//! Reads a mesh file of any known format.

use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use flate2::read::MultiGzDecoder;

use super::error::{Fault, MeshError, Place};
use super::limits::decompressed_limit;
use super::{RawMesh, VelocityName, bobj, dsc, obj, ply, stl, vtk};

/// How a mesh is written down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Syntax {
    /// Polygon file format.
    Ply,
    /// Wavefront OBJ.
    Obj,
    /// Tetrahedra of a deformable simplicial complex.
    Dsc,
    /// Legacy VTK.
    Vtk,
    /// VTK's XML for polygons.
    Vtp,
    /// Stereolithography.
    Stl,
    /// Binary OBJ of Mantaflow and FLIP Fluids.
    Bobj,
}

/// A file format: a syntax, compressed or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Format {
    /// How the mesh is written down.
    pub syntax: Syntax,
    /// Whether the file is compressed with gzip.
    pub gzip: bool,
}

/// Every format that can be read.
pub const FORMATS: [Format; 14] = [
    Format { syntax: Syntax::Ply, gzip: false },
    Format { syntax: Syntax::Obj, gzip: false },
    Format { syntax: Syntax::Dsc, gzip: false },
    Format { syntax: Syntax::Vtk, gzip: false },
    Format { syntax: Syntax::Vtp, gzip: false },
    Format { syntax: Syntax::Stl, gzip: false },
    Format { syntax: Syntax::Bobj, gzip: false },
    Format { syntax: Syntax::Ply, gzip: true },
    Format { syntax: Syntax::Obj, gzip: true },
    Format { syntax: Syntax::Dsc, gzip: true },
    Format { syntax: Syntax::Vtk, gzip: true },
    Format { syntax: Syntax::Vtp, gzip: true },
    Format { syntax: Syntax::Stl, gzip: true },
    Format { syntax: Syntax::Bobj, gzip: true },
];

impl Format {
    /// What file names of this format end with, in lower case.
    pub fn extension(self) -> &'static str {
        let (plain, compressed) = match self.syntax {
            Syntax::Ply => (".ply", ".ply.gz"),
            Syntax::Obj => (".obj", ".obj.gz"),
            Syntax::Dsc => (".dsc", ".dsc.gz"),
            Syntax::Vtk => (".vtk", ".vtk.gz"),
            Syntax::Vtp => (".vtp", ".vtp.gz"),
            Syntax::Stl => (".stl", ".stl.gz"),
            Syntax::Bobj => (".bobj", ".bobj.gz"),
        };
        if self.gzip { compressed } else { plain }
    }

    /// The format that a file's name promises, whatever the case of its letters.
    pub fn of(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_string_lossy().to_ascii_lowercase();
        FORMATS.into_iter().find(|format| name.ends_with(format.extension()))
    }
}

/// Reads a mesh from a file, without velocities; its name tells the format.
///
/// # Errors
/// [`MeshError`] when the file cannot be read, its name promises no known format, or its contents are wrong.
pub fn read(path: &Path) -> Result<RawMesh, MeshError> {
    read_with(path, &VelocityName::Nothing)
}

/// Reads a mesh from a file with velocities, where it has them or where a file beside it does.
///
/// # Errors
/// Those of [`read()`], for either file.
pub fn read_with(path: &Path, velocity: &VelocityName) -> Result<RawMesh, MeshError> {
    let bytes =
        |path: &Path| fs::read(path).map_err(|source| MeshError::Io { path: path.to_owned(), source });
    let format = promised(path)?;
    let mut mesh = read_bytes(&bytes(path)?, format, velocity, path)?;
    if let Some(beside) = velocities_beside(path, velocity) {
        add_velocities(&mut mesh, &bytes(&beside)?, &beside)?;
    }
    Ok(mesh)
}

/// Reads a mesh from contents of a file that were read before, with velocities of that name where it has them itself.
///
/// # Errors
/// [`MeshError`] when the file's name promises no known format, or the contents are wrong.
pub fn parse(bytes: &[u8], velocity: &VelocityName, path: &Path) -> Result<RawMesh, MeshError> {
    read_bytes(bytes, promised(path)?, velocity, path)
}

fn promised(path: &Path) -> Result<Format, MeshError> {
    Format::of(path).ok_or_else(|| {
        Fault::unsupported(
            Place::File,
            "the file name promises no known mesh format",
            "the known ones end with .ply, .obj, .dsc, .vtk, .vtp, .stl or .bobj, each also with .gz behind it",
        )
        .in_file(path)
    })
}

/// The file beside a mesh that has its velocities, if there is one and it is asked for.
pub fn velocities_beside(mesh: &Path, velocity: &VelocityName) -> Option<PathBuf> {
    let is_asked = velocity.find(&["velocity"], &[]).is_some();
    let may_have = Format::of(mesh).is_some_and(|format| format.syntax == Syntax::Bobj);
    if is_asked && may_have { bobj::velocity_file(mesh) } else { None }
}

/// Gives a mesh the velocities of the file beside it.
///
/// # Errors
/// [`MeshError`] when the contents are wrong, or of another number of vertices.
pub fn add_velocities(mesh: &mut RawMesh, bytes: &[u8], path: &Path) -> Result<(), MeshError> {
    let gzip = Format::of(path).is_some_and(|format| format.gzip);
    let vertices = mesh.positions.len();
    let velocities = inside(bytes, gzip, |bytes| bobj::read_velocities(bytes, vertices));
    mesh.velocities = Some(velocities.map_err(|fault| fault.in_file(path))?);
    Ok(())
}

/// Reads a mesh from the contents of a file; `path` is only named in messages.
///
/// # Errors
/// [`MeshError`] when the contents are wrong.
pub fn read_bytes(
    bytes: &[u8],
    format: Format,
    velocity: &VelocityName,
    path: &Path,
) -> Result<RawMesh, MeshError> {
    let mesh = inside(bytes, format.gzip, |bytes| read_syntax(bytes, format.syntax, velocity));
    mesh.map_err(|fault| fault.in_file(path))
}

/// Reads from what is inside a file, compressed or not.
fn inside<T>(bytes: &[u8], gzip: bool, read: impl FnOnce(&[u8]) -> Result<T, Fault>) -> Result<T, Fault> {
    if gzip { read(&decompress(bytes)?) } else { read(bytes) }
}

fn read_syntax(bytes: &[u8], syntax: Syntax, velocity: &VelocityName) -> Result<RawMesh, Fault> {
    if bytes.is_empty() {
        let cure = "wait for its writer or write it again";
        return Err(Fault::malformed(Place::File, "the file is empty", cure));
    }
    match syntax {
        Syntax::Ply => ply::read(bytes, velocity),
        Syntax::Obj => obj::read(bytes),
        Syntax::Dsc => dsc::read(bytes),
        Syntax::Vtk => vtk::read_legacy(bytes, velocity),
        Syntax::Vtp => vtk::read_xml(bytes, velocity),
        Syntax::Stl => stl::read(bytes),
        Syntax::Bobj => bobj::read(bytes),
    }
}

/// The contents of a gzip file of one or more members, their checksums verified.
fn decompress(bytes: &[u8]) -> Result<Vec<u8>, Fault> {
    let limit = decompressed_limit(bytes.len());
    let mut inside = Vec::new();
    let result = MultiGzDecoder::new(bytes).take(limit + 1).read_to_end(&mut inside);
    if inside.len() as u64 > limit {
        return Err(Fault::too_large(
            Place::File,
            format!("{} compressed bytes hold more than {limit}", bytes.len()),
            "no mesh shrinks that much; decompress the file by hand if it really is one",
        ));
    }
    match result {
        Ok(_) => Ok(inside),
        Err(error) => {
            let after = inside.len();
            let problem = if error.kind() == io::ErrorKind::UnexpectedEof {
                format!("the gzip data ends early, after {after} decompressed bytes")
            } else {
                format!("the gzip data is damaged after {after} decompressed bytes ({error})")
            };
            let cure = "the file is truncated, damaged or not gzip; write it again";
            Err(Fault::malformed(Place::File, problem, cure))
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::Compression;
    use flate2::write::GzEncoder;

    use super::*;
    use crate::mesh::error::Blame;

    fn gzip(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn names_promise_formats_in_any_case() {
        for format in FORMATS {
            let lower = format!("dir.gz/a{}", format.extension());
            assert_eq!(Format::of(Path::new(&lower)), Some(format));
            assert!(crate::sequence::is_frame_name(&lower), "{lower} is no frame of a folder");
            assert_eq!(Format::of(Path::new(&lower.to_uppercase())), Some(format));
        }
        for other in ["a.gz", "a.vtu", "a_bobj", "ply", "a.ply.bak", ""] {
            assert_eq!(Format::of(Path::new(other)), None, "{other}");
        }
    }

    #[test]
    fn a_missing_file_is_an_io_error() {
        assert!(read(Path::new("tests/data/meshes/no_such_file.ply")).unwrap_err().is_not_found());
    }

    #[test]
    fn members_are_joined() {
        let joined = [gzip(b"one "), gzip(b"two")].concat();
        assert_eq!(decompress(&joined).unwrap(), b"one two");
    }

    #[test]
    fn damage_truncation_and_bombs_are_told_apart() {
        let mut file = gzip(b"some text that is long enough");
        let truncated = decompress(&file[..file.len() - 9]).unwrap_err();
        assert!(truncated.problem.contains("ends early"), "{}", truncated.problem);
        let checksum = file.len() - 8;
        file[checksum] ^= 1;
        assert!(decompress(&file).unwrap_err().problem.contains("damaged"));
        assert_eq!(decompress(b"not gzip").unwrap_err().blame, Blame::Malformed);
        let bomb = gzip(&vec![b'0'; 96 << 20]);
        assert_eq!(decompress(&bomb).unwrap_err().blame, Blame::TooLarge);
    }
}
