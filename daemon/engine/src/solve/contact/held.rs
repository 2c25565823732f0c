//! The contact solve with every motion held: by supports, or by springs that `balance.rs` puts on free motions.
//!
//! ```text
//! h = h_free − W F,      F_i = A_i p(h_i)  (softened),      h_i ≤ 0, F_i ≥ 0, F_i h_i = 0  (hard)
//! ```
//!
//! `W = B K⁻¹ Bᵀ` is symmetric and positive semi-definite and every law is monotone, so the solution minimises the
//! convex potential `Π(Λ) = ½ Λᵀ W Λ + Σ A U(h_free − W Λ)` under `h ≤ 0` at the hard points. Each iteration
//! minimises its quadratic model exactly (the hard points by block principal pivoting, which cannot cycle) and goes
//! along the step as far as Π falls. That converges from any start; "not converged" is left for prescribed
//! motions that no contact force can resist.
//!
//! Sources: damped Newton on a convex function (Boyd and Vandenberghe 9.5); block principal pivoting with the
//! single-pivot safeguard (Portugal, Júdice, Vicente 1994).

use super::active_sparse::SparseWork;
use super::balance::BalanceWork;
use super::row::Wall;
use super::view::{Compliance, View};
use super::{Problem, SolveCounts, SolveFailure, Unknowns};
use crate::solve::contact::ContactSystem;
use crate::solve::linear::{self, DenseScratch};

/// Iterations of the damped Newton method before an attempt is given up. Piecewise linear laws end in a handful,
/// the exponential law in about ten; an order of magnitude above that nothing is gained.
const ITERATIONS_MAX: u32 = 200;
/// Full exchanges that may fail to reduce the number of violating points before single exchanges take over.
const FULL_EXCHANGES_WITHOUT_GAIN: u32 = 3;
/// Out-of-balance contact force, relative to the largest contact force, at which the laws are satisfied.
const FORCE_TOLERANCE: f64 = 1e-12;
/// Contact force, relative to the largest, of a point that is not called closed.
const STATUS_ROUNDING: f64 = 1e-11;
/// Overclosure of a hard point, relative to the largest overclosure without contact, that is rounding.
const OVERCLOSURE_TOLERANCE: f64 = 1e-13;
/// Rounding of forces and overclosures that conjugate gradients find, against that of a factor.
const ITERATIVE_ROUNDING: f64 = 100.0;
/// Remaining overclosure, on the same scale, above which a hard constraint that depends on others contradicts them.
const CONFLICT_TOLERANCE: f64 = 1e-7;
/// The same against the size of the model: rounding of coordinates where surfaces only touch.
const CONFLICT_ROUNDING: f64 = 1e-14;
/// Contact stiffness, relative to that of the bodies at the point, below which a point carries no force worth having.
const NEGLIGIBLE_STIFFNESS: f64 = 1e-30;
/// Compliance of a row against itself, relative to the largest, that is rounding: no force can move it.
const NEGLIGIBLE_COMPLIANCE: f64 = 1e-24;
/// Line search: accepted growth of the slope of Π beyond its minimum, relative to the slope at the start.
const SLOPE_ACCEPTED: f64 = 0.5;

/// Work space, allocated once; also holds the last factor, keyed by what went into it.
#[derive(Default)]
pub struct ContactSolver {
    trial: Vec<f64>,
    relief_trial: Vec<f64>,
    active: Vec<u32>,
    /// Per point: compliance of the linearised law (0 for hard points).
    compliance: Vec<f64>,
    /// Per point: overclosure at which the linearised law has no pressure (0 for hard points).
    onset: Vec<f64>,
    /// Per row: force of its curve at its wall.
    floor: Vec<f64>,
    /// Per row: the curve as linearised.
    curve_compliance: Vec<f64>,
    curve_onset: Vec<f64>,
    on_curve: Vec<bool>,
    /// Per row: whether it is on its wall.
    on_wall: Vec<bool>,
    is_active: Vec<bool>,
    was_closed: Vec<bool>,
    violating: Vec<u32>,
    right: Vec<f64>,
    factor: Vec<f64>,
    factor_points: Vec<u32>,
    factor_compliance: Vec<f64>,
    pub(super) factor_rows: Vec<u32>,
    /// Compliance below which a row on its wall cannot be moved [length/force].
    pub(super) own_min: f64,
    factors: u32,
    /// Overclosures after each iteration of the last solve.
    #[cfg(test)]
    pub(super) iterates: Vec<Vec<f64>>,
    sparse: SparseWork,
    scratch: DenseScratch,
    pub(super) balance: BalanceWork,
}

