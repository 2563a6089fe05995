//! Templates of Open Job Description: one whose scheduler makes chunks of frames, and one for schedulers that cannot.
//!
//! They are YAML in which every text is written as JSON, which YAML reads alike.

use std::fmt::Write;

use clap::Args;

use super::common::Common;
use super::work::{Work, absolute};
use super::{Papers, Refusal, shell};

#[derive(Debug, Args)]
pub struct OpenjdArguments {
    #[command(flatten)]
    pub common: Common,
    /// Print the template that does without the extension TASK_CHUNKING
    #[arg(long)]
    plain: bool,
}

const CHUNKED: &str = "template.yaml";
const PLAIN: &str = "plain.yaml";

/// Longest default of a job parameter.
const LONGEST: usize = 1024;

/// What a session shows is read from standard output.
const PROGRESS: &str = "--progress=openjd";

/// Seconds from the request to stop to the kill; floe has saved its frame in two, or as soon as a large one is written.
const NOTICE: u32 = 30;

pub fn papers(arguments: &OpenjdArguments, work: &Work) -> Result<Papers, Refusal> {
    let common = &arguments.common;
    let tasks = common.tasks(work.numbers.len(), usize::MAX)?;
    common.check_given(&["--shard", "--progress"])?;
    if let Some(word) = work.render(&[]).find(|word| word.contains("{{")) {
        return Err(format!("{word}: templates take {{{{ for the start of a variable; rename it").into());
    }
    let plain = template(common, work, &shards(work, tasks))?;
    let mut files = vec![(PLAIN, plain)];
    // A still has no frames that a scheduler could divide.
    if let Some(frames) = range(work)? {
        files.insert(
            usize::from(arguments.plain),
            (CHUNKED, template(common, work, &chunks(work, &frames, tasks))?),
        );
    }
    let about = format!("{} in {tasks} tasks", work.count());
    let folder = common.write.as_deref().map(absolute).transpose()?.unwrap_or_default();
    let path = |name: &str| shell::quoted(&format!("{folder}/{name}"));
    let (first, _) = files[0];
    let once_printed =
        format!("# {about}; as a file {first}: openjd check {first}; openjd run {first} --step Render");
    let once_written = files.iter().fold(about, |text, (name, _)| {
        format!("{text}\n  openjd check {0}; openjd run {0} --step Check --run-dependencies", path(name))
    });
    Ok(Papers { tasks, files, once_printed, once_written })
}

/// What parts the frames among tasks.
struct Division {
    extension: bool,
    /// Lines of `parameterDefinitions`.
    job: String,
    /// Lines of `taskParameterDefinitions`.
    task: String,
    /// Words that choose the frames of a task.
    choice: Vec<String>,
    /// Words that choose all frames.
    all: Vec<String>,
}

fn chunks(work: &Work, frames: &str, tasks: usize) -> Division {
    let count = work.numbers.len();
    let size = count.div_ceil(tasks);
    Division {
        extension: true,
        job: format!(
            "parameterDefinitions:
  - name: Frames
    type: STRING
    default: {frames:?}
  - name: FrameCount
    type: INT
    minValue: 1
    default: {count}
    description: How many Frames are, so that one that never came is missed
  - name: ChunkSize
    type: INT
    minValue: 1
    default: {size}
"
        ),
        task: "          - name: Frame
            type: CHUNK[INT]
            range: \"{{Param.Frames}}\"
            chunks:
              defaultTaskCount: \"{{Param.ChunkSize}}\"
              rangeConstraint: NONCONTIGUOUS
"
        .into(),
        choice: vec!["--frames={{Task.Param.Frame}}".into(), PROGRESS.into()],
        // A chunk is a range, and ranges take what is there.
        all: ["--frames={{Param.Frames}}", "--expect={{Param.FrameCount}}"].map(String::from).into(),
    }
}

fn shards(work: &Work, tasks: usize) -> Division {
    let mut choice = work.all_frames();
    choice.extend([format!("--shard={{{{Task.Param.Shard}}}}/{tasks}"), PROGRESS.into()]);
    Division {
        extension: false,
        job: String::new(),
        task: format!("          - name: Shard\n            type: INT\n            range: \"1-{tasks}\"\n"),
        choice,
        all: work.expected_frames(),
    }
}

/// The frames in the words of Open Job Description; none of a still.
fn range(work: &Work) -> Result<Option<String>, Refusal> {
    if work.frames.is_none() {
        return Ok(None);
    }
    if let Some(number) = work.numbers.iter().find(|number| number.integer().is_none()) {
        return Err(format!(
            "frame {number}: Open Job Description counts in whole numbers; choose others by --frames"
        )
        .into());
    }
    let range = crate::sequence::format_numbers(&work.numbers).replace('x', ":");
    if range.len() > LONGEST {
        let length = range.len();
        return Err(format!(
            "the frames, written as ranges, are {length} characters long, and {LONGEST} is the most that a template takes: \
             submit them in parts by --frames"
        )
        .into());
    }
    Ok(Some(range))
}

fn template(common: &Common, work: &Work, division: &Division) -> Result<String, Refusal> {
    let mut text = String::from("specificationVersion: jobtemplate-2023-09\n");
    if division.extension {
        text += "extensions: [TASK_CHUNKING]\n";
    }
    let _ = write!(text, "name: {}\n{}", yaml(&work.name), division.job);
    text += "steps:\n  - name: Render\n    parameterSpace:\n      taskParameterDefinitions:\n";
    text += &division.task;
    text += &requirements(common);
    text += &script(work.render(&division.choice), common);
    text += "  - name: Check\n    dependencies:\n      - dependsOn: Render\n";
    text += &script(work.status(&division.all), common);
    Ok(text)
}

fn requirements(common: &Common) -> String {
    let amounts = [
        ("vcpu", common.cpus.map(u64::from)),
        ("memory", common.memory), // in MiB
    ];
    let mut lines = String::new();
    for (name, least) in amounts {
        if let Some(least) = least {
            let _ = write!(lines, "        - name: amount.worker.{name}\n          min: {least}\n");
        }
    }
    if lines.is_empty() { lines } else { format!("    hostRequirements:\n      amounts:\n{lines}") }
}

fn script<'a>(words: impl Iterator<Item = &'a str>, common: &Common) -> String {
    let mut words = words.map(yaml);
    let program = words.next().unwrap_or_default();
    let mut text = format!(
        "    script:\n      actions:\n        onRun:\n          command: {program}\n          args:\n"
    );
    for word in words {
        let _ = writeln!(text, "            - {word}");
    }
    if let Some(time) = common.time {
        let _ = writeln!(text, "          timeout: {}", time.as_secs().max(1));
    }
    text + &format!(
        "          cancelation:\n            mode: NOTIFY_THEN_TERMINATE\n            notifyPeriodInSeconds: {NOTICE}\n"
    )
}

fn yaml(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}
