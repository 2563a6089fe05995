//! Movies by ffmpeg: H.264 in MP4, VP9 in WebM, or a GIF with a palette of its own.
//!
//! ffmpeg gets one picture after the other from a temporary folder: links to the PNGs, tone-mapped copies of EXRs without
//! one, and for frames that are missing the frame before them once more, so that time runs on. Colours are declared as
//! Rec. 709 with the sRGB curve, which the pictures have; without that, players guess by the size of the picture. Sizes
//! that are odd get one more row or column of black, since both codecs halve the resolution of colours.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::Duration;

use super::error::MovieError;
use super::pictures::{Pictures, is};
use crate::driver::Interrupt;
use crate::film::FilmError;
use crate::film::write::StagedFile;
use crate::sequence::{FrameFile, Gap, gaps};

/// The worst quality of H.264.
const WORST_MP4: u8 = 51;

/// Most frames that are held in place of missing ones: seven minutes at 24 a second, and as many links to pictures.
const MOST_HELD: i64 = 10_000;

/// How a movie is made.
#[derive(Clone, Debug, PartialEq)]
pub struct EncodeOptions {
    /// The movie: .mp4, .webm or .gif.
    pub output: PathBuf,
    /// Frames a second; `None` is what the scene or the pictures say.
    pub fps: Option<f64>,
    /// Quality of MP4 (0 to 51) and WebM (0 to 63), less is better; `None` is 18, or 30 for WebM.
    pub crf: Option<u8>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Mp4,
    WebM,
    Gif,
}

impl EncodeOptions {
    /// What kind of movie is asked for.
    ///
    /// # Errors
    /// When there is no such kind, or not of this quality.
    pub(crate) fn check(&self) -> Result<Kind, MovieError> {
        let kind = kind(&self.output)?;
        match self.crf {
            Some(crf) if kind == Kind::Mp4 && crf > WORST_MP4 => {
                Err(MovieError::Quality { path: self.output.clone(), crf, most: WORST_MP4 })
            }
            _ => Ok(kind),
        }
    }
}

/// Makes a movie; `warn` hears of frames that are missing. Returns how many frames it has. When the `interrupt` is
/// requested, ffmpeg is ended and everything temporary removed.
///
/// # Errors
/// When a picture is damaged or has another size, when ffmpeg is not there or fails, or the movie cannot be written.
/// Nothing is left of it then.
pub fn encode(
    pictures: &Pictures,
    options: &EncodeOptions,
    interrupt: &Interrupt,
    mut warn: impl FnMut(String),
) -> Result<usize, MovieError> {
    let kind = options.check()?;
    let frames = in_time(&pictures.files)?;
    let fps = options.fps.unwrap_or(pictures.fps);
    let arguments = |input: &Path, first: &str, output: &Path| {
        let input = ["-start_number", first, "-i"].map(String::from).into_iter().chain([text(input)]);
        let output = codec(kind, options.crf).into_iter().chain([text(output)]);
        general(fps).into_iter().chain(input).chain(output).collect::<Vec<String>>()
    };
    if !is_there() {
        let first = &pictures.files[0];
        let input = numbered_name(&first.path.with_extension("png"));
        let shown = arguments(&input, &first.number.to_string(), &options.output);
        return Err(MovieError::NoFfmpeg { command: command_line(&shown) });
    }
    for gap in gaps(&pictures.files) {
        warn(format!("frame {gap} is missing: the frame before it is held"));
    }
    let folder = staged(pictures, &frames, interrupt)?;
    let movie = StagedFile::new(&options.output, &[])?;
    run(&arguments(&folder.path().join("%08d.png"), "0", movie.path()), interrupt)?;
    movie.commit()?;
    Ok(frames.len())
}

fn kind(output: &Path) -> Result<Kind, MovieError> {
    let kinds = [("mp4", Kind::Mp4), ("webm", Kind::WebM), ("gif", Kind::Gif)];
    let found = kinds.into_iter().find(|(extension, _)| is(output, extension));
    found.map(|(_, kind)| kind).ok_or_else(|| MovieError::UnknownKind { path: output.into() })
}

/// What comes before the input.
fn general(fps: f64) -> Vec<String> {
    let fixed = ["-hide_banner", "-nostdin", "-loglevel", "error", "-y", "-framerate"];
    fixed.into_iter().map(String::from).chain([fps.to_string()]).collect()
}

