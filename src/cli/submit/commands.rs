//! A command line a task: what GNU parallel reads, and what every other scheduler runs one line of.

use clap::Args;

use super::common::Common;
use super::work::{Work, absolute};
use super::{Papers, Refusal, shell};

#[derive(Debug, Args)]
pub struct CommandsArguments {
    #[command(flatten)]
    pub common: Common,
}

const LINES: &str = "commands.txt";
const TASK: &str = "task.sh";

pub fn papers(arguments: &CommandsArguments, work: &Work) -> Result<Papers, Refusal> {
    let common = &arguments.common;
    let tasks = common.tasks(work.numbers.len(), usize::MAX)?;
    common.check_given(&["--shard"])?;
    if common.time.is_some() || common.memory.is_some() {
        return Err(
            "lines of a shell have no place for --time and --memory: tell the scheduler that runs them"
                .to_owned()
                .into(),
        );
    }
    let lines = (1..=tasks).map(|task| {
        let mut choice = work.all_frames();
        choice.push(format!("--shard={task}/{tasks}"));
        shell::line(work.render(&choice)) + "\n"
    });
    let folder = common.write.as_deref().map(absolute).transpose()?;
    let path = |name: &str| match &folder {
        Some(folder) => shell::quoted(&format!("{folder}/{name}")),
        None => name.into(),
    };
    let next = format!(
        "{} in {tasks} tasks, a line each; GNU parallel: parallel --joblog tasks.log < {}",
        work.count(),
        path(LINES)
    );
    let then = shell::line(work.status(&work.expected_frames()));
    let numbered = format!("a scheduler that counts tasks from 1: sh {} NUMBER", path(TASK));
    Ok(Papers {
        tasks,
        files: vec![(LINES, lines.collect()), (TASK, task_script())],
        once_printed: format!("# {next}\n# then: {then}"),
        once_written: format!("{next}\n{numbered}\nthen: {then}"),
    })
}

/// Runs a line of the file beside it, in whose place floe gets the signals.
fn task_script() -> String {
    format!(
        "#!/bin/sh
# Runs one line of {LINES}: sh {TASK} NUMBER, from 1.
line=$(sed -n \"${{1:?the number of a task}}p\" \"$(dirname \"$0\")/{LINES}\")
exec sh -c \"exec ${{line:?there is no such task}}\"
"
    )
}
