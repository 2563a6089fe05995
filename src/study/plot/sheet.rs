//! What every diagram has: a white sheet with a title, lines and marks of series, and their names.

use std::fmt::Write;

use quick_xml::escape::escape;

use super::label::{pixel, text};
use super::marks::{colour, mark};
use super::{Series, Style};

/// Points of a line without marks that are nearer than this to the last one are left out: nobody sees them, in pixels.
const UNSEEN: f64 = 0.4;

/// The beginning of a file: all after it is drawn over a white ground.
pub(super) fn head(title: &str, width: f64, height: f64) -> String {
    let title = escape(title);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" role=\"img\" font-family=\"Helvetica, Arial, sans-serif\" \
         font-size=\"13\" fill=\"#000\">\n<title>{title}</title>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n"
    )
}

/// What is drawn of a series.
#[derive(Default)]
pub(super) struct Strokes {
    line: String,
    last: Option<[f64; 2]>,
    /// Path of the error bars.
    pub bars: String,
    /// Marks, a line each.
    pub marks: String,
}

impl Strokes {
    /// Takes the line to its next point.
    pub fn go_to(&mut self, [x, y]: [f64; 2], style: Style) {
        let is_near = |[from_x, from_y]: [f64; 2]| (x - from_x).abs().max((y - from_y).abs()) < UNSEEN;
        if matches!(style, Style::Line | Style::Dashes) && self.last.is_some_and(is_near) {
            return;
        }
        self.last = Some([x, y]);
        self.line += &format!("{}{} {}", if self.line.is_empty() { "M" } else { "L" }, pixel(x), pixel(y));
    }

    /// Adds them in the colour of a look.
    pub fn draw(&self, svg: &mut String, look: usize, style: Style) {
        let Self { line, bars, marks, .. } = self;
        let colour = colour(look);
        let _ = writeln!(svg, r#"<g fill="{colour}" stroke="{colour}">"#);
        if style != Style::Marks {
            let dashes = dashes(style);
            let _ = writeln!(
                svg,
                r#"<path d="{line}" fill="none" stroke-width="1.6" stroke-linejoin="round"{dashes}/>"#
            );
        }
        let _ = writeln!(svg, r#"<path d="{bars}" fill="none" stroke-width="1.2"/>"#);
        if matches!(style, Style::MarksAndLine | Style::Marks) {
            // A white edge keeps marks apart that lie upon each other.
            let _ = writeln!(svg, "<g stroke=\"#fff\" stroke-width=\"0.8\">\n{marks}</g>");
        }
        svg.push_str("</g>\n");
    }
}

/// The name of a series in black, beside a piece of its line.
pub(super) fn draw_name(svg: &mut String, look: usize, series: &Series, [x, y]: [f64; 2]) {
    let colour = colour(look);
    let _ = write!(svg, r#"<g fill="{colour}" stroke="{colour}">"#);
    if series.style != Style::Marks {
        let dashes = dashes(series.style);
        let _ = write!(svg, r#"<path d="M{} {}h22" stroke-width="1.6"{dashes}/>"#, pixel(x), pixel(y));
    }
    if matches!(series.style, Style::MarksAndLine | Style::Marks) {
        svg.push_str(&mark(look, [x + 11.0, y]));
    }
    svg.push_str("</g>\n");
    text(svg, &format!(r#"x="{}" y="{}""#, pixel(x + 28.0), pixel(y + 4.5)), &series.name);
}

fn dashes(style: Style) -> &'static str {
    if style == Style::Dashes { r#" stroke-dasharray="5 3""# } else { "" }
}
