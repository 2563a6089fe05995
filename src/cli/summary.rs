//! What standard output says at the end of `floe render`.

use std::path::Path;

use serde_json::{Value, json};

use crate::accel::Hierarchy;
use crate::driver::ledger::RelativeError;
use crate::driver::{FrameRecord, RenderReport, Status, StoppedBy};
use crate::integrator::Counters;
use crate::sequence::{FrameNumber, format_numbers};

/// Frames, time, estimated error, rare events, what is left out, and where it all is.
pub fn text(report: &RenderReport) -> String {
    let done = done(report);
    let lines = [
        already_line(report),
        frames_line(report, &done),
        failures_line(report),
        interrupted_line(report),
        error_line(&done),
        cut_line(&done),
        hierarchy_line(report),
        events_line(&done),
        left_out_line(report),
        places_line(report, &done),
    ];
    lines.into_iter().flatten().map(|line| line + "\n").collect()
}

/// The same for programs.
pub fn json(report: &RenderReport) -> Value {
    let done = done(report);
    let of = |status: Status| {
        let those = done.iter().filter(|record| record.status == status);
        format_numbers(&those.filter_map(|record| record.frame.parse().ok()).collect::<Vec<FrameNumber>>())
    };
    let failed: Vec<FrameNumber> = report.failures.iter().map(|(number, _)| *number).collect();
    json!({
        "complete": of(Status::Complete),
        "partial": of(Status::Partial),
        "already": format_numbers(&report.already),
        "failed": format_numbers(&failed),
        "skipped": report.skipped,
        "interrupted": report.interrupted,
        "seconds": report.seconds,
        "samples": done.iter().map(|r| r.samples).sum::<u64>(),
        "relative_error": root_mean_square(&done),
        "worst": worst(&done).map(|(error, frame)| json!({ "frame": frame, "relative_error": error })),
        "pictures": report.pattern,
        "ledger": report.ledger,
    })
}

/// The frames whose pictures, or partials, are there.
fn done(report: &RenderReport) -> Vec<&FrameRecord> {
    let is_done = |record: &&FrameRecord| matches!(record.status, Status::Complete | Status::Partial);
    report.frames.iter().filter(is_done).collect()
}

fn already_line(report: &RenderReport) -> Option<String> {
    let (there, asked) = (report.already.len(), report.already.len() + report.frames.len() + report.skipped);
    let (word, verb) = (if asked == 1 { "frame" } else { "frames" }, if there == 1 { "was" } else { "were" });
    let line =
        || format!("{there} of {asked} {word} {verb} there already ({})", format_numbers(&report.already));
    (there > 0).then(line)
}

fn frames_line(report: &RenderReport, done: &[&FrameRecord]) -> Option<String> {
    let asked = report.frames.len() + report.skipped;
    if asked == 0 {
        return None;
    }
    let word = if asked == 1 { "frame" } else { "frames" };
    let numbers: Vec<FrameNumber> = done.iter().filter_map(|r| r.frame.parse().ok()).collect();
    let names = if numbers.is_empty() { String::new() } else { format!(" ({})", format_numbers(&numbers)) };
    let mut line = format!("{} of {asked} {word}{names} in {:.2} s", done.len(), report.seconds);
    if done.len() > 1 {
        let each = done.iter().map(|r| r.seconds()).sum::<f64>() / done.len() as f64;
        line += &format!(", {each:.2} s a frame");
    }
    Some(line)
}

fn interrupted_line(report: &RenderReport) -> Option<String> {
    report.interrupted.then(|| "interrupted: the same command goes on (render: with --resume)".into())
}

fn failures_line(report: &RenderReport) -> Option<String> {
    let failed: Vec<FrameNumber> = report.failures.iter().map(|(number, _)| *number).collect();
    if failed.is_empty() {
        return None;
    }
    let mut line = format!("failed: {}", format_numbers(&failed));
    if report.skipped > 0 && !report.interrupted {
        line += &format!("; {} after it not tried (--keep-going renders them)", report.skipped);
    }
    Some(line)
}

/// The greatest error, and whose it is.
fn worst<'a>(done: &[&'a FrameRecord]) -> Option<(RelativeError, &'a str)> {
    let known = done.iter().filter_map(|r| Some((r.relative_error?, r.frame.as_str())));
    known.max_by(|a, b| a.0.estimate.total_cmp(&b.0.estimate))
}

