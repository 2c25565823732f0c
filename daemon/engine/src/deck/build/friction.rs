//! `*FRICTION`, in the model and behind `*CHANGE FRICTION`.

use crate::model::Friction;

use super::super::card::Card;
use super::super::lex::real;
use super::super::rules;
use super::Builder;

const FRICTION: &str = "*FRICTION";

impl Builder<'_> {
    /// What a `*FRICTION` card asks for; `None` when it is faulty or not solved, which is reported.
    pub(super) fn friction(&mut self, card: &Card) -> Option<Friction> {
        if self.is_explicit && card.parameters.value("TAUMAX").is_some_and(|text| real(text.as_bytes()) == Ok(0.0)) {
            self.break_rule(&rules::TAUMAX_ZERO, card.at, FRICTION, "");
        }
        if card.parameters.has("ROUGH") {
            if let Some(line) = card.first_line() {
                let message = "rough friction takes no data line";
                self.report.error(line.at, FRICTION, message, "remove the line, or ROUGH");
                return None;
            }
            return (!card.faulty).then_some(Friction::Rough);
        }
        let mut sound = !card.faulty;
        for line in card.lines().iter() {
            let row = line.row(FRICTION);
            match row.real(0, "friction coefficient", Some(0.0), self.report) {
                Some(0.0) => {}
                None => sound = false,
                Some(coefficient) => {
                    let message =
                        format!("friction coefficient {coefficient} is not supported and would change the answer");
                    let remedy =
                        "contact is solved without friction, or with *FRICTION, ROUGH: write one of them, or 0";
                    self.report.error(row.at, FRICTION, message, remedy);
                    sound = false;
                }
            }
        }
        sound.then_some(Friction::None)
    }
}
