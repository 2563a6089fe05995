//! Puts a diagram together, from the back to the front: lines of the grid, guides, data, the frame, text.

use std::fmt::Write;

use super::label::{pixel, text};
use super::marks::{look, mark};
use super::scale::{Scale, Tick};
use super::sheet::{self, Strokes};
use super::{AxisKind, Guide, Plot, Series};

/// Left, top, right and bottom of the field of data, in pixels.
const FIELD: [f64; 4] = [66.0, 38.0, 486.0, 338.0];

/// From the field to the lower edge.
const BELOW: f64 = 52.0;

/// Between the names of two series.
const LINE: f64 = 18.0;

/// Mean width of a letter of names, generous.
const LETTER: f64 = 8.2;

/// Half the foot of an error bar.
const FOOT: f64 = 3.0;

/// Decades, or extents of the data, that a level may be away from the data.
const NEAR: f64 = 1.0;

/// A diagram with its axes.
pub(super) struct Drawing<'a> {
    plot: &'a Plot,
    x: Scale,
    y: Scale,
}

impl<'a> Drawing<'a> {
    pub fn of(plot: &'a Plot) -> Self {
        let [left, top, right, bottom] = FIELD;
        let points = || plot.series.iter().flat_map(|series| &series.points);
        let xs =
            points().flat_map(|p| [Some(p.x)].into_iter().chain(bar(p.x_range, p.x, plot.x.kind)).flatten());
        let ys =
            points().flat_map(|p| [Some(p.y)].into_iter().chain(bar(p.y_range, p.y, plot.y.kind)).flatten());
        let pixels = [bottom, top];
        let of_data = Scale::covering(plot.y.kind, ys.clone(), pixels);
        let levels = plot.guides.iter().filter_map(|guide| match guide {
            Guide::Level { y, .. } if of_data.is_near(*y, NEAR) => Some(*y),
            _ => None,
        });
        Self {
            plot,
            x: Scale::covering(plot.x.kind, xs, [left, right]),
            y: Scale::covering(plot.y.kind, ys.chain(levels), pixels),
        }
    }

    /// To the right, and up.
    #[cfg(test)]
    pub fn axes(&self) -> (Scale, Scale) {
        (self.x, self.y)
    }

    pub fn svg(&self) -> String {
        let [left, top, right, bottom] = FIELD;
        let names = self.plot.series.iter().map(|s| s.name.chars().count()).max().unwrap_or(0);
        let title = LETTER * 1.1 * self.plot.title.chars().count() as f64;
        let width = (right + 40.0 + LETTER * names as f64).max(left + title).ceil();
        let height = bottom + BELOW;
        let mut svg = sheet::head(&self.plot.title, width, height);
        self.draw_ticks(&mut svg);
        self.plot.guides.iter().for_each(|guide| self.draw_guide(&mut svg, guide));
        // The first one is drawn last: it is mostly what the diagram is about.
        for (index, series) in self.plot.series.iter().enumerate().rev() {
            self.draw_series(&mut svg, look(&self.plot.series, index), series);
        }
        let _ = writeln!(
            svg,
            r##"<rect x="{left}" y="{top}" width="{}" height="{}" fill="none" stroke="#000"/>"##,
            right - left,
            bottom - top
        );
        self.draw_names(&mut svg);
        self.draw_titles(&mut svg);
        svg + "</svg>\n"
    }

