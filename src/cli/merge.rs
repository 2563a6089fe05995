//! `floe merge`

use clap::Args;

use super::exit::Exit;
use super::progress::{Bars, ProgressArguments, Reporter, reporter};
use super::render::ended;
use super::settings::Settings;
use crate::driver::{Job, RenderOptions, merge};

#[derive(Debug, Args)]
pub struct MergeArguments {
    #[command(flatten)]
    settings: Settings,
    /// Threads that merge [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Write pictures without noise too, as frame_0001.denoised.exr beside each (also output.denoise of the scene)
    #[arg(long)]
    denoise: bool,
    /// Remove the partials of each picture that is made
    #[arg(long)]
    remove: bool,
    /// Go on with the other frames when one fails; the exit code still tells
    #[arg(long)]
    keep_going: bool,
    #[command(flatten)]
    progress: ProgressArguments,
}

/// Makes pictures of partials and says what became of it.
pub fn run(arguments: &MergeArguments) -> Exit {
    let options = RenderOptions {
        threads: arguments.threads.map(usize::from),
        keep_going: arguments.keep_going,
        denoise: arguments.denoise,
        ..arguments.settings.options()
    };
    let bars = |quiet, bar| Box::new(Bars::new(quiet, bar)) as Box<dyn Reporter>;
    let progress = reporter(&arguments.progress, options.shard, bars);
    #[cfg(unix)]
    super::signals::obey(&options.interrupt);
    let report = Job::open(&arguments.settings.scene)
        .and_then(|job| merge(&job, &options, arguments.remove, &*progress));
    ended(&*progress, report, arguments.settings.output.is_some())
}
