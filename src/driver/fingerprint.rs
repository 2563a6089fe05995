//! What a picture depends on, in 128 bits: whether it has to be drawn again is seen without drawing it.
//!
//! ```text
//! fingerprint = first 128 bits of SHA-256(version of floe, PIXELS, scene, its files, frame number, the frame's files)
//! ```
//!
//! The scene is what its file says with every default filled in, so comments and the order of keys do not count, and
//! nothing that changes pixels can be forgotten here: what does not count is taken out by name. Files count by their
//! contents, not by their dates. A billion pictures have two of one fingerprint by chance with a probability of
//! (10^9)^2 / 2^129 = 1.5e-21. A processor with instructions for SHA-256 takes half a second for a gigabyte.

use std::fmt;
use std::path::PathBuf;

use sha2::{Digest, Sha256};

use super::error::RenderError;
use super::frame_seeds::FrameSeeds;
use super::guard::guarded;
use super::job::FrameTask;
use super::samples_range::SamplesRange;
use crate::mesh::{self, VelocityName};
use crate::scene::FrameError;
use crate::scene::assembly::FrameMesh;
use crate::scene::description::{OutputDescription, RenderDescription, SceneDescription};
use crate::scene::inputs::{ContentHash, Inputs, NO_FILE};
use crate::scene::world::World;
use crate::sequence::FrameNumber;

/// Which pixels floe makes of what it is given, since the version stays the same between releases.
///
/// It is raised by one with every change after which any scene may have other pixels, by a single bit of one channel;
/// so a picture or a checkpoint that another build has left is never taken for one of this. Changes that only make floe
/// faster, or read what was refused, do not count.
pub const PIXELS: u32 = 8;

/// What a picture depends on, in 128 bits; 32 hexadecimal digits as text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Fingerprint(pub [u8; 16]);

impl Fingerprint {
    /// Of some samples of the frame.
    pub(super) fn of_range(&self, range: SamplesRange) -> Self {
        let mut hasher = Sha256::new();
        add(&mut hasher, &self.0);
        add(&mut hasher, range.to_string().as_bytes());
        Self::taken(hasher)
    }

    fn taken(hasher: Sha256) -> Self {
        let mut bits = [0; 16];
        bits.copy_from_slice(&hasher.finalize()[..16]);
        Self(bits)
    }
}

impl fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&hexadecimal(&self.0))
    }
}

/// The part of the fingerprints that all frames of a run have in common.
#[derive(Clone, Debug)]
pub struct Fingerprints {
    common: Sha256,
    /// Where a frame begins in the sequence of samples follows from what the scene itself says of samples.
    seeds: FrameSeeds,
}

impl Fingerprints {
    /// Of a scene that is rendered with some settings in place of its own.
    pub fn new(world: &World, settings: &RenderDescription) -> Self {
        let mut common = Sha256::new();
        add(&mut common, env!("CARGO_PKG_VERSION").as_bytes());
        add(&mut common, &PIXELS.to_le_bytes());
        add(&mut common, what_counts(&world.description, settings).as_bytes());
        add(&mut common, world.contents.as_flattened());
        let seeds = FrameSeeds::new(&world.description.render, settings.seed, settings.samples);
        Self { common, seeds }
    }

    /// Of a frame whose own meshes, and the other files that only it is made of, have these contents.
    pub fn of_frame(
        &self,
        number: FrameNumber,
        meshes: &[ContentHash],
        others: &[ContentHash],
    ) -> Fingerprint {
        let mut hasher = self.common.clone();
        add(&mut hasher, &number.millionths().to_le_bytes());
        add(&mut hasher, format!("{:?}", self.seeds.of_frame(number).ok()).as_bytes());
        add(&mut hasher, meshes.as_flattened());
        add(&mut hasher, others.as_flattened());
        Fingerprint::taken(hasher)
    }
}

/// The length goes first, so that no two lists of texts run into the same bytes.
fn add(hasher: &mut Sha256, bytes: &[u8]) {
    hasher.update((bytes.len() as u64).to_le_bytes());
    hasher.update(bytes);
}

/// All that a scene says, but for where files are and what only the PNG shows.
fn what_counts(scene: &SceneDescription, settings: &RenderDescription) -> String {
    let mut counts = scene.clone();
    counts.render = settings.clone();
    if settings.target_error.is_none() {
        counts.render.confidence = RenderDescription::default().confidence;
    }
    counts.file = PathBuf::new();
    counts.directory = PathBuf::new();
    if let Some(frames) = &mut counts.frames {
        frames.path.clear();
    }
    let OutputDescription { mut aovs, .. } = counts.output;
    aovs.sort_unstable();
    aovs.dedup();
    counts.output = OutputDescription { path: None, png: false, exposure: 0.0, denoise: false, aovs };
    format!("{counts:?}")
}

pub(super) fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Which frame of which scene a picture is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Identity {
    /// What the picture depends on.
    pub fingerprint: Fingerprint,
    /// SHA-256 of the bytes of the frame's own meshes, as `sha256sum` prints it, with a space between several; of a mesh in memory
    /// [`RawMesh::content_hash`](crate::mesh::RawMesh::content_hash).
    pub mesh_hash: String,
}

impl Identity {
    /// Of a frame whose own meshes, and the other files that only it is made of, have these contents.
    pub(super) fn new(
        fingerprints: &Fingerprints,
        number: FrameNumber,
        meshes: &[ContentHash],
        others: &[ContentHash],
    ) -> Self {
        let mesh_hash = meshes.iter().map(|hash| hexadecimal(hash)).collect::<Vec<_>>().join(" ");
        Self { fingerprint: fingerprints.of_frame(number, meshes, others), mesh_hash }
    }
}

