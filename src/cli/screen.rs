//! Standard error: on a terminal with a part that changes at its end, elsewhere as lines alone.

use std::io::IsTerminal;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::streams::say;

/// Standard error.
pub(super) struct Screen {
    /// What changes; hidden where there is no terminal, or where less was asked for.
    pub bar: ProgressBar,
    /// Whether it is shown.
    pub terminal: bool,
    /// Only warnings, errors and the summary were asked for.
    pub quiet: bool,
}

impl Screen {
    /// Whether a terminal is to be made use of; `length` of the bar, if it is known, and what it looks like.
    pub fn new(quiet: bool, bar: bool, length: Option<u64>, template: &str) -> Self {
        let terminal = bar && !quiet && std::io::stderr().is_terminal();
        let target = if terminal { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(length, target);
        bar.set_style(
            ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()),
        );
        Self { bar, terminal, quiet }
    }

    /// Takes away what changes.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }

    /// Writes a line that stays.
    pub fn line(&self, text: &str) {
        if self.terminal {
            self.bar.suspend(|| say(text));
        } else {
            say(text);
        }
    }
}
