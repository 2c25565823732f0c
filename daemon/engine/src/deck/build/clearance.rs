//! `*CLEARANCE`: initial clearances that win over the geometry.

use std::collections::BTreeMap;

use crate::model::NodeId;

use super::super::card::Card;
use super::super::lex::{looks_numeric, real};
use super::super::report::excerpt;
use super::super::rules;
use super::Builder;
use super::layout::Layout;

const CLEARANCE: &str = "*CLEARANCE";

impl Builder<'_> {
    /// Gives pairs their clearances. A node that two lines name has the clearance of the later one.
    pub(super) fn build_clearances(&mut self, layout: &Layout<'_>) {
        for (step, card) in layout.with_explicit_steps().filter(|(_, card)| card.keyword.name == CLEARANCE) {
            let pairs = if self.is_explicit { self.pairs_by_set(step, card) } else { self.pair_by_surfaces(card) };
            for pair in pairs {
                self.clear(pair, card);
            }
        }
    }

    /// The pair of `MASTER` and `SLAVE`.
    fn pair_by_surfaces(&mut self, card: &Card) -> Vec<usize> {
        if card.parameters.has("CPSET") {
            let remedy = "name the pair by MASTER and SLAVE";
            self.report.error(card.at, CLEARANCE, "CPSET belongs to explicit analyses", remedy);
        }
        for name in ["MASTER", "SLAVE"].into_iter().filter(|name| !card.faulty && !card.parameters.has(name)) {
            let message = format!("parameter {name} is missing");
            self.report.error(card.at, CLEARANCE, message, format!("write *CLEARANCE, {name}=…"));
        }
        let (Some(secondary), Some(primary)) = (card.parameters.value("SLAVE"), card.parameters.value("MASTER")) else {
            return Vec::new();
        };
        self.pair_of_surfaces(secondary, primary, card.at, CLEARANCE).into_iter().collect()
    }

    /// The pairs of `CPSET`.
    fn pairs_by_set(&mut self, step: Option<usize>, card: &Card) -> Vec<usize> {
        for name in ["MASTER", "SLAVE"].into_iter().filter(|name| card.parameters.has(name)) {
            let message = format!("{name} belongs to static and implicit analyses");
            let remedy = "name the pairs by CPSET, which their *CONTACT PAIR gives them";
            self.report.error(card.at, CLEARANCE, message, remedy);
        }
        if step.is_some_and(|step| step > 0) {
            self.break_rule(&rules::CLEARANCE_LATER, card.at, CLEARANCE, "");
        }
        match card.parameters.value("CPSET") {
            Some(set) => self.pairs_of_set(set, card).unwrap_or_default(),
            None => {
                if !card.faulty {
                    let remedy = "name a set of pairs: CPSET of *CONTACT PAIR";
                    self.report.error(card.at, CLEARANCE, "parameter CPSET is missing", remedy);
                }
                Vec::new()
            }
        }
    }

    /// Gives a pair the clearances of a card.
    fn clear(&mut self, pair: usize, card: &Card) {
        let definition = &self.model.pairs[pair];
        let Some(surfaces) = definition.surfaces() else { return };
        let is_adjusted = surfaces.adjust.is_some();
        let mut nodes = self.surface_nodes(surfaces.secondary);
        if definition.explicit.weight.0 != 1.0 {
            // Balanced: the nodes of either surface are secondary for a share.
            nodes.extend(self.surface_nodes(surfaces.primary));
            nodes.sort_unstable();
        }
        let Some(clearances) = self.clearances(card, nodes) else { return };
        if self.is_explicit
            && let Some((_, value)) = clearances.iter().find(|(_, value)| *value < 0.0)
        {
            let message = format!("clearance {value} is an overclosure, which explicit analyses do not begin with");
            self.report.error(card.at, CLEARANCE, message, "give clearances from 0 on, or move the nodes");
        }
        if self.finite_sliding.contains(&pair) {
            self.break_rule(&rules::CLEARANCE_SLIDING, card.at, CLEARANCE, "");
        }
        if is_adjusted {
            let message = "ADJUST of the pair moves nodes, and the clearances given here hold all the same";
            self.report.warning(card.at, CLEARANCE, message, "remove ADJUST or *CLEARANCE");
        }
        if let crate::model::PairMembers::Surfaces(surfaces) = &mut self.model.pairs[pair].members {
            let mut merged: BTreeMap<NodeId, f64> = surfaces.clearances.drain(..).collect();
            merged.extend(clearances);
            surfaces.clearances = merged.into_iter().collect();
        }
    }

    /// Nodes and their clearances as a card gives them, of the nodes that have one; `None` when it is wrong, which is reported.
    fn clearances(&mut self, card: &Card, nodes: Vec<NodeId>) -> Option<Vec<(NodeId, f64)>> {
        match (card.parameters.value("VALUE"), card.parameters.has("TABULAR")) {
            (Some(text), false) => {
                if let Some(line) = card.first_line() {
                    let message = "VALUE is the clearance of every node: no data line is read";
                    self.report.error(
                        line.at,
                        CLEARANCE,
                        message,
                        "remove the line, or write TABULAR in place of VALUE",
                    );
                    return None;
                }
                match real(text.as_bytes()) {
                    Ok(value) => Some(nodes.into_iter().map(|node| (node, value)).collect()),
                    Err(fault) => {
                        let message = format!("VALUE={} {}", excerpt(text.as_bytes()), fault.text());
                        self.report.error(card.at, CLEARANCE, message, "give a clearance; negative is an overclosure");
                        None
                    }
                }
            }
            (None, true) => self.table_of_clearances(card, &nodes),
            _ if card.faulty => None,
            _ => {
                let message = "one of VALUE and TABULAR says what the clearances are";
                self.report.error(card.at, CLEARANCE, message, "give one of them");
                None
            }
        }
    }

    fn table_of_clearances(&mut self, card: &Card, secondary: &[NodeId]) -> Option<Vec<(NodeId, f64)>> {
        let mut found = Vec::new();
        let mut sound = !card.faulty;
        if card.first_line().is_none() {
            self.report.error(card.at, CLEARANCE, "the data line is missing", "write: node or node set, clearance");
            return None;
        }
        for line in card.lines().iter() {
            let row = line.row(CLEARANCE);
            if row.fields.iter().skip(2).any(|field| !field.is_empty()) {
                let message = "a normal given with the clearance is not supported and would change the answer";
                let remedy = "contact acts along the normal of the primary surface: write node or node set, clearance";
                self.report.error(row.at, CLEARANCE, message, remedy);
                sound = false;
                continue;
            }
            let region = self.node_region(&row);
            let value = row.real(1, "clearance", None, self.report);
            let (Some(region), Some(value)) = (region, value) else {
                sound = false;
                continue;
            };
            let on_surface: Vec<NodeId> =
                region.members.iter().copied().filter(|node| secondary.binary_search(node).is_ok()).collect();
            let missing = region.members.len() - on_surface.len();
            if on_surface.is_empty() {
                let kind = if looks_numeric(row.text(0).as_bytes()) { "node" } else { "node set" };
                let message = format!("{kind} {} is not on the secondary surface", region.name);
                self.report.error(
                    row.at,
                    CLEARANCE,
                    message,
                    "clearances are those of secondary nodes: name some of them",
                );
                sound = false;
            } else if missing > 0 {
                let message = format!(
                    "{missing} nodes of {} are not on the secondary surface and have no clearance",
                    region.name
                );
                self.report.warning(row.at, CLEARANCE, message, "");
            }
            found.extend(on_surface.into_iter().map(|node| (node, value)));
        }
        sound.then_some(found)
    }
}
