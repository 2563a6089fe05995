//! Opens what the user points at: a scene file, a folder with one, or a folder of frames.

use std::io::ErrorKind;
use std::path::{Component, Path, PathBuf};

use glam::DVec3;

use super::error::RenderError;
use super::fingerprint::{Fingerprints, FrameSource, Parsed};
use super::meshes::MeshSequence;
use crate::film::write::write_atomically;
use crate::mesh::{self, MeshError, RawMesh};
use crate::scene::FrameError;
use crate::scene::assembly::Buffers;
use crate::scene::description::{Placement, SceneDescription, automatic_placement, default_scene};
use crate::scene::domain::detect_box;
use crate::scene::frame::Frame;
use crate::scene::world::World;
use crate::sequence::{FrameFile, FrameNumber, FrameSelection, SequenceError, discover, frame_path};

/// Name of the scene file in a folder.
const SCENE_FILE: &str = "scene.toml";

/// A scene and its frames.
#[derive(Clone, Debug)]
pub struct Job {
    /// What all frames share.
    pub world: World,
    /// The frames in order, of several meshes the first that is there; empty for a still.
    pub files: Vec<FrameFile>,
    /// The files of those `[[meshes]]` that change.
    pub meshes: Vec<MeshSequence>,
    /// The scene file that was written because the folder had none.
    pub written_scene: Option<PathBuf>,
    /// Name of the folder or scene, which names the output.
    pub name: String,
}

/// One frame to be rendered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameTask {
    /// Its number.
    pub number: FrameNumber,
    /// The meshes that are its own; none for a still without `[frames]`.
    pub files: Vec<PathBuf>,
    /// The frame after it in the sequence, whether it is rendered or not.
    pub next: Option<NextFrame>,
}

/// The frame after another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NextFrame {
    /// Its number.
    pub number: FrameNumber,
    /// Its meshes, in the order of the other's.
    pub files: Vec<PathBuf>,
}

impl FrameTask {
    /// Reads its files as rendering does, with the settings of the scene.
    ///
    /// # Errors
    /// When one cannot be read, or a mesh is wrong.
    pub fn read(&self, world: &World) -> Result<Parsed, RenderError> {
        let fingerprints = Fingerprints::new(world, &world.description.render);
        FrameSource::read(world, &fingerprints, self)?.parse(world)
    }

    /// Reads and assembles it; from the frame before what still serves is taken over.
    ///
    /// # Errors
    /// When a file cannot be read, or there is no frame of them.
    pub fn assemble(&self, world: &World, previous: Option<&Frame>) -> Result<Frame, RenderError> {
        let Parsed { meshes, inputs, .. } = self.read(world)?;
        let assembled = world.assemble_into(Buffers::default(), self.number, meshes, inputs, previous);
        Ok(assembled.map_err(RenderError::from)?.frame)
    }

    /// The bytes of one of its meshes.
    pub(super) fn contents(&self, path: &Path) -> Result<(PathBuf, Vec<u8>), RenderError> {
        match std::fs::read(path) {
            Ok(bytes) => Ok((path.into(), bytes)),
            // Of several meshes one that is not there is missed.
            Err(error) if self.files.len() > 1 && error.kind() == ErrorKind::NotFound => {
                Err(RenderError::MissingMesh { path: path.into(), number: self.number })
            }
            Err(source) => Err(FrameError::from(MeshError::Io { path: path.into(), source }).into()),
        }
    }
}

impl Job {
    /// Opens a scene file or a folder.
    ///
    /// A folder without `scene.toml` gets one beside its output (`out/<folder>/scene.toml`), once.
    ///
    /// # Errors
    /// When nothing is there, or the scene file is wrong, or no frames are found.
    pub fn open(path: &Path) -> Result<Self, RenderError> {
        Self::open_changed(path, |_| ())
    }

    /// Opens a scene file or a folder, and changes what the scene file says.
    ///
    /// # Errors
    /// Those of [`Job::open`].
    pub fn open_changed(
        path: &Path,
        change: impl FnOnce(&mut SceneDescription),
    ) -> Result<Self, RenderError> {
        let first = |base: &Path, pattern: &str| {
            let files = discover(base, pattern)?;
            Ok(mesh::read(&files[0].path).map_err(FrameError::from)?)
        };
        let mut job = Self::open_with(path, &first, change)?;
        let description = &job.world.description;
        job.meshes = MeshSequence::of(description)?;
        job.files = match &description.frames {
            Some(frames) if description.meshes.is_empty() => discover(&description.directory, &frames.path)?,
            _ => MeshSequence::numbered(&job.meshes),
        };
        Ok(job)
    }

