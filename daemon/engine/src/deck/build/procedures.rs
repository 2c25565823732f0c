//! Procedures of steps: `*STATIC`, `*DYNAMIC`, and which one a step has. Explicit steps are read in `explicit.rs`.

use crate::model::{DynamicControl, HalfIncrement, MassMatrix, Procedure, StaticControl};

use super::super::card::Card;
use super::super::data::Row;
use super::super::lex::real;
use super::super::report::{Report, excerpt};
use super::Builder;
use super::explicit::{EXPLICIT_PARAMETERS, ExplicitHistory};
use super::layout::{Layout, StepCards};

const STEP: &str = "*STEP";
const STATIC: &str = "*STATIC";
const DYNAMIC: &str = "*DYNAMIC";

/// `ALPHA` unless given.
const ALPHA: f64 = -0.05;

/// Part of the largest force so far that the half-increment residual may reach unless the deck says otherwise: the manual calls a
/// residual of a tenth of the typical forces a solution of high accuracy (6.3.2).
const HALF_INCREMENT: f64 = 0.1;

/// Parameters that have a meaning in implicit steps only.
const IMPLICIT_PARAMETERS: [&str; 6] = ["ALPHA", "HAFTOL", "HALFINC SCALE FACTOR", "NOHAF", "INITIAL", "MASS"];

impl Builder<'_> {
    /// Reports steps of Abaqus/Standard and of Abaqus/Explicit in one deck.
    pub(super) fn check_one_product(&mut self, layout: &Layout<'_>) {
        let mut first: Option<&StepCards<'_>> = None;
        for step in &layout.steps {
            let Some(card) = step.cards.iter().find(|card| matches!(card.keyword.name, STATIC | DYNAMIC)) else {
                continue;
            };
            let first = *first.get_or_insert(step);
            if first.is_explicit() != step.is_explicit() {
                let (this, other) = if step.is_explicit() {
                    ("explicit", "implicit or static")
                } else {
                    ("implicit or static", "explicit")
                };
                let message = format!(
                    "the step is {this} and the first one {other}: Abaqus/Standard and Abaqus/Explicit are two products, and the manual \
                     carries results from one to the other by *IMPORT only"
                );
                let remedy = "write a deck for each, or choose one kind of procedure";
                self.report.error(card.at, card.keyword.name, message, remedy);
                return;
            }
        }
    }

    /// Procedure of a step; a stand-in where there is none to be relied on, which is reported.
    pub(super) fn procedure(
        &mut self,
        step: &StepCards<'_>,
        increments_max: u32,
        explicit: &mut ExplicitHistory,
    ) -> Procedure {
        let mut procedures = step.cards.iter().filter(|card| matches!(card.keyword.name, STATIC | DYNAMIC));
        let Some(card) = procedures.next() else {
            if !step.has_refused_keywords() {
                let remedy = "write *STATIC, *DYNAMIC or *DYNAMIC, EXPLICIT behind *STEP";
                self.report.error(step.opening.at, STEP, "the step has no procedure", remedy);
            }
            return Procedure::Static(static_default(false));
        };
        if let Some(second) = procedures.next() {
            let remedy = "begin another *STEP for it";
            self.report.error(second.at, second.keyword.name, "the step has a procedure already", remedy);
        }
        let procedure = match card.keyword.name {
            STATIC => Procedure::Static(static_control(card, self.report)),
            _ if card.parameters.has("EXPLICIT") => {
                return Procedure::Explicit(self.explicit_control(card, step, explicit));
            }
            _ => Procedure::Dynamic(self.dynamic_control(card)),
        };
        if let Some(foreign) =
            step.cards.iter().find(|card| matches!(card.keyword.name, "*BULK VISCOSITY" | "*FIXED MASS SCALING"))
        {
            let message = "the keyword belongs to explicit steps";
            self.report.error(foreign.at, foreign.keyword.name, message, "remove it, or write *DYNAMIC, EXPLICIT");
        }
        if let Some(control) = procedure.implicit_increments() {
            let needed = (control.period / control.increment_initial * (1.0 - 1e-9)).ceil();
            if control.direct && needed > f64::from(increments_max) {
                let message = format!("{needed} fixed increments are needed, and the step allows {increments_max}");
                let remedy = "give *STEP a larger INC, or longer increments";
                self.report.error(card.at, card.keyword.name, message, remedy);
            }
        }
        procedure
    }

    fn dynamic_control(&mut self, card: &Card) -> DynamicControl {
        let direct = card.parameters.has("DIRECT");
        for name in EXPLICIT_PARAMETERS.into_iter().filter(|name| card.parameters.has(name)) {
            let message = format!("{name} belongs to explicit steps");
            self.report.error(card.at, DYNAMIC, message, "remove it, or write *DYNAMIC, EXPLICIT");
        }
        let default_mass = match self.model.dialect {
            crate::model::Dialect::Abaqus => MassMatrix::ByOrder,
            crate::model::Dialect::Calculix => MassMatrix::Consistent,
        };
        let times = implicit_times(card, None, self.report).unwrap_or(static_default(direct));
        DynamicControl {
            increment_initial: times.increment_initial,
            period: times.period,
            increment_min: times.increment_min,
            increment_max: times.increment_max,
            direct,
            alpha: self.alpha(card),
            half_increment: self.half_increment(card),
            initial_accelerations: card.parameters.word("INITIAL") != "NO",
            mass: match card.parameters.word("MASS").as_str() {
                "LUMPED" => MassMatrix::Lumped,
                "CONSISTENT" => MassMatrix::Consistent,
                _ => default_mass,
            },
        }
    }

    /// `ALPHA` of the operator, from -1/3 to 0.
    fn alpha(&mut self, card: &Card) -> f64 {
        let Some(text) = card.parameters.value("ALPHA") else { return ALPHA };
        match real(text.as_bytes()) {
            // -0.3333334 is meant as -1/3.
            Ok(alpha) if (-1.0 / 3.0 - 1e-6..=0.0).contains(&alpha) => alpha.max(-1.0 / 3.0),
            _ => {
                let message = format!("ALPHA={} is not a number from -1/3 to 0", excerpt(text.as_bytes()));
                let remedy = "give 0 for no numerical damping, -0.05 for a little, -1/3 for the most";
                self.report.error(card.at, DYNAMIC, message, remedy);
                ALPHA
            }
        }
    }

    fn half_increment(&mut self, card: &Card) -> HalfIncrement {
        let given: Vec<&str> =
            ["HAFTOL", "HALFINC SCALE FACTOR", "NOHAF"].into_iter().filter(|name| card.parameters.has(name)).collect();
        if let [first, second, ..] = given[..] {
            let message = format!("{first} and {second} both say what bounds the half-increment residual");
            self.report.error(card.at, DYNAMIC, message, "keep one of them");
        }
        match given.first() {
            Some(&"NOHAF") => HalfIncrement::Unchecked,
            Some(&name) => {
                let value = self.positive_parameter(card, name, "give a positive number").unwrap_or(HALF_INCREMENT);
                if name == "HAFTOL" { HalfIncrement::Force(value) } else { HalfIncrement::Relative(value) }
            }
            None => HalfIncrement::Relative(HALF_INCREMENT),
        }
    }

    /// Value of a parameter that is given, when it is a positive number; otherwise it is reported.
    pub(super) fn positive_parameter(&mut self, card: &Card, name: &str, remedy: &str) -> Option<f64> {
        let text = card.parameters.value(name)?;
        match real(text.as_bytes()) {
            Ok(value) if value > 0.0 => Some(value),
            _ => {
                let message = format!("{name}={} is not a positive number", excerpt(text.as_bytes()));
                self.report.error(card.at, card.keyword.name, message, remedy);
                None
            }
        }
    }

    /// Reports parameters that have a meaning in implicit steps only.
    pub(super) fn no_implicit_parameters(&mut self, card: &Card) {
        for name in IMPLICIT_PARAMETERS.into_iter().filter(|name| card.parameters.has(name)) {
            let message = format!("{name} belongs to implicit steps");
            self.report.error(card.at, DYNAMIC, message, "remove it: central differences have no such parameter");
        }
    }
}

