//! The engine façade: open, set, advance, observe, checkpoint, restore.

use std::sync::Arc;

pub use crate::prepared::PreparedModel;
pub use crate::request::*;
pub use crate::results::*;

use crate::explicit::ExplicitWork;
use crate::fingerprint::fingerprint;
use crate::model::Model;
use crate::procedure::courses::{ColumnMotion, Course};
use crate::procedure::implicit::ImplicitWork;
use crate::procedure::interval::Driven;
use crate::procedure::modified_hard::Verdict;
use crate::solve::contact::{ContactSolver, Row};
use crate::state::{Shape, State};

/// Called at the end of each increment; also asked whether to go on.
pub trait Watch {
    /// An increment has converged; results may be read from `simulation`.
    fn increment(&mut self, simulation: &Simulation, report: &IncrementReport);

    /// An increment found no solution and is tried again with a smaller size; `simulation` stands at its start.
    fn cutback(&mut self, _simulation: &Simulation, _report: &CutbackReport) {}

    /// True stops the advance before the next increment.
    fn cancelled(&self) -> bool {
        false
    }
}

/// Watches nothing.
impl Watch for () {
    fn increment(&mut self, _: &Simulation, _: &IncrementReport) {}
}

/// A running analysis: a prepared model and its state.
pub struct Simulation {
    pub(crate) prepared: Arc<PreparedModel>,
    pub(crate) state: State,
    /// Of static steps.
    pub(crate) solver: Option<ContactSolver>,
    pub(crate) work: Work,
    /// Of implicit dynamic steps.
    pub(crate) implicit: ImplicitWork,
    /// Of the present explicit step.
    pub(crate) explicit: Option<ExplicitWork>,
    pub(crate) derived: Derived,
    /// Input of each real column, if it is one.
    input_of_column: Vec<Option<usize>>,
    /// Total time at the start of each step.
    pub(crate) step_starts: Vec<f64>,
}

/// Work space of an attempt; nothing in it outlives one.
#[derive(Default)]
pub(crate) struct Work {
    pub coefficients: Vec<f64>,
    /// Columns of driven inputs.
    pub driven: Vec<Driven>,
    /// Columns with their rates.
    pub columns: Vec<ColumnMotion>,
    pub free: Vec<f64>,
    pub forces: Vec<f64>,
    pub closed: Vec<bool>,
    pub motions: Vec<f64>,
    pub springs: Vec<f64>,
    pub loose: Vec<f64>,
    pub load: Vec<f64>,
    pub load_scale: Vec<f64>,
    pub overclosures: Vec<f64>,
    pub relief: Vec<f64>,
    pub tangential: Vec<f64>,
    pub scratch: Vec<f64>,
    /// Overclosures from which dashpots measure their speeds.
    pub starts: Vec<f64>,
    /// What each row does.
    pub rows: Vec<Row>,
    /// Multipliers of augmented Lagrange.
    pub multipliers: Vec<f64>,
    /// Their overclosures.
    pub penetrations: Vec<f64>,
    /// By how much the onsets of curves move in an augmentation.
    pub gaps: Vec<f64>,
    /// How often each point has changed its status in the attempt.
    pub changes: Vec<u8>,
    pub verdicts: Vec<(u32, Verdict)>,
    /// What removed pairs still carry.
    pub given: Vec<f64>,
    /// Largest overclosure without contact forces: what rounding is judged against.
    pub scale: f64,
}

/// Results of the present state: a function of it, never stored.
#[derive(Default)]
pub(crate) struct Derived {
    pub overclosures: Vec<f64>,
    /// `W F`.
    pub relief: Vec<f64>,
    pub points: Vec<ContactPointResult>,
    pub pairs: Vec<PairTotals>,
    pub energies: Energies,
}

/// Whether bytes are a checkpoint of a model, found out without preparing it.
pub fn check_checkpoint(model: &Model, bytes: &[u8]) -> Result<(), RestoreError> {
    State::check(bytes, fingerprint(model)).map(|_| ())
}

