//! A report to read.

use std::fmt::Write;

use super::slow::SlowFrame;
use super::{Effort, Errors, FrameReport, SequenceReport, State};
use crate::driver::ledgers::Reason;
use crate::sequence::{FrameNumber, format_numbers};

/// Kinds of warnings that are told.
const WARNINGS: usize = 5;

/// A report in lines and columns.
pub fn text(report: &SequenceReport) -> String {
    let mut text = states(report);
    text += &took(report);
    if let Some(errors) = &report.errors {
        text += &error_lines(errors);
    }
    text += &slowest(report);
    text += &shards(report);
    text += &told(report);
    text
}

fn numbers<'a>(frames: impl Iterator<Item = &'a FrameReport>) -> String {
    format_numbers(&frames.map(|frame| frame.number).collect::<Vec<FrameNumber>>())
}

fn states(report: &SequenceReport) -> String {
    let frames = &report.frames;
    let mut text = String::new();
    for state in State::ALL {
        let own = || frames.iter().filter(|frame| frame.state == state);
        if own().next().is_some() {
            let _ = writeln!(
                text,
                "{:<12}{} of {} ({})",
                state.name(),
                own().count(),
                frames.len(),
                numbers(own())
            );
        }
    }
    for frame in frames.iter().filter(|frame| frame.state == State::Failed) {
        let _ = writeln!(text, "frame {}: {}", frame.frame, frame.error.as_deref().unwrap_or("unknown"));
    }
    for (what, count) in
        [("broken off", (|f| f.restarts) as fn(&FrameReport) -> usize), ("failed", |f| f.failures)]
    {
        let sum: usize = frames.iter().map(count).sum();
        if sum > 0 {
            let own = frames.iter().filter(|frame| count(frame) > 0);
            let _ = writeln!(text, "{what} before: {} ({})", times(sum), numbers(own));
        }
    }
    text
}

fn times(count: usize) -> String {
    if count == 1 { "once".into() } else { format!("{count} times") }
}

fn hours(seconds: f64) -> f64 {
    seconds / 3600.0
}

fn took(report: &SequenceReport) -> String {
    let Effort { seconds, cpu_seconds, thread_seconds, samples, .. } = report.total;
    let mut text = format!(
        "took        {seconds:.2} s, {:.4} core hours of CPU, {:.4} of threads; {samples:.3e} samples\n",
        hours(cpu_seconds),
        hours(thread_seconds)
    );
    if let Some(elapsed) = report.shards.elapsed_seconds {
        let _ = writeln!(text, "            within {elapsed:.2} s from the first frame to the last");
    }
    let before = report.superseded;
    if before.lines > 0 {
        let _ = writeln!(
            text,
            "            {:.2} s and {:.4} core hours of it for {} of pictures that were drawn again",
            before.seconds,
            hours(before.cpu_seconds),
            if before.lines == 1 { "a line".into() } else { format!("{} lines", before.lines) }
        );
    }
    text
}

fn error_lines(errors: &Errors) -> String {
    let percent = |part: f64| 100.0 * part;
    let mut text = format!(
        "error       {:.2} %, median {:.2} %, greatest {:.2} % in frame {}\n",
        percent(errors.root_mean_square),
        percent(errors.median),
        percent(errors.greatest),
        errors.greatest_frame
    );
    for (count, what) in [(errors.unknown, "unknown"), (errors.unsure, "only bounded from below")] {
        if count > 0 {
            let _ = writeln!(text, "            {what} in {count}");
        }
    }
    let _ = write!(
        text,
        "\nerror against run time, if squared errors fall as samples grow\n{:>12}{:>14}\n\
         {:>10.2} %{:>14.4}  as it is\n",
        "error",
        "core hours",
        percent(errors.root_mean_square),
        hours(errors.cpu_seconds)
    );
    for cost in &errors.costs {
        let error = percent(cost.relative_error);
        let _ = writeln!(text, "{error:>10} %{:>14.4}  in every frame", hours(cost.cpu_seconds));
    }
    text
}

