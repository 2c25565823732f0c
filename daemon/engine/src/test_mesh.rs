//! Boxes of elements of any shape, for tests.

use std::collections::BTreeMap;

use crate::element::{Coordinates, basis};
use crate::model::ElementShape;

/// Nodes and elements of a box.
pub struct TestMesh {
    /// Coordinates.
    pub nodes: Vec<[f64; 3]>,
    /// Nodes of each element in the order of the manual.
    pub elements: Vec<Vec<usize>>,
}

/// Corners of the elements that fill a hexahedron.
fn parts(shape: ElementShape) -> &'static [&'static [usize]] {
    match shape {
        ElementShape::Hexahedron8 | ElementShape::Hexahedron20 => &[&[0, 1, 2, 3, 4, 5, 6, 7]],
        ElementShape::Wedge6 | ElementShape::Wedge15 => &[&[0, 1, 3, 4, 5, 7], &[1, 2, 3, 5, 6, 7]],
        _ => &[&[0, 1, 2, 6], &[0, 2, 3, 6], &[0, 3, 7, 6], &[0, 7, 4, 6], &[0, 4, 5, 6], &[0, 5, 1, 6]],
    }
}

impl TestMesh {
    /// The unit cube in cells, its corner nodes moved by `place`; midside nodes halfway between the moved corners.
    pub fn new(shape: ElementShape, cells: [usize; 3], place: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        let [p, q, r] = cells;
        let mut nodes = Vec::new();
        for k in 0..=r {
            for j in 0..=q {
                for i in 0..=p {
                    nodes.push(place([i as f64 / p as f64, j as f64 / q as f64, k as f64 / r as f64]));
                }
            }
        }
        let corner = |i: usize, j: usize, k: usize| (k * (q + 1) + j) * (p + 1) + i;
        let mut elements = Vec::new();
        for (i, j, k) in (0..r).flat_map(|k| (0..q).flat_map(move |j| (0..p).map(move |i| (i, j, k)))) {
            let ring = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            let hexahedron: Vec<usize> = [k, k + 1].iter().flat_map(|&k| ring.map(|(i, j)| corner(i, j, k))).collect();
            elements.extend(parts(shape).iter().map(|part| part.iter().map(|&a| hexahedron[a]).collect::<Vec<_>>()));
        }
        let mut middles = BTreeMap::new();
        for element in &mut elements {
            for edge in basis::edges(shape) {
                let (a, b) = (element[edge[0]], element[edge[1]]);
                let middle = *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    nodes.push(std::array::from_fn(|i| 0.5 * (nodes[a][i] + nodes[b][i])));
                    nodes.len() - 1
                });
                element.push(middle);
            }
        }
        Self { nodes, elements }
    }

    /// Coordinates of an element's nodes.
    pub fn coordinates(&self, nodes: &[usize]) -> Coordinates {
        Coordinates::of(nodes.iter().map(|&n| self.nodes[n]))
    }
}
