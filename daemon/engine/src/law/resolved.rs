//! A law together with what happens when the surfaces are pulled apart.
//!
//! ```text
//! separation allowed:    p(h) of the law
//! separation prevented:  p(h) of the law for h >= h_1,  s_1 (h - h_1) below
//! ```
//!
//! * `h_1` \[length\] is the overclosure of zero pressure, `s_1` [pressure/length] the slope that begins there. The pressure
//!   below `h_1` is negative: tension. This is the law of a point that has closed before; until then an open point
//!   transmits nothing.
//! * Kinks: those of the law, less `h_1` when separation is prevented.
//! * Source: Abaqus Analysis User's Manual v6.5, 22.1.2, "Using the no separation relationship". Abaqus/Standard has it for
//!   hard contact only, so for the penalties that stand in for it; Abaqus/Explicit for the linear and the tabular law too, not
//!   for the exponential law. That a penalty goes on with its first slope is our rule; the manual says nothing of it.

use serde::{Deserialize, Serialize};

use super::curve::{Curve, CurveParameters};
use super::{LawParameters, LawPoint, LawSpecError, LawSpecErrors, PressureLaw, straight};

/// Whether surfaces that have closed may open again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Separation {
    /// They may.
    #[default]
    Allowed,
    /// They may not: the law goes on into tension.
    Prevented,
}

/// Which family of procedures the law is meant for: the manual's rules differ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LawProcedure {
    /// Abaqus/Standard: statics and implicit dynamics.
    #[default]
    Standard,
    /// Abaqus/Explicit.
    Explicit,
}

/// A law and its separation behaviour, checked against each other.
#[derive(Clone, Debug, PartialEq)]
pub struct ResolvedLaw {
    curve: Curve,
    separation: Separation,
    /// Onset and first slope of the extension into tension.
    extension: Option<(f64, f64)>,
}

impl ResolvedLaw {
    /// Refuses parameters out of their domain and the combinations that the manual refuses; every finding at once.
    pub fn new(
        parameters: &CurveParameters,
        separation: Separation,
        procedure: LawProcedure,
    ) -> Result<Self, LawSpecErrors> {
        let findings = findings(parameters, separation, procedure);
        if !findings.is_empty() {
            return Err(LawSpecErrors(findings));
        }
        let (curve, start) = parameters.curve().map_err(|error| LawSpecErrors(vec![error.into()]))?;
        let extension = match separation {
            Separation::Allowed => None,
            Separation::Prevented => start,
        };
        Ok(Self { curve, separation, extension })
    }

    /// What was asked for.
    pub fn separation(&self) -> Separation {
        self.separation
    }

    /// Evaluates many overclosures. Both slices have one entry per overclosure; panics if their lengths differ.
    pub fn evaluate_into(&self, overclosures: &[f64], points: &mut [LawPoint]) {
        assert_eq!(overclosures.len(), points.len(), "one result per overclosure");
        for (point, &h) in points.iter_mut().zip(overclosures) {
            *point = self.evaluate(h);
        }
    }
}

impl PressureLaw for ResolvedLaw {
    fn evaluate(&self, overclosure: f64) -> LawPoint {
        match self.extension {
            Some((onset, stiffness)) if overclosure <= onset => {
                straight((overclosure - onset).max(-f64::MAX), 0.0, stiffness, 0.0)
            }
            Some(_) | None => self.curve.evaluate(overclosure),
        }
    }

    fn kinks(&self) -> Vec<f64> {
        let mut kinks = self.curve.kinks();
        if let Some((onset, _)) = self.extension {
            kinks.retain(|&k| k != onset);
        }
        kinks
    }

    fn overclosure_at(&self, pressure: f64) -> f64 {
        match self.extension {
            Some((onset, stiffness)) if pressure <= 0.0 => super::saturate(onset + pressure / stiffness),
            Some(_) | None => self.curve.overclosure_at(pressure),
        }
    }
}

