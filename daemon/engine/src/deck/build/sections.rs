//! `*SOLID SECTION`, `*SPRING`, `*DASHPOT`, `*MASS` and `*ROTARY INERTIA`: what each element is made of.

use crate::model::{Connector, ElementId, ElementKind, MaterialId, SetId, SolidSection};

use super::super::card::Card;
use super::super::data::Row;
use super::super::report::{At, Report};
use super::Builder;
use super::layout::Layout;

const SOLID: &str = "*SOLID SECTION";
const SPRING: &str = "*SPRING";
const DASHPOT: &str = "*DASHPOT";
const MASS: &str = "*MASS";
const ROTARY_INERTIA: &str = "*ROTARY INERTIA";

/// Cross-section area of a bar whose section gives none.
const AREA: f64 = 1.0;

/// What a section says of one of its elements.
#[derive(Clone, Copy, PartialEq)]
struct Assigned {
    material: MaterialId,
    connector: Option<Connector>,
}

/// Keyword of the section that a kind needs, and what to do about an element without it.
fn section_of(kind: ElementKind) -> (&'static str, &'static str) {
    match kind {
        ElementKind::SpringA | ElementKind::Spring1 | ElementKind::Spring2 => {
            (SPRING, "give their set a *SPRING with a stiffness")
        }
        ElementKind::Mass => (MASS, "give their set a *MASS"),
        ElementKind::DashpotA | ElementKind::Dashpot1 | ElementKind::Dashpot2 => {
            (DASHPOT, "give their set a *DASHPOT with a coefficient")
        }
        ElementKind::RotaryI => (ROTARY_INERTIA, "give their set a *ROTARY INERTIA"),
        kind if kind.is_gap() => ("*GAP", "give their set a *GAP"),
        kind if kind.is_facet() => ("*RIGID BODY", "name their set in a *RIGID BODY"),
        _ => (SOLID, "give their set a *SOLID SECTION with a material"),
    }
}

