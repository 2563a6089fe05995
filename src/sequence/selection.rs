//! The frames that the command line asks for: `1-100x2`, `1-5:2,610`, `-5--1`, `12.5`.
//!
//! ```text
//! selection = part { "," part }
//! part      = number [ "-" number [ ( "x" | ":" ) step ] ]
//! ```
//! A range without a step holds every number between its ends, decimal ones too. With a step it holds its
//! first number and those at whole multiples of the step from there.

use std::fmt;

use super::{FrameFile, FrameNumber, SequenceError};

/// A set of frame numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameSelection {
    text: String,
    parts: Vec<Part>,
}

/// One range; a step of `None` takes all between the ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Part {
    first: FrameNumber,
    last: FrameNumber,
    step: Option<FrameNumber>,
}

impl FrameSelection {
    /// Reads a selection.
    ///
    /// # Errors
    /// [`SequenceError::Selection`] with the part that cannot be understood.
    pub fn parse(text: &str) -> Result<Self, SequenceError> {
        let parts = text.split(',').map(|part| {
            let part = part.trim();
            parse_part(part).map_err(|reason| SequenceError::Selection {
                text: text.to_owned(),
                part: part.to_owned(),
                reason: reason.to_owned(),
            })
        });
        Ok(Self { text: text.to_owned(), parts: parts.collect::<Result<_, _>>()? })
    }

    /// Whether a frame is selected.
    pub fn contains(&self, number: FrameNumber) -> bool {
        self.parts.iter().any(|part| part.contains(number))
    }

    /// The selected frames of a sequence, in its order.
    ///
    /// # Errors
    /// [`SequenceError::NoneSelected`] when no frame is left.
    pub fn select(&self, frames: &[FrameFile]) -> Result<Vec<FrameFile>, SequenceError> {
        let selected: Vec<FrameFile> =
            frames.iter().filter(|frame| self.contains(frame.number)).cloned().collect();
        if selected.is_empty() {
            let numbers: Vec<FrameNumber> = frames.iter().map(|frame| frame.number).collect();
            let available = format_numbers(&numbers);
            return Err(SequenceError::NoneSelected { selection: self.text.clone(), available });
        }
        Ok(selected)
    }

    /// The selected numbers in order; a range without a step has those at whole distances from its first one.
    pub fn numbers(&self) -> impl Iterator<Item = FrameNumber> {
        let first = self.parts.iter().map(|part| part.first).min();
        std::iter::successors(first, |&before| self.parts.iter().filter_map(|part| part.after(before)).min())
    }

    /// Where a selected frame stands among all that might be there, from 0 and in the order of the text: part after
    /// part, of which one without a step counts whole distances from its first number.
    pub fn position(&self, number: FrameNumber) -> Option<u128> {
        let part = self.parts.iter().position(|part| part.contains(number))?;
        let before: u128 = self.parts[..part].iter().map(Part::places).sum();
        Some(before + self.parts[part].place(number))
    }

    /// How many positions there are; numbers that several parts have count for each.
    pub fn positions(&self) -> u128 {
        self.parts.iter().map(Part::places).sum()
    }

    /// The single numbers of the selection that are not in a sequence; ranges take what there is.
    pub fn absent(&self, numbers: &[FrameNumber]) -> Vec<FrameNumber> {
        let single = self.parts.iter().filter(|part| part.first == part.last).map(|part| part.first);
        let mut absent: Vec<FrameNumber> = single.filter(|number| !numbers.contains(number)).collect();
        absent.sort_unstable();
        absent.dedup();
        absent
    }
}

impl fmt::Display for FrameSelection {
    /// As it was written.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Part {
    /// The least number of the part that is greater than another, in steps of 1 where there is no step.
    fn after(&self, before: FrameNumber) -> Option<FrameNumber> {
        let (first, step) = (self.first.millionths(), self.step.unwrap_or(FrameNumber::ONE).millionths());
        let steps = (before.millionths() - first).div_euclid(step) + 1;
        let next = FrameNumber::from_millionths(first + steps.max(0) * step)?;
        (next <= self.last).then_some(next)
    }

    /// The place of a number that it contains, from 0.
    fn place(&self, number: FrameNumber) -> u128 {
        let step = self.step.unwrap_or(FrameNumber::ONE);
        u128::from(number.millionths().abs_diff(self.first.millionths()) / step.millionths().unsigned_abs())
    }

    fn places(&self) -> u128 {
        self.place(self.last) + 1
    }

    fn contains(&self, number: FrameNumber) -> bool {
        let offset = || number.millionths() - self.first.millionths();
        (self.first..=self.last).contains(&number)
            && self.step.is_none_or(|step| offset() % step.millionths() == 0)
    }
}

