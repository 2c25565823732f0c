//! Pressure-overclosure relationships: what pressure a given overclosure transmits. Imports nothing of the engine.
//!
//! Every law takes the overclosure `h` \[length\], positive when the bodies overlap, and returns a pressure
//! \[pressure\], positive in compression. For a node-based secondary surface without an area the same curves are
//! read as force \[force\] over overclosure.
//!
//! A law is finite for every finite overclosure: where a value would exceed the largest `f64` it saturates there
//! ([`LawPoint::pressure`], `stiffness` and `energy` each on its own).

mod calculix_exponential;
mod curve;
mod damping;
mod error;
mod exponential;
mod linear;
mod parameters;
mod penalty;
mod resolved;
mod spec;
mod tabular;

#[cfg(test)]
mod cases;
#[cfg(test)]
pub(crate) mod check;

pub use calculix_exponential::CalculixExponential;
pub use curve::CurveParameters;
pub use damping::Damping;
pub use error::LawError;
pub use exponential::Exponential;
pub use linear::Linear;
pub use parameters::LawParameters;
pub use penalty::Penalty;
pub use resolved::{LawProcedure, ResolvedLaw, Separation};
pub use spec::{DampingSpec, KINDS, LawSpec, LawSpecError, LawSpecErrors, Relationship, read};
pub use tabular::Tabular;

use serde::{Deserialize, Serialize};

/// Pressure, its slope and its integral at one overclosure.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LawPoint {
    /// Contact pressure \[pressure\]; positive pushes the bodies apart.
    pub pressure: f64,
    /// dp/dh [pressure/length].
    pub stiffness: f64,
    /// Integral of the pressure from separation up to `h` \[pressure*length\].
    pub energy: f64,
}

/// A softened normal law. Pure: no state, no allocation in `evaluate`, defined for every finite `h`.
pub trait PressureLaw {
    /// Pressure, slope and energy at an overclosure \[length\]. Finite for every finite argument, NaN for NaN.
    fn evaluate(&self, overclosure: f64) -> LawPoint;

    /// Overclosures at which the slope is discontinuous, ascending.
    fn kinks(&self) -> Vec<f64>;

    /// Largest overclosure \[length\] at which the law transmits no more than `pressure`: the inverse of the curve
    /// where it rises, and its onset for every pressure that is not positive.
    fn overclosure_at(&self, pressure: f64) -> f64;
}

/// Normal behaviour of an interaction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum NormalBehavior {
    /// No overclosure, no tension; enforced exactly by multipliers.
    Hard,
    /// A softened law.
    Softened(PressureOverclosure),
}

/// The softened laws. Serialised as [`LawParameters`] and validated again when read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "LawParameters", into = "LawParameters")]
pub enum PressureOverclosure {
    /// Pressure proportional to the overclosure.
    Linear(Linear),
    /// Piecewise linear.
    Tabular(Tabular),
    /// The exponential curve of the Abaqus manual.
    Exponential(Exponential),
    /// The exponential curve of CalculiX.
    CalculixExponential(CalculixExponential),
}

impl PressureOverclosure {
    /// Whether pressure is piecewise linear in overclosure, so that one solve per set of segments is exact.
    pub fn is_piecewise_linear(&self) -> bool {
        match self {
            Self::Linear(_) | Self::Tabular(_) => true,
            Self::Exponential(_) | Self::CalculixExponential(_) => false,
        }
    }

    /// The numbers from which this law was made.
    pub fn parameters(&self) -> LawParameters {
        match self {
            Self::Linear(law) => LawParameters::Linear { stiffness: law.stiffness() },
            Self::Tabular(law) => LawParameters::Tabular { points: law.points() },
            Self::Exponential(law) => LawParameters::Exponential {
                clearance_at_zero_pressure: law.clearance_at_zero_pressure(),
                pressure_at_zero_clearance: law.pressure_at_zero_clearance(),
                stiffness_max: law.stiffness_max(),
            },
            Self::CalculixExponential(law) => {
                LawParameters::CalculixExponential { clearance: law.clearance(), pressure: law.pressure() }
            }
        }
    }
}

impl PressureLaw for PressureOverclosure {
    fn evaluate(&self, overclosure: f64) -> LawPoint {
        match self {
            Self::Linear(law) => law.evaluate(overclosure),
            Self::Tabular(law) => law.evaluate(overclosure),
            Self::Exponential(law) => law.evaluate(overclosure),
            Self::CalculixExponential(law) => law.evaluate(overclosure),
        }
    }

    fn kinks(&self) -> Vec<f64> {
        match self {
            Self::Linear(law) => law.kinks(),
            Self::Tabular(law) => law.kinks(),
            Self::Exponential(law) => law.kinks(),
            Self::CalculixExponential(law) => law.kinks(),
        }
    }

    fn overclosure_at(&self, pressure: f64) -> f64 {
        match self {
            Self::Linear(law) => law.overclosure_at(pressure),
            Self::Tabular(law) => law.overclosure_at(pressure),
            Self::Exponential(law) => law.overclosure_at(pressure),
            Self::CalculixExponential(law) => law.overclosure_at(pressure),
        }
    }
}

impl From<PressureOverclosure> for LawParameters {
    fn from(law: PressureOverclosure) -> Self {
        law.parameters()
    }
}

/// The straight line `p = pressure + stiffness * distance` and the energy under it, saturated at the largest `f64`.
/// `distance` is measured from where the line begins, where the energy is `energy`.
fn straight(distance: f64, pressure: f64, stiffness: f64, energy: f64) -> LawPoint {
    LawPoint {
        pressure: saturate(pressure + stiffness * distance),
        stiffness,
        // (s d) d and not s (d d): the square of a tiny distance may vanish where the product does not.
        energy: saturate(energy + (pressure * distance + 0.5 * (stiffness * distance) * distance)),
    }
}

/// The value, or the largest number of its sign; NaN stays NaN.
fn saturate(value: f64) -> f64 {
    value.clamp(-f64::MAX, f64::MAX)
}
