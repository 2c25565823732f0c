//! Eight-node brick: C3D8 with the volumetric part selectively reduced, and fully integrated.
//!
//! ```text
//! K_ab = ∫ λ ∇N_a ∇N_bᵀ + μ ∇N_b ∇N_aᵀ + μ (∇N_a · ∇N_b) I dV                        (full)
//! K_ab = κ V ḡ_a ḡ_bᵀ + ∫ μ ∇N_b ∇N_aᵀ + μ (∇N_a · ∇N_b) I − ⅔ μ ∇N_a ∇N_bᵀ dV   (C3D8)
//! ḡ_a = (1/V) ∫ ∇N_a dV:  the volumetric strain is its mean over the element
//! ```
//!
//! Both follow from the moments `M_ab = ∫ ∇N_a ∇N_bᵀ dV`, which are all that is integrated (2 x 2 x 2 Gauss).
//! Source of the selective reduction: Abaqus Theory manual 3.2.4 (fully integrated first-order solids use the
//! mean volume change); Hughes (1980), B-bar.

use super::Elasticity;

/// How the volumetric part is integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Volumetric {
    /// Its mean over the element: C3D8 of Abaqus.
    Mean,
    /// Point by point: C3D8 of CalculiX.
    Local,
}

/// Coordinates of the corner nodes, in the order of the manual [length].
pub type Corners = [[f64; 3]; 8];

/// Signs of the natural coordinates of the corners.
pub const CORNER: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// 1/√3: natural coordinate of the Gauss points.
const GAUSS: f64 = 0.577_350_269_189_625_8;

/// Gradients of the shape functions and the volume at one integration point.
pub(super) struct Point {
    /// ∇N_a [1/length].
    pub gradient: [[f64; 3]; 8],
    /// det J times the weight (1) [length³].
    pub volume: f64,
}

fn shape(natural: [f64; 3]) -> [f64; 8] {
    CORNER.map(|c| 0.125 * (1.0 + c[0] * natural[0]) * (1.0 + c[1] * natural[1]) * (1.0 + c[2] * natural[2]))
}

/// Natural coordinates of integration point `g`; points are numbered like the corners they are nearest to.
pub(super) fn gauss_point(g: usize) -> [f64; 3] {
    CORNER[g].map(|c| c * GAUSS)
}

pub(super) fn point(corners: &Corners, natural: [f64; 3]) -> Point {
    let mut dn = [[0.0; 3]; 8];
    let mut j = [[0.0; 3]; 3];
    for a in 0..8 {
        let c = &CORNER[a];
        let f = [1.0 + c[0] * natural[0], 1.0 + c[1] * natural[1], 1.0 + c[2] * natural[2]];
        dn[a] = [0.125 * c[0] * f[1] * f[2], 0.125 * c[1] * f[0] * f[2], 0.125 * c[2] * f[0] * f[1]];
        for r in 0..3 {
            for s in 0..3 {
                j[r][s] += dn[a][r] * corners[a][s];
            }
        }
    }
    let cofactor = |r: usize, s: usize| {
        let (r1, r2, s1, s2) = ((r + 1) % 3, (r + 2) % 3, (s + 1) % 3, (s + 2) % 3);
        j[r1][s1] * j[r2][s2] - j[r1][s2] * j[r2][s1]
    };
    let volume = j[0][0] * cofactor(0, 0) + j[0][1] * cofactor(0, 1) + j[0][2] * cofactor(0, 2);
    // J⁻¹[s][r] = cofactor(r, s) / det J, and ∂N/∂x_s = Σ_r J⁻¹[s][r] ∂N/∂ξ_r.
    let mut inverse = [[0.0; 3]; 3];
    for (s, row) in inverse.iter_mut().enumerate() {
        for (r, entry) in row.iter_mut().enumerate() {
            *entry = cofactor(r, s) / volume;
        }
    }
    let gradient = dn.map(|d| inverse.map(|row| row[0] * d[0] + row[1] * d[1] + row[2] * d[2]));
    Point { gradient, volume }
}

/// Smallest det J over the integration points and the volume [length³]. Positive for a usable element.
pub fn jacobian_min(corners: &Corners) -> f64 {
    (0..8).map(|g| point(corners, gauss_point(g)).volume).fold(f64::INFINITY, f64::min)
}

/// Position of block (a, b), a ≤ b, in [`Stiffness`].
const fn block_index(a: usize, b: usize) -> usize {
    a * 8 - a * (a + 1) / 2 + b
}

/// Upper blocks of a symmetric 24 x 24 stiffness matrix [force/length]: block (a, b), a ≤ b, row-major 3 x 3.
pub type Stiffness = [[f64; 9]; 36];

