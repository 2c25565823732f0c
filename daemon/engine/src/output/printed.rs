//! `JOB.dat`: the printed tables, in the layout that analysts know.

use std::fmt::Write;
use std::path::Path;

use super::file::{OutputError, TextFile};
use super::number::printed;
use super::plan::Plan;
use super::printed_contact::contact_tables;
use super::printed_elements::element_tables;
use super::printed_step::{step_heading, summary};
use super::printed_table::{Entity, Table};
use super::status_log::status_changes;
use super::{Increment, NodalFields, step_of};
use crate::model::{Model, NodeId, NodeRequest, Totals};
use crate::simulation::{HistoryRow, IncrementReport, PreparedModel};

/// Writes the summary of an increment and the tables that are due.
pub(super) struct Printed {
    file: TextFile,
    /// Step whose heading was printed last.
    step: u32,
    /// Increment of that step whose summary was printed last.
    increment: u32,
    /// Sets whose reaction totals are in the history, in its order.
    total_sets: Vec<String>,
}

impl Printed {
    pub(super) fn create(directory: &Path, job: &str, prepared: &PreparedModel) -> Result<Self, OutputError> {
        let mut file = TextFile::create(directory, job, ".dat")?;
        file.append(&title(prepared))?;
        let total_sets = prepared.total_set_names().into_iter().map(str::to_owned).collect();
        Ok(Self { file, step: 0, increment: 0, total_sets })
    }

    /// Writes the summary of an increment with its contact log, if a status changed or a table is due, and the tables.
    pub(super) fn write(&mut self, said: &Increment<'_>, plan: &Plan) -> Result<(), OutputError> {
        let Increment { prepared, report, history, resultants, contact, fields } = *said;
        let tables = !(plan.node_prints.is_empty() && plan.element_prints.is_empty() && plan.contact_prints.is_empty());
        let model = prepared.model();
        let wanted = tables || plan.end || plan.contact_log;
        let Some(step) = step_of(model, report).filter(|_| wanted) else {
            return Ok(());
        };
        let mut text = String::new();
        if report.step != self.step {
            (self.step, self.increment) = (report.step, 0);
            step_heading(&mut text, step, report);
        }
        if report.increment != self.increment {
            self.increment = report.increment;
            summary(&mut text, step, report);
            contact_log(&mut text, prepared, report);
        }
        if !plan.contact_prints.is_empty() {
            text.push_str("\n\n                              C O N T A C T   O U T P U T\n");
            for request in &plan.contact_prints {
                contact_tables(&mut text, prepared, request, resultants, contact);
            }
        }
        if let Some(fields) = fields.filter(|_| !plan.element_prints.is_empty()) {
            text.push_str("\n\n                              E L E M E N T   O U T P U T\n");
            for request in &plan.element_prints {
                element_tables(&mut text, prepared, request, fields, contact);
            }
        }
        if !plan.node_prints.is_empty() {
            text.push_str("\n\n                              N O D E   O U T P U T\n");
            for request in &plan.node_prints {
                self.node_table(&mut text, model, request, history, fields);
            }
        }
        self.file.append(&text)
    }

