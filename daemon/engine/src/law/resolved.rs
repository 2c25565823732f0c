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
//!   hard contact only; Abaqus/Explicit for the linear and the tabular law, not for the exponential law.

use serde::{Deserialize, Serialize};

use super::{LawPoint, LawSpecError, PressureLaw, PressureOverclosure, straight};

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
    law: PressureOverclosure,
    separation: Separation,
    /// Onset and first slope of the extension into tension.
    extension: Option<(f64, f64)>,
}

impl ResolvedLaw {
    /// Refuses the combinations that the manual refuses.
    pub fn new(
        law: PressureOverclosure,
        separation: Separation,
        procedure: LawProcedure,
    ) -> Result<Self, LawSpecError> {
        if let Some(refusal) = refusal(&law, separation, procedure) {
            return Err(refusal);
        }
        let extension = match (separation, &law) {
            (Separation::Allowed, _) => None,
            (Separation::Prevented, PressureOverclosure::Linear(law)) => Some((0.0, law.stiffness())),
            (Separation::Prevented, PressureOverclosure::Tabular(law)) => Some((law.onset(), law.stiffness_first())),
            (
                Separation::Prevented,
                PressureOverclosure::Exponential(_) | PressureOverclosure::CalculixExponential(_),
            ) => return Err(LawSpecError::SeparationPreventedExponential),
        };
        Ok(Self { law, separation, extension })
    }

    /// The law without its extension.
    pub fn law(&self) -> &PressureOverclosure {
        &self.law
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
            Some(_) | None => self.law.evaluate(overclosure),
        }
    }

    fn kinks(&self) -> Vec<f64> {
        let mut kinks = self.law.kinks();
        if let Some((onset, _)) = self.extension {
            kinks.retain(|&k| k != onset);
        }
        kinks
    }

    fn overclosure_at(&self, pressure: f64) -> f64 {
        match self.extension {
            Some((onset, stiffness)) if pressure <= 0.0 => super::saturate(onset + pressure / stiffness),
            Some(_) | None => self.law.overclosure_at(pressure),
        }
    }
}

/// What the manual refuses about a combination, if anything.
pub(super) fn refusal(
    law: &PressureOverclosure,
    separation: Separation,
    procedure: LawProcedure,
) -> Option<LawSpecError> {
    let exponential = match law {
        PressureOverclosure::Linear(_) | PressureOverclosure::Tabular(_) => false,
        PressureOverclosure::CalculixExponential(_) => true,
        PressureOverclosure::Exponential(law) => {
            if law.stiffness_max().is_some() && procedure == LawProcedure::Standard {
                return Some(LawSpecError::StiffnessMaxNeedsExplicit);
            }
            true
        }
    };
    match (separation, procedure) {
        (Separation::Allowed, _) => None,
        (Separation::Prevented, _) if exponential => Some(LawSpecError::SeparationPreventedExponential),
        (Separation::Prevented, LawProcedure::Standard) => Some(LawSpecError::SeparationPreventedStandard),
        (Separation::Prevented, LawProcedure::Explicit) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::check::{assert_close, check_law};
    use crate::law::{Exponential, Linear, Tabular};

    fn tension(law: PressureOverclosure) -> ResolvedLaw {
        ResolvedLaw::new(law, Separation::Prevented, LawProcedure::Explicit).unwrap()
    }

    #[test]
    fn tension_goes_on_with_the_first_slope() {
        let law = tension(PressureOverclosure::Tabular(Tabular::new(&[(0.0, -0.1), (2.0, 0.1), (9.0, 0.2)]).unwrap()));
        assert_close(law.evaluate(-0.3).pressure, -2.0, 1e-14, 0.0);
        assert_close(law.evaluate(-0.3).energy, 0.2, 1e-14, 0.0);
        check_law(&law, &[-0.4, -0.1, 0.0, 0.15, 0.4], 1e-4);
        assert_close(law.overclosure_at(-2.0), -0.3, 1e-14, 0.0);
        let law = tension(PressureOverclosure::Linear(Linear::new(250.0).unwrap()));
        check_law(&law, &[-0.4, 0.0, 0.4], 1e-4);
        assert!(law.kinks().is_empty());
        let far = law.evaluate(-1e308);
        assert!(far.pressure == -f64::MAX && far.energy == f64::MAX, "{far:?}");
    }

    #[test]
    fn refused_combinations_say_why() {
        let linear = PressureOverclosure::Linear(Linear::new(1.0).unwrap());
        let exponential = PressureOverclosure::Exponential(Exponential::new(1.0, 1.0).unwrap());
        let limited = PressureOverclosure::Exponential(Exponential::with_stiffness_max(1.0, 1.0, 9.0).unwrap());
        use {LawProcedure::*, Separation::*};
        for (law, separation, procedure, expected) in [
            (&linear, Prevented, Standard, Some(LawSpecError::SeparationPreventedStandard)),
            (&linear, Prevented, Explicit, None),
            (&linear, Allowed, Standard, None),
            (&exponential, Prevented, Standard, Some(LawSpecError::SeparationPreventedExponential)),
            (&exponential, Prevented, Explicit, Some(LawSpecError::SeparationPreventedExponential)),
            (&limited, Allowed, Standard, Some(LawSpecError::StiffnessMaxNeedsExplicit)),
            (&limited, Allowed, Explicit, None),
        ] {
            assert_eq!(ResolvedLaw::new(law.clone(), separation, procedure).err(), expected);
        }
    }

    #[test]
    fn a_batch_is_the_single_evaluations() {
        let law = tension(PressureOverclosure::Linear(Linear::new(250.0).unwrap()));
        let overclosures = [-0.1, 0.0, 0.02];
        let mut points = [LawPoint::default(); 3];
        law.evaluate_into(&overclosures, &mut points);
        assert_eq!(points, overclosures.map(|h| law.evaluate(h)));
    }
}
