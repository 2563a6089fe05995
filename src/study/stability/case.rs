//! One case of the battery: a scene with a parameter that makes it hard, a number that is known of it, and the verdict.
//!
//! ```text
//! pass:  |got - expected| <= k se + tolerance,   k = 4.5
//! ```
//! se is the standard error of what was got, from the picture's own samples; a normal number is farther off in 7 of a
//! million cases, and seeds are fixed. `tolerance` is what the case itself derives: roundings of f32, terms that a closed
//! form leaves out. Besides, no sample may have a lane that is negative or not finite, and no light may be lost unseen:
//! every counter of lost paths must be zero but for those that the case says are lost.
//!
//! Time is bounded in flights a sample, which are the same on every machine.

use std::time::Instant;

use serde::Serialize;

use super::picture::{Picture, Spoilt};
use crate::integrator::Counters;
use crate::study::StudyError;

/// k: standard errors that a number may be off.
const SCORES: f64 = 4.5;

/// Flights a sample that no case may exceed unless it says so: a second each, at ten million a second.
const MOST_FLIGHTS: f64 = 1e7;

/// Where a number that is compared with comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reference {
    /// A formula, or a quadrature of one.
    ClosedForm,
    /// What the limit of the parameter tends to.
    Limit,
    /// The same scene in another way: another unit, another order, another lane.
    Invariance,
}

/// Light that a case loses because it was asked to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loss {
    /// Paths that `max_depth` ends.
    DepthLimited,
    /// Paths cut at the hard limits.
    Cut,
    /// Total reflection without end.
    Trapped,
    /// Paths on the wrong side of a surface by rounding, more than one flight in a million.
    Astray,
}

/// What was measured.
#[derive(Clone, Debug)]
pub struct Measurement {
    /// What it is compared with.
    pub reference: Reference,
    /// The known number.
    pub expected: f64,
    /// How far off it may be without any noise.
    pub tolerance: f64,
    /// What the renderer says.
    pub got: f64,
    /// Its standard error; 0 where nothing is random.
    pub standard_error: f64,
    /// What happened in all pictures.
    pub counters: Counters,
    /// Samples in all pictures.
    pub samples: u64,
    /// Samples that are no radiance.
    pub spoilt: Spoilt,
    /// What may be lost.
    pub losses: Vec<Loss>,
    /// What else there is to say.
    pub note: String,
}

/// Measures, on as many threads as there are.
pub type Measure = Box<dyn Fn() -> Result<Measurement, StudyError> + Send + Sync>;

/// A case.
pub struct Case {
    /// Its group.
    pub group: &'static str,
    /// What is measured, in a few words.
    pub name: String,
    /// The parameter that makes it hard.
    pub parameter: f64,
    /// Whether it is part of the quick subset.
    pub is_quick: bool,
    explanation: Option<(String, f64)>,
    measure: Measure,
}

/// How a case ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// As expected.
    Pass,
    /// Not as expected, for a reason that is known and told, and by no more than is told.
    Explained,
    /// Not as expected.
    Fail,
}

/// A line of the results.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The group of the case.
    pub group: &'static str,
    /// What was measured.
    pub name: String,
    /// The parameter that makes it hard.
    pub parameter: f64,
    /// What it was compared with.
    pub reference: Reference,
    /// The known number.
    pub expected: f64,
    /// What the renderer says.
    pub got: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// How far off it may be: k standard errors, and what the case derives.
    pub allowed: f64,
    /// How far off it is, relative to what is expected unless that is 0.
    pub error: f64,
    /// Flights, traced or not, and shadow rays a sample.
    pub flights: f64,
    /// Seconds that it took.
    pub seconds: f64,
    /// The verdict.
    pub outcome: Outcome,
    /// Light that was lost, as counted; empty when none was.
    pub lost: String,
    /// Why it failed or is explained, and what else there is to say.
    pub note: String,
}

impl Case {
    /// A case.
    pub fn new(
        group: &super::Group,
        name: impl Into<String>,
        parameter: f64,
        measure: impl Fn() -> Result<Measurement, StudyError> + Send + Sync + 'static,
    ) -> Self {
        Self {
            group: group.name,
            name: name.into(),
            parameter,
            is_quick: false,
            explanation: None,
            measure: Box::new(measure),
        }
    }

    /// Part of the quick subset.
    #[must_use]
    pub fn quick(self) -> Self {
        self.quick_if(true)
    }

    /// Part of the quick subset under a condition.
    #[must_use]
    pub fn quick_if(self, is_quick: bool) -> Self {
        Self { is_quick, ..self }
    }

    /// Known not to be as expected, for this reason, by at most this relative error.
    #[must_use]
    pub fn explained(self, why: impl Into<String>, most: f64) -> Self {
        Self { explanation: Some((why.into(), most)), ..self }
    }

    /// Measures and judges.
    pub fn run(&self) -> Row {
        let start = Instant::now();
        let measured = (self.measure)();
        let seconds = start.elapsed().as_secs_f64();
        match measured {
            Ok(measured) => self.judge(&measured, seconds),
            Err(error) => Row {
                outcome: Outcome::Fail,
                note: error.to_string(),
                ..self.judge(&Measurement::new(Reference::Limit, 0.0, 0.0), seconds)
            },
        }
    }

