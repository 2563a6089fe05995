//! Words of a POSIX shell.

/// A word that a shell reads as this text.
pub fn quoted(text: &str) -> String {
    // `#` begins a comment only where a word begins.
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "_-./:=,+@%#".contains(c);
    if !text.is_empty() && !text.starts_with('#') && text.chars().all(is_plain) {
        return text.into();
    }
    format!("'{}'", text.replace('\'', r"'\''"))
}

/// A command line of these words.
pub fn line<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    words.into_iter().map(quoted).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_needs_it_is_quoted() {
        assert_eq!(line(["floe", "--output=a_##.exr", "a b", "#"]), "floe --output=a_##.exr 'a b' '#'");
        assert_eq!(quoted("it's $HOME"), r"'it'\''s $HOME'");
        assert_eq!(quoted(""), "''");
    }

    #[cfg(unix)]
    #[test]
    fn a_shell_reads_the_same_text() {
        let texts = ["a'b\"c", "$(x) `y` \\ \\n", "* ? [a] {b,c} ~ # ! & | ; < >", "é – 氷", "", "-n", "''"];
        let script = format!("for word in {}; do printf '%s\\0' \"$word\"; done", line(texts));
        let output = std::process::Command::new("sh").args(["-c", &script]).output().unwrap();
        let read = String::from_utf8(output.stdout).unwrap();
        assert_eq!(read.split_terminator('\0').collect::<Vec<_>>(), texts);
    }
}
