//! Rate of volume of solids, and the length that waves take to cross them.
//!
//! ```text
//! ε̇_vol = Σ_a g_a · v_a,   g_a = (1/V) ∫ ∇N_a dV          mean over the element
//! L = 2 / √(V λ),           λ = largest eigenvalue of Σ_a g_a g_aᵀ / w_a
//! ```
//!
//! with the lumped volume `w_a` of each node. `L` makes `2 c / L` the frequency of the fastest uniform strain in one direction on
//! lumped masses, `c` the speed of dilatational waves: the edge of a cube, the length of a bar, the smallest edge of a box.
//! A linear bulk viscosity `b₁ ρ c L ε̇_vol` is then `b₁` of the critical damping of a bar.

use super::mass;
use super::matrix::Coordinates;
use super::{isoparametric, stable, table, uniform_strain};
use crate::model::ElementKind;

/// Mean rate of volume of a solid as a function of the velocities of its nodes.
#[derive(Clone, Copy, Debug)]
pub struct Dilatation {
    /// `g_a` at each node [1/length].
    pub gradient: Coordinates,
    /// Volume [length³].
    pub volume: f64,
}

/// Mean over the points at which the kind is integrated.
pub fn of(kind: ElementKind, coordinates: &[[f64; 3]]) -> Dilatation {
    let (gradient, volume) = match kind {
        ElementKind::C3D8
        | ElementKind::C3D8Full
        | ElementKind::C3D8I
        | ElementKind::C3D8R
        | ElementKind::C3D8RCalculix => {
            let (gradient, volume) = uniform_strain::mean(super::corners(coordinates));
            (Coordinates::of(gradient.into_iter()), volume)
        }
        _ => isoparametric::mean_gradient(table::of(kind), coordinates),
    };
    Dilatation { gradient, volume }
}

/// `L` \[length\].
pub fn characteristic_length(kind: ElementKind, coordinates: &[[f64; 3]]) -> f64 {
    let Dilatation { gradient, volume } = of(kind, coordinates);
    let mut sum = [0.0; 9];
    for (g, w) in gradient.iter().zip(mass::lumped(kind, coordinates, 1.0)) {
        for i in 0..3 {
            for j in 0..3 {
                sum[3 * i + j] += g[i] * g[j] / w;
            }
        }
    }
    2.0 / (volume * stable::largest_eigenvalue(&mut sum, 3)).sqrt()
}
