//! What every scheduler is told.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;

use crate::cli::duration::time;
use crate::cli::settings::Settings;

#[derive(Debug, Args)]
pub struct Common {
    #[command(flatten)]
    pub settings: Settings,
    /// Tasks, each of which renders every N-th frame [default: one a frame, or as many as the scheduler takes]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), conflicts_with = "chunk")]
    pub tasks: Option<u32>,
    /// Frames of a task, in place of --tasks
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub chunk: Option<u32>,
    /// Processors of a task
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub cpus: Option<u16>,
    /// How long a task may take: 30m, 4h. One that takes longer is saved; Slurm puts it into the queue again
    #[arg(long, value_name = "TIME", value_parser = time)]
    pub time: Option<Duration>,
    /// Memory of a task: 900M, 8G
    #[arg(long, value_name = "BYTES", value_parser = mebibytes)]
    pub memory: Option<u64>,
    /// Write what is needed into this folder instead of printing it
    #[arg(long, value_name = "DIR")]
    pub write: Option<PathBuf>,
    /// Render a few frames with few samples, and say how many core hours all will take
    #[arg(long)]
    pub trial: bool,
    /// The floe that tasks run, as their machines know it [default: this one]
    #[arg(long, value_name = "PATH")]
    pub program: Option<String>,
    /// Further options of floe render, such as -- --denoise --time-budget 1h
    #[arg(last = true, value_name = "RENDER OPTIONS")]
    pub render: Vec<String>,
}

impl Common {
    /// How many tasks so many frames are parted into, at most as many as a scheduler takes.
    pub fn tasks(&self, frames: usize, most: usize) -> Result<usize, String> {
        let wanted = match (self.tasks, self.chunk) {
            // What would have nothing to do is not started.
            (Some(tasks), _) => (tasks as usize).min(frames),
            (None, Some(chunk)) => frames.div_ceil(chunk as usize),
            (None, None) => frames.min(most),
        };
        if wanted > most {
            let chunk = frames.div_ceil(most);
            return Err(format!(
                "{wanted} tasks are more than the {most} that an array may have: write --tasks {most} or --chunk {chunk}"
            ));
        }
        Ok(wanted)
    }

    /// What each task gets from here cannot stand behind `--` too: all of them would refuse it.
    pub fn check_given(&self, given: &[&str]) -> Result<(), String> {
        let is_given = |word: &str| given.contains(&word.split('=').next().unwrap_or_default());
        match self.render.iter().find(|word| is_given(word)) {
            Some(word) => Err(format!("{word} behind --: each task gets its own; leave it out")),
            None => Ok(()),
        }
    }
}

/// Reads an amount of memory in MiB.
fn mebibytes(text: &str) -> Result<u64, String> {
    let (digits, factor) = match text.char_indices().next_back() {
        Some((end, 'M' | 'm')) => (&text[..end], 1),
        Some((end, 'G' | 'g')) => (&text[..end], 1 << 10),
        Some((end, 'T' | 't')) => (&text[..end], 1 << 20),
        _ => ("", 1),
    };
    let is_plain = digits.bytes().all(|byte| byte.is_ascii_digit());
    let amount = digits.parse::<u64>().ok().filter(|amount| is_plain && *amount > 0);
    let amount = amount.and_then(|amount| amount.checked_mul(factor));
    amount.ok_or_else(|| format!("`{text}` is no amount of memory: write for example 900M or 8G"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_has_a_unit() {
        for (text, amount) in [("900M", 900), ("8G", 8192), ("1t", 1 << 20)] {
            assert_eq!(mebibytes(text), Ok(amount), "{text}");
        }
        for text in ["", "G", "8", "0G", "1.5G", "-1G", "+1G", "8GB", "99999999999999999T"] {
            assert!(mebibytes(text).unwrap_err().contains("8G"), "{text}");
        }
    }
}
