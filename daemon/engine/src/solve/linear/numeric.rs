//! Numeric factorisation, right-looking: each supernode is finished in turn and taken off those above it.
//!
//! ```text
//! L_own L_ownᵀ = A_own          dense
//! L_pattern = A_pattern L_own⁻ᵀ
//! A_above <- A_above − L_pattern L_patternᵀ
//! ```
//!
//! The rows of a pattern lie in their targets in a few runs of consecutive rows. Where the runs are long, the product
//! goes right into the target; else it is formed for a group of targets at once and spread from there.

use std::ops::Range;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{self, LltError};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::reborrow::{Reborrow, ReborrowMut};
use faer::{Accum, MatMut, MatRef, Par};

use super::blocks::Blocks;
use super::product::{clear_registers, multiply};
use super::{PIVOT_RELATIVE_MIN, SingularPivot};
use crate::solve::assembly::LowerMatrix;

/// Columns that a group of targets has at least, so that its product is worth a call.
const GROUP: usize = 96;
/// Columns of a product formed at a time: its upper triangle is computed only within them.
const PANEL: usize = 64;
/// A target of at least so many columns, in at most so many runs of rows, takes the product directly.
const DIRECT_COLUMNS_MIN: usize = 24;
const DIRECT_RUNS_MAX: usize = 3;

/// Computes the numbers of L where zeros are.
pub fn factor(matrix: &LowerMatrix, blocks: &Blocks, values: &mut [f64]) -> Result<(), SingularPivot> {
    let diagonal: Vec<f64> = matrix.diagonal().collect();
    let mut work = Work::new(blocks);
    for s in 0..blocks.len() {
        let (done, above) = values.split_at_mut(blocks.value_starts[s + 1]);
        let block = &mut done[blocks.value_starts[s]..];
        work.add_matrix(matrix, blocks, s, block);
        let (width, height) = (blocks.width(s), blocks.height(s));
        let (own, pattern) = MatMut::from_column_major_slice_mut(block, height, width).split_at_row_mut(width);
        work.eliminate(own, pattern, blocks.starts[s])?;
        check_pivots(&diagonal, block, height, blocks.starts[s])?;
        if height > width {
            let product = MatRef::from_column_major_slice(&*block, height, width).split_at_row(width).1;
            work.update(blocks, s, product, above);
        }
    }
    Ok(())
}

/// Refuses pivots that are rounding against the diagonal of the matrix; `start` is the first unknown of the block.
fn check_pivots(diagonal: &[f64], block: &[f64], height: usize, start: usize) -> Result<(), SingularPivot> {
    for (j, (column, original)) in block.chunks_exact(height).zip(&diagonal[start..]).enumerate() {
        let pivot = column[j];
        // False for a NaN pivot too.
        let usable = pivot * pivot > PIVOT_RELATIVE_MIN * original;
        if !usable {
            return Err(SingularPivot { unknown: start + j });
        }
    }
    Ok(())
}

/// Rows of a pattern that are consecutive rows of a target.
struct Run {
    /// Positions in the pattern.
    rows: Range<usize>,
    /// Row of the target's block.
    at: usize,
}

/// A supernode that owns some rows of a pattern.
struct Target {
    supernode: usize,
    /// Positions in the pattern of the rows that are its columns.
    columns: Range<usize>,
    /// Its runs.
    runs: Range<usize>,
}

/// Work space of a factorisation.
struct Work {
    /// Supernode of each unknown.
    owners: Vec<u32>,
    /// Row of each unknown in the block of the present supernode; old values elsewhere.
    rows: Vec<u32>,
    product: Vec<f64>,
    targets: Vec<Target>,
    runs: Vec<Run>,
    memory: MemBuffer,
}

impl Work {
    fn new(blocks: &Blocks) -> Self {
        let width_max = (0..blocks.len()).map(|s| blocks.width(s)).max().unwrap_or(0);
        let mut owners = vec![0; blocks.unknowns()];
        for s in 0..blocks.len() {
            owners[blocks.starts[s]..blocks.starts[s + 1]].fill(s as u32);
        }
        Self {
            owners,
            rows: vec![0; blocks.unknowns()],
            product: vec![0.0; blocks.pattern_max() * (GROUP + width_max)],
            targets: Vec::new(),
            runs: Vec::new(),
            memory: MemBuffer::new(factor::cholesky_in_place_scratch::<f64>(width_max, Par::Seq, Default::default())),
        }
    }

    /// Adds the columns of the matrix to what updates have left in the block.
    fn add_matrix(&mut self, matrix: &LowerMatrix, blocks: &Blocks, s: usize, block: &mut [f64]) {
        let (start, end, height) = (blocks.starts[s], blocks.starts[s + 1], blocks.height(s));
        for (i, row) in (start..end).chain(blocks.pattern(s).iter().map(|&r| r as usize)).enumerate() {
            self.rows[row] = i as u32;
        }
        for (j, column) in (start..end).zip(block.chunks_exact_mut(height)) {
            let entries = matrix.starts[j]..matrix.starts[j + 1];
            for (&row, value) in matrix.rows[entries.clone()].iter().zip(&matrix.values[entries]) {
                column[self.rows[row] as usize] += value;
            }
        }
    }

