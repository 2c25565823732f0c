//! The sparse factor: plain numbers.

use super::blocks::Blocks;
use super::{Dense, FactorSize, SingularPivot, Symbolic, numeric};
use crate::solve::assembly::LowerMatrix;

/// `L Lᵀ` of a positive definite sparse matrix.
pub struct Factor {
    pub(super) blocks: Blocks,
    pub(super) values: Vec<f64>,
}

impl Factor {
    /// Factors a matrix; refuses one that is singular to rounding.
    pub fn new(matrix: &LowerMatrix, symbolic: Symbolic) -> Result<Self, SingularPivot> {
        let mut values = vec![0.0; symbolic.size().values];
        numeric::factor(matrix, &symbolic.blocks, &mut values)?;
        Ok(Self { blocks: symbolic.blocks, values })
    }

    /// A factor from its parts; none if they do not fit together.
    pub fn from_parts(blocks: Blocks, values: Vec<f64>) -> Option<Self> {
        blocks.is_consistent(values.len()).then_some(Self { blocks, values })
    }

    /// Where the numbers of L are.
    pub fn blocks(&self) -> &Blocks {
        &self.blocks
    }

    /// The numbers of L.
    pub fn values(&self) -> &[f64] {
        &self.values
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
