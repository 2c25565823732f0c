//! Block matrices against dense ones, on meshes of mixed kinds.

use super::block_matrix::BlockMatrix;
use crate::element::{self, Elasticity, Stiffness};
use crate::model::{ElementKind, Mesh, NodeId};
use crate::test_mesh::TestMesh;

/// Numbers in [-1, 1) that repeat.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vectors(&mut self, count: usize) -> Vec<[f64; 3]> {
        (0..count).map(|_| std::array::from_fn(|_| self.next())).collect()
    }
}

/// Boxes of several kinds side by side, numbered at random, with bars between them and a node of its own.
fn mixed(random: &mut Random) -> Mesh {
    let mut mesh = Mesh::default();
    let mut elements = Vec::new();
    for kind in ElementKind::SOLIDS {
        let place = |x: [f64; 3]| [x[0] + 0.1 * x[1] * x[2], x[1] - 0.1 * x[0], x[2] + 0.05 * x[0] * x[1]];
        let part = TestMesh::new(kind.shape(), [2, 1, 1], place);
        let base = mesh.nodes.len();
        mesh.nodes.extend(&part.nodes);
        elements.extend(part.elements.iter().map(|nodes| (kind, nodes.iter().map(|n| base + n).collect::<Vec<_>>())));
    }
    let count = mesh.nodes.len() + 1;
    for _ in 0..20 {
        let end = |r: &mut Random| ((r.next() + 1.0) / 2.0 * (count - 1) as f64) as usize;
        let ends = vec![end(random), end(random)];
        elements.push((ElementKind::T3D2, ends));
    }
    mesh.nodes.push([9.0; 3]);
    let mut order: Vec<usize> = (0..count).collect();
    for i in (1..count).rev() {
        order.swap(i, ((random.next() + 1.0) / 2.0 * (i + 1) as f64) as usize);
    }
    let mut nodes = vec![[0.0; 3]; count];
    for (from, &to) in order.iter().enumerate() {
        nodes[to] = mesh.nodes[from];
    }
    mesh.nodes = nodes;
    for (kind, nodes) in elements {
        let ids: Vec<NodeId> = nodes.iter().map(|&n| NodeId(order[n] as u32)).collect();
        mesh.elements.push(kind, &ids);
    }
    mesh
}

/// Matrix of an element: its stiffness, or for bars anything symmetric.
fn matrix(mesh: &Mesh, e: u32, out: &mut Stiffness) {
    let kind = mesh.elements.kind(e as usize);
    if kind.is_solid() {
        element::stiffness(kind, &super::assembly::coordinates(mesh, e), Elasticity::new(210.0, 0.3), out);
        return;
    }
    let mut random = Random(u64::from(e));
    let mut blocks: [[f64; 9]; 3] = std::array::from_fn(|_| std::array::from_fn(|_| random.next()));
    for own in [0, 2] {
        for (i, j) in [(1, 0), (2, 0), (2, 1)] {
            blocks[own][3 * i + j] = blocks[own][3 * j + i];
        }
    }
    out.set(2, &blocks);
}

/// The same sum as a dense matrix, row by row.
fn dense(mesh: &Mesh) -> Vec<Vec<f64>> {
    let n = 3 * mesh.nodes.len();
    let mut out = vec![vec![0.0; n]; n];
    let mut k = Stiffness::default();
    for e in 0..mesh.elements.len() {
        matrix(mesh, e as u32, &mut k);
        let nodes = mesh.elements.nodes(e);
        for a in 0..nodes.len() {
            for b in 0..nodes.len() {
                let block = k.block(a.min(b), a.max(b));
                for i in 0..3 {
                    for j in 0..3 {
                        let entry = if a <= b { block[3 * i + j] } else { block[3 * j + i] };
                        out[3 * nodes[a].index() + i][3 * nodes[b].index() + j] += entry;
                    }
                }
            }
        }
    }
    out
}

