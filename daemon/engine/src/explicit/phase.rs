//! Inertia, damping and limits of a model with its masses scaled: what stays the same until a step scales them anew.

use super::elements::Part;
use super::inertia::Inertia;
use super::limits::Limits;
use super::slots::Slots;
use super::viscosity::BulkViscosity;
use crate::contact::points::ContactPoint;
use crate::element::{Elasticity, Stiffness, connector_mass};
use crate::model::{ElementId, MassMatrix, Model, NodeId};
use crate::nodal::Nodal;
use crate::solve::assembly::{coordinates, element_stiffness};
use crate::solve::block_matrix::BlockMatrix;
use crate::solve::columns::Column;
use crate::solve::constraints::Constraints;
use crate::solve::inertia::element_mass;

/// What a phase is made from.
pub struct Source<'a> {
    /// The model.
    pub model: &'a Model,
    /// Elastic constants by material.
    pub elasticities: &'a [Elasticity],
    /// Prescribed and dependent directions.
    pub constraints: &'a Constraints,
    /// Columns that carry loads.
    pub columns: &'a [Column],
    /// Contact rows.
    pub nodal: &'a Nodal,
    /// Contact points followed by tangential rows.
    pub row_points: &'a [ContactPoint],
    /// Elements with mass.
    pub parts: &'a [Part],
}

/// See the module.
pub struct Phase {
    /// Inertia of every direction.
    pub inertia: Inertia,
    /// Stable increments without contact.
    pub limits: Limits,
    /// Contact rows on independent directions.
    pub slots: Slots,
    /// Rayleigh damping and dashpots; none where nothing damps.
    pub damping: Option<BlockMatrix>,
    /// Bulk viscosity.
    pub viscosity: BulkViscosity,
}

impl Phase {
    /// With factors on the masses of the parts and bulk viscosities. The error is what is wrong, in words.
    pub fn new(source: &Source<'_>, factors: &[f64], bulk: [f64; 2]) -> Result<Self, String> {
        let Source { model, constraints, columns, .. } = *source;
        let blocks = mass_blocks(source, factors);
        let inertia = Inertia::new(model, constraints, columns, &blocks).map_err(|n| {
            format!("equations couple {n} directions by their masses, which is more than is solved in one system; use *RIGID BODY, or equations of fewer nodes")
        })?;
        let slots = Slots::new(&inertia, source.nodal, source.row_points);
        let limits = Limits::new(model, source.parts, factors, bulk[0], &inertia);
        let damping = damping(source, factors);
        let viscosity = BulkViscosity::new(model, source.parts, factors, bulk);
        Ok(Self { inertia, limits, slots, damping, viscosity })
    }

    /// Whether anything resists velocities.
    pub fn is_damped(&self) -> bool {
        self.damping.is_some() || !self.viscosity.is_empty()
    }

    /// Numbers of eight bytes that it holds.
    pub fn numbers(&self) -> usize {
        let damping = self.damping.as_ref().map_or(0, |c| c.bytes() / 8);
        self.inertia.numbers() + self.slots.numbers() + self.viscosity.numbers() + 3 * self.limits.nodes.len() + damping
    }
}

/// Diagonal blocks of the lumped mass matrix.
fn mass_blocks(source: &Source<'_>, factors: &[f64]) -> Vec<[f64; 9]> {
    let mesh = &source.model.mesh;
    let mut blocks = vec![[0.0; 9]; mesh.nodes.len()];
    for (part, factor) in source.parts.iter().zip(factors) {
        for (node, mass) in mesh.elements.nodes(part.element as usize).iter().zip(&part.masses) {
            (0..3).for_each(|d| blocks[node.index()][4 * d] += factor * mass);
        }
    }
    let mut mass = Stiffness::default();
    let mut points: Vec<ElementId> = mesh.connectors.keys().copied().collect();
    points.sort_unstable();
    for element in points {
        let nodes = mesh.elements.nodes(element.index());
        if nodes.len() == 1 {
            element_mass(source.model, element.0, MassMatrix::Lumped, &mut mass);
            let block = &mut blocks[nodes[0].index()];
            block.iter_mut().zip(mass.block(0, 0)).for_each(|(sum, m)| *sum += m);
        }
    }
    blocks
}

