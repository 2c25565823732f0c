//! Model part and steps: which card stands where, and whether it may.

use super::super::card::Card;
use super::super::keywords::{Effect, Placement};
use super::super::report::{At, Report};

/// Cards by the part of the deck that they stand in.
#[derive(Default)]
pub struct Layout<'d> {
    /// Before the first `*STEP`.
    pub model: Vec<&'d Card>,
    /// Steps in order.
    pub steps: Vec<StepCards<'d>>,
    /// All cards, in order.
    pub all: &'d [Card],
}

/// Cards of a step.
pub struct StepCards<'d> {
    /// `*STEP`.
    pub opening: &'d Card,
    /// What follows up to `*END STEP`.
    pub cards: Vec<&'d Card>,
    /// Whether the procedure is `*DYNAMIC, EXPLICIT`: then interactions and pairs may stand in the step.
    is_explicit: bool,
}

const STEP: &str = "*STEP";

/// Sorts the cards of a deck, reports those out of place. `stopped`: the rest of the deck was not read.
pub fn arrange<'d>(cards: &'d [Card], stopped: bool, report: &mut Report) -> Layout<'d> {
    let mut layout = Layout { all: cards, ..Layout::default() };
    let mut open = false;
    for (position, card) in cards.iter().enumerate() {
        match card.keyword.name {
            STEP => {
                if open {
                    report.error(card.at, STEP, "the step before is not closed", "write *END STEP before this line");
                }
                open = true;
                let within = cards[position + 1..].iter();
                let mut within = within.take_while(|card| !matches!(card.keyword.name, STEP | "*END STEP"));
                let is_explicit = within.any(is_explicit_procedure);
                layout.steps.push(StepCards { opening: card, cards: Vec::new(), is_explicit });
            }
            "*END STEP" if !open => {
                report.error(
                    card.at,
                    "*END STEP",
                    "there is no step to end",
                    "remove the line, or write *STEP before it",
                );
            }
            "*END STEP" => open = false,
            _ => layout.place(card, open, report),
        }
    }
    if let Some(step) = layout.steps.last().filter(|_| open && !stopped) {
        let message = "the step is not closed: the deck may have been cut off";
        report.error(step.opening.at, STEP, message, "write *END STEP behind the step");
    }
    if layout.steps.is_empty() && !stopped {
        let (message, remedy) = if cards.is_empty() {
            ("the deck is empty", "give a deck with nodes, elements and a step")
        } else {
            (
                "the deck has no step, so there is nothing to solve; it may have been cut off",
                "add *STEP, *STATIC, loads and *END STEP",
            )
        };
        report.error(At::DECK, "", message, remedy);
    }
    layout
}

impl<'d> Layout<'d> {
    fn place(&mut self, card: &'d Card, in_step: bool, report: &mut Report) {
        let name = card.keyword.name;
        if !card.keyword.is_read() {
            // Reported already; kept because a refused keyword explains what is missing.
            match self.steps.last_mut().filter(|_| in_step) {
                Some(step) => step.cards.push(card),
                None => self.model.push(card),
            }
            return;
        }
        let model_only =
            matches!(card.keyword.placement, Placement::Model | Placement::Material | Placement::Interaction);
        if in_step {
            let before = self.steps.last().and_then(|step| step.cards.last()).copied();
            if card.keyword.placement == Placement::Interaction {
                if before.is_some_and(|before| before.keyword.name == "*CHANGE SURFACE BEHAVIOR") {
                    return; // That is refused, and this card belongs to it.
                }
                if let (Some("*CHANGE FRICTION"), "*FRICTION", Some(step)) =
                    (before.map(|before| before.keyword.name), name, self.steps.last_mut())
                {
                    step.cards.push(card);
                    return;
                }
            }
            let is_contact = card.keyword.placement == Placement::Interaction
                || matches!(name, "*SURFACE INTERACTION" | "*CONTACT PAIR" | "*CLEARANCE")
                || is_general_contact(name);
            let is_history = is_contact && self.steps.last().is_some_and(StepCards::is_explicit);
            if model_only && !is_history {
                return report.error(
                    card.at,
                    name,
                    "the keyword stands within a step",
                    "move it before the first *STEP",
                );
            }
            if let Some(step) = self.steps.last_mut() {
                step.cards.push(card);
            }
        } else if card.keyword.placement == Placement::Step {
            report.error(card.at, name, "the keyword stands outside a step", "move it between *STEP and *END STEP");
        } else if !self.steps.is_empty() && (model_only || matches!(name, "*BOUNDARY" | "*RESTART")) {
            report.error(
                card.at,
                name,
                "the keyword stands behind a step",
                "move it before the first *STEP, or into a step",
            );
        } else {
            self.model.push(card);
        }
    }
}

impl Layout<'_> {
    /// Whether a keyword was refused: then what looks superfluous may not be.
    pub fn has_refused_keywords(&self) -> bool {
        self.all.iter().any(is_refused)
    }

    /// Cards of the model part, then those of explicit steps with the position of their step.
    pub fn with_explicit_steps(&self) -> impl Iterator<Item = (Option<usize>, &'_ Card)> {
        let steps = self.steps.iter().enumerate().filter(|(_, step)| step.is_explicit());
        let of_steps = steps.flat_map(|(position, step)| step.cards.iter().map(move |&card| (Some(position), card)));
        self.model.iter().map(|&card| (None, card)).chain(of_steps)
    }

    /// Every `*CONTACT PAIR`, wherever it may stand.
    pub fn contact_pairs(&self) -> impl Iterator<Item = &'_ Card> {
        self.with_explicit_steps().map(|(_, card)| card).filter(|card| card.keyword.name == "*CONTACT PAIR")
    }

    /// Whether a step is `*DYNAMIC, EXPLICIT`: the deck is one of Abaqus/Explicit.
    pub fn is_explicit(&self) -> bool {
        self.steps.iter().any(StepCards::is_explicit)
    }

    /// Whether a step is `*DYNAMIC`, explicit or not.
    pub fn has_dynamics(&self) -> bool {
        self.all.iter().any(|card| card.keyword.name == "*DYNAMIC")
    }

    /// Every `*DEBOND`.
    pub fn debonds(&self) -> impl Iterator<Item = &'_ Card> {
        self.all.iter().filter(|card| card.keyword.name == "*DEBOND")
    }
}

impl StepCards<'_> {
    /// Whether the procedure is `*DYNAMIC, EXPLICIT`.
    pub fn is_explicit(&self) -> bool {
        self.is_explicit
    }

    /// Whether a keyword of the step was refused: it may have been the procedure.
    pub fn has_refused_keywords(&self) -> bool {
        self.cards.iter().any(|card| is_refused(card))
    }
}

/// Whether a keyword describes general contact.
pub fn is_general_contact(name: &str) -> bool {
    super::super::general_table::GENERAL.iter().any(|keyword| keyword.name == name)
}

fn is_explicit_procedure(card: &Card) -> bool {
    card.keyword.name == "*DYNAMIC" && card.parameters.has("EXPLICIT")
}

/// Whether the keyword of a card is not supported.
pub fn is_refused(card: &Card) -> bool {
    matches!(card.keyword.effect, Effect::Refused(_))
}
