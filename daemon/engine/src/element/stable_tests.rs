//! Bounds of frequencies against eigenvalues of another routine.

use super::stable::{frequency_squared, increment, largest_eigenvalue};
use super::*;
use crate::model::{Connector, ElementKind};
use crate::solve::linear::{Dense, eigen};
use crate::test_mesh::TestMesh;

/// Numbers in [-1, 1) that repeat.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// An element with every node moved at random, as far as it stays one.
fn distorted(kind: ElementKind, random: &mut Random) -> Coordinates {
    loop {
        let flat = 0.05 + 0.95 * random.next().abs();
        let x = Coordinates::of((0..kind.node_count()).map(|a| {
            let [x, y, z] = basis::node(kind.shape(), a).map(|c| c + 0.12 * random.next());
            [x + 0.3 * y, y - 0.2 * z, flat * z]
        }));
        if jacobian_min(kind, &x) > 0.0 && mass::lumped(kind, &x, 1.0).iter().all(|m| *m > 0.0) {
            return x;
        }
    }
}

/// Largest eigenvalue of `M⁻¹ K` of elements that share nodes.
fn largest(count: usize, elements: &[(Vec<usize>, Stiffness)], masses: &[f64]) -> f64 {
    let n = 3 * count;
    let mut dense = Dense::zeros(n, n);
    for (ids, k) in elements {
        for (a, &p) in ids.iter().enumerate() {
            for (b, &q) in ids.iter().enumerate() {
                let block = k.block(a.min(b), a.max(b));
                for i in 0..3 {
                    for j in 0..3 {
                        let entry = if a <= b { block[3 * i + j] } else { block[3 * j + i] };
                        dense.values[(3 * q + j) * n + 3 * p + i] += entry / (masses[p] * masses[q]).sqrt();
                    }
                }
            }
        }
    }
    eigen(&dense).0[n - 1]
}

#[test]
fn bounds_of_elements_are_their_largest_eigenvalues_and_never_below() {
    let mut random = Random(11);
    for kind in ElementKind::SOLIDS {
        for trial in 0..40 {
            let x = distorted(kind, &mut random);
            let elasticity = Elasticity::new(210.0, [0.0, 0.3, 0.499, -0.4][trial % 4]);
            let mut k = Stiffness::default();
            stiffness(kind, &x, elasticity, &mut k);
            let masses = mass::lumped(kind, &x, 2.0);
            let bound = frequency_squared(&k, &masses);
            let ids: Vec<usize> = (0..masses.len()).collect();
            let exact = largest(masses.len(), &[(ids, k)], &masses);
            // The other routine has some 1e-14 too.
            assert!(bound >= exact * (1.0 - 1e-13), "{kind:?}: {bound} {exact}");
            assert!(bound <= exact * (1.0 + 1e-11), "{kind:?}: {bound} {exact}");
        }
    }
}

/// The mean over the elements of each node, weighted by mass, bounds what they do together.
#[test]
fn nodal_bounds_hold_for_meshes() {
    let mut random = Random(5);
    for kind in ElementKind::SOLIDS {
        let mut place = |x: [f64; 3]| std::array::from_fn(|i| x[i] * [1.0, 1.5, 0.4][i] + 0.03 * random.next());
        let places: std::cell::RefCell<_> = std::cell::RefCell::new(&mut place);
        let mesh = TestMesh::new(kind.shape(), [3, 2, 2], |x| (places.borrow_mut())(x));
        let count = mesh.nodes.len();
        let (mut masses, mut stiff) = (vec![0.0; count], vec![0.0; count]);
        let mut elements = Vec::new();
        let mut worst = 0.0f64;
        for (e, ids) in mesh.elements.iter().enumerate() {
            let x = mesh.coordinates(ids);
            let mut k = Stiffness::default();
            stiffness(kind, &x, Elasticity::new(if e % 3 == 0 { 900.0 } else { 210.0 }, 0.3), &mut k);
            let own = mass::lumped(kind, &x, 2.0);
            let bound = frequency_squared(&k, &own);
            worst = worst.max(bound);
            for (&n, m) in ids.iter().zip(&own) {
                masses[n] += m;
                stiff[n] += bound * m;
            }
            elements.push((ids.clone(), k));
        }
        let nodal = (0..count).map(|n| stiff[n] / masses[n]).fold(0.0, f64::max);
        let exact = largest(count, &elements, &masses);
        assert!(exact <= nodal && nodal <= worst * (1.0 + 1e-14), "{kind:?}: {exact} {nodal} {worst}");
        assert!(exact > 0.3 * nodal, "{kind:?}: {exact} {nodal}");
    }
}

