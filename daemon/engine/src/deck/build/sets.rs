//! `*NSET`, `*ELSET` and the sets that `*NODE` and `*ELEMENT` name: labels, ranges and other sets to positions.

use std::ops::Range;

use rustc_hash::FxHashSet;

use crate::model::{ElementId, ElementSet, NodeId, NodeSet};

use super::super::card::{Body, Card, Members};
use super::super::report::{At, Report};
use super::Builder;
use super::budget::Budget;
use super::layout::Layout;
use super::mesh::Rows;
use super::names::{Labels, Names};

/// What contributes to a set.
enum Contribution<'d> {
    /// Rows of a bulk table.
    Rows(Range<u32>),
    /// Members of a card.
    Members(&'static str, &'d Members),
    /// Positions found otherwise.
    Positions(Vec<u32>),
}

/// Sets of one kind before they are resolved.
struct RawSets<'d> {
    what: &'static str,
    sets: Vec<Vec<Contribution<'d>>>,
}

/// What the members of sets refer to.
struct Target<'a> {
    index: &'a Labels,
    labels: &'a [u32],
    rows: &'a Rows,
    refused: &'a FxHashSet<u32>,
}

impl<'d> RawSets<'d> {
    fn add(&mut self, names: &mut Names, card: &Card, name: &str, contribution: Contribution<'d>) {
        let (position, is_new) = names.enter(name, card.at);
        if is_new {
            self.sets.push(Vec::new());
        }
        if card.faulty {
            names.mark_faulty(position);
        }
        self.sets[position as usize].push(contribution);
    }

    /// Members of every set, ascending without repetition.
    fn resolve(
        &self,
        names: &mut Names,
        target: &Target<'_>,
        budget: &mut Budget,
        report: &mut Report,
    ) -> Vec<Vec<u32>> {
        let members = vec![None; self.sets.len()];
        let mut resolver = Resolver { raw: self, names, target, budget, report, members };
        for position in 0..self.sets.len() as u32 {
            resolver.resolve_from(position);
        }
        resolver.members.into_iter().map(Option::unwrap_or_default).collect()
    }
}

struct Resolver<'a, 'd> {
    raw: &'a RawSets<'d>,
    names: &'a mut Names,
    target: &'a Target<'a>,
    budget: &'a mut Budget,
    report: &'a mut Report,
    members: Vec<Option<Vec<u32>>>,
}

impl Resolver<'_, '_> {
    /// Resolves a set behind the sets that it names. The stack is explicit because decks nest sets at will.
    fn resolve_from(&mut self, start: u32) {
        if self.members[start as usize].is_some() {
            return;
        }
        let mut open = vec![(start, self.named_sets(start))];
        let mut on_stack = FxHashSet::from_iter([start]);
        while let Some((set, waiting)) = open.last_mut() {
            let set = *set;
            let Some((child, at, keyword)) = waiting.pop() else {
                let members = self.gather(set);
                self.members[set as usize] = Some(members);
                on_stack.remove(&set);
                open.pop();
                continue;
            };
            if self.members[child as usize].is_some() || child == set {
                continue;
            }
            if !on_stack.insert(child) {
                let message =
                    format!("{} {} contains itself through other sets", self.raw.what, self.names.written(child));
                self.report.error(at, keyword, message, "list the members of one of the sets");
                self.names.mark_faulty(set);
                continue;
            }
            let below = self.named_sets(child);
            open.push((child, below));
        }
    }

    fn named_sets(&mut self, set: u32) -> Vec<(u32, At, &'static str)> {
        let mut found = Vec::new();
        for contribution in &self.raw.sets[set as usize] {
            let Contribution::Members(keyword, members) = contribution else { continue };
            for (name, at) in &members.names {
                match self.names.find(name) {
                    Some(child) => found.push((child, *at, *keyword)),
                    None => {
                        self.names.mark_faulty(set);
                        let remedy = self.names.remedy(name, self.report);
                        self.report.error(*at, keyword, self.names.missing(name), remedy);
                    }
                }
            }
        }
        found
    }

    fn gather(&mut self, set: u32) -> Vec<u32> {
        let mut all = Vec::new();
        for contribution in &self.raw.sets[set as usize] {
            match contribution {
                Contribution::Rows(rows) => {
                    let found = rows.clone().filter_map(|row| self.target.rows.position(row));
                    let before = all.len();
                    all.extend(found);
                    if all.len() - before < rows.len() {
                        self.names.mark_faulty(set);
                    }
                }
                Contribution::Positions(positions) => all.extend(positions),
                Contribution::Members(keyword, members) => self.gather_members(set, keyword, members, &mut all),
            }
        }
        all.sort_unstable();
        all.dedup();
        all
    }

