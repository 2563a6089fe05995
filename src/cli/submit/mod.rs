//! `floe submit`: one file a scheduler. A task renders a share of the frames; the scheduler is somebody else's.

mod commands;
mod common;
mod openjd;
mod shell;
mod site;
mod slurm;
mod trial;
mod work;

use std::path::Path;

use clap::{Args, Subcommand};

use super::exit::Exit;
use super::files::write;
use super::streams::{print, say};
use crate::driver::RenderError;
use work::Work;

#[derive(Debug, Args)]
pub struct SubmitArguments {
    #[command(subcommand)]
    scheduler: Scheduler,
}

#[derive(Debug, Subcommand)]
enum Scheduler {
    /// A batch script for Slurm: an array of tasks, and a job after it that looks whether all is there
    Slurm(slurm::SlurmArguments),
    /// A template of Open Job Description, as AWS Deadline Cloud takes it
    Openjd(openjd::OpenjdArguments),
    /// A command line a task, for GNU parallel, OpenCue, HTCondor, PBS and others
    Commands(commands::CommandsArguments),
}

/// Why nothing is written.
struct Refusal {
    exit: Exit,
    text: String,
}

impl From<String> for Refusal {
    fn from(text: String) -> Self {
        Self { exit: Exit::Usage, text }
    }
}

impl From<RenderError> for Refusal {
    fn from(error: RenderError) -> Self {
        Self { exit: Exit::from(&error), text: error.to_string() }
    }
}

/// How many tasks there are, and what is to be written: files of these names, the first of which is printed where nothing is written, and what to do
/// next in either case.
struct Papers {
    tasks: usize,
    files: Vec<(&'static str, String)>,
    once_printed: String,
    once_written: String,
}

/// Prints or writes what a scheduler takes.
pub fn run(arguments: &SubmitArguments) -> Exit {
    let common = match &arguments.scheduler {
        Scheduler::Slurm(slurm) => &slurm.common,
        Scheduler::Openjd(openjd) => &openjd.common,
        Scheduler::Commands(commands) => &commands.common,
    };
    let papers = Work::of(common).and_then(|work| {
        let papers = match &arguments.scheduler {
            Scheduler::Slurm(arguments) => slurm::papers(arguments, &work)?,
            Scheduler::Openjd(arguments) => openjd::papers(arguments, &work)?,
            Scheduler::Commands(arguments) => commands::papers(arguments, &work)?,
        };
        if common.trial {
            trial::run(common, &work, papers.tasks)?;
        }
        Ok(papers)
    });
    match papers {
        Ok(papers) => match &common.write {
            Some(folder) => papers.write(folder),
            None => papers.print(),
        },
        Err(Refusal { exit, text }) => {
            say(&format!("error: {text}"));
            exit
        }
    }
}

impl Papers {
    /// Standard output is for a scheduler alone.
    fn print(&self) -> Exit {
        let printed = self.files.first().map_or(Exit::Complete, |(_, text)| print(text));
        say(&self.once_printed);
        printed
    }

    fn write(&self, folder: &Path) -> Exit {
        let all = self.files.iter().map(|(name, text)| write(&folder.join(name), text));
        let written = all.fold(Exit::Complete, Exit::max);
        if written == Exit::Complete {
            say(&self.once_written);
        }
        written
    }
}
