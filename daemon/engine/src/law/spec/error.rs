//! What can be wrong with a law in words.

use super::KINDS;
use crate::law::LawError;

/// One thing wrong with a law in words.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LawSpecError {
    /// No such law.
    #[error("unknown law kind {kind:?}; kinds are {}", KINDS.join(", "))]
    UnknownKind {
        /// As given.
        kind: String,
    },
    /// Hard contact is a constraint.
    #[error(
        "hard contact has no pressure-overclosure curve: it allows no overclosure and transmits any pressure; \
         it is a constraint that only a deck can solve. What stands in for it has a curve: penalty, nonlinear-penalty, \
         augmented-lagrange"
    )]
    HardHasNoCurve,
    /// Modified hard contact has a memory.
    #[error(
        "modified hard contact has no pressure-overclosure curve: whether a point is closed depends on its status before \
         (*CONTACT CONTROLS, UERRMX, PERRMX, MAXCHP); it is a constraint that only a deck can solve"
    )]
    ModifiedHardHasNoCurve,
    /// No separation is an option of other kinds.
    #[error("no separation is no law of its own: give separation=prevented with linear, tabular or a penalty")]
    NoSeparationIsAnOption,
    /// Damping where a pressure is asked for.
    #[error("contact damping is a coefficient over the clearance, not a pressure over the overclosure")]
    DampingHasNoPressure,
    /// A name that the law does not have.
    #[error("the {kind} law has no parameter {name:?}; it takes {known}")]
    UnknownParameter {
        /// Kind of law.
        kind: &'static str,
        /// As given.
        name: String,
        /// What there is.
        known: String,
    },
    /// A parameter that the law needs.
    #[error("the {kind} law needs {name}")]
    MissingParameter {
        /// Kind of law.
        kind: &'static str,
        /// Name, with its short name.
        name: String,
    },
    /// The same parameter twice.
    #[error("{name} is given more than once")]
    Repeated {
        /// Name.
        name: &'static str,
    },
    /// Text where a number should be.
    #[error("{name}: {text:?} is not a number")]
    NotANumber {
        /// Name.
        name: &'static str,
        /// As given.
        text: String,
    },
    /// A table that cannot be read.
    #[error("table point {row}: {text:?} is not of the form pressure:overclosure")]
    TablePoint {
        /// Number of the point, from 1.
        row: usize,
        /// As given.
        text: String,
    },
    /// A word that is not among the choices.
    #[error("{name}: {text:?} is neither {choices}")]
    UnknownChoice {
        /// Name.
        name: &'static str,
        /// As given.
        text: String,
        /// What there is.
        choices: &'static str,
    },
    /// A parameter out of its domain.
    #[error(transparent)]
    Law(#[from] LawError),
    /// No separation in Standard.
    #[error(
        "separation=prevented cannot be combined with a softened law in Abaqus/Standard, where it is for hard contact only; \
         procedure=explicit has it for the linear and the tabular law"
    )]
    SeparationPreventedStandard,
    /// No separation with the exponential law.
    #[error(
        "separation=prevented cannot be combined with an exponential law: its curve has no continuation into tension"
    )]
    SeparationPreventedExponential,
    /// A stiffness limit in Standard.
    #[error(
        "stiffness_max belongs to procedure=explicit; Abaqus/Standard limits the slope beyond an overclosure of 6 c0 instead"
    )]
    StiffnessMaxNeedsExplicit,
    /// Augmented Lagrange or a nonlinear penalty in Explicit.
    #[error(
        "augmented Lagrange and the nonlinear penalty belong to Abaqus/Standard; \
         procedure=explicit has the straight penalty (kind penalty)"
    )]
    EnforcementNeedsStandard,
    /// A multiplier that pulls where surfaces may part.
    #[error("multiplier (lambda) {multiplier} pulls: it may be negative with separation=prevented only")]
    MultiplierPulls {
        /// As given.
        multiplier: f64,
    },
}

/// Everything that is wrong with a law in words; never empty. Displayed one per line.
#[derive(Clone, Debug, PartialEq)]
pub struct LawSpecErrors(pub Vec<LawSpecError>);

impl std::fmt::Display for LawSpecErrors {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (i, error) in self.0.iter().enumerate() {
            let separator = if i == 0 { "" } else { "\n" };
            write!(f, "{separator}{error}")?;
        }
        Ok(())
    }
}

impl std::error::Error for LawSpecErrors {}
