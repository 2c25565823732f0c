//! Rate of volume of solids, and the length that waves take to cross them.
//!
//! ```text
//! ε̇_vol = Σ_a g_a · v_a,   g_a = (1/V) ∫ ∇N_a dV          mean over the element
//!                           g_a = ∇N_a at the centre         bricks of eight nodes
//! L = 2 / √(V λ),           λ = largest eigenvalue of Σ_a g_a g_aᵀ / w_a
//! ```
//!
//! Both gradients have `Σ g_a = 0` and `Σ x_a g_aᵀ = I`: a pressure against `ε̇_vol` changes neither momentum nor moment of momentum.
//! Those at the centre of a brick are made of three vectors; on parallelepipeds they are the mean too.
//!
//! `w_a` is the lumped volume of each node. `L` makes `2 c / L` the frequency of the fastest uniform strain in one direction on
//! lumped masses, `c` the speed of dilatational waves: the edge of a cube, the length of a bar, the smallest edge of a box.
//! A linear bulk viscosity `b₁ ρ c L ε̇_vol` is then `b₁` of the critical damping of a bar.

use super::mass;
use super::matrix::Coordinates;
use super::{brick, isoparametric, stable, table};
use crate::model::ElementKind;

/// Rate of volume of a solid as a function of the velocities of its nodes.
#[derive(Clone, Copy, Debug)]
pub struct Dilatation {
    /// `g_a` at each node [1/length].
    pub gradient: Coordinates,
    /// Volume [length³].
    pub volume: f64,
}

/// At the centre of bricks of eight nodes, else the mean over the points at which the kind is integrated.
pub fn of(kind: ElementKind, coordinates: &[[f64; 3]]) -> Dilatation {
    let (gradient, volume) = match kind {
        ElementKind::C3D8
        | ElementKind::C3D8Full
        | ElementKind::C3D8I
        | ElementKind::C3D8R
        | ElementKind::C3D8RCalculix => {
            let corners = super::corners(coordinates);
            let centre = brick::point(corners, [0.0; 3]);
            let volume = brick::nodal_volumes(corners).iter().sum();
            (Coordinates::of(centre.gradient.into_iter()), volume)
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
