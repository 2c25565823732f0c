//! C3D8I: eight-node brick with incompatible modes.
//!
//! Three functions `1 − ξ²`, `1 − η²`, `1 − ζ²` times a vector each are added to the displacements of the fully integrated
//! brick and condensed out: nine modes, which take bending without shear. Their gradients are taken with the Jacobian of
//! the element's centre, `∇P_k = (j₀/j) J₀⁻¹ ∂P_k/∂ξ`, so that a uniform stress does no work on them and the patch test is
//! passed on any mesh. Source: Taylor, Beresford, Wilson (1976), A non-conforming element for stress analysis.

use super::brick::{CORNER, Corners, Point, gauss_point, point};
use super::elasticity::Elasticity;
use super::matrix::{Stiffness, block_index};

/// Nodes and incompatible functions.
const FUNCTIONS: usize = 11;

/// Incompatible unknowns.
const MODES: usize = 9;

/// Gradients of the eight shape functions and the three incompatible functions, and the volume, at the eight points.
fn points(corners: &Corners) -> [([[f64; 3]; FUNCTIONS], f64); 8] {
    // J₀⁻¹ from the gradients at the centre: ∂ξ_r/∂x = Σ_a ξ_r(a) ∇N_a, because Σ_a ξ_r(a) N_a = ξ_r.
    let centre = point(corners, [0.0; 3]);
    let mut inverse = [[0.0; 3]; 3];
    for (c, g) in CORNER.iter().zip(&centre.gradient) {
        for r in 0..3 {
            for s in 0..3 {
                inverse[r][s] += c[r] * g[s];
            }
        }
    }
    std::array::from_fn(|g| {
        let natural = gauss_point(g);
        let Point { gradient, volume } = point(corners, natural);
        let mut all = [[0.0; 3]; FUNCTIONS];
        all[..8].copy_from_slice(&gradient);
        let ratio = centre.volume / volume;
        for k in 0..3 {
            all[8 + k] = inverse[k].map(|x| -2.0 * natural[k] * ratio * x);
        }
        (all, volume)
    })
}

/// Stiffness before condensation: upper blocks of the eleven functions.
fn extended(corners: &Corners, elasticity: Elasticity) -> [[f64; 9]; FUNCTIONS * (FUNCTIONS + 1) / 2] {
    let mut blocks = [[0.0; 9]; FUNCTIONS * (FUNCTIONS + 1) / 2];
    for (gradient, volume) in points(corners) {
        for a in 0..FUNCTIONS {
            let ga = gradient[a].map(|x| x * volume);
            for b in a..FUNCTIONS {
                let m = &mut blocks[block_index(FUNCTIONS, a, b)];
                for i in 0..3 {
                    for j in 0..3 {
                        m[3 * i + j] += ga[i] * gradient[b][j];
                    }
                }
            }
        }
    }
    blocks.map(|m| elasticity.block(&m))
}

/// `−K_αα⁻¹ K_αu`: the modes that unit displacements of the nodes cause, row by row.
fn modes(blocks: &[[f64; 9]]) -> [[f64; 24]; MODES] {
    let mut k = [[0.0; MODES]; MODES];
    let mut x = [[0.0; 24]; MODES];
    for p in 0..3 {
        for q in p..3 {
            let m = &blocks[block_index(FUNCTIONS, 8 + p, 8 + q)];
            for i in 0..3 {
                for j in 0..3 {
                    k[3 * p + i][3 * q + j] = m[3 * i + j];
                    k[3 * q + j][3 * p + i] = m[3 * i + j];
                }
            }
        }
        for a in 0..8 {
            let m = &blocks[block_index(FUNCTIONS, a, 8 + p)];
            for i in 0..3 {
                for j in 0..3 {
                    x[3 * p + j][3 * a + i] = -m[3 * i + j];
                }
            }
        }
    }
    // Elimination without pivoting: the block is positive definite.
    for r in 0..MODES {
        for s in r + 1..MODES {
            let factor = k[s][r] / k[r][r];
            for c in r..MODES {
                k[s][c] -= factor * k[r][c];
            }
            for c in 0..24 {
                x[s][c] -= factor * x[r][c];
            }
        }
    }
    for r in (0..MODES).rev() {
        for c in 0..24 {
            let known: f64 = (r + 1..MODES).map(|s| k[r][s] * x[s][c]).sum();
            x[r][c] = (x[r][c] - known) / k[r][r];
        }
    }
    x
}

/// Condensed stiffness: `K_uu − K_uα K_αα⁻¹ K_αu`.
pub fn stiffness(corners: &Corners, elasticity: Elasticity, out: &mut Stiffness) {
    let extended = extended(corners, elasticity);
    let modes = modes(&extended);
    let blocks = out.clear(8);
    for a in 0..8 {
        for b in a..8 {
            let block = &mut blocks[block_index(8, a, b)];
            *block = extended[block_index(FUNCTIONS, a, b)];
            for p in 0..3 {
                let m = &extended[block_index(FUNCTIONS, a, 8 + p)];
                for i in 0..3 {
                    for j in 0..3 {
                        for c in 0..3 {
                            block[3 * i + j] += m[3 * i + c] * modes[3 * p + c][3 * b + j];
                        }
                    }
                }
            }
        }
    }
}

/// Stress at the eight integration points, with the modes that the displacements cause.
pub fn stress(corners: &Corners, elasticity: Elasticity, u: &[[f64; 3]]) -> [[f64; 6]; 8] {
    let modes = modes(&extended(corners, elasticity));
    let mut all = [[0.0; 3]; FUNCTIONS];
    all[..8].copy_from_slice(&u[..8]);
    for p in 0..3 {
        for i in 0..3 {
            all[8 + p][i] = modes[3 * p + i].iter().zip(u.as_flattened()).map(|(x, u)| x * u).sum();
        }
    }
    points(corners).map(|(gradient, _)| {
        let mut h = [[0.0; 3]; 3];
        for (u, g) in all.iter().zip(&gradient) {
            for i in 0..3 {
                for j in 0..3 {
                    h[i][j] += u[i] * g[j];
                }
            }
        }
        elasticity.stress(&h)
    })
}
