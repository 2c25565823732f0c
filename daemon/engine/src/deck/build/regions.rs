//! Regions of data lines: a number or the name of a set, and amplitudes by name.

use crate::model::{AmplitudeId, ElementId, NodeId, Region, SetId};

use super::super::card::Card;
use super::super::data::Row;
use super::super::lex::{self, looks_numeric, unquoted};
use super::super::report::{At, excerpt};
use super::Builder;

/// A region with its members.
pub struct Members<I> {
    /// What the analyst named.
    pub region: Region,
    /// Name of the set as defined, or the label as text.
    pub name: String,
    /// Members.
    pub members: Vec<I>,
}

impl Builder<'_> {
    /// Node of a label; `None` when it is not defined, which is reported.
    #[track_caller]
    pub(super) fn node(&mut self, label: u32, at: At, keyword: &str) -> Option<NodeId> {
        let found = self.node_index.get(label).map(NodeId);
        if found.is_none() && !self.refused_nodes.contains(&label) {
            self.report.error(at, keyword, format!("node {label} is not defined"), "define it, or correct the number");
        }
        found
    }

    /// Element of a label; `None` when it is not defined, which is reported.
    #[track_caller]
    pub(super) fn element(&mut self, label: u32, at: At, keyword: &str) -> Option<ElementId> {
        let found = self.element_index.get(label).map(ElementId);
        if found.is_none() && !self.refused_elements.contains(&label) {
            self.report.error(
                at,
                keyword,
                format!("element {label} is not defined"),
                "define it, or correct the number",
            );
        }
        found
    }

    /// Nodes that the first item of a line names; never empty.
    pub(super) fn node_region(&mut self, row: &Row<'_>) -> Option<Members<NodeId>> {
        let label = self.region_label(row, "node")?;
        if let Some(label) = label {
            let node = self.node(label, row.at, row.keyword)?;
            return Some(Members { region: Region::Label(label), name: label.to_string(), members: vec![node] });
        }
        let set = self.node_sets.refer(unquoted(row.text(0)), row.at, row.keyword, self.report)?;
        let nodes = &self.model.mesh.node_sets[set as usize].nodes;
        // Up to three directions of a line hold the members.
        let covered = self.budget.take(4 * nodes.len(), row.at, row.keyword, self.report);
        let members = covered.then(|| nodes.clone())?;
        let name = self.node_sets.written(set).to_string();
        self.not_empty(members.is_empty(), "node", &name, row)?;
        Some(Members { region: Region::Set(SetId(set)), name, members })
    }

    /// Elements that the first item of a line names; never empty.
    pub(super) fn element_region(&mut self, row: &Row<'_>) -> Option<Members<ElementId>> {
        let label = self.region_label(row, "element")?;
        if let Some(label) = label {
            let element = self.element(label, row.at, row.keyword)?;
            return Some(Members { region: Region::Label(label), name: label.to_string(), members: vec![element] });
        }
        let set = self.element_sets.refer(unquoted(row.text(0)), row.at, row.keyword, self.report)?;
        let elements = &self.model.mesh.element_sets[set as usize].elements;
        let covered = self.budget.take(4 * elements.len(), row.at, row.keyword, self.report);
        let members = covered.then(|| elements.clone())?;
        let name = self.element_sets.written(set).to_string();
        self.not_empty(members.is_empty(), "element", &name, row)?;
        Some(Members { region: Region::Set(SetId(set)), name, members })
    }

    /// `Some(None)` for a name, `None` for what is neither a name nor a label, which is reported.
    fn region_label(&mut self, row: &Row<'_>, what: &str) -> Option<Option<u32>> {
        let text = row.text(0);
        let remedy = format!("write a {what} number or the name of a {what} set");
        if text.is_empty() {
            self.report.error(row.at, row.keyword, format!("the {what} or {what} set is missing"), remedy);
            return None;
        }
        if !looks_numeric(text.as_bytes()) {
            return Some(None);
        }
        match lex::label(text.as_bytes()) {
            Ok(label) => Some(Some(label)),
            Err(fault) => {
                let message = format!("{what} {} {}", excerpt(text.as_bytes()), fault.text());
                self.report.error(row.at, row.keyword, message, remedy);
                None
            }
        }
    }

    fn not_empty(&mut self, empty: bool, what: &str, name: &str, row: &Row<'_>) -> Option<()> {
        if empty {
            let message = format!("{what} set {name} is empty, so the line would have no effect");
            self.report.error(row.at, row.keyword, message, "fill the set, or remove the line");
        }
        (!empty).then_some(())
    }

    /// Amplitude of a card: `Err` when it names one that does not exist, which is reported.
    pub(super) fn amplitude(&mut self, card: &Card) -> Result<Option<AmplitudeId>, ()> {
        match card.parameters.value("AMPLITUDE") {
            None => Ok(None),
            Some(name) => {
                let found = self.amplitudes.refer(name, card.at, card.keyword.name, self.report);
                found.map(|position| Some(AmplitudeId(position))).ok_or(())
            }
        }
    }
}
