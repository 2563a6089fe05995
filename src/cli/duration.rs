//! Times on the command line.

use std::time::Duration;

/// Reads `30s`, `5m`, `1.5h` or a number of seconds.
pub fn duration(text: &str) -> Result<Duration, String> {
    let wrong = || format!("`{text}` is no time: write for example 30s, 5m, 1h, or a number of seconds");
    let (number, unit) = match text.char_indices().next_back() {
        Some((end, 's')) => (&text[..end], 1.0),
        Some((end, 'm')) => (&text[..end], 60.0),
        Some((end, 'h')) => (&text[..end], 3600.0),
        _ => (text, 1.0),
    };
    let is_plain = number.bytes().all(|b| b.is_ascii_digit() || b == b'.');
    let number: f64 = number.parse().ok().filter(|_| is_plain).ok_or_else(wrong)?;
    Duration::try_from_secs_f64(number * unit).map_err(|_| wrong())
}

/// Reads a time above 0.
pub fn time(text: &str) -> Result<Duration, String> {
    let time = duration(text)?;
    if time.is_zero() {
        Err("it has to be above 0: write for example 30s, 5m or 1h".into())
    } else {
        Ok(time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_units() {
        for (text, milliseconds) in
            [("30s", 30_000), ("5m", 300_000), ("1h", 3_600_000), ("7", 7000), ("0", 0), ("0.25s", 250)]
        {
            assert_eq!(duration(text), Ok(Duration::from_millis(milliseconds)), "{text}");
        }
    }

    #[test]
    fn other_texts_are_refused() {
        for text in
            ["", "s", "-1", "1d", "1 m", "inf", "nan", "1e9", "5ms", "+1", "é", "9".repeat(400).as_str()]
        {
            assert!(duration(text).unwrap_err().contains("30s"), "{text}");
        }
    }
}
