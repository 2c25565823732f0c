//! Contact from step to step: `*CONTACT CONTROLS`, `*MODEL CHANGE`, `*CHANGE FRICTION` and `*CONTACT INTERFERENCE` change what
//! the steps before have left.

use crate::model::{ContactControls, Enforcement, Friction, Interference, PairMembers, StepContact, SurfaceId};

use super::super::card::Card;
use super::super::data::Row;
use super::super::lex::{key, unquoted};
use super::super::report::At;
use super::Builder;
use super::controls::{StatedControls, is_hard};
use super::layout::StepCards;

const CONTROLS: &str = "*CONTACT CONTROLS";
const INTERFERENCE: &str = "*CONTACT INTERFERENCE";
const MODEL_CHANGE: &str = "*MODEL CHANGE";
const CHANGE_FRICTION: &str = "*CHANGE FRICTION";

/// What the steps so far have left. Lists have one entry per pair.
pub struct ContactHistory {
    all_pairs: StatedControls,
    pub(super) own: Vec<StatedControls>,
    active: Vec<bool>,
    frictions: Vec<Friction>,
    pub(super) interferences: Vec<Option<Interference>>,
}

impl Builder<'_> {
    /// Before the first step.
    pub(super) fn contact_history(&self) -> ContactHistory {
        ContactHistory {
            all_pairs: StatedControls::default(),
            own: vec![StatedControls::default(); self.model.pairs.len()],
            // Explicit steps add their pairs.
            active: vec![!self.is_explicit; self.model.pairs.len()],
            frictions: self.frictions_of_interactions(),
            interferences: vec![None; self.model.pairs.len()],
        }
    }

    fn frictions_of_interactions(&self) -> Vec<Friction> {
        self.model.pairs.iter().map(|pair| self.model.interactions[pair.interaction.index()].friction).collect()
    }

    /// Takes in the cards of a step (`step` counts from 0); contact as it is in this step.
    pub(super) fn step_contact(
        &mut self,
        cards: &StepCards<'_>,
        step: u32,
        history: &mut ContactHistory,
    ) -> StepContact {
        if step == 0 {
            for &(pair, scale) in &self.general_scales {
                history.own[pair].scale_penalty = Some(scale);
            }
        }
        for event in self.pair_events.iter().filter(|event| event.step == step as usize) {
            history.active[event.pair] = event.active;
        }
        let mut removed_by_new = false;
        let mut cards = cards.cards.iter().copied().peekable();
        while let Some(card) = cards.next() {
            match card.keyword.name {
                CONTROLS if self.is_explicit => self.explicit_controls(card, history),
                name @ (MODEL_CHANGE | INTERFERENCE | CHANGE_FRICTION) if self.is_explicit => {
                    let message = "the keyword belongs to static and implicit steps";
                    let remedy = match name {
                        MODEL_CHANGE => "add and delete pairs by *CONTACT PAIR, OP=ADD and OP=DELETE",
                        _ => "remove it",
                    };
                    self.report.error(card.at, name, message, remedy);
                    cards.next_if(|next| name == CHANGE_FRICTION && next.keyword.name == "*FRICTION");
                }
                CONTROLS => self.controls_card(card, history),
                MODEL_CHANGE => self.model_change(card, history),
                INTERFERENCE => {
                    if card.parameters.word("OP") == "NEW" && !std::mem::replace(&mut removed_by_new, true) {
                        history.interferences.fill(None);
                    }
                    self.interference_card(card, step, history);
                }
                CHANGE_FRICTION => {
                    let behind = cards.next_if(|next| next.keyword.name == "*FRICTION");
                    self.change_friction(card, behind, history);
                }
                _ => {}
            }
        }
        self.resolved(history)
    }

    fn resolved(&self, history: &ContactHistory) -> StepContact {
        let controls: Vec<ContactControls> = (history.own.iter().zip(&self.model.pairs))
            .map(|(own, pair)| {
                let mut controls = StatedControls::resolve(own, &history.all_pairs);
                let interaction = &self.model.interactions[pair.interaction.index()];
                if !is_hard(interaction) || interaction.enforcement != Enforcement::Lagrange {
                    controls.modified = None;
                }
                controls
            })
            .collect();
        let keep = |is_default: bool| !is_default;
        StepContact {
            active: if keep(history.active.iter().all(|&active| active)) { history.active.clone() } else { Vec::new() },
            frictions: if keep(history.frictions == self.frictions_of_interactions()) {
                history.frictions.clone()
            } else {
                Vec::new()
            },
            interferences: if keep(history.interferences.iter().all(Option::is_none)) {
                history.interferences.clone()
            } else {
                Vec::new()
            },
            controls: if keep(controls.iter().all(|c| *c == ContactControls::default())) {
                controls
            } else {
                Vec::new()
            },
        }
    }

    fn controls_card(&mut self, card: &Card, history: &mut ContactHistory) {
        let named = (card.parameters.value("SLAVE"), card.parameters.value("MASTER"));
        let pair = match named {
            (None, None) => None,
            (Some(secondary), Some(primary)) => {
                match self.pair_of_surfaces(secondary, primary, card.at, CONTROLS) {
                    Some(pair) => Some(pair),
                    None => {
                        // What it states is judged all the same.
                        self.stated_controls(card, &StatedControls::default());
                        return;
                    }
                }
            }
            _ => {
                let message = "SLAVE and MASTER name a pair together";
                self.report.error(card.at, CONTROLS, message, "give both, or none for every pair");
                self.stated_controls(card, &StatedControls::default());
                return;
            }
        };
        if card.parameters.has("RESET") {
            match pair {
                Some(pair) => history.own[pair] = StatedControls::default(),
                None => {
                    history.all_pairs = StatedControls::default();
                    history.own.fill(StatedControls::default());
                }
            }
        }
        let target = match pair {
            Some(pair) => &mut history.own[pair],
            None => &mut history.all_pairs,
        };
        if let Some(stated) = self.stated_controls(card, target) {
            target.add(stated);
            self.check_controls(card, &stated, pair);
        }
    }

    fn model_change(&mut self, card: &Card, history: &mut ContactHistory) {
        if !card.parameters.has("TYPE") && !card.faulty {
            let message = "TYPE is missing, which means elements: they stay as they are";
            self.report.error(card.at, MODEL_CHANGE, message, "write TYPE=CONTACT PAIR to switch contact");
            return;
        }
        let active = match (card.parameters.has("ADD"), card.parameters.has("REMOVE")) {
            (true, false) => true,
            (false, true) => false,
            _ if card.faulty => return,
            _ => {
                let message = "one of ADD and REMOVE says what becomes of the pairs";
                return self.report.error(card.at, MODEL_CHANGE, message, "give one of them");
            }
        };
        if card.faulty {
            return;
        }
        if card.first_line().is_none() {
            let remedy = "write: secondary surface, primary surface";
            self.report.error(card.at, MODEL_CHANGE, "the data line is missing", remedy);
        }
        for line in card.lines().iter() {
            let row = line.row(MODEL_CHANGE);
            row.at_most(2, self.report);
            let Some(pair) = self.pair_of_row(&row) else { continue };
            if std::mem::replace(&mut history.active[pair], active) == active {
                let message = format!(
                    "the pair {} is {} already",
                    self.model.pairs[pair].name,
                    if active { "active" } else { "removed" }
                );
                self.report.warning(row.at, MODEL_CHANGE, message, "remove the line, or look for a misspelt name");
            }
        }
    }

    fn change_friction(&mut self, card: &Card, behind: Option<&Card>, history: &mut ContactHistory) {
        let reset = card.parameters.has("RESET");
        let friction = match (reset, behind) {
            (true, None) => None,
            (true, Some(friction)) => {
                let message = "*FRICTION behind *CHANGE FRICTION, RESET, which brings back that of the model";
                return self.report.error(friction.at, "*FRICTION", message, "remove RESET or *FRICTION");
            }
            (false, None) => {
                let message = "no *FRICTION follows";
                return self.report.error(card.at, CHANGE_FRICTION, message, "write *FRICTION behind it, or add RESET");
            }
            (false, Some(friction)) => match self.friction(friction) {
                Some(friction) => Some(friction),
                None => return,
            },
        };
        let (interaction, set) = (card.parameters.value("INTERACTION"), card.parameters.value("ELSET"));
        let changed: Vec<usize> = match (interaction, set) {
            (Some(name), None) => {
                let Some(id) = self.refer_interaction(name, card.at, CHANGE_FRICTION) else { return };
                (0..self.model.pairs.len()).filter(|&pair| self.model.pairs[pair].interaction == id).collect()
            }
            (None, Some(name)) => match self.gap_pair(name, card.at, CHANGE_FRICTION) {
                Some(pair) => vec![pair],
                None => return,
            },
            _ => {
                let message = "INTERACTION or ELSET names what changes";
                return self.report.error(card.at, CHANGE_FRICTION, message, "give one of them");
            }
        };
        for pair in changed {
            let of_model = self.model.interactions[self.model.pairs[pair].interaction.index()].friction;
            history.frictions[pair] = friction.unwrap_or(of_model);
        }
    }

    /// Pair of the surfaces that a data line begins with.
    pub(super) fn pair_of_row(&mut self, row: &Row<'_>) -> Option<usize> {
        let (secondary, primary) = (unquoted(row.text(0)), unquoted(row.text(1)));
        if secondary.is_empty() || primary.is_empty() {
            let message = "the line does not name two surfaces";
            self.report.error(row.at, row.keyword, message, "write: secondary surface, primary surface");
            return None;
        }
        self.pair_of_surfaces(secondary, primary, row.at, row.keyword)
    }

    /// Position of the pair of two surfaces; `None` when there is none, which is reported, or when it is faulty.
    pub(super) fn pair_of_surfaces(
        &mut self,
        secondary: &str,
        primary: &str,
        at: At,
        keyword: &'static str,
    ) -> Option<usize> {
        let [first, second] =
            [secondary, primary].map(|name| self.surfaces.refer(unquoted(name), at, keyword, self.report));
        let (first, second) = (SurfaceId(first?), SurfaceId(second?));
        let position = |secondary: SurfaceId, primary: SurfaceId| {
            self.model.pairs.iter().position(|pair| {
                pair.surfaces().is_some_and(|pair| (pair.secondary, pair.primary) == (secondary, primary))
            })
        };
        let found = position(first, second);
        if found.is_none() && !self.faulty_pairs.contains(&(first, second)) {
            let message = format!("{secondary} and {primary} are no contact pair");
            let remedy = if position(second, first).is_some() {
                "exchange the names: the secondary (slave) surface of *CONTACT PAIR is the first of its line"
            } else {
                "name the surfaces of a *CONTACT PAIR"
            };
            self.report.error(at, keyword, message, remedy);
        }
        found
    }

    /// Position of the pair that the contact elements of a set make; `None` when there is none, which is reported.
    pub(super) fn gap_pair(&mut self, set: &str, at: At, keyword: &'static str) -> Option<usize> {
        let is_it = |pair: &crate::model::ContactPair| {
            matches!(pair.members, PairMembers::Gaps(_)) && key(&pair.name) == key(set)
        };
        let found = self.model.pairs.iter().position(is_it);
        if found.is_none() {
            let faulty = |lines: &super::interactions::InteractionLines| lines.faulty && lines.keyword == "*GAP";
            if !self.interaction_lines.iter().any(faulty) {
                let message = format!("{set} is no set of contact elements");
                self.report.error(at, keyword, message, "name the element set of a *GAP");
            }
        }
        found
    }
}
