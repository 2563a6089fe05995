//! Every format and encoding against its PLY twin, and what damage makes of each.
#![allow(clippy::unwrap_used)]

mod sample;
mod vtk_writers;
mod writers;

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use floe::mesh::canonical::canonical;
use floe::mesh::{
    Format, MeshError, MeshWarning, RawMesh, Region, Syntax, VelocityName, prepare, read_bytes, read_with,
    weld,
};

use sample::{Sample, measures};
use vtk_writers::{Encoding, Legacy, Xml};

/// A file and what it is a file of.
struct Example {
    name: String,
    syntax: Syntax,
    bytes: Vec<u8>,
}

fn xml_variants() -> Vec<Xml> {
    use Encoding::{AppendedBase64, AppendedRaw, Ascii, Inline, InlineApart};
    let mut variants = Vec::new();
    for encoding in [Ascii, Inline, InlineApart, AppendedRaw, AppendedBase64] {
        for (zlib, big, wide) in
            [(false, false, false), (false, true, true), (true, false, true), (true, true, false)]
        {
            let same_as_another = encoding == Ascii && (zlib || big) || encoding == InlineApart && zlib;
            if !same_as_another {
                variants.push(Xml { encoding, zlib, big, wide });
            }
        }
    }
    variants
}

/// The files that carry velocities and, where the sample has them, labels.
fn vtk_examples(sample: &Sample) -> Vec<Example> {
    let legacy = Legacy::ALL.iter().map(|how| Example {
        name: format!("{how:?}"),
        syntax: Syntax::Vtk,
        bytes: vtk_writers::legacy(sample, *how),
    });
    let xml = xml_variants().into_iter().map(|how| Example {
        name: format!("{how:?}"),
        syntax: Syntax::Vtp,
        bytes: vtk_writers::xml(sample, how),
    });
    legacy.chain(xml).collect()
}

/// The files that carry neither.
fn bare_examples(sample: &Sample) -> Vec<Example> {
    let normals = vec![[0.0, 0.0, 1.0]; sample.positions.len()];
    [
        ("binary STL", Syntax::Stl, writers::stl_binary(sample, "exported")),
        ("binary STL that begins with solid", Syntax::Stl, writers::stl_binary(sample, "solid exported")),
        ("STL text", Syntax::Stl, writers::stl_text(sample)),
        ("binary OBJ with normals", Syntax::Bobj, writers::bobj(sample, Some(&normals))),
        ("binary OBJ without", Syntax::Bobj, writers::bobj(sample, None)),
    ]
    .map(|(name, syntax, bytes)| Example { name: name.into(), syntax, bytes })
    .into()
}

fn read(bytes: &[u8], syntax: Syntax) -> Result<RawMesh, MeshError> {
    read_bytes(bytes, Format { syntax, gzip: false }, &VelocityName::Known, Path::new("example"))
}

/// Positions in single precision, which is what the files say; texts are read more precisely.
fn rounded(mut mesh: RawMesh) -> RawMesh {
    mesh.positions.iter_mut().for_each(|position| *position = position.as_vec3().as_dvec3());
    mesh
}

/// Vertices and triangles in an order that does not depend on the file, for soups.
fn ordered(mesh: &RawMesh) -> RawMesh {
    let mut mesh = RawMesh { velocities: None, normals: None, ..rounded(mesh.clone()) };
    weld(&mut mesh);
    canonical(&mesh)
}

#[test]
fn every_format_is_its_ply_twin() {
    for sample in [Sample::blob(), Sample::blob().labelled(), Sample::cube(), Sample::cube().labelled()] {
        let twin = read(&writers::ply(&sample), Syntax::Ply).unwrap();
        assert_eq!(twin, sample.mesh());
        for Example { name, syntax, bytes } in vtk_examples(&sample) {
            let mesh = read(&bytes, syntax).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert_eq!(rounded(mesh), twin, "{name}");
        }
        let scale = measures(&twin).into_iter().map(f64::abs).fold(0.0, f64::max);
        let bare = RawMesh { interfaces: None, velocities: None, ..twin };
        for Example { name, syntax, bytes } in bare_examples(&sample) {
            let mesh = read(&bytes, syntax).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert_eq!(ordered(&mesh), ordered(&bare), "{name}");
            assert_eq!(mesh.triangles.len(), bare.triangles.len());
            for (a, b) in measures(&mesh).into_iter().zip(measures(&bare)) {
                // Half a unit in the last place of single precision, three times in a volume.
                assert!((a - b).abs() <= 1.5 * f64::from(f32::EPSILON) * scale, "{name}: {a} {b}");
            }
        }
    }
}