/// Reads one part; the error is its reason with its cure.
fn parse_part(part: &str) -> Result<Part, &'static str> {
    const NUMBER: &str = "write numbers and ranges such as 7,20-30,40-100x2 (at most 6 decimals)";
    if part.is_empty() {
        return Err("there is nothing between two commas or at an end: remove the comma or write a number");
    }
    let (range, step) = match part.split_once(['x', ':']) {
        Some((range, step)) => (range, Some(step)),
        None => (part, None),
    };
    // A dash at the start is a sign; the first one after that separates the ends.
    let dash = range.char_indices().skip(1).find(|&(_, c)| c == '-').map(|(at, _)| at);
    let (first, last) = dash.map_or((range, range), |at| (&range[..at], &range[at + 1..]));
    let parse = |text: &str| text.trim().parse::<FrameNumber>().map_err(|_| NUMBER);
    let (first, last) = (parse(first)?, parse(last)?);
    let step = step.map(parse).transpose()?;
    if first > last {
        return Err("the range runs backwards: put the lesser number first");
    }
    if step.is_some() && dash.is_none() {
        return Err("a step needs a range: write for example 1-100x2");
    }
    if step.is_some_and(|step| step.millionths() <= 0) {
        return Err("the step must be above 0: write for example 1-100x2");
    }
    Ok(Part { first, last, step })
}

/// Writes numbers as a selection: `1-9,12,20-30x2`; the order and repetitions of the list do not matter.
pub fn format_numbers(numbers: &[FrameNumber]) -> String {
    let mut numbers = numbers.to_vec();
    numbers.sort_unstable();
    numbers.dedup();
    let mut parts = Vec::new();
    let mut start = 0;
    while start < numbers.len() {
        let length = run_length(&numbers[start..]);
        let run = &numbers[start..start + length];
        parts.push(format_run(run));
        start += length;
    }
    parts.join(",")
}

/// How many numbers at the start form one part: three or more at equal distances, or one.
fn run_length(numbers: &[FrameNumber]) -> usize {
    let distance = |pair: &[FrameNumber]| pair[1].millionths() - pair[0].millionths();
    let Some(step) = numbers.get(..2).map(distance) else {
        return numbers.len();
    };
    let equal = numbers.windows(2).take_while(|pair| distance(pair) == step).count();
    if equal >= 2 { equal + 1 } else { 1 }
}

