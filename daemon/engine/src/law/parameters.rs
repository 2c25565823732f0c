//! The numbers behind a law, as plain data: what is written to a file or a wire and validated when read.

use serde::{Deserialize, Serialize};

use super::{
    CalculixExponential, Exponential, LawError, Linear, PressureOverclosure, Tabular, calculix_exponential,
    exponential, linear, tabular,
};

/// Parameters of a law, not yet validated; `PressureOverclosure::try_from` makes the law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LawParameters {
    /// [`Linear`].
    Linear {
        /// [pressure/length], positive.
        stiffness: f64,
    },
    /// [`Tabular`].
    Tabular {
        /// (pressure, overclosure), both increasing, the first pressure 0.
        points: Vec<(f64, f64)>,
    },
    /// [`Exponential`].
    Exponential {
        /// c0 \[length\], positive.
        clearance_at_zero_pressure: f64,
        /// p0 \[pressure\], positive.
        pressure_at_zero_clearance: f64,
        /// Limit of the slope [pressure/length], positive; Abaqus/Explicit only.
        stiffness_max: Option<f64>,
    },
    /// [`CalculixExponential`].
    CalculixExponential {
        /// c0 \[length\], positive.
        clearance: f64,
        /// p0 \[pressure\], positive.
        pressure: f64,
    },
}

impl LawParameters {
    /// Everything that is wrong with the parameters; empty when the law can be made.
    pub fn violations(&self) -> Vec<LawError> {
        match self {
            Self::Linear { stiffness } => linear::violations(*stiffness),
            Self::Tabular { points } => tabular::violations(points),
            Self::Exponential { clearance_at_zero_pressure, pressure_at_zero_clearance, stiffness_max } => {
                exponential::violations(*clearance_at_zero_pressure, *pressure_at_zero_clearance, *stiffness_max)
            }
            Self::CalculixExponential { clearance, pressure } => {
                calculix_exponential::violations(*clearance, *pressure)
            }
        }
    }
}

impl TryFrom<LawParameters> for PressureOverclosure {
    type Error = LawError;

    /// The first of [`LawParameters::violations`], if any.
    fn try_from(parameters: LawParameters) -> Result<Self, LawError> {
        Ok(match parameters {
            LawParameters::Linear { stiffness } => Self::Linear(Linear::new(stiffness)?),
            LawParameters::Tabular { points } => Self::Tabular(Tabular::new(&points)?),
            LawParameters::Exponential { clearance_at_zero_pressure, pressure_at_zero_clearance, stiffness_max } => {
                Self::Exponential(Exponential::build(
                    clearance_at_zero_pressure,
                    pressure_at_zero_clearance,
                    stiffness_max,
                )?)
            }
            LawParameters::CalculixExponential { clearance, pressure } => {
                Self::CalculixExponential(CalculixExponential::new(clearance, pressure)?)
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laws() -> Vec<PressureOverclosure> {
        vec![
            PressureOverclosure::Linear(Linear::new(250.0).unwrap()),
            PressureOverclosure::Tabular(Tabular::new(&[(0.0, -0.1), (2.0, 0.3)]).unwrap()),
            PressureOverclosure::Exponential(Exponential::new(0.01, 5.0).unwrap()),
            PressureOverclosure::Exponential(Exponential::with_stiffness_max(0.01, 5.0, 2e4).unwrap()),
            PressureOverclosure::CalculixExponential(CalculixExponential::new(0.01, 5.0).unwrap()),
        ]
    }

    #[test]
    fn every_law_survives_json_and_postcard() {
        for law in laws() {
            let json = serde_json::to_string(&law).unwrap();
            assert_eq!(serde_json::from_str::<PressureOverclosure>(&json).unwrap(), law, "{json}");
            let bytes = postcard::to_stdvec(&law).unwrap();
            assert_eq!(postcard::from_bytes::<PressureOverclosure>(&bytes).unwrap(), law);
        }
    }

    #[test]
    fn a_serialised_law_is_validated_when_read() {
        let error = serde_json::from_str::<PressureOverclosure>(r#"{"linear":{"stiffness":-1.0}}"#).unwrap_err();
        assert!(error.to_string().contains("stiffness (slope k) must be a positive finite number, not -1"), "{error}");
        let error = serde_json::from_str::<PressureOverclosure>(r#"{"tabular":{"points":[[0,0]]}}"#).unwrap_err();
        assert!(error.to_string().contains("at least two points"), "{error}");
    }
}
