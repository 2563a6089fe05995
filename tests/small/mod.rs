//! Small scenes in temporary folders.
#![allow(dead_code, clippy::unwrap_used)]

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use floe::driver::{Job, Observer, RenderOptions, RenderReport, render};
use floe::mesh::{Interface, RawMesh, Region};
use glam::DVec3;

/// A folder that goes away with its contents.
pub struct Folder(tempfile::TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    /// A folder with `scene.toml`, whose frames are `frames/frame_####.ply`.
    pub fn with_scene(scene: &str) -> Self {
        let folder = Self::new();
        folder.write("scene.toml", scene);
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, contents: impl AsRef<[u8]>) -> &Self {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, contents).unwrap();
        self
    }

    /// Writes a mesh as `frames/frame_####.ply`.
    pub fn frame(&self, number: u32, mesh: &RawMesh) -> &Self {
        self.write(&format!("frames/frame_{number:04}.ply"), ply(mesh))
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}; there are {:?}", self.files()))
    }

    /// The lines of a ledger.
    pub fn ledger(&self, name: &str) -> Vec<serde_json::Value> {
        let text = String::from_utf8(self.read(name)).unwrap();
        text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    }

    /// Every file below the folder, sorted, hidden ones too.
    pub fn files(&self) -> Vec<String> {
        let mut found = Vec::new();
        let mut folders = vec![self.0.path().to_owned()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path);
                } else {
                    found.push(path.strip_prefix(self.0.path()).unwrap().to_str().unwrap().to_owned());
                }
            }
        }
        found.sort();
        found
    }

    /// Files that writers leave when they die.
    pub fn leftovers(&self) -> Vec<String> {
        let is_temporary =
            |name: &String| name.contains("/.") || name.starts_with('.') || name.contains(".tmp");
        self.files().into_iter().filter(is_temporary).collect()
    }

    /// Renders into `out/frame_####.exr` of the folder.
    pub fn render(&self, options: RenderOptions) -> RenderReport {
        self.render_watched(options, &())
    }

    pub fn render_watched(&self, options: RenderOptions, observer: &dyn Observer) -> RenderReport {
        let job = Job::open(&self.path("scene.toml")).unwrap();
        let output = self.path("out/frame_####.exr").to_str().unwrap().to_owned();
        render(&job, &RenderOptions { output: Some(output), ..options }, observer).unwrap()
    }
}

/// A frame of the sequence that comes with the package.
pub fn shipped_frame(number: u32) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    root.join(format!("sequences/iceberg/frames/frame_{number:04}.ply"))
}

/// The scene of the shipped sequence with a picture of 32 x 18 pixels.
pub fn shipped_scene(samples: u32) -> String {
    let sequence = Path::new(env!("CARGO_MANIFEST_DIR")).join("sequences/iceberg");
    let text = fs::read_to_string(sequence.join("scene.toml")).unwrap();
    let text = text.replace("\"sky.exr\"", &format!("'{}'", sequence.join("sky.exr").display()));
    let changed = |line: &str| match line.split(" = ").next() {
        Some("resolution") => "resolution = [32, 18]".to_owned(),
        Some("samples") => format!("samples = {samples}"),
        _ => line.to_owned(),
    };
    let small: String = text.lines().map(|line| changed(line) + "\n").collect();
    assert!(small.contains("[32, 18]") && small.contains(&format!("samples = {samples}")), "{small}");
    small
}