    /// Opens a scene file or a folder whose frames are still being written; `files` is empty.
    ///
    /// `first` reads the frame of a folder and pattern that a camera without placement, or a folder without a scene, is
    /// to be about. It is not asked for otherwise.
    ///
    /// # Errors
    /// When nothing is there, or the scene file is wrong, and those of `first`.
    pub fn open_on(path: &Path, first: &FirstMesh<'_>) -> Result<Self, RenderError> {
        Self::open_with(path, first, |_| ())
    }

    fn open_with(
        path: &Path,
        first: &FirstMesh<'_>,
        change: impl FnOnce(&mut SceneDescription),
    ) -> Result<Self, RenderError> {
        let (file, is_new, name) = match find_scene(path)? {
            SceneFile::There { file, name } => (file, false, name),
            SceneFile::ToBeWritten { file, name } => {
                write_default_scene(path, &file, &first(path, "")?)?;
                (file, true, name)
            }
        };
        let mut description = SceneDescription::from_file(&file)?;
        change(&mut description);
        let placement = match &description.camera.placement {
            Some(placement) => *placement,
            None => framed(&description, first)?,
        };
        let written_scene = is_new.then_some(file);
        let (files, meshes) = (Vec::new(), Vec::new());
        Ok(Self { world: World::new(description, placement)?, files, meshes, written_scene, name })
    }

    /// Every frame, in order.
    pub fn tasks(&self) -> Vec<FrameTask> {
        if self.files.is_empty() {
            let first = FrameNumber::from_integer(1).unwrap_or_default();
            return vec![FrameTask { number: first, files: Vec::new(), next: None }];
        }
        let meshes_of = |file: &FrameFile| match self.meshes.as_slice() {
            [] => vec![file.path.clone()],
            meshes => meshes.iter().map(|mesh| mesh.file(file.number)).collect(),
        };
        let next_of = |file: &FrameFile| NextFrame { number: file.number, files: meshes_of(file) };
        let task = |(i, file): (usize, &FrameFile)| FrameTask {
            number: file.number,
            files: meshes_of(file),
            next: self.files.get(i + 1).map(next_of),
        };
        self.files.iter().enumerate().map(task).collect()
    }

    /// The frames of a selection, in order.
    ///
    /// # Errors
    /// [`SequenceError::NoneSelected`] when no frame is left.
    pub fn select(&self, selection: &FrameSelection) -> Result<Vec<FrameTask>, SequenceError> {
        let mut tasks = self.tasks();
        let there = |t: &FrameTask| FrameFile {
            number: t.number,
            path: t.files.first().cloned().unwrap_or_default(),
        };
        let chosen = selection.select(&tasks.iter().map(there).collect::<Vec<_>>())?;
        tasks.retain(|t| chosen.iter().any(|f| f.number == t.number));
        Ok(tasks)
    }

    /// The pattern of the pictures' names, relative to the current directory.
    pub fn output_pattern(&self) -> String {
        self.world
            .description
            .output
            .path
            .clone()
            .unwrap_or_else(|| format!("out/{}/frame_####.exr", self.name))
    }
}

/// Reads the first frame of a folder and a pattern.
pub type FirstMesh<'a> = dyn Fn(&Path, &str) -> Result<RawMesh, RenderError> + 'a;

/// The scene file of what the user gave, and the name of the whole.
#[derive(Debug)]
pub(super) enum SceneFile {
    /// It is there.
    There { file: PathBuf, name: String },
    /// A folder without one: it is to be written from its first frame.
    ToBeWritten { file: PathBuf, name: String },
}

/// Finds the scene file.
pub(super) fn find_scene(path: &Path) -> Result<SceneFile, RenderError> {
    if path.is_file() {
        let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
        let is_plain = path.file_name().is_some_and(|n| n == SCENE_FILE);
        let name = if is_plain { folder_name(path.parent().unwrap_or(path)) } else { stem };
        return Ok(SceneFile::There { file: path.into(), name });
    }
    if !path.is_dir() {
        return Err(RenderError::NotFound { path: path.into() });
    }
    let name = folder_name(path);
    let own = path.join(SCENE_FILE);
    if own.is_file() {
        return Ok(SceneFile::There { file: own, name });
    }
    let file = Path::new("out").join(&name).join(SCENE_FILE);
    if !file.is_file() {
        return Ok(SceneFile::ToBeWritten { file, name });
    }
    check_folder(&file, path)?;
    Ok(SceneFile::There { file, name })
}

