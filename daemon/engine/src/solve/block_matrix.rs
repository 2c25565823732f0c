//! Symmetric matrix of 3 x 3 blocks over all nodes of a mesh, for products with nodal vectors.
//!
//! The diagonal block of a node and the blocks of the later nodes that it is coupled to stand one after another, rows in the order of
//! the nodes. A product reads every block once and uses it twice, `y_i += A x_j` and `y_j += Aᵀ x_i`: it takes about the time in
//! which the memory delivers the blocks. Sums run in the order of the blocks, so equal inputs give equal bits.

use crate::element::Stiffness;
use crate::model::{Mesh, NodeId};

/// Symmetric block matrix: stiffness [force/length], mass or damping.
pub struct BlockMatrix {
    /// Start of each node's blocks; one more than there are nodes.
    starts: Vec<usize>,
    /// Node of each block's column; the first of each row is the row's own.
    columns: Vec<u32>,
    /// Blocks, row-major.
    blocks: Vec<[f64; 9]>,
}

impl BlockMatrix {
    /// Sums up the matrices of all elements, which `element` gives once each, ascending.
    ///
    /// Blocks off the diagonal that stay exactly zero are dropped: lumped masses give a block diagonal, and elements without
    /// stiffness couple nothing.
    pub fn assemble(mesh: &Mesh, element: &mut dyn FnMut(u32, &mut Stiffness)) -> Self {
        let mut out = Self::pattern(mesh);
        let mut matrix = Stiffness::default();
        for e in 0..mesh.elements.len() {
            element(e as u32, &mut matrix);
            out.add(mesh.elements.nodes(e), &matrix);
        }
        out.compact();
        out
    }

    /// Zeros wherever elements couple nodes, and on the diagonal.
    fn pattern(mesh: &Mesh) -> Self {
        let nodes = mesh.nodes.len();
        // Elements at each node as its lowest-numbered occurrences come: counting sort.
        let mut begin = vec![0u32; nodes + 1];
        for (_, element) in mesh.elements.iter() {
            element.iter().for_each(|n| begin[n.index() + 1] += 1);
        }
        for i in 0..nodes {
            begin[i + 1] += begin[i];
        }
        let mut fill = begin.clone();
        let mut incident = vec![0u32; begin[nodes] as usize];
        for (e, (_, element)) in mesh.elements.iter().enumerate() {
            for n in element {
                let slot = &mut fill[n.index()];
                incident[*slot as usize] = e as u32;
                *slot += 1;
            }
        }
        let mut mark = vec![u32::MAX; nodes];
        let mut starts = Vec::with_capacity(nodes + 1);
        let mut columns = Vec::with_capacity(15 * nodes);
        starts.push(0);
        for i in 0..nodes as u32 {
            mark[i as usize] = i;
            let first = columns.len();
            columns.push(i);
            for &e in &incident[begin[i as usize] as usize..begin[i as usize + 1] as usize] {
                for j in mesh.elements.nodes(e as usize).iter().map(|n| n.0).filter(|&j| j > i) {
                    if mark[j as usize] != i {
                        mark[j as usize] = i;
                        columns.push(j);
                    }
                }
            }
            columns[first..].sort_unstable();
            starts.push(columns.len());
        }
        let blocks = vec![[0.0; 9]; columns.len()];
        Self { starts, columns, blocks }
    }

    /// Adds the matrix of an element with these nodes. Blocks of zeros are passed over, so that memory that stays empty is not touched.
    fn add(&mut self, nodes: &[NodeId], matrix: &Stiffness) {
        for (a, &p) in nodes.iter().enumerate() {
            for (b, &q) in nodes.iter().enumerate().skip(a) {
                let block = matrix.block(a, b);
                if block.iter().all(|&x| x == 0.0) {
                    continue;
                }
                let (row, column) = (p.min(q), p.max(q));
                let range = self.starts[row.index()]..self.starts[row.index() + 1];
                let at = self.columns[range.clone()].binary_search(&column.0);
                let at = range.start + at.expect("nodes of one element are coupled in the pattern");
                let sum = &mut self.blocks[at];
                if p <= q {
                    sum.iter_mut().zip(block).for_each(|(s, x)| *s += x);
                }
                // A node that an element names twice meets itself in both orders.
                if p > q || (p == q && a != b) {
                    for i in 0..3 {
                        for j in 0..3 {
                            sum[3 * i + j] += block[3 * j + i];
                        }
                    }
                }
            }
        }
    }

