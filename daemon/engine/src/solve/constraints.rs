//! Which displacements are independent: prescribed directions and `*EQUATION`s, eliminated before anything else.
//!
//! `u = T q + û`: a dependent direction is a sum over independent ones, of which some are prescribed. Forces go the other
//! way, `Tᵀ f`: what acts on a dependent direction acts on those that it depends on.

use rustc_hash::FxHashMap;

use super::columns::{Column, merge};
use crate::model::{Connector, ElementId, ElementKind, LoadKind, Model, NodeId};

/// A direction of a node with a factor.
pub type Term = (NodeId, u8, f64);

/// Prescribed and dependent directions.
pub struct Constraints {
    /// Bit d of a node: direction d is prescribed.
    prescribed: Vec<u8>,
    /// Bit d of a node: direction d depends on others.
    dependent: Vec<u8>,
    /// Bit d of a node: nothing resists direction d and nothing acts along it.
    inert: Vec<u8>,
    /// Dependent directions on independent ones, chains resolved; sorted, each direction at most once.
    expansions: FxHashMap<(NodeId, u8), Vec<Term>>,
}

impl Constraints {
    /// Collects the prescribed directions of the model part and of all steps, and resolves the equations; `contact_nodes` are
    /// those that contact may push.
    pub fn new(model: &Model, contact_nodes: impl Iterator<Item = NodeId>) -> Self {
        let mut prescribed = vec![0u8; model.mesh.nodes.len()];
        let lines = model.initial_boundaries.iter().chain(model.steps.iter().flat_map(|s| &s.boundaries));
        for line in lines {
            for node in &line.nodes {
                prescribed[node.index()] |= 1 << line.direction;
            }
        }
        let mut dependent = vec![0u8; model.mesh.nodes.len()];
        let mut direct: FxHashMap<(NodeId, u8), Vec<Term>> = FxHashMap::default();
        for equation in &model.equations {
            let [(node, direction, coefficient), rest @ ..] = &equation.terms[..] else { continue };
            dependent[node.index()] |= 1 << direction;
            direct.insert((*node, *direction), rest.iter().map(|&(n, d, c)| (n, d, -c / coefficient)).collect());
        }
        let mut expansions = FxHashMap::default();
        for equation in &model.equations {
            if let Some(&(node, direction, _)) = equation.terms.first() {
                resolve((node, direction), &direct, &mut expansions);
            }
        }
        let inert = touched(model, contact_nodes).iter().map(|t| 7 & !t).collect();
        Self { prescribed, dependent, inert, expansions }
    }

    /// Whether a direction (0..3) of a node is prescribed.
    pub fn is_prescribed(&self, node: NodeId, direction: usize) -> bool {
        self.prescribed[node.index()] & (1 << direction) != 0
    }

    /// Whether a direction is an unknown: neither prescribed nor dependent, and something resists or pushes it.
    pub fn is_free(&self, node: NodeId, direction: usize) -> bool {
        let node = node.index();
        (self.prescribed[node] | self.dependent[node] | self.inert[node]) & (1 << direction) == 0
    }

    /// Whether every direction of a node is prescribed.
    pub fn is_fixed(&self, node: NodeId) -> bool {
        self.prescribed[node.index()] & 7 == 7
    }

    /// Whether any direction of a node is prescribed or dependent.
    pub fn touches(&self, node: NodeId) -> bool {
        self.prescribed[node.index()] | self.dependent[node.index()] != 0
    }

    /// Whether any direction of a node depends on others.
    pub fn is_dependent(&self, node: NodeId) -> bool {
        self.dependent[node.index()] != 0
    }

    /// Independent directions that a displacement (or a force) in a direction belongs to: calls `add(node, direction,
    /// factor)` with the given value taken along. A free or prescribed direction is its own.
    pub fn expand(&self, node: NodeId, direction: usize, value: f64, mut add: impl FnMut(NodeId, usize, f64)) {
        if self.dependent[node.index()] & (1 << direction) == 0 {
            return add(node, direction, value);
        }
        for &(n, d, factor) in &self.expansions[&(node, direction as u8)] {
            add(n, usize::from(d), factor * value);
        }
    }

    /// Dependent directions with what they depend on, sorted.
    pub fn dependents(&self) -> Vec<((NodeId, u8), &[Term])> {
        let mut all: Vec<_> = self.expansions.iter().map(|(&key, terms)| (key, &terms[..])).collect();
        all.sort_by_key(|&(key, _)| key);
        all
    }

