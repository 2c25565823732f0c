//! `*CONTACT CONTROLS` of Abaqus/Explicit, for sets of pairs.

use crate::model::MechanicalConstraint;

use super::super::card::Card;
use super::Builder;
use super::contact_history::ContactHistory;
use super::controls::{Least, StatedControls, is_hard};

const CONTROLS: &str = "*CONTACT CONTROLS";

/// Parameters that have a meaning in static and implicit steps only. Those of modified hard contact are judged with the combinations.
const STANDARD: [&str; 10] = [
    "SLAVE",
    "MASTER",
    "ABSOLUTE PENETRATION TOLERANCE",
    "RELATIVE PENETRATION TOLERANCE",
    "STIFFNESS SCALE FACTOR",
    "AUTOMATIC TOLERANCES",
    "APPROACH",
    "STABILIZE",
    "TANGENT FRACTION",
    "FRICTION ONSET",
];

/// Parameters of the search for faces.
const SEARCH: [&str; 4] = ["FASTLOCALTRK", "GLOBTRKINC", "WARP CHECK PERIOD", "WARP CUT OFF"];

impl Builder<'_> {
    /// Takes in a card of an explicit step.
    pub(super) fn explicit_controls(&mut self, card: &Card, history: &mut ContactHistory) {
        for name in STANDARD.into_iter().filter(|name| card.parameters.has(name)) {
            let message = format!("{name} belongs to static and implicit steps");
            let remedy = match name {
                "SLAVE" | "MASTER" => "name the pairs by CPSET, which their *CONTACT PAIR gives them",
                _ => "remove it",
            };
            self.report.error(card.at, CONTROLS, message, remedy);
        }
        for name in SEARCH.into_iter().filter(|name| card.parameters.has(name)) {
            let message =
                format!("{name} has no effect: sliding is small, and the place of a node on its face is found once");
            self.report.warning(card.at, CONTROLS, message, "");
        }
        let mut sound = !card.faulty;
        let scale = self.control(card, "SCALE PENALTY", Least::Above, &mut sound);
        let Some(set) = card.parameters.value("CPSET") else {
            if !["MAXCHP", "PERRMX", "UERRMX", "SLAVE", "MASTER"].iter().any(|name| card.parameters.has(name)) {
                let remedy = "name a set of pairs: CPSET of *CONTACT PAIR";
                self.report.error(card.at, CONTROLS, "parameter CPSET is missing", remedy);
            }
            return;
        };
        let Some(pairs) = self.pairs_of_set(set, card) else { return };
        for pair in pairs {
            if card.parameters.has("RESET") {
                history.own[pair] = StatedControls::default();
            }
            let Some(scale) = scale else { continue };
            history.own[pair].scale_penalty = Some(scale);
            let definition = &self.model.pairs[pair];
            let is_penalty = definition.explicit.constraint == MechanicalConstraint::Penalty;
            if !is_penalty || !is_hard(&self.model.interactions[definition.interaction.index()]) {
                let message = format!(
                    "SCALE PENALTY has no effect on the pair {}: it multiplies the penalty of hard contact",
                    definition.name
                );
                let remedy = "write MECHANICAL CONSTRAINT=PENALTY with hard contact, or change the law itself";
                self.report.warning(card.at, CONTROLS, message, remedy);
            }
        }
    }
}