impl ContactSolver {
    /// Work space for a view.
    pub fn new(system: &ContactSystem) -> Self {
        let n = system.count;
        let mut solver = Self::default();
        for v in [
            &mut solver.trial,
            &mut solver.relief_trial,
            &mut solver.compliance,
            &mut solver.onset,
            &mut solver.floor,
            &mut solver.curve_compliance,
            &mut solver.curve_onset,
        ] {
            v.resize(n, 0.0);
        }
        for v in [&mut solver.active, &mut solver.violating, &mut solver.factor_points, &mut solver.factor_rows] {
            v.reserve(n);
        }
        solver.right.reserve(n);
        solver.factor_compliance.reserve(n);
        for v in [&mut solver.is_active, &mut solver.on_wall, &mut solver.on_curve] {
            v.resize(n, false);
        }
        solver.was_closed.resize(n, false);
        solver
    }

    /// The compliance has changed: its factor is of no use any more.
    pub(super) fn forget_factor(&mut self) {
        self.factor_points.clear();
        self.factor_rows.clear();
        self.factor.clear();
    }

    /// Dense factorisations so far.
    #[cfg(test)]
    pub(super) fn factors(&self) -> u32 {
        self.factors
    }

    /// Solves for the contact forces. `unknowns` hold the start and receive the solution; `relief` is the product of the view's
    /// compliance with the forces, `overclosures` receives `free − relief`. `free_scale` is the size of overclosures against
    /// which rounding is judged. On failure they are left as they are at that moment.
    pub(super) fn solve_held(
        &mut self,
        view: &View<'_>,
        free: &[f64],
        free_scale: f64,
        unknowns: &mut Unknowns<'_>,
    ) -> Result<SolveCounts, SolveFailure> {
        let Unknowns { forces, relief, closed, overclosures, .. } = unknowns;
        let n = view.rows.len();
        let mut counts = SolveCounts::default();
        let has_walls = (0..n).any(|i| view.has_wall(i));
        let factorizations = self.sparse.factorizations;
        self.own_min = NEGLIGIBLE_COMPLIANCE * (0..n).map(|i| view.own(i)).fold(0.0, f64::max);
        #[cfg(test)]
        self.iterates.clear();
        self.on_curve.fill(false);
        self.floor.fill(0.0);
        for i in 0..n {
            self.on_wall[i] = match view.rows[i].wall {
                Wall::None => false,
                Wall::OneSided => closed[i],
                Wall::TwoSided => true,
            };
        }
        // A start that violates a hard constraint has no potential to compare with: its first step is taken whole.
        let mut comparable = !has_walls;
        for i in 0..n {
            overclosures[i] = free[i] - relief[i];
        }
        for _ in 0..ITERATIONS_MAX {
            self.was_closed.copy_from_slice(closed);
            self.linearise(view, overclosures);
            counts.severe_discontinuity_iterations += self.minimise_model(view, free, free_scale)?;
            // Near the solution the slope of Π is rounding and says nothing: a step that ends balanced is taken whole.
            let whole = !comparable || self.trial_is_balanced(view, free);
            let fraction = if whole { 1.0 } else { self.line_search(view, forces, relief, overclosures) };
            comparable = true;
            for i in 0..n {
                if fraction == 1.0 {
                    forces[i] = self.trial[i];
                    relief[i] = self.relief_trial[i];
                } else {
                    forces[i] += fraction * (self.trial[i] - forces[i]);
                    relief[i] += fraction * (self.relief_trial[i] - relief[i]);
                }
                overclosures[i] = free[i] - relief[i];
            }
            for i in 0..n {
                closed[i] = if view.has_wall(i) { self.on_wall[i] } else { forces[i] > 0.0 };
            }
            if **closed != *self.was_closed {
                counts.severe_discontinuity_iterations += 1;
            } else {
                counts.equilibrium_iterations += 1;
            }
            #[cfg(test)]
            self.iterates.push(overclosures.to_vec());
            if fraction == 1.0 && self.is_balanced(view, free, forces, overclosures) {
                counts.factorizations = self.sparse.factorizations - factorizations;
                // The last step was taken whole: `relief` is `W F` as `relief` of the view computes it, unless points join that were
                // left out because their force moves nothing: it is that of their curve all the same.
                let left_out = |i: usize| {
                    let at = view.rows[i].evaluate(view.behaviors, overclosures[i]);
                    let negligible = view.rows[i].has_curve() && at.stiffness * view.own(i) <= NEGLIGIBLE_STIFFNESS;
                    (negligible && !self.is_active[i]).then_some(at.force)
                };
                if (0..n).any(|i| left_out(i).is_some_and(|force| force != 0.0)) {
                    for i in 0..n {
                        if let Some(force) = left_out(i) {
                            forces[i] = force;
                        }
                    }
                    view.relief(forces, relief);
                }
                // At the kink of a law rounding would choose the status: a force that is rounding closes nothing.
                let negligible = STATUS_ROUNDING * forces.iter().fold(0.0f64, |m, f| m.max(f.abs()));
                for (i, row) in view.rows.iter().enumerate() {
                    closed[i] = match (row.wall, row.dashpot) {
                        (Wall::TwoSided, _) => true,
                        (Wall::OneSided, None) => closed[i] && forces[i] > negligible,
                        (Wall::OneSided, Some(_)) => closed[i],
                        (Wall::None, None) => forces[i] > negligible,
                        // What a dashpot carries says nothing about contact.
                        (Wall::None, Some(_)) => {
                            row.area * row.law(view.behaviors, overclosures[i]).pressure > negligible
                        }
                    };
                }
                return Ok(counts);
            }
        }
        let scale = self.force_scale();
        let unsettled = (0..n).filter(|&i| {
            closed[i] != self.was_closed[i] || !self.point_is_balanced(view, i, free, forces, overclosures[i], scale)
        });
        Err(SolveFailure::NotConverged { points: unsettled.map(|i| i as u32).collect() })
    }