    fn gather_members(&mut self, set: u32, keyword: &'static str, members: &Members, all: &mut Vec<u32>) {
        let what = self.raw.what;
        for &(label, at) in &members.labels {
            match self.target.index.get(label) {
                Some(position) => all.push(position),
                None => {
                    self.names.mark_faulty(set);
                    if !self.target.refused.contains(&label) {
                        let message = format!("{what} {label} is not defined");
                        self.report.error(at, keyword, message, "define it, or remove it from the set");
                    }
                }
            }
        }
        for &([first, last, increment], at) in &members.ranges {
            let before = all.len();
            let count = u64::from((last - first) / increment) + 1;
            let searched = count.min(self.target.labels.len() as u64) as usize;
            if !self.budget.take(searched, at, keyword, self.report) {
                return;
            }
            if count <= 4 * self.target.labels.len() as u64 {
                all.extend((first..=last).step_by(increment as usize).filter_map(|label| self.target.index.get(label)));
            } else {
                let inside = |label: u32| (first..=last).contains(&label) && (label - first).is_multiple_of(increment);
                all.extend(
                    (0..).zip(self.target.labels).filter(|&(_, &label)| inside(label)).map(|(position, _)| position),
                );
            }
            let missing = count - (all.len() - before) as u64;
            if missing > 0 && self.target.refused.is_empty() {
                let message =
                    format!("{missing} of the {count} {what}s of the range {first} to {last} are not defined");
                self.report.warning(at, keyword, message, "the set holds those that are defined");
            } else if missing > 0 {
                self.names.mark_faulty(set);
            }
        }
        for (name, at) in &members.names {
            let Some(child) = self.names.find(name) else { continue };
            self.names.mark_used(child);
            if self.names.is_faulty(child) {
                self.names.mark_faulty(set);
            }
            if let (Some(members), true) = (&self.members[child as usize], child != set)
                && self.budget.take(members.len(), *at, keyword, self.report)
            {
                all.extend(members);
            }
        }
    }
}

impl Builder<'_> {
    pub(super) fn build_sets(&mut self, layout: &Layout<'_>, node_rows: &Rows, element_rows: &Rows) {
        let mut raw_elements = RawSets { what: "element", sets: Vec::new() };
        for card in layout.all {
            let Some(name) = card.parameters.value("ELSET") else { continue };
            match (card.keyword.name, &card.body) {
                ("*ELEMENT", Body::Elements(rows)) => {
                    raw_elements.add(&mut self.element_sets, card, name, Contribution::Rows(rows.clone()));
                    if rows.is_empty() {
                        self.mark_set_of_refused_elements(name);
                    }
                }
                ("*ELSET", Body::Members(members)) => {
                    raw_elements.add(
                        &mut self.element_sets,
                        card,
                        name,
                        Contribution::Members(card.keyword.name, members),
                    );
                }
                _ => {}
            }
        }
        let target = Target {
            index: &self.element_index,
            labels: &self.model.mesh.element_labels,
            rows: element_rows,
            refused: &self.refused_elements,
        };
        let members = raw_elements.resolve(&mut self.element_sets, &target, &mut self.budget, self.report);
        self.model.mesh.element_sets = (0..)
            .zip(members)
            .map(|(position, members)| ElementSet {
                name: self.element_sets.written(position).to_string(),
                elements: members.into_iter().map(ElementId).collect(),
            })
            .collect();

        let mut raw_nodes = RawSets { what: "node", sets: Vec::new() };
        for card in layout.all {
            let Some(name) = card.parameters.value("NSET") else { continue };
            match (card.keyword.name, &card.body) {
                ("*NODE", Body::Nodes(rows)) => {
                    raw_nodes.add(&mut self.node_sets, card, name, Contribution::Rows(rows.clone()));
                }
                ("*NSET", Body::Members(members)) => {
                    raw_nodes.add(&mut self.node_sets, card, name, Contribution::Members(card.keyword.name, members));
                    if let Some(elements) = card.parameters.value("ELSET") {
                        let positions = self.nodes_of_set(elements, card.at);
                        raw_nodes.add(&mut self.node_sets, card, name, Contribution::Positions(positions));
                    }
                }
                _ => {}
            }
        }
        let target = Target {
            index: &self.node_index,
            labels: &self.model.mesh.node_labels,
            rows: node_rows,
            refused: &self.refused_nodes,
        };
        let members = raw_nodes.resolve(&mut self.node_sets, &target, &mut self.budget, self.report);
        self.model.mesh.node_sets = (0..)
            .zip(members)
            .map(|(position, members)| NodeSet {
                name: self.node_sets.written(position).to_string(),
                nodes: members.into_iter().map(NodeId).collect(),
            })
            .collect();
    }

    /// An `*ELEMENT` card without elements that can be used: because its type is not supported, or its lines are bad.
    fn mark_set_of_refused_elements(&mut self, name: &str) {
        if let (Some(position), false) = (self.element_sets.find(name), self.refused_elements.is_empty()) {
            self.element_sets.mark_faulty(position);
        }
    }

    fn nodes_of_set(&mut self, name: &str, at: At) -> Vec<u32> {
        let Some(set) = self.element_sets.refer(name, at, "*NSET", self.report) else { return Vec::new() };
        let mesh = &self.model.mesh;
        let elements = &mesh.element_sets[set as usize].elements;
        let nodes = elements.iter().flat_map(|element| mesh.elements.nodes(element.index()));
        if !self.budget.take(nodes.clone().count(), at, "*NSET", self.report) {
            return Vec::new();
        }
        nodes.map(|node| node.0).collect()
    }
}
