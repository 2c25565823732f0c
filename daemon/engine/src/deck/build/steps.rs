//! `*STEP` and `*STATIC`.

use rustc_hash::FxHashSet;

use crate::model::{Procedure, StaticControl, Step};

use super::super::card::Card;
use super::super::data::Row;
use super::super::lex::{self, key};
use super::super::report::{Report, excerpt};
use super::Builder;
use super::layout::{Layout, StepCards};
use super::output::Requests;
use super::prescribed::Part;

const STEP: &str = "*STEP";
const STATIC: &str = "*STATIC";

/// `INC=` unless given.
const INCREMENTS_MAX: u32 = 100;

impl Builder<'_> {
    pub(super) fn build_steps(&mut self, layout: &Layout<'_>) {
        let mut names = FxHashSet::default();
        let mut requests = Requests::default();
        let mut contact = self.contact_history();
        for card in layout.model.iter().filter(|card| card.keyword.name == "*RESTART") {
            self.restart_request(card, &mut requests);
        }
        for (position, cards) in layout.steps.iter().enumerate() {
            let opening = cards.opening;
            let name = match opening.parameters.value("NAME") {
                Some(name) => name.to_string(),
                None => format!("Step-{}", position + 1),
            };
            if !names.insert(key(&name)) {
                self.report.error(
                    opening.at,
                    STEP,
                    format!("there is a step {name} already"),
                    "give each step its own name",
                );
            }
            if opening.parameters.has("NLGEOM") {
                let message = "NLGEOM: the step is solved with small displacements";
                self.report.warning(
                    opening.at,
                    STEP,
                    message,
                    "where bodies turn or stretch by more than a few percent the answer is not to be trusted",
                );
            }
            let increments_max = increments_max(opening, self.report);
            let procedure = self.procedure(cards, increments_max);
            let (mut boundary_lines, mut boundaries): (Vec<_>, Vec<_>) =
                std::mem::take(&mut self.early_boundaries).into_iter().unzip();
            for card in cards.cards.iter().filter(|card| card.keyword.name == "*BOUNDARY") {
                self.boundary_card(card, Part::Step, |at, boundary| {
                    boundary_lines.push(at);
                    boundaries.push(boundary);
                });
            }
            let (loads, load_lines, loads_removed) = self.step_loads(cards);
            let step_contact = self.step_contact(cards, position as u32, &mut contact);
            self.output_requests(cards, &mut requests);
            if !self.budget.take(requests.len(), opening.at, STEP, self.report) {
                return;
            }
            self.step_lines.push(boundary_lines);
            self.load_lines.push(load_lines);
            self.model.steps.push(Step {
                name,
                increments_max,
                procedure: Procedure::Static(procedure),
                boundaries,
                loads,
                loads_removed,
                contact: step_contact,
                output: requests.all(self.model.dialect),
                place: self.map.place(opening.at),
            });
        }
    }

    fn procedure(&mut self, step: &StepCards<'_>, increments_max: u32) -> StaticControl {
        let mut statics = step.cards.iter().filter(|card| card.keyword.name == STATIC);
        let Some(card) = statics.next() else {
            if !step.has_refused_keywords() {
                self.report.error(step.opening.at, STEP, "the step has no procedure", "write *STATIC behind *STEP");
            }
            return StaticControl {
                increment_initial: 1.0,
                period: 1.0,
                increment_min: 1e-5,
                increment_max: 1.0,
                direct: false,
            };
        };
        if let Some(second) = statics.next() {
            self.report.error(second.at, STATIC, "the step has a procedure already", "begin another *STEP for it");
        }
        let control = static_control(card, self.report);
        let needed = (control.period / control.increment_initial * (1.0 - 1e-9)).ceil();
        if control.direct && needed > f64::from(increments_max) {
            let message = format!("{needed} fixed increments are needed, and the step allows {increments_max}");
            self.report.error(card.at, STATIC, message, "give *STEP a larger INC, or longer increments");
        }
        control
    }
}

fn increments_max(opening: &Card, report: &mut Report) -> u32 {
    let Some(text) = opening.parameters.value("INC") else { return INCREMENTS_MAX };
    match lex::label(text.as_bytes()) {
        Ok(count) => count,
        Err(fault) => {
            let message = format!("INC={} {}", excerpt(text.as_bytes()), fault.text());
            report.error(opening.at, STEP, message, "give the largest number of increments");
            INCREMENTS_MAX
        }
    }
}

/// The data line of `*STATIC`: initial increment, period, smallest and largest increment; blanks and zeros are defaults.
fn static_control(card: &Card, report: &mut Report) -> StaticControl {
    let direct = card.parameters.has("DIRECT");
    let default =
        StaticControl { increment_initial: 1.0, period: 1.0, increment_min: 1e-5, increment_max: 1.0, direct };
    if let Some(second) = card.lines().get(1) {
        report.error(
            second.at,
            STATIC,
            "a second data line is not read here",
            "write one line: increment, period, smallest, largest",
        );
    }
    let Some(row) = card.first_line().map(|line| line.row(STATIC)) else { return default };
    row.at_most(4, report);
    let mut items = [0.0; 4];
    for (i, what) in ["initial increment", "period", "smallest increment", "largest increment"].into_iter().enumerate()
    {
        match row.real(i, what, Some(0.0), report) {
            Some(value) if value >= 0.0 => items[i] = value,
            Some(value) => {
                report.error(row.at, STATIC, format!("{what} {value} is negative"), "times are positive");
                return default;
            }
            None => return default,
        }
    }
    let [initial, period, smallest, largest] = items;
    let or = |value: f64, default: f64| if value == 0.0 { default } else { value };
    let period = or(period, 1.0);
    let increment_max = or(largest, period);
    let increment_initial = or(initial, period.min(increment_max));
    let increment_min = or(smallest, (1e-5 * period).min(increment_initial));
    let control = StaticControl { increment_initial, period, increment_min, increment_max, direct };
    check_control(&control, &row, report);
    control
}

fn check_control(control: &StaticControl, row: &Row<'_>, report: &mut Report) {
    let StaticControl { increment_initial: initial, period, increment_min, increment_max, direct } = *control;
    let mut order =
        |what: &str| report.error(row.at, STATIC, what, "write: increment, period, smallest, largest increment");
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
