//! Forward and backward substitution with a supernodal factor.
//!
//! All right-hand sides share one pass over L, in the order in which it is stored: for a few of them the memory is the
//! limit. The supernodes are taken in a fixed order, so that the bits are always the same.

use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Accum, MatMut, MatRef, Par};

use super::blocks::Block;
use super::product::{clear_registers, multiply};
use super::{Dense, Factor};

impl Factor {
    /// `rhs <- (L Lᵀ)⁻¹ rhs`, all columns at once.
    pub fn solve(&self, rhs: &mut Dense) {
        let mut scratch = self.scratch(rhs);
        self.forward(rhs, &mut scratch);
        self.backward(rhs, &mut scratch);
    }

    /// `rhs <- L⁻¹ rhs`.
    pub fn solve_lower(&self, rhs: &mut Dense) {
        self.forward(rhs, &mut self.scratch(rhs));
    }

    /// `rhs <- L⁻ᵀ rhs`.
    pub fn solve_transposed(&self, rhs: &mut Dense) {
        self.backward(rhs, &mut self.scratch(rhs));
    }

    /// Room for the pattern rows of any supernode.
    fn scratch(&self, rhs: &Dense) -> Vec<f64> {
        assert!(rhs.rows == self.blocks.unknowns(), "a right-hand side has a row per unknown");
        vec![0.0; self.blocks.pattern_max() * rhs.columns]
    }

    /// `rhs <- L⁻¹ rhs`. Supernodes that no entry of the right-hand side reaches cost nothing.
    fn forward(&self, rhs: &mut Dense, scratch: &mut [f64]) {
        for s in 0..self.blocks.len() {
            let block = self.blocks.block(&self.values, s);
            let own = block.start..block.start + block.width;
            if (0..rhs.columns).any(|j| rhs.column(j)[own.clone()].iter().any(|&x| x != 0.0)) {
                forward(&block, rhs, scratch);
            }
        }
    }

    /// `rhs <- L⁻ᵀ rhs`.
    fn backward(&self, rhs: &mut Dense, scratch: &mut [f64]) {
        for s in (0..self.blocks.len()).rev() {
            backward(&self.blocks.block(&self.values, s), rhs, scratch);
        }
    }
}

/// `x_own <- L_own⁻¹ x_own`, then `x_pattern <- x_pattern − L_pattern x_own`.
fn forward(block: &Block<'_>, rhs: &mut Dense, scratch: &mut [f64]) {
    let (columns, rows, below) = (rhs.columns, rhs.rows, block.pattern.len());
    let (own_factor, pattern_factor) = views(block);
    let mut own = rhs.view_mut().subrows_mut(block.start, block.width);
    solve_lower_triangular_in_place(own_factor, own.as_mut(), Par::Seq);
    clear_registers();
    if below == 0 {
        return;
    }
    let product = &mut scratch[..below * columns];
    let view = MatMut::from_column_major_slice_mut(product, below, columns);
    multiply(view, Accum::Replace, pattern_factor, own.as_ref(), 1.0);
    for (x, product) in rhs.values.chunks_exact_mut(rows).zip(product.chunks_exact(below)) {
        for (&row, value) in block.pattern.iter().zip(product) {
            x[row as usize] -= value;
        }
    }
}

/// `x_own <- L_own⁻ᵀ (x_own − L_patternᵀ x_pattern)`.
fn backward(block: &Block<'_>, rhs: &mut Dense, scratch: &mut [f64]) {
    let (columns, rows, below) = (rhs.columns, rhs.rows, block.pattern.len());
    let (own_factor, pattern_factor) = views(block);
    let gathered = &mut scratch[..below * columns];
    if below > 0 {
        for (x, gathered) in rhs.values.chunks_exact(rows).zip(gathered.chunks_exact_mut(below)) {
            for (&row, value) in block.pattern.iter().zip(gathered) {
                *value = x[row as usize];
            }
        }
    }
    let mut own = rhs.view_mut().subrows_mut(block.start, block.width);
    let gathered = MatRef::from_column_major_slice(&*gathered, below, columns);
    multiply(own.as_mut(), Accum::Add, pattern_factor.transpose(), gathered, -1.0);
    solve_upper_triangular_in_place(own_factor.transpose(), own, Par::Seq);
    clear_registers();
}

/// The triangle of the supernode's own rows and the rectangle under it.
fn views<'a>(block: &Block<'a>) -> (MatRef<'a, f64>, MatRef<'a, f64>) {
    MatRef::from_column_major_slice(block.values, block.height(), block.width).split_at_row(block.width)
}