    /// Lets every displacement column move the directions that depend on its own.
    pub fn extend(&self, columns: &mut [Column]) {
        if self.expansions.is_empty() {
            return;
        }
        let dependents = self.dependents();
        for column in columns {
            let Column::Displacement(entries) = column else { continue };
            let own: FxHashMap<(NodeId, u8), f64> = entries.iter().map(|&(n, d, v)| ((n, d), v)).collect();
            let mut all = std::mem::take(entries);
            for ((node, direction), terms) in &dependents {
                let moved: f64 =
                    terms.iter().filter_map(|&(n, d, factor)| own.get(&(n, d)).map(|value| factor * value)).sum();
                if moved != 0.0 {
                    all.push((*node, *direction, moved));
                }
            }
            *entries = merge(all);
        }
    }
}

/// Bit d of a node: an element, an equation, a load or contact acts along direction d.
fn touched(model: &Model, contact_nodes: impl Iterator<Item = NodeId>) -> Vec<u8> {
    let mesh = &model.mesh;
    let mut touched = vec![0u8; mesh.nodes.len()];
    contact_nodes.for_each(|n| touched[n.index()] = 7);
    for (e, (kind, nodes)) in mesh.elements.iter().enumerate() {
        let section = mesh.connectors.get(&ElementId(e as u32));
        match (kind, section) {
            (ElementKind::Spring1 | ElementKind::Spring2, Some(Connector::Spring { directions, .. })) => {
                nodes.iter().zip(directions).for_each(|(n, d)| touched[n.index()] |= 1 << d);
            }
            _ => nodes.iter().for_each(|n| touched[n.index()] = 7),
        }
    }
    for &(node, direction, _) in model.equations.iter().flat_map(|e| &e.terms) {
        touched[node.index()] |= 1 << direction;
    }
    for load in model.steps.iter().flat_map(|s| &s.loads) {
        if let LoadKind::Concentrated { nodes, direction } = &load.kind {
            nodes.iter().for_each(|n| touched[n.index()] |= 1 << direction);
        }
    }
    touched
}

/// Puts the expansion of a dependent direction into `done`, those that it needs first.
fn resolve(
    key: (NodeId, u8),
    direct: &FxHashMap<(NodeId, u8), Vec<Term>>,
    done: &mut FxHashMap<(NodeId, u8), Vec<Term>>,
) {
    let mut path = vec![key];
    while let Some(&top) = path.last() {
        if done.contains_key(&top) {
            path.pop();
            continue;
        }
        let terms = &direct[&top];
        let missing = terms.iter().map(|&(n, d, _)| (n, d)).find(|k| direct.contains_key(k) && !done.contains_key(k));
        match missing {
            // The deck reader refuses cycles; here one ends all the same.
            Some(next) if !path.contains(&next) => path.push(next),
            _ => {
                let mut sum = Vec::new();
                for &(node, direction, factor) in terms {
                    match done.get(&(node, direction)) {
                        Some(chain) => sum.extend(chain.iter().map(|&(n, d, f)| (n, d, f * factor))),
                        None => sum.push((node, direction, factor)),
                    }
                }
                done.insert(top, merge(sum));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Place;
    use crate::model::Equation;

    fn model(equations: &[&[Term]]) -> Model {
        let mut model = Model::default();
        model.mesh.nodes = vec![[0.0; 3]; 5];
        model.equations = equations.iter().map(|t| Equation { terms: t.to_vec(), place: Place::nowhere() }).collect();
        model
    }

    #[test]
    fn a_chain_ends_on_independent_directions() {
        // u0 = 2 u1, u1 = -u2 + 0.5 u3 (all in direction 3).
        let n = NodeId;
        let model = model(&[&[(n(0), 2, 1.0), (n(1), 2, -2.0)], &[(n(1), 2, 2.0), (n(2), 2, 2.0), (n(3), 2, -1.0)]]);
        let constraints = Constraints::new(&model, std::iter::empty());
        let mut found = Vec::new();
        constraints.expand(n(0), 2, 3.0, |node, d, v| found.push((node.0, d, v)));
        assert_eq!(found, vec![(2, 2, -6.0), (3, 2, 3.0)]);
        assert!(!constraints.is_free(n(1), 2) && constraints.is_free(n(3), 2) && !constraints.is_prescribed(n(1), 2));
        assert!(!constraints.is_free(n(3), 0), "nothing acts along it");
    }

    #[test]
    fn a_displacement_column_takes_its_dependents_along() {
        let n = NodeId;
        let model = model(&[&[(n(4), 0, 1.0), (n(1), 0, -0.5), (n(2), 1, 0.25)]]);
        let mut columns = vec![Column::Displacement(vec![(n(1), 0, 2.0), (n(2), 1, 4.0)])];
        Constraints::new(&model, std::iter::empty()).extend(&mut columns);
        assert_eq!(columns[0].entries().len(), 2, "1.0 - 1.0 leaves the dependent where it is");
        let mut columns = vec![Column::Displacement(vec![(n(1), 0, 2.0)])];
        Constraints::new(&model, std::iter::empty()).extend(&mut columns);
        assert_eq!(columns[0].entries(), [(n(1), 0, 2.0), (n(4), 0, 1.0)]);
    }
}
