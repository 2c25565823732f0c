//! The call-order table: which function may be called in which phase of an instance's life.

use serde::{Deserialize, Serialize};

/// Where an instance is in its life.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// After `fmi2Instantiate` or `fmi2Reset`.
    Instantiated,
    /// Between `fmi2EnterInitializationMode` and `fmi2ExitInitializationMode`.
    Initialization,
    /// At a communication point.
    StepComplete,
    /// The solver stopped. Values may be read; a saved state or a reset brings the instance back.
    StepFailed,
    /// After `fmi2Terminate`.
    Terminated,
    /// After a defect of ours: only `fmi2FreeInstance` is left.
    Fatal,
}

impl Phase {
    /// Name for messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Instantiated => "instantiated",
            Self::Initialization => "in initialization mode",
            Self::StepComplete => "at a communication point",
            Self::StepFailed => "after a failed step",
            Self::Terminated => "terminated",
            Self::Fatal => "unusable after an internal error",
        }
    }
}

/// Functions that act on an instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Call {
    SetDebugLogging,
    SetupExperiment,
    EnterInitializationMode,
    ExitInitializationMode,
    Terminate,
    Reset,
    GetReal,
    GetInteger,
    GetBoolean,
    GetString,
    SetReal,
    SetInteger,
    SetBoolean,
    SetString,
    GetFmuState,
    SetFmuState,
    FreeFmuState,
    SerializedFmuStateSize,
    SerializeFmuState,
    DeSerializeFmuState,
    GetDirectionalDerivative,
    SetRealInputDerivatives,
    GetRealOutputDerivatives,
    DoStep,
    CancelStep,
    GetStatus,
    GetRealStatus,
    GetIntegerStatus,
    GetBooleanStatus,
    GetStringStatus,
}

impl Call {
    /// Every call, in the order of the standard.
    pub const ALL: [Call; 30] = [
        Call::SetDebugLogging,
        Call::SetupExperiment,
        Call::EnterInitializationMode,
        Call::ExitInitializationMode,
        Call::Terminate,
        Call::Reset,
        Call::GetReal,
        Call::GetInteger,
        Call::GetBoolean,
        Call::GetString,
        Call::SetReal,
        Call::SetInteger,
        Call::SetBoolean,
        Call::SetString,
        Call::GetFmuState,
        Call::SetFmuState,
        Call::FreeFmuState,
        Call::SerializedFmuStateSize,
        Call::SerializeFmuState,
        Call::DeSerializeFmuState,
        Call::GetDirectionalDerivative,
        Call::SetRealInputDerivatives,
        Call::GetRealOutputDerivatives,
        Call::DoStep,
        Call::CancelStep,
        Call::GetStatus,
        Call::GetRealStatus,
        Call::GetIntegerStatus,
        Call::GetBooleanStatus,
        Call::GetStringStatus,
    ];

    /// Name of the C function.
    pub fn name(self) -> &'static str {
        match self {
            Call::SetDebugLogging => "fmi2SetDebugLogging",
            Call::SetupExperiment => "fmi2SetupExperiment",
            Call::EnterInitializationMode => "fmi2EnterInitializationMode",
            Call::ExitInitializationMode => "fmi2ExitInitializationMode",
            Call::Terminate => "fmi2Terminate",
            Call::Reset => "fmi2Reset",
            Call::GetReal => "fmi2GetReal",
            Call::GetInteger => "fmi2GetInteger",
            Call::GetBoolean => "fmi2GetBoolean",
            Call::GetString => "fmi2GetString",
            Call::SetReal => "fmi2SetReal",
            Call::SetInteger => "fmi2SetInteger",
            Call::SetBoolean => "fmi2SetBoolean",
            Call::SetString => "fmi2SetString",
            Call::GetFmuState => "fmi2GetFMUstate",
            Call::SetFmuState => "fmi2SetFMUstate",
            Call::FreeFmuState => "fmi2FreeFMUstate",
            Call::SerializedFmuStateSize => "fmi2SerializedFMUstateSize",
            Call::SerializeFmuState => "fmi2SerializeFMUstate",
            Call::DeSerializeFmuState => "fmi2DeSerializeFMUstate",
            Call::GetDirectionalDerivative => "fmi2GetDirectionalDerivative",
            Call::SetRealInputDerivatives => "fmi2SetRealInputDerivatives",
            Call::GetRealOutputDerivatives => "fmi2GetRealOutputDerivatives",
            Call::DoStep => "fmi2DoStep",
            Call::CancelStep => "fmi2CancelStep",
            Call::GetStatus => "fmi2GetStatus",
            Call::GetRealStatus => "fmi2GetRealStatus",
            Call::GetIntegerStatus => "fmi2GetIntegerStatus",
            Call::GetBooleanStatus => "fmi2GetBooleanStatus",
            Call::GetStringStatus => "fmi2GetStringStatus",
        }
    }

    /// Whether the standard allows this call in a phase (FMI 2.0, section 4.2.4, table of calling sequences).
    pub fn allowed_in(self, phase: Phase) -> bool {
        use Phase::*;
        let phases: &[Phase] = match self {
            Call::SetDebugLogging
            | Call::Reset
            | Call::GetFmuState
            | Call::SetFmuState
            | Call::FreeFmuState
            | Call::SerializedFmuStateSize
            | Call::SerializeFmuState
            | Call::DeSerializeFmuState => &[Instantiated, Initialization, StepComplete, StepFailed, Terminated],
            Call::SetupExperiment | Call::EnterInitializationMode => &[Instantiated],
            Call::ExitInitializationMode => &[Initialization],
            Call::Terminate => &[StepComplete, StepFailed],
            Call::GetReal | Call::GetInteger | Call::GetBoolean | Call::GetString | Call::GetDirectionalDerivative => {
                &[Initialization, StepComplete, StepFailed, Terminated]
            }
            Call::SetReal | Call::SetInteger | Call::SetBoolean | Call::SetString | Call::SetRealInputDerivatives => {
                &[Instantiated, Initialization, StepComplete]
            }
            Call::GetRealOutputDerivatives
            | Call::GetStatus
            | Call::GetRealStatus
            | Call::GetIntegerStatus
            | Call::GetBooleanStatus
            | Call::GetStringStatus => &[StepComplete, StepFailed, Terminated],
            Call::DoStep => &[StepComplete],
            // Steps are never asynchronous, so there is never one to cancel.
            Call::CancelStep => &[],
        };
        phases.contains(&phase)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_allowed_after_a_fatal_error() {
        assert!(Call::ALL.iter().all(|call| !call.allowed_in(Phase::Fatal)));
    }

    #[test]
    fn a_step_is_allowed_at_communication_points_only() {
        for phase in [Phase::Instantiated, Phase::Initialization, Phase::StepFailed, Phase::Terminated] {
            assert!(!Call::DoStep.allowed_in(phase), "{phase:?}");
        }
        assert!(Call::DoStep.allowed_in(Phase::StepComplete));
    }

    #[test]
    fn a_failed_instance_can_be_brought_back() {
        assert!(Call::SetFmuState.allowed_in(Phase::StepFailed));
        assert!(Call::Reset.allowed_in(Phase::StepFailed));
    }
}
