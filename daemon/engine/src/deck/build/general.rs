//! General contact of Abaqus/Explicit: `*CONTACT` with inclusions, exclusions and what is assigned to couples of surfaces.
//!
//! The cards become parts that do not overlap: each couple with properties of its own is a part, and the couples that are included
//! leave those out.

use crate::model::{
    ContactPair, ElementId, ExplicitContact, GeneralContact, InteractionId, MechanicalConstraint, PairMembers, Surface,
    SurfaceId, SurfaceKind, Weight,
};

use super::super::card::Card;
use super::super::data::Row;
use super::super::lex::{key, unquoted};
use super::super::report::At;
use super::Builder;
use super::explicit_pairs::PairEvent;
use super::layout::{Layout, is_general_contact};
use super::surfaces::free_faces;

const CONTACT: &str = "*CONTACT";
const INCLUSIONS: &str = "*CONTACT INCLUSIONS";

/// Name of the surface of all outer faces.
const ALL_EXTERIOR: &str = "ALL_EXTERIOR";

/// Two surfaces, in any order.
type Couple = [SurfaceId; 2];

/// What the cards of a general contact state. Of assignments to the same couple the last one counts.
#[derive(Default)]
struct Stated<'d> {
    /// `*CONTACT`.
    opening: Option<&'d Card>,
    included: Vec<(Couple, At)>,
    excluded: Vec<Couple>,
    interactions: Vec<(Couple, InteractionId)>,
    /// Secondary surface first.
    pure: Vec<Couple>,
    scales: Vec<(Couple, f64)>,
    sound: bool,
}

