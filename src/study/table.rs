//! Results of studies as text in columns, and as comma-separated values.

use std::fmt::Write;

use super::seed_modes::TemporalStudy;
use super::temporal::TemporalMetrics;

/// The head of a column, and its number.
type Column = (&'static str, fn(&TemporalMetrics) -> f64);

/// The columns of a temporal study.
const TEMPORAL: [Column; 6] = [
    ("rmse", |m| m.rmse),
    ("tcr", |m| m.tcr),
    ("lag1", |m| m.lag1),
    ("flicker", |m| m.flicker),
    ("jitter", |m| m.jitter),
    ("fireflies", |m| m.fireflies),
];

/// Columns to look at.
pub fn text(study: &TemporalStudy) -> String {
    let mut text = format!(
        "frames {} ({}), {} samples a pixel, {} pixels; errors as parts of white\n{:<10}",
        study.frames, study.count, study.samples, study.pixels, "seed_mode"
    );
    TEMPORAL.iter().for_each(|(name, _)| text += &format!("{name:>11}"));
    for (mode, metrics) in &study.modes {
        let _ = write!(text, "\n{mode:<10}");
        TEMPORAL.iter().for_each(|(_, value)| text += &format!("{:>11.5}", value(metrics)));
    }
    text + "\n"
}

/// A line of heads and a line a mode; numbers have all their digits.
pub fn csv(study: &TemporalStudy) -> String {
    let heads: Vec<&str> = TEMPORAL.iter().map(|(name, _)| *name).collect();
    let mut text = format!("seed_mode,frames,samples,{}\n", heads.join(","));
    for (mode, metrics) in &study.modes {
        let values: Vec<String> = TEMPORAL.iter().map(|(_, value)| value(metrics).to_string()).collect();
        let _ = writeln!(text, "{mode},{},{},{}", study.count, study.samples, values.join(","));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn study() -> TemporalStudy {
        let metrics = TemporalMetrics {
            rmse: 0.125,
            tcr: 1.0,
            lag1: -0.25,
            flicker: 0.5,
            jitter: 1e-7,
            fireflies: 0.0,
        };
        TemporalStudy {
            frames: "1-8".into(),
            count: 8,
            samples: 4,
            pixels: 144,
            modes: vec![("frame", metrics), ("sequence", metrics)],
        }
    }

    #[test]
    fn columns_line_up_under_their_heads() {
        let text = text(&study());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 4);
        assert!(lines[1..].iter().all(|line| line.len() == lines[1].len()), "{text}");
        assert!(lines[3].starts_with("sequence ") && lines[3].contains("-0.25000"), "{text}");
    }

    #[test]
    fn values_are_whole() {
        let csv = csv(&study());
        let expected = "seed_mode,frames,samples,rmse,tcr,lag1,flicker,jitter,fireflies\n\
                        frame,8,4,0.125,1,-0.25,0.5,0.0000001,0\n\
                        sequence,8,4,0.125,1,-0.25,0.5,0.0000001,0\n";
        assert_eq!(csv, expected);
    }
}
