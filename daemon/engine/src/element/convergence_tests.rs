//! Meshes of every kind against smooth and beam solutions: rates, bending.

use super::*;
use crate::model::{ElementKind, ElementShape};
use crate::test_mesh::TestMesh;

/// Nodal solution of `K u = f` with prescribed directions, by conjugate gradients on element matrices.
fn solve(
    mesh: &TestMesh,
    kind: ElementKind,
    elasticity: Elasticity,
    force: &[f64],
    prescribed: &[Option<f64>],
) -> Vec<f64> {
    let matrices: Vec<Stiffness> = mesh
        .elements
        .iter()
        .map(|nodes| {
            let mut k = Stiffness::default();
            stiffness(kind, &mesh.coordinates(nodes), elasticity, &mut k);
            k
        })
        .collect();
    let multiply = |u: &[f64]| {
        let mut out = vec![0.0; u.len()];
        for (nodes, k) in mesh.elements.iter().zip(&matrices) {
            let local: Vec<[f64; 3]> = nodes.iter().map(|&n| std::array::from_fn(|i| u[3 * n + i])).collect();
            for (&n, f) in nodes.iter().zip(k.force(&local)) {
                for i in 0..3 {
                    out[3 * n + i] += f[i];
                }
            }
        }
        out
    };
    let mut u: Vec<f64> = prescribed.iter().map(|p| p.unwrap_or(0.0)).collect();
    let free = |v: &mut Vec<f64>| v.iter_mut().zip(prescribed).filter(|(_, p)| p.is_some()).for_each(|(v, _)| *v = 0.0);
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut r: Vec<f64> = force.iter().zip(multiply(&u)).map(|(f, k)| f - k).collect();
    free(&mut r);
    let (mut p, mut rr) = (r.clone(), dot(&r, &r));
    let target = 1e-22 * rr;
    for _ in 0..20_000 {
        if rr <= target {
            return u;
        }
        let mut kp = multiply(&p);
        free(&mut kp);
        let alpha = rr / dot(&p, &kp);
        for i in 0..u.len() {
            u[i] += alpha * p[i];
            r[i] -= alpha * kp[i];
        }
        let next = dot(&r, &r);
        for i in 0..p.len() {
            p[i] = r[i] + next / rr * p[i];
        }
        rr = next;
    }
    panic!("conjugate gradients did not converge for {kind:?}");
}

/// `u_i = sin(k_i · x + φ_i)`.
const WAVES: [[f64; 3]; 3] = [[1.3, 0.8, -0.5], [0.4, 1.5, 0.9], [-0.7, 0.6, 1.4]];
const PHASES: [f64; 3] = [0.2, -0.4, 0.9];

fn phase(j: usize, x: [f64; 3]) -> f64 {
    (0..3).map(|i| WAVES[j][i] * x[i]).sum::<f64>() + PHASES[j]
}

fn exact(x: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|j| phase(j, x).sin())
}

/// `−(λ + μ) ∇ div u − μ Δu`.
fn body_force(e: Elasticity, x: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| {
        let square: f64 = WAVES[i].iter().map(|k| k * k).sum();
        let gradient: f64 = (0..3).map(|j| WAVES[j][j] * WAVES[j][i] * phase(j, x).sin()).sum();
        (e.lambda + e.mu) * gradient + e.mu * square * phase(i, x).sin()
    })
}

/// A rule of 27 points on any shape, exact far beyond what the elements need.
fn fine_rule(shape: ElementShape) -> Vec<([f64; 3], f64)> {
    let unit = |x: f64| 0.5 * (1.0 + x);
    hexahedron::rule_27()
        .into_iter()
        .map(|([x, y, z], w)| {
            let (u, v, t) = (unit(x), unit(y), unit(z));
            match shape {
                ElementShape::Hexahedron8 | ElementShape::Hexahedron20 => ([x, y, z], w),
                ElementShape::Wedge6 | ElementShape::Wedge15 => ([u, v * (1.0 - u), z], 0.25 * w * (1.0 - u)),
                _ => {
                    let at = [u, v * (1.0 - u), t * (1.0 - u) * (1.0 - v)];
                    (at, 0.125 * w * (1.0 - u) * (1.0 - u) * (1.0 - v))
                }
            }
        })
        .collect()
}

/// Calls `visit(nodes, basis, position, volume)` at every fine integration point of the mesh.
fn integrate(mesh: &TestMesh, shape: ElementShape, mut visit: impl FnMut(&[usize], &basis::Basis, [f64; 3], f64)) {
    let samples: Vec<_> = fine_rule(shape).into_iter().map(|(n, w)| (basis::evaluate(shape, n), w)).collect();
    for nodes in &mesh.elements {
        let x = mesh.coordinates(nodes);
        for (basis, weight) in &samples {
            let mut j = [[0.0; 3]; 3];
            let mut at = [0.0; 3];
            for (a, x) in x.iter().enumerate() {
                for r in 0..3 {
                    at[r] += basis.value[a] * x[r];
                    for s in 0..3 {
                        j[r][s] += basis.derivative[a][r] * x[s];
                    }
                }
            }
            visit(nodes, basis, at, weight * quad::dot(j[0], quad::cross(j[1], j[2])));
        }
    }
}

