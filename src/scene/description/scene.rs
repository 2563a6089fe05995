//! The scene file as a whole: reading, the list of its tables, and what the tables say about each other.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use toml::de::DeTable;

use super::document::{Source, Table};
use super::error::SceneError;
use super::{Axis, Daylight, OutputDescription, SceneDescription, SkyDescription, SunDescription};
use super::{camera, domain, frames, media, meshes, output, regions, render, sky, sun, surfaces};

/// Longest scene file that is read: measured tables of spectra fit in many times, meshes given by mistake do
/// not.
const LONGEST: u64 = 16 << 20;

impl SceneDescription {
    /// Reads a scene file.
    ///
    /// # Errors
    /// [`SceneError`], with the place of what is wrong.
    pub fn from_file(file: &Path) -> Result<Self, SceneError> {
        let io = |source| SceneError::Io { file: file.to_owned(), source };
        let mut bytes = Vec::new();
        File::open(file).and_then(|opened| opened.take(LONGEST + 1).read_to_end(&mut bytes)).map_err(io)?;
        if bytes.len() as u64 > LONGEST {
            return Err(SceneError::TooLong { file: file.to_owned(), limit: LONGEST });
        }
        match std::str::from_utf8(&bytes) {
            Ok(text) => Self::parse(text, file),
            Err(error) => {
                let readable = String::from_utf8_lossy(&bytes[..error.valid_up_to()]);
                let place = Source { text: &readable, file }.place(readable.len());
                let message = "the bytes here are not UTF-8: save the file as UTF-8".to_owned();
                Err(SceneError::Syntax { place, message })
            }
        }
    }

    /// Reads the text of a scene file; `file` is named in messages, and its folder is what inputs are
    /// relative to.
    ///
    /// # Errors
    /// [`SceneError`], with the place of what is wrong.
    pub fn parse(text: &str, file: &Path) -> Result<Self, SceneError> {
        let source = Source { text, file };
        let root = DeTable::parse(text).map_err(|error| SceneError::Syntax {
            place: source.place(error.span().map_or(0, |span| span.start)),
            message: error.message().to_owned(),
        })?;
        read(source, Table::new(source, String::new(), 0, root.get_ref()))
    }
}

/// Reads every table. Unknown ones are reported first: a mistyped name explains most errors that would
/// follow.
fn read(source: Source<'_>, root: Table<'_>) -> Result<SceneDescription, SceneError> {
    let [frames, meshes, regions, domain, media, surfaces, sun, sky, camera, render, output] = [
        "frames", "meshes", "regions", "domain", "media", "surfaces", "sun", "sky", "camera", "render",
        "output",
    ]
    .map(|name| root.get(name));
    root.finish()?;
    let frames = frames.map(|table| frames::read(&table, meshes.is_some())).transpose()?;
    let media = media.map_or_else(|| Ok(media::air_alone()), |table| media::read(&table))?;
    let regions =
        regions.map_or_else(|| Ok(regions::air_outside()), |table| regions::read(&table, &media))?;
    if let (Some(_), Some(domain)) = (&meshes, &domain) {
        return Err(domain
            .invalid("a domain is that of the one mesh of frames.path: leave out [domain] or [[meshes]]"));
    }
    let around = meshes::Around { frames: frames.as_ref(), regions: &regions, media: &media };
    let meshes = meshes.map_or_else(|| Ok(Vec::new()), |tables| meshes::read(&tables, &around))?;
    let up = frames.as_ref().map_or(Axis::Z, |frames| frames.up);
    let suns = sun.map_or_else(|| Ok(Vec::new()), |tables| sun::tables(tables))?;
    let sky =
        sky.map_or_else(|| Ok(SkyDescription::default()), |table| sky::read(&table, !suns.is_empty()))?;
    let suns = sun::read(&suns, up, &sky)?;
    let by_default = by_default(&sky, &suns, up);
    Ok(SceneDescription {
        file: source.file.to_owned(),
        directory: directory(source.file).to_owned(),
        meshes,
        regions,
        domain: domain.map(|table| domain::read(&table)).transpose()?,
        surfaces: surfaces.map_or_else(|| Ok(Vec::new()), |table| surfaces::read(&table, &media))?,
        suns,
        sky,
        camera: camera::read(camera.as_ref(), up)?,
        render: render.map_or_else(|| Ok(Default::default()), |table| render::read(&table))?,
        output: match output {
            Some(table) => output::read(&table, by_default)?,
            None => by_default,
        },
        frames,
        media,
    })
}

/// `[output]` where it says nothing: pictures under a clear sky, whose radiances are absolute, are exposed for it.
fn by_default(sky: &SkyDescription, suns: &[SunDescription], up: Axis) -> OutputDescription {
    let exposure = match sky {
        SkyDescription::Clear(_) => Daylight::new(suns, sky, up).exposure(),
        _ => 0.0,
    };
    OutputDescription { exposure, ..OutputDescription::default() }
}

/// The folder of a file; that of a bare name is the current one.
fn directory(file: &Path) -> &Path {
    match file.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}