    /// Linearises the curves at the present overclosures: `F = (h − onset) / compliance` where the slope is positive, no force
    /// elsewhere. Rows with a wall have their curve below it; where it meets the wall is the least that they carry there.
    fn linearise(&mut self, view: &View<'_>, overclosures: &[f64]) {
        for (i, row) in view.rows.iter().enumerate().filter(|(_, row)| row.has_curve()) {
            let walled = row.wall != Wall::None;
            let h = if walled { overclosures[i].min(row.position) } else { overclosures[i] };
            let at = row.evaluate(view.behaviors, h);
            // A point so soft against the bodies that its force cannot matter is left out: its compliance
            // would only bring overflow into the factor.
            let own = view.own(i);
            let softness = at.stiffness * own;
            self.on_curve[i] = softness > NEGLIGIBLE_STIFFNESS || (own == 0.0 && at.stiffness > 0.0);
            if self.on_curve[i] {
                self.curve_compliance[i] = 1.0 / at.stiffness;
                self.curve_onset[i] = h - at.force / at.stiffness;
            }
            // Of the linear model, so that a point is either on its wall or below it.
            let reaches = walled && self.on_curve[i];
            self.floor[i] = if reaches { (row.position - self.curve_onset[i]) * at.stiffness } else { 0.0 };
        }
    }

