//! Result files of a run, written while it runs: tables as CSV, fields for ParaView, the printed tables, the report.
//!
//! Every file is flushed at the end of each increment, so that a run that is killed keeps what it had. The first failure to write
//! ends the writing; [`ResultWriter::finish`] reports it with the name of the file.

mod components;
mod contact_table;
mod due;
mod fil_record;
mod file;
mod frames;
mod history_table;
mod node_table;
mod number;
mod plan;
mod port_table;
mod printed;
mod printed_contact;
mod printed_elements;
mod printed_step;
mod printed_table;
mod report;
mod results_file;
mod results_header;
mod snapshots;
mod status_log;
mod totals;
mod vtu;

#[cfg(test)]
mod tests;

pub use file::OutputError;
pub use report::{
    CutbackSummary, Finding, ModelSize, RestartOrigin, RunOutcome, RunReport, StableIncrement, StepSummary,
    write_report,
};
pub use snapshots::SnapshotSummary;
pub use status_log::{StatusChangeSummary, status_changes};

pub use crate::restart::Standing;

use std::path::Path;
use std::sync::Arc;

use crate::model::{ElementId, Model, RestartRequest, Step};
use crate::simulation::{
    ContactPointResult, HistoryRow, IncrementReport, NodalSolution, PreparedModel, Simulation, Watch,
};

use contact_table::ContactTable;
use due::Moment;
use frames::Frames;
use history_table::HistoryTable;
use node_table::NodeTable;
use plan::Plan;
use port_table::PortTable;
use printed::Printed;
use results_file::ResultsFile;
use snapshots::Snapshots;
use totals::Resultants;

/// Writes the results of a job into a directory, increment by increment.
///
/// `JOB_history.csv` and `JOB_ports.csv` have one row per increment, in explicit steps as `*OUTPUT, HISTORY` says. The other files follow the output requests of the
/// deck: contact rows and frames of a step that asks for none are written at its last increment. Nodal values are recovered (one solve) at most once per
/// increment, and only when a row or a frame needs them.
pub struct ResultWriter {
    prepared: Arc<PreparedModel>,
    history: HistoryTable,
    ports: PortTable,
    contact: ContactTable,
    nodes: NodeTable,
    printed: Printed,
    results: ResultsFile,
    frames: Frames,
    snapshots: Snapshots,
    /// The last increment, if the requests of the deck did not make it a written one in every respect.
    unfinished: Option<IncrementReport>,
    error: Option<OutputError>,
}

/// What the deck does not say about the files of a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct WriteOptions {
    /// Snapshots as here and not by `*RESTART, WRITE`.
    pub snapshots: Option<RestartRequest>,
    /// The run goes on from a snapshot: those that are there already stay.
    pub restarted: bool,
}

/// Whether `directory` holds tables of `job` that [`ResultWriter::create`] would replace.
pub fn holds_results(directory: &Path, job: &str) -> bool {
    directory.join(format!("{job}_history.csv")).exists()
}

impl ResultWriter {
    /// Creates the files of `job` in `directory`, which must exist; results of an earlier run of the same name are replaced.
    pub fn create(
        directory: &Path,
        job: &str,
        prepared: Arc<PreparedModel>,
        options: WriteOptions,
    ) -> Result<Self, OutputError> {
        report::remove(directory, job)?;
        Ok(Self {
            history: HistoryTable::create(directory, job, &prepared)?,
            ports: PortTable::create(directory, job, &prepared)?,
            contact: ContactTable::create(directory, job)?,
            nodes: NodeTable::create(directory, job)?,
            printed: Printed::create(directory, job, &prepared)?,
            results: ResultsFile::create(directory, job, prepared.model())?,
            frames: Frames::create(directory, job, prepared.model())?,
            snapshots: Snapshots::create(directory, job, options.snapshots, options.restarted)?,
            prepared,
            unfinished: None,
            error: None,
        })
    }

    /// Whether writing has failed; nothing is written after that.
    pub fn failed(&self) -> bool {
        self.error.is_some()
    }

