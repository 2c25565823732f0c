//! What a session does with its `Simulation`: one method per verb.

use std::collections::BTreeSet;
use std::hash::{BuildHasher, BuildHasherDefault, DefaultHasher};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use overclosure::model::Procedure;
use overclosure::simulation::{AdvanceOutcome, IncrementReport, Simulation, Watch, WorkCounts};
use overclosure_protocol::codec::{self, Format};
use overclosure_protocol::fault::{Fault, FaultCode};
use overclosure_protocol::key::{self, OUTPUTS_FRAME};
use overclosure_protocol::message::{
    Checkpoint, CloseReply, Counts, Field, FieldRequest, Frame, GetReply, GetRequest, InputValue, Limits, Message,
    NamedValue, OpenReply, OpenRequest, Ports, Report, RestoreReply, RestoreRequest, StepReply, StepRequest,
    StepStatus,
};

use super::convert;
use super::frames::FrameSender;
use super::models::SharedModel;
use super::registry::{Status, shutting_down};
use super::sequence::{Ledger, Outcome};

/// Explicit steps have very many increments: those within this time of a published one are passed over, but for the last of a request.
const EXPLICIT_FRAME_INTERVAL: Duration = Duration::from_millis(50);

/// Things that a session shares with the rest of the daemon.
pub struct Surroundings {
    /// Daemon id, for the keys of frames.
    pub daemon: String,
    /// Session id.
    pub session: String,
    /// Limits in force.
    pub limits: Limits,
    /// Where frames go.
    pub frames: FrameSender,
    /// Cancellation.
    pub status: Arc<Status>,
    /// Increments solved by the daemon.
    pub increments: Arc<AtomicU64>,
    /// Step requests accepted by the daemon.
    pub steps: Arc<AtomicU64>,
}

/// A prepared and initialised session.
pub struct Work {
    model: Arc<SharedModel>,
    simulation: Simulation,
    ledger: Ledger,
    around: Surroundings,
    frames_sent: u64,
    /// Fields that frames were asked for: each is a stream that ends with the session.
    streams: BTreeSet<String>,
}

impl Work {
    /// Replaces magnitudes and runs every step but the last.
    pub fn start(model: Arc<SharedModel>, request: &OpenRequest, around: Surroundings) -> Result<Self, Fault> {
        let mut simulation = Simulation::new(model.prepared.clone());
        for (input, value) in by_name(&simulation, &request.magnitudes)? {
            simulation.set_magnitude(input, value).map_err(|e| convert::set_error(&e))?;
        }
        let ledger = Ledger::new(around.limits.replies_kept);
        let streams = BTreeSet::from([OUTPUTS_FRAME.to_owned()]);
        let mut work = Self { model, simulation, ledger, around, frames_sent: 0, streams };
        let (simulation, mut watch) = work.watched(0, &[]);
        let outcome = simulation.initialize(&mut watch);
        watch.finish(simulation);
        match outcome {
            AdvanceOutcome::Reached => Ok(work),
            AdvanceOutcome::Cancelled if work.around.status.cancelled.load(Ordering::Relaxed) => Err(shutting_down()),
            AdvanceOutcome::Cancelled => {
                let limit = work.around.limits.increments_per_request;
                let mut fault = Fault::new(
                    FaultCode::LimitExceeded,
                    format!("the steps before the last need more than {limit} increments"),
                );
                fault.details.limit = Some(limit.into());
                Err(fault)
            }
            AdvanceOutcome::Stopped { reason } => {
                Err(Fault::new(FaultCode::PreloadStopped, format!("the steps before the last stopped: {reason}")))
            }
        }
    }

    /// The reply to `open`, now or when it is repeated.
    pub fn opened(&self) -> OpenReply {
        OpenReply {
            session: self.around.session.clone(),
            sequence_next: self.ledger.next(),
            time: self.simulation.time(),
            time_end: self.simulation.time_end(),
            warnings: self.model.warnings.iter().map(convert::finding).collect(),
            audit: self.simulation.audit(),
            ports: self.ports(),
            outputs: outputs(&self.simulation),
        }
    }

