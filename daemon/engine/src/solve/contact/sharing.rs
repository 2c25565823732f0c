//! How rows that depend on each other share what they carry.
//!
//! Where more walls are touched than the bodies have ways to move, equilibrium leaves the forces open: a rigid block on four
//! points, two ties of a point with one free direction. Of all forces with the same effect the evenest are taken, those of least
//! `Σ F²/A`: equal pressures under a rigid block that is pressed in its middle. With all rows `T` that touch their walls and those
//! of them, `K`, that the others depend on,
//!
//! ```text
//! M_KT F' = M_KT F,     F' = S M_TK z,     S = diag(A)
//! ```
//!
//! solved through an orthonormal basis of `S^½ M_TK`. Where the evenest forces would pull at a one-sided wall, the forces stay as
//! they are. The sparse path shares by itself: its stand-in compliances are 1/A.

use super::row::Wall;
use super::view::{Compliance, View};
use super::{ContactSolver, Unknowns};
use crate::solve::linear::Dense;

/// Overclosure, relative to the largest, at which a wall is touched.
const TOUCHING: f64 = 1e-12;
/// The same against the size of the model.
const TOUCHING_ROUNDING: f64 = 1e-13;
/// Rest of a row that the others do not explain, relative to the row, below which it depends on them.
const DEPENDENT: f64 = 1e-9;
/// Corrections of what the basis costs in digits.
const CORRECTIONS: usize = 3;

impl ContactSolver {
    /// Shares the forces of rows that depend on each other; the rows that the others depend on if any force changed. `free_scale` is
    /// what rounding is judged against.
    pub(super) fn share(&self, view: &View<'_>, free_scale: f64, unknowns: &mut Unknowns<'_>) -> Option<Vec<u32>> {
        let Compliance::Dense(m) = view.compliance else { return None };
        // Only walls depend on each other: a curve has a compliance of its own.
        if self.factor_rows.is_empty() || self.factor_rows.iter().any(|&i| !self.is_on_wall(i)) {
            return None;
        }
        let near = TOUCHING * free_scale + TOUCHING_ROUNDING * view.extent;
        let rows = || (0..view.rows.len() as u32).filter(|&i| self.touches(view, i, near, unknowns.overclosures));
        if rows().count() == self.factor_rows.len() {
            return None;
        }
        let touching: Vec<u32> = rows().collect();
        let kept = independent(m, &touching);
        if touching.len() == kept.len() {
            return None;
        }
        let root: Vec<f64> = touching.iter().map(|&t| view.rows[t as usize].area.sqrt()).collect();
        let (basis, triangle) = orthonormal(m, &touching, &kept, &root)?;
        let effect = |forces: &[f64]| -> Vec<f64> {
            let of_row =
                |&k: &u32| touching.iter().zip(forces).map(|(&t, f)| m.column(k as usize)[t as usize] * f).sum();
            kept.iter().map(of_row).collect()
        };
        let carried: Vec<f64> = touching.iter().map(|&t| unknowns.forces[t as usize]).collect();
        let wanted = effect(&carried);
        let mut shared = vec![0.0; touching.len()];
        for _ in 0..CORRECTIONS {
            let mut rest: Vec<f64> = wanted.iter().zip(effect(&shared)).map(|(w, e)| w - e).collect();
            // M_KT S^½ = Rᵀ Qᵀ, so that S^-½ dF = Q R^-T rest.
            forward(&triangle, &mut rest);
            for (column, y) in basis.iter().zip(&rest) {
                for ((f, q), s) in shared.iter_mut().zip(column).zip(&root) {
                    *f += s * q * y;
                }
            }
        }
        let largest = shared.iter().fold(0.0f64, |m, f| m.max(f.abs()));
        let pulls = |(&t, f): (&u32, &f64)| view.rows[t as usize].wall == Wall::OneSided && *f < -1e-12 * largest;
        if !largest.is_finite() || touching.iter().zip(&shared).any(pulls) {
            return None;
        }
        for (&t, f) in touching.iter().zip(&shared) {
            let t = t as usize;
            unknowns.forces[t] = if view.rows[t].wall == Wall::OneSided { f.max(0.0) } else { *f };
            unknowns.closed[t] = view.rows[t].wall == Wall::TwoSided || *f > 1e-11 * largest;
        }
        Some(kept)
    }

