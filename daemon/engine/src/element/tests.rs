//! What every kind must do, one element at a time.

use super::*;
use crate::model::{ELEMENT_NODES_MAX, ElementKind};

fn elasticity() -> Elasticity {
    Elasticity::new(210.0, 0.3)
}

/// A distorted element with curved edges where it has midside nodes.
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

fn stiffness_of(kind: ElementKind, coordinates: &[[f64; 3]]) -> Stiffness {
    let mut out = Stiffness::default();
    stiffness(kind, coordinates, elasticity(), &mut out);
    out
}

/// Displacements `shift + gradient · x` at the nodes.
fn field(coordinates: &[[f64; 3]], gradient: [[f64; 3]; 3], shift: [f64; 3]) -> Vec<[f64; 3]> {
    let at = |x: &[f64; 3]| std::array::from_fn(|i| shift[i] + (0..3).map(|j| gradient[i][j] * x[j]).sum::<f64>());
    coordinates.iter().map(at).collect()
}

const GRADIENT: [[f64; 3]; 3] = [[1e-3, 2e-4, 0.0], [1e-4, -5e-4, 3e-4], [0.0, -2e-4, 7e-4]];

/// Displacements that no simple field describes.
fn rough(kind: ElementKind) -> Vec<[f64; 3]> {
    (0..kind.node_count()).map(|a| std::array::from_fn(|i| ((a * 3 + i) as f64 * 0.7).sin() * 1e-2)).collect()
}

#[test]
fn the_six_rigid_motions_need_no_force() {
    for kind in ElementKind::SOLIDS {
        let x = distorted(kind);
        let k = stiffness_of(kind, &x);
        for motion in 0..6 {
            let (mut shift, mut gradient) = ([0.0; 3], [[0.0; 3]; 3]);
            if motion < 3 {
                shift[motion] = 1.0;
            } else {
                gradient[(motion + 1) % 3][(motion + 2) % 3] = -1.0;
                gradient[(motion + 2) % 3][(motion + 1) % 3] = 1.0;
            }
            let u = field(&x, gradient, shift);
            let worst = k.force(&u).iter().flatten().fold(0.0f64, |m, f| m.max(f.abs()));
            assert!(worst < 1e-10, "{kind:?} motion {motion}: {worst}");
            let stress = stress(kind, &x, elasticity(), &u);
            assert!(stress.iter().flatten().all(|s| s.abs() < 1e-10), "{kind:?}");
        }
    }
}

#[test]
fn uniform_strain_gives_uniform_stress_at_points_and_nodes() {
    let expected = elasticity().stress(&GRADIENT);
    for kind in ElementKind::SOLIDS {
        let x = distorted(kind);
        let points = stress(kind, &x, elasticity(), &field(&x, GRADIENT, [0.3, 0.1, -0.2]));
        let nodes = extrapolate(kind, &points);
        assert_eq!(nodes.len(), kind.node_count());
        for s in points.iter().chain(&nodes) {
            for (value, wanted) in s.iter().zip(expected) {
                assert!((value - wanted).abs() < 1e-12, "{kind:?}: {value} {wanted}");
            }
        }
    }
}

/// On straight-sided elements the nodal forces of a uniform stress are those of its tractions on the faces.
#[test]
fn uniform_stress_is_in_balance_with_tractions_on_the_faces() {
    let s = elasticity().stress(&GRADIENT);
    let tensor = [[s[0], s[3], s[4]], [s[3], s[1], s[5]], [s[4], s[5], s[2]]];
    for kind in ElementKind::SOLIDS {
        let shape = kind.shape();
        let straight = Coordinates::of((0..kind.node_count()).map(|a| {
            let [x, y, z] = basis::node(shape, a);
            // Linear along every edge: midside nodes stay halfway.
            [1.1 * x + 0.1 * y, 0.2 * x + 0.9 * y + 0.1 * z + 0.05 * x * z, 1.2 * z + 0.07 * x * y - 0.1 * x]
        }));
        let straight = straighten(kind, &straight);
        let f = stiffness_of(kind, &straight).force(&field(&straight, GRADIENT, [0.0; 3]));
        let mut by_traction = vec![[0.0; 3]; kind.node_count()];
        for local in shape.faces() {
            let nodes: Vec<[f64; 3]> = local.iter().map(|&a| straight[a as usize]).collect();
            for (&a, area) in local.iter().zip(face::nodal_area_vectors(&nodes)) {
                for i in 0..3 {
                    by_traction[a as usize][i] += (0..3).map(|j| tensor[i][j] * area[j]).sum::<f64>();
                }
            }
        }
        for (a, wanted) in by_traction.iter().enumerate() {
            for i in 0..3 {
                assert!((f[a][i] - wanted[i]).abs() < 1e-12, "{kind:?} node {a}: {} {}", f[a][i], wanted[i]);
            }
        }
    }
}

