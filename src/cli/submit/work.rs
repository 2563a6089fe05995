//! What is to be rendered, in words that mean the same on any machine that sees the same files.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use clap::Parser;

use super::common::Common;
use super::{Refusal, shell};
use crate::cli::streams::say;
use crate::cli::{Arguments, Command};
use crate::driver::{Job, RenderError, RenderOptions, check_pictures};
use crate::sequence::{FrameNumber, SequenceError, format_numbers};

/// More frames than anybody has: a range that is longer is a slip of the pen.
const MOST_FRAMES: usize = 10_000_000;

/// The frames and the settings of all tasks.
pub struct Work {
    /// The scene, with its frames as far as they are there.
    pub job: Job,
    /// Name of the scene, of letters, digits, `.`, `_` and `-`.
    pub name: String,
    /// The frames as a selection; none of a still.
    pub frames: Option<String>,
    /// Their numbers; that of a still is 1.
    pub numbers: Vec<FrameNumber>,
    /// The numbers that are there by now.
    pub there: BTreeSet<FrameNumber>,
    /// The program, then the scene.
    program: String,
    scene: String,
    /// Settings that `floe render` and `floe status` have in common, the output last.
    settings: Vec<String>,
    /// Options of `floe render`.
    options: Vec<String>,
    /// With what time a frame that was cut counts as complete.
    budget: Option<String>,
}

impl Work {
    /// Looks what there is to do, and whether it can be said.
    pub fn of(common: &Common) -> Result<Self, Refusal> {
        let options = common.settings.options();
        if options.shard.is_some() {
            return Err("--shard is what each task gets: say how many there are to be by --tasks"
                .to_owned()
                .into());
        }
        let job = opened(&common.settings.scene, &options)?;
        let numbers = numbers(&job, &options)?;
        let pattern = options.output.clone().unwrap_or_else(|| job.output_pattern());
        check_pictures(&pattern, numbers.len()).map_err(|error| match &options.output {
            Some(_) => error.to_string().into(),
            None => Refusal::from(error),
        })?;
        let frames = match &options.frames {
            Some(frames) => Some(frames.to_string()),
            None => (!is_still(&job)).then(|| format_numbers(&numbers)),
        };
        let program = match &common.program {
            Some(program) => program.clone(),
            None => absolute(&std::env::current_exe().unwrap_or_else(|_| "floe".into()))?,
        };
        let there = there(&job);
        told_missing(&there, &numbers);
        let work = Self {
            name: job.name.chars().map(|c| if is_plain(c) { c } else { '_' }).collect(),
            frames,
            program,
            scene: absolute(&job.world.description.file)?,
            settings: settings(&options, &absolute(Path::new(&pattern))?),
            options: render_options(common),
            budget: None,
            numbers,
            there,
            job,
        };
        let tasks = work.check(&options)?;
        let budget = tasks.time_budget.map(|time| format!("--time-budget={}s", time.as_secs_f64()));
        Ok(Self { budget, ..work })
    }

    /// The words of the command that renders some frames, chosen by `choice`.
    pub fn render<'a>(&'a self, choice: &'a [String]) -> impl Iterator<Item = &'a str> {
        let start = [self.program.as_str(), "render", self.scene.as_str()];
        start
            .into_iter()
            .chain([choice, &self.settings, &self.options].into_iter().flatten().map(String::as_str))
    }

    /// The words of the command that says whether all is there.
    pub fn status<'a>(&'a self, choice: &'a [String]) -> impl Iterator<Item = &'a str> {
        let start = [self.program.as_str(), "status", self.scene.as_str()];
        let words = choice.iter().chain(&self.settings).chain(&self.budget).map(String::as_str);
        start.into_iter().chain(words).chain(["--require-complete"])
    }

    /// The words of the command that tells of the whole sequence by its ledgers.
    pub fn report<'a>(&'a self, choice: &'a [String]) -> impl Iterator<Item = &'a str> {
        let output = self.settings.last();
        [self.program.as_str(), "report", self.scene.as_str()]
            .into_iter()
            .chain(choice.iter().chain(output).map(String::as_str))
    }

    /// `--frames` of all.
    pub fn all_frames(&self) -> Vec<String> {
        self.frames.iter().map(|frames| format!("--frames={frames}")).collect()
    }

    /// The same, and how many `floe status` is to find: ranges take what there is.
    pub fn expected_frames(&self) -> Vec<String> {
        let expected = format!("--expect={}", self.numbers.len());
        self.all_frames().into_iter().chain([expected]).collect()
    }

    /// How many frames, in words.
    pub fn count(&self) -> String {
        let count = self.numbers.len();
        if count == 1 { "1 frame".into() } else { format!("{count} frames") }
    }