/// What comes between input and output.
fn codec(kind: Kind, crf: Option<u8>) -> Vec<String> {
    const EVEN: &str = "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv";
    const COLOURS: &str =
        "-pix_fmt yuv420p -colorspace bt709 -color_primaries bt709 -color_trc iec61966-2-1 -color_range tv";
    let crf = |usual: u8| crf.unwrap_or(usual);
    let text = match kind {
        Kind::Mp4 => format!("-vf {EVEN} -c:v libx264 -crf {} {COLOURS} -movflags +faststart", crf(18)),
        Kind::WebM => format!("-vf {EVEN} -c:v libvpx-vp9 -crf {} -b:v 0 -row-mt 1 {COLOURS}", crf(30)),
        Kind::Gif => "-vf split[a][b];[a]palettegen[p];[b][p]paletteuse -loop 0".into(),
    };
    let container = match kind {
        Kind::Mp4 => "mp4",
        Kind::WebM => "webm",
        Kind::Gif => "gif",
    };
    // No date and no version of ffmpeg: the same pictures make the same file.
    let reproducible =
        ["-map_metadata", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact", "-f", container];
    text.split(' ').chain(reproducible).map(String::from).collect()
}

/// One picture for each moment: those of gaps are the ones before them.
fn in_time(files: &[FrameFile]) -> Result<Vec<&FrameFile>, MovieError> {
    let mut gaps = gaps(files).into_iter().peekable();
    let mut frames: Vec<&FrameFile> = Vec::new();
    let mut held = 0;
    for file in files {
        let follows = |gap: &Gap| gap.last < file.number;
        if let (Some(gap), Some(&before)) = (gaps.next_if(follows), frames.last()) {
            let missing = gap.last.integer().zip(gap.first.integer()).map(|(last, first)| last - first);
            let missing = missing.map_or(0, |way| way / gap.step + 1);
            held += missing;
            if held > MOST_HELD {
                return Err(MovieError::Gap { path: file.path.clone(), gap, count: held, most: MOST_HELD });
            }
            frames.extend(std::iter::repeat_n(before, missing as usize));
        }
        frames.push(file);
    }
    Ok(frames)
}

/// A temporary folder with `00000000.png`, `00000001.png`, ...
fn staged(
    pictures: &Pictures,
    frames: &[&FrameFile],
    interrupt: &Interrupt,
) -> Result<tempfile::TempDir, MovieError> {
    let cannot = |path: &Path, source| FilmError::CannotCreate { path: path.into(), source };
    let folder = tempfile::tempdir().map_err(|source| cannot(&std::env::temp_dir(), source))?;
    let mut size = None;
    let mut before: Option<(&FrameFile, PathBuf)> = None;
    for (i, &file) in frames.iter().enumerate() {
        if interrupt.is_requested() {
            return Err(MovieError::Interrupted);
        }
        let name = folder.path().join(format!("{i:08}.png"));
        let source = match &before {
            Some((held, path)) if *held == file => path.clone(),
            _ => source(pictures, file, folder.path(), &mut size)?,
        };
        link(&source, &name).map_err(|source| cannot(&name, source))?;
        before = Some((file, source));
    }
    Ok(folder)
}

/// The PNG of a picture: the file itself, or one made of an EXR. All have the size of the first.
fn source(
    pictures: &Pictures,
    file: &FrameFile,
    folder: &Path,
    size: &mut Option<[u32; 2]>,
) -> Result<PathBuf, MovieError> {
    let picture = pictures.read(file)?;
    let found = [picture.width(), picture.height()];
    let expected = *size.get_or_insert(found);
    if found != expected {
        return Err(MovieError::Size { path: file.path.clone(), found, expected });
    }
    let path = &file.path;
    if is(path, "png") {
        return path
            .canonicalize()
            .map_err(|e| MovieError::Picture { path: path.clone(), reason: e.to_string() });
    }
    let copy = folder.join(format!("shown_{}.png", file.number));
    let saved = picture.save_with_format(&copy, image::ImageFormat::Png);
    saved.map_err(|error| FilmError::CannotCreate {
        path: copy.clone(),
        source: std::io::Error::other(error),
    })?;
    Ok(copy)
}

#[cfg(unix)]
fn link(source: &Path, name: &Path) -> std::io::Result<()> {
    std::os::unix::fs::symlink(source, name)
}

#[cfg(not(unix))]
fn link(source: &Path, name: &Path) -> std::io::Result<()> {
    std::fs::copy(source, name).map(drop)
}

/// The name with `%04d` in place of its last number, which ffmpeg counts up.
fn numbered_name(picture: &Path) -> PathBuf {
    let name = picture.file_name().unwrap_or_default().to_string_lossy();
    let is_digit = |c: char| c.is_ascii_digit();
    let Some(end) = name.rfind(is_digit).map(|at| at + 1) else { return picture.into() };
    let start = name[..end].trim_end_matches(is_digit).len();
    picture.with_file_name(format!("{}%0{}d{}", &name[..start], end - start, &name[end..]))
}

fn is_there() -> bool {
    let silent = Command::new("ffmpeg").arg("-version").stdin(Stdio::null()).output();
    !silent.is_err_and(|error| error.kind() == std::io::ErrorKind::NotFound)
}

fn run(arguments: &[String], interrupt: &Interrupt) -> Result<(), MovieError> {
    let failed = |status: String, message: &str| MovieError::Ffmpeg {
        status,
        message: message.into(),
        command: command_line(arguments),
    };
    let mut command = Command::new("ffmpeg");
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    let broken = |error: std::io::Error| failed("it did not start".into(), &error.to_string());
    let mut ffmpeg = command.spawn().map_err(broken)?;
    let said = ffmpeg.stderr.take();
    let (status, said) = thread::scope(|scope| {
        // It waits when nobody takes what it says.
        let listener = scope.spawn(|| {
            let mut text = Vec::new();
            said.map(|mut said| said.read_to_end(&mut text));
            text
        });
        (wait(&mut ffmpeg, interrupt), listener.join().unwrap_or_default())
    });
    let status = status.map_err(broken)?;
    // What is asked to stop from a terminal is asked together with ffmpeg, which may be the first to end.
    if interrupt.is_requested() {
        return Err(MovieError::Interrupted);
    }
    if status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&said);
    let lines: Vec<&str> = said.trim().lines().collect();
    Err(failed(status.to_string(), &lines[lines.len().saturating_sub(5)..].join("\n")))
}

