//! Puts a diagram over angles together: a half circle with 0 degrees to the right and 180 to the left.

use std::fmt::Write;

use super::label::{pixel, text};
use super::marks::{look, mark};
use super::scale::{Scale, Tick};
use super::sheet::{self, Strokes};
use super::{Point, Polar};

/// The middle of the circle, in pixels.
const MIDDLE: [f64; 2] = [276.0, 292.0];

/// Its radius.
const RADIUS: f64 = 210.0;

/// From the middle to the lower edge.
const BELOW: f64 = 54.0;

/// Where the names of the series begin.
const NAMES: f64 = MIDDLE[0] + RADIUS + 50.0;

/// Between the names of two series.
const LINE: f64 = 18.0;

/// Mean width of a letter of names, generous.
const LETTER: f64 = 8.2;

/// What a number along the base takes.
const ROOM: f64 = 36.0;

/// Degrees between two rays of the grid.
const RAY: i32 = 30;

pub(super) fn svg(plot: &Polar) -> String {
    let points = plot.series.iter().flat_map(|series| &series.points);
    let radii = Scale::covering(plot.radius.kind, points.map(|p| p.y), [0.0, RADIUS]);
    let names = plot.series.iter().map(|s| s.name.chars().count()).max().unwrap_or(0);
    let title = MIDDLE[0] - RADIUS + LETTER * 1.1 * plot.title.chars().count() as f64;
    let width = (NAMES + 32.0 + LETTER * names as f64).max(title).ceil();
    let mut svg = sheet::head(&plot.title, width, MIDDLE[1] + BELOW);
    draw_grid(&mut svg, &radii);
    for (index, series) in plot.series.iter().enumerate().rev() {
        let look = look(&plot.series, index);
        let mut strokes = Strokes::default();
        for point in &series.points {
            let Some(at) = place(&radii, point) else { continue };
            strokes.go_to(at, series.style);
            strokes.marks += &mark(look, at);
            strokes.marks.push('\n');
        }
        strokes.draw(&mut svg, look, series.style);
    }
    draw_names(&mut svg, plot);
    let [x, y] = MIDDLE;
    let head = format!(r#"x="{}" y="23" font-size="15" font-weight="bold""#, x - RADIUS);
    text(&mut svg, &head, &plot.title);
    let below = format!(r#"x="{x}" y="{}" font-size="14" text-anchor="middle""#, y + 42.0);
    text(&mut svg, &below, &plot.radius.label);
    svg + "</svg>\n"
}

/// Where a distance from the middle lies at an angle in degrees.
fn towards(degrees: f64, distance: f64) -> [f64; 2] {
    let angle = degrees.to_radians();
    [MIDDLE[0] + distance * libm::cos(angle), MIDDLE[1] - distance * libm::sin(angle)]
}

fn place(radii: &Scale, point: &Point) -> Option<[f64; 2]> {
    radii.at(point.y).filter(|_| (0.0..=180.0).contains(&point.x)).map(|r| towards(point.x, r))
}

/// The names of the series, in alphabetical order: lines cross here.
fn draw_names(svg: &mut String, plot: &Polar) {
    let mut order: Vec<usize> = (0..plot.series.len()).collect();
    order.sort_by_key(|index| &plot.series[*index].name);
    for (place, index) in order.into_iter().enumerate() {
        let at = [NAMES, 70.0 + LINE * place as f64];
        sheet::draw_name(svg, look(&plot.series, index), &plot.series[index], at);
    }
}

/// Rays with their angles, and half circles with their numbers along the base.
fn draw_grid(svg: &mut String, radii: &Scale) {
    let [x, y] = MIDDLE;
    let (mut lines, mut ticks, mut numbers) = (String::new(), String::new(), String::new());
    for degrees in (0..=180 / RAY).map(|i| f64::from(i * RAY)) {
        let [to_x, to_y] = towards(degrees, RADIUS);
        lines += &format!("M{x} {y}L{} {}", pixel(to_x), pixel(to_y));
        let [at_x, at_y] = towards(degrees, RADIUS + 18.0);
        let _ = writeln!(numbers, r#"<text x="{}" y="{}">{degrees}°</text>"#, pixel(at_x), pixel(at_y + 4.5));
    }
    let mut last = RADIUS + ROOM;
    for Tick { at, label, .. } in radii.ticks().into_iter().filter(|tick| tick.has_line).rev() {
        // Numbers of the two sides would meet in the middle.
        let label = label.filter(|_| at >= 24.0 && last - at >= ROOM);
        last = if label.is_some() { at } else { last };
        let r = pixel(at);
        lines += &format!("M{} {y}A{r} {r} 0 0 1 {} {y}", pixel(x - at), pixel(x + at));
        for side in [-1.0, 1.0] {
            let along = pixel(x + side * at);
            ticks += &format!("M{along} {y}v6");
            if let Some(label) = &label {
                let _ = writeln!(numbers, r#"<text x="{along}" y="{}">{}</text>"#, y + 19.0, label.svg());
            }
        }
    }
    let _ = write!(
        svg,
        "<path d=\"{lines}\" fill=\"none\" stroke=\"#e4e4e4\"/>\n\
         <path d=\"{ticks}M{} {y}A{RADIUS} {RADIUS} 0 0 1 {} {y}Z\" fill=\"none\" stroke=\"#000\"/>\n\
         <g text-anchor=\"middle\">\n{numbers}</g>\n",
        x - RADIUS,
        x + RADIUS,
    );
}
