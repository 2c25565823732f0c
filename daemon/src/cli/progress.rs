//! What a person at a terminal sees while a run goes on: a bar on stderr, the increments table on stdout.

use std::cell::Cell;
use std::io::IsTerminal;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use overclosure::simulation::IncrementReport;

use super::clock::Stage;
use super::print;

const TABLE_HEAD: &str = concat!(
    "  STEP   INC   ATT SEVERE  EQUIL  TOTAL  TOTAL        STEP         INC OF\n",
    "                   DISCON  ITERS  ITERS  TIME         TIME         TIME\n",
    "                    ITERS\n",
);

/// Resolution of the bar.
const TICKS: u64 = 1000;

/// The bar and the table.
pub struct Progress {
    bar: ProgressBar,
    quiet: bool,
    table: Cell<Table>,
}

/// What has become of the increments table.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Table {
    Awaited,
    Begun,
    /// Unwanted, or stdout cannot be written.
    Off,
}

impl Progress {
    /// A bar if stderr is a terminal; nothing at all when `quiet`.
    pub fn new(quiet: bool) -> Self {
        let visible = !quiet && std::io::stderr().is_terminal();
        let target = if visible { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(TICKS), target);
        // The template is a constant; a bar without it would still be a bar.
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg:24} [{bar:40}] {percent:>3} % {elapsed}") {
            bar.set_style(style.progress_chars("=> "));
        }
        if visible {
            bar.enable_steady_tick(std::time::Duration::from_millis(120));
        }
        Self { bar, quiet, table: Cell::new(if quiet { Table::Off } else { Table::Awaited }) }
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

    /// A row of the table. A stdout that nobody reads any more does not end the run: its results are in files.
    pub fn increment(&self, increment: &IncrementReport, fraction: f64) {
        self.bar.set_position((fraction.clamp(0.0, 1.0) * TICKS as f64) as u64);
        let head = match self.table.get() {
            Table::Off => return,
            Table::Awaited => TABLE_HEAD,
            Table::Begun => "",
        };
        let written = self.bar.suspend(|| print(&format!("{head}{}\n", row(increment))));
        self.table.set(if written.is_ok() { Table::Begun } else { Table::Off });
    }

    /// The bar goes.
    pub fn clear(&self) {
        self.bar.finish_and_clear();
    }
}

fn row(increment: &IncrementReport) -> String {
    let IncrementReport {
        step,
        increment,
        attempt,
        severe_discontinuity_iterations: severe,
        equilibrium_iterations: equilibrium,
        time,
        step_time,
        increment_size,
        status_changes: _,
    } = increment;
    let total = severe + equilibrium;
    format!(
        "{step:>6}{increment:>6}{attempt:>6}{severe:>7}{equilibrium:>7}{total:>7}  {time:<13.6}{step_time:<13.6}{increment_size:<.6}"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_stand_under_their_headings() {
        let report = IncrementReport {
            step: 1,
            increment: 12,
            attempt: 2,
            severe_discontinuity_iterations: 3,
            equilibrium_iterations: 4,
            time: 1.5,
            step_time: 0.5,
            increment_size: 0.25,
            status_changes: Vec::new(),
        };
        let row = row(&report);
        let numbers: Vec<&str> = row.split_whitespace().collect();
        assert_eq!(numbers, ["1", "12", "2", "3", "4", "7", "1.500000", "0.500000", "0.250000"]);
        let head = TABLE_HEAD.lines().next().unwrap();
        assert_eq!(head.find("STEP").unwrap() + 4, row.find('1').unwrap() + 1);
    }
}
