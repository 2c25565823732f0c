//! Balance of bodies that only contact holds.
//!
//! Springs `ε` on the motions around their last place make the problem one with every motion held: `W` becomes
//! `W + D ε⁻¹ Dᵀ` and the free overclosures gain `D (α + ε⁻¹ Rᵀ f)`. Then `α ← α + ε⁻¹ (Rᵀ f − Dᵀ F)`, again around the new
//! place: the springs give way until they carry nothing. Each step reduces the force in them by about the ratio of their
//! stiffness to that of the contact. A motion that nothing resists keeps its spring loaded, however far it goes. Once the set of
//! closed points stands, a Newton step on the motions ends the search: also for motions that contact holds only weakly.
//!
//! Source: proximal point method on the multipliers of the balance (Rockafellar 1976); for problems of this kind it converges
//! from any start, linearly at a rate that softer springs make as fast as one likes.

use super::row::{Row, Wall};
use super::view::{Compliance, Springs, View};
use super::{ContactSolver, ContactSystem, Problem, SPRING_RATIO, SolveCounts, SolveFailure, Structure, Unknowns};
use crate::solve::linear::{self, Dense, DenseScratch};

/// Steps before an attempt is given up; five are usual.
const STEPS_MAX: u32 = 200;
/// Force in the springs, relative to the forces in the balance, that is rounding.
const BALANCED: f64 = 1e-13;
/// The same when it no longer gets less: sums over many points round.
const BALANCED_STALLED: f64 = 1e-10;
/// Springs of the last steps under very stiff laws, relative to the stiffness with which closed contact holds the motions.
const POLISHING: f64 = 0.1;
/// A step that leaves more than this part of the force in the springs is slow.
const SLOW: f64 = 0.2;
/// Forces in the balance of a motion, relative to the largest forces of the model, below which they are not its scale.
const SCALE_MIN: f64 = 1e-3;
/// The same against the force that overclosures would cause if nothing moved: a body that swings out of the way ends without any.
const UNRELIEVED_MIN: f64 = 1e-6;
/// Springs become this much softer after a slow step.
const SOFTENING: f64 = 1e-2;
/// Springs this much softer than at the start that still carry load: nothing resists the motion.
const SOFTEST: f64 = 1e-16;

/// Stiffness of closed contact, in series with the springs and relative to them, below which it holds nothing.
const HELD_MIN: f64 = 1e-9;
/// Newton step on the motions, relative to the overclosures and motions at hand, that is rounding.
const NEGLIGIBLE_STEP: f64 = 1e-14;

/// Load along a motion that contact never resists, relative to what its forces would do without cancelling, that is rounding.
const LOAD_ROUNDING: f64 = 1e-10;

/// Work space of the balance.
#[derive(Default)]
pub(super) struct BalanceWork {
    pub held: HeldCompliance,
    pub steps: Steps,
}

/// `W + D ε⁻¹ Dᵀ` and the springs that went into it.
#[derive(Default)]
pub(super) struct HeldCompliance {
    compliance: Dense,
    pub springs: Vec<f64>,
}

/// How far the closed points hold the motions that are still loaded.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Hold {
    Full,
    Partial,
    None,
}

