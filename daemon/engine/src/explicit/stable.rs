//! Stable increments of central differences, contact included.
//!
//! With bounds `S` of the eigenvalues of `M⁻¹ K` and `G` of those of `M⁻¹ C` (damping lags by half an increment)
//!
//! ```text
//! S Δt²/4 + G Δt/2 = 1        Δt = 2 / (G/2 + √(G²/4 + S))
//! ```
//!
//! which is `2/ω (√(1 + ξ²) − ξ)` for one frequency. Elements without contact give `S_0 = (2/Δt_0)²`. Contact adds the largest
//! `Σ_j |B M⁻¹ Bᵀ|_ij √(k_i k_j)`: for one point between two masses `k (1/m1 + 1/m2)`. Alone on a node this is
//! `Δt_0 / √(1 + κ)`, `κ = k Δt_0² / (4 m)`.

use super::slots::Slots;

/// Part of the free stable increment that default penalties leave.
const LEFT_BY_PENALTY: f64 = 0.96;

/// Default penalty stiffness [force/length] of a mass, given the stable increment without contact \[time\]: it takes 4 % of that.
/// Our choice: the manual says only that the effect on the increment is small.
pub fn default_stiffness(mass: f64, free: f64) -> f64 {
    let kappa = 1.0 / (LEFT_BY_PENALTY * LEFT_BY_PENALTY) - 1.0;
    kappa * 4.0 * mass / (free * free)
}

/// Stable increment \[time\] under bounds of `M⁻¹ K` [1/time²] and `M⁻¹ C` [1/time]; infinite where both are zero.
pub fn increment(stiffness: f64, damping: f64) -> f64 {
    let half = 0.5 * damping;
    2.0 / (half + (half * half + stiffness).sqrt())
}

/// Bound of the eigenvalues of `M⁻¹ Bᵀ k B` over some rows, given by row with their `k`, and the row where it is reached. `sums`:
/// a zero for each slot, zeros again afterwards.
pub fn bound(slots: &Slots, rows: &[(u32, f64)], sums: &mut [f64]) -> (f64, Option<u32>) {
    for &(row, k) in rows {
        let root = k.sqrt();
        for &(slot, b) in &slots.rows[row as usize].entries {
            sums[slot as usize] += b.abs() * root;
        }
    }
    let (mut largest, mut at) = (0.0, None);
    for &(row, k) in rows {
        let answers = &slots.rows[row as usize].answers;
        let sum: f64 = answers.iter().map(|&(slot, y)| y.abs() * sums[slot as usize]).sum();
        let bound = k.sqrt() * sum;
        if bound > largest {
            (largest, at) = (bound, Some(row));
        }
    }
    for &(row, _) in rows {
        for &(slot, _) in &slots.rows[row as usize].entries {
            sums[slot as usize] = 0.0;
        }
    }
    (largest, at)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(value: f64, expected: f64, tolerance: f64) {
        assert!((value - expected).abs() <= tolerance * expected.abs(), "{value:e} against {expected:e}");
    }

    #[test]
    fn a_default_penalty_takes_four_percent() {
        // D20.
        close(default_stiffness(0.5, 1e-6), 170138888888.8889, 1e-12);
        let k = default_stiffness(0.5, 1e-6);
        close(increment((2.0f64 / 1e-6).powi(2) + k / 0.5, 0.0), 0.96e-6, 1e-14);
    }

    #[test]
    fn point_masses_on_a_spring_have_their_increments() {
        // D18.
        close(increment(1e6 / 2.0, 0.0), 0.00282842712474619, 1e-14);
        let square = 1e6 * (1.0 / 2.0 + 1.0 / 3.0);
        close(increment(square, 0.0), 0.0021908902300206644, 1e-14);
        close(increment(square, 2.0 * 0.03 * square.sqrt()), 0.0021261492019956844, 1e-12);
    }
}
