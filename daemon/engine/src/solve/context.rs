//! What is known of a model when its bodies are prepared.

use super::assembly::element_stiffness;
use super::budget::Budget;
use super::columns::Column;
use super::constraints::Constraints;
use super::inertia;
use crate::contact::points::ContactPoint;
use crate::element::{Elasticity, Stiffness};
use crate::model::{MassMatrix, Model};

/// What bodies are made of: `stiffness K + damping C + mass M`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blend {
    /// Factor on the stiffness.
    pub stiffness: f64,
    /// Factor on the damping matrix.
    pub damping: f64,
    /// Factor on the mass matrix.
    pub mass: f64,
    /// How mass is attached to nodes.
    pub form: MassMatrix,
}

impl Blend {
    /// The stiffness alone.
    pub const STIFFNESS: Self = Self { stiffness: 1.0, damping: 0.0, mass: 0.0, form: MassMatrix::ByOrder };
    /// The mass alone.
    pub const fn mass(form: MassMatrix) -> Self {
        Self { stiffness: 0.0, damping: 0.0, mass: 1.0, form }
    }
}

/// What is known of the model when bodies are prepared.
pub struct Context<'a> {
    /// The model.
    pub model: &'a Model,
    /// Elastic constants by material.
    pub elasticities: &'a [Elasticity],
    /// Prescribed and dependent directions.
    pub constraints: &'a Constraints,
    /// Body-local number of each node.
    pub local: &'a [u32],
    /// Memory that may be used.
    pub budget: &'a Budget,
    /// All contact points.
    pub points: &'a [ContactPoint],
    /// Load and displacement columns.
    pub columns: &'a [Column],
    /// What bodies are made of.
    pub blend: Blend,
}

impl Context<'_> {
    /// Matrix of an element, into `out`.
    pub fn element_matrix(&self, element: u32, out: &mut Stiffness) {
        let Blend { stiffness, damping, mass, form } = self.blend;
        if self.blend == Blend::STIFFNESS {
            return element_stiffness(self.model, self.elasticities, element, out);
        }
        out.clear(self.model.mesh.elements.kind(element as usize).node_count());
        let mut part = Stiffness::default();
        if stiffness != 0.0 {
            element_stiffness(self.model, self.elasticities, element, &mut part);
            out.add(stiffness, &part);
        }
        if damping != 0.0 {
            inertia::element_damping(self.model, self.elasticities, element, form, &mut part);
            out.add(damping, &part);
        }
        if mass != 0.0 {
            inertia::element_mass(self.model, element, form, &mut part);
            out.add(mass, &part);
        }
    }

    /// Whether the matrix of an element couples its nodes.
    pub fn couples(&self, element: u32) -> bool {
        let massive = self.blend.stiffness == 0.0 && self.blend.damping == 0.0;
        !massive || !inertia::lumps(self.model.mesh.elements.kind(element as usize), self.blend.form)
    }
}