    fn judge(&self, measured: &Measurement, seconds: f64) -> Row {
        let Measurement { expected, got, standard_error, .. } = *measured;
        let allowed = SCORES * standard_error + measured.tolerance;
        let off = (got - expected).abs();
        let error = if expected == 0.0 { off } else { off / expected.abs() };
        let mut faults = measured.faults();
        // Not `off > allowed`, which a number that is none would pass.
        let is_off = !(off <= allowed && allowed.is_finite());
        let (outcome, why) = match &self.explanation {
            Some((why, most)) if is_off && faults.is_empty() && error <= *most => {
                (Outcome::Explained, why.clone())
            }
            _ => {
                faults.extend(is_off.then(|| format!("off by {off:.2e}, allowed {allowed:.2e}")));
                let outcome = if faults.is_empty() { Outcome::Pass } else { Outcome::Fail };
                (outcome, faults.join("; "))
            }
        };
        let notes = [why, measured.note.clone()];
        let notes: Vec<String> = notes.into_iter().filter(|note| !note.is_empty()).collect();
        Row {
            group: self.group,
            name: self.name.clone(),
            parameter: self.parameter,
            reference: measured.reference,
            expected,
            got,
            standard_error,
            allowed,
            error,
            flights: measured.flights(),
            seconds,
            outcome,
            lost: measured.lost(),
            note: notes.join("; "),
        }
    }
}

impl Measurement {
    /// A number that is compared with another, of no picture yet.
    pub fn new(reference: Reference, expected: f64, got: f64) -> Self {
        Self {
            reference,
            expected,
            tolerance: 0.0,
            got,
            standard_error: 0.0,
            counters: Counters::default(),
            samples: 0,
            spoilt: Spoilt::default(),
            losses: Vec::new(),
            note: String::new(),
        }
    }

    /// With what happened in a picture; of several each is added.
    #[must_use]
    pub fn of(mut self, picture: &Picture) -> Self {
        self.counters += picture.counters;
        self.samples += picture.samples;
        self.spoilt.not_finite += picture.spoilt.not_finite;
        self.spoilt.negative += picture.spoilt.negative;
        self
    }

    /// A picture's mean grey, of which the red channel is taken.
    pub fn mean_of(picture: &Picture, reference: Reference, expected: f64) -> Self {
        let (mean, error) = picture.mean();
        Self::new(reference, expected, mean.x).of(picture).standard_error(error.x)
    }

    /// Each of the three channels of a picture's mean.
    pub fn channels_of(picture: &Picture, reference: Reference, expected: [f64; 3]) -> [Self; 3] {
        let (mean, error) = picture.mean();
        let channel = |i: usize| {
            let measured = Self::new(reference, expected[i], mean[i]).standard_error(error[i]);
            Self { note: format!("channel {i}"), ..measured }.of(picture)
        };
        [0, 1, 2].map(channel)
    }

    /// The pixel and channel that is farthest from what all of them should be.
    pub fn farthest_in(picture: &Picture, reference: Reference, expected: f64) -> Self {
        Self::new(reference, expected, picture.farthest(expected)).of(picture)
    }

    /// With noise.
    #[must_use]
    pub fn standard_error(self, standard_error: f64) -> Self {
        Self { standard_error, ..self }
    }

