//! The second path: nothing is condensed. For models whose contact points are too many for dense matrices.
//!
//! Products with `W = B G Bᵀ` are solves with the factored bodies, and `(W + C)⁻¹` is a solve with the whole structure, its
//! bodies joined by the linearised contact (`coupled.rs`): by Woodbury,
//!
//! ```text
//! (W + C)⁻¹ = C⁻¹ − C⁻¹ B (K + Bᵀ C⁻¹ B)⁻¹ Bᵀ C⁻¹
//! ```
//!
//! Hard points have no compliance; a small one stands in for it and conjugate gradients remove it again (`conjugate.rs`), so that
//! both paths solve the same equations.

mod conjugate;
mod coupled;

pub use conjugate::{ActiveSystem, solve, stand_in};
pub use coupled::{Coupled, CoupledFactor};

use std::sync::Arc;

use super::body::Body;

/// The bodies and how contact joins them. Immutable.
pub struct SparseStructure {
    /// Factored bodies with their contact rows.
    pub bodies: Arc<Vec<Body>>,
    /// The whole structure, ready to be factored with any set of closed points.
    pub coupled: Coupled,
    /// Compliance of each point by the diagonal of the stiffness alone: the scale of `W_ii` [length/force].
    pub own: Vec<f64>,
}

impl SparseStructure {
    /// `W F`, added to `relief`.
    pub fn relief(&self, forces: &[f64], relief: &mut [f64]) {
        for body in self.bodies.iter() {
            body.respond(forces, relief, &mut []);
        }
    }

    /// `W_t F`, added to `slip`: first tangents, then second.
    pub fn slip(&self, forces: &[f64], slip: &mut [f64]) {
        for body in self.bodies.iter() {
            body.respond(forces, &mut [], slip);
        }
    }
}