fn slowest(report: &SequenceReport) -> String {
    let slow = &report.slow;
    if slow.slowest.len() < 2 {
        return String::new();
    }
    let heads =
        ["seconds", "prepare", "wait", "render", "write", "CPU %", "x median", "x samples", "x s/sample"];
    let mut text = format!("\nslowest frames\n{:>8}{:>7}", "frame", "shard");
    heads.iter().for_each(|head| text += &format!("{head:>11}"));
    for one in &slow.slowest {
        if let Some(frame) = report.frames.iter().find(|frame| frame.frame == one.frame) {
            text += &slow_line(frame, one);
        }
    }
    text.push('\n');
    match slow.threshold_seconds {
        Some(threshold) if slow.stragglers.is_empty() => {
            let _ = writeln!(text, "no stragglers: none took more than {threshold:.2} s");
        }
        Some(threshold) => {
            let own = report.frames.iter().filter(|frame| frame.straggler);
            let _ = writeln!(text, "stragglers, above {threshold:.2} s: {}", numbers(own));
        }
        None => {}
    }
    text
}

fn slow_line(frame: &FrameReport, slow: &SlowFrame) -> String {
    let mut text = format!("\n{:>8}{:>7}", frame.frame, shard_name(frame.shard));
    let FrameReport { prepare_seconds, wait_seconds, render_seconds, write_seconds, .. } = frame;
    let seconds = [&frame.effort.seconds, prepare_seconds, wait_seconds, render_seconds, write_seconds];
    let busy = 100.0 * frame.effort.cpu_seconds / frame.effort.thread_seconds;
    let ratios = [slow.times_median, slow.times_samples, slow.times_sample_seconds];
    seconds.iter().for_each(|value| text += &format!("{value:>11.2}"));
    text += &format!("{busy:>11.0}");
    ratios.iter().for_each(|value| text += &format!("{value:>11.2}"));
    text += &format!("  {}", slow.most);
    if frame.restarts > 0 {
        text += &format!(", broken off {}", times(frame.restarts));
    }
    text
}

fn shard_name(shard: Option<u32>) -> String {
    shard.map_or_else(|| "-".into(), |shard| shard.to_string())
}

fn shards(report: &SequenceReport) -> String {
    let shards = &report.shards;
    if shards.shards.len() < 2 {
        return String::new();
    }
    let mut text = format!(
        "\n{:>8}{:>10}{:>11}{:>11}{:>11}{:>11}\n",
        "shard", "pictures", "seconds", "CPU s", "begins", "ends"
    );
    for shard in &shards.shards {
        let since = |time: Option<f64>| time.map_or_else(|| "-".into(), |time| format!("{time:.2}"));
        let _ = writeln!(
            text,
            "{:>8}{:>10}{:>11.2}{:>11.2}{:>11}{:>11}{}",
            shard_name(shard.shard),
            shard.pictures,
            shard.effort.seconds,
            shard.effort.cpu_seconds,
            since(shard.begins),
            since(shard.ends),
            if shard.straggler { "  straggler" } else { "" }
        );
    }
    if let Some(imbalance) = shards.imbalance {
        let _ = writeln!(text, "imbalance {imbalance:.2}: the longest shard over the mean");
    }
    text
}

/// Warnings, and what could not be read.
fn told(report: &SequenceReport) -> String {
    let mut text = String::new();
    let count: usize = report.warnings.iter().map(|warning| warning.count).sum();
    if count > 0 {
        let _ = writeln!(text, "\nwarnings: {count}");
    }
    for warning in report.warnings.iter().take(WARNINGS) {
        let _ = writeln!(text, "{:>8} in {}: {}", warning.count, warning.frames, warning.text);
    }
    let kinds = report.warnings.len().saturating_sub(WARNINGS);
    if kinds > 0 {
        let _ = writeln!(text, "         and {kinds} other kinds");
    }
    for (reason, what) in [
        (Reason::Torn, "torn"),
        (Reason::Foreign, "not of a frame"),
        (Reason::Other, "of pictures of other names"),
    ] {
        let own = || report.unusable.iter().filter(|line| line.reason == reason);
        if let Some(first) = own().next() {
            let place = format!("{}, line {}", first.file.display(), first.line);
            let _ = writeln!(text, "\nlines that are {what}, left out: {} (first {place})", own().count());
        }
    }
    text
}
