//! `floe study`: error against run time.

use std::path::Path;

use super::Shared;
use crate::cli::exit::Exit;
use crate::cli::streams::say;
use crate::driver::Job;
use crate::study::StudyError;

pub(super) fn run(scene: &Path, shared: &Shared) -> Result<Exit, StudyError> {
    let job = Job::open(scene)?;
    let frame = shared.frame.map_or_else(String::new, |number| format!(" of frame {number}"));
    say(&format!("error: nothing{frame} of {} is studied without --temporal", job.name));
    Ok(Exit::Usage)
}
