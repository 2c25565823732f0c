//! Rates of volume and characteristic lengths, one element at a time.

use super::dilatation::{self, characteristic_length};
use super::*;
use crate::model::{ElementKind, ElementShape};

/// Distorted, with curved edges where there are midside nodes.
fn distorted(kind: ElementKind) -> Coordinates {
    Coordinates::of((0..kind.node_count()).map(|a| {
        let [x, y, z] = basis::node(kind.shape(), a);
        [
            1.1 * x + 0.1 * y - 0.05 * z + 0.06 * y * z + 0.03 * x * x,
            0.2 * x + 0.9 * y + 0.1 * z - 0.05 * x * z + 0.02 * z * z,
            -0.1 * x + 0.05 * y + 1.2 * z + 0.07 * x * y - 0.03 * y * y,
        ]
    }))
}

/// A parallelepiped, and what it makes of other shapes.
fn affine(kind: ElementKind) -> Coordinates {
    Coordinates::of((0..kind.node_count()).map(|a| {
        let [x, y, z] = basis::node(kind.shape(), a);
        [1.1 * x + 0.1 * y, 0.2 * x + 0.9 * y + 0.1 * z, 1.2 * z - 0.1 * x]
    }))
}

/// `ε̇_vol` of nodal velocities.
fn rate(d: &dilatation::Dilatation, velocity: &[[f64; 3]]) -> f64 {
    d.gradient.iter().zip(velocity).map(|(g, v)| g[0] * v[0] + g[1] * v[1] + g[2] * v[2]).sum()
}

#[test]
fn a_linear_velocity_has_the_rate_of_its_divergence_and_rigid_motions_have_none() {
    for kind in ElementKind::SOLIDS {
        let x = distorted(kind);
        let d = dilatation::of(kind, &x);
        let field = |p: &[f64; 3]| [0.3 + 0.5 * p[0] - 0.7 * p[1], 0.7 * p[0] - 0.2 * p[1], 0.1 * p[2] - 0.4 * p[0]];
        let v: Vec<[f64; 3]> = x.iter().map(field).collect();
        assert!((rate(&d, &v) - 0.4).abs() < 1e-13, "{kind:?}: {}", rate(&d, &v));
        let rigid: Vec<[f64; 3]> =
            x.iter().map(|p| [1.0 - 0.7 * p[1] + 0.2 * p[2], 0.7 * p[0], 3.0 - 0.2 * p[0]]).collect();
        assert!(rate(&d, &rigid).abs() < 1e-13, "{kind:?}");
        // No force, no moment: the tensor of arms and gradients is the unit tensor.
        for i in 0..3 {
            let force: f64 = d.gradient.iter().map(|g| g[i]).sum();
            assert!(force.abs() < 1e-14, "{kind:?}");
            for j in 0..3 {
                let moment: f64 = x.iter().zip(&*d.gradient).map(|(x, g)| x[i] * g[j]).sum();
                assert!((moment - f64::from(u8::from(i == j))).abs() < 1e-13, "{kind:?}: {moment}");
            }
        }
    }
}

/// The rate is the derivative of the volume by the nodes: where the points are enough for both, which they are not on curved
/// elements, and of bricks where they are parallelepipeds.
#[test]
fn the_rate_is_how_fast_the_volume_grows() {
    for kind in ElementKind::SOLIDS.into_iter().filter(|k| basis::edges(k.shape()).is_empty()) {
        let x = if kind.node_count() == 8 { affine(kind) } else { distorted(kind) };
        let v: Vec<[f64; 3]> =
            (0..x.len()).map(|a| std::array::from_fn(|i| ((a * 3 + i) as f64 * 0.7).sin())).collect();
        let volume = |t: f64| {
            let moved: Vec<[f64; 3]> =
                x.iter().zip(&v).map(|(x, v)| std::array::from_fn(|i| x[i] + t * v[i])).collect();
            nodal_volumes(kind, &moved).iter().sum::<f64>()
        };
        let d = dilatation::of(kind, &x);
        assert!((d.volume - volume(0.0)).abs() < 1e-13 * d.volume, "{kind:?}");
        let slope = (volume(1e-5) - volume(-1e-5)) / 2e-5 / volume(0.0);
        assert!((slope - rate(&d, &v)).abs() < 1e-8, "{kind:?}: {slope} {}", rate(&d, &v));
    }
}

#[test]
fn lengths_are_edges_of_cubes_and_smallest_edges_of_boxes_however_they_are_turned() {
    let turn = |[x, y, z]: [f64; 3]| [0.36 * x + 0.48 * y - 0.8 * z, -0.8 * x + 0.6 * y, 0.48 * x + 0.64 * y + 0.6 * z];
    for kind in ElementKind::SOLIDS.into_iter().filter(|k| k.shape() == ElementShape::Hexahedron8) {
        for (sides, wanted) in [([3.0, 3.0, 3.0], 3.0), ([4.0, 0.5, 7.0], 0.5)] {
            let x = Coordinates::of((0..8).map(|a| {
                let n = basis::node(kind.shape(), a);
                turn(std::array::from_fn(|i| 0.5 * sides[i] * n[i]))
            }));
            let length = characteristic_length(kind, &x);
            assert!((length - wanted).abs() < 1e-10, "{kind:?}: {length}");
        }
    }
    // Four times as large, four times as long.
    for kind in ElementKind::SOLIDS {
        let x = distorted(kind);
        let large = Coordinates::of(x.iter().map(|x| x.map(|x| 4.0 * x)));
        let (one, four) = (characteristic_length(kind, &x), characteristic_length(kind, &large));
        assert!((four - 4.0 * one).abs() < 1e-11 * four && one > 0.1 && one < 2.5, "{kind:?}: {one} {four}");
    }
}
