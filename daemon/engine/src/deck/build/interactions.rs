//! Interactions: `*SURFACE INTERACTION`, `*GAP` and `*INTERFACE`, with the options that stand under them.

use crate::law::NormalBehavior;
use crate::model::{Dialect, InteractionId, SurfaceInteraction};

use super::super::card::Card;
use super::super::facts::DampingKind;
use super::super::keywords::Placement;
use super::super::report::At;
use super::Builder;
use super::enforcement::AskedNormal;
use super::layout::Layout;

const INTERACTION: &str = "*SURFACE INTERACTION";
const BEHAVIOR: &str = "*SURFACE BEHAVIOR";
const DAMPING: &str = "*CONTACT DAMPING";
const FRICTION: &str = "*FRICTION";

/// Lines of an interaction, one entry for each of `Model::interactions`.
pub struct InteractionLines {
    /// `*SURFACE INTERACTION`, `*GAP` or `*INTERFACE`.
    pub keyword: &'static str,
    /// Its line.
    pub at: At,
    /// `*SURFACE BEHAVIOR`.
    pub behavior: Option<At>,
    /// `*CONTACT DAMPING`.
    pub damping: Option<At>,
    /// Its DEFINITION.
    pub damping_kind: Option<DampingKind>,
    /// `*FRICTION`.
    pub friction: Option<At>,
    /// What `*SURFACE BEHAVIOR` asks for.
    pub asked: AskedNormal,
    /// Something about it was refused: whoever refers to it need not complain again.
    pub faulty: bool,
}

impl Builder<'_> {
    /// Reads every interaction. Those of surfaces are found by [`Builder::refer_interaction`], those of contact elements by
    /// [`Builder::element_interaction`].
    pub(super) fn build_interactions(&mut self, layout: &Layout<'_>) {
        let mut open = None;
        for (_, card) in layout.with_explicit_steps() {
            open = self.interaction_or_option(card, open);
        }
        for (name, id) in (0..).zip(&self.interaction_names) {
            if self.interaction_lines[id.index()].faulty {
                self.interactions.mark_faulty(name);
            }
        }
        if self.model.dialect == Dialect::Calculix {
            for lines in self.interaction_lines.iter().filter(|lines| lines.behavior.is_none()) {
                let message = "no *SURFACE BEHAVIOR: contact is hard, where CalculiX would stop";
                self.report.warning(lines.at, lines.keyword, message, "choose a law with *SURFACE BEHAVIOR");
            }
        }
    }

    /// Takes a card that may define an interaction or belong to the one that is open; the interaction that is open behind it.
    fn interaction_or_option(&mut self, card: &Card, open: Option<InteractionId>) -> Option<InteractionId> {
        let name = card.keyword.name;
        match name {
            INTERACTION => return self.surface_interaction(card),
            "*GAP" | "*INTERFACE" => return self.element_set_interaction(card),
            _ => {}
        }
        if !card.keyword.is_read() {
            return open; // Reported already.
        }
        if card.keyword.placement != Placement::Interaction {
            return None;
        }
        let Some(id) = open else {
            let message = "no interaction is being defined here";
            self.report.error(card.at, name, message, "write it under *SURFACE INTERACTION or *GAP");
            return None;
        };
        let lines = &mut self.interaction_lines[id.index()];
        let earlier = match name {
            BEHAVIOR => lines.behavior.replace(card.at),
            DAMPING => lines.damping.replace(card.at),
            _ => lines.friction.replace(card.at),
        };
        if earlier.is_some() {
            let message = format!("the interaction has a {name} already");
            self.report.error(card.at, name, message, "keep one of them");
        }
        let sound = match name {
            BEHAVIOR => self.behavior(card, id),
            DAMPING => self.contact_damping(card, id),
            FRICTION => match self.friction(card) {
                Some(friction) => {
                    self.model.interactions[id.index()].friction = friction;
                    true
                }
                None => false,
            },
            _ => true,
        };
        self.interaction_lines[id.index()].faulty |= !sound;
        open
    }

    /// Begins an interaction of surfaces.
    fn surface_interaction(&mut self, card: &Card) -> Option<InteractionId> {
        let name = card.parameters.value("NAME")?;
        let (_, is_new) = self.interactions.enter(name, card.at);
        if !is_new {
            let message = format!("surface interaction {name} is defined twice");
            self.report.error(card.at, INTERACTION, message, "rename or remove one");
            return None;
        }
        let mut faulty = card.faulty;
        let mut node_area = None;
        if card.first_line().is_some() {
            let row = card.single_row("area of each node of a node-based surface", self.report);
            match row.and_then(|row| row.real(0, "area per node", Some(1.0), self.report)) {
                Some(area) if area > 0.0 => node_area = Some(area),
                Some(area) => {
                    let message = format!("area per node {area} is not positive");
                    self.report.error(card.at, INTERACTION, message, "give a positive area");
                    faulty = true;
                }
                None => faulty = true,
            }
        }
        let interaction = SurfaceInteraction { node_area, ..SurfaceInteraction::new(name, NormalBehavior::Hard) };
        let id = self.push_interaction(interaction, card, faulty);
        self.interaction_names.push(id);
        Some(id)
    }

    /// Begins the interaction of the contact elements of a set.
    fn element_set_interaction(&mut self, card: &Card) -> Option<InteractionId> {
        let set = card.parameters.value("ELSET").unwrap_or("");
        let interaction = SurfaceInteraction::new(set, NormalBehavior::Hard);
        Some(self.push_interaction(interaction, card, card.faulty))
    }

    pub(super) fn push_interaction(
        &mut self,
        interaction: SurfaceInteraction,
        card: &Card,
        faulty: bool,
    ) -> InteractionId {
        let id = InteractionId(self.model.interactions.len() as u32);
        self.model.interactions.push(interaction);
        self.interaction_lines.push(InteractionLines {
            keyword: card.keyword.name,
            at: card.at,
            behavior: None,
            damping: None,
            damping_kind: None,
            friction: None,
            asked: AskedNormal::default(),
            faulty,
        });
        id
    }

    /// Interaction of surfaces that a line names; `None` when there is none, which is reported, or when it is faulty.
    #[track_caller]
    pub(super) fn refer_interaction(&mut self, name: &str, at: At, keyword: &str) -> Option<InteractionId> {
        let position = self.interactions.refer(name, at, keyword, self.report)?;
        Some(self.interaction_names[position as usize])
    }

    /// Interaction that a `*GAP` or `*INTERFACE` card defines; `None` when it is faulty, which has been reported.
    pub(super) fn element_interaction(&self, card: &Card) -> Option<InteractionId> {
        let lines = self.interaction_lines.iter().position(|lines| lines.at == card.at)?;
        (!self.interaction_lines[lines].faulty).then_some(InteractionId(lines as u32))
    }
}