    /// Whether a row is in the factor, or on its wall to rounding where forces can move it.
    fn touches(&self, view: &View<'_>, i: u32, near: f64, overclosures: &[f64]) -> bool {
        let row = &view.rows[i as usize];
        let close = (overclosures[i as usize] - row.position).abs() <= near;
        let walled = row.wall != Wall::None && !row.has_curve() && view.own(i as usize) > self.own_min;
        walled && close || self.factor_rows.binary_search(&i).is_ok()
    }
}

/// Rows that do not depend on earlier ones.
fn independent(m: &Dense, rows: &[u32]) -> Vec<u32> {
    let size = rows.len();
    let mut a: Vec<f64> = Vec::with_capacity(size * size);
    for &j in rows {
        let column = m.column(j as usize);
        a.extend(rows.iter().map(|&i| column[i as usize]));
    }
    let mut kept = Vec::with_capacity(size);
    for j in 0..size {
        let (own, pivot) = (m.column(rows[j] as usize)[rows[j] as usize], a[j * size + j]);
        if pivot.is_nan() || pivot <= DEPENDENT * own {
            continue;
        }
        kept.push(rows[j]);
        for k in j + 1..size {
            let factor = a[j * size + k] / pivot;
            if factor != 0.0 {
                for i in k..size {
                    a[k * size + i] -= factor * a[j * size + i];
                }
            }
        }
    }
    kept
}

/// Vectors of a matrix, column by column.
type Columns = Vec<Vec<f64>>;

/// Orthonormal columns `Q` and upper triangle `R` (by columns) of `S^½ M_TK`; none where the columns depend on each other.
fn orthonormal(m: &Dense, touching: &[u32], kept: &[u32], root: &[f64]) -> Option<(Columns, Columns)> {
    let mut basis: Columns = Vec::with_capacity(kept.len());
    let mut triangle: Columns = Vec::with_capacity(kept.len());
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    for &k in kept {
        let column = m.column(k as usize);
        let mut v: Vec<f64> = touching.iter().zip(root).map(|(&t, s)| s * column[t as usize]).collect();
        let size = dot(&v, &v).sqrt();
        let mut above = vec![0.0; basis.len()];
        // Twice is enough: what the first pass leaves is rounding of a long way.
        for _ in 0..2 {
            for (q, r) in basis.iter().zip(&mut above) {
                let along = dot(q, &v);
                *r += along;
                v.iter_mut().zip(q).for_each(|(v, q)| *v -= along * q);
            }
        }
        let length = dot(&v, &v).sqrt();
        if length.is_nan() || length <= 1e-14 * size {
            return None;
        }
        v.iter_mut().for_each(|v| *v /= length);
        above.push(length);
        basis.push(v);
        triangle.push(above);
    }
    Some((basis, triangle))
}

/// `R^-T x` for an upper triangle given by columns.
fn forward(triangle: &[Vec<f64>], x: &mut [f64]) {
    for j in 0..x.len() {
        let sum: f64 = (0..j).map(|i| triangle[j][i] * x[i]).sum();
        x[j] = (x[j] - sum) / triangle[j][j];
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{Numbers, Solution, compliance, system};
    use super::*;
    use crate::law::NormalBehavior;

    #[test]
    fn points_that_depend_on_each_other_share_evenly() {
        let mut numbers = Numbers(41);
        for case in 0..40 {
            let n = 4 + case % 5;
            // Rank 3 with the motion that presses all points alike: then equal pressures are the evenest of their effect.
            let mut w = compliance(&mut numbers, n, 2);
            w.values.iter_mut().for_each(|value| *value += 1.0);
            let case = system(w, vec![NormalBehavior::Hard], |_| 0);
            let even: Vec<f64> = case.rows.iter().map(|row| 2.0 * row.area).collect();
            let mut free = vec![0.0; n];
            case.relief(&even, &mut free);
            let mut solution = Solution::new(&case);
            solution.solve(&mut ContactSolver::new(&case), &case, &free, &[]).expect("consistent");
            for (force, expected) in solution.forces.iter().zip(&even) {
                assert!((force / expected - 1.0).abs() < 1e-9, "{:?} {even:?}", solution.forces);
            }
            assert!(solution.closed.iter().all(|closed| *closed));
        }
    }
}
