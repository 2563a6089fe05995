//! The shipped scenes, and the parts of the renderer that can be forced in.

use std::path::{Path, PathBuf};

use floe::scene::needs::Needs;

/// A shipped scene, smaller than it is.
pub struct Scene {
    pub name: &'static str,
    /// Of several frames, this one.
    pub frame: Option<u32>,
    /// What takes the place of its own resolution and samples.
    resolution: &'static str,
    samples: u32,
    /// The frames' vertices have velocities.
    moves: bool,
    /// Something in it scatters, so that walks go on without tracing.
    scatters: bool,
    /// A light is looked for.
    lit: bool,
    /// It is rendered by photons.
    photons: bool,
}

pub const SCENES: [Scene; 3] = [
    Scene {
        name: "iceberg",
        frame: Some(6),
        resolution: "[280, 158]",
        samples: 8,
        moves: true,
        scatters: true,
        lit: true,
        photons: false,
    },
    Scene {
        name: "waters",
        frame: None,
        resolution: "[240, 120]",
        samples: 8,
        moves: false,
        scatters: true,
        lit: true,
        photons: false,
    },
    Scene {
        name: "pool",
        frame: None,
        resolution: "[160, 100]",
        samples: 8,
        moves: false,
        scatters: false,
        lit: true,
        photons: true,
    },
];

impl Scene {
    /// True where photons are its light.
    #[allow(dead_code)] // not of every bench
    pub fn photons(&self) -> bool {
        self.photons
    }

    /// Writes the scene into a folder with its files where they are; with a part forced in by what the scene says.
    pub fn write(&self, folder: &Path, forced: Option<&Part>) -> PathBuf {
        let home = Path::new(env!("CARGO_MANIFEST_DIR")).join("sequences").join(self.name);
        let text = std::fs::read_to_string(home.join("scene.toml")).unwrap();
        let mut lines: Vec<String> = text.lines().map(|line| self.small(line, &home)).collect();
        if let Some((table, line)) = forced.and_then(|part| part.says) {
            match lines.iter().position(|l| l.starts_with(table)) {
                Some(at) => lines.insert(at + 1, line.to_owned()),
                None => lines.extend([table.to_owned(), line.to_owned()]),
            }
        }
        let file = folder.join("scene.toml");
        std::fs::write(&file, lines.join("\n")).unwrap();
        file
    }

    fn small(&self, line: &str, home: &Path) -> String {
        let key = line.split(" =").next().unwrap_or_default();
        match key {
            "resolution" => format!("resolution = {}", self.resolution),
            "samples" => format!("samples = {}", self.samples),
            "path" | "mesh" => line.replacen('"', &format!("\"{}/", home.display()), 1),
            "radiance" => line.replacen("image = \"", &format!("image = \"{}/", home.display()), 1),
            _ => line.to_owned(),
        }
    }
}

/// A part of the renderer that a scene may do without.
pub struct Part {
    pub name: &'static str,
    /// Forces it in.
    pub need: Option<fn(&mut Needs)>,
    /// Forces it in: a line of a table of the scene.
    says: Option<(&'static str, &'static str)>,
    /// Whether a scene does without.
    left_out: fn(&Scene) -> bool,
}

impl Part {
    pub fn is_left_out(&self, scene: &Scene) -> bool {
        (self.left_out)(scene)
    }

    const fn need(name: &'static str, need: fn(&mut Needs), left_out: fn(&Scene) -> bool) -> Self {
        Self { name, need: Some(need), says: None, left_out }
    }

    const fn says(
        name: &'static str,
        table: &'static str,
        line: &'static str,
        left_out: fn(&Scene) -> bool,
    ) -> Self {
        Self { name, need: None, says: Some((table, line)), left_out }
    }
}

pub const PARTS: [Part; 7] = [
    Part::says(
        "spectral lanes: a medium that nothing is made of is given over wavelength",
        "[media.forced]",
        "absorption = { wavelength = [400, 700], value = [1, 2] }",
        |_| true,
    ),
    Part::need("emission of media: every flight is traced", |n| n.emission = true, |scene| scene.scatters),
    Part::need("varying density", |n| n.heterogeneous = true, |_| true),
    Part::need("shadow rays through boundaries", |n| n.matched_interfaces = true, |scene| scene.lit),
    Part::says("photon maps", "[render]", "integrator = \"photon\"", |scene| !scene.photons),
    Part::says("motion blur", "[camera]", "shutter = 0.5", |scene| scene.moves),
    Part::says("depth of field", "[camera]", "aperture = 0.001", |_| true),
];
