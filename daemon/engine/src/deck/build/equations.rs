//! `*EQUATION`: linear constraints between displacements, and the check that each direction depends on one thing only.

use rustc_hash::FxHashMap;

use crate::model::{Equation, NodeId};

use super::super::card::Card;
use super::super::data::Row;
use super::super::lex::{self, key, looks_numeric, unquoted};
use super::super::report::{At, excerpt};
use super::Builder;
use super::layout::Layout;

const EQUATION: &str = "*EQUATION";
const TERMS: &str =
    "write a line with the number of terms, then the terms: node or node set, direction, coefficient, …";

/// A term as written.
struct Term {
    /// One node, or the members of a set by their numbers.
    nodes: Vec<NodeId>,
    /// Name of the set or number of the node.
    name: String,
    direction: u8,
    coefficient: f64,
}

impl Builder<'_> {
    pub(super) fn build_equations(&mut self, layout: &Layout<'_>) {
        for card in layout.model.iter().filter(|card| card.keyword.name == EQUATION && !card.faulty) {
            self.equation_card(card, layout);
        }
        self.rigid_equations_from = self.model.equations.len();
        self.write_rigid_equations();
    }

    /// Equations of a card, up to the first fault that leaves open where the next one begins.
    fn equation_card(&mut self, card: &Card, layout: &Layout<'_>) {
        let mut lines = card.lines().iter();
        if card.first_line().is_none() {
            self.report.error(card.at, EQUATION, "the data lines are missing", TERMS);
        }
        while let Some(line) = lines.next() {
            let head = line.row(EQUATION);
            head.at_most(1, self.report);
            let Some(count) = head.whole(0, "number of terms", None, self.report) else { return };
            if count < 2 {
                let message = format!("an equation of {count} terms couples nothing");
                self.report.error(head.at, EQUATION, message, "hold a direction with *BOUNDARY");
                return;
            }
            let mut terms: Vec<Option<Term>> = Vec::new();
            while terms.len() < count as usize {
                let Some(line) = lines.next() else {
                    let message = format!("the equation has {} of its {count} terms", terms.len());
                    self.report.error(head.at, EQUATION, message, TERMS);
                    return;
                };
                let mut row = line.row(EQUATION);
                while row.fields.last().is_some_and(|field| field.is_empty()) {
                    row.fields.pop();
                }
                if row.fields.is_empty() || row.fields.len() % 3 != 0 {
                    let message = format!("{} items are no whole number of terms", row.fields.len());
                    self.report.error(row.at, EQUATION, message, TERMS);
                    return;
                }
                for first in (0..row.fields.len()).step_by(3) {
                    terms.push(self.term(&row, first, layout));
                }
                if terms.len() > count as usize {
                    let message = format!("{} terms follow, and {count} are announced", terms.len());
                    self.report.error(row.at, EQUATION, message, "begin each equation on a line of its own");
                    return;
                }
            }
            if let Some(terms) = terms.into_iter().collect::<Option<Vec<Term>>>() {
                self.expand(&terms, head.at);
            }
        }
    }

    fn term(&mut self, row: &Row<'_>, first: usize, layout: &Layout<'_>) -> Option<Term> {
        let nodes = self.term_nodes(row, first, layout);
        let dof = row.whole(first + 1, "direction", None, self.report);
        let coefficient = row.real(first + 2, "coefficient", None, self.report);
        let (mut nodes, dof, coefficient) = (nodes?, dof?, coefficient?);
        // 4 to 6 are the displacements of the node that carries the rotations.
        let turned = || nodes.iter().map(|&node| self.model.mesh.rotation_of(node)).collect::<Option<Vec<NodeId>>>();
        match (dof, turned()) {
            (1..=3, _) => {}
            (4..=6, Some(rotations)) => nodes = rotations,
            _ => {
                let message =
                    format!("direction {dof} does not exist: only reference nodes of rigid bodies have rotations");
                self.report.error(row.at, EQUATION, message, "write 1 (x), 2 (y) or 3 (z)");
                return None;
            }
        }
        let name = unquoted(row.text(first)).to_string();
        Some(Term { nodes, name, direction: ((dof - 1) % 3) as u8, coefficient })
    }

    /// Members of sets are paired by their numbers.
    fn term_nodes(&mut self, row: &Row<'_>, index: usize, layout: &Layout<'_>) -> Option<Vec<NodeId>> {
        let text = row.text(index);
        if text.is_empty() {
            self.report.error(row.at, EQUATION, "the node or node set is missing", TERMS);
            return None;
        }
        if looks_numeric(text.as_bytes()) {
            return match lex::label(text.as_bytes()) {
                Ok(label) => self.node(label, row.at, EQUATION).map(|node| vec![node]),
                Err(fault) => {
                    let message = format!("node {} {}", excerpt(text.as_bytes()), fault.text());
                    self.report.error(row.at, EQUATION, message, TERMS);
                    None
                }
            };
        }
        let set = self.node_sets.refer(unquoted(text), row.at, EQUATION, self.report)?;
        let mesh = &self.model.mesh;
        let definition = &mesh.node_sets[set as usize];
        if !self.budget.take(2 * definition.nodes.len(), row.at, EQUATION, self.report) {
            return None;
        }
        let name = key(&definition.name);
        let unsorted = definition.nodes.len() > 1
            && layout.all.iter().any(|card| {
                card.parameters.has("UNSORTED") && card.parameters.value("NSET").is_some_and(|set| key(set) == name)
            });
        if unsorted {
            let message =
                format!("node set {} is UNSORTED: its nodes would be paired in another order", definition.name);
            self.report.error(row.at, EQUATION, message, "write one equation per node");
            return None;
        }
        if definition.nodes.is_empty() {
            let message = format!("node set {} is empty", definition.name);
            self.report.error(row.at, EQUATION, message, "fill the set, or remove the equation");
            return None;
        }
        let mut nodes = definition.nodes.clone();
        nodes.sort_by_key(|node| mesh.node_labels[node.index()]);
        Some(nodes)
    }

    /// One equation for each node of the first term; a single node stands in all of them.
    fn expand(&mut self, terms: &[Term], at: At) {
        let count = terms[0].nodes.len();
        if let Some(other) = terms.iter().find(|term| term.nodes.len() != 1 && term.nodes.len() != count) {
            let message = format!(
                "{} has {} nodes, and {}, the first, has {count}",
                other.name,
                other.nodes.len(),
                terms[0].name
            );
            self.report.error(at, EQUATION, message, "name sets of one size; a single node goes with all");
            return;
        }
        if !self.budget.take(count.saturating_mul(terms.len()), at, EQUATION, self.report) {
            return;
        }
        for i in 0..count {
            let mut merged: Vec<(NodeId, u8, f64)> = Vec::with_capacity(terms.len());
            for term in terms {
                let node = if term.nodes.len() == 1 { term.nodes[0] } else { term.nodes[i] };
                match merged.iter_mut().find(|(other, direction, _)| (*other, *direction) == (node, term.direction)) {
                    Some(known) => known.2 += term.coefficient,
                    None => merged.push((node, term.direction, term.coefficient)),
                }
            }
            let (node, direction, coefficient) = merged[0];
            let place = self.direction_name(node, direction);
            merged.retain(|term| term.2 != 0.0);
            if coefficient == 0.0 {
                let message = format!("the coefficient of the first term, {place}, is 0");
                self.report.error(
                    at,
                    EQUATION,
                    message,
                    "the first term is eliminated: put one with a coefficient there",
                );
                return;
            }
            if merged.len() == 1 {
                let message = format!("the equation says no more than that {place} is 0");
                self.report.error(at, EQUATION, message, "hold the direction with *BOUNDARY");
                return;
            }
            self.model.equations.push(Equation { terms: merged, place: self.map.place(at) });
            self.equation_at.push(at);
        }
    }

    /// Direction of a node in words.
    fn direction_name(&self, node: NodeId, direction: u8) -> String {
        let mesh = &self.model.mesh;
        format!("direction {} of node {}", mesh.dof_of(node, direction), mesh.node_labels[node.index()])
    }

    /// Each direction is eliminated once, is not prescribed, and does not depend on itself.
    pub(super) fn check_equations(&mut self) {
        let boundaries = self.model.initial_boundaries.iter();
        let boundaries = boundaries.chain(self.model.steps.iter().flat_map(|step| &step.boundaries));
        let mut prescribed = vec![0u8; self.model.mesh.nodes.len()];
        for boundary in boundaries {
            boundary.nodes.iter().for_each(|node| prescribed[node.index()] |= 1 << boundary.direction);
        }
        let mut equation_of: FxHashMap<(NodeId, u8), usize> = FxHashMap::default();
        for (position, equation) in self.model.equations.iter().enumerate() {
            let (node, direction, _) = equation.terms[0];
            let at = self.equation_at[position];
            let what = self.direction_name(node, direction);
            let is_prescribed = prescribed[node.index()] >> direction & 1 == 1;
            if position >= self.rigid_equations_from {
                let message = match equation_of.insert((node, direction), position) {
                    Some(_) => format!("{what} follows the rigid body, and is the first term of an *EQUATION too"),
                    None if is_prescribed => {
                        format!("{what} follows the rigid body, and is prescribed by *BOUNDARY too")
                    }
                    None => continue,
                };
                let remedy = "act on the reference node of the body, degrees of freedom 1 to 6, or take the node out";
                self.report.error(at, "*RIGID BODY", message, remedy);
                continue;
            }
            if is_prescribed {
                let message = format!("{what} is the first term and is prescribed by *BOUNDARY too");
                self.report.error(at, EQUATION, message, "put a term first that is free, or take the *BOUNDARY away");
            }
            if equation_of.insert((node, direction), position).is_some() {
                let message = format!("{what} is the first term of two equations");
                self.report.error(at, EQUATION, message, "put another term first in one of them");
            }
        }
        for circle in circles(&self.model.equations, &equation_of) {
            let label = |&position: &usize| {
                let (node, direction, _) = self.model.equations[position].terms[0];
                self.direction_name(node, direction)
            };
            let shown: Vec<String> = circle.iter().take(6).map(label).collect();
            let more = if circle.len() > 6 { ", …" } else { "" };
            let message = format!("equations depend on each other in a circle: {}{more}", shown.join(", "));
            let remedy =
                "the first term of an equation may stand in others, but not lead back to itself: reorder the terms";
            self.report.error(self.equation_at[circle[0]], EQUATION, message, remedy);
        }
    }
}

