//! The command line: one file a command. Results go to standard output, progress to standard error.

#![allow(clippy::print_stdout, clippy::print_stderr)]

mod exit;
mod info;
mod progress;
mod render;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

pub use exit::Exit;

/// Renders folders of simulated fluid interfaces into image sequences.
#[derive(Debug, Parser)]
#[command(name = "floe", version, about, max_term_width = 100)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Render the frames of a scene file, or of a folder
    Render(render::RenderArguments),
    /// Print what a scene holds, what of the renderer it needs, and what is left out
    Info(info::InfoArguments),
}

/// Runs the command that the process was started with.
pub fn run() -> ExitCode {
    let exit = match Arguments::try_parse() {
        Ok(arguments) => match arguments.command {
            Command::Render(arguments) => render::run(&arguments),
            Command::Info(arguments) => info::run(&arguments),
        },
        Err(error) => {
            // Help and version go to standard output and are no failure.
            let exit = if error.use_stderr() { Exit::Usage } else { Exit::Complete };
            error.print().map_or(Exit::CannotWrite, |()| exit)
        }
    };
    exit.into()
}
