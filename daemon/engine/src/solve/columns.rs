//! Load patterns: the fixed shapes whose scalar coefficients change in time.

use crate::element::{self, Coordinates, connector, face};
use crate::model::{Connector, ElementFace, ElementId, LoadKind, Model, NodeId};

/// A pattern of unit coefficient; entries sorted by node and direction, each at most once.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// Nodal forces.
    Force(Vec<(NodeId, u8, f64)>),
    /// Displacements of prescribed directions.
    Displacement(Vec<(NodeId, u8, f64)>),
}

impl Column {
    /// Entries of either kind.
    pub fn entries(&self) -> &[(NodeId, u8, f64)] {
        match self {
            Column::Force(entries) | Column::Displacement(entries) => entries,
        }
    }

    /// Whether the coefficient is a displacement.
    pub fn is_displacement(&self) -> bool {
        matches!(self, Column::Displacement(_))
    }
}

/// Sorts entries and adds up those of one direction.
pub fn merge(mut entries: Vec<(NodeId, u8, f64)>) -> Vec<(NodeId, u8, f64)> {
    // A stable sort keeps the order of equal keys, and with it the order of the sums.
    entries.sort_by_key(|&(node, direction, _)| (node, direction));
    let mut out: Vec<(NodeId, u8, f64)> = Vec::with_capacity(entries.len());
    for (node, direction, value) in entries {
        match out.last_mut() {
            Some(last) if (last.0, last.1) == (node, direction) => last.2 += value,
            _ => out.push((node, direction, value)),
        }
    }
    out
}

/// Consistent nodal forces of a load of magnitude 1.
pub fn force_pattern(model: &Model, kind: &LoadKind) -> Column {
    let mut entries = Vec::new();
    match kind {
        LoadKind::Concentrated { nodes, direction } => entries.extend(nodes.iter().map(|&n| (n, *direction, 1.0))),
        LoadKind::FacePressure { faces, .. } | LoadKind::SurfacePressure { faces } => {
            pressure(model, faces, &mut entries)
        }
        LoadKind::Gravity { elements, direction } => {
            for &e in elements {
                for (&node, mass) in model.mesh.elements.nodes(e.index()).iter().zip(nodal_masses(model, e)) {
                    for (d, component) in direction.iter().enumerate().filter(|(_, c)| **c != 0.0) {
                        entries.push((node, d as u8, mass * component));
                    }
                }
            }
        }
    }
    Column::Force(merge(entries))
}

/// Mass that each node of an element stands for under a uniform acceleration: ∫ ρ N dV, half of ρ A L of a bar, all of a point
/// mass; none for a spring and for what is inert.
fn nodal_masses(model: &Model, e: ElementId) -> Vec<f64> {
    let mesh = &model.mesh;
    let density = || {
        let material = &model.materials[mesh.element_materials[e.index()].index()];
        material.density.expect("the deck reader asks for a density where gravity acts")
    };
    let coordinates = super::assembly::coordinates(mesh, e.0);
    match mesh.connectors.get(&e) {
        None => {
            let density = density();
            let volumes = element::nodal_volumes(mesh.elements.kind(e.index()), &coordinates);
            volumes.into_iter().map(|volume| density * volume).collect()
        }
        Some(Connector::Bar { area }) => vec![0.5 * density() * area * connector::length(&coordinates); 2],
        Some(Connector::Mass { mass, .. }) => vec![*mass],
        Some(
            Connector::Spring { .. } | Connector::Dashpot { .. } | Connector::RotaryInertia { .. } | Connector::Inert,
        ) => Vec::new(),
    }
}

/// A pressure of 1 pushes into the body: against the outward area vectors.
fn pressure(model: &Model, faces: &[ElementFace], entries: &mut Vec<(NodeId, u8, f64)>) {
    for &face in faces {
        let nodes = model.mesh.face_nodes(face);
        let coordinates = Coordinates::of(nodes.iter().map(|n| model.mesh.nodes[n.index()]));
        for (&node, area) in nodes.iter().zip(face::nodal_area_vectors(&coordinates)) {
            for (d, component) in area.into_iter().enumerate() {
                entries.push((node, d as u8, -component));
            }
        }
    }
}
