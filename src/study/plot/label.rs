//! Numbers along an axis, and text in SVG.

use std::fmt::Write;

use quick_xml::escape::escape;

/// A number as it stands at a tick: `0.05`, or a power of ten with a factor before it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Label {
    /// With a decimal point.
    Decimal(String),
    /// factor x 10^exponent; a factor of 1 is not written.
    Power {
        /// A whole number.
        factor: i64,
        /// Of ten.
        exponent: i32,
    },
}

impl Label {
    /// A multiple of a power of ten, with a decimal point where it has few digits.
    pub fn of(factor: i64, exponent: i32) -> Self {
        if !(-4..=3).contains(&exponent) && factor != 0 {
            return Self::Power { factor, exponent };
        }
        let digits = usize::try_from(-exponent).unwrap_or(0);
        let value = if factor == 0 { 0.0 } else { factor as f64 * power(exponent) };
        Self::Decimal(with_minus(format!("{value:.digits$}")))
    }

    /// The contents of a `text` element.
    pub fn svg(&self) -> String {
        match self {
            Self::Decimal(text) => text.clone(),
            Self::Power { factor, exponent } => {
                let exponent = with_minus(exponent.to_string());
                let factor = if *factor == 1 { String::new() } else { with_minus(format!("{factor}·")) };
                format!(r#"{factor}10<tspan dy="-5" font-size="10">{exponent}</tspan>"#)
            }
        }
    }
}

/// 10^exponent, correctly rounded.
pub(super) fn power(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().unwrap_or(f64::NAN)
}

/// Print has a sign of its own for it, as wide as a plus.
fn with_minus(number: String) -> String {
    number.replace('-', "\u{2212}")
}

/// A number of an attribute: hundredths of a pixel are enough.
pub(super) fn pixel(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

/// Adds a text of which all that means something in XML is escaped.
pub(super) fn text(svg: &mut String, attributes: &str, text: &str) {
    let _ = writeln!(svg, "<text {attributes}>{}</text>", escape(text));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_in_print() {
        for (label, svg) in [
            (Label::of(2, -2), "0.02"),
            (Label::of(-25, -1), "\u{2212}2.5"),
            (Label::of(3, 2), "300"),
            (Label::of(0, -1), "0.0"),
            (Label::of(0, 9), "0"),
            (Label::of(-20, 5), "\u{2212}20·10<tspan dy=\"-5\" font-size=\"10\">5</tspan>"),
            (
                Label::Power { factor: 1, exponent: -3 },
                "10<tspan dy=\"-5\" font-size=\"10\">\u{2212}3</tspan>",
            ),
            (Label::Power { factor: 5, exponent: 12 }, "5·10<tspan dy=\"-5\" font-size=\"10\">12</tspan>"),
        ] {
            assert_eq!(label.svg(), svg);
        }
        for (value, text) in [(1.0, "1"), (0.005, "0.01"), (-0.001, "0"), (12.5, "12.5"), (100.0, "100")] {
            assert_eq!(pixel(value), text);
        }
    }
}
