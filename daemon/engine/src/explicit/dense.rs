//! Small dense systems whose matrix may be singular: directions without inertia are held.

/// A pivot below this part of its diagonal entry is rounding: the direction has no inertia of its own.
const PIVOT_RELATIVE_MIN: f64 = 1e-12;

/// `L Lᵀ` of a symmetric positive semidefinite matrix, row by row in place; a direction whose pivot is rounding is held: its pivot
/// becomes infinite, so that solutions are zero in it.
pub fn cholesky_or_held(matrix: &mut [f64], n: usize) {
    for j in 0..n {
        let diagonal = matrix[j * n + j];
        let mut pivot = diagonal;
        for k in 0..j {
            pivot -= matrix[j * n + k] * matrix[j * n + k];
        }
        let held = pivot.is_nan() || pivot <= PIVOT_RELATIVE_MIN * diagonal;
        let root = if held { f64::INFINITY } else { pivot.sqrt() };
        matrix[j * n + j] = root;
        for i in j + 1..n {
            let mut sum = matrix[i * n + j];
            for k in 0..j {
                sum -= matrix[i * n + k] * matrix[j * n + k];
            }
            matrix[i * n + j] = if held { 0.0 } else { sum / root };
        }
    }
}

/// `x <- (L Lᵀ)⁻¹ x`, zero in held directions.
pub fn solve_held(factor: &[f64], n: usize, x: &mut [f64]) {
    for i in 0..n {
        let mut sum = x[i];
        for k in 0..i {
            sum -= factor[i * n + k] * x[k];
        }
        x[i] = sum / factor[i * n + i];
    }
    for i in (0..n).rev() {
        let mut sum = x[i];
        for k in i + 1..n {
            sum -= factor[k * n + i] * x[k];
        }
        x[i] = sum / factor[i * n + i];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_regular_matrix_is_solved_and_a_direction_without_inertia_is_held() {
        let matrix = [4.0, 2.0, 0.0, 2.0, 3.0, 0.0, 0.0, 0.0, 0.0];
        let mut factor = matrix;
        cholesky_or_held(&mut factor, 3);
        let mut x = [10.0, 9.0, 7.0];
        solve_held(&factor, 3, &mut x);
        assert!((x[0] - 1.5).abs() < 1e-14 && (x[1] - 2.0).abs() < 1e-14 && x[2] == 0.0, "{x:?}");
    }
}
