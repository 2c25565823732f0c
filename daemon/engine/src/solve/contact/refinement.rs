//! Iterative refinement of a balance that was found with springs on the motions.
//!
//! With the closed points as they are, forces and motions solve
//!
//! ```text
//! (W + C) dF − D dα = g = C (F(h) − F), h − position on walls          Dᵀ dF = r = Rᵀ f − Dᵀ F
//! ```
//!
//! The factor at hand is that of `M = W + C + D ε⁻¹ Dᵀ`. With `x = dα + ε⁻¹ r` the equations are `M dF = g + D x` and
//! `S x = r − Dᵀ M⁻¹ g`, `S = Dᵀ M⁻¹ D`, which the last Newton step has factored. What soft springs and a stiff law cost in digits
//! comes back. A step of augmented Lagrange is the same with `g = h + c0` at its closed points, known to all its digits.

use super::balance::{BalanceWork, Steps};
use super::row::Row;
use super::view::View;
use super::{ContactSolver, ContactSystem, Problem, Unknowns};
use crate::solve::linear;

/// Corrections; each gains what the factor has in digits.
const STEPS: u32 = 3;
/// Correction of the forces, relative to the largest, above which the factor is not that of this balance.
const CORRECTION_MAX: f64 = 1e-6;

impl ContactSolver {
    /// `dF` into `steps.response` and `x` into `steps.newton` for the gaps and residuals in `steps`.
    fn respond(&mut self, system: &ContactSystem, view: &View<'_>, springs: &[f64], steps: &mut Steps) -> bool {
        let k = springs.len();
        if !self.active_response(view, &steps.gaps, &mut steps.response) {
            return false;
        }
        steps.newton.clear();
        for m in 0..k {
            let along: f64 = system.gap_motions.column(m).iter().zip(&steps.response).map(|(d, f)| d * f).sum();
            let right = if system.resisted[m] { steps.residual[m] - along } else { 0.0 };
            steps.newton.push(right / springs[m].sqrt());
        }
        linear::cholesky_solve(&steps.factor, k, &mut steps.newton);
        for (m, x) in steps.newton.iter_mut().enumerate() {
            *x /= springs[m].sqrt();
            for (gap, d) in steps.gaps.iter_mut().zip(system.gap_motions.column(m)) {
                *gap += d * *x;
            }
        }
        self.active_response(view, &steps.gaps, &mut steps.response)
    }

    /// What a change of the onsets by `−gaps` does with the closed points as they are: adds it to forces, motions and overclosures.
    /// False, with nothing changed, where the last solve left no factor for that.
    pub fn correct(&mut self, system: &ContactSystem, rows: &[Row], gaps: &[f64], unknowns: &mut Unknowns<'_>) -> bool {
        let mut work = std::mem::take(&mut self.balance);
        let BalanceWork { held, steps } = &mut work;
        steps.gaps.clear();
        steps.gaps.extend_from_slice(gaps);
        let k = system.gap_motions.columns;
        let solved = if k == 0 {
            steps.newton.clear();
            self.active_response(&system.held(rows, None), &steps.gaps, &mut steps.response)
        } else {
            steps.residual.clear();
            steps.residual.resize(k, 0.0);
            steps.is_held && self.respond(system, &held.view(system, rows), &held.springs, steps)
        };
        if solved {
            // dh = −W dF + D dα
            system.relief(&steps.response, unknowns.relief);
            unknowns.forces.iter_mut().zip(&steps.response).for_each(|(f, df)| *f += df);
            unknowns.overclosures.iter_mut().zip(&*unknowns.relief).for_each(|(h, relief)| *h -= relief);
            for m in (0..k).filter(|&m| system.resisted[m]) {
                let x = steps.newton[m];
                unknowns.motions[m] += x;
                for (h, d) in unknowns.overclosures.iter_mut().zip(system.gap_motions.column(m)) {
                    *h += d * x;
                }
            }
        }
        system.relief(unknowns.forces, unknowns.relief);
        self.balance = work;
        solved
    }

    /// Refines forces and motions; relief and overclosures follow them.
    pub(super) fn refine(
        &mut self,
        system: &ContactSystem,
        problem: Problem<'_>,
        view: &View<'_>,
        springs: &[f64],
        steps: &mut Steps,
        unknowns: &mut Unknowns<'_>,
    ) {
        let (n, k) = (system.count, springs.len());
        for _ in 0..STEPS {
            steps.gaps.clear();
            steps.gaps.resize(n, 0.0);
            self.law_gaps(view, unknowns.overclosures, unknowns.forces, &mut steps.gaps);
            steps.residual.clear();
            for m in 0..k {
                let carried: f64 = system.gap_motions.column(m).iter().zip(&*unknowns.forces).map(|(d, f)| d * f).sum();
                steps.residual.push(if system.resisted[m] { problem.load[m] - carried } else { 0.0 });
            }
            if !self.respond(system, view, springs, steps) {
                return;
            }
            let largest = |v: &[f64]| v.iter().fold(0.0f64, |m, f| m.max(f.abs()));
            let correction = largest(&steps.response);
            if correction.is_nan() || correction > CORRECTION_MAX * largest(unknowns.forces) {
                return;
            }
            unknowns.forces.iter_mut().zip(&steps.response).for_each(|(f, df)| *f += df);
            for (m, alpha) in unknowns.motions.iter_mut().enumerate().filter(|&(m, _)| system.resisted[m]) {
                *alpha += steps.newton[m] - steps.residual[m] / springs[m];
            }
            system.relief(unknowns.forces, unknowns.relief);
            system.overclosures(problem.free, unknowns.relief, unknowns.motions, unknowns.overclosures);
        }
    }
}
