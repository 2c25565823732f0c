//! `*CONTACT INTERFERENCE`: overclosures that are allowed, and resolved gradually.

use crate::model::{AllowedOverclosure, Interference};

use super::super::card::Card;
use super::super::lex::unquoted;
use super::super::rules;
use super::Builder;
use super::contact_history::ContactHistory;

const INTERFERENCE: &str = "*CONTACT INTERFERENCE";

impl Builder<'_> {
    /// Takes in a card of a step, which counts from 0.
    pub(super) fn interference_card(&mut self, card: &Card, step: u32, history: &mut ContactHistory) {
        let shrink = card.parameters.has("SHRINK");
        let amplitude = match self.amplitude(card) {
            Ok(amplitude) => amplitude,
            Err(()) => return,
        };
        if shrink && step > 0 {
            self.break_rule(&rules::SHRINK_LATER, card.at, INTERFERENCE, "");
        }
        if shrink && amplitude.is_some() {
            let message = "AMPLITUDE is ignored with SHRINK: the overclosures of the start fade away over the step";
            self.report.warning(card.at, INTERFERENCE, message, "remove AMPLITUDE");
        }
        if card.faulty {
            return;
        }
        let of_elements = card.parameters.word("TYPE") == "ELEMENT";
        let is_removal = card.parameters.word("OP") == "NEW";
        if card.first_line().is_none() && !is_removal {
            let remedy =
                if of_elements { "write: element set, overclosure" } else { "write: secondary, primary, overclosure" };
            self.report.error(card.at, INTERFERENCE, "the data line is missing", remedy);
        }
        for line in card.lines().iter() {
            let row = line.row(INTERFERENCE);
            let (pair, names) = if of_elements {
                (self.gap_pair(unquoted(row.text(0)), row.at, INTERFERENCE), 1)
            } else {
                (self.pair_of_row(&row), 2)
            };
            if row.fields.iter().skip(names + 1).any(|field| !field.is_empty()) {
                let message = "a direction in which the secondary surface is shifted is not supported and would change the answer";
                let remedy = "overclosures are resolved along the normals: leave the direction out";
                self.report.error(row.at, INTERFERENCE, message, remedy);
                continue;
            }
            let allowed = if shrink {
                row.at_most(names, self.report);
                Some(AllowedOverclosure::Initial)
            } else {
                let value = row.real(names, "overclosure that is allowed", None, self.report);
                value.map(AllowedOverclosure::Uniform)
            };
            let (Some(pair), Some(allowed)) = (pair, allowed) else { continue };
            let amplitude = amplitude.filter(|_| !shrink);
            history.interferences[pair] = Some(Interference { allowed, amplitude, step });
        }
    }
}
