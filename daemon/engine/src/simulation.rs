//! The engine façade: open, set, advance, observe, checkpoint, restore.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::diagnostic::Diagnostic;
use crate::model::{Model, NodeId};
use crate::port::PortList;

/// Which solver path to take.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PathChoice {
    /// By estimated cost.
    #[default]
    Auto,
    /// Condensed onto contact, dense.
    Dense,
    /// Newton on the sparse system.
    Sparse,
}

/// How a model is prepared.
#[derive(Clone, Debug, Default)]
pub struct PrepareOptions {
    /// Solver path.
    pub path: PathChoice,
    /// Threads that may be used; 0 and 1 both mean one. The bits of the result do not depend on it.
    pub threads: usize,
    /// Text of a `ports.toml`, if any.
    pub ports_toml: Option<String>,
}

/// Stages of preparation, announced when they begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Phase {
    /// Contact search and projection.
    Search,
    /// Element matrices.
    Assemble,
    /// Fill-reducing ordering.
    Order,
    /// Symbolic factorisation.
    Symbolic,
    /// Numeric factorisation.
    Numeric,
    /// Condensation onto the contact points.
    Condense,
    /// Increments.
    Solve,
    /// Writing results.
    Write,
}

/// Everything that can be computed before the first increment. Immutable; shared by sessions and instances.
pub struct PreparedModel {
    model: Model,
    ports: PortList,
}

impl PreparedModel {
    /// Prepares a validated model. Errors are findings about the deck (a body that nothing holds, an inverted element).
    pub fn prepare(model: Model, options: &PrepareOptions, announce: &mut dyn FnMut(Phase)) -> Result<Self, Vec<Diagnostic>> {
        let _ = (model, options, announce);
        todo!()
    }

    /// The model as the deck describes it.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Findings of the preparation that do not stop it (points without a partner, …).
    pub fn warnings(&self) -> &[Diagnostic] {
        todo!()
    }

    /// Inputs and outputs.
    pub fn ports(&self) -> &PortList {
        &self.ports
    }

    /// Contact points, pairs one after another, in the order of every per-point result.
    pub fn contact_points(&self) -> &[ContactPointInfo] {
        todo!()
    }

    /// Names of the node sets whose reaction totals stand in each history row.
    pub fn total_set_names(&self) -> Vec<&str> {
        todo!()
    }
}

/// What never changes about a contact point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPointInfo {
    /// Index into `model().pairs`.
    pub pair: u32,
    /// Secondary node.
    pub node: NodeId,
    /// Tributary area [length²].
    pub area: f64,
    /// Unit normal of the primary, towards the secondary.
    pub normal: [f64; 3],
    /// Initial clearance [length].
    pub clearance: f64,
}

/// Status of a contact point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ContactStatus {
    /// No contact.
    #[serde(rename = "OP")]
    Open,
    /// Closed, frictionless.
    #[serde(rename = "CL")]
    Closed,
}

/// Result at a contact point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPointResult {
    /// Status.
    pub status: ContactStatus,
    /// COPEN: clearance [length], negative when the bodies overlap.
    pub clearance: f64,
    /// CPRESS: contact pressure [pressure], positive in compression.
    pub pressure: f64,
    /// CSHEAR1, CSHEAR2 [pressure].
    pub shear: [f64; 2],
    /// CSLIP1, CSLIP2: accumulated slip while closed [length].
    pub slip: [f64; 2],
}

/// Totals of a pair at the end of an increment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PairTotals {
    /// CFN1..3: force on the secondary surface due to pressure.
    pub force: [f64; 3],
    /// CFNM: its magnitude.
    pub force_magnitude: f64,
    /// CAREA: area of the closed points.
    pub area: f64,
}

/// Energies at the end of an increment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energies {
    /// ALLSE: strain energy of the bodies.
    pub strain: f64,
    /// ALLKE: kinetic energy.
    pub kinetic: f64,
    /// ALLWK: work of loads and prescribed displacements.
    pub external_work: f64,
    /// ALLFD: frictional dissipation.
    pub friction: f64,
    /// ALLVD: viscous dissipation.
    pub viscous: f64,
    /// ALLCCE: energy stored in softened contact.
    pub contact: f64,
    /// IMPACT_LOSS: kinetic energy lost in impacts.
    pub impact_loss: f64,
    /// ETOTAL: stored plus dissipated less external work; constant when the solution is exact.
    pub total: f64,
}

