//! `JOB_ports.csv`: every output port, one row per increment: what a master of the same deck would read.

use std::fmt::Write;
use std::path::Path;

use super::file::{OutputError, TextFile};
use super::number::{push_name, push_numbers};
use crate::simulation::{IncrementReport, PreparedModel, Simulation};

pub(super) struct PortTable {
    file: TextFile,
    /// Reused from row to row.
    values: Vec<f64>,
}

impl PortTable {
    pub(super) fn create(directory: &Path, job: &str, prepared: &PreparedModel) -> Result<Self, OutputError> {
        let mut file = TextFile::create(directory, job, "_ports.csv")?;
        let outputs = &prepared.ports().outputs;
        let mut header = String::from("step,increment,time");
        for port in outputs {
            push_name(&mut header, &port.name);
        }
        header.push('\n');
        file.append(&header)?;
        Ok(Self { file, values: vec![0.0; outputs.len()] })
    }

    pub(super) fn row(&mut self, increment: &IncrementReport, simulation: &Simulation) -> Result<(), OutputError> {
        simulation.observe(&mut self.values);
        let mut text = String::new();
        // Writing to a string does not fail.
        let _ = write!(text, "{},{}", increment.step, increment.increment);
        push_numbers(&mut text, &[increment.time]);
        push_numbers(&mut text, &self.values);
        text.push('\n');
        self.file.append(&text)
    }
}
