//! One instance of the FMU: phase, clock, values, saved states, log. Safe code; the C functions are a thin shell around it.

use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::backend::Backend;
use crate::lifecycle::{Call, Phase};
use crate::log::Log;
use crate::snapshot::{self, Clock, Head};
use crate::status::{Fault, Status};
use crate::variables::{Slot, Values, Variable};

/// How far the importer's communication point may be off, relative to the time itself (rounding of its clock) …
const POINT_TOLERANCE_TIME: f64 = 1e-12;
/// … and relative to the step it asks for (clocks that count in nanoseconds).
const POINT_TOLERANCE_STEP: f64 = 1e-6;

/// Numbers of saved states are unique in the process, so that a state of another instance is never mistaken for one's own.
static NEXT_STATE: AtomicUsize = AtomicUsize::new(1);

/// A value that came from the importer.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// For a Real.
    Real(f64),
    /// For an Integer or an enumeration.
    Integer(i32),
    /// For a String.
    String(String),
}

/// An instance.
pub struct Instance {
    guid: String,
    phase: Phase,
    clock: Clock,
    log: Log,
    backend: Box<dyn Backend>,
    values: Values,
    /// During initialisation: outputs are behind the inputs.
    stale: bool,
    states: HashMap<usize, Vec<u8>>,
}

impl Instance {
    /// A new instance of the FMU with this GUID.
    pub fn new(guid: String, backend: Box<dyn Backend>, log: Log) -> Self {
        let values = backend.table().start_values();
        Self {
            guid,
            phase: Phase::Instantiated,
            clock: Clock::default(),
            log,
            backend,
            values,
            stale: true,
            states: HashMap::new(),
        }
    }

    /// Where the instance is in its life.
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// The log.
    pub fn log(&self) -> &Log {
        &self.log
    }

    /// Logs why a call is not possible now.
    pub fn refuse_order(&self, call: Call) -> Status {
        self.log.error(|| format!("{}: not allowed {}", call.name(), self.phase.name()));
        if self.phase == Phase::Fatal { Status::Fatal } else { Status::Error }
    }

    /// Logs a reason and refuses.
    pub fn refuse(&self, call: Call, reason: impl std::fmt::Display) -> Status {
        self.log.error(|| format!("{}: {reason}", call.name()));
        Status::Error
    }

    /// An internal error was caught: the instance is of no more use.
    pub fn condemn(&mut self, call: Call, what: &str) -> Status {
        self.phase = Phase::Fatal;
        self.log.fatal(|| format!("{}: internal error: {what}; free this instance", call.name()));
        Status::Fatal
    }

    /// `fmi2SetDebugLogging`.
    pub fn set_debug_logging(&mut self, on: bool, categories: &[String]) -> Status {
        let unknown = self.log.configure(on, categories);
        if unknown.is_empty() {
            return Status::Ok;
        }
        self.log.warning(|| {
            let known: Vec<&str> = crate::log::CATEGORIES.iter().map(|(name, _)| *name).collect();
            format!("no log category {}: there are {}", unknown.join(", "), known.join(", "))
        });
        Status::Warning
    }

    /// `fmi2SetupExperiment`.
    pub fn setup_experiment(&mut self, start: f64, stop: Option<f64>) -> Status {
        let call = Call::SetupExperiment;
        if !start.is_finite() {
            return self.refuse(call, format!("start time {start} is not a finite number"));
        }
        match stop {
            Some(stop) if !stop.is_finite() => {
                return self.refuse(call, format!("stop time {stop} is not a finite number"));
            }
            Some(stop) if stop < start => {
                return self.refuse(call, format!("stop time {stop} lies before the start time {start}"));
            }
            _ => {}
        }
        self.clock = Clock { start, stop, now: start, reached: start };
        Status::Ok
    }

    /// `fmi2EnterInitializationMode`: runs what comes before the first communication point.
    pub fn enter_initialization(&mut self) -> Status {
        match self.backend.begin(&mut self.values) {
            Ok(()) => {
                self.phase = Phase::Initialization;
                self.stale = true;
                self.log.event(|| format!("initialisation begins at time {}", self.clock.start));
                Status::Ok
            }
            Err(fault) => self.fail(Call::EnterInitializationMode, fault),
        }
    }

    /// `fmi2ExitInitializationMode`. Parameters that do not fit together are refused here.
    pub fn exit_initialization(&mut self) -> Status {
        match self.catch_up() {
            Ok(()) => {
                self.phase = Phase::StepComplete;
                Status::Ok
            }
            Err(fault) => self.fail(Call::ExitInitializationMode, fault),
        }
    }

    /// `fmi2Terminate`.
    pub fn terminate(&mut self) -> Status {
        self.phase = Phase::Terminated;
        Status::Ok
    }

    /// `fmi2Reset`. Saved states stay valid.
    pub fn reset(&mut self) -> Status {
        self.backend.reset();
        self.values = self.backend.table().start_values();
        self.clock = Clock::default();
        self.stale = true;
        self.phase = Phase::Instantiated;
        Status::Ok
    }

