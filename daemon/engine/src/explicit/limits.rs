//! The stable increment without contact: a bound at every node from its elements, springs and dashpots.
//!
//! `Λ_a = Σ_e ω_e² m_ea / m_a + Σ_springs ω_s²` and likewise for damping (`element/stable.rs`). Nodes that cannot move have none.

use super::elements::Part;
use super::inertia::{Inertia, terms_of};
use crate::element::{connector, stable};
use crate::model::{Connector, ElementId, ElementKind, Model};
use crate::solve::assembly::coordinates;

/// Bounds at a node.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NodeLimit {
    /// Of `M⁻¹ K` [1/time²].
    pub stiffness: f64,
    /// Of `M⁻¹ C` without bulk viscosity [1/time].
    pub damping: f64,
    /// Of linear bulk viscosity [1/time].
    pub bulk: f64,
}

impl NodeLimit {
    /// Stable increment \[time\]; `bulk`: factor on the bulk viscosity.
    pub fn increment(&self, bulk: f64) -> f64 {
        stable::increment(self.stiffness, self.damping + bulk * self.bulk)
    }
}

/// Limits of a model without contact.
pub struct Limits {
    /// Of each node.
    pub nodes: Vec<NodeLimit>,
    /// The node with the smallest increment.
    pub slowest: usize,
    /// Its increment \[time\]; infinite where nothing limits it.
    pub increment: f64,
    /// Element that limits it, if one does.
    pub element: Option<u32>,
}

impl Limits {
    /// From elements with their mass scaled.
    pub fn new(model: &Model, parts: &[Part], factors: &[f64], linear: f64, inertia: &Inertia) -> Self {
        let mesh = &model.mesh;
        let mut nodes = vec![NodeLimit::default(); mesh.nodes.len()];
        for (part, &factor) in parts.iter().zip(factors) {
            let square = part.frequency_squared / factor;
            let bulk = part.damping_rate(model, linear, factor) - part.damping_rate(model, 0.0, factor);
            let other = part.damping_rate(model, 0.0, factor);
            for (&node, mass) in mesh.elements.nodes(part.element as usize).iter().zip(&part.masses) {
                // Nodes of rigid bodies have the mass of what is on them.
                let share = factor * mass / inertia.masses[node.index()];
                let limit = &mut nodes[node.index()];
                limit.stiffness += square * share;
                limit.damping += other * share;
                limit.bulk += bulk * share;
            }
        }
        connectors(model, inertia, &mut nodes);
        gather_groups(inertia, &mut nodes);
        let fixed = fixed_nodes(inertia, mesh.nodes.len());
        let mut slowest = (0, f64::INFINITY);
        for (node, limit) in nodes.iter_mut().enumerate() {
            if fixed[node] {
                *limit = NodeLimit::default();
            } else if limit.increment(1.0) < slowest.1 {
                slowest = (node, limit.increment(1.0));
            }
        }
        let at_slowest =
            |part: &&Part| mesh.elements.nodes(part.element as usize).iter().any(|n| n.index() == slowest.0);
        let element = (parts.iter().zip(factors).filter(|(p, _)| at_slowest(p)))
            .map(|(p, f)| (p.increment(model, linear, *f), p.element))
            .filter(|(increment, _)| increment.is_finite())
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, element)| element);
        Self { nodes, slowest: slowest.0, increment: slowest.1, element: element.filter(|_| slowest.1.is_finite()) }
    }
}

/// Adds springs, dashpots and what damps point masses.
fn connectors(model: &Model, inertia: &Inertia, nodes: &mut [NodeLimit]) {
    let mesh = &model.mesh;
    let mut sections: Vec<(ElementId, Connector)> = mesh.connectors.iter().map(|(&e, &s)| (e, s)).collect();
    sections.sort_by_key(|&(element, _)| element);
    for (element, section) in sections {
        let (kind, own) = (mesh.elements.kind(element.index()), mesh.elements.nodes(element.index()));
        let at = coordinates(mesh, element.0);
        let (spring, stiffness, damping) = match section {
            Connector::Spring { stiffness, .. } => (section, stiffness, 0.0),
            Connector::Dashpot { coefficient, directions } => {
                (Connector::Spring { stiffness: coefficient, directions }, 0.0, coefficient)
            }
            Connector::Mass { alpha, .. } | Connector::RotaryInertia { alpha, .. } => {
                nodes[own[0].index()].damping += alpha;
                continue;
            }
            Connector::Bar { .. } | Connector::Inert => continue,
        };
        let kind = match kind {
            ElementKind::DashpotA => ElementKind::SpringA,
            ElementKind::Dashpot1 => ElementKind::Spring1,
            ElementKind::Dashpot2 => ElementKind::Spring2,
            other => other,
        };
        let b = connector::elongation(kind, &at, spring);
        let mut row: Vec<(u32, f64)> = Vec::new();
        for (node, b) in own.iter().zip(b) {
            for d in 0..3u32 {
                for (at, factor) in terms_of(&inertia.dependents, 3 * node.0 + d) {
                    row.push((at, factor * b[d as usize]));
                }
            }
        }
        row.retain(|e| e.1 != 0.0);
        let mobility = inertia.mobility(&mut row);
        let mut touched: Vec<usize> = row.iter().map(|e| e.0 as usize / 3).collect();
        touched.sort_unstable();
        touched.dedup();
        for node in touched {
            nodes[node].stiffness += stiffness * mobility;
            nodes[node].damping += damping * mobility;
        }
    }
}

/// Directions of a group move together: its nodes have what the fastest of them has.
fn gather_groups(inertia: &Inertia, nodes: &mut [NodeLimit]) {
    let mut of_group = vec![NodeLimit::default(); inertia.groups.len()];
    let add = |group: &mut NodeLimit, node: NodeLimit| {
        group.stiffness = group.stiffness.max(node.stiffness);
        group.damping = group.damping.max(node.damping);
        group.bulk = group.bulk.max(node.bulk);
    };
    for (group, limit) in inertia.groups.iter().zip(&mut of_group) {
        group.at.iter().for_each(|&at| add(limit, nodes[at as usize / 3]));
    }
    for dependent in &inertia.dependents {
        for term in &dependent.terms {
            if let Some(&(group, _)) = inertia.member.get(&term.0) {
                add(&mut of_group[group as usize], nodes[dependent.at as usize / 3]);
            }
        }
    }
    for (group, limit) in inertia.groups.iter().zip(&of_group) {
        group.at.iter().for_each(|&at| add(&mut nodes[at as usize / 3], *limit));
    }
}

/// Nodes none of whose directions can move, whatever happens.
fn fixed_nodes(inertia: &Inertia, count: usize) -> Vec<bool> {
    let mut fixed: Vec<bool> = (0..count).map(|node| inertia.alone[node] == 0).collect();
    for group in &inertia.groups {
        for &at in &group.at[..group.free] {
            fixed[at as usize / 3] = false;
        }
    }
    for dependent in &inertia.dependents {
        let mobile = |&(at, _): &(u32, f64)| {
            inertia.member.get(&at).is_some_and(|&(g, place)| (place as usize) < inertia.groups[g as usize].free)
        };
        if dependent.terms.iter().any(mobile) {
            fixed[dependent.at as usize / 3] = false;
        }
    }
    fixed
}
