//! Mass and damping of bars, dashpots, point masses and rotary inertias.
//!
//! ```text
//! bar        m = ρ A L:  m/2 at either node (lumped), m/6 [2 1; 1 2] I (consistent)
//! mass       m I         at its node, damping α m I
//! inertia    the tensor  at the node that carries the rotations, damping α times it
//! dashpot    c b bᵀ      damping, b · v its rate of elongation
//! ```

use super::connector::{self, length};
use super::matrix::{Stiffness, block_index};
use crate::model::{Connector, ElementKind};

/// How the mass of an element is attached to its nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Attachment {
    /// To each node alone.
    Lumped,
    /// To all pairs of nodes, by the products of shape functions.
    Consistent,
}

/// Mass matrix of a connector, into `out` \[mass\] (rotary inertia: \[mass·length²\]); `density` is that of a bar's material.
pub fn mass(
    kind: ElementKind,
    coordinates: &[[f64; 3]],
    section: Connector,
    density: f64,
    attachment: Attachment,
    out: &mut Stiffness,
) {
    let count = kind.node_count();
    let blocks = out.clear(count);
    match section {
        Connector::Bar { area } => {
            let mass = density * area * length(coordinates);
            let (own, other) = match attachment {
                Attachment::Lumped => (mass / 2.0, 0.0),
                Attachment::Consistent => (mass / 3.0, mass / 6.0),
            };
            for (a, b, value) in [(0, 0, own), (0, 1, other), (1, 1, own)] {
                blocks[block_index(count, a, b)] = scaled_unit(value);
            }
        }
        Connector::Mass { mass, .. } => blocks[0] = scaled_unit(mass),
        Connector::RotaryInertia { inertia, .. } => blocks[0] = tensor(inertia),
        Connector::Spring { .. } | Connector::Dashpot { .. } | Connector::Inert => {}
    }
}

/// Damping matrix of a connector that its section states, into `out` [force·time/length]: of dashpots, masses and inertias.
pub fn damping(kind: ElementKind, coordinates: &[[f64; 3]], section: Connector, out: &mut Stiffness) {
    let blocks = out.clear(kind.node_count());
    match section {
        Connector::Dashpot { coefficient, directions } => {
            let spring = Connector::Spring { stiffness: coefficient, directions };
            connector::stiffness(like_spring(kind), coordinates, spring, 0.0, out);
        }
        Connector::Mass { mass, alpha } => blocks[0] = scaled_unit(alpha * mass),
        Connector::RotaryInertia { inertia, alpha } => blocks[0] = tensor(inertia).map(|i| alpha * i),
        Connector::Bar { .. } | Connector::Spring { .. } | Connector::Inert => {}
    }
}

/// The spring that acts on displacements as a dashpot acts on velocities.
fn like_spring(kind: ElementKind) -> ElementKind {
    match kind {
        ElementKind::DashpotA => ElementKind::SpringA,
        ElementKind::Dashpot1 => ElementKind::Spring1,
        ElementKind::Dashpot2 => ElementKind::Spring2,
        other => other,
    }
}

/// A multiple of the unit matrix.
fn scaled_unit(value: f64) -> [f64; 9] {
    [value, 0.0, 0.0, 0.0, value, 0.0, 0.0, 0.0, value]
}

/// Symmetric tensor of 11, 22, 33, 12, 13, 23.
fn tensor([i11, i22, i33, i12, i13, i23]: [f64; 6]) -> [f64; 9] {
    [i11, i12, i13, i12, i22, i23, i13, i23, i33]
}

#[cfg(test)]
mod tests {
    use super::*;

    const ENDS: [[f64; 3]; 2] = [[1.0, 2.0, 3.0], [3.0, -1.0, 9.0]];

    fn dot(u: &[[f64; 3]], f: &[[f64; 3]]) -> f64 {
        u.iter().zip(f).flat_map(|(u, f)| u.iter().zip(f)).map(|(u, f)| u * f).sum()
    }