    /// `fmi2DoStep`.
    pub fn do_step(&mut self, point: f64, step: f64) -> Status {
        let call = Call::DoStep;
        if !point.is_finite() || !step.is_finite() {
            return self.refuse(call, format!("communication point {point} and step {step} must be finite numbers"));
        }
        if step < 0.0 {
            return self.refuse(call, format!("step {step} is negative; set a saved state to go back"));
        }
        let now = self.clock.now;
        let scale = POINT_TOLERANCE_TIME * point.abs().max(now.abs());
        if (point - now).abs() > scale + POINT_TOLERANCE_STEP * step {
            return self.refuse(call, format!("communication point {point} is not the present time {now}"));
        }
        let end = point + step;
        if let Some(stop) = self.clock.stop.filter(|stop| end > stop + scale + POINT_TOLERANCE_STEP * step) {
            return self.refuse(call, format!("the step ends at {end}, beyond the stop time {stop}"));
        }
        match self.backend.step(end - self.clock.start, &mut self.values) {
            Ok(()) => {
                self.clock.now = end;
                self.clock.reached = end;
                self.log.event(|| format!("step of {step} to time {end}"));
                Status::Ok
            }
            Err(fault) => self.fail(call, fault),
        }
    }

    /// Values for `fmi2GetReal`.
    pub fn get_real(&mut self, references: &[u32], out: &mut [f64]) -> Status {
        self.get(Call::GetReal, references, out, |values, slot| match slot {
            Slot::Real(at) => Some(values.reals[at]),
            _ => None,
        })
    }

    /// Values for `fmi2GetInteger`.
    pub fn get_integer(&mut self, references: &[u32], out: &mut [i32]) -> Status {
        self.get(Call::GetInteger, references, out, |values, slot| match slot {
            Slot::Integer(at) => Some(values.integers[at]),
            _ => None,
        })
    }

    /// Values for `fmi2GetString`.
    pub fn get_string(&mut self, references: &[u32], out: &mut [String]) -> Status {
        self.get(Call::GetString, references, out, |values, slot| match slot {
            Slot::String(at) => Some(values.strings[at].clone()),
            _ => None,
        })
    }

    /// `fmi2GetBoolean` and `fmi2SetBoolean`: no FMU of ours has a Boolean variable.
    pub fn no_boolean(&self, call: Call, references: &[u32]) -> Status {
        match references.first() {
            None => Status::Ok,
            Some(reference) => self.refuse(call, format!("no Boolean variable has value reference {reference}")),
        }
    }

    /// Takes values for `fmi2SetReal`, `fmi2SetInteger` or `fmi2SetString`: all of them or, on an error, none.
    pub fn set(&mut self, call: Call, entries: impl Iterator<Item = (u32, Value)> + Clone) -> Status {
        for (reference, value) in entries.clone() {
            if let Err(reason) = self.check(call, reference, &value) {
                return self.refuse(call, reason);
            }
        }
        let immediate = self.phase == Phase::StepComplete && self.backend.feeds_through();
        let mut before = Vec::new();
        for (reference, value) in entries {
            let Some(previous) = self.replace(reference, value) else { continue };
            if immediate {
                before.push((reference, previous));
            }
            self.backend.note_set(reference as usize);
        }
        self.stale = true;
        if !immediate {
            return Status::Ok;
        }
        match self.backend.refresh(&mut self.values) {
            Ok(()) => Status::Ok,
            Err(fault) => {
                // Backwards, so that a variable that was set twice gets its first value again.
                for (reference, previous) in before.into_iter().rev() {
                    self.replace(reference, previous);
                }
                self.refuse(call, format!("{fault}; the previous values are kept"))
            }
        }
    }

    /// `fmi2GetFMUstate`: saves the present state, into the given handle if it is one. Returns the handle.
    pub fn save_state(&mut self, handle: Option<usize>) -> Result<usize, Status> {
        let call = Call::GetFmuState;
        let handle = match handle {
            Some(handle) if self.states.contains_key(&handle) => handle,
            Some(_) => return Err(self.refuse_state(call)),
            None => NEXT_STATE.fetch_add(1, Ordering::Relaxed),
        };
        let head = Head { guid: self.guid.clone(), phase: self.phase, clock: self.clock, values: self.values.clone() };
        let bytes = snapshot::encode(&head, &self.backend.save()).map_err(|error| self.refuse(call, error))?;
        self.states.insert(handle, bytes);
        Ok(handle)
    }

    /// `fmi2SetFMUstate`. On an error nothing has changed.
    pub fn load_state(&mut self, handle: usize) -> Status {
        let call = Call::SetFmuState;
        let Some(bytes) = self.states.get(&handle) else {
            return self.refuse_state(call);
        };
        let restored =
            snapshot::decode(bytes, &self.guid).map_err(|error| error.to_string()).and_then(|(head, rest)| {
                if self.backend.table().fits(&head.values) {
                    self.backend.restore(rest, &head.values).map(|()| head)
                } else {
                    Err("saved state has other variables".into())
                }
            });
        match restored {
            Ok(head) => {
                self.phase = head.phase;
                self.clock = head.clock;
                self.values = head.values;
                self.stale = true;
                self.log.event(|| format!("returned to the state of time {}", self.clock.now));
                Status::Ok
            }
            Err(reason) => self.refuse(call, reason),
        }
    }