/// Stiffness of a brick.
pub fn stiffness(volumetric: Volumetric, corners: &Corners, elasticity: Elasticity) -> Stiffness {
    let mut moments = [[0.0; 9]; 36];
    let mut mean = [[0.0; 3]; 8];
    let mut volume = 0.0;
    for g in 0..8 {
        let p = point(corners, gauss_point(g));
        volume += p.volume;
        for a in 0..8 {
            let ga = p.gradient[a].map(|x| x * p.volume);
            for i in 0..3 {
                mean[a][i] += ga[i];
            }
            for b in a..8 {
                let gb = &p.gradient[b];
                let m = &mut moments[block_index(a, b)];
                for i in 0..3 {
                    for j in 0..3 {
                        m[3 * i + j] += ga[i] * gb[j];
                    }
                }
            }
        }
    }
    let (mu, kappa) = (elasticity.mu, elasticity.kappa());
    let outer = match volumetric {
        Volumetric::Mean => -2.0 / 3.0 * mu,
        Volumetric::Local => elasticity.lambda,
    };
    let mut k = [[0.0; 9]; 36];
    for a in 0..8 {
        for b in a..8 {
            let (m, out) = (&moments[block_index(a, b)], &mut k[block_index(a, b)]);
            let trace = mu * (m[0] + m[4] + m[8]);
            for i in 0..3 {
                for j in 0..3 {
                    out[3 * i + j] = outer * m[3 * i + j] + mu * m[3 * j + i];
                }
                out[4 * i] += trace;
            }
            if volumetric == Volumetric::Mean {
                for i in 0..3 {
                    for j in 0..3 {
                        out[3 * i + j] += kappa * mean[a][i] * mean[b][j] / volume;
                    }
                }
            }
        }
    }
    k
}

/// Stress (11, 22, 33, 12, 13, 23) at the eight integration points [pressure].
pub fn stress(volumetric: Volumetric, corners: &Corners, elasticity: Elasticity, u: &[[f64; 3]; 8]) -> [[f64; 6]; 8] {
    let points: [Point; 8] = std::array::from_fn(|g| point(corners, gauss_point(g)));
    let volume: f64 = points.iter().map(|p| p.volume).sum();
    let divergence = |p: &Point| (0..8).map(|a| (0..3).map(|i| p.gradient[a][i] * u[a][i]).sum::<f64>()).sum::<f64>();
    let mean = points.iter().map(|p| divergence(p) * p.volume).sum::<f64>() / volume;
    std::array::from_fn(|g| {
        let p = &points[g];
        let mut h = [[0.0; 3]; 3];
        for a in 0..8 {
            for i in 0..3 {
                for j in 0..3 {
                    h[i][j] += u[a][i] * p.gradient[a][j];
                }
            }
        }
        let local = h[0][0] + h[1][1] + h[2][2];
        let dilatation = match volumetric {
            Volumetric::Mean => mean,
            Volumetric::Local => local,
        };
        let pressure_part = elasticity.kappa() * dilatation - 2.0 / 3.0 * elasticity.mu * local;
        let mu = elasticity.mu;
        [
            pressure_part + 2.0 * mu * h[0][0],
            pressure_part + 2.0 * mu * h[1][1],
            pressure_part + 2.0 * mu * h[2][2],
            mu * (h[0][1] + h[1][0]),
            mu * (h[0][2] + h[2][0]),
            mu * (h[1][2] + h[2][1]),
        ]
    })
}

/// Values at the integration points carried out to the corners by the trilinear field through them.
pub fn extrapolate(values: &[[f64; 6]; 8]) -> [[f64; 6]; 8] {
    // Corner at natural ±1 is ±√3 in the coordinates in which the Gauss points are the corners.
    std::array::from_fn(|a| {
        let n = shape(CORNER[a].map(|c| c / GAUSS));
        std::array::from_fn(|c| (0..8).map(|g| n[g] * values[g][c]).sum())
    })
}

