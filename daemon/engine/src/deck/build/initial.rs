//! `*INITIAL CONDITIONS, TYPE=VELOCITY`.

use std::collections::BTreeMap;

use crate::model::{InitialVelocity, NodeId};

use super::super::card::Card;
use super::super::data::Row;
use super::Builder;
use super::layout::Layout;

const INITIAL: &str = "*INITIAL CONDITIONS";

impl Builder<'_> {
    /// Velocities at the start of the analysis. A line replaces what earlier ones say of the same node and direction.
    pub(super) fn build_initial_velocities(&mut self, layout: &Layout<'_>) {
        let mut velocities: BTreeMap<(NodeId, u8), f64> = BTreeMap::new();
        for card in layout.model.iter().filter(|card| card.keyword.name == INITIAL) {
            if card.faulty || card.parameters.word("TYPE") != "VELOCITY" {
                continue; // Reported already.
            }
            if !layout.has_dynamics() && !layout.has_refused_keywords() {
                let message = "initial velocities have no effect: no step is dynamic";
                self.report.warning(card.at, INITIAL, message, "write *DYNAMIC or *DYNAMIC, EXPLICIT in a step");
            }
            self.velocity_card(card, &mut velocities);
        }
        let velocity = |((node, direction), value)| InitialVelocity { node, direction, value };
        self.model.initial_velocities = velocities.into_iter().map(velocity).collect();
    }

    fn velocity_card(&mut self, card: &Card, velocities: &mut BTreeMap<(NodeId, u8), f64>) {
        if card.first_line().is_none() {
            let remedy = "write: node or node set, degree of freedom, velocity";
            self.report.error(card.at, INITIAL, "the data line is missing", remedy);
        }
        for line in card.lines().iter() {
            let row = line.row(INITIAL);
            row.at_most(3, self.report);
            let region = self.node_region(&row);
            let dof = row.whole(1, "degree of freedom", None, self.report);
            let value = row.real(2, "velocity", None, self.report);
            let (Some(region), Some(dof), Some(value)) = (region, dof, value) else { continue };
            let Some(nodes) = self.nodes_with(&region.members, dof, &row) else { continue };
            self.followers_only(&region.members, &region.name, &row);
            let direction = ((dof - 1) % 3) as u8;
            velocities.extend(nodes.into_iter().map(|node| ((node, direction), value)));
        }
    }

    /// Nodes that carry a degree of freedom of some nodes; `None` when one of them does not have it, which is reported.
    fn nodes_with(&mut self, members: &[NodeId], dof: u32, row: &Row<'_>) -> Option<Vec<NodeId>> {
        let mesh = &self.model.mesh;
        let remedy = "write 1 (x), 2 (y) or 3 (z), on nodes with rotations (reference nodes of rigid bodies, nodes of ROTARYI) also 4 to 6";
        match dof {
            1..=3 => Some(members.to_vec()),
            4..=6 => match members.iter().find(|&&node| mesh.rotation_of(node).is_none()) {
                None => Some(members.iter().filter_map(|&node| mesh.rotation_of(node)).collect()),
                Some(without) => {
                    let label = mesh.node_labels[without.index()];
                    let message = format!("node {label} has no degree of freedom {dof}: it has no rotations");
                    self.report.error(row.at, INITIAL, message, remedy);
                    None
                }
            },
            _ => {
                self.report.error(row.at, INITIAL, format!("degree of freedom {dof} does not exist"), remedy);
                None
            }
        }
    }

    /// Nodes of rigid bodies have the velocity of their reference node, whatever the line says.
    fn followers_only(&mut self, members: &[NodeId], name: &str, row: &Row<'_>) {
        let has = |nodes: &[NodeId]| members.iter().any(|node| nodes.binary_search(node).is_ok());
        let found = self.model.rigid_bodies.iter().find(|body| has(&body.nodes) && !members.contains(&body.reference));
        if let Some(body) = found {
            let label = self.model.mesh.node_labels[body.reference.index()];
            let message =
                format!("nodes of {name} follow the reference node {label}, which has no velocity from this line");
            self.report.warning(row.at, INITIAL, message, "give the velocity to the reference node of the rigid body");
        }
    }
}
