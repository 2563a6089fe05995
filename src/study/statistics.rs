//! What repeats tell: means and slopes with their confidence intervals.
//!
//! ```text
//! mean +- t s / R^(1/2)       s^2 = sum_r (v_r - mean)^2 / (R - 1)                       (1)
//! ```
//!
//! t is the quantile of Student's distribution with R - 1 degrees of freedom beyond which 2.5 % lie on either side. A slope
//! takes the same way: a straight line is fitted by least squares to the points of each repeat, and (1) is taken of the R
//! slopes. Repeats have seeds of their own, so their slopes are independent and of one distribution, whatever the points of
//! a repeat have to do with each other and however their errors differ between budgets. Only that the slopes are about
//! normal is assumed; `intervals_hold_the_truth_as_often_as_they_say` finds the rate for points with such errors.
//!
//! A line through the logarithms of errors that do not fall as a power has the slope of the chord, about: more repeats make
//! its interval narrow and do not make it straight.

use serde::Serialize;

use super::distributions::student_quantile;

/// Rate at which intervals hold the truth.
pub const CONFIDENCE: f64 = 0.95;

/// A number and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Half of its confidence interval; not a number where a single repeat does not tell.
    pub half_width: f64,
}

/// The mean of a sample, and its variance s^2, which of fewer than two is not a number.
pub fn mean_and_variance(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (n - 1.0))
}

impl Estimate {
    /// (1).
    pub fn of_mean(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let (value, variance) = mean_and_variance(values);
        let t = student_quantile(0.5 + 0.5 * CONFIDENCE, n - 1.0);
        Self { value, half_width: t * (variance / n).sqrt() }
    }

    /// The ends of the interval.
    pub fn ends(&self) -> [f64; 2] {
        [self.value - self.half_width, self.value + self.half_width]
    }
}

/// A straight line y = y0 + slope x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// y at 0.
    pub y0: f64,
    /// Its slope.
    pub slope: f64,
}

impl Line {
    /// The line nearest to points (x, y) in the sense of least squares in y; `None` unless there are two x.
    pub fn fitted(points: &[[f64; 2]]) -> Option<Self> {
        let n = points.len() as f64;
        let [x0, y0] = points.iter().fold([0.0, 0.0], |[sx, sy], [x, y]| [sx + x, sy + y]).map(|sum| sum / n);
        let (xy, xx) = points
            .iter()
            .fold((0.0, 0.0), |(xy, xx), [x, y]| (xy + (x - x0) * (y - y0), xx + (x - x0) * (x - x0)));
        let slope = xy / xx;
        slope.is_finite().then_some(Self { y0: y0 - slope * x0, slope })
    }
}

/// The mean slope of the lines through the points of each repeat.
pub fn slope(repeats: &[Vec<[f64; 2]>]) -> Option<Estimate> {
    let slopes: Option<Vec<f64>> = repeats.iter().map(|points| Some(Line::fitted(points)?.slope)).collect();
    slopes.filter(|slopes| slopes.len() > 1).map(|slopes| Estimate::of_mean(&slopes))
}

/// e^x at which the lines through the points of each repeat have the value y; the interval is that of x.
pub fn crossing(repeats: &[Vec<[f64; 2]>], y: f64) -> Option<[f64; 3]> {
    let at = |points: &Vec<[f64; 2]>| {
        let Line { y0, slope } = Line::fitted(points)?;
        Some((y - y0) / slope)
    };
    let places: Option<Vec<f64>> = repeats.iter().map(at).collect();
    let place = Estimate::of_mean(&places.filter(|places| places.len() > 1)?);
    let [low, high] = place.ends();
    let times = [low, place.value, high].map(libm::exp);
    times.iter().all(|time| time.is_finite()).then_some(times)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::SplitMix;

    #[test]
    fn a_mean_has_the_interval_of_the_tables() {
        // s^2 = 2.5 and t = 2.776445 for four degrees of freedom (Abramowitz and Stegun, table 26.10).
        let estimate = Estimate::of_mean(&[1.0, 2.0, 3.0, 4.0, 5.0]);
        assert!((estimate.value - 3.0).abs() < 1e-15);
        assert!((estimate.half_width - 2.776_445 * f64::sqrt(0.5)).abs() < 1e-6, "{estimate:?}");
        assert!(Estimate::of_mean(&[1.0]).half_width.is_nan());
    }

    #[test]
    fn a_line_is_found_again() {
        let line = Line::fitted(&[[1.0, 5.0], [2.0, 3.0], [4.0, -1.0]]).unwrap();
        assert!((line.slope + 2.0).abs() < 1e-12 && (line.y0 - 7.0).abs() < 1e-12, "{line:?}");
        assert_eq!(Line::fitted(&[[1.0, 5.0]]), None);
        assert_eq!(slope(&[vec![[0.0, 0.0], [1.0, 1.0]]]), None);
        let same = vec![vec![[0.0, 1.0], [2.0, 0.0]]; 3];
        let [low, middle, high] = crossing(&same, 0.5).unwrap();
        assert!((low, high) == (middle, middle) && (middle - 1.0_f64.exp()).abs() < 1e-12, "{middle}");
    }

    /// 1000 intervals of slopes of 8 repeats over 6 budgets, whose errors differ by a factor of 5 between budgets and are
    /// alike within a repeat: 950 +- 6.9 hold the truth. 922 is four deviations below (3e-5), and 978 four above.
    #[test]
    fn intervals_hold_the_truth_as_often_as_they_say() {
        let mut random = SplitMix(3);
        let mut held = 0;
        for _ in 0..1000 {
            let repeats: Vec<Vec<[f64; 2]>> = (0..8)
                .map(|_| {
                    let shared = random.normal();
                    let point = |b: i32| {
                        let x = f64::from(b) * std::f64::consts::LN_2;
                        let noise = 0.01 * f64::from(b + 1) * (random.normal() + shared);
                        [x, 0.3 - 0.5 * x + noise]
                    };
                    (0..6).map(point).collect()
                })
                .collect();
            let [low, high] = slope(&repeats).unwrap().ends();
            held += i32::from(low <= -0.5 && -0.5 <= high);
        }
        assert!((922..978).contains(&held), "{held} of 1000 intervals hold the slope");
    }
}
