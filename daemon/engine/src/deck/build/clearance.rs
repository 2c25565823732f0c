//! `*CLEARANCE`: initial clearances that win over the geometry.

use std::collections::BTreeMap;

use crate::model::{NodeId, SurfaceId};

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
        for card in layout.model.iter().filter(|card| card.keyword.name == CLEARANCE) {
            let (Some(secondary), Some(primary)) = (card.parameters.value("SLAVE"), card.parameters.value("MASTER"))
            else {
                continue;
            };
            let pair = self.pair_of_surfaces(secondary, primary, card.at, CLEARANCE);
            let Some(surfaces) = pair.and_then(|pair| self.model.pairs[pair].surfaces()) else { continue };
            let (surface, is_adjusted) = (surfaces.secondary, surfaces.adjust.is_some());
            let Some(clearances) = self.clearances(card, surface) else { continue };
            let Some(pair) = pair else { continue };
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
    }

    /// Nodes and their clearances as a card gives them; `None` when it is wrong, which is reported.
    fn clearances(&mut self, card: &Card, surface: SurfaceId) -> Option<Vec<(NodeId, f64)>> {
        let nodes = self.surface_nodes(surface);
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