/// In single precision numbers lie a quarter apart at 4,000,000. Of text nobody can say how its numbers were made.
#[test]
fn every_binary_format_tells_of_lost_detail() {
    let here = Sample::blob();
    let mut far = here.clone();
    far.positions.iter_mut().for_each(|position| position[1] += 4e6);
    for (sample, expected) in [(here, false), (far, true)] {
        for Example { name, syntax, bytes } in vtk_examples(&sample).into_iter().chain(bare_examples(&sample))
        {
            let is_text =
                ["binary: false", "encoding: Ascii", "STL text"].iter().any(|text| name.contains(text));
            let mesh = read(&bytes, syntax).unwrap();
            let (_, warnings) = prepare(mesh, Region(1), Path::new("example")).unwrap();
            let told = warnings.iter().find(|warning| matches!(warning, MeshWarning::Coarse(_)));
            assert_eq!(told.is_some(), expected && !is_text, "{name}: {warnings:?}");
        }
    }
}

/// What a cut file may still be: a text cut within its last number, or a file cut where its arrays begin, as
/// both are files of their own. Then nothing of the surface may be missing.
fn is_whole(mesh: &RawMesh, whole: &RawMesh, bytes: &[u8], cut: usize) -> bool {
    let within_word = bytes.get(cut).is_some_and(|b| !b.is_ascii_whitespace());
    let same_triangles = mesh.triangles.len() == whole.triangles.len();
    mesh.positions.len() == whole.positions.len()
        && same_triangles
        && (within_word || mesh.triangles == whole.triangles)
}

#[test]
fn every_truncation_is_an_error_or_leaves_the_surface_whole() {
    let sample = Sample::cube();
    for Example { name, syntax, bytes } in vtk_examples(&sample).into_iter().chain(bare_examples(&sample)) {
        let whole = read(&bytes, syntax).unwrap();
        let mut accepted = 0;
        for cut in 0..bytes.len() {
            if let Ok(mesh) = read(&bytes[..cut], syntax) {
                accepted += 1;
                assert!(is_whole(&mesh, &whole, &bytes, cut), "{name} cut at {cut}");
            }
        }
        // Nothing but arrays of points and cells may be missing, which these files end with.
        assert!(accepted < 40, "{name}: {accepted} of {} lengths are accepted", bytes.len());
    }
}

/// Every byte becomes, in turn, something else, and pairs of bytes do: never a panic, and what is read keeps what
/// its type promises.
#[test]
fn flipped_bytes_never_panic() {
    let sample = Sample::cube().labelled();
    for Example { name, syntax, bytes } in vtk_examples(&sample).into_iter().chain(bare_examples(&sample)) {
        let mut damaged = bytes.clone();
        for at in 0..bytes.len() {
            for value in [0, 0xff, b'9', bytes[at] ^ 1] {
                damaged[at] = value;
                let other = (at * 7919 + 13) % bytes.len();
                let kept = damaged[other];
                damaged[other] = kept.wrapping_add(value | 1);
                if let Ok(mesh) = read(&damaged, syntax) {
                    assert!(mesh.positions.iter().all(|position| position.is_finite()), "{name}");
                    let count = mesh.positions.len();
                    assert!(mesh.triangles.iter().flatten().all(|&index| (index as usize) < count), "{name}");
                    prepare(mesh, Region(1), Path::new("example")).unwrap();
                }
                damaged[other] = kept;
            }
            damaged[at] = bytes[at];
        }
    }
}

