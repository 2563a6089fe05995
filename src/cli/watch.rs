//! `floe watch`

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, ValueEnum};
use serde_json::{Value, json};

use super::duration::time;
use super::exit::Exit;
use super::progress::{ProgressArguments, Reporter, reporter};
use super::settings::{output_pattern, target_error};
use super::streams::{print, say};
use super::watching::Watching;
use crate::driver::watch::{End, Order};
use crate::driver::{Interrupt, Observer, RenderError, RenderOptions, WatchOptions, WatchReport, watch};
use crate::sequence::{FrameNumber, SequenceError, format_numbers};

#[derive(Debug, Args)]
pub struct WatchArguments {
    /// A scene file, or a folder with scene.toml or with frames; folder and frames need not be there yet
    scene: PathBuf,
    /// Name of the pictures, such as shots/frame_####.exr (also %04d, $F4)
    /// (default: output.path of the scene, else out/NAME/frame_####.exr with the NAME of the folder)
    #[arg(long, short, value_name = "PATTERN", value_parser = output_pattern)]
    output: Option<String>,
    /// Samples a pixel [default: render.samples of the scene]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    samples: Option<u32>,
    /// Seed of every random number [default: render.seed of the scene]
    #[arg(long, value_name = "S")]
    seed: Option<u64>,
    /// Stop a frame when its relative error is at most so much, such as 0.02 or 2%
    /// [default: render.target_error of the scene]
    #[arg(long, value_name = "E", value_parser = target_error)]
    target_error: Option<f64>,
    /// Write what there is of a frame after so much light transport: 30s, 5m, 1h
    #[arg(long, value_name = "TIME", value_parser = time)]
    time_budget: Option<Duration>,
    /// Threads that render; as many more make previews [default: as for `floe render`]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Which frame is drawn first when several wait
    #[arg(long, value_enum, default_value_t)]
    order: Queue,
    /// End when this frame is drawn or bad, and those before it that are there
    #[arg(long, value_name = "FRAME", allow_hyphen_values = true)]
    until: Option<FrameNumber>,
    /// End when all is drawn and nothing has changed for so long
    #[arg(long, value_name = "TIME", value_parser = time)]
    idle_timeout: Option<Duration>,
    /// End when all is drawn and this file is in the folder of the frames
    #[arg(long, value_name = "NAME")]
    done_file: Option<String>,
    /// Samples a pixel of previews, 0 for none [default: a sixteenth of the samples, at least 4; 4 with a target]
    #[arg(long, value_name = "N")]
    preview_samples: Option<u32>,
    /// Look at the folder so often even if the system tells of no change
    #[arg(long, value_name = "TIME", value_parser = time, default_value = "2")]
    poll: Duration,
    /// How long a file has to be unchanged; 4 times as long if it cannot prove that it is whole, 20 times if in doubt
    #[arg(long, value_name = "TIME", value_parser = time, default_value = "0.5")]
    settle: Duration,
    /// Show it all on a page in a browser, at this port of this machine; 0 is one that is free
    #[cfg(feature = "serve")]
    #[arg(long, value_name = "PORT")]
    serve: Option<u16>,
    /// Listen at this address instead of that of this machine alone
    #[cfg(feature = "serve")]
    #[arg(long, value_name = "ADDRESS", requires = "serve", default_value = "127.0.0.1")]
    serve_address: std::net::IpAddr,
    #[command(flatten)]
    progress: ProgressArguments,
    /// Refused with a reason
    #[arg(long, hide = true, allow_hyphen_values = true)]
    shard: Option<String>,
}

/// Which frame is drawn first.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum Queue {
    /// The lowest number
    #[default]
    Oldest,
    /// The one that was written last
    Newest,
}

/// Renders what comes and says what became of it.
pub fn run(arguments: &WatchArguments) -> Exit {
    let bars = |quiet, bar| Box::new(Watching::new(quiet, bar)) as Box<dyn Reporter>;
    let watching = reporter(&arguments.progress, None, bars);
    // Which place a frame has is not known while others come.
    if arguments.shard.is_some() {
        say(
            "error: --shard: a watch draws every frame that comes; on several machines run `floe render --resume --shard \
             I/N` on each, and again when there are more frames",
        );
        return Exit::Usage;
    }
    let interrupt = Interrupt::default();
    #[cfg(unix)]
    super::signals::obey(&interrupt);
    let options = options(arguments, interrupt);
    let report = match served(arguments, &options, &*watching) {
        Ok(report) => report,
        Err(exit) => return exit,
    };
    watching.clear();
    let (results, exit) = match report {
        Ok(report) => {
            let printed = print(&summary(&report));
            let failures = report.failures.iter().map(|(_, error)| error).chain(&report.trouble);
            (as_json(&report), failures.map(Exit::from).fold(printed.max(ended(&report)), Exit::max))
        }
        Err(error) => {
            say(&format!("error: {error}"));
            let exit = match error {
                RenderError::Sequence(SequenceError::NoPlace { .. }) if arguments.output.is_some() => {
                    Exit::Usage
                }
                error => Exit::from(&error),
            };
            (Value::Null, exit)
        }
    };
    watching.ended(results, exit);
    exit
}

