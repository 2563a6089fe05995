//! Whether the bytes of a mesh file are all of it.
//!
//! Reading checks counts, checksums, indices and numbers. What it cannot see is how a file ends that says nothing about
//! its length, or whose end was allocated before it was written:
//!
//! | the file | what a cut or unwritten end looks like | proof |
//! |---|---|---|
//! | gzip | its checksum fails | proven |
//! | `.bobj`, `.vtp` | another length than its count says, or no end tag | proven |
//! | binary STL, whose last byte is 0 | another length than its count says | plausible |
//! | PLY, vertices before faces | too few elements; faces of no corners | proven |
//! | ... its last byte is 0 | maybe the last face, partly unwritten | plausible |
//! | ... as text, without a line break at its end | maybe the last number lacks digits | plausible |
//! | ... ends with 64 zeros or more, or with a vertex of zeros | maybe what is behind the faces | doubtful |
//! | ... last triangle or last two vertices all zero | unwritten | unreadable |
//! | OBJ, `.dsc` | fewer faces | plausible |
//! | ... without a line break at its end | a number that lacks digits | doubtful |
//! | ... open, or with unused vertices, unlike the frame before | faces are missing | doubtful |
//! | text STL, of which there may be several solids | fewer solids | plausible |
//! | `.vtk`, whose sections come one after the other | no labels, no velocities | plausible |
//! | ... without labels or asked velocities, unless the frame before had none | its sections are missing | doubtful |
//! | text with zeros at its end | unwritten | unreadable |
//!
//! The truncations of `tests/watch.rs` try every length of each.

use std::path::Path;

use glam::DVec3;

use super::guard::caught;
use super::ready::Proof;
use crate::mesh::{self, Format, MeshError, MeshWarning, Place, RawMesh, Region, Syntax, VelocityName};

/// So many zeros at the end are no record of a mesh any more.
const ZERO_TAIL: usize = 64;

/// A mesh and how sure it is that nothing of its file is missing.
#[derive(Clone, Debug)]
pub struct Inspected {
    /// The mesh.
    pub mesh: RawMesh,
    /// How sure.
    pub proof: Proof,
    /// What is doubtful, for a warning.
    pub doubt: Option<String>,
    /// What the next frame is expected to have too.
    pub traits: Traits,
}

/// What a file that is cut may lack without a fault; `None` where nothing is known of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Traits {
    /// Whether the surface is open or leaves vertices unused.
    pub loose: Option<bool>,
    /// Whether its triangles have labels.
    pub labels: Option<bool>,
    /// Whether its vertices have velocities.
    pub velocities: Option<bool>,
}

impl Inspected {
    fn new(mesh: RawMesh, proof: Proof, doubt: Option<String>) -> Self {
        let traits = Traits { labels: Some(mesh.interfaces.is_some()), ..Traits::default() };
        Self { mesh, proof, doubt, traits }
    }

    /// Doubts a mesh without velocities where the one before had them, or where none is known.
    pub fn expect_velocities(&mut self, before: Traits) {
        self.traits.velocities = Some(self.mesh.velocities.is_some());
        self.expect(self.mesh.velocities.is_some(), before.velocities, "velocities");
    }

    fn expect(&mut self, is_there: bool, before: Option<bool>, what: &str) {
        if is_there || before == Some(false) {
            return;
        }
        self.proof = Proof::Doubtful;
        let doubt = before.map(|_| format!("it has no {what}, unlike the frame before"));
        self.doubt = self.doubt.take().or(doubt);
    }
}

/// Reads a mesh from the bytes of a file, with velocities of that name; `before` is what was found of another frame.
///
/// # Errors
/// [`MeshError`] when the bytes are no whole mesh.
pub fn inspect(
    bytes: &[u8],
    path: &Path,
    velocity: &VelocityName,
    before: Traits,
) -> Result<Inspected, MeshError> {
    let inspected = caught(|| inspect_bytes(bytes, path, velocity, before));
    inspected.unwrap_or_else(|reason| {
        Err(malformed(path, &format!("floe itself fails on it, which is worth a report ({reason})")))
    })
}

fn inspect_bytes(
    bytes: &[u8],
    path: &Path,
    velocity: &VelocityName,
    before: Traits,
) -> Result<Inspected, MeshError> {
    let format = Format::of(path).ok_or_else(|| malformed(path, "its name promises no known mesh format"))?;
    let mesh = mesh::read_bytes(bytes, format, velocity, path)?;
    if format.gzip {
        return Ok(Inspected::new(mesh, Proof::Proven, None));
    }
    let zeros = bytes.iter().rev().take_while(|&&byte| byte == 0).count();
    match format.syntax {
        Syntax::Obj | Syntax::Dsc => inspect_endless(bytes, mesh, path, zeros, before.loose),
        Syntax::Stl if !is_binary_stl(bytes) => Ok(Inspected::new(mesh, Proof::Plausible, None)),
        Syntax::Vtk => {
            let mut inspected = inspect_counted(bytes, mesh, path, zeros)?;
            inspected.proof = inspected.proof.max(Proof::Plausible);
            let is_labelled = inspected.mesh.interfaces.is_some();
            inspected.expect(is_labelled, before.labels, "labels");
            if *velocity != VelocityName::Nothing {
                inspected.expect_velocities(before);
            }
            Ok(inspected)
        }
        _ => inspect_counted(bytes, mesh, path, zeros),
    }
}

