//! Standard output and standard error, either of which may be a pipe that nobody reads any more.
//!
//! A line goes out in one write, so that those of several threads, or of several workers with one log, do not mix.

use std::io::{ErrorKind, Write};
use std::sync::OnceLock;

use serde_json::{Value, json};

use super::exit::Exit;

/// How lines are told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// As they are, on standard error.
    #[default]
    Plain,
    /// As JSON objects, on standard error.
    Json,
    /// As they are, and errors to Open Job Description besides.
    OpenJd,
}

/// That of the process, which has one command.
static FORM: OnceLock<Form> = OnceLock::new();

/// Tells all lines in this form from now on; the first one stays.
pub fn speak(form: Form) {
    let _ = FORM.set(form);
}

fn form() -> Form {
    FORM.get().copied().unwrap_or_default()
}

/// Prints results to standard output; a reader that has gone away (`| head`) has what it wanted.
pub fn print(text: &str) -> Exit {
    let mut output = std::io::stdout().lock();
    let text = if form() == Form::OpenJd { harmless(text) } else { text.into() };
    match output.write_all(text.as_bytes()).and_then(|()| output.flush()) {
        Ok(()) => Exit::Complete,
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Exit::Complete,
        Err(error) => {
            say(&format!("error: standard output: {error}; check the disk that it goes to"));
            Exit::CannotWrite
        }
    }
}

/// Writes a line to standard error. There is nowhere to tell that it failed, and no reason to stop rendering.
pub fn say(line: &str) {
    match form() {
        Form::Plain => write_line(line),
        Form::Json => event(&as_event(line)),
        Form::OpenJd => {
            write_line(&harmless(line));
            if let Some(error) = line.strip_prefix("error: ") {
                direct("fail", error);
            }
        }
    }
}

/// Writes an object to standard error, in a line.
pub fn event(object: &Value) {
    write_line(&object.to_string());
}

/// Tells Open Job Description something: it reads the lines of standard output that begin so.
pub fn direct(what: &str, text: &str) {
    let line = directive(what, text);
    let mut output = std::io::stdout().lock();
    let _ = output.write_all(line.as_bytes()).and_then(|()| output.flush());
}

fn write_line(line: &str) {
    let _ = std::io::stderr().lock().write_all(format!("{line}\n").as_bytes());
}

/// The event that a line stands for.
fn as_event(line: &str) -> Value {
    match line.split_once(": ") {
        Some(("error", text)) => json!({ "event": "failed", "error": text }),
        Some(("warning", text)) => json!({ "event": "warning", "text": text }),
        _ => json!({ "event": "message", "text": line }),
    }
}

/// One line, whatever the text: the rest would be taken for something else.
fn directive(what: &str, text: &str) -> String {
    let text: Vec<&str> = text.split_whitespace().collect();
    format!("openjd_{what}: {}\n", text.join(" "))
}

/// A text of which no line is taken for a directive: sessions read both streams, and lines of a scene file are quoted.
/// They read them as Python does, to which a lone carriage return ends a line too.
fn harmless(text: &str) -> String {
    let indented = ['\n', '\r']
        .iter()
        .fold(text.to_owned(), |text, end| text.replace(&format!("{end}openjd_"), &format!("{end} openjd_")));
    if indented.starts_with("openjd_") { format!(" {indented}") } else { indented }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_events() {
        for (line, object) in [
            ("error: frame 7: no\nmore", json!({ "event": "failed", "error": "frame 7: no\nmore" })),
            ("warning: dark", json!({ "event": "warning", "text": "dark" })),
            ("waiting for frames: 2", json!({ "event": "message", "text": "waiting for frames: 2" })),
        ] {
            assert_eq!(as_event(line), object);
            assert!(!as_event(line).to_string().contains('\n'));
        }
    }

    /// `openjd-sessions` matches `^openjd_(?:progress|status|fail|env|..): (.+)$` against each line of both streams.
    #[test]
    fn texts_are_no_directives_and_directives_are_one_line() {
        assert_eq!(directive("fail", "a\n  openjd_env: A=B\r\n"), "openjd_fail: a openjd_env: A=B\n");
        let text =
            harmless("openjd_env: A=B\n3 | x\nopenjd_fail: no\n4 |\ropenjd_env: A=B\r\nopenjd_fail: no\n");
        assert!(text.split(['\n', '\r']).all(|line| !line.starts_with("openjd_")), "{text:?}");
        assert_eq!(harmless("2 of 3\nfailed: 1\n"), "2 of 3\nfailed: 1\n");
    }
}