    /// Ends the writing. A run that stopped early gets the rows, the frame and the snapshot that the last increment of a step
    /// gets. Returns the snapshots that are there.
    pub fn finish(mut self, simulation: &Simulation) -> Result<Vec<SnapshotSummary>, OutputError> {
        if let Some(error) = self.error {
            return Err(error);
        }
        if let Some(increment) = self.unfinished.take() {
            self.write(simulation, &increment, Moment::Stopped)?;
        }
        Ok(self.snapshots.written())
    }

    fn write(
        &mut self,
        simulation: &Simulation,
        increment: &IncrementReport,
        moment: Moment,
    ) -> Result<(), OutputError> {
        let prepared = Arc::clone(&self.prepared);
        let model = prepared.model();
        let Some(step) = step_of(model, increment) else {
            return Ok(());
        };
        let plan = Plan::new(step, increment, moment);
        if plan.is_empty() {
            return self.snapshots.write(step, increment, moment, simulation);
        }
        let history = simulation.history();
        let contact = simulation.contact_results();
        let resultants = Resultants::of_pairs(&prepared, &history.pairs, contact);
        if plan.history {
            self.history.row(increment, &history, &resultants)?;
            self.ports.row(increment, simulation)?;
        }
        if plan.contact_rows {
            self.contact.rows(&prepared, increment, contact)?;
        }
        let fields = plan.needs_solution().then(|| {
            let solution = simulation.recover();
            let stress = if plan.needs_stress() { simulation.nodal_stress(&solution) } else { Vec::new() };
            let axial = if plan.needs_elements() { axial(simulation, &solution) } else { Vec::new() };
            NodalFields { solution, stress, axial }
        });
        if let Some(fields) = &fields {
            self.nodes.rows(model, increment, &plan.node_rows, &fields.solution)?;
            if plan.frame {
                self.frames.write(&prepared, increment.time, fields, contact)?;
            }
        }
        let said = Increment {
            prepared: &prepared,
            report: increment,
            history: &history,
            resultants: &resultants,
            contact,
            fields: fields.as_ref(),
        };
        self.printed.write(&said, &plan)?;
        self.results.write(&said, &plan)?;
        self.snapshots.write(step, increment, moment, simulation)
    }
}

impl Watch for ResultWriter {
    fn increment(&mut self, simulation: &Simulation, report: &IncrementReport) {
        if self.error.is_some() {
            return;
        }
        let last = step_of(self.prepared.model(), report).is_some_and(|step| {
            // The clock of a step is a sum of increments; its end is hit to rounding.
            report.step_time >= step.procedure.period() * (1.0 - 1e-9)
        });
        let moment = if last { Moment::LastOfStep } else { Moment::Within };
        self.unfinished = (!last).then(|| report.clone());
        if let Err(error) = self.write(simulation, report, moment) {
            self.error = Some(error);
        }
    }

    /// Results that cannot be written are not worth computing.
    fn cancelled(&self) -> bool {
        self.failed()
    }
}

/// The step that an increment belongs to.
fn step_of<'a>(model: &'a Model, increment: &IncrementReport) -> Option<&'a Step> {
    model.steps.get((increment.step as usize).checked_sub(1)?)
}

/// What an increment has to say to the files with tables and records.
struct Increment<'a> {
    prepared: &'a PreparedModel,
    report: &'a IncrementReport,
    history: &'a HistoryRow,
    resultants: &'a [Resultants],
    contact: &'a [ContactPointResult],
    /// Values that one recovery gives, where something needs them.
    fields: Option<&'a NodalFields>,
}

/// What one recovery gives; stress and axial values are empty when nothing needs them.
struct NodalFields {
    solution: NodalSolution,
    stress: Vec<[f64; 6]>,
    /// Stress of each bar and force of each spring, positive in tension, by element.
    axial: Vec<(ElementId, f64)>,
}

/// Stress of each bar and force of each spring, by element.
fn axial(simulation: &Simulation, solution: &NodalSolution) -> Vec<(ElementId, f64)> {
    let mut elements: Vec<ElementId> = simulation.prepared().model().mesh.connectors.keys().copied().collect();
    elements.sort_unstable();
    let value = |element| Some((element, simulation.element_stress(solution, element).first()?[0]));
    elements.into_iter().filter_map(value).collect()
}
