//! Everything that is a curve of pressure over overclosure: the softened laws, and the penalties that stand in for hard
//! contact. What is needed to make one, as plain data.
//!
//! ```text
//! augmented Lagrange  p(h) = max(0, λ + k (h + c0)) = k (h + c0 + λ/k) where that is positive
//! ```
//!
//! * `k` penalty stiffness [pressure/length]; `λ` multiplier \[pressure\], what earlier augmentations have found; `c0` the
//!   clearance at which pressure begins while `λ` is zero \[length\].
//! * Source: Abaqus Analysis User's Manual v6.5, 22.1.2, "The augmented Lagrangian method in ABAQUS/Standard"; the penalties are of
//!   later releases.

use super::error::{require, require_in_range, require_positive};
use super::{LawError, LawParameters, LawPoint, Penalty, PressureLaw, PressureOverclosure};

const CLEARANCE: &str = "clearance_at_zero_pressure (c0)";
const NOT_NEGATIVE: &str = "a finite number, zero or positive";

/// Parameters of a curve, not yet validated.
#[derive(Clone, Debug, PartialEq)]
pub enum CurveParameters {
    /// A softened law.
    Softened(LawParameters),
    /// [`Penalty::linear`].
    Penalty {
        /// `k` [pressure/length], positive.
        stiffness: f64,
        /// `c0` \[length\], not negative.
        clearance: f64,
    },
    /// [`Penalty::nonlinear`].
    NonlinearPenalty {
        /// `Ki` [pressure/length], positive.
        stiffness_initial: f64,
        /// `Kf` [pressure/length], no less than `Ki`.
        stiffness_final: f64,
        /// `d` \[length\], not negative.
        lower: f64,
        /// `e` \[length\], beyond `d`.
        upper: f64,
        /// `c0` \[length\], not negative.
        clearance: f64,
    },
    /// The penalty with the multiplier of an augmentation.
    AugmentedLagrange {
        /// `k` [pressure/length], positive.
        stiffness: f64,
        /// `λ` \[pressure\]; negative only where surfaces may not separate.
        multiplier: f64,
        /// `c0` \[length\], not negative.
        clearance: f64,
    },
}

impl From<LawParameters> for CurveParameters {
    fn from(parameters: LawParameters) -> Self {
        Self::Softened(parameters)
    }
}

/// A curve.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Curve {
    Softened(PressureOverclosure),
    Penalty(Penalty),
}

impl CurveParameters {
    /// Everything that is wrong with the parameters; empty when the curve can be made.
    pub fn violations(&self) -> Vec<LawError> {
        let mut findings = Vec::new();
        match *self {
            Self::Softened(ref parameters) => return parameters.violations(),
            Self::Penalty { stiffness, clearance } => {
                require_positive(&mut findings, "stiffness (k)", stiffness);
                require(&mut findings, CLEARANCE, NOT_NEGATIVE, clearance, clearance >= 0.0);
            }
            Self::NonlinearPenalty { stiffness_initial, stiffness_final, lower, upper, clearance } => {
                require_positive(&mut findings, "stiffness_initial (ki)", stiffness_initial);
                require_positive(&mut findings, "stiffness_final (kf)", stiffness_final);
                let bounds = "a finite number no less than stiffness_initial (ki)";
                let stiffens = findings.is_empty() && stiffness_final < stiffness_initial;
                require(&mut findings, "stiffness_final (kf)", bounds, stiffness_final, !stiffens);
                require(&mut findings, "lower (d)", NOT_NEGATIVE, lower, lower >= 0.0);
                require(&mut findings, "upper (e)", "a finite number beyond lower (d)", upper, upper > lower);
                require(&mut findings, CLEARANCE, NOT_NEGATIVE, clearance, clearance >= 0.0);
                if findings.is_empty() {
                    let end = Penalty::nonlinear(stiffness_initial, stiffness_final, lower, upper, 0.0).evaluate(upper);
                    require_in_range(&mut findings, "nonlinear penalty", "the pressure at upper (e)", end.pressure);
                    let slope = (stiffness_final - stiffness_initial) / (upper - lower);
                    require(&mut findings, "upper (e)", "farther from lower (d)", upper, slope.is_finite());
                }
            }
            Self::AugmentedLagrange { stiffness, multiplier, clearance } => {
                require_positive(&mut findings, "stiffness (k)", stiffness);
                require(&mut findings, "multiplier (lambda)", "a finite number", multiplier, true);
                require(&mut findings, CLEARANCE, NOT_NEGATIVE, clearance, clearance >= 0.0);
                if findings.is_empty() {
                    let shift = multiplier / stiffness;
                    let bounds = "small enough for the stiffness: their quotient is a length";
                    require(&mut findings, "multiplier (lambda)", bounds, multiplier, shift.is_finite());
                }
            }
        }
        findings
    }

