//! Structure of a sparse factor: which columns form a supernode and which rows each supernode reaches.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::SymbolicSupernodalParams;
use faer::sparse::linalg::cholesky::{simplicial, supernodal};

use super::blocks::Blocks;
use crate::solve::assembly::LowerMatrix;

/// Sizes of a factorisation before it is done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FactorSize {
    /// Numbers stored in L.
    pub values: usize,
}

/// When supernodes are merged although their patterns differ: up to so many columns, if at most this part of the
/// numbers are zeros. Wide ones gain nothing by it.
const RELAXATION: [(usize, f64); 4] = [(4, 1.0), (16, 0.8), (48, 0.1), (usize::MAX, 0.02)];
/// Columns of the widest block: the unused triangle on its diagonal is small then against the numbers below.
const WIDTH_MAX: usize = 512;

/// Structure of L.
#[derive(Clone)]
pub struct Symbolic {
    pub(super) blocks: Blocks,
}

impl Symbolic {
    /// Analyses a matrix in its own order.
    pub fn analyse(matrix: &LowerMatrix) -> Self {
        let n = matrix.len();
        // faer analyses the upper triangle: transpose the pattern. Rows come out ascending.
        let mut starts = vec![0usize; n + 1];
        for &r in &matrix.rows {
            starts[r + 1] += 1;
        }
        for i in 0..n {
            starts[i + 1] += starts[i];
        }
        let mut fill = starts.clone();
        let mut rows = vec![0usize; matrix.rows.len()];
        for j in 0..n {
            for &r in &matrix.rows[matrix.starts[j]..matrix.starts[j + 1]] {
                rows[fill[r]] = j;
                fill[r] += 1;
            }
        }
        let upper = SymbolicSparseColMatRef::new_checked(n, n, &starts, None, &rows);
        let mut etree = vec![0isize; n];
        let mut counts = vec![0usize; n];
        let request = simplicial::prefactorize_symbolic_cholesky_scratch::<usize>(n, rows.len())
            .or(supernodal::factorize_supernodal_symbolic_cholesky_scratch::<usize>(n));
        let mut memory = MemBuffer::new(request);
        let stack = MemStack::new(&mut memory);
        let etree = simplicial::prefactorize_symbolic_cholesky(&mut etree, &mut counts, upper, stack);
        let inner = supernodal::factorize_supernodal_symbolic_cholesky(
            upper,
            etree,
            &counts,
            stack,
            SymbolicSupernodalParams { relax: Some(&RELAXATION) },
        )
        .expect("the index type is as wide as memory");
        let blocks = Blocks {
            starts: std::iter::once(0).chain(inner.supernode_end().iter().copied()).collect(),
            pattern_starts: inner.col_ptr_for_row_idx().to_vec(),
            pattern: inner.row_idx().iter().map(|&row| row as u32).collect(),
            value_starts: inner.col_ptr_for_val().to_vec(),
        };
        Self { blocks: blocks.cut(WIDTH_MAX) }
    }

    /// Multiplications and additions of the numeric factorisation.
    pub fn operations(&self) -> f64 {
        let blocks = &self.blocks;
        (0..blocks.len())
            .map(|s| {
                let width = blocks.starts[s + 1] - blocks.starts[s];
                let height = width + blocks.pattern_starts[s + 1] - blocks.pattern_starts[s];
                (0..width).map(|j| ((height - j) as f64).powi(2)).sum::<f64>()
            })
            .sum()
    }

    /// Numbers that L will hold.
    pub fn size(&self) -> FactorSize {
        FactorSize { values: self.blocks.values() }
    }
}
