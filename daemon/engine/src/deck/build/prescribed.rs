//! `*BOUNDARY`: lines to single directions, and which line prescribes which direction of a node.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use crate::model::{Boundary, BoundaryKind, Dialect, Model, NodeId};

use super::super::card::Card;
use super::super::data::Row;
use super::super::lex::{key, looks_numeric};
use super::super::report::{At, excerpt};
use super::Builder;
use super::layout::Layout;

const BOUNDARY: &str = "*BOUNDARY";

/// Where a `*BOUNDARY` stands.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Before the first step.
    Model,
    /// In a static step.
    Static,
    /// In a dynamic step.
    Dynamic,
}

/// Named types and their degrees of freedom.
const NAMED: [(&str, &[u32]); 8] = [
    ("XSYMM", &[1, 5, 6]),
    ("YSYMM", &[2, 4, 6]),
    ("ZSYMM", &[3, 4, 5]),
    ("XASYMM", &[2, 3, 4]),
    ("YASYMM", &[1, 3, 5]),
    ("ZASYMM", &[1, 2, 6]),
    ("PINNED", &[1, 2, 3]),
    ("ENCASTRE", &[1, 2, 3, 4, 5, 6]),
];

impl Builder<'_> {
    /// Hands over the lines of a `*BOUNDARY`, one boundary per direction, each with its line.
    pub(super) fn boundary_card(&mut self, card: &Card, part: Part, mut push: impl FnMut(At, Boundary)) {
        let Ok(mut amplitude) = self.amplitude(card) else { return };
        let early_values = part == Part::Model && self.model.dialect == Dialect::Calculix;
        if part == Part::Model && !early_values && amplitude.take().is_some() {
            self.report.warning(card.at, BOUNDARY, "AMPLITUDE is ignored: values before the first step are 0", "");
        }
        if card.faulty {
            return;
        }
        let kind = match card.parameters.word("TYPE").as_str() {
            "VELOCITY" => BoundaryKind::Velocity,
            "ACCELERATION" => BoundaryKind::Acceleration,
            _ => BoundaryKind::Displacement,
        };
        if part == Part::Static && kind != BoundaryKind::Displacement {
            let message = format!("TYPE={} in a static step", card.parameters.word("TYPE"));
            let remedy = "prescribe the displacements of the step, or write *DYNAMIC for *STATIC";
            return self.report.error(card.at, BOUNDARY, message, remedy);
        }
        // What is held before the first step stays where it is: a velocity or acceleration of zero is a displacement of zero.
        let kind = if part == Part::Model { BoundaryKind::Displacement } else { kind };
        let mut warned = false;
        for line in card.lines().iter() {
            let row = line.row(BOUNDARY);
            row.at_most(4, self.report);
            let region = self.node_region(&row);
            let directions = self.directions(&row);
            let magnitude = row.real(3, "magnitude", Some(0.0), self.report);
            let (Some(region), Some(directions), Some(magnitude)) = (region, directions, magnitude) else { continue };
            if early_values && magnitude != 0.0 && !std::mem::replace(&mut warned, true) {
                let message = format!("value {magnitude} before the first step: it is reached over the first step");
                self.report.warning(row.at, BOUNDARY, message, "write values that are not 0 into the step");
            }
            if part == Part::Model && !early_values && magnitude != 0.0 {
                let message = format!("value {magnitude} before the first step");
                self.report.error(
                    row.at,
                    BOUNDARY,
                    message,
                    "move the line into the step in which the value is reached",
                );
                continue;
            }
            let nodes_along = |direction: &u8| match direction {
                0..=2 => region.members.clone(),
                _ => region.members.iter().filter_map(|&node| self.model.mesh.rotation_of(node)).collect(),
            };
            let along: Vec<_> = directions.iter().map(|d| (d % 3, nodes_along(d))).collect();
            let ignored = directions.iter().zip(&along).filter(|(_, (_, nodes))| nodes.is_empty()).map(|(d, _)| d + 1);
            if let (Some(first), true) = (ignored.clone().min(), looks_numeric(row.text(1).as_bytes())) {
                let last = ignored.max().unwrap_or(first);
                let message = format!(
                    "degrees of freedom {first} to {last} are ignored: only reference nodes of rigid bodies and nodes of ROTARYI have rotations"
                );
                self.report.warning(row.at, BOUNDARY, message, "");
            }
            for (direction, nodes) in along.into_iter().filter(|(_, nodes)| !nodes.is_empty()) {
                let boundary = Boundary {
                    kind,
                    region: region.region.clone(),
                    region_name: region.name.clone(),
                    nodes,
                    direction,
                    magnitude,
                    amplitude,
                    place: self.map.place(row.at),
                };
                push(row.at, boundary);
            }
        }
    }

    /// Displacements that are reached at once: an infinite velocity. Those that an earlier step has reached stay.
    pub(super) fn check_jumps(&mut self, boundaries: &[Boundary], lines: &[At]) {
        for (boundary, &at) in boundaries.iter().zip(lines) {
            let earlier = self.model.steps.iter().flat_map(|step| &step.boundaries).rev();
            let mut earlier =
                earlier.filter(|other| (&other.region, other.direction) == (&boundary.region, boundary.direction));
            let is_jump = boundary.kind == BoundaryKind::Displacement
                && boundary.amplitude.is_none()
                && boundary.magnitude != 0.0
                && earlier.next().is_none_or(|other| {
                    other.kind != boundary.kind || other.magnitude != boundary.magnitude || other.amplitude.is_some()
                });
            if !is_jump {
                continue;
            }
            let (name, magnitude) = (&boundary.region_name, boundary.magnitude);
            let message = format!(
                "{name} is displaced by {magnitude} at once: a dynamic step does not ramp values without an amplitude"
            );
            let remedy = "give AMPLITUDE with a curve from 0, prescribe TYPE=VELOCITY, or write *STEP, AMPLITUDE=RAMP";
            self.report.warning(at, BOUNDARY, message, remedy);
        }
    }

    /// Directions that a line names: displacements 0..3, rotations 3..6.
    fn directions(&mut self, row: &Row<'_>) -> Option<Vec<u8>> {
        let first = row.text(1);
        if !first.is_empty() && !looks_numeric(first.as_bytes()) {
            let word = key(first);
            let Some((_, dofs)) = NAMED.iter().find(|(name, _)| *name == word) else {
                let names: Vec<_> = NAMED.iter().map(|(name, _)| *name).collect();
                let message = format!("there is no boundary type {}", excerpt(first.as_bytes()));
                self.report.error(
                    row.at,
                    BOUNDARY,
                    message,
                    format!("write degrees of freedom 1 to 3, or {}", names.join(", ")),
                );
                return None;
            };
            return Some(dofs.iter().map(|&dof| dof as u8 - 1).collect());
        }
        let first = row.whole(1, "first degree of freedom", None, self.report)?;
        let last = row.whole(2, "last degree of freedom", Some(first), self.report)?;
        if first == 0 || last < first || last > 6 {
            let message = format!("degrees of freedom {first} to {last} do not exist");
            self.report.error(
                row.at,
                BOUNDARY,
                message,
                "write first and last of 1 (x), 2 (y), 3 (z), on reference nodes of rigid bodies also of 4 to 6",
            );
            return None;
        }
        Some((first..=last).map(|dof| dof as u8 - 1).collect())
    }

    /// Checks over all steps: every step prescribes the same directions, and each by one line.
    pub(super) fn check_prescribed(&mut self, layout: &Layout<'_>) {
        let mut prescribed = vec![0u8; self.model.mesh.nodes.len()];
        for boundary in &self.model.initial_boundaries {
            boundary.nodes.iter().for_each(|node| prescribed[node.index()] |= 1 << boundary.direction);
        }
        for (step, cards) in layout.steps.iter().enumerate() {
            if step >= self.model.steps.len() {
                break;
            }
            self.one_line_per_direction(step);
            let cards: Vec<&Card> = cards.cards.iter().copied().filter(|card| card.keyword.name == BOUNDARY).collect();
            if let Some(new) = cards.iter().find(|card| card.parameters.word("OP") == "NEW") {
                self.nothing_is_freed(step, &prescribed, new.at);
            }
            let mut added = None;
            for (line, boundary) in self.model.steps[step].boundaries.iter().enumerate() {
                let bit = 1 << boundary.direction;
                for node in &boundary.nodes {
                    if prescribed[node.index()] & bit == 0 {
                        added = added.or(Some((line, *node, boundary.direction)));
                        prescribed[node.index()] |= bit;
                    }
                }
            }
            if let (Some((line, node, direction)), true) = (added, step > 0) {
                let message = format!(
                    "degree of freedom {} of node {} is prescribed here for the first time",
                    self.model.mesh.dof_of(node, direction),
                    self.label(node.index())
                );
                let remedy = "a step that holds further nodes is not solved: prescribe them from the first step on";
                self.report.error(self.step_lines[step][line], BOUNDARY, message, remedy);
            }
        }
    }

    /// `OP=NEW` may replace values, not free what was prescribed before.
    fn nothing_is_freed(&mut self, step: usize, prescribed: &[u8], at: At) {
        if !self.budget.take(prescribed.len(), at, BOUNDARY, self.report) {
            return;
        }
        let mut here = vec![0u8; prescribed.len()];
        for boundary in &self.model.steps[step].boundaries {
            boundary.nodes.iter().for_each(|node| here[node.index()] |= 1 << boundary.direction);
        }
        let freed = prescribed.iter().zip(&here).map(|(before, now)| before & !now);
        if let Some((node, bits)) = freed.enumerate().find(|&(_, bits)| bits != 0) {
            let direction = self.model.mesh.dof_of(NodeId(node as u32), bits.trailing_zeros() as u8);
            let message = format!("OP=NEW would free degree of freedom {direction} of node {}", self.label(node));
            let remedy = "a step that frees nodes is not solved: use OP=MOD, or prescribe them again";
            self.report.error(at, BOUNDARY, message, remedy);
        }
    }

    fn label(&self, node: usize) -> u32 {
        self.model.mesh.node_labels[node]
    }

    /// Takes nodes out of lines that a later line of the step overrides. Two values that differ and are not 0 are an error.
    fn one_line_per_direction(&mut self, step: usize) {
        let Model { steps, mesh, .. } = &mut self.model;
        let boundaries = &mut steps[step].boundaries;
        let mut line_of: FxHashMap<(NodeId, u8), usize> = FxHashMap::default();
        // (overridden line, line that counts): number of nodes and the first one.
        let mut overridden: BTreeMap<(usize, usize), (usize, NodeId)> = BTreeMap::new();
        let mut lost: Vec<Vec<NodeId>> = vec![Vec::new(); boundaries.len()];
        for (line, boundary) in boundaries.iter().enumerate() {
            for &node in &boundary.nodes {
                if let Some(earlier) = line_of.insert((node, boundary.direction), line) {
                    overridden.entry((earlier, line)).or_insert((0, node)).0 += 1;
                    lost[earlier].push(node);
                }
            }
        }
        for ((earlier, later), (count, node)) in overridden {
            let (before, now) = (&boundaries[earlier], &boundaries[later]);
            let at = self.step_lines[step][later];
            let direction = mesh.dof_of(node, now.direction);
            let label = mesh.node_labels[node.index()];
            let same = (before.magnitude, before.amplitude, before.kind) == (now.magnitude, now.amplitude, now.kind);
            if !same && before.magnitude != 0.0 && now.magnitude != 0.0 {
                let message = format!(
                    "degree of freedom {direction} of node {label} is prescribed as {} and as {} in one step",
                    before.magnitude, now.magnitude
                );
                self.report.error(at, BOUNDARY, message, "prescribe it once");
            } else if before.magnitude != 0.0 || now.magnitude != 0.0 {
                let message = format!(
                    "degree of freedom {direction} of {count} nodes, the first is node {label}, is prescribed as {} and again as {}: this line counts",
                    before.magnitude, now.magnitude
                );
                self.report.warning(at, BOUNDARY, message, "prescribe each node once");
            }
        }
        for (boundary, lost) in boundaries.iter_mut().zip(&mut lost) {
            if !lost.is_empty() {
                lost.sort_unstable();
                boundary.nodes.retain(|node| lost.binary_search(node).is_err());
            }
        }
        let mut kept = boundaries.iter().map(|boundary| !boundary.nodes.is_empty()).collect::<Vec<_>>().into_iter();
        self.step_lines[step].retain(|_| kept.next().unwrap_or(true));
        boundaries.retain(|boundary| !boundary.nodes.is_empty());
    }
}
