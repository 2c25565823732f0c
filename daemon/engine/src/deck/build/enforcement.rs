//! How hard contact is enforced: `DIRECT`, `AUGMENTED LAGRANGE` and `PENALTY` of `*SURFACE BEHAVIOR`, with their data lines.

use crate::model::{Enforcement, LinearPenalty, NonlinearPenalty};

use super::super::card::Card;
use super::super::data::Row;
use super::super::facts::Law;
use super::Builder;

const BEHAVIOR: &str = "*SURFACE BEHAVIOR";

/// What `*SURFACE BEHAVIOR` asks for, sound or not.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AskedNormal {
    /// The law; none: hard.
    pub softened: Option<Law>,
    /// `AUGMENTED LAGRANGE`.
    pub augmented: bool,
    /// `PENALTY`.
    pub penalty: bool,
    /// `NO SEPARATION`.
    pub no_separation: bool,
    /// First point of a table as written: pressure, overclosure.
    pub table_start: Option<(f64, f64)>,
}

impl AskedNormal {
    /// Hard contact that may separate, enforced by multipliers.
    pub fn is_plain_hard(self) -> bool {
        self == Self::default()
    }
}

impl Builder<'_> {
    /// Enforcement of a hard interaction; `None` when the card is wrong about it, which is reported.
    pub(super) fn enforcement(&mut self, card: &Card, asked: AskedNormal) -> Option<Enforcement> {
        let given: Vec<&str> = ["DIRECT", "AUGMENTED LAGRANGE", "PENALTY"]
            .into_iter()
            .filter(|parameter| card.parameters.has(parameter))
            .collect();
        if let [first, second, ..] = given[..] {
            let message = format!("{first} and {second} are two ways to enforce contact");
            self.report.error(card.at, BEHAVIOR, message, "keep one of them");
            return None;
        }
        let nonlinear = card.parameters.word("PENALTY") == "NONLINEAR";
        let (items, what) = match (asked.augmented || asked.penalty, nonlinear) {
            (false, _) => {
                let Some(line) = card.first_line() else { return Some(Enforcement::Lagrange) };
                if card.faulty {
                    return None; // The line may belong to what was refused.
                }
                self.report.error(
                    line.at,
                    BEHAVIOR,
                    "hard contact takes no data line",
                    "remove the line, or choose a law with PRESSURE-OVERCLOSURE=, AUGMENTED LAGRANGE or PENALTY",
                );
                return None;
            }
            (true, false) => (3, "penalty stiffness, clearance at zero pressure, scale factor"),
            (true, true) => (
                6,
                "final stiffness, clearance at zero pressure, scale factor, upper limit of the quadratic range, initial over final \
                 stiffness, lower over upper limit",
            ),
        };
        let row = match card.first_line() {
            Some(_) => Some(card.single_row(what, self.report)?),
            None => None,
        };
        if let Some(row) = &row {
            row.at_most(items, self.report);
        }
        let mut line = PenaltyLine { builder: self, row, what, sound: true };
        let enforcement = if nonlinear {
            let default = NonlinearPenalty::default();
            Enforcement::NonlinearPenalty(NonlinearPenalty {
                stiffness_final: line.optional(0, "final stiffness"),
                clearance: line.not_negative(1, "clearance at zero pressure", default.clearance),
                scale: line.positive(2, "scale factor", default.scale),
                upper_limit: line.positive(3, "upper limit of the quadratic range", default.upper_limit),
                stiffness_ratio: line
                    .within(4, "initial over final stiffness", default.stiffness_ratio, |x| x > 0.0 && x <= 1.0),
                lower_ratio: line.within(5, "lower over upper limit", default.lower_ratio, |x| (0.0..1.0).contains(&x)),
            })
        } else {
            let default = LinearPenalty::default();
            let penalty = LinearPenalty {
                stiffness: line.optional(0, "penalty stiffness"),
                clearance: line.not_negative(1, "clearance at zero pressure", default.clearance),
                scale: line.positive(2, "scale factor", default.scale),
            };
            if asked.augmented { Enforcement::AugmentedLagrange(penalty) } else { Enforcement::Penalty(penalty) }
        };
        line.sound.then_some(enforcement)
    }
}

/// Items of a data line that have ranges; what is outside of them is reported.
struct PenaltyLine<'b, 'r, 'd> {
    builder: &'b mut Builder<'r>,
    row: Option<Row<'d>>,
    what: &'static str,
    sound: bool,
}

impl PenaltyLine<'_, '_, '_> {
    /// Positive, or blank: automatic.
    fn optional(&mut self, index: usize, what: &str) -> Option<f64> {
        let blank = self.row.as_ref().is_none_or(|row| row.text(index).is_empty());
        (!blank).then(|| self.positive(index, what, 1.0))
    }

    fn positive(&mut self, index: usize, what: &str, default: f64) -> f64 {
        self.checked(index, what, default, "is not positive", |x| x > 0.0)
    }

    fn not_negative(&mut self, index: usize, what: &str, default: f64) -> f64 {
        self.checked(index, what, default, "is negative", |x| x >= 0.0)
    }

    fn within(&mut self, index: usize, what: &str, default: f64, is_sound: impl Fn(f64) -> bool) -> f64 {
        self.checked(index, what, default, "is not between 0 and 1", is_sound)
    }

    fn checked(&mut self, index: usize, what: &str, default: f64, fault: &str, is_sound: impl Fn(f64) -> bool) -> f64 {
        let Some(row) = &self.row else { return default };
        match row.real(index, what, Some(default), self.builder.report) {
            Some(value) if is_sound(value) => value,
            Some(value) => {
                let message = format!("{what} {value} {fault}");
                let remedy = format!("correct the data line: {}; blank items are automatic", self.what);
                self.builder.report.error(row.at, BEHAVIOR, message, remedy);
                self.sound = false;
                default
            }
            None => {
                self.sound = false;
                default
            }
        }
    }
}
