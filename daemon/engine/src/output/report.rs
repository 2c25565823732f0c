//! `JOB.json`: how the run ended and what it cost.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::file::OutputError;
use super::snapshots::SnapshotSummary;
use super::status_log::StatusChangeSummary;
use crate::diagnostic::{Diagnostic, Severity};
use crate::model::Dialect;
use crate::restart::Standing;
use crate::simulation::{CutbackReport, StepReport, WorkCounts};

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum RunOutcome {
    /// Every step to its end.
    Completed,
    /// Before the end: not converged, or told to stop.
    Stopped,
}

/// The report of a run.
#[derive(Clone, Debug, Serialize)]
pub struct RunReport {
    /// Name of the job.
    pub job: String,
    /// The deck.
    pub deck: String,
    /// Version of the program.
    pub version: String,
    /// How keywords were read.
    pub dialect: Dialect,
    /// How it ended.
    pub outcome: RunOutcome,
    /// Why it stopped; absent when it did not.
    pub reason: Option<String>,
    /// Total time of the last good increment.
    pub time_reached: f64,
    /// Nodes, elements and contact points.
    pub size: ModelSize,
    /// Where the run went on from; absent for one that began at the beginning.
    pub restarted_from: Option<RestartOrigin>,
    /// Inputs that were set instead of those of the deck.
    pub inputs_set: BTreeMap<String, f64>,
    /// Per step begun, in order.
    pub steps: Vec<StepSummary>,
    /// Increments of this run that were tried in vain, in order.
    pub cutbacks: Vec<CutbackSummary>,
    /// The contact log: points that changed status in this run, in order.
    pub status_changes: Vec<StatusChangeSummary>,
    /// Changes that the log does not tell, for there were too many.
    pub status_changes_omitted: u64,
    /// Snapshots from which a run can go on.
    pub snapshots: Vec<SnapshotSummary>,
    /// Findings about the deck.
    pub diagnostics: Vec<Finding>,
    /// Findings of the audit of the solution.
    pub audit: Vec<String>,
    /// Wall seconds by phase.
    pub wall_seconds: BTreeMap<String, f64>,
}

/// The snapshot that a run went on from.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RestartOrigin {
    /// The file, as the user named it.
    pub file: String,
    /// The last increment that it knows of.
    #[serde(flatten)]
    pub standing: Standing,
}

/// An increment that was tried in vain.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CutbackSummary {
    /// Step number, from 1.
    pub step: u32,
    /// Increment that was tried, from 1.
    pub increment: u32,
    /// Attempt that failed, from 1.
    pub attempt: u32,
    /// Its size \[time\].
    pub increment_size: f64,
    /// Size of the next attempt \[time\].
    pub next_size: f64,
    /// Why it failed.
    pub reason: String,
}

impl From<&CutbackReport> for CutbackSummary {
    fn from(report: &CutbackReport) -> Self {
        let CutbackReport { step, increment, attempt, increment_size, next_size, reason } = report.clone();
        Self { step, increment, attempt, increment_size, next_size, reason }
    }
}

/// Size of a model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct ModelSize {
    /// Nodes.
    pub nodes: usize,
    /// Elements.
    pub elements: usize,
    /// Contact points.
    pub contact_points: usize,
}

/// What a step did.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StepSummary {
    /// Name of the step.
    pub name: String,
    /// `*STATIC`, ….
    pub procedure: &'static str,
    /// Total time reached.
    pub time_reached: f64,
    /// Increments completed.
    pub increments: u32,
    /// Equilibrium iterations.
    pub equilibrium_iterations: u32,
    /// Iterations that changed a contact status.
    pub severe_discontinuity_iterations: u32,
    /// Attempts that failed.
    pub cutbacks: u32,
    /// Sparse factorisations.
    pub factorizations: u32,
    /// Augmentations of augmented Lagrange.
    pub augmentations: u32,
    /// Impacts of an implicit dynamic step.
    pub impacts: u32,
    /// Smallest increment of the step in this run \[time\]; absent before the first.
    pub increment_min: Option<f64>,
    /// Largest increment of the step in this run \[time\]; absent before the first.
    pub increment_max: Option<f64>,
    /// Stable increments of an explicit step in this run; absent before the first, and in other steps.
    pub stable_increment: Option<StableIncrement>,
}

/// Stable increments over a step \[time\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StableIncrement {
    /// Of the first increment.
    pub first: f64,
    /// The smallest one.
    pub min: f64,
    /// Of the last increment.
    pub last: f64,
}

impl From<StepReport> for StepSummary {
    fn from(report: StepReport) -> Self {
        let StepReport { name, procedure, time_reached, counts } = report;
        let WorkCounts {
            increments,
            equilibrium_iterations,
            severe_discontinuity_iterations,
            cutbacks,
            factorizations,
            augmentations,
            impacts,
        } = counts;
        Self {
            name,
            procedure,
            time_reached,
            increments,
            equilibrium_iterations,
            severe_discontinuity_iterations,
            cutbacks,
            factorizations,
            augmentations,
            impacts,
            increment_min: None,
            increment_max: None,
            stable_increment: None,
        }
    }
}

/// A finding about the deck.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Error or warning.
    pub severity: Severity,
    /// File; absent for text without one.
    pub file: Option<PathBuf>,
    /// Line from 1; 0 when it is about the deck as a whole.
    pub line: u32,
    /// Keyword with its star; may be empty.
    pub keyword: String,
    /// What is wrong.
    pub message: String,
    /// What can be done.
    pub remedy: String,
}

impl From<&Diagnostic> for Finding {
    fn from(diagnostic: &Diagnostic) -> Self {
        let Diagnostic { severity, place, keyword, message, remedy } = diagnostic;
        Self {
            severity: *severity,
            file: place.file.as_deref().cloned(),
            line: place.line,
            keyword: keyword.clone(),
            message: message.clone(),
            remedy: remedy.clone(),
        }
    }
}

/// Writes the report in one piece: it is there as a whole or not at all.
pub fn write_report(directory: &Path, job: &str, report: &RunReport) -> Result<(), OutputError> {
    let path = report_path(directory, job);
    let temporary = directory.join(format!("{job}.json.part"));
    write_json(&temporary, report).map_err(OutputError::at(&temporary))?;
    fs::rename(&temporary, &path).map_err(OutputError::at(&path))
}

/// Removes the report of an earlier run, which would outlive a run that is killed.
pub(super) fn remove(directory: &Path, job: &str) -> Result<(), OutputError> {
    let path = report_path(directory, job);
    match fs::remove_file(&path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(OutputError { path, source: error }),
        Ok(()) | Err(_) => Ok(()),
    }
}

fn report_path(directory: &Path, job: &str) -> PathBuf {
    directory.join(format!("{job}.json"))
}

fn write_json(path: &Path, report: &RunReport) -> io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    serde_json::to_writer_pretty(&mut file, report)?;
    file.write_all(b"\n")?;
    file.flush()
}
