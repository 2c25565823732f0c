//! What can be found about a model before anything is factored.

use rustc_hash::FxHashSet;

use crate::contact::points::{self, ContactPoint};
use crate::diagnostic::{Diagnostic, Place};
use crate::model::{Model, NodeId};
use crate::procedure::loading::Loading;
use crate::procedure::rows::{self, RowPlan};
use crate::solve::constraints::Constraints;
use crate::solve::floating::{Floating, LOAD_ROUNDING};
use crate::solve::linear::Dense;
use crate::solve::motions::Motions;
use crate::solve::numbering::Bodies;
use crate::solve::parts::Sample;

/// A model that can be prepared, with what was learnt on the way.
pub struct Examined {
    /// Prescribed and dependent directions.
    pub constraints: Constraints,
    /// Contact points of all pairs.
    pub points: Vec<ContactPoint>,
    /// The same followed by the tangential rows.
    pub row_points: Vec<ContactPoint>,
    /// What the rows are made of.
    pub rows: RowPlan,
    /// Connected bodies.
    pub bodies: Bodies,
    /// Motions of each body that its supports leave free.
    pub motions: Vec<Motions>,
    /// The same at the contact points.
    pub floating: Floating,
    /// Columns and their courses.
    pub loading: Loading,
    /// Findings that leave the answer standing.
    pub warnings: Vec<Diagnostic>,
}

/// Examines a validated model; the errors are all there are.
pub fn examine(model: &Model) -> Result<Examined, Vec<Diagnostic>> {
    let (points, mut warnings) = points::find(model);
    let rows = RowPlan::new(model, &points).map_err(|pairs| no_stiffness(model, &pairs))?;
    let row_points = rows::with_tangential(model, &points);
    let nodes: Vec<NodeId> = contact_nodes(&points);
    let constraints = Constraints::new(model, nodes.iter().copied());
    let bodies = Bodies::find(model, nodes.iter().copied().filter(|&n| !constraints.is_fixed(n)));
    let mut motions: Vec<Motions> = (bodies.nodes.iter().zip(&bodies.elements))
        .map(|(nodes, elements)| Motions::find(model, &constraints, nodes, elements, &bodies.local))
        .collect();
    let floating = Floating::new(model, &constraints, &row_points, &bodies, &mut motions);
    warnings.extend(unreachable_loads(model, &bodies));
    let mut loading = Loading::new(model)?;
    constraints.extend(&mut loading.columns);
    let (errors, idle) = unheld(model, &bodies, &motions, &floating, &loading);
    warnings.extend(idle);
    if errors.is_empty() {
        Ok(Examined { constraints, points, row_points, rows, bodies, motions, floating, loading, warnings })
    } else {
        Err(errors)
    }
}

/// Nodes that contact may hold, each once, in the order of the points: secondary nodes, and the first nodes of GAP elements.
fn contact_nodes(points: &[ContactPoint]) -> Vec<NodeId> {
    let mut seen = FxHashSet::default();
    let mut nodes = Vec::new();
    for point in points {
        point.row(point.normal, |node, _, _| {
            if seen.insert(node) {
                nodes.push(node);
            }
        });
    }
    nodes
}

/// Automatic stiffnesses that have no elements to be taken from.
fn no_stiffness(model: &Model, pairs: &[u32]) -> Vec<Diagnostic> {
    let finding = |&pair: &u32| {
        let pair = &model.pairs[pair as usize];
        Diagnostic::error(
            pair.place.clone(),
            "*SURFACE BEHAVIOR",
            format!(
                "pair {}: an automatic penalty stiffness or damping is a multiple of the stiffness of the elements underneath, and neither side has any",
                pair.name
            ),
            "give the stiffness on the data line of *SURFACE BEHAVIOR (the coefficient on that of STABILIZE)",
        )
    };
    pairs.iter().map(finding).collect()
}

