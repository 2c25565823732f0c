//! `*STEP`.

use rustc_hash::FxHashSet;

use crate::model::{DefaultAmplitude, Step};

use super::super::card::Card;
use super::super::lex::{self, key};
use super::super::report::{Report, excerpt};
use super::Builder;
use super::layout::Layout;
use super::output::Requests;
use super::prescribed::Part;

const STEP: &str = "*STEP";

/// `INC=` unless given.
const INCREMENTS_MAX: u32 = 100;

impl Builder<'_> {
    pub(super) fn build_steps(&mut self, layout: &Layout<'_>) {
        self.check_one_product(layout);
        let mut names = FxHashSet::default();
        let mut requests = Requests::default();
        let mut contact = self.contact_history();
        let mut explicit = self.explicit_defaults(layout);
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
            let increments_max = increments_max(opening, cards.is_explicit(), self.report);
            let procedure = self.procedure(cards, increments_max, &mut explicit);
            let default_amplitude = match opening.parameters.word("AMPLITUDE").as_str() {
                "RAMP" => DefaultAmplitude::Ramp,
                "STEP" => DefaultAmplitude::Step,
                _ if procedure.is_dynamic() => DefaultAmplitude::Step,
                _ => DefaultAmplitude::Ramp,
            };
            let part = if procedure.is_dynamic() { Part::Dynamic } else { Part::Static };
            let (mut boundary_lines, mut boundaries): (Vec<_>, Vec<_>) =
                std::mem::take(&mut self.early_boundaries).into_iter().unzip();
            for card in cards.cards.iter().filter(|card| card.keyword.name == "*BOUNDARY") {
                self.boundary_card(card, part, |at, boundary| {
                    boundary_lines.push(at);
                    boundaries.push(boundary);
                });
            }
            if procedure.is_dynamic() && default_amplitude == DefaultAmplitude::Step {
                self.check_jumps(&boundaries, &boundary_lines);
            }
            let (loads, load_lines, loads_removed) = self.step_loads(cards);
            let step_contact = self.step_contact(cards, position as u32, &mut contact);
            if procedure.is_dynamic() && step_contact.controls.iter().any(|controls| controls.modified.is_some()) {
                self.report.warning(
                    opening.at,
                    STEP,
                    "MAXCHP, PERRMX and UERRMX have no effect in a dynamic step: hard contact changes by impacts and releases",
                    "leave them out, or end them with *CONTACT CONTROLS, RESET",
                );
            }
            self.output_requests(cards, &mut requests);
            if !self.budget.take(requests.len(), opening.at, STEP, self.report) {
                return;
            }
            self.step_lines.push(boundary_lines);
            self.load_lines.push(load_lines);
            self.model.steps.push(Step {
                name,
                increments_max,
                procedure,
                default_amplitude,
                boundaries,
                loads,
                loads_removed,
                contact: step_contact,
                output: requests.all(self.model.dialect),
                place: self.map.place(opening.at),
            });
        }
    }
}

fn increments_max(opening: &Card, is_explicit: bool, report: &mut Report) -> u32 {
    let given = opening.parameters.value("INC");
    if is_explicit {
        if given.is_some() {
            let message = "INC has no effect on an explicit step: as many increments are taken as the period needs";
            report.warning(opening.at, STEP, message, "leave it out");
        }
        return u32::MAX;
    }
    let Some(text) = given else { return INCREMENTS_MAX };
    match lex::label(text.as_bytes()) {
        Ok(count) => count,
        Err(fault) => {
            let message = format!("INC={} {}", excerpt(text.as_bytes()), fault.text());
            report.error(opening.at, STEP, message, "give the largest number of increments");
            INCREMENTS_MAX
        }
    }
}
