//! Sparse and dense factorisations. The only folder that names faer; everything runs sequentially, so that the bits of
//! a result do not depend on the machine's load.

mod blocks;
mod dense;
mod factor;
mod numeric;
mod product;
mod substitution;
mod symbolic;

#[cfg(test)]
mod tests;

pub use blocks::Blocks;
pub use dense::{Dense, DenseScratch, cholesky_in_place, cholesky_solve, eigen, singular};
pub use factor::Factor;
pub use symbolic::{FactorSize, Symbolic};

/// A pivot smaller than this part of its diagonal entry is rounding: the direction has no stiffness of its own.
/// Cholesky loses about `n` units of rounding; a body held by a real support keeps pivots above 1e-10 of the diagonal.
const PIVOT_RELATIVE_MIN: f64 = 1e-12;

/// The matrix has no usable pivot in this unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SingularPivot {
    /// Position of the unknown in elimination order.
    pub unknown: usize,
}
