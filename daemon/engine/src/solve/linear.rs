//! Sparse and dense factorisations. The only file that names faer; everything runs sequentially, so that the bits of
//! a result do not depend on the machine's load.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve;
use faer::sparse::linalg::SymbolicSupernodalParams;
use faer::sparse::linalg::cholesky::{simplicial, supernodal};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Accum, Conj, MatMut, MatRef, Par};

use super::assembly::LowerMatrix;

/// A pivot smaller than this part of its diagonal entry is rounding: the direction has no stiffness of its own.
/// Cholesky loses about `n` units of rounding; a body held by a real support keeps pivots above 1e-10 of the diagonal.
const PIVOT_RELATIVE_MIN: f64 = 1e-12;

/// The matrix has no usable pivot in this unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SingularPivot {
    /// Position of the unknown in elimination order.
    pub unknown: usize,
}

/// Dense column-major matrix.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Dense {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Entries, column by column.
    pub values: Vec<f64>,
}

impl Dense {
    /// A matrix of zeros.
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Self { rows, columns, values: vec![0.0; rows * columns] }
    }

    /// One column.
    pub fn column(&self, j: usize) -> &[f64] {
        &self.values[j * self.rows..(j + 1) * self.rows]
    }

    /// One column, writable.
    pub fn column_mut(&mut self, j: usize) -> &mut [f64] {
        &mut self.values[j * self.rows..(j + 1) * self.rows]
    }

    /// `out += self * x`, columns in order.
    pub fn multiply_add(&self, x: &[f64], out: &mut [f64]) {
        for (j, &factor) in x.iter().enumerate() {
            if factor != 0.0 {
                for (o, v) in out.iter_mut().zip(self.column(j)) {
                    *o += factor * v;
                }
            }
        }
    }

    fn view(&self) -> MatRef<'_, f64> {
        MatRef::from_column_major_slice(&self.values, self.rows, self.columns)
    }

    fn view_mut(&mut self) -> MatMut<'_, f64> {
        MatMut::from_column_major_slice_mut(&mut self.values, self.rows, self.columns)
    }

    /// `selfᵀ self`, exactly symmetric.
    pub fn gram(&self) -> Dense {
        let mut out = Dense::zeros(self.columns, self.columns);
        matmul(out.view_mut(), Accum::Replace, self.view().transpose(), self.view(), 1.0, Par::Seq);
        for j in 0..self.columns {
            for i in 0..j {
                out.values[j * self.columns + i] = out.values[i * self.columns + j];
            }
        }
        out
    }

    /// `self <- lower⁻¹ self`.
    pub fn solve_lower(&mut self, lower: &Dense) {
        triangular_solve::solve_lower_triangular_in_place(lower.view(), self.view_mut(), Par::Seq);
    }

    /// `self <- lower⁻ᵀ self`.
    pub fn solve_lower_transposed(&mut self, lower: &Dense) {
        triangular_solve::solve_upper_triangular_in_place(lower.view().transpose(), self.view_mut(), Par::Seq);
    }
}

/// Sizes of a factorisation before it is done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FactorSize {
    /// Numbers stored in L.
    pub values: usize,
}

/// Structure of L.
pub struct Symbolic {
    inner: supernodal::SymbolicSupernodalCholesky<usize>,
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
            SymbolicSupernodalParams::default(),
        )
        .expect("the index type is as wide as memory");
        Self { inner }
    }

    /// Numbers that L will hold.
    pub fn size(&self) -> FactorSize {
        FactorSize { values: self.inner.len_val() }
    }
}

/// `L Lᵀ` of a positive definite sparse matrix.
pub struct Factor {
    symbolic: Symbolic,
    values: Vec<f64>,
}

