//! Isotropic linear elasticity.

/// Elastic constants that an element needs.
#[derive(Clone, Copy, Debug)]
pub struct Elasticity {
    /// Lamé's first constant [pressure].
    pub lambda: f64,
    /// Shear modulus [pressure].
    pub mu: f64,
}

impl Elasticity {
    /// From Young's modulus and Poisson's ratio.
    pub fn new(youngs_modulus: f64, poissons_ratio: f64) -> Self {
        let (e, nu) = (youngs_modulus, poissons_ratio);
        Self { lambda: e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), mu: e / (2.0 * (1.0 + nu)) }
    }

    /// Whether nothing resists: the material of solids of a rigid body.
    pub fn is_zero(self) -> bool {
        self.mu == 0.0 && self.lambda == 0.0
    }

    /// Young's modulus [pressure].
    pub fn youngs_modulus(self) -> f64 {
        if self.is_zero() {
            return 0.0;
        }
        self.mu * (3.0 * self.lambda + 2.0 * self.mu) / (self.lambda + self.mu)
    }

    /// Bulk modulus [pressure].
    pub fn kappa(self) -> f64 {
        self.lambda + 2.0 / 3.0 * self.mu
    }

    /// Stress (11, 22, 33, 12, 13, 23) of a displacement gradient `h[i][j] = ∂u_i/∂x_j` [pressure].
    pub fn stress(self, h: &[[f64; 3]; 3]) -> [f64; 6] {
        let volumetric = self.lambda * (h[0][0] + h[1][1] + h[2][2]);
        let mu = self.mu;
        [
            volumetric + 2.0 * mu * h[0][0],
            volumetric + 2.0 * mu * h[1][1],
            volumetric + 2.0 * mu * h[2][2],
            mu * (h[0][1] + h[1][0]),
            mu * (h[0][2] + h[2][0]),
            mu * (h[1][2] + h[2][1]),
        ]
    }

    /// Block `K_ab` of the moment `M_ab = ∫ ∇N_a ∇N_bᵀ dV`, row-major.
    pub fn block(self, m: &[f64; 9]) -> [f64; 9] {
        let mut out = [0.0; 9];
        let trace = self.mu * (m[0] + m[4] + m[8]);
        for i in 0..3 {
            for j in 0..3 {
                out[3 * i + j] = self.lambda * m[3 * i + j] + self.mu * m[3 * j + i];
            }
            out[4 * i] += trace;
        }
        out
    }
}