fn static_default(direct: bool) -> StaticControl {
    StaticControl { increment_initial: 1.0, period: 1.0, increment_min: 1e-5, increment_max: 1.0, direct }
}

/// The data line of `*STATIC`; without one, or with a faulty one, which is reported, a step of length 1.
fn static_control(card: &Card, report: &mut Report) -> StaticControl {
    let default = static_default(card.parameters.has("DIRECT"));
    if card.first_line().is_none() {
        return default;
    }
    implicit_times(card, Some(1.0), report).unwrap_or(default)
}

/// A data line of first increment, period, smallest and largest increment; blanks and zeros are defaults. The period has one in
/// static steps only: in dynamics time has a unit.
fn implicit_times(card: &Card, period_default: Option<f64>, report: &mut Report) -> Option<StaticControl> {
    const LINE: &str = "write one line: increment, period, smallest, largest";
    let keyword = card.keyword.name;
    let direct = card.parameters.has("DIRECT");
    if let Some(second) = card.lines().get(1) {
        report.error(second.at, keyword, "a second data line is not read here", LINE);
    }
    let Some(row) = card.first_line().map(|line| line.row(keyword)) else {
        report.error(card.at, keyword, "the data line is missing", LINE);
        return None;
    };
    row.at_most(4, report);
    let mut items = [0.0; 4];
    for (i, what) in ["initial increment", "period", "smallest increment", "largest increment"].into_iter().enumerate()
    {
        match row.real(i, what, Some(0.0), report) {
            Some(value) if value >= 0.0 => items[i] = value,
            Some(value) => {
                report.error(row.at, keyword, format!("{what} {value} is negative"), "times are positive");
                return None;
            }
            None => return None,
        }
    }
    let [initial, period, smallest, largest] = items;
    let or = |value: f64, default: f64| if value == 0.0 { default } else { value };
    let period = match period_default {
        Some(default) => or(period, default),
        None if period == 0.0 => {
            let message = "the step has no period: its length would be zero";
            report.error(row.at, keyword, message, "give the length of the step as the second item");
            return None;
        }
        None => period,
    };
    let increment_max = or(largest, period);
    let increment_initial = or(initial, period.min(increment_max));
    let increment_min = or(smallest, (1e-5 * period).min(increment_initial));
    let control = StaticControl { increment_initial, period, increment_min, increment_max, direct };
    check_control(&control, &row, report);
    Some(control)
}

fn check_control(control: &StaticControl, row: &Row<'_>, report: &mut Report) {
    let StaticControl { increment_initial: initial, period, increment_min, increment_max, direct } = *control;
    let mut order =
        |what: &str| report.error(row.at, row.keyword, what, "write: increment, period, smallest, largest increment");
    if initial > period {
        order(&format!("the initial increment {initial} is longer than the period {period}"));
    }
    if !direct && increment_min > initial {
        order(&format!("the smallest increment {increment_min} is longer than the initial one {initial}"));
    }
    if !direct && increment_max < initial {
        order(&format!("the largest increment {increment_max} is shorter than the initial one {initial}"));
    }
}