/// Midside nodes put halfway between their corners.
fn straighten(kind: ElementKind, x: &[[f64; 3]]) -> Coordinates {
    let mut out: Vec<[f64; 3]> = x.to_vec();
    for face in kind.shape().faces().iter().filter(|f| f.len() > 4) {
        let corners = face.len() / 2;
        for i in 0..corners {
            let (a, b) = (x[face[i] as usize], x[face[(i + 1) % corners] as usize]);
            out[face[corners + i] as usize] = std::array::from_fn(|d| 0.5 * (a[d] + b[d]));
        }
    }
    Coordinates::of(out.into_iter())
}

#[test]
fn the_force_is_the_derivative_of_the_energy() {
    for kind in ElementKind::SOLIDS {
        let x = distorted(kind);
        let k = stiffness_of(kind, &x);
        let u = rough(kind);
        let energy = |u: &[[f64; 3]]| {
            let f = k.force(u);
            0.5 * u.iter().zip(&f).map(|(u, f)| (0..3).map(|i| u[i] * f[i]).sum::<f64>()).sum::<f64>()
        };
        let f = k.force(&u);
        for a in 0..kind.node_count() {
            for i in 0..3 {
                let mut shifted = u.clone();
                shifted[a][i] += 1e-4;
                let up = energy(&shifted);
                shifted[a][i] -= 2e-4;
                let slope = (up - energy(&shifted)) / 2e-4;
                assert!((slope - f[a][i]).abs() < 1e-8, "{kind:?} node {a} direction {i}: {slope} {}", f[a][i]);
            }
        }
    }
}

/// Energy from the stresses at the integration points: independent of the blocks. Not for C3D8R, whose hourglass stiffness
/// stores energy without stress, and not for C3D8, which `brick.rs` tests.
#[test]
fn the_energy_is_that_of_the_stresses() {
    let nu = 0.3;
    for kind in ElementKind::SOLIDS
        .into_iter()
        .filter(|k| !matches!(k, ElementKind::C3D8 | ElementKind::C3D8R | ElementKind::C3D8RCalculix))
    {
        let x = distorted(kind);
        let u = rough(kind);
        let f = stiffness_of(kind, &x).force(&u);
        let by_force: f64 = u.iter().zip(&f).map(|(u, f)| (0..3).map(|i| u[i] * f[i]).sum::<f64>()).sum();
        let density = |s: &[f64; 6]| {
            let trace = s[0] + s[1] + s[2];
            let square = s[0] * s[0] + s[1] * s[1] + s[2] * s[2] + 2.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]);
            ((1.0 + nu) * square - nu * trace * trace) / 210.0
        };
        let table = table::of(kind);
        let volumes = table.points.iter().map(|p| {
            let mut j = [[0.0; 3]; 3];
            for (x, d) in x.iter().zip(&p.basis.derivative) {
                for r in 0..3 {
                    for s in 0..3 {
                        j[r][s] += d[r] * x[s];
                    }
                }
            }
            p.weight * face_determinant(&j)
        });
        let points = stress(kind, &x, elasticity(), &u);
        // The eight points of bricks are numbered like the corners; volumes of the table run along ξ first.
        let order: Vec<usize> =
            if kind.node_count() == 8 { vec![0, 1, 3, 2, 4, 5, 7, 6] } else { (0..points.len()).collect() };
        let by_stress: f64 = volumes.zip(order).map(|(v, g)| v * density(&points[g])).sum();
        assert!((by_force - by_stress).abs() < 1e-11 * by_stress, "{kind:?}: {by_force} {by_stress}");
    }
}

fn face_determinant(j: &[[f64; 3]; 3]) -> f64 {
    quad::dot(j[0], quad::cross(j[1], j[2]))
}

/// Eigenvalues of a symmetric matrix by Jacobi rotations.
fn eigenvalues(mut m: Vec<Vec<f64>>) -> Vec<f64> {
    let n = m.len();
    for _ in 0..60 {
        let mut off = 0.0f64;
        for p in 0..n {
            for q in p + 1..n {
                off = off.max(m[p][q].abs());
                if m[p][q].abs() < 1e-300 {
                    continue;
                }
                let theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
                let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let (c, s) = (1.0 / (t * t + 1.0).sqrt(), t / (t * t + 1.0).sqrt());
                for row in &mut m {
                    let (a, b) = (row[p], row[q]);
                    (row[p], row[q]) = (c * a - s * b, s * a + c * b);
                }
                for k in 0..n {
                    let (a, b) = (m[p][k], m[q][k]);
                    (m[p][k], m[q][k]) = (c * a - s * b, s * a + c * b);
                }
            }
        }
        if off < 1e-13 {
            break;
        }
    }
    let mut values: Vec<f64> = (0..n).map(|i| m[i][i]).collect();
    values.sort_by(f64::total_cmp);
    values
}

