//! Isoparametric elements integrated point by point: C3D4, C3D6, C3D10, C3D15, C3D20, C3D20R.
//!
//! ```text
//! K_ab = ∫ λ ∇N_a ∇N_bᵀ + μ ∇N_b ∇N_aᵀ + μ (∇N_a · ∇N_b) I dV
//! ```

use super::elasticity::Elasticity;
use super::matrix::{Coordinates, Stiffness, block_index};
use super::table::{Sample, Table};
use crate::model::ELEMENT_NODES_MAX;

/// Gradients and volume at an integration point.
struct Point {
    /// ∇N_a [1/length].
    gradient: [[f64; 3]; ELEMENT_NODES_MAX],
    /// det J times the weight [length³].
    volume: f64,
}

/// Rows ∂x/∂ξ_r of the Jacobian.
pub(super) fn jacobian(sample: &Sample, coordinates: &[[f64; 3]]) -> [[f64; 3]; 3] {
    let mut j = [[0.0; 3]; 3];
    for (x, d) in coordinates.iter().zip(&sample.basis.derivative) {
        for r in 0..3 {
            for s in 0..3 {
                j[r][s] += d[r] * x[s];
            }
        }
    }
    j
}

fn cofactor(j: &[[f64; 3]; 3], r: usize, s: usize) -> f64 {
    let (r1, r2, s1, s2) = ((r + 1) % 3, (r + 2) % 3, (s + 1) % 3, (s + 2) % 3);
    j[r1][s1] * j[r2][s2] - j[r1][s2] * j[r2][s1]
}

pub(super) fn determinant(j: &[[f64; 3]; 3]) -> f64 {
    (0..3).map(|s| j[0][s] * cofactor(j, 0, s)).sum()
}

fn point(sample: &Sample, coordinates: &[[f64; 3]]) -> Point {
    let j = jacobian(sample, coordinates);
    let det = determinant(&j);
    // J⁻¹[s][r] = cofactor(r, s) / det J, and ∂N/∂x_s = Σ_r J⁻¹[s][r] ∂N/∂ξ_r.
    let inverse: [[f64; 3]; 3] = std::array::from_fn(|s| std::array::from_fn(|r| cofactor(&j, r, s) / det));
    let mut gradient = [[0.0; 3]; ELEMENT_NODES_MAX];
    for (g, d) in gradient.iter_mut().zip(&sample.basis.derivative).take(coordinates.len()) {
        *g = inverse.map(|row| row[0] * d[0] + row[1] * d[1] + row[2] * d[2]);
    }
    Point { gradient, volume: det * sample.weight }
}

/// Smallest det J over the points of stiffness and further ones, times the volume of the parent's weights [length³].
pub fn jacobian_min(table: &Table, coordinates: &[[f64; 3]]) -> f64 {
    let samples = table.points.iter().chain(&table.further);
    samples.map(|s| determinant(&jacobian(s, coordinates))).fold(f64::INFINITY, f64::min)
}

/// Stiffness of an element.
pub fn stiffness(table: &Table, coordinates: &[[f64; 3]], elasticity: Elasticity, out: &mut Stiffness) {
    let n = table.count;
    let blocks = out.clear(n);
    for sample in &table.points {
        let p = point(sample, coordinates);
        for a in 0..n {
            let ga = p.gradient[a].map(|x| x * p.volume);
            let row = &mut blocks[block_index(n, a, a)..block_index(n, a, n)];
            for (m, gb) in row.iter_mut().zip(&p.gradient[a..n]) {
                for i in 0..3 {
                    for j in 0..3 {
                        m[3 * i + j] += ga[i] * gb[j];
                    }
                }
            }
        }
    }
    for block in blocks {
        *block = elasticity.block(block);
    }
}

/// Stress at the integration points.
pub fn stress(table: &Table, coordinates: &[[f64; 3]], elasticity: Elasticity, u: &[[f64; 3]]) -> Vec<[f64; 6]> {
    let at = |sample: &Sample| {
        let p = point(sample, coordinates);
        let mut h = [[0.0; 3]; 3];
        for (u, g) in u.iter().zip(&p.gradient) {
            for i in 0..3 {
                for j in 0..3 {
                    h[i][j] += u[i] * g[j];
                }
            }
        }
        elasticity.stress(&h)
    };
    table.points.iter().map(at).collect()
}

/// Volume that each node stands for: ∫ N_a dV [length³]. Negative at the corners of quadratic tetrahedra and bricks.
pub fn nodal_volumes(table: &Table, coordinates: &[[f64; 3]]) -> Vec<f64> {
    let mut out = vec![0.0; table.count];
    for sample in &table.products {
        let volume = determinant(&jacobian(sample, coordinates)) * sample.weight;
        for (o, n) in out.iter_mut().zip(sample.basis.value) {
            *o += n * volume;
        }
    }
    out
}

/// Mean of ∇N_a over the points of the stiffness [1/length], and the volume [length³].
pub fn mean_gradient(table: &Table, coordinates: &[[f64; 3]]) -> (Coordinates, f64) {
    let (mut sum, mut volume) = ([[0.0; 3]; ELEMENT_NODES_MAX], 0.0);
    for sample in &table.points {
        let p = point(sample, coordinates);
        volume += p.volume;
        for (s, g) in sum.as_flattened_mut().iter_mut().zip(p.gradient.as_flattened()) {
            *s += p.volume * g;
        }
    }
    (Coordinates::of(sum[..table.count].iter().map(|s| s.map(|x| x / volume))), volume)
}
