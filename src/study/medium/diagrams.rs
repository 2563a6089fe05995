//! Reports as diagrams, and as a page of them.

use std::fmt::Write;

use quick_xml::escape::escape;

use super::{MediumReport, phase};
use crate::study::plot::{Axis, Plot, Point, Polar, Series, Style};

/// Wavelengths in nm of which phase functions are drawn: their colours among those of series are blue, vermilion, green.
const DRAWN: [f64; 3] = [450.0, 650.0, 550.0];

/// Least angle in degrees on a logarithmic axis.
const LEAST_ANGLE: f64 = 0.01;

/// More points than that need no marks.
const MARKED: usize = 24;

type Curve = (&'static str, fn(&MediumReport) -> &[f64]);

const COEFFICIENTS: [Curve; 4] = [
    ("absorption", |r| &r.sigma_a),
    ("scattering", |r| &r.sigma_s),
    ("reduced scattering", |r| &r.reduced_sigma_s),
    ("diffuse attenuation K", |r| &r.diffuse_attenuation),
];

const SHARES: [Curve; 3] =
    [("albedo", |r| &r.albedo), ("mean cosine g", |r| &r.g), ("reflectance R", |r| &r.reflectance)];

/// Every diagram of one medium, or of two, the second one dashed: the file's name without its ending, and the text of
/// the SVG file.
pub fn all(reports: &[&MediumReport]) -> Vec<(&'static str, String)> {
    let title = reports.iter().map(|report| report.medium.as_str()).collect::<Vec<_>>().join(" and ");
    let over_wavelength = |y: Axis, curves: &[Curve]| Plot {
        title: title.clone(),
        x: Axis::linear("wavelength / nm"),
        y,
        series: reports.iter().enumerate().flat_map(|(i, _)| series(reports, i, curves)).collect(),
        guides: Vec::new(),
    };
    let coefficients = over_wavelength(Axis::logarithmic("coefficient / (1/m)"), &COEFFICIENTS);
    let shares = over_wavelength(Axis::linear("share"), &SHARES);
    let radius = "phase function / (1/sr)";
    let phase = Plot {
        title: title.clone(),
        x: Axis::logarithmic("angle of scattering / degrees"),
        y: Axis::logarithmic(radius),
        series: phases(reports, LEAST_ANGLE),
        guides: Vec::new(),
    };
    let polar = Polar { title, radius: Axis::logarithmic(radius), series: phases(reports, 0.0) };
    vec![
        ("coefficients", coefficients.svg()),
        ("albedo", shares.svg()),
        ("phase", phase.svg()),
        ("phase_polar", polar.svg()),
    ]
}

/// Name of a curve of report `i`: with that of the medium where there are two.
fn named(reports: &[&MediumReport], i: usize, name: &str) -> String {
    if reports.len() > 1 { format!("{}: {name}", reports[i].medium) } else { name.into() }
}

fn series(reports: &[&MediumReport], i: usize, curves: &[Curve]) -> Vec<Series> {
    let report = reports[i];
    let style = match i {
        0 if report.wavelengths.len() <= MARKED => Style::MarksAndLine,
        0 => Style::Line,
        _ => Style::Dashes,
    };
    let curve = |(name, values): &Curve| Series {
        name: named(reports, i, name),
        points: report.wavelengths.iter().zip(values(report)).map(|(x, y)| Point::new(*x, *y)).collect(),
        style,
    };
    curves.iter().map(curve).collect()
}

fn phases(reports: &[&MediumReport], least: f64) -> Vec<Series> {
    let mut series = Vec::new();
    for (i, report) in reports.iter().enumerate() {
        let style = if i == 0 { Style::Line } else { Style::Dashes };
        for lambda in DRAWN {
            let degrees: Vec<f64> = report.phase.angles.iter().map(|angle| angle.to_degrees()).collect();
            let values = phase::at(&report.phase, lambda);
            // What lies below the axis is nearly that of the last such angle.
            let first = degrees.partition_point(|angle| *angle <= least).max(1) - 1;
            let points = degrees.iter().zip(values).skip(first);
            series.push(Series {
                name: named(reports, i, &format!("{lambda} nm")),
                points: points.map(|(angle, value)| Point::new(angle.max(least), value)).collect(),
                style,
            });
        }
    }
    series
}

/// A page with the diagrams and a text, which needs nothing else.
pub fn html(title: &str, diagrams: &[(&'static str, String)], text: &str) -> String {
    let mut page = format!(
        "<!doctype html>\n<meta charset=\"utf-8\">\n<title>{}</title>\n\
         <body style=\"font-family: sans-serif; margin: 2em\">\n",
        escape(title)
    );
    diagrams.iter().for_each(|(_, svg)| page += svg);
    let _ = writeln!(page, "<pre style=\"overflow: auto\">{}</pre>", escape(text));
    page
}