impl Builder<'_> {
    /// Reads general contact of the model part, then of each explicit step.
    pub(super) fn build_general_contact(&mut self, layout: &Layout<'_>) {
        if !layout.is_explicit() {
            if let Some(card) = layout.model.iter().find(|card| is_general_contact(card.keyword.name)) {
                let remedy = "name every two surfaces that may meet by *CONTACT PAIR";
                let message = "general contact belongs to explicit analyses here";
                self.report.error(card.at, card.keyword.name, message, remedy);
            }
            return;
        }
        let mut acting: Vec<usize> = Vec::new();
        let parts = std::iter::once((None, &layout.model))
            .chain(layout.steps.iter().enumerate().map(|(position, step)| (Some(position), &step.cards)));
        for (step, cards) in parts {
            let cards = cards.iter().copied().filter(|card| is_general_contact(card.keyword.name));
            let Some(stated) = self.stated_general(cards) else { continue };
            let Some(opening) = stated.opening else { continue };
            if !acting.is_empty() && opening.parameters.word("OP") != "NEW" {
                let message = "general contact is described already";
                let remedy =
                    "write *CONTACT, OP=NEW and describe it as a whole: parts of it are not changed one by one";
                self.report.error(opening.at, CONTACT, message, remedy);
                continue;
            }
            let events = acting.drain(..).map(|pair| PairEvent { step: step.unwrap_or(0), pair, active: false });
            self.pair_events.extend(events);
            acting = self.general_parts(stated, step);
        }
    }

    /// What the cards of one part of the deck state; none without cards.
    fn stated_general<'d>(&mut self, cards: impl Iterator<Item = &'d Card>) -> Option<Stated<'d>> {
        let mut stated = Stated { sound: true, ..Stated::default() };
        let mut is_there = false;
        for card in cards {
            is_there = true;
            let name = card.keyword.name;
            if name == CONTACT {
                if let Some(earlier) = stated.opening.replace(card) {
                    let message = "general contact is described twice in one part of the deck";
                    self.report.error(card.at, CONTACT, message, "write one *CONTACT with all that belongs to it");
                    stated.opening = Some(earlier);
                }
                continue;
            }
            if stated.opening.is_none() {
                self.report.error(
                    card.at,
                    name,
                    "no general contact is being described here",
                    "write it under *CONTACT",
                );
                stated.sound = false;
            }
            stated.sound &= !card.faulty;
            if name == INCLUSIONS && card.parameters.has("ALL EXTERIOR") {
                let all = self.all_exterior(card);
                stated.included.push(([all, all], card.at));
                if let Some(line) = card.first_line() {
                    let message = "ALL EXTERIOR includes everything: no data line is read";
                    self.report.error(line.at, name, message, "remove the line, or ALL EXTERIOR");
                }
                continue;
            }
            if card.first_line().is_none() {
                self.report.error(card.at, name, "the data line is missing", "write: first surface, second surface");
                stated.sound = false;
            }
            for line in card.lines().iter() {
                let row = line.row(name);
                stated.sound &= self.general_row(card, &row, &mut stated).is_some();
            }
        }
        is_there.then_some(stated)
    }

    /// A line of surfaces and what is assigned to them.
    fn general_row(&mut self, card: &Card, row: &Row<'_>, stated: &mut Stated<'_>) -> Option<()> {
        let name = card.keyword.name;
        let couple = [self.general_surface(row, 0, card), self.general_surface(row, 1, card)];
        let [first, second] = couple;
        // One surface meets itself, as the manual has it.
        let blank_second = row.text(1).is_empty() && !row.text(0).is_empty() && name != "*CONTACT EXCLUSIONS";
        let couple = if blank_second { [first?, first?] } else { [first?, second?] };
        match name {
            INCLUSIONS => {
                row.at_most(2, self.report);
                stated.included.push((couple, row.at));
            }
            "*CONTACT EXCLUSIONS" => {
                row.at_most(2, self.report);
                stated.excluded.push(couple);
            }
            "*CONTACT PROPERTY ASSIGNMENT" => {
                row.at_most(3, self.report);
                let interaction = unquoted(row.text(2));
                if interaction.is_empty() {
                    let message = "the surface interaction is missing";
                    let remedy = "write: first surface, second surface, surface interaction; blank surfaces are all";
                    self.report.error(row.at, name, message, remedy);
                    return None;
                }
                stated.interactions.push((couple, self.refer_interaction(interaction, row.at, name)?));
            }
            "*CONTACT FORMULATION" => {
                row.at_most(3, self.report);
                let pure = match key(row.text(2)).as_str() {
                    "" | "SLAVE" | "SECONDARY" => couple,
                    "MASTER" | "MAIN" => [couple[1], couple[0]],
                    _ => {
                        let message = format!("{} is no part of a surface", row.text(2));
                        self.report.error(
                            row.at,
                            name,
                            message,
                            "write SLAVE or MASTER: the part of the first surface",
                        );
                        return None;
                    }
                };
                if couple[0] == couple[1] {
                    let message = "a surface that meets itself has no secondary and primary one";
                    self.report.error(row.at, name, message, "name two surfaces");
                    return None;
                }
                stated.pure.push(pure);
            }
            _ if card.parameters.word("TYPE") == "SCALEPENALTY" => {
                row.at_most(3, self.report);
                let scale = row.real(2, "factor on the penalty", None, self.report)?;
                if scale <= 0.0 {
                    let message = format!("factor on the penalty {scale} is not positive");
                    self.report.error(row.at, name, message, "give a positive factor");
                    return None;
                }
                stated.scales.push((couple, scale));
            }
            _ => {}
        }
        Some(())
    }

    /// Surface of an item of a line; blank is all exterior. Surfaces of general contact are made of faces without midside nodes.
    fn general_surface(&mut self, row: &Row<'_>, index: usize, card: &Card) -> Option<SurfaceId> {
        let name = unquoted(row.text(index));
        if name.is_empty() {
            return Some(self.all_exterior(card));
        }
        let surface = SurfaceId(self.surfaces.refer(name, row.at, row.keyword, self.report)?);
        let definition = &self.model.mesh.surfaces[surface.index()];
        let what = match &definition.kind {
            SurfaceKind::Faces(_) => return Some(surface),
            SurfaceKind::Nodes(_) => "nodes",
            SurfaceKind::Bars(_) => "bars",
            SurfaceKind::Analytical(_) => "an analytical profile",
        };
        let message = format!("surface {} is made of {what}, and general contact is that of faces", definition.name);
        let remedy = "name a surface of faces, or describe this contact by *CONTACT PAIR";
        self.report.error(row.at, row.keyword, message, remedy);
        None
    }

    /// The surface of all outer faces, added to the model where it is needed first. Facets face the side of their normal.
    fn all_exterior(&mut self, card: &Card) -> SurfaceId {
        let (position, is_new) = self.surfaces.enter(ALL_EXTERIOR, card.at);
        self.surfaces.mark_used(position);
        if is_new {
            let mesh = &self.model.mesh;
            let all = (0..mesh.elements.len()).filter(|&e| {
                let kind = mesh.elements.kind(e);
                kind.is_solid() || kind.is_facet()
            });
            let all: Vec<ElementId> = all.map(|e| ElementId(e as u32)).collect();
            let (facets, solids): (Vec<ElementId>, Vec<ElementId>) =
                all.into_iter().partition(|e| mesh.elements.kind(e.index()).is_facet());
            let mut faces = free_faces(mesh, &solids);
            faces.extend(facets.iter().map(|&element| crate::model::ElementFace { element, face: 0 }));
            faces.sort_unstable();
            if !facets.is_empty() {
                let message = "facets of rigid bodies meet other bodies on the side of their normal (SPOS) only";
                self.report.warning(
                    card.at,
                    card.keyword.name,
                    message,
                    "list their corners so that the normal points outwards",
                );
            }
            self.model.mesh.surfaces.push(Surface { name: ALL_EXTERIOR.into(), kind: SurfaceKind::Faces(faces) });
        }
        SurfaceId(position)
    }

    /// Adds the parts of a general contact to the model; their positions.
    fn general_parts(&mut self, stated: Stated<'_>, step: Option<usize>) -> Vec<usize> {
        let Some(opening) = stated.opening.filter(|_| stated.sound) else { return Vec::new() };
        if stated.included.is_empty() {
            if opening.parameters.word("OP") != "NEW" {
                let remedy =
                    "write *CONTACT INCLUSIONS, ALL EXTERIOR, or couples of surfaces under *CONTACT INCLUSIONS";
                self.report.error(opening.at, CONTACT, "nothing is included in general contact", remedy);
            }
            return Vec::new();
        }
        let named = stated.interactions.iter().map(|&(couple, _)| couple);
        let named = named.chain(stated.pure.iter().copied()).chain(stated.scales.iter().map(|&(couple, _)| couple));
        let is_included = |couple: &Couple| {
            let included = stated.included.iter().any(|&(wide, _)| self.covers(wide, *couple));
            included && !stated.excluded.iter().any(|&wide| self.covers(wide, *couple))
        };
        // From wide to narrow, each couple once.
        let mut couples: Vec<Couple> = stated.included.iter().map(|&(couple, _)| couple).collect();
        couples.extend(named.filter(is_included));
        couples.sort_by_key(|couple| couple.iter().filter(|&&surface| !self.is_all(surface)).count());
        let mut parts: Vec<Couple> = Vec::new();
        for couple in couples {
            if !parts.iter().any(|&known| same(known, couple)) {
                parts.push(couple);
            }
        }
        let of_pairs: Vec<Couple> = (self.model.pairs.iter())
            .filter_map(|pair| pair.surfaces().map(|pair| [pair.secondary, pair.primary]))
            .filter(|couple| !couple.iter().any(|&surface| self.is_analytical(surface)))
            .collect();
        let mut added = Vec::new();
        for (position, &couple) in parts.iter().enumerate() {
            let interaction =
                stated.interactions.iter().rev().find(|(wide, _)| self.covers(*wide, couple)).map(|i| i.1);
            let pure = stated.pure.iter().rev().find(|&&wide| self.covers(wide, couple)).copied();
            let scale = stated.scales.iter().rev().find(|(wide, _)| self.covers(*wide, couple)).map_or(1.0, |s| s.1);
            let interaction = interaction.unwrap_or_else(|| self.default_interaction(opening));
            let surfaces = match pure {
                Some(pure) if same(pure, couple) => pure,
                _ => couple,
            };
            let excluded = stated.excluded.iter().chain(&parts[position + 1..]).chain(&of_pairs).copied().collect();
            let weight = Weight(if pure.is_some() { 1.0 } else { 0.5 });
            if !self.sides_fit(surfaces, opening.at) {
                continue;
            }
            let name = match surfaces.iter().all(|&surface| self.is_all(surface)) {
                true => "GENERAL_CONTACT".to_string(),
                false => format!("GENERAL_{}", self.pair_name(surfaces[0], surfaces[1])),
            };
            let pair = self.model.pairs.len();
            let name =
                if self.pairs.contains(&key(&name)) { format!("{name}_{}", step.unwrap_or(0) + 1) } else { name };
            self.push_pair(
                ContactPair {
                    name,
                    members: PairMembers::General(GeneralContact { surfaces, excluded }),
                    interaction,
                    explicit: ExplicitContact { constraint: MechanicalConstraint::Penalty, weight },
                    place: self.map.place(opening.at),
                },
                opening.at,
            );
            if self.model.pairs.len() > pair {
                self.pair_events.push(PairEvent { step: step.unwrap_or(0), pair, active: true });
                self.general_interactions.push(interaction);
                self.general_scales.push((pair, scale));
                added.push(pair);
            }
        }
        added
    }

    /// Nodes of both surfaces become contact points: their faces have no midside nodes.
    fn sides_fit(&mut self, surfaces: Couple, at: At) -> bool {
        let mesh = &self.model.mesh;
        for surface in surfaces {
            let definition = &mesh.surfaces[surface.index()];
            let SurfaceKind::Faces(faces) = &definition.kind else { continue };
            if !self.budget.take(4 * faces.len(), at, CONTACT, self.report) {
                return false;
            }
            if let Some(face) = faces.iter().find(|&&face| mesh.face_nodes(face).is_quadratic()) {
                let message = format!(
                    "surface {} has faces with midside nodes (element {}, {}): their corners stand for no area or a negative one",
                    definition.name,
                    mesh.element_labels[face.element.index()],
                    mesh.elements.kind(face.element.index()).name()
                );
                let remedy = "mesh the body with C3D4, C3D6 or C3D8, or name it as a primary surface in a *CONTACT PAIR and exclude it";
                self.report.error(at, CONTACT, message, remedy);
                return false;
            }
        }
        true
    }

    fn is_all(&self, surface: SurfaceId) -> bool {
        self.model.mesh.surfaces[surface.index()].name == ALL_EXTERIOR
    }

    pub(super) fn is_analytical(&self, surface: SurfaceId) -> bool {
        matches!(self.model.mesh.surfaces[surface.index()].kind, SurfaceKind::Analytical(_))
    }

    /// Whether what is said of one couple holds for another: they are the same, or one surface is all exterior in the first.
    fn covers(&self, wide: Couple, couple: Couple) -> bool {
        let fits = |wide: SurfaceId, surface: SurfaceId| wide == surface || self.is_all(wide);
        let [a, b] = couple;
        (fits(wide[0], a) && fits(wide[1], b)) || (fits(wide[0], b) && fits(wide[1], a))
    }
}

/// Whether two couples are of the same surfaces.
fn same(a: Couple, b: Couple) -> bool {
    a == b || a == [b[1], b[0]]
}
