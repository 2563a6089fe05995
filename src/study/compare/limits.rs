//! When a difference is one.
//!
//! Pictures of the same bits agree whatever is asked. Others, with limits of relMSE or FLIP, agree when they keep these,
//! and pass the z-test if its significance is given too; without any limit they agree when the z-test finds nothing. A
//! number that is not finite in one of them, where the other has another one, is always a difference.
//!
//! The significance is that of all frames together: each gets its part, so that a long sequence raises no more false
//! alarms than one picture.

use serde::Serialize;

use super::measure::Comparison;
use crate::study::z_test::SIGNIFICANCE;

/// What is asked of pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// The greatest mean relMSE.
    pub max_relmse: Option<f64>,
    /// The greatest mean FLIP.
    pub max_flip: Option<f64>,
    /// Probability with which the z-test may take noise for a difference.
    pub significance: Option<f64>,
}

/// How a pair was judged.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "verdict", content = "reasons")]
pub enum Verdict {
    /// To the last bit.
    Identical,
    /// They differ by no more than noise.
    WithinNoise,
    /// They keep the limits.
    WithinLimits,
    /// Each way in which they differ, in words.
    Different(Vec<String>),
}

impl Limits {
    /// Judges one of several frames.
    pub fn judge(&self, found: &Comparison, frames: usize) -> Verdict {
        if found.identical {
            return Verdict::Identical;
        }
        let limited = self.max_relmse.is_some() || self.max_flip.is_some();
        let mut reasons = Vec::new();
        if found.broken > 0 {
            reasons.push(format!("{} pixels have numbers that are not finite", found.broken));
        }
        for (name, value, limit) in
            [("relMSE", found.relmse.mean, self.max_relmse), ("FLIP", found.flip, self.max_flip)]
        {
            if let Some(limit) = limit.filter(|limit| value.is_nan() || value > *limit) {
                reasons.push(format!("{name} {value:.3e} is above {limit}"));
            }
        }
        if let Some(significance) = self.significance.or((!limited).then_some(SIGNIFICANCE)) {
            reasons.extend(fails(found, significance / frames.max(1) as f64));
        }
        match (reasons.is_empty(), limited) {
            (false, _) => Verdict::Different(reasons),
            (true, true) => Verdict::WithinLimits,
            (true, false) => Verdict::WithinNoise,
        }
    }
}

/// Why the z-test fails, if it does.
fn fails(found: &Comparison, significance: f64) -> Option<String> {
    let Some(test) = &found.z_test else {
        let why = found.no_test.map(|why| why.to_string()).unwrap_or_default();
        return Some(format!(
            "there is no z-test, since {why}; allow for a difference with --max-relmse or --max-flip"
        ));
    };
    let worst = &test.worst;
    (test.p < significance).then(|| {
        format!(
            "more than noise: p = {:.1e} is below {significance:.1e}; {} of the {} x {} pixels at ({}, {}) is off by {:+.2} %",
            test.p, worst.channel, worst.size[0], worst.size[1], worst.at[0], worst.at[1], 100.0 * worst.relative
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::metrics::RelativeMse;
    use crate::study::z_test::{Deviation, NoTest, ZTest};

    fn found(p: Option<f64>) -> Comparison {
        let worst = Deviation {
            at: [16, 0],
            size: [16, 9],
            channel: "G",
            t: 5.0,
            degrees_of_freedom: 700.0,
            relative: 0.02,
        };
        Comparison {
            size: [32, 9],
            identical: false,
            broken: 0,
            means: [[1.0; 3]; 2],
            relmse: RelativeMse { mean: 0.01, trimmed: 0.009, median: 0.005 },
            rmse: 0.1,
            relative_difference: 0.0,
            flip: 0.05,
            greatest: None,
            z_test: p.map(|p| ZTest { p, worst, detectable: 0.01, left_out: 0 }),
            no_test: p.is_none().then_some(NoTest::NoVariance),
            flip_map: Vec::new(),
        }
    }

    fn reasons(limits: Limits, found: &Comparison, frames: usize) -> String {
        match limits.judge(found, frames) {
            Verdict::Different(reasons) => reasons.join("; "),
            verdict => format!("{verdict:?}"),
        }
    }

    #[test]
    fn without_limits_the_test_decides() {
        let none = Limits::default();
        assert_eq!(none.judge(&found(Some(0.0011)), 1), Verdict::WithinNoise);
        let words = reasons(none, &found(Some(0.0009)), 1);
        assert!(
            words.contains("more than noise") && words.contains("16 x 9 pixels at (16, 0) is off by +2.00 %"),
            "{words}"
        );
        // Of ten frames each has a tenth.
        assert_eq!(none.judge(&found(Some(0.0009)), 10), Verdict::WithinNoise);
        assert!(reasons(none, &found(Some(0.00009)), 10).contains("below 1.0e-4"));
        assert!(reasons(none, &found(None), 1).contains("--max-relmse"));
        let strict = Limits { significance: Some(0.05), ..none };
        assert!(reasons(strict, &found(Some(0.04)), 1).contains("below 5.0e-2"));
        let identical = Comparison { identical: true, ..found(None) };
        assert_eq!(strict.judge(&identical, 1), Verdict::Identical);
    }

    #[test]
    fn limits_decide_where_they_are_given() {
        let wide = Limits { max_relmse: Some(0.011), max_flip: Some(0.051), significance: None };
        assert_eq!(wide.judge(&found(Some(0.0)), 1), Verdict::WithinLimits);
        let narrow = Limits { max_relmse: Some(0.009), max_flip: Some(0.049), significance: Some(0.001) };
        let words = reasons(narrow, &found(Some(0.0)), 1);
        for word in ["relMSE 1.000e-2 is above 0.009", "FLIP 5.000e-2 is above 0.049", "more than noise"] {
            assert!(words.contains(word), "{words}");
        }
        let broken = Comparison { broken: 3, ..found(Some(1.0)) };
        assert!(reasons(wide, &broken, 1).starts_with("3 pixels"));
    }
}