    /// Sets what the active rows are worth in the linear model: walls where they stand, curves as linearised.
    fn activate(&mut self, view: &View<'_>) {
        self.active.clear();
        for (i, row) in view.rows.iter().enumerate() {
            self.is_active[i] = self.on_wall[i] || self.on_curve[i];
            if self.is_active[i] {
                self.active.push(i as u32);
                let on_wall = self.on_wall[i];
                self.compliance[i] = if on_wall { 0.0 } else { self.curve_compliance[i] };
                self.onset[i] = if on_wall { row.position } else { self.curve_onset[i] };
            }
        }
    }

    /// Minimises the quadratic model into `trial` and `relief_trial`; returns the exchanges of hard points.
    fn minimise_model(&mut self, view: &View<'_>, free: &[f64], free_scale: f64) -> Result<u32, SolveFailure> {
        let n = view.rows.len();
        let (mut best, mut patience, mut exchanges) = (usize::MAX, FULL_EXCHANGES_WITHOUT_GAIN, 0u32);
        // Single exchanges visit a set at most once; the bound only guards against rounding.
        let exchanges_max = 50 + 20 * n as u32;
        loop {
            self.activate(view);
            self.solve_active(view, free);
            view.relief(&self.trial, &mut self.relief_trial);
            let force_scale = self.trial.iter().fold(0.0f64, |m, f| m.max(f.abs()));
            let iterative = !matches!(view.compliance, Compliance::Dense(_));
            let rounding = if iterative { ITERATIVE_ROUNDING } else { 1.0 };
            let slack = rounding * OVERCLOSURE_TOLERANCE * free_scale;
            self.violating.clear();
            for (i, row) in view.rows.iter().enumerate().filter(|(_, row)| row.wall == Wall::OneSided) {
                let violates = if self.on_wall[i] {
                    self.trial[i] < self.floor[i] - rounding * FORCE_TOLERANCE * force_scale
                } else {
                    free[i] - self.relief_trial[i] > row.position + slack
                };
                if violates {
                    self.violating.push(i as u32);
                }
            }
            if self.violating.is_empty() {
                return self.check_conflicts(view, free, free_scale).map(|()| exchanges);
            }
            if exchanges == exchanges_max {
                return Err(SolveFailure::NotConverged { points: self.violating.clone() });
            }
            exchanges += 1;
            let full = if self.violating.len() < best {
                best = self.violating.len();
                patience = FULL_EXCHANGES_WITHOUT_GAIN;
                true
            } else if patience > 0 {
                patience -= 1;
                true
            } else {
                false
            };
            let begin = if full { 0 } else { self.violating.len() - 1 };
            for &i in &self.violating[begin..] {
                self.on_wall[i as usize] = !self.on_wall[i as usize];
            }
        }
    }

    /// Solves `(W + C) F = h_free − onset` on the active points into `trial`; reuses the factor when neither the
    /// points nor their compliances have changed.
    fn solve_active(&mut self, view: &View<'_>, free: &[f64]) {
        let n = view.rows.len();
        if let Compliance::Sparse(..) = view.compliance {
            return self.solve_active_sparse(view, free);
        }
        let unchanged = self.factor_points == self.active
            && self.active.iter().zip(&self.factor_compliance).all(|(&i, &c)| c == self.compliance[i as usize]);
        if !unchanged {
            self.factor_points.clone_from(&self.active);
            self.factor_compliance.clear();
            self.factor_compliance.extend(self.active.iter().map(|&i| self.compliance[i as usize]));
            self.take_movable(view);
            self.factors += 1;
            self.fill_factor(view);
            let size = self.factor_rows.len();
            if !linear::cholesky_in_place(&mut self.factor, size, &mut self.scratch) {
                // Dependent constraints (one node in two pairs, both sides prescribed): keep an independent subset.
                self.keep_independent(view);
                self.fill_factor(view);
                let size = self.factor_rows.len();
                let positive = linear::cholesky_in_place(&mut self.factor, size, &mut self.scratch);
                assert!(positive, "the rows left by the pivot check are independent");
            }
        }
        self.right.clear();
        self.right.extend(self.factor_rows.iter().map(|&i| free[i as usize] - self.onset[i as usize]));
        linear::cholesky_solve(&self.factor, self.factor_rows.len(), &mut self.right);
        self.trial[..n].fill(0.0);
        for (&i, &force) in self.factor_rows.iter().zip(&self.right) {
            self.trial[i as usize] = force;
        }
    }

