//! The frames of a report as comma-separated values.

use std::fmt::Write;

use super::{FrameReport, SequenceReport};

/// The head of a column, and its text.
type Column = (&'static str, fn(&FrameReport) -> String);

const COLUMNS: [Column; 23] = [
    ("frame", |f| f.frame.clone()),
    ("state", |f| f.state.name().into()),
    ("shard", |f| optional(f.shard)),
    ("seconds", |f| f.effort.seconds.to_string()),
    ("cpu_seconds", |f| f.effort.cpu_seconds.to_string()),
    ("thread_seconds", |f| f.effort.thread_seconds.to_string()),
    ("prepare_seconds", |f| f.prepare_seconds.to_string()),
    ("wait_seconds", |f| f.wait_seconds.to_string()),
    ("render_seconds", |f| f.render_seconds.to_string()),
    ("write_seconds", |f| f.write_seconds.to_string()),
    ("samples", |f| f.effort.samples.to_string()),
    ("samples_per_pixel", |f| optional(f.samples_per_pixel.map(|samples| samples.mean))),
    ("stopped_by", |f| optional(f.stopped_by.map(|reason| reason.name()))),
    ("relative_error", |f| optional(f.relative_error.map(|error| error.estimate))),
    ("low", |f| optional(f.relative_error.map(|error| error.low))),
    ("high", |f| optional(f.relative_error.map(|error| error.high).filter(|high| high.is_finite()))),
    ("runs", |f| f.effort.lines.to_string()),
    ("restarts", |f| f.restarts.to_string()),
    ("failures", |f| f.failures.to_string()),
    ("warnings", |f| f.warnings.to_string()),
    ("straggler", |f| f.straggler.to_string()),
    ("ended", |f| optional(f.ended)),
    ("picture", |f| quoted(&f.output.to_string_lossy())),
];

/// A line of heads and a line a frame; numbers have all their digits, and what is not known is empty.
pub fn csv(report: &SequenceReport) -> String {
    let heads: Vec<&str> = COLUMNS.iter().map(|(head, _)| *head).collect();
    let mut text = heads.join(",") + "\n";
    for frame in &report.frames {
        let values: Vec<String> = COLUMNS.iter().map(|(_, value)| value(frame)).collect();
        let _ = writeln!(text, "{}", values.join(","));
    }
    text
}

fn optional(value: Option<impl ToString>) -> String {
    value.map(|value| value.to_string()).unwrap_or_default()
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}