/// The length of a binary STL file follows from its count.
fn is_binary_stl(bytes: &[u8]) -> bool {
    let count = bytes.get(80..84).map(|c| u64::from(u32::from_le_bytes([c[0], c[1], c[2], c[3]])));
    count.is_some_and(|count| bytes.len() as u64 == 84 + 50 * count)
}

/// A format that says how long it is.
fn inspect_counted(bytes: &[u8], mesh: RawMesh, path: &Path, zeros: usize) -> Result<Inspected, MeshError> {
    let unwritten = mesh.triangles.last().is_some_and(|[a, b, c]| a == b && b == c)
        || mesh.positions.last_chunk::<2>() == Some(&[DVec3::ZERO; 2]);
    if zeros > 0 && unwritten {
        return Err(malformed(path, "its end is all zeros: allocated, but not written"));
    }
    let head = &bytes[..bytes.len().min(1024)];
    let place = |words: &[u8]| head.windows(words.len()).position(|found| found == words);
    let is_text = place(b"format ascii").or(place(b"\nASCII")).is_some();
    let cut = is_text && !bytes.ends_with(b"\n");
    let vertices_last = place(b"element vertex") > place(b"element face");
    let last_is_zero = zeros > 0 && vertices_last && mesh.positions.last() == Some(&DVec3::ZERO);
    let doubt = (zeros >= ZERO_TAIL || last_is_zero).then(|| format!("{zeros} zeros at its end"));
    let proof = match (&doubt, zeros > 0 || cut) {
        (Some(_), _) => Proof::Doubtful,
        (None, true) => Proof::Plausible,
        (None, false) => Proof::Proven,
    };
    Ok(Inspected::new(mesh, proof, doubt))
}

/// A text that may end after any line.
fn inspect_endless(
    bytes: &[u8],
    mesh: RawMesh,
    path: &Path,
    zeros: usize,
    loose_before: Option<bool>,
) -> Result<Inspected, MeshError> {
    if zeros > 0 {
        return Err(malformed(path, "its end is all zeros: allocated, but not written"));
    }
    let (loose, how) = match Format::of(path).map(|format| format.syntax) {
        Some(Syntax::Dsc) => (has_unused_corners(bytes), "has vertices that no tetrahedron uses"),
        _ => (is_loose(bytes, &mesh, path), "is open or has vertices that no face uses"),
    };
    let doubt = if !bytes.ends_with(b"\n") {
        Some("no line break at its end".to_owned())
    } else if loose && loose_before == Some(false) {
        Some(format!("it {how}, unlike the frame before"))
    } else {
        None
    };
    let unknown = loose && loose_before.is_none();
    let proof = if doubt.is_some() || unknown { Proof::Doubtful } else { Proof::Plausible };
    let mut inspected = Inspected::new(mesh, proof, doubt);
    inspected.traits.loose = Some(loose);
    Ok(inspected)
}

/// Whether the surface of an OBJ file has a rim, or the file vertices that no face uses.
fn is_loose(bytes: &[u8], mesh: &RawMesh, path: &Path) -> bool {
    let is_vertex = |line: &&[u8]| line.trim_ascii_start().starts_with(b"v ");
    if bytes.split(|&byte| byte == b'\n').filter(is_vertex).count() > mesh.positions.len() {
        return true;
    }
    let is_open = |warning: &MeshWarning| matches!(warning, MeshWarning::Open { .. });
    mesh::prepare(mesh.clone(), Region(1), path).is_ok_and(|(_, warnings)| warnings.iter().any(is_open))
}

/// Whether a `.dsc` file, which has been read without fault, has vertices that no tetrahedron uses.
fn has_unused_corners(bytes: &[u8]) -> bool {
    let mut words = bytes.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    let (mut vertices, mut used) = (0, Vec::new());
    while let Some(word) = words.next() {
        if word == b"v" {
            vertices += 1;
            words.nth(2);
            continue;
        }
        for corner in words.by_ref().take(4) {
            let index = std::str::from_utf8(corner).ok().and_then(|text| text.parse::<usize>().ok());
            let index = index.unwrap_or_default();
            if index >= used.len() {
                used.resize(index + 1, false);
            }
            used[index] = true;
        }
        words.next();
    }
    used.iter().filter(|is_used| **is_used).count() < vertices
}

fn malformed(path: &Path, problem: &str) -> MeshError {
    MeshError::Malformed {
        path: path.into(),
        place: Place::File,
        problem: problem.into(),
        cure: "wait for its writer or write it again",
    }
}

#[cfg(test)]
mod tests;