/// One number or a run of equal distances.
fn format_run(run: &[FrameNumber]) -> String {
    let (first, last) = (run[0], run[run.len() - 1]);
    let step =
        run.get(1).and_then(|next| FrameNumber::from_millionths(next.millionths() - first.millionths()));
    match step {
        None => first.to_string(),
        Some(FrameNumber::ONE) if first.integer().is_some() => format!("{first}-{last}"),
        Some(step) => format!("{first}-{last}x{step}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn single_numbers_are_missed_and_ranges_take_what_there_is() {
        let numbers = [1, 2, 4].map(|n| FrameNumber::from_integer(n).unwrap());
        let absent = FrameSelection::parse("7,1,3,2-9,7").unwrap().absent(&numbers);
        assert_eq!(absent, [3, 7].map(FrameNumber::from), "each of them once");
    }
    use proptest::prelude::*;

    fn selected(text: &str, candidates: std::ops::RangeInclusive<i64>) -> Vec<i64> {
        let selection = FrameSelection::parse(text).unwrap();
        candidates.filter(|&n| selection.contains(FrameNumber::from_integer(n).unwrap())).collect()
    }

    #[test]
    fn ranges_steps_lists_and_signs() {
        assert_eq!(selected("1-10x2", -20..=20), [1, 3, 5, 7, 9]);
        assert_eq!(selected("1-10:3", -20..=20), [1, 4, 7, 10]);
        assert_eq!(selected("7,9,20", 0..=30), [7, 9, 20]);
        assert_eq!(selected("1-5:2,610", 0..=700), [1, 3, 5, 610]);
        assert_eq!(selected("-5--1", -20..=20), [-5, -4, -3, -2, -1]);
        assert_eq!(selected("-2-2x2", -20..=20), [-2, 0, 2]);
        assert_eq!(selected("-7", -20..=20), [-7]);
        assert_eq!(selected(" 3 , 5 - 6 ", 0..=9), [3, 5, 6]);
    }

    /// Whatever is there: what one run finds missing has the place that another finds it at.
    #[test]
    fn positions_follow_from_the_text() {
        for (text, number, position, of) in [
            ("1-100", "1", Some(0), 100),
            ("1-100", "100", Some(99), 100),
            ("1-100x2", "7", Some(3), 50),
            ("1-100x2", "8", None, 50),
            ("9,3-5", "9", Some(0), 4),
            ("9,3-5", "4", Some(2), 4),
            ("-5--1", "-3", Some(2), 5),
            ("-3,7", "7", Some(1), 2),
            ("10-20", "12.5", Some(2), 11),
            ("0-1x0.25", "0.75", Some(3), 5),
            ("1-3,2-5", "3", Some(2), 7),
            ("1-3,2-5", "4", Some(5), 7),
            ("0-1000000000000", "1000000000000", Some(1_000_000_000_000), 1_000_000_000_001),
        ] {
            let selection = FrameSelection::parse(text).unwrap();
            let found = (selection.position(number.parse().unwrap()), selection.positions());
            assert_eq!(found, (position, of), "{number} of {text}");
        }
    }

    #[test]
    fn numbers_of_a_selection_come_in_order_and_once() {
        let numbers = |text: &str| FrameSelection::parse(text).unwrap().numbers().collect::<Vec<_>>();
        for (text, shown) in [
            ("1-16", "1-16"),
            ("9,3-5,4-6", "3-6,9"),
            ("-2-2x2,1-3", "-2,0-3"),
            ("1.5-3", "1.5,2.5"),
            ("7", "7"),
            ("1000000000000", "1000000000000"),
        ] {
            assert_eq!(format_numbers(&numbers(text)), shown, "{text}");
        }
        assert_eq!(numbers("1-3,2-4").len(), 4);
    }

    #[test]
    fn decimal_numbers() {
        let n = |text: &str| text.parse::<FrameNumber>().unwrap();
        assert!(FrameSelection::parse("12.5").unwrap().contains(n("12.5")));
        assert!(!FrameSelection::parse("12").unwrap().contains(n("12.5")));
        assert!(FrameSelection::parse("10-20").unwrap().contains(n("12.5")));
        let halves = FrameSelection::parse("0-2x0.5").unwrap();
        assert!(halves.contains(n("1.5")) && !halves.contains(n("1.25")));
    }

    #[test]
    fn what_cannot_be_understood_is_named() {
        for (text, part, reason) in [
            ("", "", "nothing between"),
            ("1,,2", "", "nothing between"),
            ("1-5,", "", "nothing between"),
            ("abc", "abc", "write numbers"),
            ("1-", "1-", "write numbers"),
            ("-", "-", "write numbers"),
            ("1-2-3", "1-2-3", "write numbers"),
            ("4,9-5", "9-5", "backwards"),
            ("7x2", "7x2", "needs a range"),
            ("1-9x0", "1-9x0", "above 0"),
            ("1-9x-2", "1-9x-2", "above 0"),
            ("1-9x", "1-9x", "write numbers"),
            ("1-9xx2", "1-9xx2", "write numbers"),
            ("99999999999999999999", "99999999999999999999", "write numbers"),
        ] {
            match FrameSelection::parse(text) {
                Err(SequenceError::Selection { part: p, reason: r, .. }) => {
                    assert_eq!(p, part);
                    assert!(r.contains(reason), "{text}: {r}");
                }
                other => panic!("{text}: {other:?}"),
            }
        }
    }

    #[test]
    fn selecting_nothing_says_what_there_is() {
        let frames: Vec<FrameFile> = (1..=9)
            .map(|n| FrameFile { number: FrameNumber::from(n), path: format!("{n}.ply").into() })
            .collect();
        assert_eq!(FrameSelection::parse("8-20").unwrap().select(&frames).unwrap(), frames[7..]);
        let error = FrameSelection::parse("600-700").unwrap().select(&frames).unwrap_err().to_string();
        assert_eq!(
            error,
            "none of the frames `600-700` is in the sequence, which has 1-9: choose from those"
        );
    }

    #[test]
    fn lists_are_written_as_ranges() {
        let format = |list: &[&str]| {
            format_numbers(&list.iter().map(|n| n.parse().unwrap()).collect::<Vec<FrameNumber>>())
        };
        assert_eq!(format(&[]), "");
        assert_eq!(format(&["3", "1", "2", "2", "12", "20", "22", "24"]), "1-3,12,20-24x2");
        assert_eq!(format(&["1", "2"]), "1,2");
        assert_eq!(format(&["-3", "-2", "-1"]), "-3--1");
        assert_eq!(format(&["0.5", "1.5", "2.5"]), "0.5-2.5x1");
    }

    proptest! {
        #[test]
        fn parsing_never_panics(text in "[-0-9x:., a-é]{0,24}") {
            let _ = FrameSelection::parse(&text);
        }

        #[test]
        fn a_written_list_selects_exactly_its_numbers(list in proptest::collection::btree_set(-40i64..40, 1..40)) {
            let numbers: Vec<FrameNumber> = list.iter().map(|&n| FrameNumber::from_integer(n).unwrap()).collect();
            let text = format_numbers(&numbers);
            prop_assert_eq!(selected(&text, -60..=60), list.into_iter().collect::<Vec<_>>(), "{}", text);
        }
    }
}
