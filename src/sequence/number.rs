//! The number of a frame, as an integer count of millionths.
//!
//! Most frames have whole numbers. Some simulators name a frame by its time (`iter_12.5.dsc`); up to six
//! decimals are kept exactly. Equality, order and random seeds never see a rounded value.

use std::fmt;
use std::str::FromStr;

const MILLION: i64 = 1_000_000;

/// The number of a frame: whole, or with up to six decimals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FrameNumber(i64);

/// A text that is not a frame number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("not a frame number: write digits, with up to 6 decimals and at most {limit}", limit = FrameNumber::LIMIT)]
pub struct ParseFrameNumberError;

impl FrameNumber {
    /// The greatest whole number (and, negated, the least).
    pub const LIMIT: i64 = 1_000_000_000_000;

    /// The number of a still frame.
    pub const ONE: Self = Self(MILLION);

    /// A whole number, if it is within [`FrameNumber::LIMIT`].
    pub fn from_integer(number: i64) -> Option<Self> {
        (-Self::LIMIT..=Self::LIMIT).contains(&number).then(|| Self(number * MILLION))
    }

    /// A number of millionths, if it is within [`FrameNumber::LIMIT`].
    pub(super) fn from_millionths(millionths: i64) -> Option<Self> {
        (-Self::LIMIT * MILLION..=Self::LIMIT * MILLION).contains(&millionths).then_some(Self(millionths))
    }

    /// Reads what [`FromStr`] reads, and times with an exponent: `1e-05`.
    pub(super) fn from_time(text: &str) -> Result<Self, ParseFrameNumberError> {
        let Some((mantissa, exponent)) = text.split_once(['e', 'E']) else { return text.parse() };
        let (sign, mantissa) = mantissa.strip_prefix('-').map_or(("", mantissa), |rest| ("-", rest));
        let (whole, decimals) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let exponent: i32 = exponent.parse().map_err(|_| ParseFrameNumberError)?;
        // More lies beyond every limit.
        if whole.is_empty() || !(-99..=99).contains(&exponent) {
            return Err(ParseFrameNumberError);
        }
        let zeros = "0".repeat(99);
        let digits = format!("{zeros}{whole}{decimals}{zeros}");
        let point = (zeros.len() + whole.len()).saturating_add_signed(exponent as isize);
        match digits.split_at_checked(point) {
            Some((whole, decimals)) => format!("{sign}{whole}.{decimals}").parse(),
            None => Err(ParseFrameNumberError),
        }
    }

    /// The integer key of the frame: its number in millionths.
    pub fn millionths(self) -> i64 {
        self.0
    }

    /// The number, when it is whole.
    pub fn integer(self) -> Option<i64> {
        (self.0 % MILLION == 0).then_some(self.0 / MILLION)
    }

    /// The number with its whole part padded to `width` digits: 12.5 in four digits is `0012.5`.
    pub fn padded(self, width: usize) -> String {
        let sign = if self.0 < 0 { "-" } else { "" };
        let magnitude = self.0.unsigned_abs();
        let (whole, part) = (magnitude / MILLION as u64, magnitude % MILLION as u64);
        let decimals = format!("{part:06}");
        match decimals.trim_end_matches('0') {
            "" => format!("{sign}{whole:0width$}"),
            decimals => format!("{sign}{whole:0width$}.{decimals}"),
        }
    }
}

impl From<u32> for FrameNumber {
    fn from(number: u32) -> Self {
        Self(i64::from(number) * MILLION)
    }
}

impl fmt::Display for FrameNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.padded(1))
    }
}

impl FromStr for FrameNumber {
    type Err = ParseFrameNumberError;