/// Volume that each corner stands for: ∫ N_a dV [length³].
pub fn nodal_volumes(corners: &Corners) -> [f64; 8] {
    let mut out = [0.0; 8];
    for g in 0..8 {
        let natural = gauss_point(g);
        let volume = point(corners, natural).volume;
        for (o, n) in out.iter_mut().zip(shape(natural)) {
            *o += n * volume;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    const DISTORTED: Corners = [
        [0.0, 0.0, 0.0],
        [1.1, 0.1, -0.1],
        [1.2, 1.0, 0.1],
        [0.1, 0.9, 0.0],
        [-0.1, 0.1, 1.0],
        [0.9, 0.0, 1.2],
        [1.0, 1.1, 0.9],
        [0.0, 1.2, 1.1],
    ];

    fn internal_force(k: &Stiffness, u: &[[f64; 3]; 8]) -> [[f64; 3]; 8] {
        let forces = crate::element::Stiffness::from_blocks(8, k).force(u);
        std::array::from_fn(|a| forces[a])
    }

    fn elasticity() -> Elasticity {
        Elasticity::new(210.0, 0.3)
    }

    fn field(gradient: [[f64; 3]; 3], shift: [f64; 3]) -> [[f64; 3]; 8] {
        DISTORTED.map(|x| std::array::from_fn(|i| shift[i] + (0..3).map(|j| gradient[i][j] * x[j]).sum::<f64>()))
    }

    #[test]
    fn rigid_motions_need_no_force() {
        for kind in [Volumetric::Mean, Volumetric::Local] {
            let k = stiffness(kind, &DISTORTED, elasticity());
            let motion = field([[0.0, -0.3, 0.2], [0.3, 0.0, -0.1], [-0.2, 0.1, 0.0]], [1.0, -2.0, 3.0]);
            let worst = internal_force(&k, &motion).iter().flatten().fold(0.0f64, |m, f| m.max(f.abs()));
            assert!(worst < 1e-12, "{kind:?}: {worst}");
        }
    }

    #[test]
    fn uniform_strain_gives_uniform_stress_and_the_force_is_its_divergence() {
        let gradient = [[1e-3, 2e-4, 0.0], [1e-4, -5e-4, 3e-4], [0.0, -2e-4, 7e-4]];
        let u = field(gradient, [0.0; 3]);
        let e = elasticity();
        let trace = gradient[0][0] + gradient[1][1] + gradient[2][2];
        let expected =
            |i: usize, j: usize| e.mu * (gradient[i][j] + gradient[j][i]) + if i == j { e.lambda * trace } else { 0.0 };
        for kind in [Volumetric::Mean, Volumetric::Local] {
            for s in extrapolate(&stress(kind, &DISTORTED, e, &u)) {
                for (value, (i, j)) in s.iter().zip([(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]) {
                    assert!((value - expected(i, j)).abs() < 1e-13, "{kind:?}");
                }
            }
            // Force on corner a is σ ∫∇N_a dV.
            let f = internal_force(&stiffness(kind, &DISTORTED, e), &u);
            for a in 0..8 {
                let mut mean = [0.0; 3];
                for g in 0..8 {
                    let p = point(&DISTORTED, gauss_point(g));
                    for (m, x) in mean.iter_mut().zip(p.gradient[a]) {
                        *m += x * p.volume;
                    }
                }
                for i in 0..3 {
                    let by_stress: f64 = (0..3).map(|j| expected(i, j) * mean[j]).sum();
                    assert!((f[a][i] - by_stress).abs() < 1e-13, "{kind:?}");
                }
            }
        }
    }

    #[test]
    fn internal_force_is_the_derivative_of_the_energy() {
        let u: [[f64; 3]; 8] =
            std::array::from_fn(|a| std::array::from_fn(|i| ((a * 3 + i) as f64 * 0.7).sin() * 1e-2));
        for kind in [Volumetric::Mean, Volumetric::Local] {
            let k = stiffness(kind, &DISTORTED, elasticity());
            let energy = |u: &[[f64; 3]; 8]| -> f64 {
                let f = internal_force(&k, u);
                0.5 * (0..8).map(|a| (0..3).map(|i| f[a][i] * u[a][i]).sum::<f64>()).sum::<f64>()
            };
            // Energy from the stresses: independent of the blocks that the force uses.
            let strain_energy: f64 = {
                let s = stress(kind, &DISTORTED, elasticity(), &u);
                (0..8)
                    .map(|g| {
                        let p = point(&DISTORTED, gauss_point(g));
                        let mut work = 0.0;
                        for a in 0..8 {
                            let gr = p.gradient[a];
                            let t = &s[g];
                            let traction = [
                                t[0] * gr[0] + t[3] * gr[1] + t[4] * gr[2],
                                t[3] * gr[0] + t[1] * gr[1] + t[5] * gr[2],
                                t[4] * gr[0] + t[5] * gr[1] + t[2] * gr[2],
                            ];
                            work += (0..3).map(|i| traction[i] * u[a][i]).sum::<f64>();
                        }
                        0.5 * work * p.volume
                    })
                    .sum()
            };
            // Mean dilatation: ∫ κ θ̄ θ = ∫ κ θ̄², so the stress work equals the energy for both kinds.
            assert!((strain_energy - energy(&u)).abs() < 1e-12 * strain_energy, "{kind:?}");
            let f = internal_force(&k, &u);
            for a in 0..8 {
                for i in 0..3 {
                    let mut shifted = u;
                    shifted[a][i] += 1e-4;
                    let up = energy(&shifted);
                    shifted[a][i] -= 2e-4;
                    let slope = (up - energy(&shifted)) / 2e-4;
                    assert!((slope - f[a][i]).abs() < 1e-9, "{kind:?} node {a} direction {i}");
                }
            }
        }
    }

    #[test]
    fn nodal_volumes_add_up_to_the_volume() {
        let total: f64 = nodal_volumes(&DISTORTED).iter().sum();
        let volume: f64 = (0..8).map(|g| point(&DISTORTED, gauss_point(g)).volume).sum();
        assert!((total - volume).abs() < 1e-15);
        assert!(jacobian_min(&DISTORTED) > 0.0);
    }
}
