//! What can be found about a model before anything is factored.

use crate::contact::points::{self, ContactPoint};
use crate::diagnostic::{Diagnostic, Place};
use crate::model::Model;
use crate::procedure::loading::Loading;
use crate::solve::numbering::Bodies;
use crate::solve::rigid;
use crate::solve::supports::Supports;

/// A model that can be prepared, with what was learnt on the way.
pub struct Examined {
    /// Prescribed directions.
    pub supports: Supports,
    /// Contact points of all pairs.
    pub points: Vec<ContactPoint>,
    /// Connected bodies.
    pub bodies: Bodies,
    /// Columns and their courses.
    pub loading: Loading,
    /// Findings that leave the answer standing.
    pub warnings: Vec<Diagnostic>,
}

/// Examines a validated model; the errors are all there are.
pub fn examine(model: &Model) -> Result<Examined, Vec<Diagnostic>> {
    let supports = Supports::new(model);
    let (points, mut warnings) = points::find(model);
    let bodies = Bodies::find(&model.mesh);
    let mut errors = unattached(model, &bodies, &supports, &points);
    errors.extend(unheld(model, &bodies, &supports));
    warnings.extend(unreachable_loads(model, &bodies));
    match Loading::new(model) {
        Ok(loading) if errors.is_empty() => Ok(Examined { supports, points, bodies, loading, warnings }),
        Ok(_) => Err(errors),
        Err(found) => {
            errors.extend(found);
            Err(errors)
        }
    }
}

/// Bodies that the supports do not hold, by name and motion.
fn unheld(model: &Model, bodies: &Bodies, supports: &Supports) -> Vec<Diagnostic> {
    let mut errors = Vec::new();
    for (nodes, elements) in bodies.nodes.iter().zip(&bodies.elements) {
        let motions = rigid::free_motions(&model.mesh, nodes, |n, d| supports.is_prescribed(n, d));
        if !motions.is_empty() {
            errors.push(Diagnostic::error(
                Place::nowhere(),
                "*BOUNDARY",
                format!(
                    "body {} is not held by its own supports, which leave it {}; contact alone cannot hold a body in this version",
                    body_name(model, elements),
                    motions.join(", ")
                ),
                "prescribe enough of its directions by *BOUNDARY",
            ));
        }
    }
    errors
}

/// The smallest element set that covers the body, else its first element.
fn body_name(model: &Model, elements: &[u32]) -> String {
    let first = elements[0];
    let covers = |set: &&crate::model::ElementSet| {
        set.elements.len() >= elements.len()
            && elements.iter().all(|&e| set.elements.binary_search(&crate::model::ElementId(e)).is_ok())
    };
    match model.mesh.element_sets.iter().filter(covers).min_by_key(|s| s.elements.len()) {
        Some(set) => set.name.clone(),
        None => format!("of element {}", model.mesh.element_labels[first as usize]),
    }
}

/// Contact nodes that no element holds and no support fixes.
fn unattached(model: &Model, bodies: &Bodies, supports: &Supports, points: &[ContactPoint]) -> Vec<Diagnostic> {
    let mut reported = rustc_hash::FxHashSet::default();
    let mut errors = Vec::new();
    for point in points {
        let n = point.node;
        let loose = bodies.of_node[n.index()] == u32::MAX && (0..3).any(|d| !supports.is_prescribed(n, d));
        if loose && reported.insert(n) {
            errors.push(Diagnostic::error(
                model.pairs[point.pair as usize].place.clone(),
                "*CONTACT PAIR",
                format!(
                    "secondary node {} belongs to no element and is not fully prescribed",
                    model.mesh.node_labels[n.index()]
                ),
                "attach it to an element or prescribe its directions 1 to 3",
            ));
        }
    }
    errors
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
                format!("node {} belongs to no element: its force acts on nothing", model.mesh.node_labels[n.index()]),
                "load nodes of elements",
            ));
        }
    }
    warnings
}
