//! The errors of a group against its parameter, as a diagram.

use super::{Group, Row};
use crate::study::plot::{Axis, Plot, Point, Series, Style};

/// Errors below this are drawn there: a logarithmic axis has no place for none at all.
const LEAST: f64 = 1e-12;

/// A mark a case, with a bar from its error to what is allowed; nothing where the group has no rows.
pub fn of(group: &Group, rows: &[Row]) -> Option<Plot> {
    let own = || rows.iter().filter(|row| row.group == group.name);
    let mut names: Vec<&str> = Vec::new();
    for row in own() {
        if !names.contains(&row.name.as_str()) {
            names.push(&row.name);
        }
    }
    let has_two_signs = own().any(|row| row.parameter < 0.0);
    let x = match has_two_signs {
        true => Axis::linear(group.parameter),
        false => Axis::logarithmic(group.parameter),
    };
    let series = names.iter().map(|&name| Series {
        name: name.into(),
        points: own().filter(|row| row.name == name).map(point).collect(),
        style: Style::MarksAndLine,
    });
    let series: Vec<Series> = series.collect();
    (!series.is_empty()).then(|| Plot {
        title: group.name.into(),
        x,
        y: Axis::logarithmic("relative error, and what is allowed"),
        series,
        guides: Vec::new(),
    })
}

fn point(row: &Row) -> Point {
    let scale = if row.expected == 0.0 { 1.0 } else { row.expected.abs() };
    let error = row.error.max(LEAST);
    let allowed = row.allowed / scale;
    Point { y_range: Some([error, allowed.max(error)]), ..Point::new(row.parameter, error) }
}