/// Checks that a scene that was written earlier is about this folder: two folders may have the same name.
fn check_folder(scene: &Path, folder: &Path) -> Result<(), RenderError> {
    let description = SceneDescription::from_file(scene)?;
    // What is about other meshes by now is not about those that it was written for.
    let frames = description.frames.filter(|_| description.meshes.is_empty());
    let Some(frames) = frames else { return Ok(()) };
    let is_inside = normalised(&description.directory.join(&frames.path)).starts_with(normalised(folder));
    if is_inside {
        return Ok(());
    }
    Err(RenderError::OtherFolder { scene: scene.into(), frames: frames.path, folder: folder.into() })
}

fn folder_name(folder: &Path) -> String {
    let absolute = folder.canonicalize().unwrap_or_else(|_| folder.into());
    absolute.file_name().map_or_else(|| "scene".into(), |n| n.to_string_lossy().into_owned())
}

/// Writes the scene of a folder that has none, from its first frame.
fn write_default_scene(folder: &Path, file: &Path, first: &RawMesh) -> Result<(), RenderError> {
    let mut labels: Vec<i32> = match &first.interfaces {
        Some(interfaces) => interfaces.iter().flat_map(|i| [i.front.0, i.back.0]).collect(),
        None => vec![1],
    };
    labels.sort_unstable();
    labels.dedup();
    let target = file.parent().unwrap_or(Path::new("."));
    let frames = relative_path(target, folder);
    let name = frames.to_str().ok_or_else(|| RenderError::NotUtf8 { path: folder.into() })?;
    let text = default_scene(name, bounds_of(first), &labels, detect_box(first));
    Ok(write_atomically(file, text.as_bytes())?)
}

/// `to` as seen from the folder `from`, both relative to the current directory; absolute when there is no way.
fn relative_path(from: &Path, to: &Path) -> PathBuf {
    let here = std::env::current_dir().unwrap_or_default();
    let from: Vec<Component> = Vec::from_iter(from.components());
    let from: PathBuf = here.join(PathBuf::from_iter(from));
    let to = to.canonicalize().unwrap_or_else(|_| here.join(to));
    let from = normalised(&from);
    let shared = from.components().zip(to.components()).take_while(|(a, b)| a == b).count();
    let up = std::iter::repeat_n(Component::ParentDir, from.components().count() - shared);
    up.chain(to.components().skip(shared)).collect()
}

/// Resolves what exists of a path; a folder that does not exist yet keeps its name.
fn normalised(path: &Path) -> PathBuf {
    match (path.canonicalize(), path.parent(), path.file_name()) {
        (Ok(found), ..) => found,
        (Err(_), Some(parent), Some(name)) => normalised(parent).join(name),
        _ => path.into(),
    }
}

/// A camera on the bounds of the first frame, or of the surfaces of a still.
fn framed(description: &SceneDescription, first: &FirstMesh<'_>) -> Result<Placement, RenderError> {
    let bounds = match &description.frames {
        Some(frames) if description.meshes.is_empty() => {
            let (min, max) = bounds_of(&first(&description.directory, &frames.path)?);
            (min * frames.scale, max * frames.scale)
        }
        _ => placed_bounds(description)?,
    };
    let camera = &description.camera;
    Ok(automatic_placement(bounds, camera.up, camera.fov, camera.resolution))
}

/// Of the `[[meshes]]` in the first frame, and of the `[[surfaces]]` where there are none.
fn placed_bounds(description: &SceneDescription) -> Result<(DVec3, DVec3), RenderError> {
    let meshes = MeshSequence::of(description)?;
    let number = MeshSequence::numbered(&meshes).first().map_or(FrameNumber::ONE, |first| first.number);
    let mut placed: Vec<(PathBuf, f64, DVec3)> = Vec::new();
    for (which, mesh) in description.meshes.iter().enumerate() {
        let moving = meshes.iter().find(|moving| moving.mesh == which);
        let path = moving.map_or_else(|| description.directory.join(&mesh.path), |m| m.file(number));
        placed.push((path, mesh.scale, mesh.translate));
    }
    if placed.is_empty() {
        for surface in &description.surfaces {
            let path = description.directory.join(frame_path(&surface.mesh, number)?);
            placed.push((path, surface.scale, surface.translate));
        }
    }
    let mut bounds = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (path, scale, translate) in placed {
        let (min, max) = bounds_of(&mesh::read(&path).map_err(FrameError::from)?);
        bounds = (bounds.0.min(min * scale + translate), bounds.1.max(max * scale + translate));
    }
    Ok(bounds)
}

pub(super) fn bounds_of(mesh: &RawMesh) -> (DVec3, DVec3) {
    mesh.positions
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), &p| (min.min(p), max.max(p)))
}