impl Simulation {
    /// At the start of the first step.
    pub fn new(prepared: Arc<PreparedModel>) -> Self {
        let (points, n) = (prepared.points.len(), prepared.rows.count());
        let springs = prepared.statics.as_ref().map_or_else(Vec::new, |statics| statics.contact.springs.clone());
        let motions = springs.len();
        let inputs = prepared.loading.input_columns.len();
        let mut input_of_column = vec![None; prepared.real_columns];
        for (input, &column) in prepared.loading.input_columns.iter().enumerate() {
            input_of_column[column] = Some(input);
        }
        let mut step_starts = Vec::with_capacity(prepared.model.steps.len());
        let mut total = 0.0;
        for step in &prepared.model.steps {
            step_starts.push(total);
            total += step.procedure.period();
        }
        let mut counts = vec![WorkCounts::default()];
        counts[0].factorizations = prepared.factorizations();
        let state = State {
            step: 0,
            step_time: 0.0,
            increment_next: prepared.model.steps[0].procedure.increment_first(),
            increment_anchor: 0.0,
            increment_index: 0,
            easy_increments: 0,
            counts,
            coefficients: vec![0.0; prepared.real_columns],
            step_start: vec![0.0; prepared.real_columns],
            magnitudes: vec![None; inputs],
            driven: vec![false; inputs],
            pending: vec![None; inputs],
            forces: vec![0.0; n],
            closed: vec![false; n],
            latched: vec![false; points],
            stuck: vec![false; points],
            multipliers: vec![0.0; points],
            penetrations: vec![0.0; points],
            origins: vec![0.0; 2 * points],
            viscous: vec![0.0; n],
            removed: vec![0.0; n],
            damping_work: 0.0,
            tangential: vec![0.0; 2 * n],
            slip: vec![0.0; 2 * n],
            motions: vec![0.0; motions],
            springs,
            conjugates: vec![0.0; prepared.real_columns],
            external_work: 0.0,
            last_change: 0.0,
            motion: None,
        };
        let work = Work {
            coefficients: Vec::with_capacity(prepared.real_columns),
            driven: Vec::with_capacity(inputs),
            free: vec![0.0; n],
            forces: vec![0.0; n],
            closed: vec![false; n],
            motions: vec![0.0; motions],
            springs: vec![0.0; motions],
            loose: Vec::with_capacity(motions),
            load: vec![0.0; motions],
            load_scale: vec![0.0; motions],
            overclosures: vec![0.0; n],
            relief: vec![0.0; n],
            tangential: vec![0.0; 2 * n],
            scratch: vec![0.0; 2 * n],
            columns: Vec::new(),
            starts: vec![0.0; n],
            rows: Vec::with_capacity(n),
            multipliers: vec![0.0; points],
            penetrations: vec![0.0; points],
            gaps: Vec::new(),
            changes: Vec::with_capacity(points),
            verdicts: Vec::with_capacity(points),
            given: Vec::new(),
            scale: 0.0,
        };
        let derived = Derived { overclosures: vec![0.0; n], relief: vec![0.0; n], ..Derived::default() };
        let solver = prepared.statics.as_ref().map(|statics| ContactSolver::new(&statics.contact));
        let implicit = match prepared.implicit {
            Some(_) => ImplicitWork::new(prepared.model.mesh.nodes.len()),
            None => ImplicitWork::default(),
        };
        let mut simulation =
            Self { prepared, state, solver, work, implicit, explicit: None, derived, input_of_column, step_starts };
        simulation.begin_motion();
        simulation.recompute();
        simulation
    }

    /// Runs every step but the last. The ports drive the last one. Does nothing when already there.
    pub fn initialize(&mut self, watch: &mut dyn Watch) -> AdvanceOutcome {
        while !self.on_last_step() {
            let period = self.prepared.model.steps[self.state.step as usize].procedure.period();
            match self.advance_step(period, watch) {
                AdvanceOutcome::Reached => self.begin_next_step(),
                other => return other,
            }
        }
        AdvanceOutcome::Reached
    }

    /// The prepared model.
    pub fn prepared(&self) -> &Arc<PreparedModel> {
        &self.prepared
    }

    /// Total time.
    pub fn time(&self) -> f64 {
        self.step_start_time() + self.state.step_time
    }

    /// Total time at which the last step, the one that ports drive, begins.
    pub fn time_start(&self) -> f64 {
        self.step_starts[self.step_starts.len() - 1]
    }

    /// Total time at which the last step ends by the deck.
    pub fn time_end(&self) -> f64 {
        let last = self.step_starts.len() - 1;
        self.step_starts[last] + self.prepared.model.steps[last].procedure.period()
    }

    /// Replaces the magnitude of the line behind an input and keeps its amplitude (`--set`).
    pub fn set_magnitude(&mut self, input: usize, value: f64) -> Result<(), SetError> {
        self.check_input(input, value)?;
        self.state.magnitudes[input] = Some(value);
        Ok(())
    }

    /// Actual value of an input at the end of the next advance, reached linearly from the last one.
    pub fn set(&mut self, input: usize, value: f64) -> Result<(), SetError> {
        self.check_input(input, value)?;
        self.state.pending[input] = Some(value);
        Ok(())
    }