    /// What `floe render` would refuse is refused here, and not by a thousand machines; so is what makes other pictures than
    /// those that the check looks for. What is asked of the tasks.
    fn check(&self, settings: &RenderOptions) -> Result<RenderOptions, Refusal> {
        let all = self.all_frames();
        let words: Vec<&str> = self.render(&all).collect();
        if let Some(word) = words.iter().find(|word| word.contains(char::is_control)) {
            return Err(
                format!("{word:?} has a line break or another control character in it: rename it").into()
            );
        }
        let parsed = Arguments::try_parse_from(std::iter::once("floe").chain(words[1..].iter().copied()));
        let parsed = parsed.map_err(|error| {
            let reason = error.to_string();
            let reason = reason.lines().next().unwrap_or_default().trim_start_matches("error: ");
            let command = shell::line(words.iter().copied());
            format!(
                "tasks could not run `{command}`: {reason}; what follows -- has to be options of floe render"
            )
        })?;
        let Command::Render(render) = parsed.command else { return Ok(settings.clone()) };
        let tasks = render.options();
        let pixels = |of: &RenderOptions| (of.samples, of.target_error, of.seed);
        if pixels(&tasks) != pixels(settings) {
            return Err("--samples, --target-error and --seed have to be known to the check too: write them before the --"
                .to_owned()
                .into());
        }
        if tasks.samples_range.is_some() || render.preview {
            return Err("with --samples-range or --preview no task makes a whole picture: leave it out"
                .to_owned()
                .into());
        }
        Ok(tasks)
    }
}

/// The scene; of frames that are asked for none need be there yet.
fn opened(scene: &Path, options: &RenderOptions) -> Result<Job, RenderError> {
    match Job::open(scene) {
        Err(RenderError::Sequence(error)) if options.frames.is_some() => {
            // Without its meshes nobody knows where the camera of such a scene is.
            let none = |folder: &Path, wanted: &str| {
                let (folder, wanted) = (folder.into(), wanted.to_owned());
                Err(RenderError::Sequence(SequenceError::NothingFound { folder, wanted }))
            };
            Job::open_on(scene, &none).map_err(|_| RenderError::Sequence(error))
        }
        opened => opened,
    }
}

fn numbers(job: &Job, options: &RenderOptions) -> Result<Vec<FrameNumber>, Refusal> {
    let Some(selection) = &options.frames else {
        return Ok(job.tasks().iter().map(|task| task.number).collect());
    };
    let mut numbers: Vec<FrameNumber> = selection.numbers().take(MOST_FRAMES + 1).collect();
    if numbers.len() > MOST_FRAMES {
        return Err(format!("--frames {selection} are more than {MOST_FRAMES} frames: ask for fewer").into());
    }
    // Ranges hold decimal numbers too, where there are any.
    numbers.extend(job.files.iter().map(|file| file.number).filter(|number| selection.contains(*number)));
    numbers.sort_unstable();
    numbers.dedup();
    Ok(numbers)
}

fn is_still(job: &Job) -> bool {
    job.world.description.frames.is_none() && job.world.description.meshes.is_empty()
}

fn there(job: &Job) -> BTreeSet<FrameNumber> {
    let still = is_still(job).then_some(FrameNumber::ONE);
    job.files.iter().map(|file| file.number).chain(still).collect()
}

/// Frames that are asked for before they are there may be meant, or a slip of the pen.
fn told_missing(there: &BTreeSet<FrameNumber>, numbers: &[FrameNumber]) {
    let missing: Vec<FrameNumber> =
        numbers.iter().copied().filter(|number| !there.contains(number)).collect();
    if !missing.is_empty() {
        say(&format!("# not there yet: {}", format_numbers(&missing)));
    }
}

fn settings(options: &RenderOptions, output: &str) -> Vec<String> {
    let given = [
        ("samples", options.samples.map(|samples| samples.to_string())),
        ("target-error", options.target_error.map(|error| error.to_string())),
        ("seed", options.seed.map(|seed| seed.to_string())),
        ("output", Some(output.to_owned())),
    ];
    given.into_iter().filter_map(|(name, value)| Some(format!("--{name}={}", value?))).collect()
}

fn render_options(common: &Common) -> Vec<String> {
    let always = ["--resume", "--keep-going"].map(String::from);
    let threads = common.cpus.map(|cpus| format!("--threads={cpus}"));
    always.into_iter().chain(threads).chain(common.render.iter().cloned()).collect()
}

fn is_plain(c: char) -> bool {
    c.is_ascii_alphanumeric() || matches!(c, '.' | '_' | '-')
}

/// A path that means the same in every folder.
pub fn absolute(path: &Path) -> Result<String, Refusal> {
    let path = std::path::absolute(path).unwrap_or_else(|_| PathBuf::from(path));
    let text = path.to_str().map(str::to_owned);
    text.ok_or_else(|| {
        format!("{}: the name is not UTF-8, and a script is; rename it", path.display()).into()
    })
}
