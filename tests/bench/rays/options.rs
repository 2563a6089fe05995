//! The command line.

use super::meshes;

/// What is asked for.
pub struct Options {
    /// Only rows whose name contains this.
    pub rows: String,
    /// Names of meshes.
    pub meshes: Vec<String>,
    /// Pixels along a side of the camera's image; its square is the number of rays.
    pub side: u32,
    /// Whether builds and refits are timed.
    pub build: bool,
    /// Passes over the rays.
    pub repeat: usize,
}

/// How to ask.
const USAGE: &str = "--rows TEXT       only rows whose name contains TEXT
--meshes A,B      some of 20k,200k,2m
--quick           256 thousand rays a row instead of a million
--no-build        no rows of builds and refits
--repeat N        passes over the rays (5)";

impl Options {
    /// Reads the arguments of the process.
    ///
    /// # Errors
    /// What was not understood, and the usage.
    pub fn read() -> Result<Self, String> {
        let meshes = meshes::NAMES.map(str::to_owned).to_vec();
        let mut options = Self { rows: String::new(), meshes, side: 1024, build: true, repeat: 5 };
        let mut arguments = std::env::args().skip(1);
        while let Some(argument) = arguments.next() {
            let mut value = || arguments.next().ok_or_else(|| format!("{argument} needs a value\n{USAGE}"));
            match argument.as_str() {
                "--rows" => options.rows = value()?,
                "--meshes" => options.meshes = value()?.split(',').map(str::to_owned).collect(),
                "--quick" => options.side = 512,
                "--no-build" => options.build = false,
                "--repeat" => options.repeat = value()?.parse().map_err(|e| format!("--repeat: {e}"))?,
                // Cargo adds it.
                "--bench" => {}
                "--help" => return Err(USAGE.to_owned()),
                other => return Err(format!("unknown argument {other}\n{USAGE}")),
            }
        }
        options.repeat = options.repeat.max(1);
        if let Some(name) = options.meshes.iter().find(|name| !meshes::NAMES.contains(&name.as_str())) {
            return Err(format!("no mesh {name}; there are {}", meshes::NAMES.join(", ")));
        }
        Ok(options)
    }

    /// The meshes, made one after the other.
    pub fn meshes(&self) -> impl Iterator<Item = meshes::Mesh> {
        self.meshes.iter().filter_map(|name| meshes::by_name(name))
    }

    /// True for rows that are wanted.
    pub fn wants(&self, row: &str) -> bool {
        row.contains(&self.rows)
    }
}
