//! The command as a process, and a folder of scenes for it.

use std::collections::BTreeMap;
use std::process::{Command, Stdio};

use glam::DVec3;

use super::small::{Folder, cuboid, labelled, ply, scene};

/// What a run of the command left behind.
#[derive(Debug)]
pub struct Outcome {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Outcome {
    /// Asserts how it ended.
    pub fn ended(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "{self:#?}");
        self
    }

    /// Asserts that standard error names all of these.
    pub fn says(self, words: &[&str]) -> Self {
        for word in words {
            assert!(self.stderr.contains(word), "no \"{word}\" in {self:#?}");
        }
        self
    }

    /// Asserts that standard output has all of these.
    pub fn prints(self, words: &[&str]) -> Self {
        for word in words {
            assert!(self.stdout.contains(word), "no \"{word}\" in {self:#?}");
        }
        self
    }
}

pub fn command(folder: &Folder, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_floe"));
    command.args(arguments).current_dir(folder.path("")).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

pub fn floe(folder: &Folder, arguments: &[&str]) -> Outcome {
    let output = command(folder, arguments).output().unwrap();
    Outcome {
        code: output.status.code(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// `boxes/scene.toml` with a growing box of ice as frames 1 to `frames`.
pub fn boxes(frames: u32, tables: &str) -> Folder {
    let folder = Folder::new();
    folder.write("boxes/scene.toml", scene(tables));
    for number in 1..=frames {
        write_box(&folder, number, 0.5 + 0.1 * f64::from(number));
    }
    folder
}

/// Writes a box of ice as a frame.
pub fn write_box(folder: &Folder, number: u32, size: f64) {
    let mesh = labelled(cuboid(DVec3::splat(-size), DVec3::splat(size)), 0, 2);
    folder.write(&format!("boxes/frames/frame_{number:04}.ply"), ply(&mesh));
}

pub fn edit(folder: &Folder, from: &str, to: &str) {
    let text = String::from_utf8(folder.read("boxes/scene.toml")).unwrap();
    assert!(text.contains(from), "{text}");
    folder.write("boxes/scene.toml", text.replace(from, to));
}

/// All pictures of `boxes`, PNG too, by their names.
pub fn pictures(folder: &Folder) -> BTreeMap<String, Vec<u8>> {
    let is_picture = |name: &String| name.ends_with(".exr") || name.ends_with(".png");
    folder.files().into_iter().filter(is_picture).map(|name| (name.clone(), folder.read(&name))).collect()
}
