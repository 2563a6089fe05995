//! Where numbers lie along an axis, and which of them are marked.

use super::AxisKind;
use super::label::{Label, power};

/// The part of an axis that is left free at either end.
const MARGIN: f64 = 0.06;

/// Decades that a logarithmic axis has at least.
const FEWEST_DECADES: f64 = 0.5;

/// Labels along an axis, at most about so many.
const MOST_LABELS: f64 = 7.0;

/// An axis as it is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    kind: AxisKind,
    /// The ends: numbers on a linear axis, their decimal logarithms on a logarithmic one.
    ends: [f64; 2],
    /// The pixels of the ends.
    pixels: [f64; 2],
}

/// A mark along an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    /// Its pixel.
    pub at: f64,
    /// The number beside it; minor ticks have none.
    pub label: Option<Label>,
    /// Whether a line goes across the diagram.
    pub has_line: bool,
}

impl Scale {
    /// An axis from one pixel to another that shows all numbers that it can.
    pub fn covering(kind: AxisKind, values: impl Iterator<Item = f64>, pixels: [f64; 2]) -> Self {
        let places = values.filter_map(|value| place(kind, value));
        let [mut low, mut high] =
            places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)]);
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        let least = match kind {
            AxisKind::Logarithmic => FEWEST_DECADES,
            AxisKind::Linear if low == high => 0.2 * low.abs().max(5.0),
            AxisKind::Linear => 0.0,
        };
        let lacks = 0.5 * (least - (high - low)).max(0.0);
        let margin = lacks + MARGIN * (high - low);
        Self { kind, ends: [low - margin, high + margin], pixels }
    }

    /// The pixel of a number; it may be beyond the ends.
    pub fn at(&self, value: f64) -> Option<f64> {
        place(self.kind, value).map(|place| self.pixel(place))
    }

    /// The pixel of an end of an error bar, and whether that is where it ends: what is beyond an end of the axis, or
    /// has no place, is cut there.
    pub fn end(&self, value: f64, end: usize) -> (f64, bool) {
        let [low, high] = self.ends;
        match place(self.kind, value) {
            Some(place) if (low..=high).contains(&place) => (self.pixel(place), true),
            _ => (self.pixels[end], false),
        }
    }

    /// Whether a number lies between the ends.
    pub fn shows(&self, value: f64) -> bool {
        self.end(value, 0).1
    }

    /// Whether a number lies between the ends or at most so many decades beyond; extents of the axis, on a linear one.
    pub fn is_near(&self, value: f64, decades: f64) -> bool {
        let [low, high] = self.ends;
        let far = match self.kind {
            AxisKind::Linear => decades * (high - low),
            AxisKind::Logarithmic => decades,
        };
        place(self.kind, value).is_some_and(|place| (low - far..=high + far).contains(&place))
    }

    /// Pixels per unit of a linear axis, per decade of a logarithmic one.
    pub fn unit(&self) -> f64 {
        (self.pixels[1] - self.pixels[0]) / (self.ends[1] - self.ends[0])
    }

    /// The marks.
    pub fn ticks(&self) -> Vec<Tick> {
        match self.kind {
            AxisKind::Linear => self.linear_ticks(),
            AxisKind::Logarithmic => self.decades(),
        }
    }

    fn pixel(&self, place: f64) -> f64 {
        self.pixels[0] + (place - self.ends[0]) * self.unit()
    }

    /// Multiples of 1, 2 or 5 times a power of ten.
    fn linear_ticks(&self) -> Vec<Tick> {
        let [low, high] = self.ends;
        let least = (high - low) / MOST_LABELS;
        let exponent = libm::log10(least).floor() as i32;
        let digit =
            [1, 2, 5, 10].into_iter().find(|d| f64::from(*d) * power(exponent) >= least).unwrap_or(10);
        let step = f64::from(digit) * power(exponent);
        let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
        // A step of ten is one of the next power.
        let (digit, exponent) = if digit == 10 { (1, exponent + 1) } else { (digit, exponent) };
        let tick = |i: i64| Tick {
            at: self.pixel(i as f64 * step),
            label: Some(Label::of(i * i64::from(digit), exponent)),
            has_line: true,
        };
        (first..=last).map(tick).collect()
    }

    /// The powers of ten, and their multiples as minor ticks; labels at these too where there are few decades.
    fn decades(&self) -> Vec<Tick> {
        let [low, high] = self.ends;
        let (first, last) = (low.floor() as i32, high.floor() as i32);
        let stride = (f64::from(last - first) / MOST_LABELS).ceil().max(1.0) as i32;
        let marked = self.marked(first, last);
        let mut ticks = Vec::new();
        for exponent in first..=last {
            for factor in 1..=9_i64 {
                let at = f64::from(exponent) + libm::log10(factor as f64);
                if !(low..=high).contains(&at) || (factor > 1 && stride > 1) {
                    continue;
                }
                let is_labelled = marked.contains(&factor) && exponent.rem_euclid(stride) == 0;
                let label = match marked {
                    [1] => Label::Power { factor, exponent },
                    _ => Label::of(factor, exponent),
                };
                let label = is_labelled.then_some(label);
                ticks.push(Tick { at: self.pixel(at), label, has_line: factor == 1 });
            }
        }
        ticks
    }

    /// The factors of powers of ten that have labels: as few as make two labels.
    fn marked(&self, first: i32, last: i32) -> &'static [i64] {
        const CHOICES: [&[i64]; 3] = [&[1], &[1, 2, 5], &[1, 2, 3, 4, 5, 6, 7, 8, 9]];
        let [low, high] = self.ends;
        let count = |factors: &[i64]| {
            let places = (first..=last)
                .flat_map(|e| factors.iter().map(move |f| f64::from(e) + libm::log10(*f as f64)));
            places.filter(|at| (low..=high).contains(at)).count()
        };
        CHOICES.into_iter().find(|factors| count(factors) > 1).unwrap_or(CHOICES[2])
    }
}

