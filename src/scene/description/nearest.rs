//! "Did you mean ...": the known word nearest to a mistyped one.

/// Least Jaro-Winkler similarity of a suggestion. Slips of one or two letters lie above 0.85, unrelated keys
/// of the scene file below 0.75.
const SIMILAR: f64 = 0.8;

/// The most similar of some known words, if any is similar; the first of equals.
pub(super) fn nearest<'k>(word: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    let mut best = None;
    let mut best_similarity = SIMILAR;
    for candidate in known {
        let similarity = strsim::jaro_winkler(&word.to_lowercase(), &candidate.to_lowercase());
        if similarity > best_similarity {
            (best, best_similarity) = (Some(candidate), similarity);
        }
    }
    best
}

/// Ends a message: a suggestion, or all the words there are.
pub fn suggestion(word: &str, known: &[&str], all: &str) -> String {
    match nearest(word, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("{all} {}", list(known)),
    }
}

/// `a`, `b` and `c` in back quotes.
pub(super) fn list(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
    match quoted.as_slice() {
        [] => "none".to_owned(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_recognised_and_strangers_are_not() {
        let media = ["ior", "absorption", "scattering", "phase"];
        for (word, expected) in [
            ("scatering", Some("scattering")),
            ("Absorption", Some("absorption")),
            ("absorbtion", Some("absorption")),
            ("phse", Some("phase")),
            ("IOR", Some("ior")),
            ("emission", None),
            ("density", None),
            ("model", None),
            ("", None),
        ] {
            assert_eq!(nearest(word, media), expected, "{word}");
        }
        assert_eq!(list(&["a", "b", "c"]), "`a`, `b` and `c`");
    }
}
