//! `*DYNAMIC, EXPLICIT` with `*BULK VISCOSITY` and `*FIXED MASS SCALING`.

use crate::model::{Dialect, ExplicitControl, ExplicitIncrements, MassScaling, MassScalingKind, SetId};

use super::super::card::Card;
use super::super::data::Row;
use super::super::lex::real;
use super::super::report::excerpt;
use super::Builder;
use super::layout::{Layout, StepCards};

const DYNAMIC: &str = "*DYNAMIC";
const BULK_VISCOSITY: &str = "*BULK VISCOSITY";
const MASS_SCALING: &str = "*FIXED MASS SCALING";

/// Linear and quadratic bulk viscosity unless given.
const VISCOSITY: [f64; 2] = [0.06, 1.2];

/// Parameters of `*DYNAMIC` that have a meaning in explicit steps only.
pub const EXPLICIT_PARAMETERS: [&str; 2] = ["DIRECT USER CONTROL", "SCALE FACTOR"];

/// What explicit steps so far have left to the next one.
pub struct ExplicitHistory {
    bulk_viscosity: [f64; 2],
    mass_scaling: Vec<MassScaling>,
}

impl Builder<'_> {
    /// Before the first step.
    pub(super) fn explicit_defaults(&mut self, layout: &Layout<'_>) -> ExplicitHistory {
        let mut history = ExplicitHistory { bulk_viscosity: VISCOSITY, mass_scaling: Vec::new() };
        for card in layout.model.iter().filter(|card| card.keyword.name == BULK_VISCOSITY) {
            if !layout.is_explicit() {
                let remedy = "remove it, or write *DYNAMIC, EXPLICIT";
                self.report.error(card.at, BULK_VISCOSITY, "the keyword belongs to explicit steps", remedy);
            }
            self.bulk_viscosity(card, &mut history);
        }
        history
    }

    /// Procedure of an explicit step.
    pub(super) fn explicit_control(
        &mut self,
        card: &Card,
        step: &StepCards<'_>,
        history: &mut ExplicitHistory,
    ) -> ExplicitControl {
        if self.model.dialect == Dialect::Calculix {
            let message = "explicit steps of CalculiX are not solved";
            let remedy = "write *DYNAMIC, or read the deck in the dialect abaqus";
            self.report.error(card.at, DYNAMIC, message, remedy);
        }
        self.no_implicit_parameters(card);
        let direct = ["DIRECT USER CONTROL", "DIRECT"].into_iter().find(|name| card.parameters.has(name));
        let scale = self.scale_factor(card);
        if let (Some(direct), true) = (direct, card.parameters.has("SCALE FACTOR")) {
            let message = format!("SCALE FACTOR has no effect with {direct}: increments are as long as the line says");
            self.report.error(card.at, DYNAMIC, message, "keep one of them");
        }
        let mut control = ExplicitControl {
            period: 1.0,
            increments: ExplicitIncrements::Automatic { scale },
            increment_max: None,
            bulk_viscosity: VISCOSITY,
            mass_scaling: Vec::new(),
        };
        let what = if direct.is_some() { "increment, period" } else { "blank, period, blank, largest increment" };
        if let Some(row) = card.single_row(what, self.report) {
            self.explicit_times(&row, direct.is_some(), &mut control);
        }
        let mut scalings = Vec::new();
        for card in &step.cards {
            match card.keyword.name {
                BULK_VISCOSITY => self.bulk_viscosity(card, history),
                MASS_SCALING => self.mass_scaling(card, &mut scalings),
                _ => {}
            }
        }
        if !scalings.is_empty() {
            history.mass_scaling = scalings;
        }
        control.bulk_viscosity = history.bulk_viscosity;
        control.mass_scaling.clone_from(&history.mass_scaling);
        control
    }

    fn scale_factor(&mut self, card: &Card) -> f64 {
        let Some(text) = card.parameters.value("SCALE FACTOR") else { return 1.0 };
        match real(text.as_bytes()) {
            Ok(scale) if scale > 0.0 && scale <= 1.0 => scale,
            _ => {
                let message = format!("SCALE FACTOR={} is not above 0 and at most 1", excerpt(text.as_bytes()));
                let remedy = "increments above the stable one grow without bounds: give a part of it";
                self.report.error(card.at, DYNAMIC, message, remedy);
                1.0
            }
        }
    }

    /// The data line: increment (with `DIRECT USER CONTROL`), period, blank, largest increment.
    fn explicit_times(&mut self, row: &Row<'_>, direct: bool, control: &mut ExplicitControl) {
        row.at_most(if direct { 2 } else { 4 }, self.report);
        if let Some(period) = self.time(row, 1, "period") {
            control.period = period;
        }
        if direct {
            let Some(size) = self.time(row, 0, "increment") else { return };
            if size > control.period {
                let message = format!("the increment {size} is longer than the period {}", control.period);
                self.report.error(row.at, DYNAMIC, message, "write: increment, period");
            }
            control.increments = ExplicitIncrements::Direct(size);
            return;
        }
        for index in [0, 2] {
            if row.real(index, "blank item", Some(0.0), self.report).is_some_and(|value| value != 0.0) {
                let message =
                    format!("item {} is {}, and increments are chosen automatically", index + 1, row.text(index));
                let remedy = "write: blank, period, blank, largest increment; or add DIRECT USER CONTROL and write: increment, period";
                self.report.error(row.at, DYNAMIC, message, remedy);
            }
        }
        match row.real(3, "largest increment", Some(0.0), self.report) {
            None | Some(0.0) => {}
            Some(largest) if largest > 0.0 => control.increment_max = Some(largest),
            Some(largest) => {
                let message = format!("largest increment {largest} is negative");
                self.report.error(row.at, DYNAMIC, message, "times are positive");
            }
        }
    }

    fn time(&mut self, row: &Row<'_>, index: usize, what: &str) -> Option<f64> {
        let value = row.real(index, what, None, self.report)?;
        if value > 0.0 {
            return Some(value);
        }
        let message = format!("{what} {value} is not positive");
        let remedy = if index == 1 { "give the length of the step as the second item" } else { "times are positive" };
        self.report.error(row.at, row.keyword, message, remedy);
        None
    }

    fn bulk_viscosity(&mut self, card: &Card, history: &mut ExplicitHistory) {
        let Some(row) = card.single_row("linear, quadratic bulk viscosity", self.report) else { return };
        row.at_most(2, self.report);
        for (index, what) in ["linear bulk viscosity", "quadratic bulk viscosity"].into_iter().enumerate() {
            match row.real(index, what, Some(history.bulk_viscosity[index]), self.report) {
                Some(value) if value >= 0.0 => history.bulk_viscosity[index] = value,
                Some(value) => {
                    let message = format!("{what} {value} is negative");
                    self.report.error(
                        row.at,
                        BULK_VISCOSITY,
                        message,
                        "give numbers from 0 on; 0.06 and 1.2 are usual",
                    );
                }
                None => {}
            }
        }
    }

    fn mass_scaling(&mut self, card: &Card, scalings: &mut Vec<MassScaling>) {
        let element_set = match card.parameters.value("ELSET") {
            None => None,
            Some(name) => match self.element_sets.refer(name, card.at, MASS_SCALING, self.report) {
                Some(set) => Some(SetId(set)),
                None => return,
            },
        };
        let factor = self.positive_parameter(card, "FACTOR", "give the factor on the masses");
        let increment = self.positive_parameter(card, "DT", "give the stable increment to reach");
        if !card.parameters.has("FACTOR") && !card.parameters.has("DT") && !card.faulty {
            let message = "one of FACTOR and DT says how much masses are scaled";
            self.report.error(card.at, MASS_SCALING, message, "give one of them, or both");
        }
        if card.parameters.has("TYPE") && !card.parameters.has("DT") {
            let message = "TYPE says how elements reach DT, which is not given";
            self.report.error(card.at, MASS_SCALING, message, "give DT, or remove TYPE");
        }
        let by_increment = increment.map(|dt| match card.parameters.word("TYPE").as_str() {
            "BELOWMIN" => MassScalingKind::BelowMin(dt),
            "SETEQUALDT" => MassScalingKind::SetEqual(dt),
            _ => MassScalingKind::Uniform(dt),
        });
        let kinds = factor.map(MassScalingKind::Factor).into_iter().chain(by_increment);
        scalings.extend(kinds.map(|kind| MassScaling { element_set, kind }));
    }
}
