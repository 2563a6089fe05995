//! The readers of files and of words from the command line.

use std::path::Path;

use floe::light::Picture;
use floe::mesh::{self, Format, RawMesh, Region, Syntax, VelocityName};
use floe::optics::volume;
use floe::scene::description::{Model, SceneDescription};
use floe::sequence::{FrameNumber, FrameSelection, check_output_pattern, frame_path};

/// A mesh is refused, or it is what `RawMesh` promises and can be made fit for rays.
pub fn mesh(syntax: Syntax, gzip: bool, bytes: &[u8]) {
    let path = Path::new("fuzzed");
    let format = Format { syntax, gzip };
    if let Ok(mesh) = mesh::read_bytes(bytes, format, &VelocityName::Known, path) {
        assert_keeps_its_promises(&mesh);
        // A mesh of so many triangles is sound or not as one of fewer is; this one takes time.
        if mesh.triangles.len() < 10_000
            && let Ok((prepared, warnings)) = mesh::prepare(mesh, Region(1), path)
        {
            assert_keeps_its_promises(&prepared);
            assert!(prepared.interfaces.is_some());
            warnings.iter().for_each(|warning| drop(warning.to_string()));
        }
    }
    if syntax == Syntax::Bobj {
        let mut still =
            RawMesh { positions: vec![glam::DVec3::ZERO; bytes.len() / 12], ..RawMesh::default() };
        let _ = mesh::add_velocities(&mut still, bytes, Path::new("velocity0001.bobj"));
    }
}

fn assert_keeps_its_promises(mesh: &RawMesh) {
    let vertices = mesh.positions.len();
    let inside = |corners: &[u32; 3], count: usize| corners.iter().all(|&corner| (corner as usize) < count);
    assert!(mesh.positions.iter().all(|p| p.is_finite()));
    assert!(mesh.triangles.iter().all(|t| inside(t, vertices)));
    assert!(mesh.interfaces.as_ref().is_none_or(|i| i.len() == mesh.triangles.len()));
    assert!(mesh.velocities.as_ref().is_none_or(|v| v.len() == vertices));
    if let Some(normals) = &mesh.normals {
        match &normals.corners {
            Some(corners) => {
                assert_eq!(corners.len(), mesh.triangles.len());
                assert!(corners.iter().all(|c| inside(c, normals.values.len())));
            }
            None => assert_eq!(normals.values.len(), vertices),
        }
    }
}

/// A grid is refused, or has as many numbers as its size says.
pub fn grid(bytes: &[u8]) {
    if let Err(error) = volume::read_bytes(bytes, Path::new("fuzzed")) {
        drop(error.to_string());
    }
}

/// A picture is refused, or can shine; a finished frame is refused, or has as many pixels as its size says.
pub fn picture(bytes: &[u8]) {
    if let Ok(picture) = Picture::read_bytes(bytes, Path::new("fuzzed")) {
        assert_eq!(picture.texels.len(), picture.width * picture.height);
        assert!(picture.texels.iter().all(|t| t.is_finite() && t.min_element() >= 0.0));
    }
    if let Ok(layers) = floe::film::exr_layers::read_layers(bytes) {
        assert_eq!(layers.colours.len(), layers.width * layers.height);
    }
    if let Ok(image) = floe::film::exr_read::read_colours(bytes) {
        assert_eq!(image.pixels.len(), image.width as usize * image.height as usize);
    }
}

/// A scene is refused with words, or is one whose media can be computed.
pub fn scene(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match SceneDescription::parse(text, Path::new("fuzzed/scene.toml")) {
        Ok(scene) => scene.media.values().filter_map(|medium| medium.model.as_ref()).for_each(model),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

/// What is in a medium is refused with words, or scatters and absorbs.
fn model(model: &Model) {
    match model.mixture.bulk(&[550.0]) {
        Ok(bulk) => {
            let coefficients = bulk.sigma_a.iter().chain(&bulk.sigma_s);
            assert!(coefficients.into_iter().all(|sigma| sigma.is_finite() && *sigma >= 0.0), "{model:?}");
            assert!(bulk.g.iter().all(|g| g.abs() <= 1.0), "{model:?}");
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

/// Ranges, patterns and numbers.
pub fn names(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Ok(selection) = FrameSelection::parse(text) {
        let few: Vec<FrameNumber> = selection.numbers().take(100).collect();
        assert!(few.iter().all(|&number| selection.contains(number)));
    }
    if let Ok(number) = text.parse::<FrameNumber>() {
        assert_eq!(number.to_string().parse().ok(), Some(number));
    }
    if check_output_pattern(text, 2).is_ok() {
        let of = |number: u32| frame_path(text, number.into()).ok();
        assert!(of(1).is_some() && of(1) != of(2));
    }
}