/// Motions without energy of elements that share nodes.
fn free_motions(kind: ElementKind, nodes: usize, elements: &[(Vec<usize>, Coordinates)]) -> usize {
    let n = 3 * nodes;
    let mut dense = vec![vec![0.0; n]; n];
    for (ids, x) in elements {
        let k = stiffness_of(kind, x);
        for a in 0..ids.len() {
            for i in 0..3 {
                let mut u = [[0.0; 3]; ELEMENT_NODES_MAX];
                u[a][i] = 1.0;
                for (&id, f) in ids.iter().zip(k.force(&u)) {
                    for j in 0..3 {
                        dense[3 * id + j][3 * ids[a] + i] += f[j];
                    }
                }
            }
        }
    }
    let values = eigenvalues(dense);
    assert!(values[0] > -1e-9 * values[n - 1], "{kind:?}: {}", values[0]);
    values.iter().filter(|v| v.abs() < 1e-9 * values[n - 1]).count()
}

/// Six for every kind, but for two that Abaqus and CalculiX integrate at so few points that a lone element has more.
#[test]
fn only_rigid_motions_are_free() {
    for kind in ElementKind::SOLIDS {
        let expected = match kind {
            ElementKind::C3D6 => 7,
            ElementKind::C3D20R => 12,
            _ => 6,
        };
        let ids: Vec<usize> = (0..kind.node_count()).collect();
        assert_eq!(free_motions(kind, ids.len(), &[(ids, distorted(kind))]), expected, "{kind:?}");
    }
}

/// What a lone C3D6 has too much, its neighbours do not share; of C3D20R one motion survives in a row, none in a slab.
#[test]
fn the_surplus_motions_of_lone_elements_vanish_in_meshes() {
    let cases = [
        (ElementKind::C3D6, [1, 1, 1]),
        (ElementKind::C3D6, [1, 1, 2]),
        (ElementKind::C3D20R, [2, 2, 1]),
        (ElementKind::C3D4, [1, 1, 1]),
    ];
    for (kind, cells) in cases {
        let place = |[x, y, z]: [f64; 3]| [x + 0.1 * y * z, y - 0.1 * x * z, 1.1 * z + 0.05 * x];
        let mesh = crate::test_mesh::TestMesh::new(kind.shape(), cells, place);
        let elements: Vec<_> = mesh.elements.iter().map(|ids| (ids.clone(), mesh.coordinates(ids))).collect();
        assert_eq!(free_motions(kind, mesh.nodes.len(), &elements), 6, "{kind:?} {cells:?}");
    }
}

#[test]
fn nodal_volumes_add_up_and_quadratic_corners_are_negative() {
    for kind in ElementKind::SOLIDS {
        let x = Coordinates::of((0..kind.node_count()).map(|a| basis::node(kind.shape(), a)));
        let volumes = nodal_volumes(kind, &x);
        let parent = match kind.node_count() {
            4 | 10 => 1.0 / 6.0,
            6 | 15 => 1.0,
            _ => 8.0,
        };
        assert!((volumes.iter().sum::<f64>() - parent).abs() < 1e-13, "{kind:?}");
        match kind.node_count() {
            4 | 6 | 8 => assert!(volumes.iter().all(|v| (v - volumes[0]).abs() < 1e-14), "{kind:?}"),
            // −V/20 and V/5; −V/8 and V/6.
            10 => assert!((volumes[0] + parent / 20.0).abs() < 1e-14 && (volumes[4] - parent / 5.0).abs() < 1e-14),
            20 => assert!((volumes[0] + parent / 8.0).abs() < 1e-13 && (volumes[8] - parent / 6.0).abs() < 1e-13),
            _ => assert!(volumes[0] < 0.0 && volumes[6] > 0.0),
        }
        assert!(jacobian_min(kind, &x) > 0.0);
    }
}

#[test]
fn a_mirrored_element_has_no_positive_jacobian() {
    for kind in ElementKind::SOLIDS {
        let mirrored = Coordinates::of(distorted(kind).iter().map(|&[x, y, z]| [x, y, -z]));
        assert!(jacobian_min(kind, &mirrored) < 0.0, "{kind:?}");
    }
}

/// Near incompressibility: mean dilatation keeps C3D8 soft, C3D8I and C3D8R stay finite, the full brick locks.
#[test]
fn a_bent_brick_is_soft_with_incompatible_modes() {
    let cube: Vec<[f64; 3]> = (0..8).map(|a| basis::node(ElementKind::C3D8.shape(), a)).collect();
    // Pure bending in the plane 1-3: u1 = x z, at the nodes only.
    let u: Vec<[f64; 3]> = cube.iter().map(|&[x, _, z]| [x * z, 0.0, 0.0]).collect();
    let energy = |kind| {
        let mut k = Stiffness::default();
        stiffness(kind, &cube, Elasticity::new(1.0, 0.0), &mut k);
        u.iter().zip(k.force(&u)).map(|(u, f)| 0.5 * u[0] * f[0]).sum::<f64>()
    };
    // Beam theory with ν = 0: ½ ∫ z² dV = 4/3; the shear of the plain brick adds ½ · ½ ∫ x² dV = 2/3.
    assert!((energy(ElementKind::C3D8I) - 4.0 / 3.0).abs() < 1e-12);
    assert!((energy(ElementKind::C3D8Full) - 2.0).abs() < 1e-12);
    assert!((energy(ElementKind::C3D8) - 4.0 / 3.0) > 0.1);
    assert!(energy(ElementKind::C3D8R) < 4.0 / 3.0);
}