/// `alpha M + beta K` of the materials, dashpots, and what damps point masses.
fn damping(source: &Source<'_>, factors: &[f64]) -> Option<BlockMatrix> {
    let model = source.model;
    let mesh = &model.mesh;
    let damped = |m: &crate::model::Material| m.damping.alpha != 0.0 || m.damping.beta != 0.0;
    let by_section = |section: &crate::model::Connector| {
        use crate::model::Connector::{Dashpot, Mass, RotaryInertia};
        match section {
            Dashpot { coefficient, .. } => *coefficient != 0.0,
            Mass { alpha, .. } | RotaryInertia { alpha, .. } => *alpha != 0.0,
            _ => false,
        }
    };
    if !model.materials.iter().any(damped) && !mesh.connectors.values().any(by_section) {
        return None;
    }
    let mut factor_of = vec![1.0; mesh.elements.len()];
    source.parts.iter().zip(factors).for_each(|(part, f)| factor_of[part.element as usize] = *f);
    let mut part = Stiffness::default();
    let matrix = BlockMatrix::assemble(mesh, &mut |e, out| {
        let kind = mesh.elements.kind(e as usize);
        match mesh.connectors.get(&ElementId(e)) {
            Some(&section) => connector_mass::damping(kind, &coordinates(mesh, e), section, out),
            None => {
                out.clear(kind.node_count());
            }
        }
        let rayleigh = super::elements::material(model, e).map(|m| m.damping).unwrap_or_default();
        if rayleigh.alpha != 0.0 {
            element_mass(model, e, MassMatrix::Lumped, &mut part);
            out.add(rayleigh.alpha * factor_of[e as usize], &part);
        }
        if rayleigh.beta != 0.0 {
            element_stiffness(model, source.elasticities, e, &mut part);
            out.add(rayleigh.beta, &part);
        }
    });
    Some(matrix)
}

/// Free directions without inertia along which something acts: an element, a load or a contact point; ascending flat positions.
pub fn without_inertia(phase: &Phase, source: &Source<'_>, stiffness: &BlockMatrix) -> Vec<u32> {
    let count = source.model.mesh.nodes.len();
    let mut acted = vec![false; 3 * count];
    let mut act = |at: u32| {
        for (independent, _) in super::inertia::terms_of(&phase.inertia.dependents, at) {
            acted[independent as usize] = true;
        }
    };
    for node in 0..count as u32 {
        let block = stiffness.diagonal(NodeId(node));
        let damping = phase.damping.as_ref().map_or([0.0; 9], |c| c.diagonal(NodeId(node)));
        (0..3).filter(|&d| block[4 * d] != 0.0 || damping[4 * d] != 0.0).for_each(|d| act(3 * node + d as u32));
    }
    for column in source.columns.iter().filter(|c| !c.is_displacement()) {
        let loaded = column.entries().iter().filter(|e| e.2 != 0.0);
        loaded.for_each(|&(node, d, _)| act(3 * node.0 + u32::from(d)));
    }
    for row in &phase.slots.rows {
        for &(slot, b) in row.entries.iter().filter(|e| e.1.abs() > 1e-12) {
            debug_assert!(b.is_finite());
            acted[phase.slots.at[slot as usize] as usize] = true;
        }
    }
    (0..3 * count as u32)
        .filter(|&at| acted[at as usize] && !phase.inertia.has_inertia(at))
        .filter(|&at| !source.constraints.is_prescribed(NodeId(at / 3), at as usize % 3))
        .filter(|&at| phase.inertia.dependents.binary_search_by_key(&at, |d| d.at).is_err())
        .collect()
}