/// One row of the history.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HistoryRow {
    /// Per contact pair.
    pub pairs: Vec<PairTotals>,
    /// Energies.
    pub energies: Energies,
    /// Total reaction force per set of [`PreparedModel::total_set_names`].
    pub reactions: Vec<[f64; 3]>,
}

/// Nodal fields, recovered by one solve. One entry per node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodalSolution {
    /// U [length].
    pub displacement: Vec<[f64; 3]>,
    /// RF \[force\]: non-zero at prescribed directions only.
    pub reaction: Vec<[f64; 3]>,
}

/// Work counts, per step.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct WorkCounts {
    /// Increments completed.
    pub increments: u32,
    /// Equilibrium iterations.
    pub equilibrium_iterations: u32,
    /// Severe discontinuity iterations: those that changed a contact status.
    pub severe_discontinuity_iterations: u32,
    /// Cutbacks.
    pub cutbacks: u32,
    /// Sparse factorisations done for this step.
    pub factorizations: u32,
}

/// What a step has done so far.
#[derive(Clone, Debug, PartialEq)]
pub struct StepReport {
    /// Name of the step.
    pub name: String,
    /// `*STATIC`, ….
    pub procedure: &'static str,
    /// Total time reached.
    pub time_reached: f64,
    /// Work.
    pub counts: WorkCounts,
}

/// A contact point that changed status in an increment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StatusChange {
    /// Index into [`PreparedModel::contact_points`].
    pub point: u32,
    /// Status at the end of the increment.
    pub to: ContactStatus,
}

/// One line of the increments table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IncrementReport {
    /// Step number, from 1.
    pub step: u32,
    /// Increment number within the step, from 1.
    pub increment: u32,
    /// Attempt that succeeded, from 1.
    pub attempt: u32,
    /// Severe discontinuity iterations of the attempt.
    pub severe_discontinuity_iterations: u32,
    /// Equilibrium iterations of the attempt.
    pub equilibrium_iterations: u32,
    /// Total time at the end.
    pub time: f64,
    /// Step time at the end.
    pub step_time: f64,
    /// Size of the increment.
    pub increment_size: f64,
    /// Points whose status at the end differs from that at the start: the contact log.
    pub status_changes: Vec<StatusChange>,
}

/// Called at the end of each increment; also asked whether to go on.
pub trait Watch {
    /// An increment has converged; results may be read from `simulation`.
    fn increment(&mut self, simulation: &Simulation, report: &IncrementReport);

    /// True stops the advance before the next increment.
    fn cancelled(&self) -> bool {
        false
    }
}

/// Watches nothing.
impl Watch for () {
    fn increment(&mut self, _: &Simulation, _: &IncrementReport) {}
}

/// How an advance ended.
#[derive(Clone, Debug, PartialEq)]
pub enum AdvanceOutcome {
    /// The target time was reached.
    Reached,
    /// The watch asked to stop; the state stands at the last completed increment.
    Cancelled,
    /// The solution could not be continued; the state stands at the last good increment.
    Stopped {
        /// Why, in words: what did not converge, which points chattered or slid too far.
        reason: String,
    },
}

/// Why a value cannot be set.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SetError {
    /// No such input.
    #[error("no input port {index}: this deck has {count}")]
    UnknownInput {
        /// Asked for.
        index: usize,
        /// Number of inputs.
        count: usize,
    },
    /// NaN or infinity.
    #[error("input {port}: {value} is not a finite number")]
    NotFinite {
        /// Name of the port.
        port: String,
        /// The value.
        value: f64,
    },
}

/// Why a target time cannot be taken.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AdvanceError {
    /// NaN or infinity.
    #[error("target time {target} is not a finite number")]
    NotFinite {
        /// The target.
        target: f64,
    },
    /// The target lies before the present time.
    #[error("target time {target} lies before the present time {now}; restore a checkpoint to go back")]
    Past {
        /// Present time.
        now: f64,
        /// The target.
        target: f64,
    },
}

