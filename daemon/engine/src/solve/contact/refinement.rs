//! Iterative refinement of a balance that was found with springs on the motions.
//!
//! With the closed points as they are, forces and motions solve
//!
//! ```text
//! (W + C) dF − D dα = g = h − onset − C F          Dᵀ dF = r = Rᵀ f − Dᵀ F
//! ```
//!
//! The factor at hand is that of `M = W + C + D ε⁻¹ Dᵀ`. With `x = dα + ε⁻¹ r` the equations are `M dF = g + D x` and
//! `S x = r − Dᵀ M⁻¹ g`, `S = Dᵀ M⁻¹ D`, which the last Newton step has factored. What soft springs and a stiff law cost in digits
//! comes back.

use super::balance::Steps;
use super::view::View;
use super::{ContactSolver, ContactSystem, Problem, Unknowns};
use crate::solve::linear;

/// Corrections; each gains what the factor has in digits.
const STEPS: u32 = 2;
/// Correction of the forces, relative to the largest, above which the factor is not that of this balance.
const CORRECTION_MAX: f64 = 1e-6;

impl ContactSolver {
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
            self.law_gaps(unknowns.overclosures, unknowns.forces, &mut steps.gaps);
            if !self.active_response(view, &steps.gaps, &mut steps.response) {
                return;
            }
            steps.residual.clear();
            steps.newton.clear();
            for m in 0..k {
                let d = system.gap_motions.column(m);
                let along = |v: &[f64]| d.iter().zip(v).map(|(d, f)| d * f).sum::<f64>();
                let missing = if system.resisted[m] { problem.load[m] - along(unknowns.forces) } else { 0.0 };
                let right = if system.resisted[m] { missing - along(&steps.response) } else { 0.0 };
                steps.residual.push(missing);
                steps.newton.push(right / springs[m].sqrt());
            }
            linear::cholesky_solve(&steps.factor, k, &mut steps.newton);
            for (m, x) in steps.newton.iter_mut().enumerate() {
                *x /= springs[m].sqrt();
                for (gap, d) in steps.gaps.iter_mut().zip(system.gap_motions.column(m)) {
                    *gap += d * *x;
                }
            }
            if !self.active_response(view, &steps.gaps, &mut steps.response) {
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
