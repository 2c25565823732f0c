//! Contact tables of `JOB.dat`: the points of each pair, the totals of each pair.

use std::fmt::Write;

use super::components::{self, COMPONENTS};
use super::number::printed;
use super::printed_table::{Entity, Table};
use super::totals::{FAMILIES, Resultants, magnitude};
use crate::model::{ContactPair, ContactRequest, Model, SurfaceId};
use crate::simulation::{ContactPointInfo, ContactPointResult, PreparedModel};

/// What stands above the totals of a family.
const TITLES: [[&str; 3]; 3] = [
    ["TOTAL FORCE DUE TO CONTACT PRESSURE", "TOTAL FORCE DUE TO FRICTION", "TOTAL FORCE DUE TO PRESSURE AND FRICTION"],
    [
        "TOTAL MOMENT DUE TO CONTACT PRESSURE, ABOUT THE ORIGIN",
        "TOTAL MOMENT DUE TO FRICTION, ABOUT THE ORIGIN",
        "TOTAL MOMENT DUE TO PRESSURE AND FRICTION, ABOUT THE ORIGIN",
    ],
    [
        "CENTER OF THE FORCE DUE TO CONTACT PRESSURE",
        "CENTER OF THE FORCE DUE TO FRICTION",
        "CENTER OF THE FORCE DUE TO PRESSURE AND FRICTION",
    ],
];

/// Appends the tables of a request.
pub(super) fn contact_tables(
    text: &mut String,
    prepared: &PreparedModel,
    request: &ContactRequest,
    resultants: &[Resultants],
    contact: &[ContactPointResult],
) {
    let model = prepared.model();
    for (i, pair) in model.pairs.iter().enumerate().filter(|(_, pair)| request.selects(pair)) {
        let members = points_of(prepared, contact, request, i);
        if pair.surfaces().is_some() {
            point_table(text, model, pair, request, members);
        } else {
            gap_table(text, model, pair, request.summary, members);
        }
        if let Some(resultants) = resultants.get(i) {
            totals(text, request, resultants);
        }
    }
}

/// Points of a pair that a request is about, in the order of the contact points.
pub(super) fn points_of<'a>(
    prepared: &'a PreparedModel,
    contact: &'a [ContactPointResult],
    request: &ContactRequest,
    pair: usize,
) -> Vec<(&'a ContactPointInfo, &'a ContactPointResult)> {
    let chosen = request.nodes.map(|set| &prepared.model().mesh.node_sets[set.index()].nodes);
    let points = prepared.contact_points().iter().zip(contact);
    points
        .filter(|(point, _)| point.pair as usize == pair)
        .filter(|(point, _)| chosen.is_none_or(|nodes| nodes.binary_search(&point.node).is_ok()))
        .collect()
}

fn point_table(
    text: &mut String,
    model: &Model,
    pair: &ContactPair,
    request: &ContactRequest,
    members: Vec<(&ContactPointInfo, &ContactPointResult)>,
) {
    let columns: Vec<usize> = (0..COMPONENTS.len()).filter(|&c| request.asks_for(&[COMPONENTS[c]])).collect();
    let Some(surfaces) = pair.surfaces().filter(|_| !columns.is_empty() || request.asks_for(&["CSTATUS"])) else {
        return;
    };
    let name = |surface: SurfaceId| &model.mesh.surfaces[surface.index()].name;
    let whom = match request.nodes {
        None => "ALL SECONDARY NODES".to_owned(),
        Some(set) => format!("NODES OF NODE SET {}", model.mesh.node_sets[set.index()].name),
    };
    let heading = format!(
        "THE FOLLOWING TABLE IS PRINTED FOR {whom} IN CONTACT PAIR ({},{})",
        name(surfaces.secondary),
        name(surfaces.primary)
    );
    let names: Vec<&str> = columns.iter().map(|&c| COMPONENTS[c]).collect();
    let mut table = Table::new(&heading, Entity::Node, Some("STATUS"), &names);
    for (point, result) in members {
        let values = components::values(result);
        let values: Vec<f64> = columns.iter().map(|&c| values[c]).collect();
        table.row(model.mesh.node_labels[point.node.index()], Some(result.status.code()), &values);
    }
    table.finish(text, request.summary, request.totals);
}

/// Contact elements: E11 is the opening and S11 the pressure (the force, where the area is 1); then slip and shear.
pub(super) fn gap_table(
    text: &mut String,
    model: &Model,
    pair: &ContactPair,
    summary: bool,
    members: Vec<(&ContactPointInfo, &ContactPointResult)>,
) {
    let heading = format!("THE FOLLOWING TABLE IS PRINTED FOR ALL CONTACT ELEMENTS IN ELEMENT SET {}", pair.name);
    let columns = ["E11", "E12", "E13", "S11", "S12", "S13"];
    let mut table = Table::new(&heading, Entity::Element, Some("STATUS"), &columns);
    for (label, result) in gap_labels(model, pair).zip(members.iter().map(|(_, result)| result)) {
        table.row(label, Some(result.status.code()), &gap_values(result));
    }
    table.finish(text, summary, false);
}

/// Numbers of the contact elements of a pair, in the order of their points.
pub(super) fn gap_labels<'a>(model: &'a Model, pair: &'a ContactPair) -> impl Iterator<Item = u32> + 'a {
    let gaps = match &pair.members {
        crate::model::PairMembers::Gaps(gaps) => gaps.as_slice(),
        crate::model::PairMembers::Surfaces(_) | crate::model::PairMembers::General(_) => &[],
    };
    gaps.iter().map(|gap| model.mesh.element_labels[gap.element.index()])
}

/// E11, E12, E13, S11, S12, S13 of a contact element.
pub(super) fn gap_values(result: &ContactPointResult) -> [f64; 6] {
    let ContactPointResult { clearance, pressure, shear, slip, .. } = *result;
    [clearance, slip[0], slip[1], pressure, shear[0], shear[1]]
}

/// The force of pressure and the area always; the others when they are asked for.
fn totals(text: &mut String, request: &ContactRequest, resultants: &Resultants) {
    for (names, titles) in FAMILIES.iter().zip(TITLES) {
        for (name, title) in names.iter().zip(titles).filter(|(name, _)| **name == "CFN" || request.asks_for(&[name])) {
            let Some(vector) = resultants.family(name) else { continue };
            let mut columns: Vec<String> = (1..=3).map(|d| format!("{name}{d}")).collect();
            let mut values = vector.to_vec();
            if name.starts_with('C') {
                columns.push(format!("{name}M"));
                values.push(magnitude(vector));
            }
            let area = *name == "CFN";
            if area {
                columns.push("CAREA".to_owned());
                values.push(resultants.area);
            }
            // Writing to a string does not fail.
            let _ = writeln!(text, "\n   {title}{}\n", if area { " AND AREA IN CONTACT" } else { "" });
            let _ = writeln!(text, "            {}", columns.iter().map(|n| format!("{n:>15}")).collect::<String>());
            let _ = writeln!(text, "      TOTAL {}", values.iter().copied().map(printed).collect::<String>());
        }
    }
}
