//! Matching of file names with `*` (any characters) and `?` (one character).

/// Whether a file name pattern is a glob.
pub(super) fn is_glob(pattern: &str) -> bool {
    pattern.contains(['*', '?'])
}

/// Whether `name` as a whole matches `pattern`.
///
/// Goes back only to the last `*`, so that the time is at most the product of the two lengths.
pub(super) fn matches(pattern: &str, name: &str) -> bool {
    let pattern: Vec<char> = pattern.chars().collect();
    let name: Vec<char> = name.chars().collect();
    let (mut p, mut n) = (0, 0);
    let mut star: Option<(usize, usize)> = None;
    while n < name.len() {
        match pattern.get(p) {
            Some('*') => {
                star = Some((p, n));
                p += 1;
            }
            Some(&c) if c == '?' || c == name[n] => {
                p += 1;
                n += 1;
            }
            _ => match star {
                // The last star takes one character more.
                Some((star_p, star_n)) => {
                    star = Some((star_p, star_n + 1));
                    p = star_p + 1;
                    n = star_n + 1;
                }
                None => return false,
            },
        }
    }
    pattern[p..].iter().all(|&c| c == '*')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stars_and_question_marks() {
        for (pattern, name) in [
            ("*", ""),
            ("*", "frame_1.ply"),
            ("frame_*.ply", "frame_0001.ply"),
            ("frame_*.ply", "frame_.ply"),
            ("*_*.ply", "a_b_c.ply"),
            ("frame_?.ply", "frame_é.ply"),
            ("a*b*c", "aXbYbZc"),
            ("exact.ply", "exact.ply"),
        ] {
            assert!(matches(pattern, name), "{pattern} {name}");
        }
        for (pattern, name) in [
            ("frame_?.ply", "frame_10.ply"),
            ("frame_*.ply", "frame_1.obj"),
            ("?", ""),
            ("a*b", "abc"),
            ("exact.ply", "exact.ply.gz"),
            ("", "a"),
        ] {
            assert!(!matches(pattern, name), "{pattern} {name}");
        }
    }

    #[test]
    fn many_stars_take_no_exponential_time() {
        let pattern = "*a".repeat(200) + "b";
        assert!(!matches(&pattern, &"a".repeat(2000)));
    }
}
