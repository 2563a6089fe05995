//! Error against run time, a mark a frame.

use super::{FrameReport, SequenceReport};
use crate::study::plot::{Axis, Guide, Plot, Point, Series, Style};

/// The pictures whose errors are known, stragglers apart, and a line along which an error falls as more samples are drawn;
/// `None` where there are none.
pub fn diagram(report: &SequenceReport, title: &str) -> Option<Plot> {
    let errors = report.errors.as_ref()?;
    let known = || report.frames.iter().filter(|f| f.state.is_there() && f.relative_error.is_some());
    let series = |name: &str, straggler: bool| Series {
        name: name.into(),
        points: known().filter(|frame| frame.straggler == straggler).filter_map(point).collect(),
        style: Style::Marks,
    };
    let series = [series("frames", false), series("stragglers", true)];
    let seconds = errors.cpu_seconds / known().count() as f64;
    Some(Plot {
        title: title.into(),
        x: Axis::logarithmic("CPU time / s"),
        y: Axis::logarithmic("estimated relative error"),
        series: series.into_iter().filter(|series| !series.points.is_empty()).collect(),
        guides: vec![Guide::Slope {
            slope: -0.5,
            through: [seconds, errors.root_mean_square],
            label: "slope \u{2212}1/2".into(),
        }],
    })
}

fn point(frame: &FrameReport) -> Option<Point> {
    let error = frame.relative_error?;
    let range = error.high.is_finite().then_some([error.low, error.high]);
    Some(Point { y_range: range, ..Point::new(frame.effort.cpu_seconds, error.estimate) })
}