/// Circles of equations: each contains the first term of the next one, the last that of the first. Depth first, with a stack
/// of its own because chains may be long.
fn circles(equations: &[Equation], equation_of: &FxHashMap<(NodeId, u8), usize>) -> Vec<Vec<usize>> {
    #[derive(Clone, Copy, PartialEq)]
    enum State {
        New,
        Open,
        Done,
    }
    let mut state = vec![State::New; equations.len()];
    let mut found = Vec::new();
    for start in 0..equations.len() {
        if state[start] != State::New {
            continue;
        }
        state[start] = State::Open;
        // Equations on the way, and the term of each that is looked at next.
        let mut way = vec![(start, 1)];
        while let Some((position, term)) = way.last_mut() {
            let Some(&(node, direction, _)) = equations[*position].terms.get(*term) else {
                state[*position] = State::Done;
                way.pop();
                continue;
            };
            *term += 1;
            let Some(&next) = equation_of.get(&(node, direction)) else { continue };
            match state[next] {
                State::New => {
                    state[next] = State::Open;
                    way.push((next, 1));
                }
                State::Open => {
                    let begin =
                        way.iter().position(|&(other, _)| other == next).expect("an open equation is on the way");
                    found.push(way[begin..].iter().map(|&(position, _)| position).collect());
                }
                State::Done => {}
            }
        }
    }
    found
}
