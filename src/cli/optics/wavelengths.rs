//! Wavelengths as they are written on the command line.

use crate::spectrum::cie::{LAMBDA_MAX, LAMBDA_MIN};

/// More of them are a slip of the step.
const MOST: usize = 4001;

/// Wavelengths in nm, rising.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct WavelengthList(pub Vec<f64>);

impl Default for WavelengthList {
    fn default() -> Self {
        Self((0..=20).map(|i| LAMBDA_MIN + 20.0 * f64::from(i)).collect())
    }
}

/// `400,550,700` or `400..700:25`, with its end where a step meets it.
pub(super) fn wavelengths(text: &str) -> Result<WavelengthList, String> {
    let list = match text.split_once("..") {
        Some((start, rest)) => {
            let (end, step) = rest.split_once(':').unwrap_or((rest, "20"));
            range(number(start)?, number(end)?, number(step)?)?
        }
        None => text.split(',').map(number).collect::<Result<Vec<_>, _>>()?,
    };
    if let Some(outside) = list.iter().find(|lambda| !(LAMBDA_MIN..=LAMBDA_MAX).contains(*lambda)) {
        return Err(format!(
            "{outside} nm is not between {LAMBDA_MIN} and {LAMBDA_MAX} nm, where light is seen: leave it out"
        ));
    }
    if let Some(pair) = list.windows(2).find(|pair| pair[0] >= pair[1]) {
        return Err(format!(
            "{} nm stands before {} nm: write them in rising order, each once",
            pair[0], pair[1]
        ));
    }
    Ok(WavelengthList(list))
}

fn range(start: f64, end: f64, step: f64) -> Result<Vec<f64>, String> {
    if step <= 0.0 {
        return Err(format!("the step is {step}: write one above 0, such as {start}..{end}:25"));
    }
    if end < start {
        return Err(format!("{start} is above {end}: write {end}..{start}:{step}"));
    }
    // A step that meets the end but for rounding meets it.
    let steps = ((end - start) / step + 1e-9).floor();
    if steps >= MOST as f64 {
        return Err(format!(
            "that is more than {MOST} wavelengths: write a greater step, such as {start}..{end}:5"
        ));
    }
    Ok((0..=steps as u32).map(|i| start + step * f64::from(i)).collect())
}

fn number(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
    number.ok_or_else(|| {
        format!("\"{text}\" is no number: write nanometres such as 400,550,700 or 400..700:25")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_and_ranges_are_understood() {
        for (text, list) in [
            ("550", vec![550.0]),
            ("400, 550.5,700", vec![400.0, 550.5, 700.0]),
            ("400..500:25", vec![400.0, 425.0, 450.0, 475.0, 500.0]),
            ("400..430:12.5", vec![400.0, 412.5, 425.0]),
            ("700..720", vec![700.0, 720.0]),
            ("500..500:1", vec![500.0]),
        ] {
            assert_eq!(wavelengths(text), Ok(WavelengthList(list)), "{text}");
        }
        assert_eq!(wavelengths("380..780:20"), Ok(WavelengthList::default()));
        // 0.1 is no binary fraction.
        assert_eq!(wavelengths("400..401:0.1").unwrap().0.len(), 11);
    }

    #[test]
    fn what_is_none_is_told_with_the_cure() {
        for (text, cure) in [
            ("", "such as 400,550,700"),
            ("blue", "\"blue\" is no number"),
            ("nan", "is no number"),
            ("700,400", "700 nm stands before 400 nm"),
            ("400,400", "each once"),
            ("300,400", "300 nm is not between 380 and 780"),
            ("400..900:100", "800 nm is not between"),
            ("700..400:25", "write 400..700:25"),
            ("400..700:0", "write one above 0"),
            ("400..700:-5", "write one above 0"),
            ("400..700:1e-9", "a greater step"),
        ] {
            let message = wavelengths(text).unwrap_err();
            assert!(message.contains(cure), "{text}: {message}");
        }
    }
}