/// Over the frames, so that it is the error of the sequence as one picture.
fn root_mean_square(done: &[&FrameRecord]) -> Option<f64> {
    let errors: Vec<f64> = done.iter().filter_map(|r| r.relative_error).map(|e| e.estimate).collect();
    (!errors.is_empty()).then(|| (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt())
}

fn error_line(done: &[&FrameRecord]) -> Option<String> {
    let (Some((worst, frame)), Some(mean)) = (worst(done), root_mean_square(done)) else {
        let unknown =
            "estimated relative error unknown: it takes at least 2 samples a pixel, 4 with a target";
        return (!done.is_empty()).then(|| unknown.into());
    };
    let percent = |part: f64| 100.0 * part;
    let range = match worst.high.is_finite() {
        true => format!("{:.2} to {:.2} %", percent(worst.low), percent(worst.high)),
        false => format!("at least {:.2} %", percent(worst.low)),
    };
    // Two decimals at most, as 99.99 % has.
    let confidence = (1e4 * worst.confidence).round() / 100.0;
    let interval = format!("{range} at {confidence} % confidence");
    let effort = effort(done);
    Some(if done.iter().filter(|r| r.relative_error.is_some()).count() == 1 {
        format!("estimated relative error {:.2} % ({interval}) {effort}", percent(mean))
    } else {
        let worst = percent(worst.estimate);
        format!(
            "estimated relative error {:.2} %, worst {worst:.2} % in frame {frame} ({interval}), {effort}",
            percent(mean)
        )
    })
}

/// What the error was reached with, and what ended it where that was not the number of samples alone.
fn effort(done: &[&FrameRecord]) -> String {
    let frames = done.len() as f64;
    let seconds = done.iter().map(|r| r.render_seconds).sum::<f64>() / frames;
    let mut text = format!("after {seconds:.1} s{}", if done.len() == 1 { "" } else { " a frame" });
    let pixels = || done.iter().filter_map(|r| r.samples_per_pixel);
    let mean = pixels().map(|p| p.mean).sum::<f64>() / frames;
    text += &format!(", {mean:.0} samples a pixel");
    if let (Some(least), Some(most)) = (pixels().map(|p| p.least).min(), pixels().map(|p| p.most).max())
        && least < most
    {
        text += &format!(" ({least} to {most})");
    }
    let bounded: Vec<_> =
        done.iter().filter(|r| r.target_error.is_some() || r.time_budget.is_some()).collect();
    let stops = [StoppedBy::Target, StoppedBy::Time, StoppedBy::Samples].into_iter().filter_map(|reason| {
        let count = bounded.iter().filter(|r| r.stopped_by == Some(reason)).count();
        let what = match reason {
            StoppedBy::Target => "the target",
            StoppedBy::Time => "the time budget",
            StoppedBy::Samples => "the number of samples",
        };
        let times = if done.len() == 1 { String::new() } else { format!(" in {count}") };
        (count > 0).then(|| format!("by {what}{times}"))
    });
    let stops: Vec<String> = stops.collect();
    if stops.is_empty() { text } else { text + ", stopped " + &stops.join(", ") }
}

fn cut_line(done: &[&FrameRecord]) -> Option<String> {
    let cut = done.iter().filter(|r| r.stopped_by == Some(StoppedBy::Time));
    let numbers: Vec<FrameNumber> = cut.filter_map(|r| r.frame.parse().ok()).collect();
    let line = || {
        format!(
            "cut when their time was up: {}; --resume without a budget, or with a longer one, goes on",
            format_numbers(&numbers)
        )
    };
    (!numbers.is_empty()).then(line)
}

/// How often the hierarchy was refitted; nothing for a single frame.
fn hierarchy_line(report: &RenderReport) -> Option<String> {
    let made = |hierarchy| report.frames.iter().filter(|r| r.hierarchy == Some(hierarchy)).count();
    let counts: Vec<String> = [Hierarchy::Built, Hierarchy::Refitted, Hierarchy::Rebuilt]
        .into_iter()
        .map(|hierarchy| (made(hierarchy), hierarchy.name()))
        .filter(|(count, _)| *count > 0)
        .map(|(count, name)| format!("{count} {name}"))
        .collect();
    (report.frames.len() > 1 && !counts.is_empty()).then(|| format!("hierarchy: {}", counts.join(", ")))
}

fn events_line(done: &[&FrameRecord]) -> Option<String> {
    let mut total = Counters::default();
    done.iter().for_each(|r| total += r.counters);
    let events: Vec<String> = [
        (total.label_mismatches, "hits with mismatched labels"),
        (total.astray_photons, "photons ended where they met a boundary of another medium"),
        (total.non_finite, "samples that were not finite"),
        (total.escaped_inside, "paths that left a fluid through a hole"),
        (total.depth_limited, "paths ended by max_depth"),
        (total.cut, "paths cut at the hard limit of interactions"),
        (total.trapped, "paths reflected inside for ever"),
    ]
    .into_iter()
    .filter(|(count, _)| *count > 0)
    .map(|(count, what)| format!("{count} {what}"))
    .collect();
    (!events.is_empty()).then(|| format!("of {} rays: {}", total.rays, events.join(", ")))
}

fn left_out_line(report: &RenderReport) -> Option<String> {
    let mut parts: Vec<&str> = report.frames.iter().flat_map(|r| &r.left_out).map(String::as_str).collect();
    parts.sort_unstable();
    parts.dedup();
    (!parts.is_empty()).then(|| format!("left out: {}", parts.join(", ")))
}

fn places_line(report: &RenderReport, done: &[&FrameRecord]) -> Option<String> {
    let pictures = match done {
        [] if report.already.is_empty() => {
            return Some(format!("no pictures; ledger {}", report.ledger.display()));
        }
        [only] if report.already.is_empty() => only.output.display(),
        [first, ..] if first.status == Status::Partial => first.output.display(),
        _ => Path::new(&report.pattern).display(),
    };
    let ledger = report.ledger.display();
    Some(if done.iter().any(|record| record.status == Status::Partial) {
        format!("partials {pictures}, for `floe merge` when all samples are there; ledger {ledger}")
    } else {
        format!("pictures {pictures}; ledger {ledger}")
    })
}