/// Waits for a program to end, and ends it when that is asked for.
fn wait(program: &mut Child, interrupt: &Interrupt) -> std::io::Result<ExitStatus> {
    loop {
        if let Some(status) = program.try_wait()? {
            return Ok(status);
        }
        if interrupt.is_requested() {
            program.kill()?;
            return program.wait();
        }
        thread::sleep(Duration::from_millis(10));
    }
}

fn text(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

/// The command as one would type it.
fn command_line(arguments: &[String]) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./:+=,%#".contains(c);
    let quoted = |a: &String| if a.chars().all(plain) { a.clone() } else { format!("'{a}'") };
    std::iter::once("ffmpeg".to_owned()).chain(arguments.iter().map(quoted)).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbered(numbers: &[&str]) -> Vec<FrameFile> {
        numbers.iter().map(|n| FrameFile { number: n.parse().unwrap(), path: PathBuf::from(n) }).collect()
    }

    #[test]
    fn frames_that_are_missing_are_those_before_them() {
        for (there, shown) in [
            (vec!["1", "2", "3"], "1 2 3"),
            (vec!["1", "2", "5", "6", "8"], "1 2 2 2 5 6 6 8"),
            (vec!["10", "20", "50"], "10 20 20 20 50"),
            (vec!["1.5", "4", "9"], "1.5 4 9"),
            (vec!["7"], "7"),
        ] {
            let files = numbered(&there);
            let names: Vec<String> = in_time(&files).unwrap().iter().map(|f| f.number.to_string()).collect();
            assert_eq!(names.join(" "), shown);
        }
    }

    #[test]
    fn gaps_that_nobody_wants_to_watch_are_refused() {
        assert_eq!(in_time(&numbered(&["0", "1", "10002"])).unwrap().len(), 10_003);
        for there in [["1", "2", "20000000"], ["1", "10004", "10005"], ["0", "1", "100000000000"]] {
            let text = in_time(&numbered(&there)).unwrap_err().to_string();
            assert!(text.contains("at most 10000") && text.contains("missing"), "{text}");
        }
        // Every ten thousandth frame is no gap.
        assert_eq!(in_time(&numbered(&["0", "20000000", "40000000"])).unwrap().len(), 3);
    }

    #[test]
    fn a_command_can_be_typed() {
        let arguments = ["-i", "a b.png", "out/c_%04d.png", "split[a];b"].map(String::from);
        assert_eq!(command_line(&arguments), "ffmpeg -i 'a b.png' out/c_%04d.png 'split[a];b'");
    }

    #[test]
    fn numbers_in_names_are_those_that_ffmpeg_counts() {
        for (name, counted) in
            [("a1/frame_0012.png", "a1/frame_%04d.png"), ("7.png", "%01d.png"), ("still.png", "still.png")]
        {
            assert_eq!(numbered_name(Path::new(name)), Path::new(counted));
        }
    }

    #[test]
    fn the_name_tells_the_kind() {
        assert_eq!(kind(Path::new("a/b.MP4")).unwrap(), Kind::Mp4);
        assert!(kind(Path::new("a/b.avi")).unwrap_err().to_string().contains(".webm"));
    }
}