/// Motions that neither supports nor contact resist, of bodies with elements: an error where a load of the deck acts along
/// one, else a warning.
fn unheld(
    model: &Model,
    bodies: &Bodies,
    motions: &[Motions],
    floating: &Floating,
    loading: &Loading,
) -> (Vec<Diagnostic>, Vec<Diagnostic>) {
    let (mut errors, mut warnings) = (Vec::new(), Vec::new());
    let loads = floating.loads(&loading.columns, bodies, motions);
    // In a dynamic step a body that nothing holds moves.
    let statics: Vec<bool> = model.steps.iter().map(|step| !step.procedure.is_dynamic()).collect();
    let ends: Vec<Vec<f64>> =
        loading.step_ends(model).into_iter().zip(&statics).filter(|(_, held)| **held).map(|(end, _)| end).collect();
    // What the lines of the deck do together at the end of a step counts: one may balance another.
    let acts = |z: usize| {
        let combination = floating.loose.column(z);
        ends.iter().any(|coefficients| {
            let terms = |d: &Dense, abs: bool| -> f64 {
                let of_column = |j: usize| d.column(j).iter().zip(combination).map(|(l, z)| l * z).sum::<f64>();
                let of_scale = |j: usize| d.column(j).iter().zip(combination).map(|(l, z)| (l * z).abs()).sum::<f64>();
                let term = |(j, a): (usize, &f64)| if abs { a.abs() * of_scale(j) } else { a * of_column(j) };
                coefficients.iter().enumerate().map(term).sum()
            };
            terms(&loads.loads, false).abs() > LOAD_ROUNDING * terms(&loads.scales, true)
        })
    };
    // Findings of one body together, bodies in the order of their motions.
    let mut found: Vec<(String, Vec<String>, Vec<String>)> = Vec::new();
    for z in 0..floating.loose.columns {
        let (sample, words) = floating.describe(motions, floating.loose.column(z));
        let (name, said) = match sample {
            Sample::Node(node) => (format!("node {}", model.mesh.node_labels[node.index()]), words),
            Sample::Element(e) => {
                let body = bodies.of_node[model.mesh.elements.nodes(e as usize)[0].index()] as usize;
                (body_name(model, &bodies.nodes[body], &bodies.elements[body]), words)
            }
        };
        let at = found.iter().position(|f| f.0 == name).unwrap_or_else(|| {
            found.push((name, Vec::new(), Vec::new()));
            found.len() - 1
        });
        if acts(z) {
            found[at].1.push(said);
        } else if !ends.is_empty() && matches!(sample, Sample::Element(_)) {
            // A lone node that nothing loads and nothing resists just stays.
            found[at].2.push(said);
        }
    }
    for (name, loaded, idle) in found {
        if !loaded.is_empty() {
            errors.push(Diagnostic::error(
                Place::nowhere(),
                "*BOUNDARY",
                format!("{name} is loaded along motions that neither supports nor contact hold: {}", loaded.join(", ")),
                "hold these motions by *BOUNDARY, *EQUATION or a spring, or let a contact pair resist them",
            ));
        }
        if !idle.is_empty() {
            warnings.push(Diagnostic::warning(
                Place::nowhere(),
                "*BOUNDARY",
                format!(
                    "nothing holds {name} against {}; no load acts along it, so it stays where it is",
                    idle.join(", ")
                ),
                "hold these motions by *BOUNDARY if the body should not be free",
            ));
        }
    }
    (errors, warnings)
}

/// A body in words: the smallest element set that covers it, else its first element or its node.
pub fn body_name(model: &Model, nodes: &[NodeId], elements: &[u32]) -> String {
    let Some(&first) = elements.first() else {
        return format!("node {}", model.mesh.node_labels[nodes[0].index()]);
    };
    let covers = |set: &&crate::model::ElementSet| {
        set.elements.len() >= elements.len()
            && elements.iter().all(|&e| set.elements.binary_search(&crate::model::ElementId(e)).is_ok())
    };
    match model.mesh.element_sets.iter().filter(covers).min_by_key(|s| s.elements.len()) {
        Some(set) => format!("body {}", set.name),
        None => format!("the body of element {}", model.mesh.element_labels[first as usize]),
    }
}

/// Loads on nodes that belong to no element go nowhere.
fn unreachable_loads(model: &Model, bodies: &Bodies) -> Vec<Diagnostic> {
    let mut warnings = Vec::new();
    for load in model.steps.iter().flat_map(|s| &s.loads) {
        if let crate::model::LoadKind::Concentrated { nodes, .. } = &load.kind
            && let Some(n) = nodes.iter().find(|n| bodies.of_node[n.index()] == u32::MAX)
        {
            warnings.push(Diagnostic::warning(
                load.place.clone(),
                "*CLOAD",
                format!(
                    "node {} belongs to no element and no equation: its force acts on nothing",
                    model.mesh.node_labels[n.index()]
                ),
                "load nodes of elements",
            ));
        }
    }
    warnings
}