fn apply(matrix: &[Vec<f64>], x: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let row = |r: &Vec<f64>| r.iter().zip(x.as_flattened()).map(|(a, x)| a * x).sum::<f64>();
    matrix.chunks(3).map(|rows| std::array::from_fn(|d| row(&rows[d]))).collect()
}

fn difference(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn products_are_those_of_the_dense_matrix() {
    for seed in 1..6 {
        let mut random = Random(seed);
        let mesh = mixed(&mut random);
        let wanted = dense(&mesh);
        let size = wanted.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        let k = BlockMatrix::assemble(&mesh, &mut |e, out| matrix(&mesh, e, out));
        assert_eq!(k.len(), mesh.nodes.len());
        let x = random.vectors(mesh.nodes.len());
        let mut y = random.vectors(mesh.nodes.len());
        let before = y.clone();
        k.multiply_add(-0.7, &x, &mut y);
        let kx = apply(&wanted, &x);
        let sum: Vec<[f64; 3]> =
            before.iter().zip(&kx).map(|(b, k)| std::array::from_fn(|d| b[d] - 0.7 * k[d])).collect();
        assert!(difference(&y, &sum) < 1e-13 * size, "{}", difference(&y, &sum));
        k.multiply(&x, &mut y);
        assert!(difference(&y, &kx) < 1e-13 * size);
        for node in 0..mesh.nodes.len() {
            let own = k.diagonal(NodeId(node as u32));
            for (at, value) in own.iter().enumerate() {
                let entry = wanted[3 * node + at / 3][3 * node + at % 3];
                assert!((value - entry).abs() < 1e-13 * size);
            }
        }
    }
}

#[test]
fn it_is_symmetric_and_gives_the_same_bits_every_time() {
    let mut random = Random(7);
    let mesh = mixed(&mut random);
    let assemble = || BlockMatrix::assemble(&mesh, &mut |e, out| matrix(&mesh, e, out));
    let (x, z) = (random.vectors(mesh.nodes.len()), random.vectors(mesh.nodes.len()));
    let k = assemble();
    let product = |k: &BlockMatrix, x: &[[f64; 3]]| {
        let mut y = vec![[1.0; 3]; x.len()];
        k.multiply(x, &mut y);
        y
    };
    let dot =
        |a: &[[f64; 3]], b: &[[f64; 3]]| a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| a * b).sum::<f64>();
    let (kx, kz) = (product(&k, &x), product(&k, &z));
    assert!((dot(&z, &kx) - dot(&x, &kz)).abs() < 1e-11 * dot(&kx, &kx).sqrt());
    assert_eq!(kx, product(&assemble(), &x));
}

#[test]
fn nodes_that_nothing_couples_take_no_blocks() {
    let mesh = mixed(&mut Random(3));
    let count = mesh.nodes.len();
    let masses = BlockMatrix::assemble(&mesh, &mut |e, out| {
        out.set_diagonal(&vec![f64::from(e); mesh.elements.nodes(e as usize).len()]);
    });
    assert_eq!(masses.blocks(), count);
    let empty = BlockMatrix::assemble(&mesh, &mut |e, out| {
        out.clear(mesh.elements.nodes(e as usize).len());
    });
    assert_eq!(empty.blocks(), count);
    let mut y = vec![[1.0; 3]; count];
    empty.multiply(&Random(1).vectors(count), &mut y);
    assert!(y.iter().all(|y| *y == [0.0; 3]));
}

/// A brick collapsed into a wedge names two nodes twice.
#[test]
fn a_node_that_an_element_names_twice_gets_all_its_parts() {
    let corners = [0u32, 1, 2, 2, 3, 4, 5, 5].map(NodeId);
    let places = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];
    let mut mesh = Mesh { nodes: places.to_vec(), ..Mesh::default() };
    mesh.elements.push(ElementKind::C3D8, &corners);
    let k = BlockMatrix::assemble(&mesh, &mut |e, out| matrix(&mesh, e, out));
    let x = Random(5).vectors(6);
    let mut y = x.clone();
    k.multiply(&x, &mut y);
    assert!(difference(&y, &apply(&dense(&mesh), &x)) < 1e-11);
}