/// A scene of labels 0 air, 1 water, 2 ice under a sky, seen from the front: what stands between -1 and 1 fills it.
/// A table of the same name in `instead` takes the place of the usual one.
pub fn scene(instead: &str) -> String {
    let tables = [
        "[frames]\npath = \"frames/frame_####.ply\"\n",
        "[regions]\n0 = \"air\"\n1 = \"water\"\n2 = \"ice\"\n",
        "[media.air]\nior = 1.0\n",
        "[media.water]\nior = 1.33\nabsorption = [0.35, 0.07, 0.03]\n",
        "[media.ice]\nior = 1.31\nabsorption = 0.1\nscattering = 2\n",
        "[sky]\nradiance = [0.6, 0.7, 0.8]\n",
        "[camera]\neye = [0.4, -4, 0.9]\ntarget = [0, 0, 0]\nvertical_fov = 40\nresolution = [16, 9]\n",
        "[render]\nsamples = 4\n",
    ];
    let head = |table: &str| table.split(']').next().unwrap().to_owned() + "]";
    let usual = tables.iter().filter(|table| !instead.contains(&head(table)));
    usual.copied().collect::<Vec<_>>().join("\n") + "\n" + instead
}

/// A mesh as PLY text that carries every digit.
pub fn ply(mesh: &RawMesh) -> String {
    let mut text = String::from("ply\nformat ascii 1.0\n");
    let labels =
        if mesh.interfaces.is_some() { "property int label_front\nproperty int label_back\n" } else { "" };
    let (vertices, faces) = (mesh.positions.len(), mesh.triangles.len());
    write!(text, "element vertex {vertices}\nproperty double x\nproperty double y\nproperty double z\n")
        .unwrap();
    if mesh.velocities.is_some() {
        text.push_str("property float vx\nproperty float vy\nproperty float vz\n");
    }
    write!(text, "element face {faces}\nproperty list uchar int vertex_indices\n{labels}end_header\n")
        .unwrap();
    for (i, p) in mesh.positions.iter().enumerate() {
        write!(text, "{} {} {}", p.x, p.y, p.z).unwrap();
        if let Some(velocities) = &mesh.velocities {
            let v = velocities[i];
            write!(text, " {} {} {}", v.x, v.y, v.z).unwrap();
        }
        text.push('\n');
    }
    for (i, [a, b, c]) in mesh.triangles.iter().enumerate() {
        write!(text, "3 {a} {b} {c}").unwrap();
        if let Some(interfaces) = &mesh.interfaces {
            write!(text, " {} {}", interfaces[i].front.0, interfaces[i].back.0).unwrap();
        }
        text.push('\n');
    }
    text
}

/// The bytes of a picture but for those that say which scene and mesh it is of.
pub fn without_marks(mut picture: Vec<u8>) -> Vec<u8> {
    for (mark, digits) in [("checksum", 32), ("fingerprint", 32), ("meshHash", 64)] {
        let head = format!("floe:{mark}\0string\0");
        let at = picture.windows(head.len()).position(|w| w == head.as_bytes()).expect(mark);
        let value = at + head.len() + 4;
        picture[value..value + digits].fill(0);
    }
    picture
}

/// A box with outward normals; unlabelled.
pub fn cuboid(min: DVec3, max: DVec3) -> RawMesh {
    let corner = |i: u32| {
        let pick = |bit: u32, axis: usize| if i >> bit & 1 == 1 { max[axis] } else { min[axis] };
        DVec3::new(pick(0, 0), pick(1, 1), pick(2, 2))
    };
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    RawMesh {
        positions: (0..8).map(corner).collect(),
        triangles: quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        interfaces: None,
        normals: None,
        velocities: None,
    }
}

/// The box from -0.8 to 0.8.
pub fn cube() -> RawMesh {
    cuboid(DVec3::splat(-0.8), DVec3::splat(0.8))
}

/// The mesh with the same labels on every triangle.
pub fn labelled(mesh: RawMesh, front: i32, back: i32) -> RawMesh {
    let interface = Interface { front: Region(front), back: Region(back) };
    RawMesh { interfaces: Some(vec![interface; mesh.triangles.len()]), ..mesh }
}

/// The triangles of both meshes.
pub fn joined(mut a: RawMesh, b: &RawMesh) -> RawMesh {
    let first = a.positions.len() as u32;
    a.positions.extend(&b.positions);
    a.triangles.extend(b.triangles.iter().map(|t| t.map(|v| v + first)));
    if let (Some(a), Some(b)) = (&mut a.interfaces, &b.interfaces) {
        a.extend(b);
    }
    a
}
