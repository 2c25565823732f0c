//! Masses of one element at a time.

use super::mass::{consistent, lumped};
use super::*;
use crate::model::{ElementKind, ElementShape};

const DENSITY: f64 = 2.5;

/// Straight-sided, distorted where the corners allow it.
fn straight(kind: ElementKind) -> Coordinates {
    let corner = |[x, y, z]: [f64; 3]| {
        [
            1.1 * x + 0.1 * y - 0.05 * z + 0.06 * y * z,
            0.2 * x + 0.9 * y + 0.1 * z - 0.05 * x * z,
            1.2 * z - 0.1 * x + 0.05 * y + 0.07 * x * y,
        ]
    };
    let shape = kind.shape();
    let edges = basis::edges(shape);
    let corners = kind.node_count() - edges.len();
    let mut nodes: Vec<[f64; 3]> = (0..corners).map(|a| corner(basis::node(shape, a))).collect();
    for &[a, b] in edges {
        nodes.push(std::array::from_fn(|d| 0.5 * (nodes[a][d] + nodes[b][d])));
    }
    Coordinates::of(nodes.into_iter())
}

/// ∫ f dV over the element by a product rule of eight points per direction, collapsed where the parent is.
fn integral(kind: ElementKind, x: &[[f64; 3]], f: &dyn Fn([f64; 3]) -> f64) -> f64 {
    // Gauss–Legendre on [-1, 1] by Newton's method.
    let rule: Vec<(f64, f64)> = (0..8)
        .map(|k| {
            let mut t = (std::f64::consts::PI * (k as f64 + 0.75) / 8.5).cos();
            let mut slope = 0.0;
            for _ in 0..50 {
                let (mut p, mut q) = (1.0, t);
                for n in 2..=8 {
                    (p, q) = (q, ((2 * n - 1) as f64 * t * q - (n - 1) as f64 * p) / n as f64);
                }
                slope = 8.0 * (t * q - p) / (t * t - 1.0);
                t -= q / slope;
            }
            (t, 2.0 / ((1.0 - t * t) * slope * slope))
        })
        .collect();
    let mut sum = 0.0;
    for &(r, u) in &rule {
        for &(s, v) in &rule {
            for &(t, w) in &rule {
                let half = |x: f64| 0.5 * (1.0 + x);
                let (natural, weight) = match kind.shape() {
                    ElementShape::Hexahedron8 | ElementShape::Hexahedron20 => ([r, s, t], u * v * w),
                    ElementShape::Wedge6 | ElementShape::Wedge15 => {
                        let a = half(r);
                        ([a, half(s) * (1.0 - a), t], u * v * w / 4.0 * (1.0 - a))
                    }
                    _ => {
                        let a = half(r);
                        let b = half(s) * (1.0 - a);
                        ([a, b, half(t) * (1.0 - a - b)], u * v * w / 8.0 * (1.0 - a) * (1.0 - a - b))
                    }
                };
                let sample = table::Sample { weight, basis: basis::evaluate(kind.shape(), natural) };
                let det = isoparametric::determinant(&isoparametric::jacobian(&sample, x));
                let place = std::array::from_fn(|d| x.iter().zip(&sample.basis.value).map(|(x, n)| n * x[d]).sum());
                sum += weight * det * f(place);
            }
        }
    }
    sum
}

fn energy(m: &Stiffness, v: &[[f64; 3]]) -> f64 {
    0.5 * v.iter().zip(m.force(v)).flat_map(|(v, f)| (0..3).map(move |d| v[d] * f[d])).sum::<f64>()
}

#[test]
fn the_energy_of_translation_is_half_of_mass_times_speed_squared() {
    let v = [1.0, -2.0, 0.5];
    for kind in ElementKind::SOLIDS {
        let x = straight(kind);
        let mass = DENSITY * integral(kind, &x, &|_| 1.0);
        let mut m = Stiffness::default();
        consistent(kind, &x, DENSITY, &mut m);
        let all = vec![v; kind.node_count()];
        assert!((energy(&m, &all) - 0.5 * mass * 5.25).abs() < 1e-13 * mass, "{kind:?}");
        // The momentum is the mass times the velocity, along it.
        let momentum = m.force(&all).iter().fold([0.0; 3], |p, f| std::array::from_fn(|d| p[d] + f[d]));
        assert!((0..3).all(|d| (momentum[d] - mass * v[d]).abs() < 1e-12 * mass), "{kind:?}");
        let nodal = lumped(kind, &x, DENSITY);
        assert!(nodal.iter().all(|&m| m > 0.0), "{kind:?}: {nodal:?}");
        assert!((nodal.iter().sum::<f64>() - mass).abs() < 1e-13 * mass, "{kind:?}");
    }
}