    fn node_table(
        &self,
        text: &mut String,
        model: &Model,
        request: &NodeRequest,
        history: &HistoryRow,
        fields: Option<&NodalFields>,
    ) {
        let set = request.set.map(|set| &model.mesh.node_sets[set.index()]);
        let whom = set.map_or_else(|| "ALL NODES".to_owned(), |s| format!("NODES OF NODE SET {}", s.name));
        let everything: Vec<NodeId>;
        let nodes = match set {
            Some(set) => &set.nodes,
            None => {
                everything = (0..model.mesh.node_count() as u32).map(NodeId).collect();
                &everything
            }
        };
        let turning: Vec<(NodeId, NodeId)> =
            nodes.iter().filter_map(|&node| Some((node, model.mesh.rotation_of(node)?))).collect();
        for variable in &request.variables {
            let totals = (variable == "RF").then(|| set.and_then(|s| self.total(&s.name, history))).flatten();
            if request.totals != Totals::Only
                && let Some(fields) = fields
            {
                let heading = format!("THE FOLLOWING TABLE IS PRINTED FOR {whom}");
                let mut print = |name: &str, rows: &mut dyn Iterator<Item = (NodeId, NodeId)>, values: &[[f64; 3]]| {
                    let columns = [1, 2, 3].map(|i| format!("{name}{i}"));
                    let mut table = Table::new(&heading, Entity::Node, None, &columns.each_ref().map(String::as_str));
                    for (node, source) in rows {
                        table.row(model.mesh.node_labels[node.index()], None, &values[source.index()]);
                    }
                    table.finish(text, request.summary, false);
                };
                let solution = &fields.solution;
                let (own, values, rotations) = match variable.as_str() {
                    "U" => (Some("U"), &solution.displacement, "UR"),
                    "V" => (Some("V"), &solution.velocity, "VR"),
                    "A" => (Some("A"), &solution.acceleration, "AR"),
                    "RF" => (Some("RF"), &solution.reaction, "RM"),
                    "UR" => (None, &solution.displacement, "UR"),
                    "VR" => (None, &solution.velocity, "VR"),
                    "AR" => (None, &solution.acceleration, "AR"),
                    "RM" => (None, &solution.reaction, "RM"),
                    _ => continue,
                };
                // A static step has no velocities and accelerations.
                if values.is_empty() {
                    continue;
                }
                if let Some(name) = own {
                    print(name, &mut nodes.iter().map(|&node| (node, node)), values);
                }
                // The motion of a reference node has six components, and so has its reaction.
                let named = request.variables.iter().any(|other| other == rotations);
                if own.is_none() || (!turning.is_empty() && !named) {
                    print(rotations, &mut turning.iter().copied(), values);
                }
            }
            if request.totals != Totals::No
                && let Some(total) = totals
            {
                let _ = writeln!(text, "\n   TOTAL FORCE FOR {whom}\n");
                let _ = writeln!(text, "            {:>15}{:>15}{:>15}", "RF1", "RF2", "RF3");
                let _ = writeln!(text, "      TOTAL {}", total.map(printed).concat());
            }
        }
    }

    fn total(&self, set: &str, history: &HistoryRow) -> Option<[f64; 3]> {
        let i = self.total_sets.iter().position(|name| name.eq_ignore_ascii_case(set))?;
        history.reactions.get(i).copied()
    }
}

fn title(prepared: &PreparedModel) -> String {
    let model = prepared.model();
    let mut text = format!("\n   OVERCLOSURE {}\n\n", env!("CARGO_PKG_VERSION"));
    for line in model.heading.lines() {
        // Writing to a string does not fail, here and below.
        let _ = writeln!(text, "   {line}");
    }
    text.push_str("\n                              P R O B L E M   S I Z E\n\n");
    for (what, count) in [
        ("ELEMENTS", model.mesh.elements.len()),
        ("NODES", model.mesh.node_count()),
        ("CONTACT PAIRS", model.pairs.len()),
        ("CONTACT POINTS", prepared.contact_points().len()),
        ("STEPS", model.steps.len()),
    ] {
        let _ = writeln!(text, "   {:<40}{count:>12}", format!("NUMBER OF {what} IS"));
    }
    text
}

/// Points whose status changed in the increment.
fn contact_log(text: &mut String, prepared: &PreparedModel, report: &IncrementReport) {
    if report.status_changes.is_empty() {
        return;
    }
    text.push_str(
        "\n   CONTACT POINTS THAT CHANGED STATUS IN THIS INCREMENT\n\n         NODE   FROM     TO   CONTACT PAIR\n\n",
    );
    for change in status_changes(prepared, report) {
        let (from, to) = (change.from.code(), change.to.code());
        let _ = writeln!(text, "  {:>11} {from:>6} {to:>6}   {}", change.node, change.pair);
    }
}