    fn check_input(&self, input: usize, value: f64) -> Result<(), SetError> {
        let inputs = &self.prepared.ports.inputs;
        match inputs.get(input) {
            None => Err(SetError::UnknownInput { index: input, count: inputs.len() }),
            Some(port) if !value.is_finite() => Err(SetError::NotFinite { port: port.name.clone(), value }),
            Some(_) => Ok(()),
        }
    }

    /// Present actual value of an input (a pending one if it was set since the last advance).
    pub fn input(&self, input: usize) -> Option<f64> {
        let column = *self.prepared.loading.input_columns.get(input)?;
        let now = self.column_now(column).of(self.kind_of(column));
        Some(self.state.pending[input].unwrap_or(now))
    }

    /// Advances to a total time, through `initialize` if needed. Increments follow the deck's control and end
    /// on the target to rounding; a target equal to the present time applies pending inputs and refreshes outputs.
    pub fn advance(&mut self, target: f64, watch: &mut dyn Watch) -> Result<AdvanceOutcome, AdvanceError> {
        self.check_target(target)?;
        match self.initialize(watch) {
            AdvanceOutcome::Reached => Ok(self.advance_step(target - self.time_start(), watch)),
            other => Ok(other),
        }
    }

    /// Whether [`Self::advance`] would take a target time: finite, and not before the present time by more than rounding.
    pub fn check_target(&self, target: f64) -> Result<(), AdvanceError> {
        if !target.is_finite() {
            return Err(AdvanceError::NotFinite { target });
        }
        let now = self.time().max(self.time_start());
        if target < now - 1e-12 * now.abs().max(self.time_end()) {
            return Err(AdvanceError::Past { now, target });
        }
        Ok(())
    }

    /// Results at the contact points, in the order of [`PreparedModel::contact_points`].
    pub fn contact_results(&self) -> &[ContactPointResult] {
        &self.derived.points
    }

    /// Reports of the steps begun so far, in order.
    pub fn step_reports(&self) -> Vec<StepReport> {
        let report = |(i, counts): (usize, &WorkCounts)| {
            let step = &self.prepared.model.steps[i];
            let time_reached =
                if i == self.state.step as usize { self.time() } else { self.step_starts[i] + step.procedure.period() };
            StepReport {
                name: step.name.clone(),
                procedure: step.procedure.keyword(),
                time_reached,
                counts: counts.clone(),
            }
        };
        self.state.counts.iter().enumerate().map(report).collect()
    }

    /// Versioned, checksummed, little-endian bytes of the state.
    pub fn checkpoint(&self) -> Vec<u8> {
        self.state.encode(self.prepared.fingerprint)
    }

    /// Returns to a checkpoint of the same model, bit for bit. On error nothing changes.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), RestoreError> {
        let model = &self.prepared.model;
        let shape = Shape {
            dynamic: model.steps.iter().map(|step| step.procedure.is_dynamic()).collect(),
            nodes: model.mesh.nodes.len(),
        };
        self.state = State::decode(bytes, self.prepared.fingerprint, &self.state, &shape)?;
        self.recompute();
        Ok(())
    }

    pub(crate) fn on_last_step(&self) -> bool {
        self.state.step as usize + 1 == self.prepared.model.steps.len()
    }

    /// Total time at the start of the present step.
    pub(crate) fn step_start_time(&self) -> f64 {
        self.step_starts[self.state.step as usize]
    }

    /// Course of a column in the present step, with replaced magnitudes.
    pub(crate) fn course(&self, column: usize) -> Course {
        let course = self.prepared.loading.courses[self.state.step as usize][column];
        let replaced =
            self.input_of_column[column].filter(|_| self.on_last_step()).and_then(|i| self.state.magnitudes[i]);
        replaced.map_or(course, |magnitude| course.with_magnitude(magnitude))
    }

    fn begin_next_step(&mut self) {
        self.state.step += 1;
        self.state.step_time = 0.0;
        self.state.step_start.clone_from(&self.state.coefficients);
        let procedure = &self.prepared.model.steps[self.state.step as usize].procedure;
        self.state.increment_next = procedure.increment_first();
        self.state.increment_anchor = 0.0;
        self.state.increment_index = 0;
        self.state.easy_increments = 0;
        self.state.counts.push(WorkCounts::default());
        let moved = self.state.motion.is_some();
        self.begin_motion();
        self.remove_pairs();
        if self.state.motion.is_none() && !moved {
            self.begin_overclosures();
        }
        self.recompute();
    }
}
