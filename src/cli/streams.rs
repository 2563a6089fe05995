//! Standard output and standard error, either of which may be a pipe that nobody reads any more.

use std::io::{ErrorKind, Write};

use super::exit::Exit;

/// Prints results to standard output; a reader that has gone away (`| head`) has what it wanted.
pub fn print(text: &str) -> Exit {
    let mut output = std::io::stdout().lock();
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
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}