    /// `fmi2FreeFMUstate`.
    pub fn free_state(&mut self, handle: usize) -> Status {
        match self.states.remove(&handle) {
            Some(_) => Status::Ok,
            None => self.refuse_state(Call::FreeFmuState),
        }
    }

    /// Bytes for `fmi2SerializedFMUstateSize` and `fmi2SerializeFMUstate`.
    pub fn serialized_state(&self, call: Call, handle: usize) -> Result<&[u8], Status> {
        self.states.get(&handle).map(Vec::as_slice).ok_or_else(|| self.refuse_state(call))
    }

    /// `fmi2DeSerializeFMUstate`: checks the bytes and gives them a handle, the given one if it is one.
    pub fn deserialize_state(&mut self, bytes: &[u8], handle: Option<usize>) -> Result<usize, Status> {
        let call = Call::DeSerializeFmuState;
        if let Err(error) = snapshot::decode(bytes, &self.guid) {
            return Err(self.refuse(call, error));
        }
        let handle = match handle {
            Some(handle) if self.states.contains_key(&handle) => handle,
            Some(_) => return Err(self.refuse_state(call)),
            None => NEXT_STATE.fetch_add(1, Ordering::Relaxed),
        };
        self.states.insert(handle, bytes.to_vec());
        Ok(handle)
    }

    /// `fmi2GetRealStatus(fmi2LastSuccessfulTime)`.
    pub fn last_successful_time(&self) -> f64 {
        self.clock.reached
    }

    /// `fmi2GetStatus(fmi2DoStepStatus)`: what the last step returned.
    pub fn last_step_status(&self) -> Status {
        if self.phase == Phase::StepFailed { Status::Error } else { Status::Ok }
    }

    fn refuse_state(&self, call: Call) -> Status {
        self.refuse(call, "the state does not belong to this instance, or was freed")
    }

    fn fail(&mut self, call: Call, fault: Fault) -> Status {
        match fault {
            Fault::Refused(reason) => self.refuse(call, reason),
            Fault::Failed { reason, elapsed } => {
                self.phase = Phase::StepFailed;
                self.clock.reached = self.clock.start + elapsed;
                let reached = self.clock.reached;
                self.refuse(
                    call,
                    format!("{reason}; the solution stands at time {reached}; set a saved state or reset to go on"),
                )
            }
        }
    }

    /// During initialisation outputs are computed when somebody looks, not at every set.
    fn catch_up(&mut self) -> Result<(), Fault> {
        if self.phase == Phase::Initialization && self.stale {
            self.backend.refresh(&mut self.values)?;
            self.stale = false;
        }
        Ok(())
    }

    fn get<T>(
        &mut self,
        call: Call,
        references: &[u32],
        out: &mut [T],
        read: impl Fn(&Values, Slot) -> Option<T>,
    ) -> Status {
        if let Err(fault) = self.catch_up() {
            return self.fail(call, fault);
        }
        for (reference, out) in references.iter().zip(out) {
            match self.backend.table().slot(*reference).and_then(|slot| read(&self.values, slot)) {
                Some(value) => *out = value,
                None => return self.refuse(call, unknown(call, *reference)),
            }
        }
        Status::Ok
    }

    /// Puts a value into its slot and returns what was there.
    fn replace(&mut self, reference: u32, value: Value) -> Option<Value> {
        let values = &mut self.values;
        match (self.backend.table().slot(reference)?, value) {
            (Slot::Real(at), Value::Real(value)) => Some(Value::Real(std::mem::replace(&mut values.reals[at], value))),
            (Slot::Integer(at), Value::Integer(value)) => {
                Some(Value::Integer(std::mem::replace(&mut values.integers[at], value)))
            }
            (Slot::String(at), Value::String(value)) => {
                Some(Value::String(std::mem::replace(&mut values.strings[at], value)))
            }
            _ => None,
        }
    }

    fn check(&self, call: Call, reference: u32, value: &Value) -> Result<(), String> {
        let (variable, slot) = self.backend.table().look_up(reference).ok_or_else(|| unknown(call, reference))?;
        let fits = match (slot, value) {
            (Slot::Real(_), Value::Real(value)) => check_real(variable, *value),
            (Slot::Integer(_), Value::Integer(value)) => variable.check_integer(*value),
            (Slot::String(_), Value::String(_)) => Ok(()),
            _ => Err(unknown(call, reference)),
        };
        fits?;
        if variable.settable_in(self.phase) {
            Ok(())
        } else {
            Err(format!("{} cannot be set: it is computed", variable.name))
        }
    }
}

fn check_real(variable: &Variable, value: f64) -> Result<(), String> {
    if value.is_finite() { Ok(()) } else { Err(format!("{}: {value} is not a finite number", variable.name)) }
}

fn unknown(call: Call, reference: u32) -> String {
    let kind = call.name().trim_start_matches("fmi2Get").trim_start_matches("fmi2Set");
    format!("no {kind} variable has value reference {reference}")
}