/// How a watch ended, or how the command did that could not begin.
type Outcome = Result<Result<WatchReport, RenderError>, Exit>;

/// Watches, with a page if one is asked for.
#[cfg(feature = "serve")]
fn served(arguments: &WatchArguments, options: &WatchOptions, watching: &dyn Observer) -> Outcome {
    use super::serve::{Board, Both, serve};
    let Some(port) = arguments.serve else { return Ok(watch(&arguments.scene, options, watching)) };
    let board = std::sync::Arc::new(Board::default());
    let bound = serve(arguments.serve_address, port, board.clone()).map_err(|reason| {
        say(&format!(
            "error: cannot serve at {}, port {port}: {reason}; choose another port",
            arguments.serve_address
        ));
        Exit::CannotCreate
    })?;
    if !bound.ip().is_loopback() {
        say("warning: whoever reaches this machine can see the pictures");
    }
    say(&format!("page at http://{}/", bound));
    let both = Both { first: watching, board: &board };
    Ok(watch(&arguments.scene, options, &both))
}

/// Watches.
#[cfg(not(feature = "serve"))]
fn served(arguments: &WatchArguments, options: &WatchOptions, watching: &dyn Observer) -> Outcome {
    Ok(watch(&arguments.scene, options, watching))
}

fn options(arguments: &WatchArguments, interrupt: Interrupt) -> WatchOptions {
    WatchOptions {
        render: RenderOptions {
            output: arguments.output.clone(),
            samples: arguments.samples,
            seed: arguments.seed,
            target_error: arguments.target_error,
            time_budget: arguments.time_budget,
            threads: arguments.threads.map(usize::from),
            interrupt,
            ..WatchOptions::default().render
        },
        order: match arguments.order {
            Queue::Oldest => Order::Oldest,
            Queue::Newest => Order::Newest,
        },
        until: arguments.until,
        idle_timeout: arguments.idle_timeout,
        done_file: arguments.done_file.clone(),
        preview_samples: arguments.preview_samples,
        poll: arguments.poll,
        quiet: arguments.settle,
    }
}

/// Stopped while there was more to do is not the same as stopped.
fn ended(report: &WatchReport) -> Exit {
    match report.ended {
        End::Interrupted if !report.pending.is_empty() || report.expected_more => Exit::Interrupted,
        _ => Exit::Complete,
    }
}

fn as_json(report: &WatchReport) -> Value {
    let failed: Vec<FrameNumber> = report.failures.iter().map(|(number, _)| *number).collect();
    let places = report.places.as_ref();
    json!({
        "complete": format_numbers(&report.drawn),
        "failed": format_numbers(&failed),
        "pending": format_numbers(&report.pending),
        "interrupted": report.ended == End::Interrupted,
        "seconds": report.seconds,
        "pictures": places.map(|(pattern, _)| pattern),
        "ledger": places.map(|(_, ledger)| ledger),
    })
}

fn summary(report: &WatchReport) -> String {
    let why = match report.ended {
        End::Until => "the last frame is done",
        End::DoneFile => "the simulation is done",
        End::Idle => "nothing has changed for a while",
        End::Interrupted => "stopped",
    };
    let list = |what: &str, numbers: &[FrameNumber]| match numbers {
        [] => String::new(),
        numbers => format!("{what}: {}\n", format_numbers(numbers)),
    };
    let word = |n: usize| if n == 1 { "picture" } else { "pictures" };
    let mut text =
        format!("{why}: {} {} finished in {:.2} s\n", report.finished, word(report.finished), report.seconds);
    text += &list("drawn", &report.drawn);
    text += &list("failed", &report.failures.iter().map(|(number, _)| *number).collect::<Vec<_>>());
    text += &list("not drawn yet", &report.pending);
    match &report.places {
        Some((pattern, ledger)) => text + &format!("pictures {pattern}; ledger {}\n", ledger.display()),
        None => text,
    }
}
