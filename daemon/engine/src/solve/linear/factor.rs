//! The sparse factor: plain numbers, computed by faer.

use faer::Par;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltError;
use faer::sparse::linalg::cholesky::supernodal;
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};

use super::blocks::Blocks;
use super::{Dense, FactorSize, PIVOT_RELATIVE_MIN, SingularPivot, Symbolic};
use crate::solve::assembly::LowerMatrix;

/// `L Lᵀ` of a positive definite sparse matrix.
pub struct Factor {
    pub(super) blocks: Blocks,
    pub(super) values: Vec<f64>,
}

impl Factor {
    /// Factors a matrix; refuses one that is singular to rounding.
    pub fn new(matrix: &LowerMatrix, symbolic: Symbolic) -> Result<Self, SingularPivot> {
        let n = matrix.len();
        let mut values = vec![0.0; symbolic.size().values];
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &matrix.starts, None, &matrix.rows);
        let params = Default::default();
        let mut memory = MemBuffer::new(supernodal::factorize_supernodal_numeric_llt_scratch::<usize, f64>(
            &symbolic.inner,
            Par::Seq,
            params,
        ));
        supernodal::factorize_supernodal_numeric_llt(
            &mut values,
            SparseColMatRef::new(pattern, &matrix.values),
            Default::default(),
            &symbolic.inner,
            Par::Seq,
            MemStack::new(&mut memory),
            params,
        )
        .map_err(|LltError::NonPositivePivot { index }| SingularPivot { unknown: index })?;
        let factor = Self { blocks: symbolic.blocks(), values };
        factor.check_pivots(matrix)?;
        Ok(factor)
    }

    /// Refuses pivots that are rounding against the diagonal of the matrix.
    fn check_pivots(&self, matrix: &LowerMatrix) -> Result<(), SingularPivot> {
        let mut diagonal = matrix.diagonal();
        for s in 0..self.blocks.len() {
            let block = self.blocks.block(&self.values, s);
            for j in 0..block.width {
                let (pivot, original) = (block.column(j).0[0], diagonal.next().unwrap_or(0.0));
                // False for a NaN pivot too.
                let usable = pivot * pivot > PIVOT_RELATIVE_MIN * original;
                if !usable {
                    return Err(SingularPivot { unknown: block.start + j });
                }
            }
        }
        Ok(())
    }

    /// Numbers held.
    pub fn size(&self) -> FactorSize {
        FactorSize { values: self.values.len() }
    }

    /// Trailing block of L from unknown `begin` on, gathered from all supernodes that reach into it:
    /// `L_cc L_ccᵀ` is the Schur complement onto those unknowns.
    pub fn trailing(&self, begin: usize) -> Dense {
        let n = self.blocks.unknowns();
        let mut out = Dense::zeros(n - begin, n - begin);
        if begin == n {
            return out;
        }
        for s in self.blocks.supernode_of(begin)..self.blocks.len() {
            let block = self.blocks.block(&self.values, s);
            for j in begin.max(block.start)..block.start + block.width {
                let column = out.column_mut(j - begin);
                let (own, below) = block.column(j - block.start);
                column[j - begin..][..own.len()].copy_from_slice(own);
                for (&row, value) in block.pattern.iter().zip(below) {
                    column[row as usize - begin] = *value;
                }
            }
        }
        out
    }
}