    /// Reads `7`, `0007`, `-3` or `12.5`; padding of any length is allowed.
    fn from_str(text: &str) -> Result<Self, ParseFrameNumberError> {
        let (sign, digits) = match text.strip_prefix('-') {
            Some(rest) => (-1, rest),
            None => (1, text),
        };
        let (whole, decimals) = digits.split_once('.').unwrap_or((digits, "0"));
        let all_digits = |s: &str| !s.is_empty() && s.bytes().all(|b| b.is_ascii_digit());
        let kept = decimals.trim_end_matches('0');
        if !all_digits(whole) || !all_digits(decimals) || kept.len() > 6 {
            return Err(ParseFrameNumberError);
        }
        let whole: i64 = whole.parse().map_err(|_| ParseFrameNumberError)?;
        let decimals: i64 = format!("{kept:0<6}").parse().map_err(|_| ParseFrameNumberError)?;
        whole
            .checked_mul(MILLION)
            .and_then(|whole| whole.checked_add(decimals))
            .and_then(|millionths| Self::from_millionths(sign * millionths))
            .ok_or(ParseFrameNumberError)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn number(text: &str) -> FrameNumber {
        text.parse().unwrap()
    }

    #[test]
    fn numbers_are_exact_and_ordered_by_value() {
        assert_eq!(number("12.5").millionths(), 12_500_000);
        assert_eq!(number("0007"), FrameNumber::from(7));
        assert_eq!(number("-0.25").millionths(), -250_000);
        assert_eq!(number("1.50000000"), number("1.5"));
        assert_eq!(number("3.0"), FrameNumber::from(3));
        assert_eq!(number("3.00").integer(), Some(3));
        assert_eq!(number("12.5").integer(), None);
        let mut sorted = ["100", "12.5", "0.5", "-2", "9"].map(number);
        sorted.sort();
        assert_eq!(sorted.map(|n| n.to_string()), ["-2", "0.5", "9", "12.5", "100"]);
    }

    #[test]
    fn text_that_is_no_number_is_refused() {
        let huge = "9".repeat(400);
        for text in
            ["", "-", ".", "1.", ".5", "+1", "1e3", "--1", "1.2.3", "1.1234567", "٣", &huge, "1000000000001"]
        {
            assert!(text.parse::<FrameNumber>().is_err(), "{text}");
        }
        assert!("1000000000000".parse::<FrameNumber>().is_ok());
        assert!(("0".repeat(300) + "5").parse::<FrameNumber>().is_ok());
        assert_eq!(FrameNumber::from_integer(i64::MAX), None);
        assert_eq!(FrameNumber::from_integer(i64::MIN), None);
    }

    #[test]
    fn times_with_an_exponent_are_exact() {
        for (text, number) in [
            ("1e-05", "0.00001"),
            ("2.5e-05", "0.000025"),
            ("12.5e-1", "1.25"),
            ("1.25E+2", "125"),
            ("1.25e1", "12.5"),
            ("3e6", "3000000"),
            ("-1.5e-1", "-0.15"),
            ("0.05", "0.05"),
            ("12", "12"),
        ] {
            assert_eq!(FrameNumber::from_time(text).map(|n| n.to_string()), Ok(number.to_owned()), "{text}");
        }
        for text in
            ["1e-07", "1e13", "1e", "e5", "1e5.5", "1e999999999999", "1e-100", "é1e2", "1.e-3.5", "-1e-3x"]
        {
            assert!(FrameNumber::from_time(text).is_err(), "{text}");
        }
    }

    #[test]
    fn padding_grows_and_keeps_decimals() {
        assert_eq!(number("7").padded(4), "0007");
        assert_eq!(number("12345").padded(4), "12345");
        assert_eq!(number("12.5").padded(4), "0012.5");
        assert_eq!(number("-5").padded(4), "-0005");
        assert_eq!(number("0.000001").padded(1), "0.000001");
    }

    proptest! {
        #[test]
        fn parsing_never_panics(text in ".{0,40}", exponent in "[0-9é.]{0,6}[eE][-+]?[0-9]{0,4}") {
            let _ = text.parse::<FrameNumber>();
            let _ = FrameNumber::from_time(&text);
            let _ = FrameNumber::from_time(&exponent);
        }

        #[test]
        fn display_parses_back(millionths in -1_000_000_000_000_000_000i64..=1_000_000_000_000_000_000) {
            let number = FrameNumber::from_millionths(millionths).unwrap();
            prop_assert_eq!(number.to_string().parse(), Ok(number));
        }
    }
}
