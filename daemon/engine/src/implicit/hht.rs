//! The time operator of Hilber, Hughes and Taylor.
//!
//! ```text
//! M a_1 + (1 + α) r_1 − α r_0 + Bᵀ Λ = 0          r = K u + C v − f + Bᵀ F,  Λ: multipliers of hard contact
//! u_1 = u_0 + Δt v_0 + Δt² ((1/2 − β) a_0 + β a_1)
//! v_1 = v_0 + Δt ((1 − γ) a_0 + γ a_1)
//! β = (1 − α)² / 4,  γ = 1/2 − α,  −1/3 ≤ α ≤ 0
//! ```
//!
//! `F` are the forces of softened contact, penalties and dashpots: they are weighted like internal forces. Divided by `1 + α` the
//! equation of an increment is one of statics with the matrix `K + C γ/(β Δt) + M / ((1 + α) β Δt²)`; a multiplier then counts as
//! `Λ / (1 + α)`. Source: Abaqus Theory Manual 2.4.1; the weighting of contact is our reading.

use crate::model::MassMatrix;
use crate::solve::context::Blend;

/// The operator for one increment size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hht {
    /// `α`.
    pub alpha: f64,
    /// `β`.
    pub beta: f64,
    /// `γ`.
    pub gamma: f64,
    /// `Δt` \[time\].
    pub size: f64,
}

impl Hht {
    /// For an increment of a size, positive.
    pub fn new(alpha: f64, size: f64) -> Self {
        Self { alpha, beta: (1.0 - alpha).powi(2) / 4.0, gamma: 0.5 - alpha, size }
    }

    /// `dv_1/du_1` [1/time].
    pub fn speed(&self) -> f64 {
        self.gamma / (self.beta * self.size)
    }

    /// `da_1/du_1` [1/time²].
    pub fn curvature(&self) -> f64 {
        1.0 / (self.beta * self.size * self.size)
    }

    /// The matrix of an increment.
    pub fn blend(&self, form: MassMatrix) -> Blend {
        Blend { stiffness: 1.0, damping: self.speed(), mass: self.curvature() / (1.0 + self.alpha), form }
    }

    /// Displacement and velocity at the end if the acceleration there were zero.
    pub fn predict(&self, u: f64, v: f64, a: f64) -> (f64, f64) {
        let t = self.size;
        (u + t * v + t * t * (0.5 - self.beta) * a, v + t * (1.0 - self.gamma) * a)
    }

    /// Velocity and acceleration at the end where the displacement is known.
    pub fn correct(&self, u0: f64, v0: f64, a0: f64, u1: f64) -> (f64, f64) {
        let (u, v) = self.predict(u0, v0, a0);
        let a1 = (u1 - u) * self.curvature();
        (v + self.size * self.gamma * a1, a1)
    }

    /// Overclosure from which a dashpot measures: its speed at the end of the increment is `speed · (h_1 − start)`.
    pub fn dashpot_start(&self, h0: f64, v0: f64, a0: f64) -> f64 {
        // v_1 = speed (h_1 − h_0) + (1 − γ/β) v_0 + Δt (1 − γ/(2β)) a_0
        let ratio = self.gamma / self.beta;
        h0 - ((1.0 - ratio) * v0 + self.size * (1.0 - 0.5 * ratio) * a0) / self.speed()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mass_on_a_spring_follows_the_published_march() {
        // m = 1, K = 1e4, Δt = 1e-3, α = −0.05, v = 1 at the start.
        let hht = Hht::new(-0.05, 1e-3);
        assert!((hht.beta - 0.275625).abs() < 1e-15 && (hht.gamma - 0.55).abs() < 1e-15);
        let (k, mut u, mut v, mut a) = (1e4, 0.0, 1.0, 0.0);
        for _ in 0..10 {
            let (u_p, _) = hht.predict(u, v, a);
            let factor = 1.0 + hht.alpha;
            let matrix = k + hht.curvature() / factor;
            let right = hht.curvature() / factor * u_p + hht.alpha / factor * k * u;
            let u1 = right / matrix;
            let (v1, a1) = hht.correct(u, v, a, u1);
            (u, v, a) = (u1, v1, a1);
        }
        for (value, expected) in [(u, 0.008408637181706482), (v, 0.5409607544914448), (a, -83.79560298922911)] {
            assert!((value - expected).abs() < 1e-11 * expected.abs(), "{value} {expected}");
        }
    }

    #[test]
    fn the_speed_of_a_dashpot_is_the_velocity_of_the_operator() {
        let hht = Hht::new(-0.1, 0.02);
        let (h0, v0, a0, h1) = (0.3, -1.5, 7.0, 0.25);
        let speed = hht.speed() * (h1 - hht.dashpot_start(h0, v0, a0));
        assert!((speed - hht.correct(h0, v0, a0, h1).0).abs() < 1e-12);
    }
}
