//! Mass and damping matrices of the elements of a model.

use super::assembly::{coordinates, element_stiffness};
use crate::element::connector_mass::{self, Attachment};
use crate::element::{Elasticity, Stiffness, basis, mass};
use crate::model::{Connector, ElementId, ElementKind, MassMatrix, Material, Model, Rayleigh};

/// Whether the mass of elements of a kind is attached to each node alone.
pub fn lumps(kind: ElementKind, matrix: MassMatrix) -> bool {
    match matrix {
        MassMatrix::Lumped => true,
        MassMatrix::Consistent => false,
        MassMatrix::ByOrder => basis::edges(kind.shape()).is_empty(),
    }
}

/// Whether an element has a damping matrix.
pub fn damps(model: &Model, element: u32) -> bool {
    let section = model.mesh.connectors.get(&ElementId(element));
    let connector = match section {
        Some(Connector::Dashpot { coefficient, .. }) => *coefficient != 0.0,
        Some(Connector::Mass { alpha, .. } | Connector::RotaryInertia { alpha, .. }) => *alpha != 0.0,
        Some(Connector::Bar { .. } | Connector::Spring { .. } | Connector::Inert) | None => false,
    };
    connector || material(model, element).is_some_and(|m| m.damping != Rayleigh::default())
}

/// Material of an element; none for springs, dashpots, point masses and what is inert.
fn material(model: &Model, element: u32) -> Option<&Material> {
    model.materials.get(model.mesh.element_materials[element as usize].index())
}

/// Mass matrix of an element of the model, into `out` \[mass\] (of a rotary inertia \[mass·length²\]): block diagonal where it is
/// lumped; zeros where there is no density.
pub fn element_mass(model: &Model, element: u32, matrix: MassMatrix, out: &mut Stiffness) {
    let mesh = &model.mesh;
    let kind = mesh.elements.kind(element as usize);
    let density = material(model, element).and_then(|m| m.density).unwrap_or(0.0);
    let lumped = lumps(kind, matrix);
    let coordinates = coordinates(mesh, element);
    match mesh.connectors.get(&ElementId(element)) {
        Some(&section) => {
            let attachment = if lumped { Attachment::Lumped } else { Attachment::Consistent };
            connector_mass::mass(kind, &coordinates, section, density, attachment, out);
        }
        None if density == 0.0 => {
            out.clear(kind.node_count());
        }
        None if lumped => out.set_diagonal(&mass::lumped(kind, &coordinates, density)),
        None => mass::consistent(kind, &coordinates, density, out),
    }
}

/// Damping matrix of an element of the model, into `out` [force·time/length]: Rayleigh damping `alpha M + beta K` of its material,
/// dashpots, and `alpha M` of point masses and rotary inertias.
pub fn element_damping(
    model: &Model,
    elasticities: &[Elasticity],
    element: u32,
    matrix: MassMatrix,
    out: &mut Stiffness,
) {
    let mesh = &model.mesh;
    let kind = mesh.elements.kind(element as usize);
    match mesh.connectors.get(&ElementId(element)) {
        Some(&section) => connector_mass::damping(kind, &coordinates(mesh, element), section, out),
        None => {
            out.clear(kind.node_count());
        }
    }
    let Some(rayleigh) = material(model, element).map(|m| m.damping) else { return };
    let mut part = Stiffness::default();
    if rayleigh.alpha != 0.0 {
        element_mass(model, element, matrix, &mut part);
        out.add(rayleigh.alpha, &part);
    }
    if rayleigh.beta != 0.0 {
        element_stiffness(model, elasticities, element, &mut part);
        out.add(rayleigh.beta, &part);
    }
}