/// Where a number lies, if it has a place.
fn place(kind: AxisKind, value: f64) -> Option<f64> {
    let place = match kind {
        AxisKind::Linear => value,
        AxisKind::Logarithmic if value > 0.0 => libm::log10(value),
        AxisKind::Logarithmic => return None,
    };
    place.is_finite().then_some(place)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(kind: AxisKind, ends: [f64; 2]) -> Vec<String> {
        let scale = Scale { kind, ends, pixels: [0.0, 100.0] };
        scale.ticks().into_iter().filter_map(|tick| tick.label).map(|label| label.svg()).collect()
    }

    fn power_of_ten(exponent: &str) -> String {
        format!(r#"10<tspan dy="-5" font-size="10">{exponent}</tspan>"#)
    }

    #[test]
    fn powers_of_ten_are_marked_and_more_where_there_are_few() {
        let log = AxisKind::Logarithmic;
        assert_eq!(labels(log, [-1.5, 1.2]), ["\u{2212}1", "0", "1"].map(power_of_ten));
        assert_eq!(labels(log, [-1.2, -0.2]), ["0.1", "0.2", "0.5"]);
        assert_eq!(labels(log, [1.1, 1.5]), ["20", "30"]);
        assert_eq!(labels(log, [0.0, 20.0]), ["0", "3", "6", "9", "12", "15", "18"].map(power_of_ten));
        let minor = Scale { kind: log, ends: [0.0, 2.0], pixels: [0.0, 100.0] }.ticks();
        assert_eq!((minor.len(), minor[1].label.clone()), (19, None));
        assert!((minor[1].at - 50.0 * 2.0_f64.log10()).abs() < 1e-9, "{minor:?}");
    }

    #[test]
    fn linear_axes_have_round_numbers() {
        let linear = AxisKind::Linear;
        assert_eq!(labels(linear, [-0.1, 1.05]), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(linear, [-30.0, 42.0]), ["\u{2212}20", "0", "20", "40"]);
        assert_eq!(labels(linear, [0.0, 700.0]), ["0", "100", "200", "300", "400", "500", "600", "700"]);
    }

    #[test]
    fn axes_hold_what_they_can_show() {
        let values = [1.0, 100.0, 0.0, -1.0, f64::NAN, f64::INFINITY];
        let scale = Scale::covering(AxisKind::Logarithmic, values.into_iter(), [0.0, 112.0]);
        // Two decades and 6 % of them at either end.
        for (value, pixel) in [(1.0, 6.0), (10.0, 56.0), (100.0, 106.0)] {
            assert!((scale.at(value).unwrap() - pixel).abs() < 1e-9, "{value}");
        }
        assert_eq!(
            (scale.at(0.0), scale.end(0.0, 0), scale.end(1e9, 1)),
            (None, (0.0, false), (112.0, false))
        );
        for kind in [AxisKind::Linear, AxisKind::Logarithmic] {
            for values in [&[][..], &[3.0], &[1e-300, 1e300]] {
                let scale = Scale::covering(kind, values.iter().copied(), [0.0, 100.0]);
                assert!(scale.ticks().len() > 1 && scale.unit().is_finite(), "{kind:?} {values:?}");
            }
        }
    }
}
