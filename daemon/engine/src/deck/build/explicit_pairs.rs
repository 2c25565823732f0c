//! `*CONTACT PAIR` of Abaqus/Explicit: pairs that steps add and delete, which surface plays which part, and sets of pairs.

use crate::model::{
    ContactPair, ExplicitContact, InteractionId, MechanicalConstraint, PairMembers, SurfaceId, SurfaceInteraction,
    SurfaceKind, SurfacePair, Weight,
};

use super::super::card::Card;
use super::super::data::Row;
use super::super::lex::{key, real};
use super::super::report::excerpt;
use super::Builder;
use super::pairs::EXTENSION_ZONE;

const PAIR: &str = "*CONTACT PAIR";

/// Name of the interaction of pairs that name none: hard, frictionless.
pub const DEFAULT_INTERACTION: &str = "default";

/// Which surface of a pair plays which part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roles {
    /// The secondary surface, alone or for the share `weight`.
    pub secondary: SurfaceId,
    /// The other one.
    pub primary: SurfaceId,
    /// Share of the result in which the parts are these; 1 is pure.
    pub weight: f64,
}

/// A change of a pair at the start of a step.
#[derive(Clone, Copy)]
pub struct PairEvent {
    /// Position of the step.
    pub step: usize,
    /// Position of the pair.
    pub pair: usize,
    /// Whether it acts from there on.
    pub active: bool,
}

/// `MECHANICAL CONSTRAINT` of a card.
pub fn constraint_of(card: &Card) -> MechanicalConstraint {
    match card.parameters.word("MECHANICAL CONSTRAINT").as_str() {
        "PENALTY" => MechanicalConstraint::Penalty,
        _ => MechanicalConstraint::Kinematic,
    }
}

/// `WEIGHT` of a card, if it is a number from 0 to 1.
pub fn weight_of(card: &Card) -> Option<f64> {
    let weight = real(card.parameters.value("WEIGHT")?.as_bytes()).ok()?;
    (0.0..=1.0).contains(&weight).then_some(weight)
}