impl Builder<'_> {
    pub(super) fn build_sections(&mut self, layout: &Layout<'_>) {
        let inert = Assigned { material: MaterialId::NONE, connector: Some(Connector::Inert) };
        let of_kind = |kind: ElementKind| (kind.is_gap() || kind.is_facet()).then_some(inert);
        let mut owner: Vec<Option<Assigned>> = self.model.mesh.elements.iter().map(|(kind, _)| of_kind(kind)).collect();
        let mut sound = true;
        for card in &layout.model {
            let done = match card.keyword.name {
                SOLID => self.solid_section(card, &mut owner),
                SPRING | DASHPOT | MASS | ROTARY_INERTIA => self.connector_section(card, &mut owner),
                _ => continue,
            };
            sound &= done.is_some();
        }
        if sound {
            self.without_section(&owner);
        }
        let material = |owner: &Option<Assigned>| owner.map_or(MaterialId::NONE, |assigned| assigned.material);
        self.model.mesh.element_materials = owner.iter().map(material).collect();
        let connectors = (0..).zip(&owner).filter_map(|(e, owner)| Some((ElementId(e), (*owner)?.connector?)));
        self.model.mesh.connectors = connectors.collect();
    }

    /// Elements of the set of a section; none when it is not to be relied on, which is reported. All of them are of a
    /// kind that takes the section.
    fn section_elements(&mut self, card: &Card) -> Option<(SetId, Vec<ElementId>)> {
        let keyword = card.keyword.name;
        let set = self.element_sets.refer(card.parameters.value("ELSET")?, card.at, keyword, self.report)?;
        let mesh = &self.model.mesh;
        let definition = &mesh.element_sets[set as usize];
        if definition.elements.is_empty() {
            let message = format!("element set {} is empty", definition.name);
            self.report.warning(card.at, keyword, message, "the section has no effect");
        }
        if !self.budget.take(definition.elements.len(), card.at, keyword, self.report) {
            return None;
        }
        let kind = |element: &ElementId| mesh.elements.kind(element.index());
        let mut foreign = definition.elements.iter().filter(|element| section_of(kind(element)).0 != keyword);
        if let Some(first) = foreign.next() {
            let (label, kind) = (mesh.element_labels[first.index()], kind(first));
            let more = match foreign.count() {
                0 => String::new(),
                count => format!(" and {count} others of the set do"),
            };
            let message = format!("element {label} of type {} takes no {keyword}{more}", kind.name());
            let remedy = format!("name a set without it; {} takes {}", kind.name(), section_of(kind).0);
            self.report.error(card.at, keyword, message, remedy);
            return None;
        }
        Some((SetId(set), definition.elements.clone()))
    }

    fn solid_section(&mut self, card: &Card, owner: &mut [Option<Assigned>]) -> Option<()> {
        let found = self.section_elements(card);
        let name = card.parameters.value("MATERIAL")?;
        // A faulty material is still the material of its elements.
        let known = self.materials.find(name).filter(|&position| self.materials.is_faulty(position));
        let material = known.or_else(|| self.materials.refer(name, card.at, SOLID, self.report));
        if let Some(position) = material {
            self.materials.mark_used(position);
        }
        let ((set, elements), material) = (found?, MaterialId(material?));
        let is_bar = |element: &ElementId| self.model.mesh.elements.kind(element.index()) == ElementKind::T3D2;
        let bars: Vec<ElementId> = elements.iter().copied().filter(is_bar).collect();
        let area = if bars.is_empty() { Some(AREA) } else { area(card, self.report) };
        for element in elements {
            let connector = bars.binary_search(&element).is_ok().then(|| Connector::Bar { area: area.unwrap_or(AREA) });
            self.assign(element, Assigned { material, connector }, card.at, SOLID, owner);
        }
        self.model.sections.push(SolidSection { element_set: set, material });
        area.map(|_| ())
    }

    fn connector_section(&mut self, card: &Card, owner: &mut [Option<Assigned>]) -> Option<()> {
        let (_, elements) = self.section_elements(card)?;
        if card.faulty {
            return None;
        }
        let Some(first) = elements.first() else { return Some(()) };
        let mesh = &self.model.mesh;
        let kind = mesh.elements.kind(first.index());
        if let Some(other) = elements.iter().find(|element| mesh.elements.kind(element.index()) != kind) {
            let message = format!(
                "the set holds {} (element {}) and {} (element {})",
                kind.name(),
                mesh.element_labels[first.index()],
                mesh.elements.kind(other.index()).name(),
                mesh.element_labels[other.index()]
            );
            self.report.error(card.at, card.keyword.name, message, "give each type a set and a section of its own");
            return None;
        }
        let connector = match kind {
            ElementKind::Mass => mass(card, self.report)?,
            ElementKind::RotaryI => rotary_inertia(card, self.report)?,
            _ => spring_or_dashpot(card, kind, self.report)?,
        };
        for element in elements {
            let assigned = Assigned { material: MaterialId::NONE, connector: Some(connector) };
            self.assign(element, assigned, card.at, card.keyword.name, owner);
        }
        Some(())
    }

    fn assign(
        &mut self,
        element: ElementId,
        assigned: Assigned,
        at: At,
        keyword: &str,
        owner: &mut [Option<Assigned>],
    ) {
        let Some(other) = owner[element.index()].replace(assigned).filter(|other| *other != assigned) else { return };
        let label = self.model.mesh.element_labels[element.index()];
        let message = if other.material == assigned.material {
            format!("element {label} has a section with other values already")
        } else {
            format!("element {label} is of material {} already", self.materials.written(other.material.0))
        };
        self.report.error(at, keyword, message, "give each element one section");
    }

    /// Dashpots act in dynamic steps only.
    pub(super) fn check_dashpots(&mut self, layout: &Layout<'_>) {
        let is_static =
            |step: &&super::layout::StepCards<'_>| step.cards.iter().any(|card| card.keyword.name == "*STATIC");
        let Some(step) = layout.steps.iter().find(is_static) else { return };
        for card in layout.model.iter().filter(|card| card.keyword.name == DASHPOT) {
            if layout.has_dynamics() {
                let message = "dashpots have no force in the static steps of the deck";
                self.report.warning(card.at, DASHPOT, message, "let the static steps hold every body without them");
            } else {
                let message = "dashpots act in dynamic steps, and the deck has none";
                let remedy = "remove them, or write *DYNAMIC for *STATIC";
                self.report.error(card.at.min(step.opening.at), DASHPOT, message, remedy);
            }
        }
    }

    /// Elements without a section: one finding for each kind of section.
    fn without_section(&mut self, owner: &[Option<Assigned>]) {
        let mut without: Vec<(&str, &str, usize, usize)> = Vec::new();
        for (position, _) in owner.iter().enumerate().filter(|(_, owner)| owner.is_none()) {
            let (keyword, remedy) = section_of(self.model.mesh.elements.kind(position));
            match without.iter_mut().find(|entry| entry.0 == keyword) {
                Some((.., count)) => *count += 1,
                None => without.push((keyword, remedy, position, 1)),
            }
        }
        for (keyword, remedy, first, count) in without {
            let label = self.model.mesh.element_labels[first];
            let what = if keyword == SOLID { "section".into() } else { keyword.to_string() };
            let message = format!("{count} elements have no {what}, the first is element {label}");
            self.report.error(self.element_at[first], "*ELEMENT", message, remedy);
        }
    }
}

