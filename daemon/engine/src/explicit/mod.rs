//! Explicit dynamics: central differences on lumped masses, with kinematic and penalty contact. No stiffness is factored.
//!
//! An increment from `t(n)` to `t(n+1)`:
//!
//! 1. `K u(n)`: one pass over the matrix; loads, damping and penalty contact at `t(n)`.
//! 2. `a(n)`, `v(n+½)`, `u(n+1)`: one pass over the nodal vectors (`kick.rs`), groups of coupled directions behind it.
//! 3. Kinematic contact corrects what the prediction has done (`kinematic.rs`).
//! 4. Energies at `t(n)` (`energies.rs`).
//!
//! Everything here is a function of slices and of what preparation has found; how it becomes part of an analysis stands in
//! `procedure/explicit.rs`. Source: Abaqus manual v6.5, 6.3.3 (explicit dynamic analysis) and 21.4.4 (contact constraint enforcement).

mod coupled;
mod dense;
mod elements;
pub mod energies;
mod hard;
mod increment;
mod inertia;
mod kick;
pub mod kinematic;
mod limits;
mod model;
mod penalty;
mod phase;
mod plan;
mod rules;
mod scaling;
mod slots;
mod stable;
mod viscosity;

pub use increment::{ExplicitWork, Found, Memory};
pub use model::{ExplicitModel, Setting, UNLIMITED};
