//! The increments table: of implicit steps with their iterations, of explicit ones with sizes and energies.

use overclosure::model::Procedure;
use overclosure::simulation::{IncrementReport, Simulation};

const IMPLICIT_HEAD: &str = concat!(
    "  STEP   INC   ATT SEVERE  EQUIL  TOTAL  TOTAL        STEP         INC OF\n",
    "                   DISCON  ITERS  ITERS  TIME         TIME         TIME\n",
    "                    ITERS\n",
);
const EXPLICIT_HEAD: &str = concat!(
    "  STEP       INC  TOTAL         STEP          INC OF        KINETIC       TOTAL         WALL TIME\n",
    "                  TIME          TIME          TIME          ENERGY        ENERGY        LEFT\n",
);

/// What a row says of an increment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    step: u32,
    increment: u32,
    time: f64,
    step_time: f64,
    increment_size: f64,
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Implicit { attempt: u32, severe: u32, equilibrium: u32 },
    Explicit { kinetic: f64, total: f64 },
}

impl Row {
    /// Of the increment that a simulation has just completed.
    pub fn new(simulation: &Simulation, report: &IncrementReport) -> Self {
        let IncrementReport {
            step,
            increment,
            attempt,
            severe_discontinuity_iterations: severe,
            equilibrium_iterations: equilibrium,
            time,
            step_time,
            increment_size,
            stable_increment: _,
            status_changes: _,
        } = *report;
        let kind = match &simulation.prepared().model().steps[step as usize - 1].procedure {
            Procedure::Static(_) | Procedure::Dynamic(_) => Kind::Implicit { attempt, severe, equilibrium },
            Procedure::Explicit(_) => {
                let energies = simulation.energies();
                Kind::Explicit { kinetic: energies.kinetic, total: energies.total }
            }
        };
        Self { step, increment, time, step_time, increment_size, kind }
    }

    /// Number of the step.
    pub fn step(&self) -> u32 {
        self.step
    }

    /// Rows of a step that are written however fast they come.
    pub fn rows_at_once(&self) -> u32 {
        match self.kind {
            Kind::Implicit { .. } => 1000,
            Kind::Explicit { .. } => 20,
        }
    }

    fn head(&self) -> &'static str {
        match self.kind {
            Kind::Implicit { .. } => IMPLICIT_HEAD,
            Kind::Explicit { .. } => EXPLICIT_HEAD,
        }
    }

    fn text(&self, left: Option<&str>) -> String {
        let Self { step, increment, .. } = self;
        let [time, step_time, size] = [self.time, self.step_time, self.increment_size].map(number);
        match self.kind {
            Kind::Implicit { attempt, severe, equilibrium } => {
                let total = severe + equilibrium;
                let counts = format!("{step:>6}{increment:>6}{attempt:>6}{severe:>7}{equilibrium:>7}{total:>7}");
                format!("{counts}  {time:<13}{step_time:<13}{size}\n")
            }
            Kind::Explicit { kinetic, total } => {
                let [kinetic, total] = [kinetic, total].map(number);
                let numbers = format!("{time:<14}{step_time:<14}{size:<14}{kinetic:<14}{total:<14}");
                format!("{step:>6}{increment:>10}  {numbers}{}\n", left.unwrap_or("-"))
            }
        }
    }
}

/// Six decimals where they tell something, else as a power of ten.
fn number(value: f64) -> String {
    match value.abs() {
        size if size == 0.0 || (1e-3..1e5).contains(&size) => format!("{value:.6}"),
        _ => format!("{value:.5e}"),
    }
}

/// The table so far.
#[derive(Debug, Default)]
pub struct Table {
    /// Heading that was written last.
    head: &'static str,
    /// The last increment, if it got no row.
    unwritten: Option<Row>,
}

impl Table {
    /// What is to be written at an increment: its row if it is due, before it the last row of the step before.
    pub fn take(&mut self, row: Row, due: bool, left: Option<String>) -> String {
        let mut text = String::new();
        if let Some(before) = self.unwritten.take().filter(|before| before.step != row.step) {
            self.push(&mut text, before, None);
        }
        match due {
            true => self.push(&mut text, row, left.as_deref()),
            false => self.unwritten = Some(row),
        }
        text
    }

    /// What is to be written at the end: the last row, unless it is there.
    pub fn end(&mut self) -> String {
        let mut text = String::new();
        if let Some(row) = self.unwritten.take() {
            self.push(&mut text, row, None);
        }
        text
    }

    fn push(&mut self, text: &mut String, row: Row, left: Option<&str>) {
        if self.head != row.head() {
            self.head = row.head();
            text.push_str(self.head);
        }
        text.push_str(&row.text(left));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn implicit(step: u32, increment: u32) -> Row {
        let kind = Kind::Implicit { attempt: 2, severe: 3, equilibrium: 4 };
        Row { step, increment, time: 1.5, step_time: 0.5, increment_size: 0.25, kind }
    }

    fn explicit(increment: u32) -> Row {
        let kind = Kind::Explicit { kinetic: 0.5, total: -1.25e-9 };
        Row { step: 1, increment, time: 2.5e-5, step_time: 2.5e-5, increment_size: 1e-7, kind }
    }

    #[test]
    fn rows_stand_under_their_headings() {
        let row = implicit(1, 12).text(None);
        let numbers: Vec<&str> = row.split_whitespace().collect();
        assert_eq!(numbers, ["1", "12", "2", "3", "4", "7", "1.500000", "0.500000", "0.250000"]);
        let head = IMPLICIT_HEAD.lines().next().unwrap();
        assert_eq!(head.find("STEP").unwrap() + 4, row.find('1').unwrap() + 1);
        let row = explicit(250).text(Some("0:00:07"));
        let numbers: Vec<&str> = row.split_whitespace().collect();
        assert_eq!(
            numbers,
            ["1", "250", "2.50000e-5", "2.50000e-5", "1.00000e-7", "0.500000", "-1.25000e-9", "0:00:07"]
        );
        let [first, second] = EXPLICIT_HEAD.lines().collect::<Vec<_>>()[..] else { panic!("{EXPLICIT_HEAD}") };
        for (name, number) in [("KINETIC", "0.500000"), ("WALL", "0:00:07")] {
            assert_eq!(first.find(name), row.find(number), "{row}");
        }
        assert_eq!(second.find("LEFT"), row.find("0:00:07"));
        assert_eq!(first.find("INC").unwrap() + 3, row.find("250").unwrap() + 3);
    }

    #[test]
    fn the_last_increment_of_step_and_run_has_its_row() {
        let mut table = Table::default();
        let lines = |text: String| text.lines().map(|l| l.trim().to_owned()).collect::<Vec<_>>();
        assert_eq!(lines(table.take(explicit(1), true, None)).len(), 3, "the heading and the row");
        assert!(table.take(explicit(2), false, None).is_empty() && table.take(explicit(3), false, None).is_empty());
        let next = lines(table.take(implicit(2, 1), true, None));
        assert!(next[0].starts_with("1         3"), "{next:?}");
        assert_eq!(next.len(), 1 + 3 + 1, "{next:?}");
        assert!(table.end().is_empty());
        table.take(implicit(2, 2), false, None);
        assert_eq!(lines(table.end()).len(), 1);
    }
}
