//! The command line: one file a command. Results go to standard output, progress to standard error.

mod compare;
mod duration;
mod encode;
mod environment;
mod exit;
mod files;
mod info;
mod merge;
mod optics;
mod progress;
mod render;
mod report;
mod screen;
#[cfg(feature = "serve")]
mod serve;
mod settings;
#[cfg(unix)]
mod signals;
mod status;
mod streams;
mod study;
mod submit;
mod summary;
mod watch;
mod watching;

use std::io::ErrorKind;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

pub use exit::Exit;

/// Renders folders of simulated fluid interfaces into image sequences.
#[derive(Debug, Parser)]
#[command(name = "floe", version, about, long_about = None, max_term_width = 100, after_help = exit::HELP)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Render the frames of a scene file, or of a folder
    Render(render::RenderArguments),
    /// Render frames as a simulation writes them
    Watch(watch::WatchArguments),
    /// Make pictures of frames whose samples several machines have rendered (render --samples-range)
    Merge(merge::MergeArguments),
    /// Print which frames are there, missing, begun, out of date or damaged
    Status(status::StatusArguments),
    /// Print what the ledgers of rendered frames tell: time, errors, slow frames and shards
    Report(report::ReportArguments),
    /// Print what a scene holds, what of the renderer it needs, and what is left out
    Info(info::InfoArguments),
    /// Write what puts frames into the queue of a scheduler, and say what they will cost
    Submit(submit::SubmitArguments),
    /// Make a movie, or a sheet of small pictures, of what was rendered
    Encode(encode::EncodeArguments),
    /// Print and draw what a medium, or a sphere, scatters and absorbs
    Optics(optics::OpticsArguments),
    /// Render frames in several ways and measure how they differ
    Study(study::StudyArguments),
    /// Compare pictures with reference pictures, and say whether they differ by more than noise
    Compare(compare::CompareArguments),
}

/// Runs the command that the process was started with.
pub fn run() -> ExitCode {
    // The default hook has told where it happened; schedulers need the code of an internal error.
    let obedient = || environment::obey().map_or_else(|exit| exit, |()| dispatch());
    std::panic::catch_unwind(obedient).unwrap_or(Exit::Internal).into()
}

fn dispatch() -> Exit {
    match Arguments::try_parse() {
        Ok(arguments) => match arguments.command {
            Command::Render(arguments) => render::run(&arguments),
            Command::Watch(arguments) => watch::run(&arguments),
            Command::Merge(arguments) => merge::run(&arguments),
            Command::Status(arguments) => status::run(&arguments),
            Command::Report(arguments) => report::run(&arguments),
            Command::Info(arguments) => info::run(&arguments),
            Command::Submit(arguments) => submit::run(&arguments),
            Command::Encode(arguments) => encode::run(&arguments),
            Command::Optics(arguments) => optics::run(&arguments),
            Command::Study(arguments) => study::run(&arguments),
            Command::Compare(arguments) => compare::run(&arguments),
        },
        Err(error) => {
            // Help and version go to standard output and are no failure.
            let exit = if error.use_stderr() { Exit::Usage } else { Exit::Complete };
            match error.print() {
                Err(failure) if failure.kind() != ErrorKind::BrokenPipe => Exit::CannotWrite,
                _ => exit,
            }
        }
    }
}
