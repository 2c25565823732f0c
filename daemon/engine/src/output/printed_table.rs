//! One table of `JOB.dat`: a row per node or element, with the extremes of the columns below.

use std::fmt::Write;

use super::number::printed;

/// What the rows of a table are about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Entity {
    Node,
    Element,
}

impl Entity {
    fn name(self) -> &'static str {
        match self {
            Self::Node => "NODE",
            Self::Element => "ELEMENT",
        }
    }
}

/// A table of nodes or elements with the extremes of its columns.
pub(super) struct Table {
    text: String,
    entity: Entity,
    /// Whether a column of text stands before the numbers.
    status: bool,
    /// Per column: (least, its node), (greatest, its node).
    extremes: Vec<[(f64, u32); 2]>,
    /// Per column: the sum of its rows.
    sums: Vec<f64>,
    rows: usize,
}

impl Table {
    /// A table without rows; `status` is the heading of a column of text before the numbers.
    pub(super) fn new(heading: &str, entity: Entity, status: Option<&str>, columns: &[&str]) -> Self {
        // Writing to a string does not fail, here and below.
        let mut text = format!("\n   {heading}\n\n {:>11}", entity.name());
        if let Some(status) = status {
            let _ = write!(text, " {status:>6}");
        }
        for column in columns {
            let _ = write!(text, "{column:>15}");
        }
        text.push_str("\n\n");
        Self { text, entity, status: status.is_some(), extremes: Vec::new(), sums: vec![0.0; columns.len()], rows: 0 }
    }

    /// Adds the row of a node or element.
    pub(super) fn row(&mut self, label: u32, status: Option<&str>, values: &[f64]) {
        let _ = write!(self.text, " {label:>11}");
        if let Some(status) = status {
            let _ = write!(self.text, " {status:>6}");
        }
        if self.extremes.is_empty() {
            self.extremes = values.iter().map(|&v| [(v, label); 2]).collect();
        }
        for ((&value, [least, greatest]), sum) in values.iter().zip(&mut self.extremes).zip(&mut self.sums) {
            self.text.push_str(&printed(value));
            *sum += value;
            if value < least.0 {
                *least = (value, label);
            }
            if value > greatest.0 {
                *greatest = (value, label);
            }
        }
        self.text.push('\n');
        self.rows += 1;
    }

    /// Appends the table: with its extremes if a summary is wanted, with the sums of its columns if totals are.
    pub(super) fn finish(mut self, text: &mut String, summary: bool, totals: bool) {
        if self.rows == 0 {
            self.text.push_str("   THERE ARE NO ENTRIES IN THIS TABLE\n");
            text.push_str(&self.text);
            return;
        }
        let gap = if self.status { "       " } else { "" };
        for (which, name) in [(1, "MAXIMUM"), (0, "MINIMUM")].into_iter().filter(|_| summary) {
            let _ = write!(self.text, "\n {name:>11}{gap}");
            for column in &self.extremes {
                self.text.push_str(&printed(column[which].0));
            }
            let _ = write!(self.text, "\n {:>11}{gap}", format!("AT {}", self.entity.name()));
            for column in &self.extremes {
                let _ = write!(self.text, "{:>15}", column[which].1);
            }
        }
        if totals {
            let _ = write!(self.text, "\n {:>11}{gap}", "TOTAL");
            for &sum in &self.sums {
                self.text.push_str(&printed(sum));
            }
        }
        if summary || totals {
            self.text.push('\n');
        }
        text.push_str(&self.text);
    }
}
