//! Diagrams for papers and web pages: points with error bars over linear or logarithmic axes, as SVG.
//!
//! ```text
//!         title
//!   y |  ¦     o          ¦
//!     |  ¦     |  o       ¦ o  name of the series, at the height of its last point
//!     |. ¦ . . . .|. . o. ¦ a level
//!     |  ¦- _             ¦
//!     |  ¦     - _        ¦ a slope
//!     +--------------------
//!               x
//! ```
//!
//! The file needs nothing else: text is in the reader's own sans serif, and there is no script. Its bytes follow from the
//! [`Plot`] alone. Series differ in shape as well as in colour, and the colours are those of `[OKABE08]`, which people
//! see apart who lack a kind of cones. A name stands in black beside its mark, since pale colours make bad letters.
//!
//! Over angles there is a [`Polar`] diagram beside the [`Plot`], in the same manner.
//!
//! What has no place on an axis (a number that is not finite, or not positive on a logarithmic one) is left out; an error
//! bar that goes below a logarithmic axis goes to its end and has no foot there.

mod draw;
mod label;
mod marks;
mod polar;
mod scale;
mod sheet;

/// A diagram.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// What stands over it.
    pub title: String,
    /// To the right.
    pub x: Axis,
    /// Up.
    pub y: Axis,
    /// The data; the first one is drawn last, over the others.
    pub series: Vec<Series>,
    /// What data are compared with.
    pub guides: Vec<Guide>,
}

/// Values over an angle from 0 to 180 degrees, as distances from the middle of a half circle. They are the same on
/// either side of the axis, so half of it says all.
#[derive(Clone, Debug, PartialEq)]
pub struct Polar {
    /// What stands over it.
    pub title: String,
    /// The distance from the middle.
    pub radius: Axis,
    /// The data, each x being an angle in degrees; the first one is drawn last, over the others. There are no error bars.
    pub series: Vec<Series>,
}

/// An axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The quantity, with its unit: `CPU time / s`.
    pub label: String,
    /// How numbers are spread.
    pub kind: AxisKind,
}

/// How numbers are spread along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisKind {
    /// Evenly.
    Linear,
    /// By their logarithms.
    Logarithmic,
}

impl Axis {
    /// A linear axis.
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), kind: AxisKind::Linear }
    }

    /// A logarithmic axis.
    pub fn logarithmic(label: impl Into<String>) -> Self {
        Self { label: label.into(), kind: AxisKind::Logarithmic }
    }
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name.
    pub name: String,
    /// The points, in the order in which a line joins them.
    pub points: Vec<Point>,
    /// What is drawn of them.
    pub style: Style,
}

/// What is drawn of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// Marks that a line joins.
    MarksAndLine,
    /// Marks alone, as of measurements.
    Marks,
    /// A line alone, as of a formula.
    Line,
    /// A dashed line, of what a line is compared with: the first dashed one has the colour of the first series.
    Dashes,
}

/// A point and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// To the right.
    pub x: f64,
    /// Up.
    pub y: f64,
    /// From where to where the horizontal error bar goes.
    pub x_range: Option<[f64; 2]>,
    /// From where to where the vertical error bar goes.
    pub y_range: Option<[f64; 2]>,
}

impl Point {
    /// A point without error bars.
    pub fn new(x: f64, y: f64) -> Self {
        Self { x, y, x_range: None, y_range: None }
    }
}

/// A line to compare with.
#[derive(Clone, Debug, PartialEq)]
pub enum Guide {
    /// A dashed line: y goes as x^slope where both axes are logarithmic, and straight with this slope where both are
    /// linear; with one of each there is none.
    Slope {
        /// Its slope.
        slope: f64,
        /// A point (x, y) that it goes through.
        through: [f64; 2],
        /// What it stands for.
        label: String,
    },
    /// A dotted line at a height. One that is more than a decade off the data (more than their extent, on a linear axis)
    /// is left out.
    Level {
        /// The height.
        y: f64,
        /// What it stands for.
        label: String,
    },
}

impl Plot {
    /// The text of an SVG file.
    pub fn svg(&self) -> String {
        draw::Drawing::of(self).svg()
    }
}

impl Polar {
    /// The text of an SVG file.
    pub fn svg(&self) -> String {
        polar::svg(self)
    }
}

#[cfg(test)]
mod tests;
#[cfg(test)]
pub(super) use tests::parsed;
