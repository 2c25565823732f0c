//! Element tables of `JOB.dat`: stresses of solids, bars, springs, contact elements.

use super::NodalFields;
use super::printed_contact::{gap_labels, gap_values};
use super::printed_table::{Entity, Table};
use crate::model::{ElementId, ElementKind, ElementRequest, Model, NodeId, PairMembers};
use crate::simulation::{ContactPointResult, PreparedModel};

/// Appends the tables of a request: stresses at the nodes of its solids, the values of its bars and springs, and those of its
/// contact elements.
pub(super) fn element_tables(
    text: &mut String,
    prepared: &PreparedModel,
    request: &ElementRequest,
    fields: &NodalFields,
    contact: &[ContactPointResult],
) {
    stress_tables(text, prepared.model(), request, fields);
    gap_tables(text, prepared, request, contact);
}

/// Contact elements of a request, one table per element set of their definition.
fn gap_tables(text: &mut String, prepared: &PreparedModel, request: &ElementRequest, contact: &[ContactPointResult]) {
    let model = prepared.model();
    let wanted = |variable: &str| request.variables.iter().any(|v| v == variable);
    let mut columns = Vec::new();
    if wanted("E") {
        columns.extend([(0, "E11"), (1, "E12"), (2, "E13")]);
    }
    if wanted("S") {
        columns.extend([(3, "S11"), (4, "S12"), (5, "S13")]);
    }
    let set = request.set.map(|s| &model.mesh.element_sets[s.index()]);
    for (i, pair) in model.pairs.iter().enumerate() {
        let PairMembers::Gaps(gaps) = &pair.members else { continue };
        let points = prepared.contact_points().iter().zip(contact).filter(|(point, _)| point.pair as usize == i);
        let rows = gaps.iter().zip(gap_labels(model, pair)).zip(points.map(|(_, result)| result));
        let rows: Vec<_> = rows
            .filter(|((gap, _), _)| set.is_none_or(|set| set.elements.binary_search(&gap.element).is_ok()))
            .map(|((_, label), result)| (label, result))
            .collect();
        if rows.is_empty() || columns.is_empty() {
            continue;
        }
        let whom = set.map_or_else(|| "ALL ELEMENTS".to_owned(), |set| format!("ELEMENT SET {}", set.name));
        let heading = format!(
            "THE FOLLOWING TABLE IS PRINTED FOR THE CONTACT ELEMENTS OF {whom} (E11: OPENING, S11: POSITIVE IN COMPRESSION)"
        );
        let names: Vec<&str> = columns.iter().map(|(_, name)| *name).collect();
        let mut table = Table::new(&heading, Entity::Element, Some("STATUS"), &names);
        for (label, result) in rows {
            let values = gap_values(result);
            let values: Vec<f64> = columns.iter().map(|&(c, _)| values[c]).collect();
            table.row(label, Some(result.status.code()), &values);
        }
        table.finish(text, request.summary, false);
    }
}

/// Stresses at the nodes of the solids of a request, then the values of its bars and springs.
fn stress_tables(text: &mut String, model: &Model, request: &ElementRequest, fields: &NodalFields) {
    if !request.variables.iter().any(|v| v == "S") {
        return;
    }
    let mesh = &model.mesh;
    let set = request.set.map(|s| &mesh.element_sets[s.index()]);
    let whom = set.map_or_else(|| "ALL ELEMENTS".to_owned(), |set| format!("ELEMENT SET {}", set.name));
    let is_member = |element: ElementId| set.is_none_or(|set| set.elements.binary_search(&element).is_ok());
    let kinds = (0..).map(ElementId).zip(mesh.elements.iter());
    let solids = kinds.filter(|(element, (kind, _))| kind.is_solid() && is_member(*element));
    let mut nodes: Vec<NodeId> = solids.flat_map(|(_, (_, nodes))| nodes).copied().collect();
    nodes.sort_unstable();
    nodes.dedup();
    if !nodes.is_empty() {
        let columns = ["S11", "S22", "S33", "S12", "S13", "S23"];
        let heading = format!("THE FOLLOWING TABLE IS PRINTED FOR THE NODES OF {whom} (STRESSES AVERAGED AT NODES)");
        let mut table = Table::new(&heading, Entity::Node, None, &columns);
        for node in nodes {
            table.row(mesh.node_labels[node.index()], None, &fields.stress[node.index()]);
        }
        table.finish(text, request.summary, false);
    }
    for (bars, what, value) in [(true, "BARS", "STRESS"), (false, "SPRINGS", "FORCE")] {
        let is_wanted = |element: ElementId| (mesh.elements.kind(element.index()) == ElementKind::T3D2) == bars;
        let rows: Vec<_> = fields.axial.iter().filter(|(e, _)| is_wanted(*e) && is_member(*e)).collect();
        if rows.is_empty() {
            continue;
        }
        let heading =
            format!("THE FOLLOWING TABLE IS PRINTED FOR THE {what} OF {whom} (S11: {value}, POSITIVE IN TENSION)");
        let mut table = Table::new(&heading, Entity::Element, Some("PT"), &["S11"]);
        for &&(element, value) in &rows {
            table.row(mesh.element_labels[element.index()], Some("1"), &[value]);
        }
        table.finish(text, request.summary, false);
    }
}
