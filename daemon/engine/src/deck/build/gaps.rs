//! `*GAP`: contact elements between two nodes.

use rustc_hash::FxHashMap;

use crate::contact::points::direction;
use crate::element::quad::{dot, norm, sub};
use crate::model::{ContactPair, Dialect, ElementId, ElementKind, GapElement, GapKind, PairMembers};

use super::super::card::Card;
use super::super::data::Row;
use super::super::report::At;
use super::Builder;
use super::layout::Layout;

const GAP: &str = "*GAP";
/// Area of a gap that gives none: its pressure is a force.
const AREA: f64 = 1.0;
/// Part of the distance of two nodes below which their distance from an axis is rounding.
const ON_AXIS: f64 = 1e-12;

/// What the data line says of all elements of a set.
struct Given {
    distance: f64,
    axis: Option<[f64; 3]>,
    area: f64,
}

impl Builder<'_> {
    /// Makes a pair of each `*GAP`; behind the interactions.
    pub(super) fn build_gaps(&mut self, layout: &Layout<'_>) {
        let mut owner: FxHashMap<ElementId, At> = FxHashMap::default();
        for card in layout.model.iter().filter(|card| card.keyword.name == GAP) {
            if self.is_explicit {
                let message = "contact elements belong to static and implicit analyses";
                let remedy = "describe the contact by *CONTACT PAIR with a surface of nodes, TYPE=NODE";
                self.report.error(card.at, GAP, message, remedy);
            }
            self.gap_card(card, &mut owner);
        }
        let mesh = &self.model.mesh;
        let gaps = mesh.elements.iter().enumerate().filter(|(_, (kind, _))| kind.is_gap());
        let mut without = gaps.map(|(e, _)| e).filter(|&e| !owner.contains_key(&ElementId(e as u32)));
        if let Some(first) = without.next() {
            let (label, count) = (mesh.element_labels[first], 1 + without.count());
            let message = format!("{count} GAP elements have no *GAP, the first is element {label}");
            self.report.error(
                self.element_at[first],
                "*ELEMENT",
                message,
                "give their set a *GAP with the initial opening and the direction",
            );
        }
    }

    fn gap_card(&mut self, card: &Card, owner: &mut FxHashMap<ElementId, At>) -> Option<()> {
        let interaction = self.element_interaction(card);
        let set = self.element_sets.refer(card.parameters.value("ELSET")?, card.at, GAP, self.report)?;
        let definition = &self.model.mesh.element_sets[set as usize];
        let (name, elements) = (definition.name.clone(), definition.elements.clone());
        if elements.is_empty() {
            let message = format!("element set {name} is empty");
            self.report.error(card.at, GAP, message, "fill the set, or remove the card");
            return None;
        }
        if !self.budget.take(elements.len(), card.at, GAP, self.report) {
            return None;
        }
        let kinds = &self.model.mesh.elements;
        let (first, label) =
            (kinds.kind(elements[0].index()), |e: ElementId| self.model.mesh.element_labels[e.index()]);
        if let Some(&other) = elements.iter().find(|e| !kinds.kind(e.index()).is_gap()) {
            let message =
                format!("element {} of type {} takes no *GAP", label(other), kinds.kind(other.index()).name());
            self.report.error(card.at, GAP, message, "name a set of GAPUNI, GAPCYL or GAPSPHER elements");
            return None;
        }
        if let Some(&other) = elements.iter().find(|e| kinds.kind(e.index()) != first) {
            let message = format!(
                "the set holds {} (element {}) and {} (element {})",
                first.name(),
                label(elements[0]),
                kinds.kind(other.index()).name(),
                label(other)
            );
            self.report.error(card.at, GAP, message, "give each type a set and a *GAP of its own");
            return None;
        }
        for &element in &elements {
            if owner.insert(element, card.at).is_some() {
                let message = format!("element {} has a *GAP already", self.model.mesh.element_labels[element.index()]);
                self.report.error(card.at, GAP, message, "give each element one *GAP");
                return None;
            }
        }
        let given = self.gap_line(card, first);
        let given = given.filter(|_| !card.faulty)?;
        let gaps: Vec<Option<GapElement>> = elements.iter().map(|&e| self.gap_element(e, &given, card.at)).collect();
        let gaps = gaps.into_iter().collect::<Option<Vec<GapElement>>>()?;
        let pair = ContactPair {
            explicit: Default::default(),
            name,
            members: PairMembers::Gaps(gaps),
            interaction: interaction?,
            place: self.map.place(card.at),
        };
        self.push_pair(pair, card.at);
        Some(())
    }

    /// `d, nx, ny, nz, area`; a missing line stands for zeros.
    fn gap_line(&mut self, card: &Card, kind: ElementKind) -> Option<Given> {
        let blank = Row { at: card.at, keyword: GAP, fields: Vec::new() };
        let row = card.first_line().map_or(blank, |line| line.row(GAP));
        if let Some(second) = card.lines().get(1) {
            let message = "a second data line is not read here";
            self.report.error(second.at, GAP, message, "write one line: opening, direction (3), area");
            return None;
        }
        if self.model.dialect == Dialect::Calculix && row.fields.iter().skip(5).any(|field| !field.is_empty()) {
            let message = "the spring constant and the tensile force of the gap are not read: contact is hard";
            let remedy = "remove them, or write *SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR under *GAP";
            self.report.error(row.at, GAP, message, remedy);
            return None;
        }
        row.at_most(5, self.report);
        let distance = row.real(0, "initial opening", Some(0.0), self.report);
        let mut vector = [0.0; 3];
        for (i, component) in vector.iter_mut().enumerate() {
            *component = row.real(1 + i, "direction", Some(0.0), self.report)?;
        }
        let area = row.real(4, "area", Some(AREA), self.report)?;
        if area <= 0.0 {
            self.report.error(row.at, GAP, format!("area {area} is not positive"), "give a positive area");
            return None;
        }
        let largest = vector.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        // Scaled first, so that squares neither vanish nor overflow.
        let axis = (largest > 0.0).then(|| direction(vector.map(|x| x / largest)));
        let distance = distance?;
        match kind {
            ElementKind::GapUni => {}
            _ if distance == 0.0 => {
                let message = format!("the distance of {} is 0 or missing", kind.name());
                let remedy = "give the largest distance of the nodes, or the smallest one with a minus sign";
                self.report.error(row.at, GAP, message, remedy);
                return None;
            }
            ElementKind::GapCyl if axis.is_none() => {
                let remedy = "write: distance, then the three components of the axis";
                self.report.error(row.at, GAP, "the axis of GAPCYL is missing", remedy);
                return None;
            }
            ElementKind::GapSpher if axis.is_some() => {
                let message = "GAPSPHER has no direction: items 2 to 4 are not read";
                self.report.error(row.at, GAP, message, "write: distance, , , , area");
                return None;
            }
            _ => {}
        }
        Some(Given { distance, axis, area })
    }

    fn gap_element(&mut self, element: ElementId, given: &Given, at: At) -> Option<GapElement> {
        let mesh = &self.model.mesh;
        let nodes = mesh.elements.nodes(element.index());
        let nodes = [nodes[0], nodes[1]];
        let [first, second] = nodes.map(|n| mesh.nodes[n.index()]);
        let (between, label) = (sub(second, first), mesh.element_labels[element.index()]);
        let distance = norm(between);
        let mut fault = |message: String, remedy: &str| {
            self.report.error(at, GAP, message, remedy);
            None
        };
        let kind = match (mesh.elements.kind(element.index()), given.axis) {
            (ElementKind::GapUni, Some(axis)) => GapKind::Unidirectional(axis),
            (ElementKind::GapUni, None) if distance > 0.0 => GapKind::Unidirectional(between.map(|x| x / distance)),
            (ElementKind::GapUni, None) => {
                let message = format!("the nodes of element {label} are at the same place, so they give no direction");
                return fault(message, "give the direction from node 1 towards node 2 behind the opening");
            }
            (ElementKind::GapCyl, Some(axis)) => {
                let along = dot(between, axis);
                let across = norm(std::array::from_fn(|i| between[i] - along * axis[i]));
                if across <= ON_AXIS * distance {
                    let message = format!("the nodes of element {label} lie on one line along the axis");
                    return fault(message, "move one of them off the axis, so that the contact has a direction");
                }
                GapKind::Cylindrical(axis)
            }
            _ if distance == 0.0 => {
                let message = format!("the nodes of element {label} are at the same place");
                return fault(message, "move one of them, so that the contact has a direction");
            }
            _ => GapKind::Spherical,
        };
        Some(GapElement { element, nodes, kind, distance: given.distance, area: given.area })
    }
}