    /// Publishes for others what the session is at.
    pub fn tell(&self, working: bool) {
        self.around.status.update(working, self.ledger.next(), self.simulation.time());
    }

    /// Ends the frames.
    pub fn end(self) {
        for stream in &self.streams {
            self.around.frames.end(self.frame_key(stream));
        }
    }

    pub fn ports(&self) -> Ports {
        convert::ports(self.model.prepared.ports())
    }

    pub fn step(&mut self, request: &StepRequest) -> Result<StepReply, Fault> {
        let print = fingerprint(request)?;
        match self.ledger.admit(request.sequence, print)? {
            Some(Outcome::Step(reply)) => return Ok(reply),
            Some(Outcome::Restore(_)) => {
                return Err(Fault::new(FaultCode::SequenceConflict, "the sequence number was used by a restore"));
            }
            None => {}
        }
        let inputs = self.check_step(request)?;
        for (input, value) in inputs {
            self.simulation.set(input, value).map_err(|e| convert::set_error(&e))?;
        }
        self.streams.extend(request.frames.iter().cloned());
        let before = total(&self.simulation);
        let (simulation, mut watch) = self.watched(request.sequence, &request.frames);
        let outcome = simulation.advance(request.time, &mut watch);
        watch.finish(simulation);
        let increments = watch.increments;
        let outcome = outcome.map_err(|e| convert::advance_error(&e))?;
        self.around.increments.fetch_add(increments.into(), Ordering::Relaxed);
        self.around.steps.fetch_add(1, Ordering::Relaxed);
        let (status, reason) = match outcome {
            AdvanceOutcome::Reached => (StepStatus::Reached, String::new()),
            AdvanceOutcome::Stopped { reason } => (StepStatus::Stopped, reason),
            AdvanceOutcome::Cancelled if self.around.status.cancelled.load(Ordering::Relaxed) => {
                (StepStatus::Cancelled, "the daemon is shutting down".to_owned())
            }
            AdvanceOutcome::Cancelled => {
                let limit = self.around.limits.increments_per_request;
                (
                    StepStatus::IncrementLimit,
                    format!("one request may take {limit} increments; the next step goes on from here"),
                )
            }
        };
        let reply = StepReply {
            sequence: request.sequence,
            status,
            reason,
            time: self.simulation.time(),
            counts: difference(&before, &total(&self.simulation)),
            audit: self.simulation.audit(),
            outputs: outputs(&self.simulation),
        };
        self.ledger.record(print, Outcome::Step(reply.clone()));
        Ok(reply)
    }

    pub fn get(&self, request: &GetRequest) -> Result<GetReply, Fault> {
        let ports = self.model.prepared.ports();
        let values = outputs(&self.simulation);
        let input = |i: usize| {
            let value = self.simulation.input(i).unwrap_or(f64::NAN);
            NamedValue { name: ports.inputs[i].name.clone(), value }
        };
        let output = |i: usize| NamedValue { name: ports.outputs[i].name.clone(), value: values[i] };
        let mut reply = GetReply {
            sequence_next: self.ledger.next(),
            time: self.simulation.time(),
            time_end: self.simulation.time_end(),
            inputs: Vec::new(),
            outputs: Vec::new(),
        };
        if request.names.is_empty() {
            reply.inputs = (0..ports.inputs.len()).map(input).collect();
            reply.outputs = (0..ports.outputs.len()).map(output).collect();
        }
        for name in &request.names {
            match (ports.input(name), ports.output(name)) {
                (Some(i), _) => reply.inputs.push(input(i)),
                (None, Some(i)) => reply.outputs.push(output(i)),
                (None, None) => return Err(unknown_port(name, "port")),
            }
        }
        Ok(reply)
    }

