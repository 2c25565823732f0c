//! Dense matrices: products, triangular solves, Cholesky factors, eigenvalues.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::triangular_solve;
use faer::reborrow::ReborrowMut;
use faer::{Accum, MatMut, MatRef, Par};

use serde::{Deserialize, Serialize};

use super::PIVOT_RELATIVE_MIN;
use super::product::{clear_registers, multiply};

/// Dense column-major matrix.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
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

    /// Whether it has as many rows and columns, and the numbers for them.
    pub fn has_shape(&self, rows: Option<usize>, columns: usize) -> bool {
        Some(self.rows) == rows && self.columns == columns && self.values.len() == self.rows * columns
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

    pub(super) fn view_mut(&mut self) -> MatMut<'_, f64> {
        MatMut::from_column_major_slice_mut(&mut self.values, self.rows, self.columns)
    }

    /// `selfᵀ self`, exactly symmetric.
    pub fn gram(&self) -> Dense {
        let mut out = Dense::zeros(self.columns, self.columns);
        multiply(out.view_mut(), Accum::Replace, self.view().transpose(), self.view(), 1.0);
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
        clear_registers();
    }

    /// `self <- lower⁻ᵀ self`.
    pub fn solve_lower_transposed(&mut self, lower: &Dense) {
        triangular_solve::solve_upper_triangular_in_place(lower.view().transpose(), self.view_mut(), Par::Seq);
        clear_registers();
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
    let done = factor::cholesky_in_place(view, Default::default(), Par::Seq, MemStack::new(memory), Default::default());
    clear_registers();
    if done.is_err() {
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
    clear_registers();
}

/// Work space of the dense factorisation, kept between increments.
#[derive(Default)]
pub struct DenseScratch {
    diagonal: Vec<f64>,
    memory: Option<MemBuffer>,
    memory_for: usize,
}

/// Singular values (descending) and right singular vectors (columns) of a matrix; as many as it has columns.
pub fn singular(matrix: &Dense) -> (Vec<f64>, Dense) {
    let k = matrix.columns;
    if k == 0 {
        return (Vec::new(), Dense::default());
    }
    // Rows of zeros change nothing and give every column its vector.
    let rows = matrix.rows.max(k);
    let padded = faer::Mat::from_fn(rows, k, |i, j| if i < matrix.rows { matrix.column(j)[i] } else { 0.0 });
    let decomposition = padded.thin_svd().expect("a finite matrix has singular values");
    clear_registers();
    let mut vectors = Dense::zeros(k, k);
    for j in 0..k {
        for (i, x) in vectors.column_mut(j).iter_mut().enumerate() {
            *x = decomposition.V()[(i, j)];
        }
    }
    ((0..k).map(|i| decomposition.S()[i]).collect(), vectors)
}

/// Eigenvalues (ascending) and eigenvectors (columns) of a symmetric matrix.
pub fn eigen(matrix: &Dense) -> (Vec<f64>, Dense) {
    let n = matrix.rows;
    if n == 0 {
        return (Vec::new(), Dense::default());
    }
    let decomposition =
        matrix.view().self_adjoint_eigen(faer::Side::Lower).expect("a finite symmetric matrix has eigenvectors");
    clear_registers();
    let mut vectors = Dense::zeros(n, n);
    for j in 0..n {
        for (i, x) in vectors.column_mut(j).iter_mut().enumerate() {
            *x = decomposition.U()[(i, j)];
        }
    }
    ((0..n).map(|i| decomposition.S()[i]).collect(), vectors)
}