/// Vectors of a step.
#[derive(Default)]
pub(super) struct Steps {
    free: Vec<f64>,
    place: Vec<f64>,
    pub residual: Vec<f64>,
    /// What the laws miss, and what motions add to it.
    pub gaps: Vec<f64>,
    scales: Vec<f64>,
    /// `S` in units of the springs.
    stiffness: Dense,
    pub factor: Vec<f64>,
    /// Whether that is the factor of the last step: closed points hold every motion.
    pub is_held: bool,
    scratch: DenseScratch,
    pub response: Vec<f64>,
    pub newton: Vec<f64>,
    /// Motions that the springs give: a step that always leads on.
    safe: Vec<f64>,
    /// The last balance found.
    kept_forces: Vec<f64>,
    kept_closed: Vec<bool>,
    kept_motions: Vec<f64>,
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
            let view = system.held(problem.rows, None);
            let scale = problem.free.iter().fold(0.0f64, |m, h| m.max(h.abs()));
            let counts = self.solve_held(&view, problem.free, scale, unknowns)?;
            if self.share(&view, scale, unknowns).is_some() {
                view.relief(unknowns.forces, unknowns.relief);
                system.overclosures(problem.free, unknowns.relief, unknowns.motions, unknowns.overclosures);
            }
            return Ok(counts);
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
        let BalanceWork { held, steps } = work;
        let (n, k) = (system.count, system.gap_motions.columns);
        for z in 0..system.loose.columns {
            let combination = system.loose.column(z);
            let (mut load, mut scale) = (0.0, 0.0);
            for m in 0..k {
                load += combination[m] * problem.load[m];
                scale += (combination[m] * problem.load_scale[m]).abs();
            }
            if load.abs() > LOAD_ROUNDING * scale {
                return Err(SolveFailure::Unheld { motions: combination.to_vec() });
            }
        }
        let mut counts = SolveCounts::default();
        // Residual of the last place that was kept; where to go back to if a Newton step does not reduce it.
        let (mut last, mut retreat, mut trusted, mut polished) = (f64::INFINITY, false, true, false);
        // Whether a Newton step has been taken: then also weakly held motions stand where they should.
        let (mut refined, mut kept) = (false, false);
        for _ in 0..STEPS_MAX {
            if held.hold(system, unknowns.springs) {
                self.forget_factor();
            }
            let scale = steps.free_overclosures(system, problem, unknowns);
            let view = held.view(system, problem.rows);
            view.relief(unknowns.forces, unknowns.relief);
            let done = match self.solve_held(&view, &steps.free, scale, unknowns) {
                Ok(done) => done,
                // A point at the kink of its law may flip for ever by rounding; a balance found before that stands.
                Err(_) if kept => {
                    unknowns.forces.copy_from_slice(&steps.kept_forces);
                    unknowns.closed.copy_from_slice(&steps.kept_closed);
                    unknowns.motions.copy_from_slice(&steps.kept_motions);
                    system.relief(unknowns.forces, unknowns.relief);
                    system.overclosures(problem.free, unknowns.relief, unknowns.motions, unknowns.overclosures);
                    return Ok(counts);
                }
                Err(failure) => return Err(steps.escape(system, problem, &held.springs).unwrap_or(failure)),
            };
            counts.equilibrium_iterations += done.equilibrium_iterations;
            counts.severe_discontinuity_iterations += done.severe_discontinuity_iterations;
            counts.factorizations += done.factorizations;
            let worst = steps.measure(system, problem, unknowns);
            if std::mem::take(&mut retreat) && worst > 0.5 * last && worst > BALANCED_STALLED {
                // The Newton step led to another set of closed points: the safe one instead.
                unknowns.motions.copy_from_slice(&steps.safe);
                trusted = false;
                continue;
            }
            let slow = worst > SLOW * last;
            let hold = self.newton_step(system, &view, &held.springs, steps);
            let stiffened = self.adjust_springs(system, unknowns.springs, slow && hold != Hold::Full);
            for m in 0..k {
                steps.safe[m] = unknowns.motions[m] + steps.residual[m] / held.springs[m];
            }
            if worst <= BALANCED_STALLED {
                kept = true;
                steps.keep(unknowns);
            }
            let size = steps.safe.iter().fold(scale, |s, a| s.max(a.abs()));
            let small = hold != Hold::None && steps.newton.iter().all(|s| s.abs() <= NEGLIGIBLE_STEP * size);
            if !stiffened
                && (worst <= BALANCED_STALLED && (slow || small)
                    || worst <= BALANCED && (refined || hold == Hold::None))
            {
                unknowns.motions.copy_from_slice(&steps.safe);
                system.relief(unknowns.forces, unknowns.relief);
                system.overclosures(problem.free, unknowns.relief, unknowns.motions, unknowns.overclosures);
                if polished || self.laws_hold(system, problem, unknowns) {
                    if steps.is_held {
                        self.refine(system, problem, &view, &held.springs, steps, unknowns);
                    }
                    if let Some(rows) = self.share(&view, scale, unknowns) {
                        system.relief(unknowns.forces, unknowns.relief);
                        system.overclosures(problem.free, unknowns.relief, unknowns.motions, unknowns.overclosures);
                        // One point may carry a block that touches with many: then only all of them hold its place.
                        if !steps.is_held && self.join(&view, &rows) {
                            self.newton_step(system, &view, &held.springs, steps);
                            if steps.is_held {
                                self.refine(system, problem, &view, &held.springs, steps, unknowns);
                            }
                        }
                    }
                    return Ok(counts);
                }
                // Laws much stiffer than the bodies feel the rounding of the soft springs.
                polished = true;
                let fitting = |m: usize| POLISHING * self.holding_stiffness(system, m);
                (unknowns.springs.iter_mut().enumerate()).for_each(|(m, s)| *s = s.max(fitting(m)));
                last = f64::INFINITY;
                continue;
            }
            if unknowns.springs.iter().zip(&system.springs).any(|(now, first)| *now < SOFTEST * first) {
                let way = steps.residual.iter().zip(&held.springs).map(|(r, spring)| r / spring).collect();
                return Err(SolveFailure::Unheld { motions: way });
            }
            last = worst;
            if hold != Hold::None && trusted && !stiffened {
                unknowns.motions.iter_mut().zip(&steps.newton).for_each(|(a, step)| *a += step);
                retreat = true;
                refined = true;
            } else {
                unknowns.motions.copy_from_slice(&steps.safe);
                trusted = true;
            }
        }
        let closed = (0..n as u32).filter(|&i| unknowns.closed[i as usize]).collect();
        let failure = SolveFailure::NotConverged { points: closed };
        Err(steps.escape(system, problem, &held.springs).unwrap_or(failure))
    }

    /// Newton step on the motions with the closed points as they are: `S⁻¹ (Rᵀ f − Dᵀ F)` with the stiffness
    /// `S = Dᵀ (W + C + D ε⁻¹ Dᵀ)⁻¹ D` that they and the springs have in series. Directions that no closed point holds go as far as
    /// their springs give: only partly held. Not at all where nothing is closed: there is no step then.
    fn newton_step(&mut self, system: &ContactSystem, view: &View<'_>, springs: &[f64], steps: &mut Steps) -> Hold {
        let k = springs.len();
        steps.is_held = false;
        steps.stiffness.rows = k;
        steps.stiffness.columns = k;
        steps.stiffness.values.clear();
        steps.stiffness.values.resize(k * k, 0.0);
        for m in (0..k).filter(|&m| system.resisted[m]) {
            if !self.active_response(view, system.gap_motions.column(m), &mut steps.response) {
                return Hold::None;
            }
            for l in (0..k).filter(|&l| system.resisted[l]) {
                let d = system.gap_motions.column(l);
                let stiffness: f64 = d.iter().zip(&steps.response).map(|(d, x)| d * x).sum();
                // In units of the springs: between 0, not held, and 1, held by something much stiffer.
                steps.stiffness.values[m * k + l] = stiffness / (springs[l] * springs[m]).sqrt();
            }
        }
        for m in (0..k).filter(|&m| !system.resisted[m]) {
            steps.stiffness.values[m * k + m] = 1.0;
        }
        steps.factor.clone_from(&steps.stiffness.values);
        let regular = linear::cholesky_in_place(&mut steps.factor, k, &mut steps.scratch)
            && (0..k).all(|m| steps.factor[m * k + m].powi(2) > HELD_MIN);
        if !regular {
            return steps.partial_step(springs);
        }
        steps.newton.clear();
        steps.newton.extend(steps.residual.iter().zip(springs).map(|(r, spring)| r / spring.sqrt()));
        linear::cholesky_solve(&steps.factor, k, &mut steps.newton);
        steps.newton.iter_mut().zip(springs).for_each(|(step, spring)| *step /= spring.sqrt());
        steps.is_held = true;
        Hold::Full
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

impl HeldCompliance {
    /// The rows of a system with the springs that are held.
    pub fn view<'a>(&'a self, system: &'a ContactSystem, rows: &'a [Row]) -> View<'a> {
        let compliance = match &system.structure {
            Structure::Dense(_) => Compliance::Dense(&self.compliance),
            Structure::Sparse(sparse) => Compliance::Sparse(
                sparse,
                Some(Springs { gaps: &system.gap_motions, springs: &self.springs, resisted: &system.resisted }),
            ),
        };
        system.held(rows, Some(compliance))
    }

    /// Takes springs over, with `W + D ε⁻¹ Dᵀ` where there is a `W`; whether that is another one than before.
    fn hold(&mut self, system: &ContactSystem, springs: &[f64]) -> bool {
        if self.springs == springs {
            return false;
        }
        self.springs.clear();
        self.springs.extend_from_slice(springs);
        let Structure::Dense(compliance) = &system.structure else { return false };
        let n = compliance.rows;
        (self.compliance.rows, self.compliance.columns) = (n, n);
        self.compliance.values.clone_from(&compliance.values);
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
}

