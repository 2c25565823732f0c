//! Balance of bodies that only contact holds.
//!
//! Springs `ε` on the motions around their last place make the problem one with every motion held: `W` becomes
//! `W + D ε⁻¹ Dᵀ` and the free overclosures gain `D (α + ε⁻¹ Rᵀ f)`. Then `α ← α + ε⁻¹ (Rᵀ f − Dᵀ F)`, again around the new
//! place: the springs give way until they carry nothing. Each step reduces the force in them by about the ratio of their
//! stiffness to that of the contact. A motion that nothing resists keeps its spring loaded, however far it goes.
//!
//! Source: proximal point method on the multipliers of the balance (Rockafellar 1976); for problems of this kind it converges
//! from any start, linearly at a rate that softer springs make as fast as one likes.

use super::view::{Compliance, Springs};
use super::{ContactSolver, ContactSystem, Problem, SPRING_RATIO, SolveCounts, SolveFailure, Structure, Unknowns};
use crate::solve::linear::Dense;

/// Steps before an attempt is given up; five are usual.
const STEPS_MAX: u32 = 100;
/// Force in the springs, relative to the forces in the balance, that is rounding.
const BALANCED: f64 = 1e-13;
/// The same when it no longer gets less: sums over many points round.
const BALANCED_STALLED: f64 = 1e-10;
/// Springs of the last steps under very stiff laws, relative to the stiffness with which closed contact holds the motions.
const POLISHING: f64 = 0.1;
/// A step that leaves more than this part of the force in the springs is slow.
const SLOW: f64 = 0.2;
/// Springs become this much softer after a slow step.
const SOFTENING: f64 = 1e-2;
/// Springs this much softer than at the start that still carry load: nothing resists the motion.
const SOFTEST: f64 = 1e-16;

/// Work space of the balance.
#[derive(Default)]
pub(super) struct BalanceWork {
    /// `W + D ε⁻¹ Dᵀ` and the springs that went into it.
    compliance: Dense,
    springs: Vec<f64>,
    free: Vec<f64>,
    place: Vec<f64>,
    residual: Vec<f64>,
}

impl ContactSolver {
    /// Solves for contact forces and motions; `springs` stay as they are where no motion is free. On failure the unknowns are left as they are at that moment.
    pub fn solve(
        &mut self,
        system: &ContactSystem,
        problem: Problem<'_>,
        unknowns: &mut Unknowns<'_>,
    ) -> Result<SolveCounts, SolveFailure> {
        if system.gap_motions.columns == 0 {
            let view = system.held(None);
            let scale = problem.free.iter().fold(0.0f64, |m, h| m.max(h.abs()));
            return self.solve_held(&view, problem.free, scale, unknowns);
        }
        let mut work = std::mem::take(&mut self.balance);
        let result = self.balance(system, problem, unknowns, &mut work);
        self.balance = work;
        result
    }

    fn balance(
        &mut self,
        system: &ContactSystem,
        problem: Problem<'_>,
        unknowns: &mut Unknowns<'_>,
        work: &mut BalanceWork,
    ) -> Result<SolveCounts, SolveFailure> {
        let (n, k) = (system.points.len(), system.gap_motions.columns);
        let unheld = |m: usize| {
            let mut motions = vec![0.0; k];
            motions[m] = problem.load[m];
            SolveFailure::Unheld { motions }
        };
        if let Some(m) =
            (0..k).find(|&m| !system.resisted[m] && problem.load[m].abs() > BALANCED_STALLED * problem.load_scale[m])
        {
            return Err(unheld(m));
        }
        let mut counts = SolveCounts::default();
        let mut previous = f64::INFINITY;
        let mut polished = false;
        for _ in 0..STEPS_MAX {
            if work.hold(system, unknowns.springs) {
                self.forget_factor();
            }
            let scale = work.free_overclosures(system, problem, unknowns);
            let view = system.held(Some(match &system.structure {
                Structure::Dense(_) => Compliance::Dense(&work.compliance),
                Structure::Sparse(sparse) => Compliance::Sparse(
                    sparse,
                    Some(Springs { gaps: &system.gap_motions, springs: &work.springs, resisted: &system.resisted }),
                ),
            }));
            view.relief(unknowns.forces, unknowns.relief);
            let done = self.solve_held(&view, &work.free, scale, unknowns)?;
            counts.equilibrium_iterations += done.equilibrium_iterations;
            counts.severe_discontinuity_iterations += done.severe_discontinuity_iterations;
            counts.factorizations += done.factorizations;
            let worst = work.move_on(system, problem, unknowns);
            let slow = worst > SLOW * previous;
            let stiffened = self.adjust_springs(system, unknowns.springs, slow);
            if !stiffened && (worst <= BALANCED || (worst <= BALANCED_STALLED && slow)) {
                system.relief(unknowns.forces, unknowns.relief);
                system.overclosures(problem.free, unknowns.relief, unknowns.motions, unknowns.overclosures);
                if polished || self.laws_hold(system, problem.free, unknowns) {
                    return Ok(counts);
                }
                // Laws much stiffer than the bodies feel the rounding of the soft springs.
                polished = true;
                let fitting = |m: usize| POLISHING * self.holding_stiffness(system, m);
                (unknowns.springs.iter_mut().enumerate()).for_each(|(m, s)| *s = s.max(fitting(m)));
                previous = f64::INFINITY;
                continue;
            }
            if unknowns.springs.iter().zip(&system.springs).any(|(now, first)| *now < SOFTEST * first) {
                return Err(SolveFailure::Unheld { motions: work.residual.clone() });
            }
            previous = worst;
        }
        Err(SolveFailure::NotConverged { points: (0..n as u32).filter(|&i| unknowns.closed[i as usize]).collect() })
    }