/// L2 error of the displacement on the unit cube with `n` cells along each edge.
fn error(kind: ElementKind, n: usize) -> f64 {
    let e = Elasticity::new(1.0, 0.3);
    let shape = kind.shape();
    // Smoothly distorted: nodes of the boundary stay on it.
    let bend = |[x, y, z]: [f64; 3]| {
        let b = 0.6 * x * (1.0 - x) * y * (1.0 - y) * z * (1.0 - z);
        [x + b, y - 0.7 * b, z + 0.5 * b]
    };
    let mesh = TestMesh::new(shape, [n; 3], bend);
    let mut force = vec![0.0; 3 * mesh.nodes.len()];
    integrate(&mesh, shape, |nodes, basis, at, volume| {
        let f = body_force(e, at);
        for (a, &node) in nodes.iter().enumerate() {
            for i in 0..3 {
                force[3 * node + i] += volume * basis.value[a] * f[i];
            }
        }
    });
    let outside = |x: &[f64; 3]| x.iter().any(|&c| c.abs() < 1e-12 || (c - 1.0).abs() < 1e-12);
    let prescribed: Vec<Option<f64>> =
        mesh.nodes.iter().flat_map(|x| exact(*x).map(|u| outside(x).then_some(u))).collect();
    let u = solve(&mesh, kind, e, &force, &prescribed);
    let mut square = 0.0;
    integrate(&mesh, shape, |nodes, basis, at, volume| {
        let wanted = exact(at);
        for i in 0..3 {
            let found: f64 = nodes.iter().enumerate().map(|(a, &node)| basis.value[a] * u[3 * node + i]).sum();
            square += volume * (found - wanted[i]).powi(2);
        }
    });
    square.sqrt()
}

#[test]
fn displacements_converge_at_the_rate_of_the_kind() {
    for kind in ElementKind::SOLIDS {
        let quadratic = kind.node_count() > 8;
        let (n, rate_min) = if quadratic { (2, 2.75) } else { (4, 1.8) };
        let (coarse, fine) = (error(kind, n), error(kind, 2 * n));
        let rate = (coarse / fine).log2();
        assert!(rate > rate_min && rate < rate_min + 1.3, "{kind:?}: {coarse:.3e} {fine:.3e} rate {rate:.3}");
    }
}

/// Tip deflection over that of a Timoshenko beam of length 10 and section 1 x 1 under a tip force.
fn cantilever(kind: ElementKind, divisions: [usize; 3]) -> f64 {
    let shape = kind.shape();
    let e = Elasticity::new(1.0, 0.3);
    let mesh = TestMesh::new(shape, divisions, |[x, y, z]| [10.0 * x, y, z]);
    let mut force = vec![0.0; 3 * mesh.nodes.len()];
    for nodes in &mesh.elements {
        for face in shape.faces() {
            let nodes: Vec<usize> = face.iter().map(|&a| nodes[a as usize]).collect();
            let x: Vec<[f64; 3]> = nodes.iter().map(|&n| mesh.nodes[n]).collect();
            if x.iter().all(|x| (x[0] - 10.0).abs() < 1e-12) {
                for (&n, area) in nodes.iter().zip(face::nodal_areas(&x)) {
                    force[3 * n + 2] += area;
                }
            }
        }
    }
    let prescribed: Vec<Option<f64>> = mesh.nodes.iter().flat_map(|x| [(x[0] < 1e-12).then_some(0.0); 3]).collect();
    let u = solve(&mesh, kind, e, &force, &prescribed);
    let tip = mesh.nodes.iter().position(|x| x[0] > 9.999 && x[1] < 1e-9 && x[2] < 1e-9).expect("a tip corner");
    let (bending, shear) = (1000.0 / (3.0 / 12.0), 10.0 / (5.0 / 6.0 * e.mu));
    u[3 * tip + 2] / (bending + shear)
}

#[test]
fn incompatible_modes_and_quadratic_elements_bend_where_plain_bricks_lock() {
    let cases = [
        (ElementKind::C3D8, [5, 1, 1], 0.0, 0.75),
        (ElementKind::C3D8Full, [5, 1, 1], 0.0, 0.75),
        (ElementKind::C3D8I, [5, 1, 1], 0.96, 1.01),
        (ElementKind::C3D8I, [10, 1, 1], 0.97, 1.01),
        (ElementKind::C3D20, [5, 1, 1], 0.96, 1.01),
        (ElementKind::C3D20R, [5, 1, 1], 0.97, 1.02),
        (ElementKind::C3D10, [5, 1, 1], 0.90, 1.01),
        (ElementKind::C3D15, [5, 1, 1], 0.93, 1.01),
        (ElementKind::C3D8R, [20, 4, 4], 0.95, 1.1),
        (ElementKind::C3D4, [5, 1, 1], 0.0, 0.4),
        (ElementKind::C3D6, [5, 1, 1], 0.0, 0.75),
    ];
    for (kind, divisions, low, high) in cases {
        let ratio = cantilever(kind, divisions);
        assert!(ratio > low && ratio < high, "{kind:?} {divisions:?}: {ratio:.4}");
    }
}