impl Steps {
    /// Keeps a balance that was found.
    fn keep(&mut self, unknowns: &Unknowns<'_>) {
        self.kept_forces.clear();
        self.kept_forces.extend_from_slice(unknowns.forces);
        self.kept_closed.clear();
        self.kept_closed.extend_from_slice(unknowns.closed);
        self.kept_motions.clone_from(&self.safe);
    }

    /// The Newton step where the closed points hold some directions only: the others go as far as their springs give.
    fn partial_step(&mut self, springs: &[f64]) -> Hold {
        let k = springs.len();
        let (values, vectors) = linear::eigen(&self.stiffness);
        self.newton.fill(0.0);
        let mut hold = Hold::Full;
        for (value, v) in values.iter().zip(vectors.values.chunks_exact(k.max(1))) {
            let along: f64 = (0..k).map(|m| v[m] * self.residual[m] / springs[m].sqrt()).sum();
            let is_held = *value > HELD_MIN;
            if !is_held && along != 0.0 {
                hold = Hold::Partial;
            }
            let amount = if is_held { along / value } else { along };
            (0..k).for_each(|m| self.newton[m] += amount * v[m] / springs[m].sqrt());
        }
        hold
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

    /// A proof that nothing holds the way the springs give: the loads push along it, and no overclosure gets larger on it.
    fn escape(&self, system: &ContactSystem, problem: Problem<'_>, springs: &[f64]) -> Option<SolveFailure> {
        let way: Vec<f64> = self.residual.iter().zip(springs).map(|(r, spring)| r / spring).collect();
        let pushed: f64 = way.iter().zip(problem.load).map(|(z, load)| z * load).sum();
        let mut overclosures = vec![0.0; system.count];
        system.gap_motions.multiply_add(&way, &mut overclosures);
        let largest = overclosures.iter().fold(0.0f64, |m, h| m.max(h.abs()));
        // A two-sided wall resists both ways.
        let gives = |(h, row): (&f64, &Row)| match row.wall {
            Wall::None if !row.has_curve() => true,
            Wall::TwoSided => h.abs() <= 1e-9 * largest,
            Wall::None | Wall::OneSided => *h <= 1e-9 * largest,
        };
        let opens = overclosures.iter().zip(problem.rows).all(gives);
        (opens && pushed > 0.0).then_some(SolveFailure::Unheld { motions: way })
    }

    /// What the springs carry; returns the largest of it against the forces in the balance.
    fn measure(&mut self, system: &ContactSystem, problem: Problem<'_>, unknowns: &Unknowns<'_>) -> f64 {
        let k = problem.load.len();
        self.residual.clear();
        self.newton.resize(k, 0.0);
        self.safe.resize(k, 0.0);
        self.scales.clear();
        for m in 0..k {
            if !system.resisted[m] {
                self.residual.push(0.0);
                self.scales.push(0.0);
                continue;
            }
            let (mut sum, mut scale) = (0.0, problem.load_scale[m]);
            for (d, f) in system.gap_motions.column(m).iter().zip(&*unknowns.forces) {
                sum += d * f;
                scale += (d * f).abs();
            }
            self.residual.push(problem.load[m] - sum);
            self.scales.push(scale);
        }
        // A motion that carries next to nothing is judged by what goes on elsewhere.
        let forces = unknowns.forces.iter().fold(0.0f64, |m, f| m.max(f.abs()));
        let unrelieved = (problem.free.iter().zip(problem.rows).enumerate())
            .map(|(i, (h, row))| match row.wall {
                Wall::None => row.evaluate(&system.behaviors, *h).force.abs(),
                Wall::OneSided => (h - row.position).max(0.0) / system.own(i),
                Wall::TwoSided => (h - row.position).abs() / system.own(i),
            })
            .filter(|force| force.is_finite())
            .fold(0.0f64, f64::max);
        let least = (SCALE_MIN * self.scales.iter().fold(forces, |m, s| m.max(*s))).max(UNRELIEVED_MIN * unrelieved);
        let relative = |(r, s): (&f64, &f64)| if *r == 0.0 { 0.0 } else { r.abs() / s.max(least) };
        self.residual.iter().zip(&self.scales).map(relative).fold(0.0f64, f64::max)
    }
}
