//! What tells series apart: a colour and a shape each.

use super::label::pixel;
use super::{Series, Style};

/// `[OKABE08]` without its yellow, which is too pale for lines on white; the darker ones first.
const COLOURS: [&str; 7] = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000"];

/// Shapes of about one area, in a box from -1 to 1; none is the circle.
const SHAPES: [&[[f64; 2]]; 5] = [
    &[],
    &[[-0.88, -0.88], [0.88, -0.88], [0.88, 0.88], [-0.88, 0.88]],
    &[[0.0, -1.25], [1.15, 0.8], [-1.15, 0.8]],
    &[[0.0, -1.3], [1.1, 0.0], [0.0, 1.3], [-1.1, 0.0]],
    &[[0.0, 1.25], [1.15, -0.8], [-1.15, -0.8]],
];

/// Radius of a mark in pixels.
const RADIUS: f64 = 4.0;

/// Which colour and shape a series has: its number, and among dashed ones its number there, so that the first of them
/// looks like the first of all.
pub(super) fn look(series: &[Series], index: usize) -> usize {
    match series[index].style {
        Style::Dashes => series[..index].iter().filter(|other| other.style == Style::Dashes).count(),
        _ => index,
    }
}

/// The colour of series `index`. After all colours the first comes again, with another shape.
pub(super) fn colour(index: usize) -> &'static str {
    COLOURS[index % COLOURS.len()]
}

/// A mark of series `index`; the group around it has its colour.
pub(super) fn mark(index: usize, [x, y]: [f64; 2]) -> String {
    match SHAPES[index % SHAPES.len()] {
        [] => format!(r#"<circle cx="{}" cy="{}" r="{RADIUS}"/>"#, pixel(x), pixel(y)),
        corners => {
            let corner =
                |[dx, dy]: &[f64; 2]| format!("{},{}", pixel(x + RADIUS * dx), pixel(y + RADIUS * dy));
            let corners: Vec<String> = corners.iter().map(corner).collect();
            format!(r#"<polygon points="{}"/>"#, corners.join(" "))
        }
    }
}
