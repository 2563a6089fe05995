//! Quick pictures for framing: a quarter of the width and height, few samples, and a folder of their own.

use std::path::{Path, PathBuf};

use super::error::RenderError;
use super::job::Job;
use super::render::RenderOptions;

/// Edge of a pixel of a preview in pixels of the picture.
const COARSENESS: u32 = 4;

/// Most samples in a pixel of a preview.
const SAMPLES: u32 = 16;

/// Opens a scene as [`Job::open`] does, but coarsely, with its pictures where [`place`] says.
///
/// # Errors
/// Those of [`Job::open`].
pub fn open(path: &Path) -> Result<Job, RenderError> {
    let mut job = Job::open_changed(path, |scene| {
        scene.camera.resolution = scene.camera.resolution.map(|n| (n / COARSENESS).max(1));
        scene.render.samples = scene.render.samples.min(SAMPLES);
    })?;
    job.world.description.output.path = Some(place(&job.output_pattern()));
    Ok(job)
}

/// What is asked for, for a preview: its pictures where [`place`] says, and no more samples than it may have.
pub fn options(options: RenderOptions) -> RenderOptions {
    RenderOptions {
        output: options.output.as_deref().map(place),
        samples: options.samples.map(|samples| samples.min(SAMPLES)),
        look: true,
        ..options
    }
}

/// The pattern for previews of pictures: the folder `preview` beside them, so that neither they nor their ledger are
/// taken for each other.
pub fn place(pattern: &str) -> String {
    let path = Path::new(pattern);
    let name: PathBuf = path.file_name().map(PathBuf::from).unwrap_or_default();
    path.with_file_name("preview").join(name).to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn previews_have_a_folder_of_their_own() {
        assert_eq!(place("out/ice/frame_####.exr"), "out/ice/preview/frame_####.exr");
        assert_eq!(place("shot.exr"), "preview/shot.exr");
    }
}