    /// Rows of the factor: the active ones less those on a wall that no force can move.
    fn take_movable(&mut self, view: &View<'_>) {
        self.factor_rows.clear();
        for &i in &self.active {
            if !self.on_wall[i as usize] || view.own(i as usize) > self.own_min {
                self.factor_rows.push(i);
            }
        }
    }

    /// The same by sparse solves.
    fn solve_active_sparse(&mut self, view: &View<'_>, free: &[f64]) {
        self.take_movable(view);
        self.right.clear();
        self.factor_compliance.clear();
        for &i in &self.factor_rows {
            self.right.push(free[i as usize] - self.onset[i as usize]);
            self.factor_compliance.push(self.compliance[i as usize]);
        }
        let mut forces = vec![0.0; self.factor_rows.len()];
        let solved = self.sparse.solve(view, &self.factor_rows, &self.factor_compliance, &self.right, &mut forces);
        self.trial.fill(0.0);
        for (&i, force) in self.factor_rows.iter().zip(&forces) {
            // Without a factor nothing is known: the iteration ends as not converged.
            self.trial[i as usize] = if solved { *force } else { f64::NAN };
        }
    }

    /// Whether a row of the factor is on its wall.
    pub(super) fn is_on_wall(&self, row: u32) -> bool {
        self.on_wall[row as usize]
    }

    /// Takes rows that touch their walls as the rows of the factor; whether they have one. The next solve begins with its own.
    pub(super) fn join(&mut self, view: &View<'_>, rows: &[u32]) -> bool {
        for &i in rows {
            let i = i as usize;
            (self.on_wall[i], self.is_active[i]) = (true, true);
            (self.compliance[i], self.onset[i]) = (0.0, view.rows[i].position);
        }
        self.factor_points.clear();
        self.factor_rows.clear();
        self.factor_rows.extend_from_slice(rows);
        self.fill_factor(view);
        self.factors += 1;
        let joined = linear::cholesky_in_place(&mut self.factor, rows.len(), &mut self.scratch);
        if !joined {
            self.forget_factor();
        }
        joined
    }

    /// What the laws miss at the rows of the factor, as overclosures: `h − position` on a wall, `C (F(h) − F)` on a curve.
    pub(super) fn law_gaps(&self, view: &View<'_>, overclosures: &[f64], forces: &[f64], out: &mut [f64]) {
        for &i in &self.factor_rows {
            let i = i as usize;
            let row = &view.rows[i];
            out[i] = match self.on_wall[i] {
                true => overclosures[i] - row.position,
                false => self.compliance[i] * (row.evaluate(view.behaviors, overclosures[i]).force - forces[i]),
            };
        }
    }

    /// `(W + C)⁻¹ right` on the closed points of the last model, zero elsewhere; false when there are none.
    pub(super) fn active_response(&mut self, view: &View<'_>, right: &[f64], out: &mut Vec<f64>) -> bool {
        out.clear();
        out.resize(right.len(), 0.0);
        if self.factor_rows.is_empty() {
            return false;
        }
        self.right.clear();
        self.right.extend(self.factor_rows.iter().map(|&i| right[i as usize]));
        if let Compliance::Sparse(..) = view.compliance {
            let mut x = vec![0.0; self.factor_rows.len()];
            if !self.sparse.solve(view, &self.factor_rows, &self.factor_compliance, &self.right, &mut x) {
                return false;
            }
            self.right = x;
        } else {
            linear::cholesky_solve(&self.factor, self.factor_rows.len(), &mut self.right);
        }
        for (&i, x) in self.factor_rows.iter().zip(&self.right) {
            out[i as usize] = *x;
        }
        true
    }

