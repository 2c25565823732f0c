//! ADJUST of contact pairs: the parameter, and the nodes that it moves.

use crate::contact::adjust::adjust;
use crate::element::Coordinates;
use crate::model::{Adjust, AdjustRegion, ElementId, NodeId, PairMembers, SetId, SurfaceId};

use super::super::card::Card;
use super::super::lex::{looks_numeric, real};
use super::super::report::excerpt;
use super::Builder;
use super::mesh::shape_fault;

const PAIR: &str = "*CONTACT PAIR";

impl Builder<'_> {
    /// ADJUST: a distance or a node set; `Err` when it is neither, which is reported.
    pub(super) fn adjust_parameter(&mut self, card: &Card) -> Result<Option<Adjust>, ()> {
        let Some(text) = card.parameters.value("ADJUST") else { return Ok(None) };
        let region = if looks_numeric(text.as_bytes()) {
            match real(text.as_bytes()) {
                Ok(distance) if distance >= 0.0 => AdjustRegion::Within(distance),
                _ => {
                    let message = format!("ADJUST={} is no distance", excerpt(text.as_bytes()));
                    let remedy = "give the largest clearance that is closed, 0 for overlaps only, or a node set";
                    self.report.error(card.at, PAIR, message, remedy);
                    return Err(());
                }
            }
        } else {
            AdjustRegion::Set(SetId(self.node_sets.refer(text, card.at, PAIR, self.report).ok_or(())?))
        };
        Ok(Some(Adjust { region, moved: 0, distance_max: 0.0 }))
    }

    /// Moves the nodes, pair by pair in the order of the deck, and looks at the elements that they belong to.
    pub(super) fn adjust_nodes(&mut self) {
        for index in 0..self.model.pairs.len() {
            let PairMembers::Surfaces(surfaces) = &mut self.model.pairs[index].members else { continue };
            let Some(region) = surfaces.adjust.map(|adjust| adjust.region) else { continue };
            let moved = adjust(&mut self.model.mesh, surfaces, region);
            let distance_max = moved.iter().fold(0.0, |largest: f64, &(_, distance)| largest.max(distance));
            surfaces.adjust = Some(Adjust { region, moved: moved.len() as u32, distance_max });
            let secondary = surfaces.secondary;
            self.no_secondary_node_in_set(index, secondary, region);
            self.spoilt_elements(index, &moved);
        }
    }

    fn no_secondary_node_in_set(&mut self, index: usize, secondary: SurfaceId, region: AdjustRegion) {
        let AdjustRegion::Set(set) = region else { return };
        let secondary = self.surface_nodes(secondary);
        let set = &self.model.mesh.node_sets[set.index()];
        if !set.nodes.iter().any(|node| secondary.binary_search(node).is_ok()) {
            let message = format!("ADJUST={} moves nothing: the set has no node of the secondary surface", set.name);
            self.report.warning(self.pair_at[index], PAIR, message, "name a set of secondary nodes");
        }
    }

    fn spoilt_elements(&mut self, index: usize, moved: &[(NodeId, f64)]) {
        let mesh = &self.model.mesh;
        let is_moved = |node: &NodeId| moved.binary_search_by_key(node, |&(node, _)| node).is_ok();
        for (element, (kind, nodes)) in (0..).map(ElementId).zip(mesh.elements.iter()) {
            if !nodes.iter().any(is_moved) {
                continue;
            }
            let coordinates = Coordinates::of(nodes.iter().map(|node| mesh.nodes[node.index()]));
            if let Some(fault) = shape_fault(kind, &coordinates) {
                let label = mesh.element_labels[element.index()];
                let message = format!("ADJUST spoils element {label}: it {fault}");
                self.report.error(self.pair_at[index], PAIR, message, "adjust by less, or correct the geometry");
            }
        }
    }
}