/// Why a checkpoint cannot be restored.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RestoreError {
    /// Too short, wrong magic, wrong checksum.
    #[error("not an overclosure checkpoint or damaged: {detail}")]
    Damaged {
        /// What does not fit.
        detail: String,
    },
    /// Written by another version of the format.
    #[error("checkpoint version {found} cannot be read by this build, which reads version {supported}")]
    Version {
        /// In the bytes.
        found: u32,
        /// Of this build.
        supported: u32,
    },
    /// Belongs to another deck.
    #[error("the checkpoint belongs to another model (fingerprint {found:016x}, this model has {expected:016x})")]
    OtherModel {
        /// In the bytes.
        found: u64,
        /// Of this model.
        expected: u64,
    },
}

/// Why a field cannot be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("no field {name}: available are {available}")]
pub struct FieldError {
    /// Asked for.
    pub name: String,
    /// What there is, comma separated.
    pub available: String,
}

/// A field: row-major values, one row per label.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// `U`, `RF`, `S`, `CPRESS`, `COPEN`, `CSTATUS`, `CSLIP`.
    pub name: String,
    /// Node label of each row.
    pub labels: Vec<u32>,
    /// Values per row.
    pub components: usize,
    /// `labels.len() * components` values.
    pub values: Vec<f64>,
}

/// A running analysis: a prepared model and its state.
pub struct Simulation {
    prepared: Arc<PreparedModel>,
}

impl Simulation {
    /// At the start of the first step.
    pub fn new(prepared: Arc<PreparedModel>) -> Self {
        Self { prepared }
    }

    /// Runs every step but the last. The ports drive the last one. Does nothing when already there.
    pub fn initialize(&mut self, watch: &mut dyn Watch) -> AdvanceOutcome {
        let _ = watch;
        todo!()
    }

    /// The prepared model.
    pub fn prepared(&self) -> &Arc<PreparedModel> {
        &self.prepared
    }

    /// Total time.
    pub fn time(&self) -> f64 {
        todo!()
    }

    /// Total time at which the last step ends by the deck.
    pub fn time_end(&self) -> f64 {
        todo!()
    }

    /// Replaces the magnitude of the line behind an input and keeps its amplitude (`--set`).
    pub fn set_magnitude(&mut self, input: usize, value: f64) -> Result<(), SetError> {
        let _ = (input, value);
        todo!()
    }

    /// Actual value of an input at the end of the next advance, reached linearly from the last one.
    pub fn set(&mut self, input: usize, value: f64) -> Result<(), SetError> {
        let _ = (input, value);
        todo!()
    }

    /// Present actual value of an input (a pending one if it was set since the last advance).
    pub fn input(&self, input: usize) -> Option<f64> {
        let _ = input;
        todo!()
    }

    /// Advances to a total time, through `initialize` if needed. Increments follow the deck's control and end
    /// exactly on the target; a target equal to the present time applies pending inputs and refreshes outputs.
    pub fn advance(&mut self, target: f64, watch: &mut dyn Watch) -> Result<AdvanceOutcome, AdvanceError> {
        let _ = (target, watch);
        todo!()
    }

    /// Output values in port order. Panics if the length is not the number of outputs.
    pub fn observe(&self, outputs: &mut [f64]) {
        let _ = outputs;
        todo!()
    }

    /// Results at the contact points, in the order of [`PreparedModel::contact_points`].
    pub fn contact_results(&self) -> &[ContactPointResult] {
        todo!()
    }

    /// The history row of the present time.
    pub fn history(&self) -> HistoryRow {
        todo!()
    }

    /// Displacements and reactions of all nodes: one solve.
    pub fn recover(&self) -> NodalSolution {
        todo!()
    }

    /// Stress at the nodes (11, 22, 33, 12, 13, 23), averaged over the elements of one material at each node.
    pub fn nodal_stress(&self, solution: &NodalSolution) -> Vec<[f64; 6]> {
        let _ = solution;
        todo!()
    }

    /// A field by name.
    pub fn field(&self, name: &str) -> Result<Field, FieldError> {
        let _ = name;
        todo!()
    }

    /// Reports of the steps begun so far, in order.
    pub fn step_reports(&self) -> Vec<StepReport> {
        todo!()
    }

    /// What the audit of the present solution found; empty when clean.
    pub fn audit(&self) -> Vec<String> {
        todo!()
    }

    /// Versioned, checksummed, little-endian bytes of the state.
    pub fn checkpoint(&self) -> Vec<u8> {
        todo!()
    }

    /// Returns to a checkpoint of the same model, bit for bit.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), RestoreError> {
        let _ = bytes;
        todo!()
    }
}