    /// The lines of the grid, the ticks and their numbers.
    fn draw_ticks(&self, svg: &mut String) {
        let [left, top, right, bottom] = FIELD;
        let (mut lines, mut ticks, mut numbers) = (String::new(), String::new(), String::new());
        for Tick { at, label, has_line } in self.x.ticks() {
            let (at, length) = (pixel(at), if has_line { 6.0 } else { 3.0 });
            lines += &if has_line { format!("M{at} {bottom}V{top}") } else { String::new() };
            ticks += &format!("M{at} {bottom}v-{length}");
            if let Some(label) = label {
                let _ = writeln!(numbers, r#"<text x="{at}" y="{}">{}</text>"#, bottom + 18.0, label.svg());
            }
        }
        let upright = numbers.clone();
        numbers.clear();
        for Tick { at, label, has_line } in self.y.ticks() {
            let length = if has_line { 6.0 } else { 3.0 };
            lines += &if has_line { format!("M{left} {}H{right}", pixel(at)) } else { String::new() };
            ticks += &format!("M{left} {}h{length}", pixel(at));
            if let Some(label) = label {
                let _ = writeln!(
                    numbers,
                    r#"<text x="{}" y="{}">{}</text>"#,
                    left - 6.0,
                    pixel(at + 4.5),
                    label.svg()
                );
            }
        }
        let _ = write!(
            svg,
            "<path d=\"{lines}\" fill=\"none\" stroke=\"#e4e4e4\"/>\n\
             <path d=\"{ticks}\" fill=\"none\" stroke=\"#000\"/>\n\
             <g text-anchor=\"middle\">\n{upright}</g>\n<g text-anchor=\"end\">\n{numbers}</g>\n"
        );
    }

    fn draw_guide(&self, svg: &mut String, guide: &Guide) {
        let [left, _, right, _] = FIELD;
        match guide {
            Guide::Level { y, label } => {
                let Some(at) = self.y.at(*y).filter(|_| self.y.shows(*y)) else { return };
                let _ = writeln!(
                    svg,
                    r##"<path d="M{left} {0}H{right}" fill="none" stroke="#555" stroke-width="1.2" stroke-dasharray="1.5 3.5"/>"##,
                    pixel(at)
                );
                let place =
                    format!(r##"x="{}" y="{}" fill="#555" font-size="12""##, left + 10.0, pixel(at - 5.0));
                text(svg, &place, label);
            }
            Guide::Slope { slope, through, label } => {
                if let Some([a, b]) = self.segment(*slope, *through) {
                    draw_slope(svg, a, b, label);
                }
            }
        }
    }

    /// The part of a line of a slope within the field.
    fn segment(&self, slope: f64, [x, y]: [f64; 2]) -> Option<[[f64; 2]; 2]> {
        let is_straight = self.plot.x.kind == self.plot.y.kind;
        let (x, y) = (self.x.at(x).filter(|_| is_straight)?, self.y.at(y)?);
        let steepness = slope * self.y.unit() / self.x.unit();
        let [left, top, right, bottom] = FIELD;
        let at = |pixel: f64| [pixel, y + steepness * (pixel - x)];
        // From where to where it is between the upper and the lower edge.
        let (over, under) = match steepness {
            0.0 if (top..=bottom).contains(&y) => (left, right),
            _ => (x + (top - y) / steepness, x + (bottom - y) / steepness),
        };
        let (from, to) = (over.min(under).max(left), over.max(under).min(right));
        (from < to).then(|| [at(from), at(to)])
    }

    fn draw_series(&self, svg: &mut String, look: usize, series: &Series) {
        let mut strokes = Strokes::default();
        for point in &series.points {
            let (Some(x), Some(y)) = (self.x.at(point.x), self.y.at(point.y)) else { continue };
            strokes.go_to([x, y], series.style);
            strokes.marks += &mark(look, [x, y]);
            strokes.marks.push('\n');
            for (end, value) in point.y_range.into_iter().flatten().enumerate() {
                let (to, has_foot) = self.y.end(value, end);
                let foot = if has_foot { format!("m-{FOOT} 0h{}", 2.0 * FOOT) } else { String::new() };
                strokes.bars += &format!("M{} {}V{}{foot}", pixel(x), pixel(y), pixel(to));
            }
            for (end, value) in point.x_range.into_iter().flatten().enumerate() {
                let (to, has_foot) = self.x.end(value, end);
                let foot = if has_foot { format!("m0 -{FOOT}v{}", 2.0 * FOOT) } else { String::new() };
                strokes.bars += &format!("M{} {}H{}{foot}", pixel(x), pixel(y), pixel(to));
            }
        }
        strokes.draw(svg, look, series.style);
    }

    /// The names of the series beside the field, as near as they can be to the height of their last points.
    fn draw_names(&self, svg: &mut String) {
        let [_, top, right, bottom] = FIELD;
        let last = |series: &Series| series.points.iter().rev().find_map(|p| self.y.at(p.y));
        let heights = self.plot.series.iter().map(|s| last(s).unwrap_or(top)).collect::<Vec<_>>();
        let places = apart(&heights, [top + 8.0, bottom - 8.0]);
        for (index, (series, at)) in self.plot.series.iter().zip(places).enumerate() {
            sheet::draw_name(svg, look(&self.plot.series, index), series, [right + 8.0, at]);
        }
    }

    fn draw_titles(&self, svg: &mut String) {
        let [left, top, right, bottom] = FIELD;
        let (middle, half) = (0.5 * (left + right), 0.5 * (top + bottom));
        let title = format!(r#"x="{left}" y="{}" font-size="15" font-weight="bold""#, top - 15.0);
        text(svg, &title, &self.plot.title);
        let x = format!(r#"x="{middle}" y="{}" font-size="14" text-anchor="middle""#, bottom + 42.0);
        text(svg, &x, &self.plot.x.label);
        let y =
            format!(r#"transform="translate(17 {half}) rotate(-90)" font-size="14" text-anchor="middle""#);
        text(svg, &y, &self.plot.y.label);
    }
}

/// A dashed line and, along it at its lower end, what it stands for.
fn draw_slope(svg: &mut String, a: [f64; 2], b: [f64; 2], label: &str) {
    let [[ax, ay], [bx, by]] = [a, b].map(|p| p.map(pixel));
    let _ = writeln!(
        svg,
        r##"<path d="M{ax} {ay}L{bx} {by}" fill="none" stroke="#555" stroke-width="1.2" stroke-dasharray="7 4"/>"##
    );
    let angle = libm::atan2(b[1] - a[1], b[0] - a[0]).to_degrees();
    // From the left end where the line rises, from the right end where it falls: away from the data above it.
    let (at, anchor, inwards) = if b[1] < a[1] { (a, "start", 12.0) } else { (b, "end", -12.0) };
    let place = format!(
        r##"transform="translate({} {}) rotate({})" x="{inwards}" y="-6" fill="#555" font-size="12" text-anchor="{anchor}""##,
        pixel(at[0]),
        pixel(at[1]),
        pixel(angle)
    );
    text(svg, &place, label);
}

/// The ends of an error bar that say how far an axis has to go: on a logarithmic one not to where a number is known
/// by a tenth of itself only.
fn bar(range: Option<[f64; 2]>, value: f64, kind: AxisKind) -> [Option<f64>; 2] {
    let far = |end: f64| kind == AxisKind::Logarithmic && end < 0.1 * value;
    range.map_or([None; 2], |range| range.map(|end| (!far(end)).then_some(end)))
}

/// Heights that are at least [`LINE`] apart and within bounds, if there is room, in the order of the given ones.
fn apart(heights: &[f64], [top, bottom]: [f64; 2]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..heights.len()).collect();
    order.sort_by(|a, b| heights[*a].total_cmp(&heights[*b]).then(a.cmp(b)));
    let mut places = heights.to_vec();
    let mut least = top;
    for &i in &order {
        places[i] = places[i].max(least);
        least = places[i] + LINE;
    }
    let mut most = bottom.max(top + LINE * heights.len().saturating_sub(1) as f64);
    for &i in order.iter().rev() {
        places[i] = places[i].min(most);
        most = places[i] - LINE;
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_keep_apart_in_the_order_of_their_heights() {
        assert_eq!(apart(&[50.0, 40.0, 45.0], [0.0, 100.0]), [76.0, 40.0, 58.0]);
        assert_eq!(apart(&[99.0, 98.0], [0.0, 100.0]), [100.0, 82.0]);
        assert_eq!(apart(&[5.0; 3], [0.0, 20.0]), [0.0, 18.0, 36.0]);
    }
}