    fn eliminate(
        &mut self,
        mut own: MatMut<'_, f64>,
        mut pattern: MatMut<'_, f64>,
        start: usize,
    ) -> Result<(), SingularPivot> {
        let stack = MemStack::new(&mut self.memory);
        factor::cholesky_in_place(own.rb_mut(), Default::default(), Par::Seq, stack, Default::default())
            .map_err(|LltError::NonPositivePivot { index }| SingularPivot { unknown: start + index })?;
        solve_lower_triangular_in_place(own.rb(), pattern.rb_mut().transpose_mut(), Par::Seq);
        clear_registers();
        Ok(())
    }

    /// Takes `pattern patternᵀ` off the supernodes above; `above` begins after the block of supernode `s`.
    fn update(&mut self, blocks: &Blocks, s: usize, pattern: MatRef<'_, f64>, above: &mut [f64]) {
        let (base, rows) = (blocks.value_starts[s + 1], blocks.pattern(s));
        let mut first = 0;
        while first < rows.len() {
            self.targets.clear();
            self.runs.clear();
            let (mut end, mut direct) = (first, false);
            while end < rows.len() && end - first < GROUP {
                let target = self.locate(blocks, rows, end);
                if self.is_direct(&target) {
                    // One that comes after others begins the next round.
                    direct = end == first;
                    if direct {
                        end = target.columns.end;
                        self.targets.push(target);
                    }
                    break;
                }
                end = target.columns.end;
                self.targets.push(target);
            }
            if direct {
                self.update_directly(blocks, rows, pattern, &mut above[..], base);
            } else {
                self.form(pattern, first..end);
                self.spread(blocks, rows, first, &mut above[..], base);
            }
            first = end;
        }
    }

    /// The supernode that owns the row at a position of the pattern; adds the runs of the rows from there on.
    fn locate(&mut self, blocks: &Blocks, rows: &[u32], first: usize) -> Target {
        let supernode = self.owners[rows[first] as usize] as usize;
        let (start, end) = (blocks.starts[supernode], blocks.starts[supernode + 1]);
        let below = blocks.pattern(supernode);
        let columns = first..first + rows[first..].partition_point(|&row| (row as usize) < end);
        let runs = self.runs.len();
        let mut walked = 0;
        for (i, &row) in rows.iter().enumerate().skip(first) {
            let at = if i < columns.end {
                row as usize - start
            } else {
                while below[walked] != row {
                    walked += 1;
                }
                end - start + walked
            };
            match self.runs[runs..].last_mut() {
                Some(run) if run.at + run.rows.len() == at => run.rows.end = i + 1,
                _ => self.runs.push(Run { rows: i..i + 1, at }),
            }
        }
        Target { supernode, columns, runs: runs..self.runs.len() }
    }

    fn is_direct(&self, target: &Target) -> bool {
        target.columns.len() >= DIRECT_COLUMNS_MIN
            && target.runs.len() <= DIRECT_RUNS_MAX
            && self.runs[target.runs.start].rows.end >= target.columns.end
    }

    /// Product into the one target, whose columns are consecutive.
    fn update_directly(&self, blocks: &Blocks, rows: &[u32], pattern: MatRef<'_, f64>, above: &mut [f64], base: usize) {
        let Target { supernode, columns, runs } = &self.targets[0];
        let height = blocks.height(*supernode);
        let at = blocks.column_at(*supernode, rows[columns.start]) - base;
        let mut into =
            MatMut::from_column_major_slice_mut(&mut above[at..at + columns.len() * height], height, columns.len());
        let right = pattern.subrows(columns.start, columns.len()).transpose();
        for run in &self.runs[runs.clone()] {
            let left = pattern.subrows(run.rows.start, run.rows.len());
            multiply(into.rb_mut().subrows_mut(run.at, run.rows.len()), Accum::Add, left, right, -1.0);
        }
    }

    /// Lower triangle of the given columns of the product, from the row of the first on.
    fn form(&mut self, pattern: MatRef<'_, f64>, columns: Range<usize>) {
        let height = pattern.nrows() - columns.start;
        for begin in columns.clone().step_by(PANEL) {
            let width = PANEL.min(columns.end - begin);
            let skipped = begin - columns.start;
            let panel = &mut self.product[skipped * height..(skipped + width) * height];
            let panel =
                MatMut::from_column_major_slice_mut(panel, height, width).subrows_mut(skipped, height - skipped);
            let left = pattern.subrows(begin, height - skipped);
            multiply(panel, Accum::Replace, left, pattern.subrows(begin, width).transpose(), 1.0);
        }
    }

    /// Takes the formed product, which begins at position `first` of the pattern, off the targets.
    fn spread(&self, blocks: &Blocks, rows: &[u32], first: usize, above: &mut [f64], base: usize) {
        let height = rows.len() - first;
        for Target { supernode, columns, runs } in &self.targets {
            let mut runs = &self.runs[runs.clone()];
            for column in columns.clone() {
                let product = &self.product[(column - first) * height..(column - first + 1) * height];
                let at = blocks.column_at(*supernode, rows[column]) - base;
                let into = &mut above[at..at + blocks.height(*supernode)];
                while runs[0].rows.end <= column {
                    runs = &runs[1..];
                }
                for run in runs {
                    let begin = run.rows.start.max(column);
                    let product = &product[begin - first..run.rows.end - first];
                    let into = &mut into[run.at + begin - run.rows.start..];
                    for (a, p) in into.iter_mut().zip(product) {
                        *a -= p;
                    }
                }
            }
        }
    }
}
