//! What a study of convergence found: columns to look at, comma-separated values, and a diagram.

use std::fmt::Write;

use super::{BudgetPoint, ConvergenceResults, End, Series};
use crate::study::plot::{Axis, Guide, Plot, Point, Series as Curve, Style};
use crate::study::statistics::Estimate;

/// The head of a column, and its number.
type Column = (&'static str, fn(&BudgetPoint) -> f64);

/// The columns of the values.
const VALUES: [Column; 23] = [
    ("samples", |p| p.samples.into()),
    ("repeats", |p| p.repeats as f64),
    ("cpu_seconds", |p| p.cpu_seconds.value),
    ("cpu_seconds_half_width", |p| p.cpu_seconds.half_width),
    ("seconds", |p| p.seconds),
    ("rays", |p| p.rays),
    ("rmse", |p| p.rmse.value),
    ("rmse_half_width", |p| p.rmse.half_width),
    ("relmse", |p| p.relative_mse.value),
    ("relmse_half_width", |p| p.relative_mse.half_width),
    ("relmse_trimmed", |p| p.trimmed),
    ("relmse_median", |p| p.median),
    ("flip", |p| p.flip),
    ("variance", |p| p.variance),
    ("efficiency", |p| p.efficiency),
    ("cost", |p| p.cost[0]),
    ("cost_trimmed", |p| p.cost[1]),
    ("cost_median", |p| p.cost[2]),
    ("estimated_error", |p| p.estimated_error),
    ("true_error", |p| p.true_error),
    ("bias", |p| p.bias.relative),
    ("bias_t", |p| p.bias.t),
    ("bias_p", |p| p.bias.p),
];

/// The columns to look at: their heads, which of [`VALUES`] they show, and how.
const COLUMNS: [(&str, &str, Form); 13] = [
    ("CPU s", "cpu_seconds", Form::Digits),
    ("rmse", "rmse", Form::Digits),
    ("+-", "rmse_half_width", Form::Short),
    ("relMSE", "relmse", Form::Digits),
    ("trimmed", "relmse_trimmed", Form::Digits),
    ("median", "relmse_median", Form::Digits),
    ("FLIP", "flip", Form::Digits),
    ("true", "true_error", Form::Percent),
    ("estimated", "estimated_error", Form::Percent),
    ("bias", "bias", Form::Percent),
    ("p", "bias_p", Form::Short),
    ("1/(var s)", "efficiency", Form::Digits),
    ("cost", "cost", Form::Digits),
];

/// How a number is shown.
#[derive(Clone, Copy)]
enum Form {
    Digits,
    Short,
    Percent,
}

/// Columns to look at.
pub fn text(results: &ConvergenceResults) -> String {
    let [width, height] = results.resolution;
    let facts = &results.reference;
    let mut text = format!(
        "{}, frame {}, {width} x {height} pixels\nreference {}",
        results.scene,
        results.frame,
        results.reference_file.display()
    );
    if !facts.integrator.is_empty() {
        let _ = write!(text, " ({}, {} samples)", facts.integrator, facts.samples);
    }
    let _ = match results.reference_noise {
        0.0 => writeln!(text, ", which says nothing of its noise"),
        noise => writeln!(text, ", noise {noise:.3e}, which rmse, relMSE and true are without"),
    };
    if let Some(check) = &facts.check {
        let _ = writeln!(
            text,
            "{} ({} samples) differs from it by {:.3} % (t {:.2}, p {:.2})",
            check.integrator,
            check.samples,
            100.0 * check.bias.relative,
            check.bias.t,
            check.bias.p
        );
    }
    results.series.iter().for_each(|series| describe(&mut text, series, results.error));
    match results.end {
        End::Complete => (),
        End::Time => text += "\ntime was up: some pictures are missing\n",
        End::Interrupted => text += "\ninterrupted: some pictures are missing\n",
    }
    text
}

fn describe(text: &mut String, series: &Series, error: Option<f64>) {
    let _ = write!(text, "\n{}", series.name);
    if !series.left_out.is_empty() {
        let _ = write!(text, " (leaves out {})", series.left_out.join(", "));
    }
    let _ = write!(text, "\n{:>8}{:>4}", "samples", "n");
    COLUMNS.iter().for_each(|(head, ..)| text.push_str(&format!("{head:>11}")));
    for point in &series.points {
        let _ = write!(text, "\n{:>8}{:>4}", point.samples, point.repeats);
        for (_, name, form) in COLUMNS {
            let value =
                VALUES.iter().find(|(head, _)| *head == name).map_or(f64::NAN, |(_, value)| value(point));
            let shown = match form {
                Form::Digits => format!("{value:.3e}"),
                Form::Short => format!("{value:.1e}"),
                Form::Percent => format!("{:.3} %", 100.0 * value),
            };
            let _ = write!(text, "{shown:>11}");
        }
    }
    text.push('\n');
    let slopes = [(series.slope_by_time, "CPU time"), (series.slope_by_samples, "samples")];
    for (slope, of) in slopes.into_iter().filter_map(|(slope, of)| Some((slope?, of))) {
        let Estimate { value, half_width } = slope;
        let _ = writeln!(text, "  rmse falls with {of} to the power {value:.3} +- {half_width:.3}");
    }
    if let (Some([low, middle, high]), Some(error)) = (series.seconds_to_error, error) {
        let _ = writeln!(
            text,
            "  a relative error of {error} takes {middle:.3e} s of CPU ({low:.3e} to {high:.3e})"
        );
    }
}

/// A line of heads and a line for each budget of each series; numbers have all their digits.
pub fn csv(results: &ConvergenceResults) -> String {
    let heads: Vec<&str> = VALUES.iter().map(|(name, _)| *name).collect();
    let mut text = format!("series,{}\n", heads.join(","));
    for series in &results.series {
        for point in &series.points {
            let values: Vec<String> = VALUES.iter().map(|(_, value)| value(point).to_string()).collect();
            let _ = writeln!(text, "\"{}\",{}", series.name.replace('"', "\"\""), values.join(","));
        }
    }
    text
}

/// Everything, as JSON.
pub fn json(results: &ConvergenceResults) -> String {
    serde_json::to_string_pretty(results).unwrap_or_default() + "\n"
}

/// Error against CPU time.
pub fn plot(results: &ConvergenceResults) -> Plot {
    let point = |p: &BudgetPoint| Point {
        y_range: Some(p.rmse.ends()),
        ..Point::new(p.cpu_seconds.value, p.rmse.value)
    };
    let series = results.series.iter().map(|series| Curve {
        name: named_with_slope(series),
        points: series.points.iter().map(point).collect(),
        style: Style::MarksAndLine,
    });
    let noise = Guide::Level { y: results.reference_noise, label: "noise of the reference".into() };
    let is_photon = |series: &&Series| series.name.starts_with("photon");
    let (photons, paths): (Vec<&Series>, Vec<&Series>) = results.series.iter().partition(is_photon);
    let slopes =
        [slope(&paths, -1.0 / 2.0, "slope \u{2212}1/2"), slope(&photons, -1.0 / 3.0, "slope \u{2212}1/3")];
    Plot {
        title: format!("{}, frame {}", results.scene, results.frame),
        x: Axis::logarithmic("CPU time / s"),
        y: Axis::logarithmic("root mean square error (radiance)"),
        series: series.collect(),
        guides: [noise].into_iter().chain(slopes.into_iter().flatten()).collect(),
    }
}

/// The line that theory has for some series, a little below all of their points.
fn slope(series: &[&Series], slope: f64, label: &str) -> Option<Guide> {
    let power = |p: &BudgetPoint| libm::pow(p.cpu_seconds.value, slope);
    let points = || series.iter().flat_map(|series| &series.points).filter(|p| p.rmse.value > 0.0);
    let lowest = points().map(|p| p.rmse.value / power(p)).fold(f64::INFINITY, f64::min);
    let first = points().next()?;
    let through = [first.cpu_seconds.value, 0.75 * lowest * power(first)];
    Some(Guide::Slope { slope, through, label: label.into() })
}

fn named_with_slope(series: &Series) -> String {
    let sign = |value: f64| format!("{value:.3}").replace('-', "\u{2212}");
    match &series.slope_by_time {
        Some(slope) => {
            format!("{}: {} \u{b1} {:.3}", series.name, sign(slope.value), slope.half_width)
        }
        None => series.name.clone(),
    }
}

/// A page with the diagram and the columns, which needs nothing else.
pub fn html(results: &ConvergenceResults) -> String {
    let escape = |text: &str| quick_xml::escape::escape(text).into_owned();
    format!(
        "<!doctype html>\n<meta charset=\"utf-8\">\n<title>{}</title>\n\
         <body style=\"font-family: sans-serif; margin: 2em\">\n{}<pre style=\"overflow: auto\">{}</pre>\n",
        escape(&results.scene),
        plot(results).svg(),
        escape(&text(results))
    )
}

#[cfg(test)]
mod tests;
