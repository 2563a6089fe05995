//! Any mesh at all as a frame of a scene.

use std::path::PathBuf;
use std::sync::OnceLock;

use floe::driver::Job;
use floe::driver::tiles::{Sampling, render_pixels};
use floe::mesh::{Interface, RawMesh, Region};
use floe::scene::assembly::FrameMesh;
use floe::sequence::FrameNumber;
use glam::DVec3;

/// Water that scatters, ice, a sun, and a floor that is the mesh itself seen from all sides.
const SCENE: &str = "
[frames]
path = \"frame_####.ply\"
[regions]
0 = \"air\"
1 = \"sea\"
2 = \"ice\"
[media.sea]
ior = 1.33
absorption = [0.3, 0.1, 0.02]
scattering = 0.5
phase = { kind = \"henyey-greenstein\", g = 0.9 }
[media.ice]
ior = 1.31
[sun]
direction = [0.3, 0.2, 0.9]
angular_diameter = 5
irradiance = 3
[sky]
radiance = [0.6, 0.7, 0.8]
[camera]
eye = [3, 1, 2]
target = [0, 0, 0]
resolution = [4, 4]
[render]
samples = 1
max_depth = 64
";

/// A cube's corner, so that there is a first frame.
const FIRST: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                     element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

fn job() -> &'static Job {
    static JOB: OnceLock<(tempfile::TempDir, Job)> = OnceLock::new();
    let (_, job) = JOB.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a folder for the scene");
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("written");
        write("scene.toml", SCENE);
        write("frame_0001.ply", FIRST);
        let job = Job::open(&folder.path().join("scene.toml")).expect("the scene is sound");
        (folder, job)
    });
    job
}

/// A frame is refused with words, or its picture is finite and not negative.
pub fn frame(bytes: &[u8]) {
    let Some(mesh) = mesh_of(bytes) else { return };
    let job = job();
    let meshes = [FrameMesh { path: PathBuf::from("fuzzed.ply"), mesh }];
    match job.world.assemble(FrameNumber::from(1), meshes, None) {
        Err(error) => assert!(!error.to_string().is_empty()),
        Ok(assembled) => {
            let sampling = Sampling::new(&job.world.description.render);
            let (image, counters) = render_pixels(&assembled.frame, &sampling, &|_, _| ());
            assert_eq!(counters.non_finite, 0);
            assert!(image.pixels.iter().all(|p| p.rgb.is_finite() && p.rgb.min_element() >= 0.0));
        }
    }
}

/// One byte: how many vertices, up to 32. For each its coordinates: single precision, those that are not finite left to the
/// readers. Then triangles: three bytes of corners and one of labels.
fn mesh_of(bytes: &[u8]) -> Option<RawMesh> {
    let (&first, rest) = bytes.split_first()?;
    let count = usize::from(first % 32) + 1;
    let (vertices, faces) = rest.split_at_checked(count * 12)?;
    let number = |bytes: &[u8]| f64::from(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]));
    let positions: Vec<DVec3> =
        vertices.chunks_exact(12).map(|b| DVec3::new(number(b), number(&b[4..]), number(&b[8..]))).collect();
    if !positions.iter().all(|p| p.is_finite()) {
        return None;
    }
    let corner = |byte: u8| u32::from(byte) % count as u32;
    let faces = || faces.chunks_exact(4).take(64);
    let label = |bits: u8| Region(i32::from(bits % 4));
    Some(RawMesh {
        positions,
        triangles: faces().map(|b| [corner(b[0]), corner(b[1]), corner(b[2])]).collect(),
        interfaces: (first < 192)
            .then(|| faces().map(|b| Interface { front: label(b[3]), back: label(b[3] >> 4) }).collect()),
        ..RawMesh::default()
    })
}