/// Between 1/√3 and 1 of edge over wave speed: the triaxial mode of one cube is stiffer than a wave across many.
#[test]
fn a_cube_has_about_its_edge_over_the_speed_of_dilatational_waves() {
    let cube = |a: usize| basis::node(ElementKind::C3D8.shape(), a).map(|c| 1.5 * c);
    let x = Coordinates::of((0..8).map(cube));
    for nu in [0.0, 0.3, 0.49] {
        let elasticity = Elasticity::new(210.0, nu);
        let wave = ((elasticity.lambda + 2.0 * elasticity.mu) / 2.0).sqrt();
        let mut k = Stiffness::default();
        stiffness(ElementKind::C3D8, &x, elasticity, &mut k);
        let own = increment(frequency_squared(&k, &mass::lumped(ElementKind::C3D8, &x, 2.0)), 0.0);
        let triaxial =
            ((elasticity.lambda + 2.0 * elasticity.mu) / (3.0 * elasticity.lambda + 2.0 * elasticity.mu)).sqrt();
        let across = 3.0 / wave;
        assert!((own / across - triaxial).abs() < 1e-10, "{nu}: {} {triaxial}", own / across);
    }
}

#[test]
fn a_bar_has_its_length_over_its_wave_speed() {
    let ends = [[1.0, 2.0, 3.0], [3.0, -1.0, 9.0]];
    let (modulus, density, area) = (200.0, 2.0, 0.5);
    let bar = Connector::Bar { area };
    let mut k = Stiffness::default();
    connector::stiffness(ElementKind::T3D2, &ends, bar, modulus, &mut k);
    let masses = [0.5 * density * area * 7.0; 2];
    let wanted = 7.0 / f64::sqrt(modulus / density);
    assert!((increment(frequency_squared(&k, &masses), 0.0) - wanted).abs() < 1e-11 * wanted);
}

/// Two masses on a spring, closed forms: 2, 3, 1e6, 3 % of critical damping.
#[test]
fn masses_on_a_spring_have_the_increment_of_the_text_books() {
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-14, "{a} {b}");
    // k / m on a fixed point; k (1/m₁ + 1/m₂) for both.
    close(increment(1e6 / 2.0, 0.0), 0.002_828_427_124_746_19);
    let mut spring = Stiffness::default();
    let section = Connector::Spring { stiffness: 1e6, directions: [0, 0] };
    connector::stiffness(ElementKind::SpringA, &[[0.0; 3], [1.0, 2.0, 2.0]], section, 0.0, &mut spring);
    let pair = frequency_squared(&spring, &[2.0, 3.0]);
    close(increment(pair, 0.0), 0.002_190_890_230_020_664_4);
    close(increment(pair, 2.0 * 0.03 * pair.sqrt()), 0.002_126_149_201_995_684_4);
    let xi = 0.03f64;
    close(increment(pair, 2.0 * xi * pair.sqrt()), 2.0 / pair.sqrt() * ((1.0 + xi * xi).sqrt() - xi));
    // Damping alone: c Δt / 2 = m.
    close(increment(0.0, 4.0), 0.5);
    assert_eq!(increment(0.0, 0.0), f64::INFINITY);
}

#[test]
fn a_node_without_mass_under_stiffness_has_no_increment_and_one_without_either_no_say() {
    let mut k = Stiffness::default();
    connector::stiffness(
        ElementKind::SpringA,
        &[[0.0; 3], [1.0, 0.0, 0.0]],
        Connector::Spring { stiffness: 3.0, directions: [0, 0] },
        0.0,
        &mut k,
    );
    assert_eq!(frequency_squared(&k, &[1.0, 0.0]), f64::INFINITY);
    k.clear(2);
    assert_eq!(frequency_squared(&k, &[1.0, 0.0]), 0.0);
}

#[test]
fn eigenvalues_of_matrices_with_known_ones_are_found() {
    // Projections and multiples of the unit matrix, and orders from one to the largest.
    for n in [1, 2, 3, 24, 60] {
        let mut unit = vec![0.0; n * n];
        (0..n).for_each(|i| unit[i * n + i] = 7.0);
        assert!((largest_eigenvalue(&mut unit, n) - 7.0).abs() < 1e-10);
        let mut ones = vec![1e-30; n * n];
        assert!((largest_eigenvalue(&mut ones, n) / (n as f64 * 1e-30) - 1.0).abs() < 1e-11);
    }
    // Second differences: 2 − 2 cos(π n / (n + 1)).
    let n = 30;
    let mut chain = vec![0.0; n * n];
    for i in 0..n {
        chain[i * n + i] = 2.0;
        if i > 0 {
            chain[i * n + i - 1] = -1.0;
        }
    }
    let wanted = 2.0 + 2.0 * (std::f64::consts::PI / 31.0).cos();
    let found = largest_eigenvalue(&mut chain, n);
    assert!(found >= wanted && found < wanted * (1.0 + 1e-11));
}