/// Cross-section area of bars: the first item of the data line.
fn area(card: &Card, report: &mut Report) -> Option<f64> {
    let row = card.first_line().map(|line| line.row(SOLID));
    let Some(row) = row.filter(|row| !row.text(0).is_empty()) else {
        let message = format!("the section of the bars gives no area: {AREA} is taken");
        report.warning(card.at, SOLID, message, "give the cross-section area on the data line");
        return Some(AREA);
    };
    row.at_most(1, report);
    positive(&row, "cross-section area", report)
}

fn positive(row: &Row<'_>, what: &str, report: &mut Report) -> Option<f64> {
    let value = row.real(0, what, None, report)?;
    if value > 0.0 {
        return Some(value);
    }
    report.error(row.at, row.keyword, format!("{what} {value} is not positive"), format!("give a positive {what}"));
    None
}

fn not_negative(row: &Row<'_>, what: &str, report: &mut Report) -> Option<f64> {
    let value = row.real(0, what, None, report)?;
    if value >= 0.0 {
        return Some(value);
    }
    report.error(row.at, row.keyword, format!("{what} {value} is negative"), format!("give a positive {what}"));
    None
}

fn mass(card: &Card, report: &mut Report) -> Option<Connector> {
    let alpha = damping_factor(card, report);
    let row = card.single_row("mass", report)?;
    row.at_most(1, report);
    Some(Connector::Mass { mass: not_negative(&row, "mass", report)?, alpha: alpha? })
}

/// `ALPHA` of a section; `None` when it is wrong, which is reported.
fn damping_factor(card: &Card, report: &mut Report) -> Option<f64> {
    if card.parameters.has("ALPHA") { super::materials::not_negative(card, "ALPHA", report) } else { Some(0.0) }
}