    /// The curve, with its onset \[length\] and the slope [pressure/length] with which it begins, if it begins with one.
    /// The first of [`CurveParameters::violations`], if any.
    pub(super) fn curve(&self) -> Result<(Curve, Option<(f64, f64)>), LawError> {
        if let Some(violation) = self.violations().into_iter().next() {
            return Err(violation);
        }
        let penalty = |penalty, clearance: f64, stiffness| (Curve::Penalty(penalty), Some((-clearance, stiffness)));
        Ok(match *self {
            Self::Softened(ref parameters) => {
                let law = PressureOverclosure::try_from(parameters.clone())?;
                let start = match &law {
                    PressureOverclosure::Linear(law) => Some((0.0, law.stiffness())),
                    PressureOverclosure::Tabular(law) => Some((law.onset(), law.stiffness_first())),
                    PressureOverclosure::Exponential(_) | PressureOverclosure::CalculixExponential(_) => None,
                };
                (Curve::Softened(law), start)
            }
            Self::Penalty { stiffness, clearance } => {
                penalty(Penalty::linear(stiffness, clearance), clearance, stiffness)
            }
            Self::NonlinearPenalty { stiffness_initial, stiffness_final, lower, upper, clearance } => penalty(
                Penalty::nonlinear(stiffness_initial, stiffness_final, lower, upper, clearance),
                clearance,
                stiffness_initial,
            ),
            Self::AugmentedLagrange { stiffness, multiplier, clearance } => {
                let reach = clearance + multiplier / stiffness;
                penalty(Penalty::linear(stiffness, reach), reach, stiffness)
            }
        })
    }
}

impl PressureLaw for Curve {
    fn evaluate(&self, overclosure: f64) -> LawPoint {
        match self {
            Self::Softened(law) => law.evaluate(overclosure),
            Self::Penalty(law) => law.evaluate(overclosure),
        }
    }

    fn kinks(&self) -> Vec<f64> {
        match self {
            Self::Softened(law) => law.kinks(),
            Self::Penalty(law) => law.kinks(),
        }
    }

    fn overclosure_at(&self, pressure: f64) -> f64 {
        match self {
            Self::Softened(law) => law.overclosure_at(pressure),
            Self::Penalty(law) => law.overclosure_at(pressure),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::check::{assert_close, assert_finite_everywhere, assert_inverse, check_law};

    fn curve(parameters: CurveParameters) -> Curve {
        parameters.curve().expect("valid parameters").0
    }

    #[test]
    fn a_multiplier_moves_the_onset() {
        let law = curve(CurveParameters::AugmentedLagrange { stiffness: 3000.0, multiplier: 6.0, clearance: 1e-3 });
        for h in [-0.01, -0.0031, -0.0029, 0.0, 0.004] {
            assert_close(law.evaluate(h).pressure, (6.0 + 3000.0 * (h + 1e-3)).max(0.0), 1e-13, 1e-13);
        }
        check_law(&law, &[-0.01, -0.002, 0.0, 0.004], 1e-6);
        assert_inverse(&law, &[-0.0029, 0.0, 0.004], -0.003);
    }

    #[test]
    fn penalties_are_curves_like_the_laws() {
        let nonlinear = CurveParameters::NonlinearPenalty {
            stiffness_initial: 100.0,
            stiffness_final: 1e4,
            lower: 0.01,
            upper: 0.03,
            clearance: 0.005,
        };
        check_law(&curve(nonlinear.clone()), &[-0.01, -0.002, 0.004, 0.015, 0.024, 0.06], 1e-6);
        for parameters in [CurveParameters::Penalty { stiffness: 3e3, clearance: 0.005 }, nonlinear] {
            let law = curve(parameters);
            assert_finite_everywhere(&law);
            assert_inverse(&law, &[-0.002, 0.0, 0.01, 0.02, 0.03, 0.5], -0.005);
        }
    }

    #[test]
    fn every_wrong_number_is_named() {
        let wrong = CurveParameters::NonlinearPenalty {
            stiffness_initial: 0.0,
            stiffness_final: f64::NAN,
            lower: -1.0,
            upper: -2.0,
            clearance: f64::INFINITY,
        };
        let text: Vec<String> = wrong.violations().iter().map(ToString::to_string).collect();
        for name in ["(ki)", "(kf)", "lower (d) must", "upper (e) must", "(c0)"] {
            assert!(text.iter().any(|t| t.contains(name)), "{name} is missing in {text:?}");
        }
        let softening = CurveParameters::NonlinearPenalty {
            stiffness_initial: 2.0,
            stiffness_final: 1.0,
            lower: 0.0,
            upper: 1.0,
            clearance: 0.0,
        };
        assert_eq!(softening.violations().len(), 1);
        let steep = CurveParameters::AugmentedLagrange { stiffness: 1e-300, multiplier: 1e300, clearance: 0.0 };
        assert_eq!(steep.violations().len(), 1);
    }
}