    /// Springs for the next step: soft against the closed contact that holds each motion; ever softer while a motion goes on
    /// without meeting resistance. Whether one became stiffer: what was found with springs that soft lacks digits.
    fn adjust_springs(&self, system: &ContactSystem, springs: &mut [f64], slow: bool) -> bool {
        let mut stiffened = false;
        for (m, spring) in springs.iter_mut().enumerate().filter(|&(m, _)| system.resisted[m]) {
            let fitting = SPRING_RATIO * self.holding_stiffness(system, m);
            *spring = match slow {
                true if fitting > 0.0 && fitting < 0.1 * *spring => fitting,
                true => SOFTENING * *spring,
                // After a long way through softer and softer springs: back to what keeps the digits.
                false if *spring < SOFTENING * fitting => {
                    stiffened = true;
                    fitting
                }
                false => *spring,
            };
        }
        stiffened
    }

    /// Stiffness with which the closed points hold a motion, each on its own.
    fn holding_stiffness(&self, system: &ContactSystem, motion: usize) -> f64 {
        (system.gap_motions.column(motion).iter().enumerate())
            .filter_map(|(i, d)| self.present_compliance(system, i).map(|c| d * d / c))
            .filter(|stiffness| stiffness.is_finite())
            .sum()
    }
}

impl BalanceWork {
    /// Takes springs over, with `W + D ε⁻¹ Dᵀ` where there is a `W`; whether that is another one than before.
    fn hold(&mut self, system: &ContactSystem, springs: &[f64]) -> bool {
        if self.springs == springs {
            return false;
        }
        self.springs.clear();
        self.springs.extend_from_slice(springs);
        let Structure::Dense(compliance) = &system.structure else { return false };
        self.compliance.clone_from(compliance);
        let n = self.compliance.rows;
        for (m, spring) in springs.iter().enumerate().filter(|&(m, _)| system.resisted[m]) {
            let d = system.gap_motions.column(m);
            for j in (0..n).filter(|&j| d[j] != 0.0) {
                let factor = d[j] / spring;
                for (w, di) in self.compliance.column_mut(j).iter_mut().zip(d) {
                    *w += factor * di;
                }
            }
        }
        true
    }

    /// `h_free + D (α + ε⁻¹ Rᵀ f)`; returns the size of overclosures against which rounding is judged.
    fn free_overclosures(&mut self, system: &ContactSystem, problem: Problem<'_>, unknowns: &Unknowns<'_>) -> f64 {
        self.place.clear();
        self.place.extend_from_slice(unknowns.motions);
        self.free.clear();
        self.free.extend_from_slice(problem.free);
        system.gap_motions.multiply_add(&self.place, &mut self.free);
        let largest = |free: &[f64]| free.iter().fold(0.0f64, |m, h| m.max(h.abs()));
        let scale = largest(&self.free);
        for (m, place) in self.place.iter_mut().enumerate() {
            *place = if system.resisted[m] { problem.load[m] / unknowns.springs[m] } else { 0.0 };
        }
        system.gap_motions.multiply_add(&self.place, &mut self.free);
        // Far away places round more: a twentieth of their size keeps the tolerances above that.
        scale.max(0.05 * largest(&self.free))
    }

    /// Moves by what the springs carry; returns the largest of it against the forces in the balance.
    fn move_on(&mut self, system: &ContactSystem, problem: Problem<'_>, unknowns: &mut Unknowns<'_>) -> f64 {
        let mut worst = 0.0f64;
        self.residual.clear();
        for m in 0..problem.load.len() {
            if !system.resisted[m] {
                self.residual.push(0.0);
                continue;
            }
            let (mut sum, mut scale) = (0.0, problem.load_scale[m]);
            for (d, f) in system.gap_motions.column(m).iter().zip(&*unknowns.forces) {
                sum += d * f;
                scale += (d * f).abs();
            }
            let residual = problem.load[m] - sum;
            unknowns.motions[m] += residual / unknowns.springs[m];
            if residual != 0.0 {
                worst = worst.max(residual.abs() / scale);
            }
            self.residual.push(residual);
        }
        worst
    }
}