/// I11, I22, I33, I12, I13, I23 on one line: a matrix without negative eigenvalues.
fn rotary_inertia(card: &Card, report: &mut Report) -> Option<Connector> {
    let alpha = damping_factor(card, report);
    let row = card.single_row("I11, I22, I33, I12, I13, I23", report)?;
    row.at_most(6, report);
    let mut inertia = [0.0; 6];
    for (value, (index, name)) in inertia.iter_mut().zip(["I11", "I22", "I33", "I12", "I13", "I23"].iter().enumerate())
    {
        *value = row.real(index, name, Some(0.0), report)?;
    }
    let [a, b, c, d, e, f] = inertia;
    // Principal minors of the matrix, each up to rounding of its terms: all are positive or zero in a body of mass.
    let scale = a.abs().max(b.abs()).max(c.abs());
    let minors = [
        a,
        b,
        c,
        (a * b - d * d) / scale,
        (a * c - e * e) / scale,
        (b * c - f * f) / scale,
        (a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e)) / (scale * scale),
    ];
    if scale > 0.0 && minors.into_iter().all(|minor| minor >= -1e-12 * scale) {
        return Some(Connector::RotaryInertia { inertia, alpha: alpha? });
    }
    let message = if scale == 0.0 {
        "the moments of inertia are zero".to_string()
    } else {
        format!("no body has the moments of inertia {a}, {b}, {c} with the products {d}, {e}, {f}")
    };
    let remedy = "give I11, I22, I33, I12, I13, I23 of a body about the node";
    report.error(row.at, ROTARY_INERTIA, message, remedy);
    None
}

/// A line of directions (none for SPRINGA and DASHPOTA, where it is blank), then the stiffness or the coefficient.
fn spring_or_dashpot(card: &Card, kind: ElementKind, report: &mut Report) -> Option<Connector> {
    let keyword = card.keyword.name;
    let is_spring = keyword == SPRING;
    let rows: Vec<Row<'_>> = card.lines().iter().map(|line| line.row(keyword)).collect();
    let rows: Vec<&Row<'_>> = rows.iter().filter(|row| row.fields.iter().any(|field| !field.is_empty())).collect();
    let what = if is_spring { "stiffness" } else { "damping coefficient" };
    let (nodes, layout) = match kind {
        ElementKind::SpringA | ElementKind::DashpotA => (0, format!("write a blank line, then: {what}")),
        ElementKind::Spring1 | ElementKind::Dashpot1 => (1, format!("write two lines: direction; {what}")),
        _ => (2, format!("write two lines: direction at node 1, direction at node 2; {what}")),
    };
    let lines = 1 + usize::from(nodes > 0);
    if let Some(extra) = rows.get(lines) {
        let message = format!("{} takes {lines} lines of data; a further one is not read", kind.name());
        let on = if is_spring { "elongation" } else { "velocity" };
        let remedy = format!("{layout}; a {what} that depends on temperature or {on} is not solved");
        report.error(extra.at, keyword, message, remedy);
        return None;
    }
    let Some(row) = rows.get(lines - 1) else {
        report.error(card.at, keyword, format!("a line of data of {} is missing", kind.name()), layout);
        return None;
    };
    if row.fields.iter().skip(1).any(|field| !field.is_empty()) {
        let message = format!("frequency and temperature behind the {what} are ignored: it is the same for all");
        report.warning(row.at, keyword, message, "");
        row.at_most(3, report);
    }
    let value = not_negative(row, what, report);
    let mut directions = [0; 2];
    if nodes > 0 {
        rows[0].at_most(nodes, report);
        for (node, direction) in directions.iter_mut().enumerate().take(nodes) {
            *direction = spring_direction(rows[0], node, report)?;
        }
    }
    let value = value?;
    Some(if is_spring {
        Connector::Spring { stiffness: value, directions }
    } else {
        Connector::Dashpot { coefficient: value, directions }
    })
}

fn spring_direction(row: &Row<'_>, node: usize, report: &mut Report) -> Option<u8> {
    let what = format!("direction at node {}", node + 1);
    let dof = row.whole(node, &what, None, report)?;
    if (1..=3).contains(&dof) {
        return Some(dof as u8 - 1);
    }
    report.error(row.at, row.keyword, format!("{what}: {dof} does not exist"), "write 1 (x), 2 (y) or 3 (z)");
    None
}