    /// `W + C` on the rows of the factor, lower triangle used.
    fn fill_factor(&mut self, view: &View<'_>) {
        let Compliance::Dense(w) = view.compliance else { return };
        let size = self.factor_rows.len();
        self.factor.clear();
        self.factor.reserve(size * size);
        for &j in &self.factor_rows {
            let column = w.column(j as usize);
            let begin = self.factor.len();
            self.factor.extend(self.factor_rows.iter().map(|&i| column[i as usize]));
            let diagonal = begin / size.max(1);
            self.factor[begin + diagonal] += self.compliance[j as usize];
        }
    }

    /// Compliance at a point that the last model took part with: that of the bodies and of the law; none at open points.
    pub(super) fn present_compliance(&self, system: &ContactSystem, i: usize) -> Option<f64> {
        let own = system.own(i);
        match self.on_wall[i] {
            true => Some(own),
            false => (self.is_active[i] && self.trial[i] != 0.0).then(|| own + self.compliance[i]),
        }
    }

    /// Reduces the factor's rows to those whose pivot is more than rounding.
    fn keep_independent(&mut self, view: &View<'_>) {
        self.fill_factor(view);
        let size = self.factor_rows.len();
        let a = &mut self.factor;
        let diagonal: Vec<f64> = (0..size).map(|i| a[i * size + i]).collect();
        let mut kept = Vec::with_capacity(size);
        for j in 0..size {
            let pivot = a[j * size + j];
            // A thousand times the limit of the dense factorisation, so that what is kept passes there.
            if pivot.is_nan() || pivot <= 1e-9 * diagonal[j] || diagonal[j] <= 0.0 {
                continue;
            }
            kept.push(self.factor_rows[j]);
            for k in j + 1..size {
                let f = a[j * size + k] / pivot;
                if f != 0.0 {
                    for i in k..size {
                        a[k * size + i] -= f * a[j * size + i];
                    }
                }
            }
        }
        self.factor_rows = kept;
    }

    /// A hard point that was left out as dependent must be satisfied by the others.
    fn check_conflicts(&self, view: &View<'_>, free: &[f64], free_scale: f64) -> Result<(), SolveFailure> {
        let dense = matches!(view.compliance, Compliance::Dense(_));
        if dense && self.factor_rows.len() == self.active.len() {
            return Ok(());
        }
        let limit = (CONFLICT_TOLERANCE * free_scale).max(CONFLICT_ROUNDING * view.extent);
        let conflict = |&i: &u32| -> Option<(u32, f64)> {
            let row = &view.rows[i as usize];
            let overclosure = free[i as usize] - self.relief_trial[i as usize] - row.position;
            // Conjugate gradients do not tell which points depend on others: all are looked at.
            let dependent = self.on_wall[i as usize] && (!dense || self.factor_rows.binary_search(&i).is_err());
            let missed = if row.wall == Wall::TwoSided { overclosure.abs() } else { overclosure };
            (dependent && missed > limit).then_some((i, overclosure))
        };
        let points: Vec<_> = self.active.iter().filter_map(conflict).collect();
        if points.is_empty() { Ok(()) } else { Err(SolveFailure::Infeasible { points }) }
    }

