//! C3D8R: eight-node brick of uniform strain with hourglass stiffness.
//!
//! The strain is its mean over the element, `B_a = (1/V) ∫ ∇N_a dV`, which passes the patch test on any mesh. Twelve
//! motions have no mean strain; they get the stiffness of Flanagan and Belytschko:
//!
//! ```text
//! γ_αa = Γ_αa − Σ_i (Σ_b Γ_αb x_bi) B_ai        orthogonal to every linear field
//! K_ab += k Σ_α γ_αa γ_αb I,   k = r V Σ_a B_a · B_a
//! ```
//!
//! with r = HOURGLASS μ, or HOURGLASS_CALCULIX E as CalculiX has it. Source: Flanagan, Belytschko (1981), A uniform strain hexahedron and quadrilateral with orthogonal hourglass control.

use super::brick::{CORNER, Corners, gauss_point, point};
use super::elasticity::Elasticity;
use super::matrix::{Stiffness, block_index};

/// Part of the shear modulus that resists hourglass motions: the default of the stiffness method of Abaqus.
pub const HOURGLASS: f64 = 0.005;

/// Part of Young's modulus that resists hourglass motions in CalculiX.
pub const HOURGLASS_CALCULIX: f64 = 0.0005;

/// Mean gradients [1/length] and volume [length³].
fn mean(corners: &Corners) -> ([[f64; 3]; 8], f64) {
    let mut gradient = [[0.0; 3]; 8];
    let mut volume = 0.0;
    for g in 0..8 {
        let p = point(corners, gauss_point(g));
        volume += p.volume;
        for (sum, x) in gradient.as_flattened_mut().iter_mut().zip(p.gradient.as_flattened()) {
            *sum += x * p.volume;
        }
    }
    (gradient.map(|b| b.map(|x| x / volume)), volume)
}

/// Hourglass vectors γ_α by node.
fn hourglass(corners: &Corners, gradient: &[[f64; 3]; 8]) -> [[f64; 8]; 4] {
    let pattern = |c: &[f64; 3]| [c[1] * c[2], c[2] * c[0], c[0] * c[1], c[0] * c[1] * c[2]];
    std::array::from_fn(|alpha| {
        let base: [f64; 8] = std::array::from_fn(|a| pattern(&CORNER[a])[alpha]);
        let linear: [f64; 3] = std::array::from_fn(|i| base.iter().zip(corners).map(|(g, x)| g * x[i]).sum());
        std::array::from_fn(|a| {
            let along: f64 = linear.iter().zip(&gradient[a]).map(|(l, b)| l * b).sum();
            base[a] - along
        })
    })
}

/// Stiffness with hourglass control of resistance r [pressure].
pub fn stiffness(corners: &Corners, elasticity: Elasticity, resistance: f64, out: &mut Stiffness) {
    let (gradient, volume) = mean(corners);
    let gamma = hourglass(corners, &gradient);
    let size: f64 = gradient.as_flattened().iter().map(|b| b * b).sum();
    let stiff = resistance * volume * size;
    let blocks = out.clear(8);
    for a in 0..8 {
        for b in a..8 {
            let mut moment = [0.0; 9];
            for i in 0..3 {
                for j in 0..3 {
                    moment[3 * i + j] = volume * gradient[a][i] * gradient[b][j];
                }
            }
            let mut block = elasticity.block(&moment);
            let resist = stiff * gamma.iter().map(|g| g[a] * g[b]).sum::<f64>();
            for i in 0..3 {
                block[4 * i] += resist;
            }
            blocks[block_index(8, a, b)] = block;
        }
    }
}

/// Stress of the mean strain.
pub fn stress(corners: &Corners, elasticity: Elasticity, u: &[[f64; 3]]) -> [f64; 6] {
    let (gradient, _) = mean(corners);
    let mut h = [[0.0; 3]; 3];
    for (u, g) in u.iter().zip(&gradient) {
        for i in 0..3 {
            for j in 0..3 {
                h[i][j] += u[i] * g[j];
            }
        }
    }
    elasticity.stress(&h)
}