    pub fn field(&self, request: &FieldRequest) -> Result<Field, Fault> {
        let field = self.simulation.field(&request.name).map_err(|e| convert::field_error(&e))?;
        Ok(convert::field(field, self.simulation.time()))
    }

    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint { time: self.simulation.time(), state: self.simulation.checkpoint() }
    }

    pub fn restore(&mut self, request: &RestoreRequest) -> Result<RestoreReply, Fault> {
        let print = fingerprint(request)?;
        match self.ledger.admit(request.sequence, print)? {
            Some(Outcome::Restore(reply)) => return Ok(reply),
            Some(Outcome::Step(_)) => {
                return Err(Fault::new(FaultCode::SequenceConflict, "the sequence number was used by a step"));
            }
            None => {}
        }
        self.simulation.restore(&request.state).map_err(|e| convert::restore_error(&e))?;
        let reply = RestoreReply {
            sequence: request.sequence,
            time: self.simulation.time(),
            outputs: outputs(&self.simulation),
        };
        self.ledger.record(print, Outcome::Restore(reply.clone()));
        Ok(reply)
    }

    pub fn report(&self) -> Report {
        Report {
            session: self.around.session.clone(),
            sequence_next: self.ledger.next(),
            time: self.simulation.time(),
            steps: self.simulation.step_reports().iter().map(convert::step_summary).collect(),
            audit: self.simulation.audit(),
            warnings: self.model.warnings.iter().map(convert::finding).collect(),
        }
    }

    pub fn close(&self) -> CloseReply {
        CloseReply { session: self.around.session.clone(), time: self.simulation.time() }
    }

    /// Everything that can be wrong with a step, found before anything is changed.
    fn check_step(&self, request: &StepRequest) -> Result<Vec<(usize, f64)>, Fault> {
        self.simulation.check_target(request.time).map_err(|e| convert::advance_error(&e))?;
        let inputs = &self.model.prepared.ports().inputs;
        let mut values = by_name(&self.simulation, &request.inputs)?;
        if request.indices.len() != request.values.len() {
            let text = format!(
                "{} indices and {} values: there must be one value for each index",
                request.indices.len(),
                request.values.len()
            );
            return Err(Fault::new(FaultCode::BadRequest, text));
        }
        for (&index, &value) in request.indices.iter().zip(&request.values) {
            if index as usize >= inputs.len() {
                return Err(Fault::new(
                    FaultCode::UnknownPort,
                    format!("no input port {index}: this deck has {}", inputs.len()),
                ));
            }
            values.push((index as usize, value));
        }
        let mut seen = vec![false; inputs.len()];
        for &(input, value) in &values {
            let name = &inputs[input].name;
            if std::mem::replace(&mut seen[input], true) {
                return Err(Fault::new(FaultCode::BadRequest, format!("input {name} is given twice")));
            }
            if !value.is_finite() {
                return Err(Fault::new(FaultCode::NotFinite, format!("input {name}: {value} is not a finite number")));
            }
        }
        for field in &request.frames {
            self.simulation.field(field).map_err(|e| convert::field_error(&e))?;
        }
        Ok(values)
    }

    fn frame_key(&self, field: &str) -> String {
        key::frame(&self.around.daemon, &self.around.session, field)
    }

    fn watched<'a>(&'a mut self, sequence: u64, fields: &'a [String]) -> (&'a mut Simulation, FrameWatch<'a>) {
        let watch = FrameWatch {
            around: &self.around,
            sequence,
            fields,
            frames_sent: &mut self.frames_sent,
            increments: 0,
            published: None,
            passed_over: None,
            increments_max: self.around.limits.increments_per_request,
            cancelled: &self.around.status.cancelled,
        };
        (&mut self.simulation, watch)
    }
}

/// Publishes each increment and says when to stop.
struct FrameWatch<'a> {
    around: &'a Surroundings,
    sequence: u64,
    fields: &'a [String],
    frames_sent: &'a mut u64,
    increments: u32,
    /// When the last frames were published, and the increment since that was not.
    published: Option<Instant>,
    passed_over: Option<At>,
    increments_max: u32,
    cancelled: &'a AtomicBool,
}

/// An increment of the deck.
#[derive(Clone, Copy)]
struct At {
    step: u32,
    increment: u32,
    time: f64,
}