impl Factor {
    /// Factors a matrix; refuses one that is singular to rounding.
    pub fn new(matrix: &LowerMatrix, symbolic: Symbolic) -> Result<Self, SingularPivot> {
        let n = matrix.len();
        let mut values = vec![0.0; symbolic.inner.len_val()];
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &matrix.starts, None, &matrix.rows);
        let view = SparseColMatRef::new(pattern, &matrix.values);
        let params = Default::default();
        let mut memory = MemBuffer::new(supernodal::factorize_supernodal_numeric_llt_scratch::<usize, f64>(
            &symbolic.inner,
            Par::Seq,
            params,
        ));
        supernodal::factorize_supernodal_numeric_llt(
            &mut values,
            view,
            Default::default(),
            &symbolic.inner,
            Par::Seq,
            MemStack::new(&mut memory),
            params,
        )
        .map_err(|e| match e {
            faer::linalg::cholesky::llt::factor::LltError::NonPositivePivot { index } => {
                SingularPivot { unknown: index }
            }
        })?;
        let factor = Self { symbolic, values };
        let mut diagonal = matrix.diagonal();
        for s in 0..factor.symbolic.inner.n_supernodes() {
            let node = factor.view().supernode(s);
            for i in 0..node.val().ncols() {
                let (pivot, original) = (node.val()[(i, i)], diagonal.next().unwrap_or(0.0));
                // False for a NaN pivot too.
                let usable = pivot * pivot > PIVOT_RELATIVE_MIN * original;
                if !usable {
                    return Err(SingularPivot { unknown: node.start() + i });
                }
            }
        }
        Ok(factor)
    }

    fn view(&self) -> supernodal::SupernodalLltRef<'_, usize, f64> {
        supernodal::SupernodalLltRef::new(&self.symbolic.inner, &self.values)
    }

    /// Numbers held.
    pub fn size(&self) -> FactorSize {
        self.symbolic.size()
    }

    /// `rhs <- (L Lᵀ)⁻¹ rhs`, all columns at once.
    pub fn solve(&self, rhs: &mut Dense) {
        let mut memory = MemBuffer::new(self.symbolic.inner.solve_in_place_scratch::<f64>(rhs.columns, Par::Seq));
        self.view().solve_in_place_with_conj(Conj::No, rhs.view_mut(), Par::Seq, MemStack::new(&mut memory));
    }

    /// `rhs <- L⁻ᵀ rhs`.
    pub fn solve_transposed(&self, rhs: &mut Dense) {
        let mut memory = MemBuffer::new(self.symbolic.inner.solve_in_place_scratch::<f64>(rhs.columns, Par::Seq));
        self.view().l_transpose_solve_with_conj(Conj::No, rhs.view_mut(), Par::Seq, MemStack::new(&mut memory));
    }

    /// Trailing block of L from unknown `begin` on, gathered from all supernodes that reach into it:
    /// `L_cc L_ccᵀ` is the Schur complement onto those unknowns.
    pub fn trailing(&self, begin: usize) -> Dense {
        let n = self.symbolic.inner.nrows();
        let mut out = Dense::zeros(n - begin, n - begin);
        for s in 0..self.symbolic.inner.n_supernodes() {
            let node = self.view().supernode(s);
            let (start, width) = (node.start(), node.val().ncols());
            for j in begin.max(start)..start + width {
                let column = out.column_mut(j - begin);
                for i in j..start + width {
                    column[i - begin] = node.val()[(i - start, j - start)];
                }
                for (k, &row) in node.pattern().iter().enumerate() {
                    column[row - begin] = node.val()[(width + k, j - start)];
                }
            }
        }
        out
    }
}

/// Dense `L Lᵀ` of the leading `n x n` block of a buffer with leading dimension `n`, in place; false when a pivot is
/// not positive or is rounding against its diagonal entry. The strict upper triangle is not used.
pub fn cholesky_in_place(matrix: &mut [f64], n: usize, scratch: &mut DenseScratch) -> bool {
    use faer::linalg::cholesky::llt::factor;
    scratch.diagonal.clear();
    scratch.diagonal.extend((0..n).map(|i| matrix[i * n + i]));
    let request = factor::cholesky_in_place_scratch::<f64>(n, Par::Seq, Default::default());
    if scratch.memory_for < n {
        scratch.memory = Some(MemBuffer::new(request));
        scratch.memory_for = n;
    }
    let memory = scratch.memory.get_or_insert_with(|| MemBuffer::new(request));
    let view = MatMut::from_column_major_slice_mut(matrix, n, n);
    if factor::cholesky_in_place(view, Default::default(), Par::Seq, MemStack::new(memory), Default::default()).is_err()
    {
        return false;
    }
    (0..n).all(|i| matrix[i * n + i] * matrix[i * n + i] > PIVOT_RELATIVE_MIN * scratch.diagonal[i])
}