    /// Drops blocks of zeros off the diagonal.
    fn compact(&mut self) {
        let mut kept = 0;
        let mut start = 0;
        for i in 0..self.len() {
            let end = self.starts[i + 1];
            for k in start..end {
                if self.columns[k] as usize == i || self.blocks[k].iter().any(|&x| x != 0.0) {
                    if k != kept {
                        self.columns[kept] = self.columns[k];
                        self.blocks[kept] = self.blocks[k];
                    }
                    kept += 1;
                }
            }
            start = end;
            self.starts[i + 1] = kept;
        }
        self.columns.truncate(kept);
        self.blocks.truncate(kept);
        self.columns.shrink_to_fit();
        self.blocks.shrink_to_fit();
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of blocks that are stored.
    pub fn blocks(&self) -> usize {
        self.blocks.len()
    }

    /// Bytes that a product reads of the matrix.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.blocks[..]) + size_of_val(&self.columns[..]) + size_of_val(&self.starts[..])
    }

    /// Diagonal block of a node, row-major.
    pub fn diagonal(&self, node: NodeId) -> [f64; 9] {
        self.blocks[self.starts[node.index()]]
    }

    /// `y = K x`, nodal vectors over all nodes.
    pub fn multiply(&self, x: &[[f64; 3]], y: &mut [[f64; 3]]) {
        y.fill([0.0; 3]);
        self.multiply_add(1.0, x, y);
    }

    /// `y += factor K x`.
    ///
    /// Numbers 1 and 2 of each row of a block go in pairs, which every processor multiplies at once; number 3 goes alone.
    pub fn multiply_add(&self, factor: f64, x: &[[f64; 3]], y: &mut [[f64; 3]]) {
        assert!(x.len() == self.len() && y.len() == self.len(), "nodal vectors are over all nodes of the mesh");
        let mut start = 0;
        for (i, &end) in self.starts[1..].iter().enumerate() {
            let (diagonal, later) = (&self.blocks[start], &self.blocks[start + 1..end]);
            let own = x[i].map(|value| factor * value);
            let (mut pairs, mut thirds) = ([[0.0; 2]; 3], [0.0; 3]);
            for d in 0..3 {
                add_product(&mut pairs[d], [diagonal[3 * d], diagonal[3 * d + 1]], [x[i][0], x[i][1]]);
                thirds[d] += diagonal[3 * d + 2] * x[i][2];
            }
            for (a, &j) in later.iter().zip(&self.columns[start + 1..end]) {
                let (other, out) = (&x[j as usize], &mut y[j as usize]);
                let (mut pair, mut third) = ([out[0], out[1]], out[2]);
                for d in 0..3 {
                    let row = [a[3 * d], a[3 * d + 1]];
                    add_product(&mut pairs[d], row, [other[0], other[1]]);
                    add_product(&mut pair, row, [own[d], own[d]]);
                    thirds[d] += a[3 * d + 2] * other[2];
                    third += a[3 * d + 2] * own[d];
                }
                *out = [pair[0], pair[1], third];
            }
            for (out, (pair, third)) in y[i].iter_mut().zip(pairs.iter().zip(thirds)) {
                *out += factor * (pair[0] + pair[1] + third);
            }
            start = end;
        }
    }
}

/// `sum += a b`, number by number.
#[inline(always)]
fn add_product(sum: &mut [f64; 2], a: [f64; 2], b: [f64; 2]) {
    sum[0] += a[0] * b[0];
    sum[1] += a[1] * b[1];
}
