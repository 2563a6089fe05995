//! Frames that are drawn while they are written: none from incomplete bytes, none lost, whatever the writer does.
#![allow(clippy::unwrap_used)]

mod command;
mod ends;
mod manners;
mod simulator;
mod slow;
#[path = "../small/mod.rs"]
mod small;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::Duration;

use floe::driver::{
    FrameRecord, Observer, RenderOptions, Status, WatchOptions, WatchReport, WatchStatus, read_identity,
    watch,
};
use glam::DVec3;
use sha2::{Digest, Sha256};
use small::{Folder, cuboid, labelled};

/// Hears what a watch tells, and looks at each picture when it is finished.
#[derive(Default)]
struct Witness {
    /// Hashes of all meshes that a picture was ever finished of.
    hashes: Mutex<BTreeSet<String>>,
    /// Finished pictures and previews, in order: frame and whether it is a preview.
    drawn: Mutex<Vec<(String, bool)>>,
    failed: Mutex<Vec<(String, String)>>,
    warnings: Mutex<Vec<String>>,
    phases: Mutex<Vec<WatchStatus>>,
}

impl Observer for Witness {
    fn finished(&self, record: &FrameRecord) {
        let frame = record.frame.clone();
        match record.status {
            Status::Complete => {
                let identity = read_identity(&record.output).unwrap();
                self.hashes.lock().unwrap().insert(identity.mesh_hash);
                self.drawn.lock().unwrap().push((frame, false));
            }
            Status::Preview => {
                assert!(record.output.with_extension("png").exists());
                self.drawn.lock().unwrap().push((frame, true));
            }
            _ => self.failed.lock().unwrap().push((frame, record.error.clone().unwrap_or_default())),
        }
    }

    fn warning(&self, text: &str) {
        self.warnings.lock().unwrap().push(text.to_owned());
    }

    fn watching(&self, status: &WatchStatus) {
        let mut phases = self.phases.lock().unwrap();
        if phases.last() != Some(status) {
            phases.push(status.clone());
        }
    }
}

/// The quiet time of these tests. What proves that it is whole needs none, so that no test depends on how busy a machine is;
/// what does not waits 4 times as long.
const QUIET: Duration = Duration::from_millis(25);

/// Options that are quick, and end when `DONE` is there.
fn options(folder: &Folder) -> WatchOptions {
    let output = folder.path("out/frame_####.exr").to_str().unwrap().to_owned();
    WatchOptions {
        render: RenderOptions { output: Some(output), threads: Some(2), ..RenderOptions::default() },
        done_file: Some("DONE".into()),
        preview_samples: Some(2),
        poll: Duration::from_millis(100),
        quiet: QUIET,
        ..WatchOptions::default()
    }
}

fn watched(folder: &Folder, options: &WatchOptions, observer: &dyn Observer) -> WatchReport {
    watch(&folder.path("scene.toml"), options, observer).unwrap()
}

/// Binary PLY of a box whose size tells the frame.
fn contents(number: usize) -> Vec<u8> {
    let mesh = labelled(cuboid(DVec3::splat(-0.8), DVec3::splat(0.3 + 0.05 * number as f64)), 0, 1);
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n\
         property float z\nelement face {}\nproperty list uchar int vertex_indices\nproperty uchar label_front\n\
         property uchar label_back\nend_header\n",
        mesh.positions.len(),
        mesh.triangles.len()
    )
    .into_bytes();
    for p in &mesh.positions {
        bytes.extend(p.as_vec3().to_array().iter().flat_map(|c| c.to_le_bytes()));
    }
    for triangle in &mesh.triangles {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|index| index.to_le_bytes()));
        bytes.extend([0, 1]);
    }
    bytes
}

fn hash(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

fn picture(folder: &Folder, number: usize) -> PathBuf {
    folder.path(&format!("out/frame_{number:04}.exr"))
}

/// What mesh a picture says it is of.
fn drawn_of(path: &Path) -> Option<String> {
    read_identity(path).map(|identity| identity.mesh_hash)
}
