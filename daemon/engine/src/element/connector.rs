//! Bars and springs: one elongation each, `K = k b bᵀ` with the elongation `b · u`.

use super::Stiffness;
use crate::model::{Connector, ElementKind};

/// Stiffness along the elongation of a connector [force/length]; none for a mass and for what is inert.
///
/// A bar has `E A / L`; `youngs_modulus` is that of its material.
pub fn axial_stiffness(coordinates: &[[f64; 3]], section: Connector, youngs_modulus: f64) -> Option<f64> {
    match section {
        Connector::Bar { area } => Some(youngs_modulus * area / length(coordinates)),
        Connector::Spring { stiffness, .. } => Some(stiffness),
        Connector::Dashpot { .. } | Connector::Mass { .. } | Connector::RotaryInertia { .. } | Connector::Inert => None,
    }
}

/// Elongation of a connector: `b` at each of its nodes, positive when it gets longer (SPRING1 and SPRING2: the displacement
/// of the first node less that of the second).
pub fn elongation(kind: ElementKind, coordinates: &[[f64; 3]], section: Connector) -> [[f64; 3]; 2] {
    let mut b = [[0.0; 3]; 2];
    match (kind, section) {
        (ElementKind::Spring1, Connector::Spring { directions, .. }) => b[0][usize::from(directions[0])] = 1.0,
        (ElementKind::Spring2, Connector::Spring { directions, .. }) => {
            b[0][usize::from(directions[0])] = 1.0;
            b[1][usize::from(directions[1])] = -1.0;
        }
        (ElementKind::T3D2 | ElementKind::SpringA, _) => {
            let length = length(coordinates);
            for d in 0..3 {
                b[1][d] = (coordinates[1][d] - coordinates[0][d]) / length;
                b[0][d] = -b[1][d];
            }
        }
        _ => {}
    }
    b
}

/// Distance between the two nodes [length].
pub fn length(coordinates: &[[f64; 3]]) -> f64 {
    (0..3).map(|d| (coordinates[1][d] - coordinates[0][d]).powi(2)).sum::<f64>().sqrt()
}

/// Stiffness matrix of a connector, into `out`; zero for a mass and for what is inert.
pub fn stiffness(
    kind: ElementKind,
    coordinates: &[[f64; 3]],
    section: Connector,
    youngs_modulus: f64,
    out: &mut Stiffness,
) {
    let count = kind.node_count();
    let blocks = out.clear(count);
    let Some(k) = axial_stiffness(coordinates, section, youngs_modulus) else { return };
    let b = elongation(kind, coordinates, section);
    for a in 0..count {
        for c in a..count {
            let block = &mut blocks[super::matrix::block_index(count, a, c)];
            for i in 0..3 {
                for j in 0..3 {
                    block[3 * i + j] = k * b[a][i] * b[c][j];
                }
            }
        }
    }
}

/// Force in a connector under nodal displacements, positive in tension [force].
pub fn force(
    kind: ElementKind,
    coordinates: &[[f64; 3]],
    section: Connector,
    youngs_modulus: f64,
    u: &[[f64; 3]],
) -> f64 {
    let b = elongation(kind, coordinates, section);
    let elongation: f64 = u.iter().zip(&b).flat_map(|(u, b)| u.iter().zip(b)).map(|(u, b)| u * b).sum();
    axial_stiffness(coordinates, section, youngs_modulus).unwrap_or(0.0) * elongation
}

#[cfg(test)]
mod tests {
    use super::*;

    const ENDS: [[f64; 3]; 2] = [[1.0, 2.0, 3.0], [3.0, -1.0, 9.0]];
    const SPRING: Connector = Connector::Spring { stiffness: 5.0, directions: [2, 0] };

    fn cases() -> [(ElementKind, Connector); 4] {
        [
            (ElementKind::T3D2, Connector::Bar { area: 0.5 }),
            (ElementKind::SpringA, SPRING),
            (ElementKind::Spring1, SPRING),
            (ElementKind::Spring2, SPRING),
        ]
    }

    #[test]
    fn the_stiffness_is_the_derivative_of_the_force_and_of_half_its_work() {
        for (kind, section) in cases() {
            let mut k = Stiffness::default();
            let coordinates = &ENDS[..kind.node_count()];
            stiffness(kind, coordinates, section, 200.0, &mut k);
            let u = [[0.3, -0.1, 0.7], [0.2, 0.5, -0.4]];
            let u = &u[..kind.node_count()];
            let force = force(kind, coordinates, section, 200.0, u);
            let b = elongation(kind, coordinates, section);
            for (node, row) in k.force(u).iter().take(u.len()).enumerate() {
                for d in 0..3 {
                    assert!((row[d] - force * b[node][d]).abs() < 1e-12, "{kind:?}");
                }
            }
        }
    }

    #[test]
    fn a_bar_and_an_axial_spring_resist_no_rigid_motion_and_a_bar_carries_e_a_over_l() {
        // Length 7: (2, -3, 6).
        for (kind, section) in &cases()[..2] {
            let rotation =
                |x: [f64; 3]| [0.2 * x[2] - 0.7 * x[1] + 1.0, 0.7 * x[0] - 0.4 * x[2], 0.4 * x[1] - 0.2 * x[0]];
            assert!(force(*kind, &ENDS, *section, 200.0, &ENDS.map(rotation)).abs() < 1e-12);
        }
        let stretched = [[0.0; 3], [2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0]];
        let pull = force(ElementKind::T3D2, &ENDS, Connector::Bar { area: 0.5 }, 200.0, &stretched);
        assert!((pull - 200.0 * 0.5 / 7.0).abs() < 1e-12);
    }
}