/// What is wrong with the numbers and with the combination.
pub(super) fn findings(
    parameters: &CurveParameters,
    separation: Separation,
    procedure: LawProcedure,
) -> Vec<LawSpecError> {
    use {LawProcedure::*, Separation::*};
    let mut findings: Vec<LawSpecError> = parameters.violations().into_iter().map(LawSpecError::Law).collect();
    match *parameters {
        CurveParameters::Softened(LawParameters::Exponential { stiffness_max, .. }) => {
            if stiffness_max.is_some() && procedure == Standard {
                findings.push(LawSpecError::StiffnessMaxNeedsExplicit);
            }
            if separation == Prevented {
                findings.push(LawSpecError::SeparationPreventedExponential);
            }
        }
        CurveParameters::Softened(LawParameters::CalculixExponential { .. }) => {
            if separation == Prevented {
                findings.push(LawSpecError::SeparationPreventedExponential);
            }
        }
        CurveParameters::Softened(LawParameters::Linear { .. } | LawParameters::Tabular { .. }) => {
            if separation == Prevented && procedure == Standard {
                findings.push(LawSpecError::SeparationPreventedStandard);
            }
        }
        CurveParameters::Penalty { .. } => {}
        CurveParameters::NonlinearPenalty { .. } | CurveParameters::AugmentedLagrange { .. } => {
            if procedure == Explicit {
                findings.push(LawSpecError::EnforcementNeedsStandard);
            }
        }
    }
    if let CurveParameters::AugmentedLagrange { multiplier, .. } = *parameters
        && multiplier < 0.0
        && separation == Allowed
    {
        findings.push(LawSpecError::MultiplierPulls { multiplier });
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::LawError;
    use crate::law::check::{assert_close, check_law};

    fn tension(law: impl Into<CurveParameters>) -> ResolvedLaw {
        ResolvedLaw::new(&law.into(), Separation::Prevented, LawProcedure::Explicit).unwrap()
    }

    #[test]
    fn tension_goes_on_with_the_first_slope() {
        let law = tension(LawParameters::Tabular { points: vec![(0.0, -0.1), (2.0, 0.1), (9.0, 0.2)] });
        assert_close(law.evaluate(-0.3).pressure, -2.0, 1e-14, 0.0);
        assert_close(law.evaluate(-0.3).energy, 0.2, 1e-14, 0.0);
        check_law(&law, &[-0.4, -0.1, 0.0, 0.15, 0.4], 1e-4);
        assert_close(law.overclosure_at(-2.0), -0.3, 1e-14, 0.0);
        let law = tension(LawParameters::Linear { stiffness: 250.0 });
        check_law(&law, &[-0.4, 0.0, 0.4], 1e-4);
        assert!(law.kinks().is_empty());
        let far = law.evaluate(-1e308);
        assert!(far.pressure == -f64::MAX && far.energy == f64::MAX, "{far:?}");
    }

    #[test]
    fn penalties_pull_with_their_first_slope() {
        let nonlinear = CurveParameters::NonlinearPenalty {
            stiffness_initial: 100.0,
            stiffness_final: 1e4,
            lower: 0.01,
            upper: 0.03,
            clearance: 0.005,
        };
        let law = ResolvedLaw::new(&nonlinear, Separation::Prevented, LawProcedure::Standard).unwrap();
        assert_close(law.evaluate(-0.025).pressure, -2.0, 1e-14, 0.0);
        assert_close(law.overclosure_at(-2.0), -0.025, 1e-14, 0.0);
        check_law(&law, &[-0.3, -0.005, 0.004, 0.015, 0.06], 1e-6);
        let pulled = CurveParameters::AugmentedLagrange { stiffness: 3000.0, multiplier: -6.0, clearance: 0.0 };
        let law = ResolvedLaw::new(&pulled, Separation::Prevented, LawProcedure::Standard).unwrap();
        assert_close(law.evaluate(0.0).pressure, -6.0, 1e-14, 0.0);
        assert!(law.kinks().is_empty());
    }

    #[test]
    fn a_table_without_a_point_of_zero_pressure_is_refused_whatever_separation_is() {
        let table = LawParameters::Tabular { points: vec![(1.0, 0.0), (2.0, 0.1)] }.into();
        for separation in [Separation::Allowed, Separation::Prevented] {
            let errors = ResolvedLaw::new(&table, separation, LawProcedure::Explicit).unwrap_err();
            assert!(matches!(errors.0[..], [LawSpecError::Law(LawError::FirstPressureNotZero { .. })]), "{errors}");
        }
    }

    #[test]
    fn refused_combinations_say_why() {
        let linear = LawParameters::Linear { stiffness: 1.0 }.into();
        let exponential = |stiffness_max| {
            CurveParameters::from(LawParameters::Exponential {
                clearance_at_zero_pressure: 1.0,
                pressure_at_zero_clearance: 1.0,
                stiffness_max,
            })
        };
        let calculix = LawParameters::CalculixExponential { clearance: 1.0, pressure: 1.0 }.into();
        let penalty = CurveParameters::Penalty { stiffness: 1.0, clearance: 0.0 };
        let augmented = |multiplier| CurveParameters::AugmentedLagrange { stiffness: 1.0, multiplier, clearance: 0.0 };
        use LawSpecError::*;
        use {LawProcedure::*, Separation::*};
        for (law, separation, procedure, expected) in [
            (&linear, Prevented, Standard, vec![SeparationPreventedStandard]),
            (&linear, Prevented, Explicit, vec![]),
            (&linear, Allowed, Standard, vec![]),
            (&exponential(None), Prevented, Standard, vec![SeparationPreventedExponential]),
            (&exponential(None), Prevented, Explicit, vec![SeparationPreventedExponential]),
            (&calculix, Prevented, Explicit, vec![SeparationPreventedExponential]),
            (&exponential(Some(9.0)), Allowed, Standard, vec![StiffnessMaxNeedsExplicit]),
            (
                &exponential(Some(9.0)),
                Prevented,
                Standard,
                vec![StiffnessMaxNeedsExplicit, SeparationPreventedExponential],
            ),
            (&exponential(Some(9.0)), Allowed, Explicit, vec![]),
            (&penalty, Prevented, Standard, vec![]),
            (&penalty, Allowed, Explicit, vec![]),
            (&augmented(1.0), Allowed, Explicit, vec![EnforcementNeedsStandard]),
            (&augmented(-1.0), Allowed, Standard, vec![MultiplierPulls { multiplier: -1.0 }]),
            (&augmented(-1.0), Prevented, Standard, vec![]),
        ] {
            let found = ResolvedLaw::new(law, separation, procedure).err().map_or(Vec::new(), |errors| errors.0);
            assert_eq!(found, expected, "{law:?} {separation:?} {procedure:?}");
        }
    }

    #[test]
    fn a_batch_is_the_single_evaluations() {
        let law = tension(LawParameters::Linear { stiffness: 250.0 });
        let overclosures = [-0.1, 0.0, 0.02];
        let mut points = [LawPoint::default(); 3];
        law.evaluate_into(&overclosures, &mut points);
        assert_eq!(points, overclosures.map(|h| law.evaluate(h)));
    }
}
