//! What elements are computed from and give back: node vectors and stiffness blocks.

use crate::model::ELEMENT_NODES_MAX;

/// Vectors at the nodes of an element or face, without allocation.
#[derive(Clone, Copy, Debug)]
pub struct Coordinates {
    values: [[f64; 3]; ELEMENT_NODES_MAX],
    count: usize,
}

impl Coordinates {
    /// Takes the vectors of one element or face; those beyond the largest element are dropped.
    pub fn of(vectors: impl Iterator<Item = [f64; 3]>) -> Self {
        let mut out = Self { values: [[0.0; 3]; ELEMENT_NODES_MAX], count: 0 };
        for (slot, vector) in out.values.iter_mut().zip(vectors) {
            *slot = vector;
            out.count += 1;
        }
        out
    }
}

impl std::ops::Deref for Coordinates {
    type Target = [[f64; 3]];

    fn deref(&self) -> &[[f64; 3]] {
        &self.values[..self.count]
    }
}

/// Upper blocks of the symmetric matrix of an element, stiffness [force/length], mass or damping: block (a, b), a ≤ b, row-major 3 x 3.
#[derive(Clone, Debug, Default)]
pub struct Stiffness {
    count: usize,
    blocks: Vec<[f64; 9]>,
}

/// Position of block (a, b), a ≤ b, among the upper blocks of `count` nodes.
pub const fn block_index(count: usize, a: usize, b: usize) -> usize {
    a * count - a * (a + 1) / 2 + b
}

impl Stiffness {
    /// From its blocks.
    #[cfg(test)]
    pub fn from_blocks(count: usize, blocks: &[[f64; 9]]) -> Self {
        let mut out = Self::default();
        out.set(count, blocks);
        out
    }

    /// Replaces the blocks.
    pub fn set(&mut self, count: usize, blocks: &[[f64; 9]]) {
        self.count = count;
        self.blocks.clear();
        self.blocks.extend_from_slice(blocks);
    }

    /// All blocks, zeroed, for a number of nodes.
    pub fn clear(&mut self, count: usize) -> &mut [[f64; 9]] {
        self.count = count;
        self.blocks.clear();
        self.blocks.resize(count * (count + 1) / 2, [0.0; 9]);
        &mut self.blocks
    }

    /// Replaces the blocks by multiples of the unit matrix on the diagonal, one per node.
    pub fn set_diagonal(&mut self, values: &[f64]) {
        let count = values.len();
        let blocks = self.clear(count);
        for (a, &value) in values.iter().enumerate() {
            let block = &mut blocks[block_index(count, a, a)];
            (block[0], block[4], block[8]) = (value, value, value);
        }
    }

    /// Adds a multiple of a matrix of as many nodes.
    pub fn add(&mut self, factor: f64, other: &Self) {
        debug_assert_eq!(self.count, other.count);
        for (sum, term) in self.blocks.as_flattened_mut().iter_mut().zip(other.blocks.as_flattened()) {
            *sum += factor * term;
        }
    }

    /// Number of nodes.
    #[cfg(test)]
    pub fn count(&self) -> usize {
        self.count
    }

    /// Block (a, b), a ≤ b.
    #[inline]
    pub fn block(&self, a: usize, b: usize) -> &[f64; 9] {
        &self.blocks[block_index(self.count, a, b)]
    }

    /// `K u`, node by node [force]; zero beyond the node count.
    pub fn force(&self, u: &[[f64; 3]]) -> [[f64; 3]; ELEMENT_NODES_MAX] {
        let mut f = [[0.0; 3]; ELEMENT_NODES_MAX];
        for a in 0..self.count {
            for b in a..self.count {
                let m = self.block(a, b);
                for i in 0..3 {
                    for j in 0..3 {
                        f[a][i] += m[3 * i + j] * u[b][j];
                        if a != b {
                            f[b][j] += m[3 * i + j] * u[a][i];
                        }
                    }
                }
            }
        }
        f
    }
}