/// The meshes of the next frame.
#[derive(Debug, Default)]
struct NextMeshes {
    /// The files, or why they are not there.
    files: Vec<Result<(PathBuf, Vec<u8>), String>>,
    /// After this frame.
    seconds: f64,
}

/// The files of a frame as they were read, before anything is made of them.
#[derive(Debug)]
pub struct FrameSource {
    /// The frame's own meshes.
    pub(super) meshes: Vec<(PathBuf, Vec<u8>)>,
    /// Those of the next frame, where velocities follow from them.
    next: Option<NextMeshes>,
    /// The other files.
    pub(super) inputs: Inputs,
    /// What these bytes make of the picture.
    pub identity: Identity,
}

impl FrameSource {
    /// Reads the files of a frame.
    ///
    /// # Errors
    /// When one of them cannot be read.
    pub fn read(world: &World, fingerprints: &Fingerprints, task: &FrameTask) -> Result<Self, RenderError> {
        let meshes = task.files.iter().map(|path| task.contents(path)).collect::<Result<Vec<_>, _>>()?;
        let inputs = Inputs::of_frame(world, task.number, &task.files)?;
        let following = task.next.as_ref().filter(|_| world.follows_vertices());
        let next = following.map(|next| {
            let contents = |path: &PathBuf| match std::fs::read(path) {
                Ok(bytes) => Ok((path.clone(), bytes)),
                Err(error) => Err(format!("{}: {error}", path.display())),
            };
            let frames = (next.number.millionths() - task.number.millionths()) as f64 / 1e6;
            NextMeshes { files: next.files.iter().map(contents).collect(), seconds: frames / world.fps() }
        });
        Ok(Self::identified(fingerprints, task.number, meshes, next, inputs))
    }

    /// A frame whose files have been read.
    pub fn of(
        fingerprints: &Fingerprints,
        number: FrameNumber,
        meshes: Vec<(PathBuf, Vec<u8>)>,
        inputs: Inputs,
    ) -> Self {
        Self::identified(fingerprints, number, meshes, None, inputs)
    }

    fn identified(
        fingerprints: &Fingerprints,
        number: FrameNumber,
        meshes: Vec<(PathBuf, Vec<u8>)>,
        next: Option<NextMeshes>,
        inputs: Inputs,
    ) -> Self {
        let hash = |bytes: &Vec<u8>| -> ContentHash { Sha256::digest(bytes).into() };
        let hashes: Vec<ContentHash> = meshes.iter().map(|(_, bytes)| hash(bytes)).collect();
        let mut others = inputs.hashes();
        if let Some(NextMeshes { files, seconds }) = &next {
            // Velocities are distances in this time, each mesh's to the next one in its own place.
            others.push(Sha256::digest(seconds.to_le_bytes()).into());
            others.extend(files.iter().map(|next| next.as_ref().map_or(NO_FILE, |(_, bytes)| hash(bytes))));
        }
        let identity = Identity::new(fingerprints, number, &hashes, &others);
        Self { meshes, next, inputs, identity }
    }

    /// The meshes in the very bytes that were hashed, and the rest.
    ///
    /// # Errors
    /// When a mesh is wrong.
    pub fn parse(self, world: &World) -> Result<Parsed, RenderError> {
        let velocity = world.velocity_name();
        let parse = |(path, bytes): (PathBuf, Vec<u8>)| {
            let mut mesh = mesh::parse(&bytes, &velocity, &path).map_err(FrameError::from)?;
            self.inputs.add_velocities(&mut mesh, &path, &velocity).map_err(FrameError::from)?;
            Ok(FrameMesh { path, mesh })
        };
        let mut meshes = self.meshes.into_iter().map(parse).collect::<Result<Vec<_>, RenderError>>()?;
        let mut warnings = Vec::new();
        if world.follows_vertices() {
            let NextMeshes { files, seconds } = self.next.unwrap_or_default();
            let mut files = files.into_iter();
            for mesh in &mut meshes {
                let unknown = follow_next(files.next(), seconds, mesh).err();
                warnings.extend(unknown.map(|why| format!("{}: {why}; {STANDS_STILL}", mesh.path.display())));
            }
        }
        Ok(Parsed { meshes, inputs: self.inputs, identity: self.identity, warnings })
    }
}

pub(super) const STANDS_STILL: &str = "nothing in it moves while the shutter is open";

/// Takes the velocities of a mesh from the next frame, or tells why not: whatever is wrong with that one, its turn is
/// still to come.
fn follow_next(
    next: Option<Result<(PathBuf, Vec<u8>), String>>,
    seconds: f64,
    mesh: &mut FrameMesh,
) -> Result<(), String> {
    let (path, bytes) = next.ok_or("there is no next frame to take velocities from")??;
    let parse = || Ok(mesh::parse(&bytes, &VelocityName::Nothing, &path).map_err(FrameError::from)?);
    let after = guarded(&path, parse).map_err(|e| format!("the next frame cannot be followed: {e}"))?;
    mesh::follow(&mut mesh.mesh, &after, seconds).map_err(|e| e.to_string())
}

/// What the files of a frame say.
#[derive(Debug)]
pub struct Parsed {
    /// The frame's own meshes.
    pub meshes: Vec<FrameMesh>,
    /// The other files.
    pub inputs: Inputs,
    /// Which frame it is.
    pub identity: Identity,
    /// What the user should look at.
    pub warnings: Vec<String>,
}
