//! Stable increments of central differences: bounds of frequencies that are never too low.
//!
//! ```text
//! M (v₊ − v₋) / Δt + C v₋ + K u = 0 is stable where  M ≥ Δt C / 2 + Δt² K / 4
//! K_e ≤ ω_e² M_e  for every part  ⟹  K ≤ diag(Σ_e ω_e² m_ea)
//! ```
//!
//! (`≤` between matrices). So each node `a` may be looked at by itself: `Λ_a = Σ_e ω_e² m_ea / m_a` over its elements, plus the
//! `ω²` of every spring at it, on the masses that its ends move, bounds the frequencies from above, and damping likewise. The `ω_e²` are largest
//! eigenvalues on lumped masses, found by reduction to three diagonals and bisection: the upper end of the last bracket counts.
//! Source: Fried (1972), Bounds on the extremal eigenvalues of the finite element stiffness and mass matrices; for damping taken from
//! the velocity before: Belytschko, Liu, Moran (2000), Nonlinear finite elements, 6.2.

use super::matrix::Stiffness;
use crate::model::ELEMENT_NODES_MAX;

/// Unknowns of the largest element.
const UNKNOWNS: usize = 3 * ELEMENT_NODES_MAX;

/// Bracket at which bisection ends, relative to the eigenvalue; the reduction is accurate to some 1e-14.
const BRACKET_RELATIVE: f64 = 1e-12;

/// Largest `ω²` [1/time²] of an element on lumped masses of its nodes \[mass\]: an upper bound, to twelve digits. Infinite where a node
/// without mass has stiffness.
pub fn frequency_squared(matrix: &Stiffness, masses: &[f64]) -> f64 {
    let n = 3 * masses.len();
    let mut scaled = [0.0; UNKNOWNS * UNKNOWNS];
    for (b, m) in masses.iter().enumerate() {
        for (a, l) in masses[..=b].iter().enumerate() {
            let block = matrix.block(a, b);
            if block.iter().all(|x| *x == 0.0) {
                continue;
            }
            let product = l * m;
            if product <= 0.0 {
                return f64::INFINITY;
            }
            let scale = 1.0 / product.sqrt();
            for i in 0..3 {
                for j in 0..3 {
                    scaled[(3 * b + j) * n + 3 * a + i] = scale * block[3 * i + j];
                }
            }
        }
    }
    largest_eigenvalue(&mut scaled[..n * n], n)
}

/// Largest stable increment \[time\] for `K ≤ ω² M` and `C ≤ rate M`: `2/ω (√(1 + ξ²) − ξ)` with `rate = 2 ξ ω`. Infinite where both
/// are zero.
pub fn increment(frequency_squared: f64, damping_rate: f64) -> f64 {
    let half = 0.5 * damping_rate;
    2.0 / (half + (half * half + frequency_squared).sqrt())
}

/// Upper bound of the largest eigenvalue of a positive semidefinite matrix of order `n`, to twelve digits. Only the lower triangle is
/// used, row by row; it is overwritten.
pub fn largest_eigenvalue(matrix: &mut [f64], n: usize) -> f64 {
    let size = (0..n).flat_map(|i| &matrix[i * n..=i * n + i]).fold(0.0f64, |m, x| m.max(x.abs()));
    if size == 0.0 || !size.is_finite() {
        return size;
    }
    matrix.iter_mut().for_each(|x| *x /= size);
    let (mut diagonal, mut beside) = ([0.0; UNKNOWNS], [0.0; UNKNOWNS]);
    tridiagonal(matrix, n, &mut diagonal, &mut beside);
    let squares = beside.map(|e| e * e);
    // All eigenvalues lie below x where every pivot of T − x I is negative (Sturm).
    let above_all = |x: f64| {
        let mut pivot = 1.0;
        (0..n).all(|i| {
            pivot = diagonal[i] - x - if i > 0 { squares[i] / pivot } else { 0.0 };
            pivot < 0.0
        })
    };
    let beyond = |i: usize| if i + 1 < n { beside[i + 1].abs() } else { 0.0 };
    let row_sum = |i: usize| diagonal[i] + beside[i].abs() + beyond(i);
    let mut low = diagonal[..n].iter().fold(0.0f64, |m, d| m.max(*d));
    let mut high = (0..n).map(row_sum).fold(low, f64::max) * (1.0 + BRACKET_RELATIVE);
    while high - low > BRACKET_RELATIVE * high {
        let middle = 0.5 * (low + high);
        if above_all(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    size * high * (1.0 + BRACKET_RELATIVE)
}

/// Householder reflections from the last row up: diagonal, and the entry left of it in each row.
fn tridiagonal(matrix: &mut [f64], n: usize, diagonal: &mut [f64; UNKNOWNS], beside: &mut [f64; UNKNOWNS]) {
    for i in (0..n).rev() {
        let (above, row) = matrix.split_at_mut(i * n);
        diagonal[i] = row[i];
        if i == 0 {
            break;
        }
        let u = &mut row[..i];
        let last = u[i - 1];
        if u[..i - 1].iter().all(|x| *x == 0.0) {
            beside[i] = last;
            continue;
        }
        let norm = u.iter().map(|x| x * x).sum::<f64>();
        beside[i] = -norm.sqrt().copysign(last);
        // |u|² / 2 of the reflected vector u = row − beside e.
        let half = norm - last * beside[i];
        u[i - 1] = last - beside[i];
        // p = A u / half, then A −= q uᵀ + u qᵀ with q = p − (u·p / (2 half)) u.
        let mut p = [0.0; UNKNOWNS];
        for j in 0..i {
            let a = &above[j * n..=j * n + j];
            let mut sum = a[j] * u[j];
            for ((p, a), u_k) in p[..j].iter_mut().zip(a).zip(&u[..j]) {
                sum += a * u_k;
                *p += a * u[j];
            }
            p[j] += sum;
        }
        let p = &mut p[..i];
        let along = p.iter().zip(&*u).map(|(p, u)| p * u).sum::<f64>() / (2.0 * half * half);
        for (p, u) in p.iter_mut().zip(&*u) {
            *p = *p / half - along * u;
        }
        for j in 0..i {
            for ((a, p_k), u_k) in above[j * n..=j * n + j].iter_mut().zip(&*p).zip(&*u) {
                *a -= p[j] * u_k + u[j] * p_k;
            }
        }
    }
}
