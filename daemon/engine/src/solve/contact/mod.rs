//! The contact solve in gap space: which points carry force, how much, and where bodies settle that only contact holds.
//!
//! ```text
//! h = h_free − W F + D α,      F_i = A_i p(h_i)  (curves),      h_i ≤ 0, F_i ≥ 0, F_i h_i = 0  (walls; see `row.rs`)
//! Dᵀ F = Rᵀ f
//! ```
//!
//! `held.rs` solves it with the motions `α` held, `balance.rs` finds them.

mod active_sparse;
mod balance;
mod held;
mod refinement;
mod row;
#[cfg(test)]
mod row_tests;
mod sharing;
mod system;
#[cfg(test)]
mod tests;
mod view;

pub use held::ContactSolver;
pub use row::{Curve, Dashpot, Row, Viscosity, Wall};
pub use system::{ContactSystem, Structure, initial_springs};

/// Springs on motions, relative to the stiffness with which closed contact holds them: soft enough to lead to the balance in a few
/// steps, stiff enough to keep thirteen digits.
const SPRING_RATIO: f64 = 1e-3;

/// What the contact points are pushed by in an increment.
#[derive(Clone, Copy)]
pub struct Problem<'a> {
    /// What each row does.
    pub rows: &'a [Row],
    /// Overclosures without contact forces and motions.
    pub free: &'a [f64],
    /// `Rᵀ f` per motion.
    pub load: &'a [f64],
    /// Scale of its rounding.
    pub load_scale: &'a [f64],
}

/// Start and solution of an increment.
pub struct Unknowns<'a> {
    /// `F`.
    pub forces: &'a mut [f64],
    /// `W F`.
    pub relief: &'a mut [f64],
    /// Status of each point.
    pub closed: &'a mut [bool],
    /// `h`.
    pub overclosures: &'a mut [f64],
    /// `α`.
    pub motions: &'a mut [f64],
    /// Springs on the motions that led to the balance last time [force/length].
    pub springs: &'a mut [f64],
}

/// Work of a solve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SolveCounts {
    /// Iterations without a change of status.
    pub equilibrium_iterations: u32,
    /// Iterations that changed the status of a point.
    pub severe_discontinuity_iterations: u32,
    /// Sparse factorisations.
    pub factorizations: u32,
}

/// Why no solution was found.
#[derive(Clone, Debug, PartialEq)]
pub enum SolveFailure {
    /// Hard points that overlap although no contact force can move them.
    Infeasible {
        /// Points and their overclosures.
        points: Vec<(u32, f64)>,
    },
    /// Loads along a motion of bodies that no contact holds.
    Unheld {
        /// The motion.
        motions: Vec<f64>,
    },
    /// Statuses or multipliers were still changing when an increment was given up.
    Unsettled,
    /// The iteration limit was reached.
    NotConverged {
        /// Points that were still changing or out of balance.
        points: Vec<u32>,
    },
}
