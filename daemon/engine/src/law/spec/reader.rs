//! From `name=value` pairs to the numbers of a law.

use super::kind::*;
use super::{DampingSpec, LawSpec, LawSpecError, LawSpecErrors, Relationship, plain};
use crate::law::resolved::findings;
use crate::law::{CurveParameters, LawParameters, LawProcedure, Separation};

/// Collects values by name, then makes the specification of them.
pub(super) struct Reader {
    kind: Kind,
    values: Vec<(Name, String)>,
    errors: Vec<LawSpecError>,
}

impl Reader {
    pub fn new(kind: Kind) -> Self {
        Self { kind, values: Vec::new(), errors: Vec::new() }
    }

    pub fn take(&mut self, name: &str, value: &str) {
        let known = self.kind.parameters();
        match known.iter().find(|n| n.is(name)) {
            None => self.errors.push(LawSpecError::UnknownParameter {
                kind: self.kind.name(),
                name: name.to_owned(),
                known: known.iter().map(|n| n.described()).collect::<Vec<_>>().join(", "),
            }),
            Some(&found) if self.values.iter().any(|(n, _)| *n == found) => {
                self.errors.push(LawSpecError::Repeated { name: found.long });
            }
            Some(&found) => self.values.push((found, value.trim().to_owned())),
        }
    }

    pub fn finish(mut self) -> Result<Relationship, LawSpecErrors> {
        for name in self.kind.parameters().iter().filter(|n| n.required) {
            if self.text(*name).is_none() {
                self.errors.push(LawSpecError::MissingParameter { kind: self.kind.name(), name: name.described() });
            }
        }
        if self.kind == Kind::Damping {
            let damping = self.damping();
            self.errors.extend(damping.iter().flat_map(DampingSpec::violations).map(LawSpecError::Law));
            return match damping {
                Some(damping) if self.errors.is_empty() => Ok(Relationship::Damping(damping)),
                _ => Err(LawSpecErrors(self.errors)),
            };
        }
        let parameters = self.curve();
        let separation = self.choice(
            SEPARATION,
            &[("allowed", Separation::Allowed), ("prevented", Separation::Prevented)],
            "allowed nor prevented",
        );
        let procedure = self.choice(
            PROCEDURE,
            &[("standard", LawProcedure::Standard), ("explicit", LawProcedure::Explicit)],
            "standard nor explicit",
        );
        let Some(parameters) = parameters else {
            return Err(LawSpecErrors(self.errors));
        };
        if !self.errors.is_empty() {
            // What can be said about the numbers that were read is said too.
            self.errors.extend(parameters.violations().into_iter().map(LawSpecError::Law));
            return Err(LawSpecErrors(self.errors));
        }
        let limited =
            matches!(parameters, CurveParameters::Softened(LawParameters::Exponential { stiffness_max: Some(_), .. }));
        let unnamed = if limited { LawProcedure::Explicit } else { LawProcedure::Standard };
        let (separation, procedure) = (separation.unwrap_or_default(), procedure.unwrap_or(unnamed));
        let wrong = findings(&parameters, separation, procedure);
        if wrong.is_empty() {
            Ok(Relationship::Pressure(LawSpec { parameters, separation, procedure }))
        } else {
            Err(LawSpecErrors(wrong))
        }
    }

    fn curve(&mut self) -> Option<CurveParameters> {
        // Every number is read before the first missing one ends the reading, so that all faults are reported.
        Some(match self.kind {
            Kind::Linear => LawParameters::Linear { stiffness: self.number(STIFFNESS)? }.into(),
            Kind::Tabular => LawParameters::Tabular { points: self.table()? }.into(),
            Kind::Exponential => {
                let (c0, p0) = (self.number(CLEARANCE), self.number(PRESSURE));
                let limit = self.optional(STIFFNESS_MAX)?;
                LawParameters::Exponential {
                    clearance_at_zero_pressure: c0?,
                    pressure_at_zero_clearance: p0?,
                    stiffness_max: limit,
                }
                .into()
            }
            Kind::CalculixExponential => {
                let (c0, p0) = (self.number(CALCULIX_CLEARANCE), self.number(CALCULIX_PRESSURE));
                LawParameters::CalculixExponential { clearance: c0?, pressure: p0? }.into()
            }
            Kind::Penalty => {
                let (stiffness, clearance) = (self.number(STIFFNESS), self.optional(PENALTY_CLEARANCE));
                CurveParameters::Penalty { stiffness: stiffness?, clearance: clearance?.unwrap_or(0.0) }
            }
            Kind::NonlinearPenalty => {
                let stiffnesses = (self.number(STIFFNESS_INITIAL), self.number(STIFFNESS_FINAL));
                let lengths = (self.number(LOWER), self.number(UPPER), self.optional(PENALTY_CLEARANCE));
                CurveParameters::NonlinearPenalty {
                    stiffness_initial: stiffnesses.0?,
                    stiffness_final: stiffnesses.1?,
                    lower: lengths.0?,
                    upper: lengths.1?,
                    clearance: lengths.2?.unwrap_or(0.0),
                }
            }
            Kind::AugmentedLagrange => {
                let (stiffness, multiplier) = (self.number(STIFFNESS), self.number(MULTIPLIER));
                let clearance = self.optional(PENALTY_CLEARANCE);
                CurveParameters::AugmentedLagrange {
                    stiffness: stiffness?,
                    multiplier: multiplier?,
                    clearance: clearance?.unwrap_or(0.0),
                }
            }
            Kind::Damping => return None,
        })
    }

    fn damping(&mut self) -> Option<DampingSpec> {
        let (coefficient, clearance) = (self.number(COEFFICIENT), self.number(DAMPING_CLEARANCE));
        let fraction = self.optional(FRACTION)?.unwrap_or(0.0);
        Some(DampingSpec { coefficient: coefficient?, clearance: clearance?, fraction })
    }

    fn text(&self, name: Name) -> Option<&str> {
        self.values.iter().find(|(n, _)| *n == name).map(|(_, text)| text.as_str())
    }

    fn number(&mut self, name: Name) -> Option<f64> {
        let text = self.text(name)?.to_owned();
        let number = text.parse().ok();
        if number.is_none() {
            self.errors.push(LawSpecError::NotANumber { name: name.long, text });
        }
        number
    }

    /// A number that may be absent; none when it is there and cannot be read.
    fn optional(&mut self, name: Name) -> Option<Option<f64>> {
        if self.text(name).is_none() { Some(None) } else { self.number(name).map(Some) }
    }

    /// `p1:h1,p2:h2,...`
    fn table(&mut self) -> Option<Vec<(f64, f64)>> {
        let text = self.text(TABLE)?.to_owned();
        let before = self.errors.len();
        let mut points = Vec::new();
        for (row, pair) in (1..).zip(text.split(',').map(str::trim).filter(|pair| !pair.is_empty())) {
            let point = pair.split_once(':').and_then(|(p, h)| Some((p.trim().parse().ok()?, h.trim().parse().ok()?)));
            match point {
                Some(point) => points.push(point),
                None => self.errors.push(LawSpecError::TablePoint { row, text: pair.to_owned() }),
            }
        }
        (self.errors.len() == before).then_some(points)
    }

    fn choice<T: Copy>(&mut self, name: Name, choices: &[(&str, T)], words: &'static str) -> Option<T> {
        let text = self.text(name)?.to_owned();
        let found = choices.iter().find(|(word, _)| plain(&text) == *word).map(|(_, choice)| *choice);
        if found.is_none() {
            self.errors.push(LawSpecError::UnknownChoice { name: name.long, text, choices: words });
        }
        found
    }
}
