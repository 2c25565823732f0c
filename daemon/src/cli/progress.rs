//! What a person at a terminal sees while a run goes on: a bar on stderr, the increments table on stdout.

use std::cell::{Cell, RefCell};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::clock::Stage;
use super::increments::{Row, Table};
use super::pace::Pace;
use super::print;

/// Resolution of the bar.
const TICKS: u64 = 1000;
/// The bar moves at most this often.
const BAR_INTERVAL: Duration = Duration::from_millis(100);

/// The bar and the table.
pub struct Progress {
    bar: ProgressBar,
    quiet: bool,
    table: RefCell<Table>,
    /// Whether rows are wanted, and stdout can be written.
    tells: Cell<bool>,
    pace: RefCell<Pace>,
    moved: Cell<Option<Instant>>,
}

impl Progress {
    /// A bar if stderr is a terminal; nothing at all when `quiet`.
    pub fn new(quiet: bool) -> Self {
        let visible = !quiet && std::io::stderr().is_terminal();
        let target = if visible { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(TICKS), target);
        // The template is a constant; a bar without it would still be a bar.
        if let Ok(style) =
            ProgressStyle::with_template("{spinner} {msg:24} [{bar:40}] {percent:>3} % {elapsed}{prefix}")
        {
            bar.set_style(style.progress_chars("=> "));
        }
        if visible {
            bar.enable_steady_tick(Duration::from_millis(120));
        }
        Self {
            bar,
            quiet,
            table: RefCell::default(),
            tells: Cell::new(!quiet),
            pace: RefCell::default(),
            moved: Cell::new(None),
        }
    }

    /// Whether only findings are wanted.
    pub fn quiet(&self) -> bool {
        self.quiet
    }

    /// Another stage begins.
    pub fn stage(&self, stage: Stage) {
        self.bar.set_message(stage.description());
    }

    /// Writes to the terminal without the bar in between.
    pub fn hidden_while<T>(&self, write: impl FnOnce() -> T) -> T {
        self.bar.suspend(write)
    }

    /// An increment is done; `fraction` of the time of the run has passed. Of many increments not every one gets a row.
    pub fn increment(&self, row: Row, fraction: f64) {
        let now = Instant::now();
        let left = self.pace.borrow_mut().left(now, fraction);
        if self.moved.get().is_none_or(|then| now - then >= BAR_INTERVAL) {
            self.moved.set(Some(now));
            self.bar.set_position((fraction.clamp(0.0, 1.0) * TICKS as f64) as u64);
            self.bar.set_prefix(left.map_or_else(String::new, |left| format!(", {} left", clock(left))));
        }
        if !self.tells.get() {
            return;
        }
        let due = self.pace.borrow_mut().is_due(now, row.step(), row.rows_at_once());
        let text = self.table.borrow_mut().take(row, due, left.map(clock));
        self.write(&text);
    }

    /// The last row, if it is still to be written; then the bar goes.
    pub fn clear(&self) {
        let text = self.table.borrow_mut().end();
        self.write(&text);
        self.bar.finish_and_clear();
    }

    /// A stdout that nobody reads any more does not end the run: its results are in files.
    fn write(&self, text: &str) {
        if !text.is_empty() && self.bar.suspend(|| print(text)).is_err() {
            self.tells.set(false);
        }
    }
}

/// `h:mm:ss`.
fn clock(time: Duration) -> String {
    let seconds = time.as_secs();
    format!("{}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_told_in_hours() {
        assert_eq!(clock(Duration::from_millis(999)), "0:00:00");
        assert_eq!(clock(Duration::from_secs(3600 + 2 * 60 + 3)), "1:02:03");
    }
}
