//! The kinds of law and the names of their parameters.

use super::{LawSpecError, plain};

/// Names of the kinds, as [`super::read`] takes them.
pub const KINDS: [&str; 8] = [
    "linear",
    "tabular",
    "exponential",
    "calculix-exponential",
    "penalty",
    "nonlinear-penalty",
    "augmented-lagrange",
    "damping",
];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Linear,
    Tabular,
    Exponential,
    CalculixExponential,
    Penalty,
    NonlinearPenalty,
    AugmentedLagrange,
    Damping,
}

/// A parameter: its name, the manual's short name, and another one that stands in decks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Name {
    pub long: &'static str,
    pub short: &'static str,
    pub other: &'static str,
    pub required: bool,
}

const fn required(long: &'static str, short: &'static str) -> Name {
    Name { long, short, other: long, required: true }
}

const fn optional(long: &'static str, short: &'static str) -> Name {
    Name { long, short, other: long, required: false }
}

impl Name {
    const fn or(self, other: &'static str) -> Self {
        Self { other, ..self }
    }

    pub fn is(self, text: &str) -> bool {
        let key = plain(text);
        [self.long, self.short, self.other].iter().any(|name| key == plain(name))
    }

    /// `clearance_at_zero_pressure (c0)`, optional ones in brackets.
    pub fn described(self) -> String {
        let both =
            if self.long == self.short { self.long.to_owned() } else { format!("{} ({})", self.long, self.short) };
        if self.required { both } else { format!("[{both}]") }
    }
}

pub(super) const SEPARATION: Name = optional("separation", "separation");
pub(super) const PROCEDURE: Name = optional("procedure", "procedure");
pub(super) const STIFFNESS: Name = required("stiffness", "k");
pub(super) const TABLE: Name = required("table", "table");
pub(super) const CLEARANCE: Name = required("clearance_at_zero_pressure", "c0");
pub(super) const PRESSURE: Name = required("pressure_at_zero_clearance", "p0");
pub(super) const STIFFNESS_MAX: Name = optional("stiffness_max", "kmax");
pub(super) const CALCULIX_CLEARANCE: Name = required("clearance", "c0");
pub(super) const CALCULIX_PRESSURE: Name = required("pressure", "p0");
pub(super) const PENALTY_CLEARANCE: Name = optional("clearance_at_zero_pressure", "c0").or("clearance");
pub(super) const STIFFNESS_INITIAL: Name = required("stiffness_initial", "ki").or("initial_stiffness");
pub(super) const STIFFNESS_FINAL: Name = required("stiffness_final", "kf").or("final_stiffness");
pub(super) const LOWER: Name = required("lower", "d");
pub(super) const UPPER: Name = required("upper", "e");
pub(super) const MULTIPLIER: Name = required("multiplier", "lambda");
pub(super) const COEFFICIENT: Name = required("coefficient", "mu0");
pub(super) const DAMPING_CLEARANCE: Name = required("clearance", "c0").or("clearance_at_zero_damping");
pub(super) const FRACTION: Name = optional("fraction", "eta");

impl Kind {
    pub fn parse(text: &str) -> Result<Self, LawSpecError> {
        match plain(text).as_str() {
            "linear" => Ok(Self::Linear),
            "tabular" => Ok(Self::Tabular),
            "exponential" => Ok(Self::Exponential),
            "calculixexponential" => Ok(Self::CalculixExponential),
            "penalty" => Ok(Self::Penalty),
            "nonlinearpenalty" => Ok(Self::NonlinearPenalty),
            "augmentedlagrange" => Ok(Self::AugmentedLagrange),
            "damping" => Ok(Self::Damping),
            "hard" => Err(LawSpecError::HardHasNoCurve),
            "modifiedhard" => Err(LawSpecError::ModifiedHardHasNoCurve),
            "noseparation" => Err(LawSpecError::NoSeparationIsAnOption),
            _ => Err(LawSpecError::UnknownKind { kind: text.to_owned() }),
        }
    }

    pub fn name(self) -> &'static str {
        KINDS[self as usize]
    }

    pub fn parameters(self) -> &'static [Name] {
        match self {
            Self::Linear => &[STIFFNESS, SEPARATION, PROCEDURE],
            Self::Tabular => &[TABLE, SEPARATION, PROCEDURE],
            Self::Exponential => &[CLEARANCE, PRESSURE, STIFFNESS_MAX, SEPARATION, PROCEDURE],
            Self::CalculixExponential => &[CALCULIX_CLEARANCE, CALCULIX_PRESSURE, SEPARATION, PROCEDURE],
            Self::Penalty => &[STIFFNESS, PENALTY_CLEARANCE, SEPARATION, PROCEDURE],
            Self::NonlinearPenalty => {
                &[STIFFNESS_INITIAL, STIFFNESS_FINAL, LOWER, UPPER, PENALTY_CLEARANCE, SEPARATION, PROCEDURE]
            }
            Self::AugmentedLagrange => &[STIFFNESS, MULTIPLIER, PENALTY_CLEARANCE, SEPARATION, PROCEDURE],
            Self::Damping => &[COEFFICIENT, DAMPING_CLEARANCE, FRACTION],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_in_the_list_is_its_own_kind() {
        for (at, name) in KINDS.iter().enumerate() {
            let kind = Kind::parse(name).unwrap();
            assert_eq!((kind as usize, kind.name()), (at, *name));
        }
    }

    #[test]
    fn no_two_parameters_of_a_kind_share_a_name() {
        for kind in KINDS {
            let names = Kind::parse(kind).unwrap().parameters();
            for name in names {
                for text in [name.long, name.short, name.other] {
                    assert_eq!(names.iter().filter(|n| n.is(text)).count(), 1, "{kind}: {text}");
                }
            }
        }
    }
}