impl FrameWatch<'_> {
    /// Publishes the last increment of the request, unless that is done.
    fn finish(&mut self, simulation: &Simulation) {
        if let Some(at) = self.passed_over.take() {
            self.publish(simulation, at);
        }
    }

    fn publish(&mut self, simulation: &Simulation, at: At) {
        let send = |field: &str, components: usize, labels: Vec<u32>, values: Vec<f64>| {
            let frame = Frame {
                number: *self.frames_sent,
                sequence: self.sequence,
                step: at.step,
                increment: at.increment,
                time: at.time,
                field: field.to_owned(),
                components: u32::try_from(components).unwrap_or(u32::MAX),
                labels,
                values,
            };
            self.around.frames.send(key::frame(&self.around.daemon, &self.around.session, field), frame);
        };
        let values = outputs(simulation);
        send(OUTPUTS_FRAME, values.len(), Vec::new(), values);
        for name in self.fields {
            // The names were checked before the step began.
            if let Ok(field) = simulation.field(name) {
                send(name, field.components, field.labels, field.values);
            }
        }
    }
}

impl Watch for FrameWatch<'_> {
    fn increment(&mut self, simulation: &Simulation, report: &IncrementReport) {
        self.increments += 1;
        *self.frames_sent += 1;
        let at = At { step: report.step, increment: report.increment, time: report.time };
        let step = &simulation.prepared().model().steps[report.step as usize - 1];
        if matches!(step.procedure, Procedure::Explicit(_)) {
            let now = Instant::now();
            if self.published.is_some_and(|then| now - then < EXPLICIT_FRAME_INTERVAL) {
                self.passed_over = Some(at);
                return;
            }
            self.published = Some(now);
        }
        self.passed_over = None;
        self.publish(simulation, at);
    }

    fn cancelled(&self) -> bool {
        self.increments >= self.increments_max || self.cancelled.load(Ordering::Relaxed)
    }
}

fn outputs(simulation: &Simulation) -> Vec<f64> {
    let mut values = vec![0.0; simulation.prepared().ports().outputs.len()];
    simulation.observe(&mut values);
    values
}

fn by_name(simulation: &Simulation, values: &[InputValue]) -> Result<Vec<(usize, f64)>, Fault> {
    let ports = simulation.prepared().ports();
    values
        .iter()
        .map(|v| ports.input(&v.name).map(|i| (i, v.value)).ok_or_else(|| unknown_port(&v.name, "input port")))
        .collect()
}

fn unknown_port(name: &str, what: &str) -> Fault {
    Fault::new(FaultCode::UnknownPort, format!("no {what} {name:?}; the verb ports lists what there is"))
}

/// Work done in all steps together.
fn total(simulation: &Simulation) -> Counts {
    let mut sum = WorkCounts::default();
    for report in simulation.step_reports() {
        let WorkCounts {
            increments,
            equilibrium_iterations,
            severe_discontinuity_iterations,
            cutbacks,
            factorizations,
            augmentations,
            impacts,
        } = report.counts;
        sum.increments += increments;
        sum.equilibrium_iterations += equilibrium_iterations;
        sum.severe_discontinuity_iterations += severe_discontinuity_iterations;
        sum.cutbacks += cutbacks;
        sum.factorizations += factorizations;
        sum.augmentations += augmentations;
        sum.impacts += impacts;
    }
    convert::counts(&sum)
}

fn difference(before: &Counts, after: &Counts) -> Counts {
    Counts {
        increments: after.increments.saturating_sub(before.increments),
        equilibrium_iterations: after.equilibrium_iterations.saturating_sub(before.equilibrium_iterations),
        severe_discontinuity_iterations: after
            .severe_discontinuity_iterations
            .saturating_sub(before.severe_discontinuity_iterations),
        cutbacks: after.cutbacks.saturating_sub(before.cutbacks),
        factorizations: after.factorizations.saturating_sub(before.factorizations),
        augmentations: after.augmentations.saturating_sub(before.augmentations),
        impacts: after.impacts.saturating_sub(before.impacts),
    }
}

/// Of the request's canonical bytes: the same whether it came as JSON or postcard.
pub fn fingerprint<M: Message>(request: &M) -> Result<u64, Fault> {
    let bytes = codec::encode(request, Format::Postcard)?;
    Ok(BuildHasherDefault::<DefaultHasher>::default().hash_one((M::NAME, bytes)))
}
