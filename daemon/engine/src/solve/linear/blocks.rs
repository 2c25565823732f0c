//! Where the numbers of a sparse factor are.

use serde::{Deserialize, Serialize};

/// Where the blocks of L are. A supernode is a run of columns with one pattern below them; its block is dense and
/// column-major, the rows of its own columns first (their strict upper triangle means nothing), then the pattern.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Blocks {
    /// First unknown of each supernode, then the number of unknowns.
    pub starts: Vec<usize>,
    /// Where the pattern of each supernode begins, then its total length.
    pub pattern_starts: Vec<usize>,
    /// Rows below the supernodes' own, ascending within each.
    pub pattern: Vec<u32>,
    /// Where the values of each supernode begin, then their total number.
    pub value_starts: Vec<usize>,
}

/// One supernode of L.
#[derive(Clone, Copy)]
pub struct Block<'a> {
    /// Its first unknown.
    pub start: usize,
    /// Its number of columns.
    pub width: usize,
    /// Rows below its own.
    pub pattern: &'a [u32],
    /// `width` columns of `width + pattern.len()` numbers.
    pub values: &'a [f64],
}

impl Block<'_> {
    /// Length of a column.
    pub fn height(&self) -> usize {
        self.width + self.pattern.len()
    }

    /// A column from the diagonal on: the rest of the supernode's own rows, then the pattern rows.
    pub fn column(&self, j: usize) -> (&[f64], &[f64]) {
        let column = &self.values[j * self.height()..(j + 1) * self.height()];
        column[j..].split_at(self.width - j)
    }
}

impl Blocks {
    /// Number of supernodes.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.starts[self.len()]
    }

    /// Numbers in all blocks.
    pub fn values(&self) -> usize {
        self.value_starts[self.len()]
    }

    /// Columns of a supernode.
    pub fn width(&self, s: usize) -> usize {
        self.starts[s + 1] - self.starts[s]
    }

    /// Length of the columns of a supernode.
    pub fn height(&self, s: usize) -> usize {
        self.width(s) + self.pattern(s).len()
    }

    /// Rows below a supernode's own.
    pub fn pattern(&self, s: usize) -> &[u32] {
        &self.pattern[self.pattern_starts[s]..self.pattern_starts[s + 1]]
    }

    /// Where the column of an unknown of a supernode begins in the values.
    pub fn column_at(&self, s: usize, unknown: u32) -> usize {
        self.value_starts[s] + (unknown as usize - self.starts[s]) * self.height(s)
    }

    /// The same structure with supernodes cut into equal parts of at most `width_max` columns: the unused triangles on
    /// their diagonals are smaller then.
    pub fn cut(&self, width_max: usize) -> Self {
        let mut out = Self { starts: vec![0], pattern_starts: vec![0], pattern: Vec::new(), value_starts: vec![0] };
        for s in 0..self.len() {
            let (start, end, width) = (self.starts[s], self.starts[s + 1], self.width(s));
            let parts = width.div_ceil(width_max);
            let mut begin = start;
            for part in 1..=parts {
                let next = start + width * part / parts;
                let values = out.values() + (next - begin) * (end - begin + self.pattern(s).len());
                out.pattern.extend(next as u32..end as u32);
                out.pattern.extend(self.pattern(s));
                out.starts.push(next);
                out.pattern_starts.push(out.pattern.len());
                out.value_starts.push(values);
                begin = next;
            }
        }
        out
    }

    /// Length of the longest pattern.
    pub fn pattern_max(&self) -> usize {
        (0..self.len()).map(|s| self.pattern(s).len()).max().unwrap_or(0)
    }

    /// A supernode with its values.
    pub fn block<'a>(&'a self, values: &'a [f64], s: usize) -> Block<'a> {
        Block {
            start: self.starts[s],
            width: self.width(s),
            pattern: self.pattern(s),
            values: &values[self.value_starts[s]..self.value_starts[s + 1]],
        }
    }

    /// The supernode of an unknown.
    pub fn supernode_of(&self, unknown: usize) -> usize {
        self.starts.partition_point(|&start| start <= unknown) - 1
    }

    /// Whether starts, patterns and values fit together, for this many values: what a file must keep.
    pub fn is_consistent(&self, values: usize) -> bool {
        let count = self.starts.len();
        let ends = |starts: &[usize], end: usize| {
            starts.len() == count && starts[0] == 0 && starts.is_sorted() && starts[count - 1] == end
        };
        if count == 0 || !ends(&self.starts, self.starts[count - 1]) || !ends(&self.pattern_starts, self.pattern.len())
        {
            return false;
        }
        let n = self.unknowns();
        ends(&self.value_starts, values)
            && (0..self.len()).all(|s| {
                let (width, end) = (self.width(s), self.starts[s + 1]);
                let pattern = self.pattern(s);
                let inside = pattern.iter().all(|&row| (end..n).contains(&(row as usize)));
                let size = self.value_starts[s + 1] - self.value_starts[s];
                inside && pattern.is_sorted() && Some(size) == width.checked_mul(width + pattern.len())
            })
    }
}
