//! What elements do to prescribed directions: couplings of displacement columns, and internal forces.

use super::assembly::element_stiffness;
use super::columns::Column;
use super::context::Context;
use super::linear::Dense;
use crate::element::{Coordinates, Elasticity, Stiffness};
use crate::model::{ELEMENT_NODES_MAX, Model, NodeId};

/// Vectors at the nodes of an element; those beyond its node count are zero.
type NodeVectors = [[f64; 3]; ELEMENT_NODES_MAX];

/// Forces that unit displacement columns cause on every direction of the elements they touch: calls
/// `add(node, direction, column, force)` with `K û_j`, element by element. Returns `û_iᵀ K û_j`.
pub fn couplings(context: &Context<'_>, elements: &[u32], mut add: impl FnMut(NodeId, usize, usize, f64)) -> Dense {
    let mut energy = Dense::zeros(context.columns.len(), context.columns.len());
    let patterns = Patterns::new(context.model, context.columns);
    let mut touched: Vec<(usize, NodeVectors)> = Vec::new();
    let mut k = Stiffness::default();
    for &e in elements {
        let nodes = context.model.mesh.elements.nodes(e as usize);
        patterns.gather(nodes, &mut touched);
        if touched.is_empty() {
            continue;
        }
        element_stiffness(context.model, context.elasticities, e, &mut k);
        for (j, u) in &touched {
            let forces = k.force(&u[..nodes.len()]);
            let forces = &forces[..nodes.len()];
            for (i, v) in &touched {
                energy.column_mut(*j)[*i] +=
                    v.iter().zip(forces).flat_map(|(v, f)| v.iter().zip(f)).map(|(v, f)| v * f).sum::<f64>();
            }
            for (&node, force) in nodes.iter().zip(forces) {
                for (direction, &f) in force.iter().enumerate() {
                    add(node, direction, *j, f);
                }
            }
        }
    }
    energy
}

/// Displacement columns by node.
struct Patterns {
    /// Start of each node's entries; one more than there are nodes.
    starts: Vec<u32>,
    /// (column, direction, value).
    entries: Vec<(u32, u8, f64)>,
}

impl Patterns {
    fn new(model: &Model, columns: &[Column]) -> Self {
        let each = || {
            columns.iter().enumerate().filter_map(|(j, c)| match c {
                Column::Displacement(entries) => Some((j as u32, entries)),
                Column::Force(_) => None,
            })
        };
        let mut starts = vec![0u32; model.mesh.nodes.len() + 1];
        for (_, entries) in each() {
            for (node, ..) in entries {
                starts[node.index() + 1] += 1;
            }
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut fill = starts.clone();
        let mut out = vec![(0, 0, 0.0); starts[starts.len() - 1] as usize];
        for (j, entries) in each() {
            for &(node, direction, value) in entries {
                let slot = &mut fill[node.index()];
                out[*slot as usize] = (j, direction, value);
                *slot += 1;
            }
        }
        Self { starts, entries: out }
    }

    /// Columns with a value on one of the nodes, with their displacements of these nodes; by column.
    fn gather(&self, nodes: &[NodeId], out: &mut Vec<(usize, NodeVectors)>) {
        out.clear();
        for (a, node) in nodes.iter().enumerate() {
            for &(j, direction, value) in
                &self.entries[self.starts[node.index()] as usize..self.starts[node.index() + 1] as usize]
            {
                let at = match out.iter().position(|&(column, _)| column == j as usize) {
                    Some(at) => at,
                    None => {
                        out.push((j as usize, [[0.0; 3]; ELEMENT_NODES_MAX]));
                        out.len() - 1
                    }
                };
                out[at].1[a][direction as usize] = value;
            }
        }
        out.sort_by_key(|&(column, _)| column);
    }
}

/// `K u` of the given elements at their nodes; the caller keeps what belongs to prescribed directions.
pub fn internal_forces(
    model: &Model,
    elasticities: &[Elasticity],
    elements: &[u32],
    displacement: &[[f64; 3]],
    mut add: impl FnMut(NodeId, usize, f64),
) {
    let mut k = Stiffness::default();
    for &e in elements {
        let nodes = model.mesh.elements.nodes(e as usize);
        element_stiffness(model, elasticities, e, &mut k);
        let u = Coordinates::of(nodes.iter().map(|n| displacement[n.index()]));
        for (&node, force) in nodes.iter().zip(k.force(&u)) {
            for (direction, f) in force.into_iter().enumerate() {
                add(node, direction, f);
            }
        }
    }
}