impl Builder<'_> {
    /// Takes in a card of the model part or of a step of an explicit deck.
    pub(super) fn explicit_pair_card(&mut self, step: Option<usize>, card: &Card) {
        if card.parameters.word("OP") == "DELETE" {
            return self.delete_pairs(step, card);
        }
        for name in ["ADJUST", "EXTENSION ZONE", "HCRIT"].into_iter().filter(|name| card.parameters.has(name)) {
            let message = format!("{name} belongs to pairs of static and implicit analyses");
            let remedy = match name {
                "ADJUST" => "remove it: nodes that overlap in the first step are moved onto the surface in any case",
                _ => "remove it",
            };
            self.report.error(card.at, PAIR, message, remedy);
        }
        if card.parameters.word("TYPE") == "SURFACETOSURFACE" {
            let message = "TYPE=SURFACE TO SURFACE belongs to pairs of static and implicit analyses";
            self.report.error(card.at, PAIR, message, "remove it: nodes meet faces in explicit analyses");
        }
        if card.parameters.has("WEIGHT") && weight_of(card).is_none() {
            let text = card.parameters.value("WEIGHT").unwrap_or("");
            let message = format!("WEIGHT={} is not a number from 0 to 1", excerpt(text.as_bytes()));
            let remedy = "1: the first surface is primary; 0: the second one is; 0.5: balanced";
            self.report.error(card.at, PAIR, message, remedy);
        }
        self.warn_of_sliding(card);
        let interaction = match card.parameters.value("INTERACTION") {
            Some(name) => self.refer_interaction(name, card.at, PAIR),
            None => Some(self.default_interaction(card)),
        };
        if card.first_line().is_none() {
            self.report.error(card.at, PAIR, "the data line is missing", "write: first surface, second surface");
        }
        let (constraint, mut pairs) = (constraint_of(card), Vec::new());
        for line in card.lines().iter() {
            let row = line.row(PAIR);
            row.at_most(2, self.report);
            let (first, second) = (self.pair_surface(&row, 0, "first"), self.pair_surface(&row, 1, "second"));
            let (Some(first), Some(second)) = (first, second) else { continue };
            let roles = self.roles(first, second, constraint, weight_of(card));
            let is_sound = self.pair_is_sound(&row, roles.secondary, roles.primary, roles.weight);
            let (Some(interaction), false, true) = (interaction, card.faulty, is_sound) else {
                self.faulty_pairs.insert((first, second));
                self.faulty_pairs.insert((second, first));
                continue;
            };
            let explicit = ExplicitContact { constraint, weight: Weight(roles.weight) };
            if let Some(pair) = self.add_explicit_pair(&row, card, step, roles, interaction, explicit) {
                pairs.push(pair);
            }
        }
        if let Some(name) = card.parameters.value("CPSET") {
            let (position, is_new) = self.contact_sets.enter(name, card.at);
            self.contact_sets.mark_used(position);
            if is_new {
                self.contact_set_pairs.push(Vec::new());
            }
            if card.faulty || interaction.is_none() {
                self.contact_sets.mark_faulty(position);
            }
            let members = &mut self.contact_set_pairs[position as usize];
            members.extend(pairs);
            members.sort_unstable();
            members.dedup();
        }
    }

    /// Which surface is secondary, and for which share, of two in the order of the line.
    ///
    /// `WEIGHT` is the share in which the first surface is primary. Without it the manual's defaults hold (contact pair formulation):
    /// nodes meet faces, deformable bodies meet rigid ones in kinematic contact and analytical ones in any; everything else is balanced.
    pub(super) fn roles(
        &self,
        first: SurfaceId,
        second: SurfaceId,
        constraint: MechanicalConstraint,
        weight: Option<f64>,
    ) -> Roles {
        let kind = |surface: SurfaceId| &self.model.mesh.surfaces[surface.index()].kind;
        let is_secondary_only = |surface| matches!(kind(surface), SurfaceKind::Nodes(_) | SurfaceKind::Bars(_));
        let is_primary_only = |surface| {
            matches!(kind(surface), SurfaceKind::Analytical(_))
                || (constraint == MechanicalConstraint::Kinematic && self.is_rigid_surface(surface))
        };
        let first_primary = weight.unwrap_or_else(|| {
            match [
                is_secondary_only(first) || is_primary_only(second),
                is_secondary_only(second) || is_primary_only(first),
            ] {
                [true, false] => 0.0,
                [false, true] => 1.0,
                _ => 0.5,
            }
        });
        if first_primary == 1.0 {
            Roles { secondary: second, primary: first, weight: 1.0 }
        } else {
            Roles { secondary: first, primary: second, weight: 1.0 - first_primary }
        }
    }

    /// Whether every node of a surface moves with the reference node of a rigid body.
    pub(super) fn is_rigid_surface(&self, surface: SurfaceId) -> bool {
        if let SurfaceKind::Analytical(_) = self.model.mesh.surfaces[surface.index()].kind {
            return true;
        }
        let nodes = self.surface_nodes(surface);
        let bodies = &self.model.rigid_bodies;
        let is_rigid =
            |node| bodies.iter().any(|body| body.reference == node || body.nodes.binary_search(&node).is_ok());
        !nodes.is_empty() && nodes.into_iter().all(is_rigid)
    }

    /// Adds a pair, or brings one back that was deleted; its position.
    fn add_explicit_pair(
        &mut self,
        row: &Row<'_>,
        card: &Card,
        step: Option<usize>,
        roles: Roles,
        interaction: InteractionId,
        explicit: ExplicitContact,
    ) -> Option<usize> {
        let Roles { secondary, primary, .. } = roles;
        if let Some(pair) = self.pair_between(secondary, primary) {
            let known = &self.model.pairs[pair];
            let name = known.name.clone();
            let parts = known.surfaces().map(|pair| (pair.secondary, pair.primary));
            let is_same =
                (parts, known.interaction, known.explicit) == (Some((secondary, primary)), interaction, explicit);
            if step.is_none() || self.is_active(pair) {
                self.report.error(row.at, PAIR, format!("the pair {name} is given twice"), "remove one of the lines");
                return None;
            }
            if !is_same {
                let message = format!("the pair {name} comes back otherwise than it was deleted");
                let remedy = "give it the interaction, MECHANICAL CONSTRAINT and WEIGHT that it had, or make surfaces of other names of the same faces";
                self.report.error(row.at, PAIR, message, remedy);
                return None;
            }
            self.pair_events.extend(step.map(|step| PairEvent { step, pair, active: true }));
            return Some(pair);
        }
        let pair = self.model.pairs.len();
        let members = PairMembers::Surfaces(SurfacePair {
            secondary,
            primary,
            extension_zone: EXTENSION_ZONE,
            hcrit: None,
            adjust: None,
            clearances: Vec::new(),
        });
        let (name, place) = (self.pair_name(secondary, primary), self.map.place(row.at));
        self.push_pair(ContactPair { name, members, interaction, explicit, place }, row.at);
        if self.model.pairs.len() == pair {
            return None; // Another pair has this name, which is reported.
        }
        if !card.parameters.has("SMALL SLIDING") {
            self.finite_sliding.insert(pair);
        }
        self.pair_events.push(PairEvent { step: step.unwrap_or(0), pair, active: true });
        Some(pair)
    }

    /// Position of the pair of two surfaces, whichever is secondary.
    fn pair_between(&self, first: SurfaceId, second: SurfaceId) -> Option<usize> {
        let is_it = |pair: &SurfacePair| [(first, second), (second, first)].contains(&(pair.secondary, pair.primary));
        self.model.pairs.iter().position(|pair| pair.surfaces().is_some_and(is_it))
    }

    /// Whether the cards so far leave a pair active.
    fn is_active(&self, pair: usize) -> bool {
        self.pair_events.iter().rev().find(|event| event.pair == pair).is_some_and(|event| event.active)
    }

    fn delete_pairs(&mut self, step: Option<usize>, card: &Card) {
        let Some(step) = step else {
            let message = "OP=DELETE before the first step: there is no pair yet";
            return self.report.error(card.at, PAIR, message, "remove the card, or move it into a step");
        };
        if card.first_line().is_none() {
            self.report.error(card.at, PAIR, "the data line is missing", "write: first surface, second surface");
        }
        for line in card.lines().iter() {
            let row = line.row(PAIR);
            row.at_most(2, self.report);
            let (first, second) = (self.pair_surface(&row, 0, "first"), self.pair_surface(&row, 1, "second"));
            let (Some(first), Some(second)) = (first, second) else { continue };
            match self.pair_between(first, second).filter(|&pair| self.is_active(pair)) {
                Some(pair) => self.pair_events.push(PairEvent { step, pair, active: false }),
                None if self.faulty_pairs.contains(&(first, second)) => {}
                None => {
                    let name = |surface: SurfaceId| self.model.mesh.surfaces[surface.index()].name.clone();
                    let message = format!("{} and {} are no contact pair that acts here", name(first), name(second));
                    let remedy = "name the surfaces of a *CONTACT PAIR of this step or one before";
                    self.report.error(row.at, PAIR, message, remedy);
                }
            }
        }
    }

    /// Interaction of pairs that name none: hard and frictionless.
    pub(super) fn default_interaction(&mut self, card: &Card) -> InteractionId {
        if let Some(known) = self.default_interaction {
            return known;
        }
        let interaction = SurfaceInteraction::new(DEFAULT_INTERACTION, crate::law::NormalBehavior::Hard);
        let id = self.push_interaction(interaction, card, false);
        self.default_interaction = Some(id);
        id
    }

    /// Pairs of a set that `CPSET` names; `None` when there is none, which is reported, or when it is faulty.
    pub(super) fn pairs_of_set(&mut self, name: &str, card: &Card) -> Option<Vec<usize>> {
        let set = self.contact_sets.refer(name, card.at, card.keyword.name, self.report)?;
        Some(self.contact_set_pairs[set as usize].clone())
    }

    /// Whether a card is about the interaction of a name; cards without a name are about the default.
    pub(super) fn is_about(&self, card: &Card, interaction: InteractionId) -> bool {
        match card.parameters.value("INTERACTION") {
            Some(used) => {
                self.default_interaction != Some(interaction)
                    && key(used) == key(&self.model.interactions[interaction.index()].name)
            }
            None => self.default_interaction == Some(interaction) && card.parameters.word("OP") != "DELETE",
        }
    }
}