    /// Part of the step to take: 1 unless Π has risen again before its end, else a point near its minimum.
    fn line_search(&self, view: &View<'_>, forces: &[f64], relief: &[f64], overclosures: &[f64]) -> f64 {
        let n = view.rows.len();
        // Π'(t) = (Λ + t dΛ)ᵀ W dΛ − Σ A p(h − t W dΛ) (W dΛ).
        let slope = |t: f64| -> f64 {
            let mut sum = 0.0;
            for i in 0..n {
                let rate = self.relief_trial[i] - relief[i];
                let force = forces[i] + t * (self.trial[i] - forces[i]);
                sum += force * rate;
                let row = &view.rows[i];
                if row.has_curve() {
                    let h = overclosures[i] - t * rate;
                    let h = if row.wall == Wall::None { h } else { h.min(row.position) };
                    sum -= row.evaluate(view.behaviors, h).force * rate;
                }
            }
            sum
        };
        let start = slope(0.0);
        let end = slope(1.0);
        if start >= 0.0 || end <= SLOPE_ACCEPTED * -start {
            return 1.0;
        }
        // Illinois variant of the secant method: keeps the bracket, never stalls.
        let (mut low, mut low_slope, mut high, mut high_slope) = (0.0, start, 1.0, end);
        for _ in 0..60 {
            let t = low + (high - low) * (low_slope / (low_slope - high_slope));
            let at = slope(t);
            if at.abs() <= 0.1 * -start {
                return t;
            }
            if at < 0.0 {
                low = t;
                low_slope = at;
                high_slope *= 0.5;
            } else {
                high = t;
                high_slope = at;
                low_slope *= 0.5;
            }
        }
        if low > 0.0 { low } else { high }
    }

    fn is_balanced(&self, view: &View<'_>, free: &[f64], forces: &[f64], overclosures: &[f64]) -> bool {
        let scale = self.force_scale();
        (0..view.rows.len()).all(|i| self.point_is_balanced(view, i, free, forces, overclosures[i], scale))
    }

    /// Whether the laws are satisfied without springs on the motions.
    pub(super) fn laws_hold(&self, system: &ContactSystem, problem: Problem<'_>, unknowns: &Unknowns<'_>) -> bool {
        self.is_balanced(&system.held(problem.rows, None), problem.free, unknowns.forces, unknowns.overclosures)
    }

    /// Whether the end of the present step satisfies the laws.
    fn trial_is_balanced(&self, view: &View<'_>, free: &[f64]) -> bool {
        let scale = self.force_scale();
        let overclosure = |i: usize| free[i] - self.relief_trial[i];
        (0..view.rows.len()).all(|i| self.point_is_balanced(view, i, free, &self.trial, overclosure(i), scale))
    }

    /// Largest force of the model solution.
    fn force_scale(&self) -> f64 {
        self.trial.iter().fold(0.0f64, |m, f| m.max(f.abs()))
    }

    /// Whether the force of a softened point is that of its law at an overclosure. Hard points are settled by the model.
    fn point_is_balanced(
        &self,
        view: &View<'_>,
        i: usize,
        free: &[f64],
        forces: &[f64],
        overclosure: f64,
        scale: f64,
    ) -> bool {
        let row = &view.rows[i];
        if !row.has_curve() {
            return true;
        }
        if self.on_wall[i] {
            let least = row.evaluate(view.behaviors, row.position).force;
            return row.wall == Wall::TwoSided || forces[i] >= least - FORCE_TOLERANCE * scale;
        }
        let at = row.evaluate(view.behaviors, overclosure);
        let own = view.own(i);
        if !self.is_active[i] && at.stiffness * own <= NEGLIGIBLE_STIFFNESS && own > 0.0 {
            // Left out of the model because its force cannot matter.
            return true;
        }
        let residual = (forces[i] - at.force).abs();
        if residual <= FORCE_TOLERANCE * scale {
            return true;
        }
        // What the rounding of the overclosure does to the force cannot be asked for; at a kink the slope beyond it counts.
        let rounding = view.rounding(i, free[i], overclosure, forces);
        residual <= rounding * at.stiffness
            || residual <= rounding * row.evaluate(view.behaviors, overclosure + rounding).stiffness
    }
}
