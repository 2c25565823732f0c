//! Products of dense matrices, and what they leave behind.

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, MatMut, MatRef, Par};

/// `into <- factor left right`, or adds it.
pub fn multiply(into: MatMut<'_, f64>, accum: Accum, left: MatRef<'_, f64>, right: MatRef<'_, f64>, factor: f64) {
    matmul(into, accum, left, right, factor, Par::Seq);
    clear_registers();
}

/// Has the processor forget the upper halves of its vector registers.
///
/// The kernels of faer's products return with them in use. Everything that follows and uses the lower halves only, which is all code
/// compiled for any x86-64, then has to keep them, and takes up to three times as long (a product with 2200 x 14 blocks in cache on
/// an AMD EPYC of 2024: 180 instead of 60 µs), until an instruction clears them. A solve with one unknown ends with it: 13 ns.
pub fn clear_registers() {
    let mut one = [1.0];
    let lower = MatRef::from_column_major_slice(&[1.0], 1, 1);
    solve_lower_triangular_in_place(lower, MatMut::from_column_major_slice_mut(&mut one, 1, 1), Par::Seq);
    std::hint::black_box(one);
}