    #[test]
    fn a_bar_has_the_energy_of_its_material_under_linear_velocities() {
        // ρ A L = 0.5 · 2 · 7 = 7.
        let bar = Connector::Bar { area: 0.5 };
        let v = [[0.3, -0.1, 0.7], [0.2, 0.5, -0.4]];
        let energy = |attachment, v: &[[f64; 3]]| {
            let mut m = Stiffness::default();
            mass(ElementKind::T3D2, &ENDS, bar, 2.0, attachment, &mut m);
            0.5 * dot(v, &m.force(v))
        };
        // ½ ρ A ∫ v·v ds over the line: ½ m (v1·v1 + v1·v2 + v2·v2) / 3.
        let square = |a: usize, b: usize| (0..3).map(|d| v[a][d] * v[b][d]).sum::<f64>();
        let exact = 0.5 * 7.0 * (square(0, 0) + square(0, 1) + square(1, 1)) / 3.0;
        assert!((energy(Attachment::Consistent, &v) - exact).abs() < 1e-14);
        let halves = 0.5 * 3.5 * (square(0, 0) + square(1, 1));
        assert!((energy(Attachment::Lumped, &v) - halves).abs() < 1e-14);
        for attachment in [Attachment::Lumped, Attachment::Consistent] {
            let whole = energy(attachment, &[[1.0, 2.0, -2.0]; 2]);
            assert!((whole - 0.5 * 7.0 * 9.0).abs() < 1e-13, "{attachment:?}");
        }
    }

    #[test]
    fn masses_and_inertias_have_their_energy_and_damp_by_alpha_times_it() {
        let inertia = [5.0, 6.0, 7.0, 0.5, -0.25, 0.75];
        let cases = [
            (ElementKind::Mass, Connector::Mass { mass: 3.0, alpha: 0.2 }, 3.0 * 14.0),
            // ω · J ω for ω = (1, 2, 3): 5 + 24 + 63 + 2 (0.5 · 2 − 0.25 · 3 + 0.75 · 6).
            (ElementKind::RotaryI, Connector::RotaryInertia { inertia, alpha: 0.2 }, 92.0 + 2.0 * 4.75),
        ];
        let v = [[1.0, 2.0, 3.0]];
        for (kind, section, twice) in cases {
            let (mut m, mut c) = (Stiffness::default(), Stiffness::default());
            mass(kind, &ENDS[..1], section, 0.0, Attachment::Lumped, &mut m);
            damping(kind, &ENDS[..1], section, &mut c);
            assert!((dot(&v, &m.force(&v)) - twice).abs() < 1e-12, "{kind:?}");
            assert!((dot(&v, &c.force(&v)) - 0.2 * twice).abs() < 1e-12, "{kind:?}");
        }
    }

    #[test]
    fn dashpots_take_power_from_their_rate_of_elongation_alone() {
        let section = Connector::Dashpot { coefficient: 5.0, directions: [2, 0] };
        let v = [[0.3, -0.1, 0.7], [0.2, 0.5, -0.4]];
        // Along (2, -3, 6) / 7; v2 − v1 = (-0.1, 0.6, -1.1).
        let along = (2.0 * -0.1 + -3.0 * 0.6 + 6.0 * -1.1) / 7.0;
        for (kind, rate) in
            [(ElementKind::DashpotA, along), (ElementKind::Dashpot1, 0.7), (ElementKind::Dashpot2, 0.7 - 0.2)]
        {
            let count = kind.node_count();
            let mut c = Stiffness::default();
            damping(kind, &ENDS[..count], section, &mut c);
            let power = dot(&v[..count], &c.force(&v[..count]));
            assert!((power - 5.0 * rate * rate).abs() < 1e-13, "{kind:?}: {power}");
        }
        // A rotation about the first node is no elongation.
        let mut c = Stiffness::default();
        damping(ElementKind::DashpotA, &ENDS, section, &mut c);
        assert!(c.force(&[[0.0; 3], [3.0, 2.0, 0.0]]).as_flattened().iter().all(|f| f.abs() < 1e-14));
    }
}