    /// How far off it may be without any noise, absolutely.
    #[must_use]
    pub fn tolerance(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// Loses this light because it was asked to.
    #[must_use]
    pub fn losing(mut self, loss: Loss) -> Self {
        self.losses.push(loss);
        self
    }

    /// With something to say.
    #[must_use]
    pub fn note(self, note: impl Into<String>) -> Self {
        Self { note: note.into(), ..self }
    }

    /// Of several comparisons the one that is farthest off, measured by what it may be off.
    pub fn worst(several: impl IntoIterator<Item = Self>) -> Self {
        let score = |m: &Self| {
            let score = (m.got - m.expected).abs() / (SCORES * m.standard_error + m.tolerance);
            // Exact where it has to be is no fault, and what is not a number is the greatest.
            if m.got == m.expected {
                0.0
            } else if score.is_nan() {
                f64::INFINITY
            } else {
                score
            }
        };
        let worst = several.into_iter().max_by(|a, b| score(a).total_cmp(&score(b)));
        worst.unwrap_or_else(|| Self::new(Reference::Limit, 0.0, f64::NAN))
    }

    fn flights(&self) -> f64 {
        let Counters { rays, untraced, shadow_rays, photons, .. } = self.counters;
        (rays + untraced + shadow_rays + photons) as f64 / (self.samples.max(1)) as f64
    }

    /// Every counter of light that does not get where it should, and whether the case allows it.
    fn losses(&self) -> [(&'static str, u64, bool); 6] {
        let c = &self.counters;
        let allows = |loss| self.losses.contains(&loss);
        // Points next to a surface may lie beyond it by their rounding: one flight in a million, as in any sound frame.
        let most = ((c.rays + c.untraced) as f64 * 1e-6).max(3.0);
        let rare = |count: u64| count as f64 <= most || allows(Loss::Astray);
        [
            ("not finite", c.non_finite, false),
            ("depth limited", c.depth_limited, allows(Loss::DepthLimited)),
            ("cut", c.cut, allows(Loss::Cut)),
            ("trapped", c.trapped, allows(Loss::Trapped)),
            ("label mismatches", c.label_mismatches, rare(c.label_mismatches)),
            ("escaped inside", c.escaped_inside, rare(c.escaped_inside)),
        ]
    }

    fn lost(&self) -> String {
        let counted = self.losses().into_iter().filter(|(_, count, _)| *count > 0);
        let texts = counted.map(|(name, count, _)| format!("{name} {count}"));
        match texts.collect::<Vec<_>>() {
            none if none.is_empty() => String::new(),
            some => format!("{} of {} samples", some.join(", "), self.samples),
        }
    }

    fn faults(&self) -> Vec<String> {
        let lost = self.losses().into_iter().filter(|(_, count, allowed)| *count > 0 && !allowed);
        let mut faults: Vec<String> = lost.map(|(name, ..)| format!("{name}: light is lost")).collect();
        let Spoilt { not_finite, negative } = self.spoilt;
        faults.extend((not_finite > 0).then(|| format!("{not_finite} samples are not finite")));
        faults.extend((negative > 0).then(|| format!("{negative} samples are negative")));
        let flights = self.flights();
        faults.extend((flights > MOST_FLIGHTS).then(|| format!("{flights:.0} flights a sample")));
        faults
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::stability::Group;

    const TEST: Group = Group { name: "test", parameter: "", about: "", cases: Vec::new };

    fn outcome(measured: Measurement) -> Outcome {
        Case::new(&TEST, "test", 1.0, move || Ok(measured.clone())).run().outcome
    }

    fn close() -> Measurement {
        Measurement::new(Reference::Limit, 1.0, 1.01)
    }

    #[test]
    fn a_number_passes_within_its_errors_only() {
        assert_eq!(outcome(close()), Outcome::Fail);
        assert_eq!(outcome(close().standard_error(0.003)), Outcome::Pass);
        assert_eq!(outcome(close().standard_error(0.002)), Outcome::Fail);
        assert_eq!(outcome(close().standard_error(0.002).tolerance(0.002)), Outcome::Pass);
        for spoilt in [f64::NAN, f64::INFINITY] {
            assert_eq!(outcome(close().standard_error(spoilt)), Outcome::Fail);
            assert_eq!(
                outcome(Measurement::new(Reference::Limit, 1.0, spoilt).tolerance(9.0)),
                Outcome::Fail
            );
        }
    }

    #[test]
    fn light_is_not_lost_unseen() {
        let with = |change: fn(&mut Measurement)| {
            let mut measured = close().tolerance(1.0);
            change(&mut measured);
            measured
        };
        assert_eq!(outcome(with(|_| ())), Outcome::Pass);
        let limited = with(|m| m.counters.depth_limited = 1);
        assert_eq!(outcome(limited.clone()), Outcome::Fail);
        assert_eq!(outcome(limited.losing(Loss::DepthLimited)), Outcome::Pass);
        assert_eq!(outcome(with(|m| m.counters.escaped_inside = 3)), Outcome::Pass);
        assert_eq!(outcome(with(|m| m.counters.escaped_inside = 4)), Outcome::Fail);
        assert_eq!(outcome(with(|m| m.spoilt.negative = 1)), Outcome::Fail);
        assert_eq!(outcome(with(|m| m.spoilt.not_finite = 1)), Outcome::Fail);
        assert_eq!(outcome(with(|m| m.counters.untraced = 20_000_000)), Outcome::Fail);
    }

    #[test]
    fn an_explanation_covers_no_more_than_it_says() {
        let run = |most, measured: Measurement| {
            Case::new(&TEST, "test", 1.0, move || Ok(measured.clone())).explained("because", most).run()
        };
        let row = run(0.02, close());
        assert_eq!((row.outcome, row.note.as_str()), (Outcome::Explained, "because"));
        assert_eq!(run(0.005, close()).outcome, Outcome::Fail);
        assert_eq!(run(0.02, close().tolerance(0.1)).outcome, Outcome::Pass);
        let mut spoilt = close();
        spoilt.spoilt.negative = 1;
        assert_eq!(run(0.02, spoilt).outcome, Outcome::Fail);
    }

    #[test]
    fn the_worst_is_that_which_is_off_by_most_of_what_it_may_be() {
        let number = |got, tolerance| Measurement::new(Reference::Limit, 1.0, got).tolerance(tolerance);
        assert_eq!(Measurement::worst([number(1.5, 1.0), number(1.1, 0.1), number(1.0, 0.0)]).got, 1.1);
        assert!(Measurement::worst([number(1.5, 1.0), number(f64::NAN, 0.1)]).got.is_nan());
        assert!(Measurement::worst([]).got.is_nan());
    }
}
