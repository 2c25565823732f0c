//! Between engine types and messages. Structs are taken apart without `..`, so that a new field stops the build here.

use overclosure::diagnostic::{self, Diagnostic};
use overclosure::model;
use overclosure::port;
use overclosure::simulation::{
    self, AdvanceError, FieldError, PathChoice, RestoreError, SetError, StepReport, WorkCounts,
};
use overclosure_protocol::fault::{Fault, FaultCode};
use overclosure_protocol::message::{
    Counts, Dialect, Field, Finding, Port, Ports, Quantity, Severity, SolverPath, StepSummary,
};

pub fn dialect(dialect: Dialect) -> model::Dialect {
    match dialect {
        Dialect::Abaqus => model::Dialect::Abaqus,
        Dialect::Calculix => model::Dialect::Calculix,
    }
}

pub fn path(path: SolverPath) -> PathChoice {
    match path {
        SolverPath::Auto => PathChoice::Auto,
        SolverPath::Dense => PathChoice::Dense,
        SolverPath::Sparse => PathChoice::Sparse,
    }
}

pub fn finding(diagnostic: &Diagnostic) -> Finding {
    // A deck that came over the wire is a text without a file.
    let Diagnostic { severity, place: diagnostic::Place { file: _, line }, keyword, message, remedy } = diagnostic;
    let severity = match severity {
        diagnostic::Severity::Warning => Severity::Warning,
        diagnostic::Severity::Error => Severity::Error,
    };
    Finding { severity, line: *line, keyword: keyword.clone(), message: message.clone(), remedy: remedy.clone() }
}

/// A refused deck, with every diagnostic: in the details alone, which every client shows after the message.
pub fn deck_refused(diagnostics: &[Diagnostic]) -> Fault {
    let errors = diagnostics.iter().filter(|d| d.is_error()).count();
    let plural = if errors == 1 { "" } else { "s" };
    let mut fault = Fault::new(FaultCode::DeckRefused, format!("the deck has {errors} error{plural}"));
    fault.details.findings = diagnostics.iter().map(finding).collect();
    fault
}

pub fn ports(list: &port::PortList) -> Ports {
    let port::PortList { inputs, outputs } = list;
    Ports { inputs: inputs.iter().map(port).collect(), outputs: outputs.iter().map(port).collect() }
}

fn port(port: &port::Port) -> Port {
    let port::Port { name, quantity, unit, description } = port;
    Port {
        name: name.clone(),
        quantity: self::quantity(*quantity),
        unit: unit.clone(),
        description: description.clone(),
    }
}

fn quantity(quantity: port::Quantity) -> Quantity {
    match quantity {
        port::Quantity::Length => Quantity::Length,
        port::Quantity::Force => Quantity::Force,
        port::Quantity::Pressure => Quantity::Pressure,
        port::Quantity::Acceleration => Quantity::Acceleration,
        port::Quantity::Area => Quantity::Area,
        port::Quantity::Energy => Quantity::Energy,
        port::Quantity::Time => Quantity::Time,
        port::Quantity::Count => Quantity::Count,
        port::Quantity::Angle => Quantity::Angle,
        port::Quantity::Moment => Quantity::Moment,
        port::Quantity::Velocity => Quantity::Velocity,
        port::Quantity::AngularVelocity => Quantity::AngularVelocity,
        port::Quantity::AngularAcceleration => Quantity::AngularAcceleration,
    }
}

pub fn counts(counts: &WorkCounts) -> Counts {
    let WorkCounts {
        increments,
        equilibrium_iterations,
        severe_discontinuity_iterations,
        cutbacks,
        factorizations,
        augmentations,
        impacts,
    } = *counts;
    Counts {
        increments,
        equilibrium_iterations,
        severe_discontinuity_iterations,
        cutbacks,
        factorizations,
        augmentations,
        impacts,
    }
}

pub fn step_summary(report: &StepReport) -> StepSummary {
    let StepReport { name, procedure, time_reached, counts } = report;
    StepSummary {
        name: name.clone(),
        procedure: (*procedure).to_owned(),
        time_reached: *time_reached,
        counts: self::counts(counts),
    }
}

pub fn field(field: simulation::Field, time: f64) -> Field {
    let simulation::Field { name, labels, components, values } = field;
    Field { name, time, components: u32::try_from(components).unwrap_or(u32::MAX), labels, values }
}

pub fn set_error(error: &SetError) -> Fault {
    let code = match error {
        SetError::UnknownInput { .. } => FaultCode::UnknownPort,
        SetError::NotFinite { .. } => FaultCode::NotFinite,
    };
    Fault::new(code, error.to_string())
}

pub fn advance_error(error: &AdvanceError) -> Fault {
    let code = match error {
        AdvanceError::NotFinite { .. } => FaultCode::NotFinite,
        AdvanceError::Past { .. } => FaultCode::TimeInPast,
    };
    Fault::new(code, error.to_string())
}

pub fn restore_error(error: &RestoreError) -> Fault {
    Fault::new(FaultCode::CheckpointRefused, error.to_string())
}

pub fn field_error(error: &FieldError) -> Fault {
    Fault::new(FaultCode::UnknownField, error.to_string())
}