#[test]
fn consistent_masses_have_the_energy_of_linear_and_their_products_of_quadratic_velocities() {
    for kind in ElementKind::SOLIDS {
        let x = straight(kind);
        let mut m = Stiffness::default();
        consistent(kind, &x, DENSITY, &mut m);
        // A rigid rotation and a stretch: the velocity within is exact for every isoparametric element.
        let field =
            |p: [f64; 3]| [0.3 - 0.7 * p[1] + 0.2 * p[2], 0.7 * p[0] - 0.4 * p[2], 0.4 * p[1] - 0.2 * p[0] + p[2]];
        let v: Vec<[f64; 3]> = x.iter().map(|&p| field(p)).collect();
        let wanted = 0.5 * DENSITY * integral(kind, &x, &|p| field(p).iter().map(|v| v * v).sum());
        assert!((energy(&m, &v) - wanted).abs() < 1e-13 * wanted, "{kind:?}: {} {wanted}", energy(&m, &v));
        let affine = Coordinates::of((0..kind.node_count()).map(|a| {
            let [x, y, z] = basis::node(kind.shape(), a);
            [1.1 * x + 0.1 * y, 0.2 * x + 0.9 * y + 0.1 * z, 1.2 * z - 0.1 * x]
        }));
        if basis::edges(kind.shape()).is_empty() {
            continue;
        }
        // Second-order elements represent quadratic fields on affine shapes.
        let field = |p: [f64; 3]| [p[0] * p[0] - p[1], p[1] * p[2] + 0.3 * p[2] * p[2], 1.0 - p[0] * p[1]];
        consistent(kind, &affine, DENSITY, &mut m);
        let v: Vec<[f64; 3]> = affine.iter().map(|&p| field(p)).collect();
        let wanted = 0.5 * DENSITY * integral(kind, &affine, &|p| field(p).iter().map(|v| v * v).sum());
        assert!((energy(&m, &v) - wanted).abs() < 1e-12 * wanted, "{kind:?}: {} {wanted}", energy(&m, &v));
    }
}

/// Every block against its integral, on an element whose edges are straight.
#[test]
fn consistent_masses_are_products_of_shape_functions() {
    for kind in ElementKind::SOLIDS {
        let x = straight(kind);
        let mut m = Stiffness::default();
        consistent(kind, &x, DENSITY, &mut m);
        // Row sums are the nodal volumes, which another rule integrates.
        let volumes = nodal_volumes(kind, &x);
        for (a, volume) in volumes.iter().enumerate() {
            let row: f64 = (0..kind.node_count()).map(|b| m.block(a.min(b), a.max(b))[0]).sum();
            assert!((row - DENSITY * volume).abs() < 1e-13, "{kind:?} node {a}: {row} {}", DENSITY * volume);
            let own = m.block(a, a);
            assert!(own[0] > 0.0 && own[0] == own[4] && own[4] == own[8]);
            assert!([1, 2, 3, 5, 6, 7].iter().all(|&i| own[i] == 0.0));
        }
    }
}

/// Known values: a tetrahedron has V/10 and V/20; its quadratic sibling V/70 at corners and 8 V/105 at edges.
#[test]
fn tetrahedra_have_the_masses_of_the_text_books() {
    let parent = |kind: ElementKind| Coordinates::of((0..kind.node_count()).map(|a| basis::node(kind.shape(), a)));
    let volume = 1.0 / 6.0;
    let mut m = Stiffness::default();
    consistent(ElementKind::C3D4, &parent(ElementKind::C3D4), 1.0, &mut m);
    assert!((m.block(0, 0)[0] - volume / 10.0).abs() < 1e-15 && (m.block(1, 3)[0] - volume / 20.0).abs() < 1e-15);
    consistent(ElementKind::C3D10, &parent(ElementKind::C3D10), 1.0, &mut m);
    assert!((m.block(2, 2)[0] - volume / 70.0).abs() < 1e-15);
    assert!((m.block(5, 5)[0] - volume * 8.0 / 105.0).abs() < 1e-15);
    // Scaled: 4 corners of 1/70 and 6 edges of 8/105 make 18/35.
    let nodal = lumped(ElementKind::C3D10, &parent(ElementKind::C3D10), 1.0);
    assert!((nodal[0] - volume / 36.0).abs() < 1e-15 && (nodal[9] - volume * 4.0 / 27.0).abs() < 1e-15);
}