/// Gives every whole number of a file's text, one by one, the value of two milliards.
fn inflated(bytes: &[u8]) -> Vec<Vec<u8>> {
    let mut files = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let digits = bytes[at..].iter().take_while(|b| b.is_ascii_digit()).count();
        if digits > 0 {
            files.push([&bytes[..at], b"2000000000", &bytes[at + digits..]].concat());
        }
        at += digits.max(1);
    }
    files
}

#[test]
fn counts_that_no_file_holds_are_refused_at_once() {
    let sample = Sample::cube();
    for Example { name, syntax, bytes } in vtk_examples(&sample).into_iter().chain(bare_examples(&sample)) {
        let mut files = inflated(&bytes);
        for at in 0..bytes.len().saturating_sub(8) {
            for count in [2_000_000_000_u32.to_le_bytes(), 2_000_000_000_u32.to_be_bytes()] {
                files.push([&bytes[..at], &count, &bytes[at + 4..]].concat());
            }
        }
        for file in &files {
            // These have 4 kB at most, which take microseconds. On a busy machine a reading may have to wait: then
            // another one tells.
            let time = || {
                let started = Instant::now();
                let _ = read(file, syntax);
                started.elapsed()
            };
            let quick = (0..5).any(|_| time() < Duration::from_millis(10));
            assert!(quick, "{name}: {:?}", read(file, syntax).err());
        }
    }
}

#[test]
fn velocities_lie_beside_binary_obj_files() {
    let folder = tempfile::tempdir().unwrap();
    let sample = Sample::blob();
    let mesh = folder.path().join("000007.bobj");
    fs::write(&mesh, writers::bobj(&sample, None)).unwrap();
    fs::write(folder.path().join("velocity000007.bobj"), writers::bobj_velocities(&sample)).unwrap();
    assert_eq!(read_with(&mesh, &VelocityName::Known).unwrap(), sample.mesh());
}

/// Writes the examples: `cargo test --release --test mesh_formats -- --ignored`
#[test]
#[ignore = "writes tests/data/meshes"]
fn write_the_examples() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/meshes");
    let cube = Sample::cube();
    let labelled = Sample { labels: Some(vec![[0, 1]; 6]), ..Sample::cube() };
    let write = |name: &str, bytes: Vec<u8>| fs::write(folder.join(name), bytes).unwrap();
    for how in Legacy::ALL {
        let encoding = if how.binary { "binary" } else { "ascii" };
        let kind = if how.grid { "grid" } else { "poly" };
        let name = format!("cube_{kind}_v{}_{encoding}.vtk", how.version.replace('.', ""));
        write(&name, vtk_writers::legacy(if how.grid { &labelled } else { &cube }, how));
    }
    for how in xml_variants() {
        let name = format!(
            "cube_{:?}{}{}{}.vtp",
            how.encoding,
            flag(how.zlib, "_zlib"),
            flag(how.big, "_big"),
            flag(how.wide, "_wide")
        );
        write(&name.to_lowercase(), vtk_writers::xml(if how.wide { &labelled } else { &cube }, how));
    }
    let diagonals = cube.positions.iter().map(|p| p.map(|x| (x - 0.5) / 0.75_f32.sqrt())).collect::<Vec<_>>();
    write("cube_binary.stl", writers::stl_binary(&cube, "exported"));
    write("cube_solid.stl", writers::stl_binary(&cube, "solid exported"));
    write("cube_ascii.stl", writers::stl_text(&cube));
    write("cube.bobj", writers::bobj(&cube, None));
    write("cube_normals.bobj", writers::bobj(&cube, Some(&diagonals)));
    for name in [
        "cube_poly_v51_binary.vtk",
        "cube_appendedraw_zlib_wide.vtp",
        "cube_solid.stl",
        "cube.bobj",
        "cube_normals.bobj",
    ] {
        let mut encoder = flate2::GzBuilder::new().write(Vec::new(), flate2::Compression::best());
        std::io::Write::write_all(&mut encoder, &fs::read(folder.join(name)).unwrap()).unwrap();
        write(&format!("{name}.gz"), encoder.finish().unwrap());
    }
}

fn flag(on: bool, name: &str) -> &str {
    if on { name } else { "" }
}