/// `x <- (L Lᵀ)⁻¹ x` with the factor of [`cholesky_in_place`].
pub fn cholesky_solve(factor: &[f64], n: usize, x: &mut [f64]) {
    let lower = MatRef::from_column_major_slice(factor, n, n);
    let mut rhs = MatMut::from_column_major_slice_mut(x, n, 1);
    triangular_solve::solve_lower_triangular_in_place(lower, rhs.rb_mut(), Par::Seq);
    triangular_solve::solve_upper_triangular_in_place(lower.transpose(), rhs, Par::Seq);
}

/// Work space of the dense factorisation, kept between increments.
#[derive(Default)]
pub struct DenseScratch {
    diagonal: Vec<f64>,
    memory: Option<MemBuffer>,
    memory_for: usize,
}

/// Eigenvalues (ascending) and eigenvectors (columns) of a small symmetric matrix.
pub fn eigen(matrix: &[[f64; 6]; 6]) -> ([f64; 6], [[f64; 6]; 6]) {
    let view = faer::Mat::from_fn(6, 6, |i, j| matrix[i][j]);
    let decomposition = view.self_adjoint_eigen(faer::Side::Lower).expect("a finite symmetric matrix has eigenvectors");
    let values = std::array::from_fn(|i| decomposition.S()[i]);
    let vectors = std::array::from_fn(|j| std::array::from_fn(|i| decomposition.U()[(i, j)]));
    (values, vectors)
}

use faer::reborrow::ReborrowMut;

#[cfg(test)]
mod tests {
    use super::*;

    /// Tridiagonal (-1, 2.5, -1) with a dense last row.
    fn sample(n: usize) -> (LowerMatrix, Vec<Vec<f64>>) {
        let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        let mut full = vec![vec![0.0; n]; n];
        for j in 0..n {
            for i in j..n {
                let v = if i == j {
                    4.5
                } else if i == j + 1 {
                    -1.0
                } else if i == n - 1 {
                    0.01
                } else {
                    continue;
                };
                rows.push(i);
                values.push(v);
                full[i][j] = v;
                full[j][i] = v;
            }
            starts.push(rows.len());
        }
        (LowerMatrix { starts, rows, values }, full)
    }

    #[test]
    fn solve_inverts_the_matrix() {
        let (matrix, full) = sample(30);
        let factor = Factor::new(&matrix, Symbolic::analyse(&matrix)).expect("positive definite");
        let mut x = Dense::zeros(30, 2);
        for (i, v) in x.values.iter_mut().enumerate() {
            *v = (i as f64).sin();
        }
        let rhs = x.clone();
        factor.solve(&mut x);
        for c in 0..2 {
            for i in 0..30 {
                let ax: f64 = (0..30).map(|j| full[i][j] * x.column(c)[j]).sum();
                assert!((ax - rhs.column(c)[i]).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn the_trailing_block_is_the_factor_of_the_schur_complement() {
        let (matrix, full) = sample(30);
        let factor = Factor::new(&matrix, Symbolic::analyse(&matrix)).expect("positive definite");
        for begin in [0, 7, 25, 29] {
            let l = factor.trailing(begin);
            // Schur complement by plain elimination.
            let mut s = full.clone();
            for k in 0..begin {
                let pivot = s[k].clone();
                for row in s.iter_mut().skip(k + 1) {
                    let f = row[k] / pivot[k];
                    for (entry, p) in row.iter_mut().zip(&pivot) {
                        *entry -= f * p;
                    }
                }
            }
            for i in begin..30 {
                for j in begin..30 {
                    let llt: f64 = (0..30 - begin).map(|k| l.column(k)[i - begin] * l.column(k)[j - begin]).sum();
                    assert!((llt - s[i][j]).abs() < 1e-12, "begin {begin}");
                }
            }
        }
    }

    #[test]
    fn a_singular_matrix_is_refused_with_its_unknown() {
        // Free-free chain: stiffness without support.
        let matrix = LowerMatrix {
            starts: vec![0, 2, 4, 5],
            rows: vec![0, 1, 1, 2, 2],
            values: vec![1.0, -1.0, 2.0, -1.0, 1.0],
        };
        let refused = Factor::new(&matrix, Symbolic::analyse(&matrix)).err();
        assert_eq!(refused, Some(SingularPivot { unknown: 2 }));
    }
}
