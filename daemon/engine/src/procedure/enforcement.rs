//! Equilibrium of an increment under every enforcement of contact.
//!
//! The contact solve finds the equilibrium of rows that stand as they are. Around it, until nothing changes:
//!
//! 1. points of modified hard contact change their status by the state table (`modified_hard.rs`);
//! 2. closed points under rough friction stick, open ones are free;
//! 3. tangential dashpots follow the coefficient at their point's clearance;
//! 4. augmented Lagrange: where a penetration exceeds the tolerance, or a multiplier that is too large holds a point off by as
//!    much, every multiplier becomes the present pressure, `λ ← max(0, λ + k (h + c0))`. The compliances stay, so no factor is computed again.

use super::modified_hard::{Judged, Verdict, judge, withdraw};
use super::rows::Moment;
use crate::model::FrictionOnset;
use crate::simulation::Simulation;
use crate::solve::contact::{ContactSolver, ContactSystem, Problem, SolveCounts, SolveFailure, Unknowns, Wall};

/// Solves of one increment before it is given up.
const ROUNDS_MAX: u32 = 2000;
/// Changes of status of one point in an increment: more are chatter.
const CHANGES_MAX: u8 = 3;
/// Overclosure of a hard point, relative to the largest overclosure without contact, that is rounding.
const OVERCLOSURE_ROUNDING: f64 = 1e-12;
/// Contact force, relative to the largest, that is rounding.
const FORCE_ROUNDING: f64 = 1e-11;
/// Clearance, relative to the interface, at which surfaces touch at the start of an increment.
const TOUCHING: f64 = 1e-9;
/// Change of a tangential damping coefficient, relative to the normal one of closed points, that matters.
const COEFFICIENT_ROUNDING: f64 = 1e-10;

/// Work of an increment.
#[derive(Clone, Copy, Debug, Default)]
pub struct IncrementCounts {
    /// Work of the contact solves.
    pub solves: SolveCounts,
    /// Augmentations.
    pub augmentations: u32,
}

/// Bodies as contact sees them, and what solves for its forces.
pub(crate) struct Coupling<'a> {
    pub system: &'a ContactSystem,
    pub solver: &'a mut ContactSolver,
}

impl Simulation {
    /// Where the present step stands at a step time.
    pub(crate) fn moment(prepared: &crate::prepared::PreparedModel, step: usize, time: f64) -> Moment<'_> {
        let period = prepared.model.steps[step].procedure.period();
        let progress = (time / period).min(1.0);
        Moment { model: &prepared.model, plan: &prepared.rows, step, progress, period }
    }

    /// Finds equilibrium for the free overclosures and loads in the work space. A dashpot's speed is the way from
    /// `work.starts` over `size` \[time\], which is the increment of a static step.
    pub(crate) fn equilibrium(
        &mut self,
        coupling: &mut Coupling<'_>,
        time: f64,
        size: f64,
    ) -> Result<IncrementCounts, SolveFailure> {
        let prepared = self.prepared.clone();
        let moment = Self::moment(&prepared, self.state.step as usize, time);
        self.begin_rows(&moment, size);
        let mut counts = IncrementCounts::default();
        let mut rescued = false;
        for _ in 0..ROUNDS_MAX {
            let work = &mut self.work;
            let problem =
                Problem { rows: &work.rows, free: &work.free, load: &work.load, load_scale: &work.load_scale };
            let mut unknowns = Unknowns {
                forces: &mut work.forces,
                relief: &mut work.relief,
                closed: &mut work.closed,
                overclosures: &mut work.overclosures,
                motions: &mut work.motions,
                springs: &mut work.springs,
            };
            match coupling.solver.solve(coupling.system, problem, &mut unknowns) {
                Ok(solved) => {
                    counts.solves.equilibrium_iterations += solved.equilibrium_iterations;
                    counts.solves.severe_discontinuity_iterations += solved.severe_discontinuity_iterations;
                    counts.solves.factorizations += solved.factorizations;
                }
                // Points that nothing holds yet may be about to stick or to close.
                Err(_) if !rescued && self.rescue(&moment) => {
                    rescued = true;
                    continue;
                }
                Err(failure) => return Err(failure),
            }
            let changed = self.change_status(&moment)? | self.change_sticking(&moment);
            if changed {
                counts.solves.severe_discontinuity_iterations += 1;
                continue;
            }
            if self.follow_clearances(&moment, size) {
                continue;
            }
            self.note_penetrations(&moment);
            loop {
                match self.augment(coupling, &moment) {
                    Augmented::Enough => return Ok(counts),
                    Augmented::Solved => counts.augmentations += 1,
                    Augmented::ToSolve => {
                        counts.augmentations += 1;
                        break;
                    }
                }
                if counts.augmentations > ROUNDS_MAX {
                    return Err(SolveFailure::Unsettled);
                }
            }
        }
        Err(SolveFailure::Unsettled)
    }

    /// Rows, statuses and multipliers at the start of an attempt.
    fn begin_rows(&mut self, moment: &Moment<'_>, size: f64) {
        let (state, work, now) = (&self.state, &mut self.work, &self.derived.overclosures);
        let points = moment.plan.points();
        work.changes.clear();
        work.changes.resize(points, 0);
        work.multipliers.clone_from(&state.multipliers);
        work.rows.clear();
        for i in 0..points {
            let mut row = moment.normal_row(state, i, state.closed[i], work.multipliers[i]);
            row.dashpot = moment.dashpot(i, work.starts[i], size);
            // A pair that no longer acts begins open.
            work.closed[i] = state.closed[i] && moment.is_active(i);
            work.rows.push(row);
        }
        for (k, &tangential) in (points..).zip(&moment.plan.tangential) {
            let point = tangential.point as usize;
            let touches = state.closed[point] || now[point] >= -TOUCHING * moment.plan.length(point);
            let tied = moment.sticks(point, touches, state.closed[point]);
            let mut row = moment.tangential_row(state, tangential, tied);
            row.dashpot = moment.tangential_dashpot(point, now[point], work.starts[k], size);
            work.closed[k] = tied;
            work.rows.push(row);
        }
        work.scale = work.free.iter().fold(0.0f64, |m, h| m.max(h.abs()));
    }

    /// Where loads go into motions that nothing holds: rough points that are not closed yet stick for the time being, and open points
    /// of modified hard contact go as far as they may without pressure. Whether that changes anything.
    fn rescue(&mut self, moment: &Moment<'_>) -> bool {
        let mut changed = false;
        let points = moment.plan.points();
        for i in 0..points {
            let row = &mut self.work.rows[i];
            if let (Wall::None, Some(modified)) = (row.wall, moment.modified(i)) {
                (row.wall, row.position) = (Wall::OneSided, modified.overclosure_max);
                changed = true;
            }
        }
        for (k, tangential) in (points..).zip(&moment.plan.tangential) {
            let point = tangential.point as usize;
            let immediate = moment.controls(point).friction_onset == FrictionOnset::Immediate;
            let row = &mut self.work.rows[k];
            if row.wall == Wall::None && immediate && moment.sticks(point, true, self.state.closed[point]) {
                row.wall = Wall::TwoSided;
                changed = true;
            }
        }
        if changed {
            let (state, work) = (&self.state, &mut self.work);
            work.forces.clone_from(&state.forces);
            work.relief.clone_from(&self.derived.relief);
            work.motions.clone_from(&state.motions);
            work.springs.clone_from(&state.springs);
        }
        changed
    }

    /// Pressure of a point without its viscous part \[pressure\].
    fn contact_pressure(&self, i: usize) -> f64 {
        let work = &self.work;
        let row = &work.rows[i];
        (work.forces[i] - row.viscous_force(work.overclosures[i])) / row.area
    }

    /// Modified hard contact: points change their status by the state table; whether any did.
    fn change_status(&mut self, moment: &Moment<'_>) -> Result<bool, SolveFailure> {
        let points = moment.plan.points();
        let forces = self.work.forces.iter().fold(0.0f64, |m, f| m.max(f.abs()));
        let mut verdicts = std::mem::take(&mut self.work.verdicts);
        let mut changed = Ok(false);
        // Pairs with controls of their own are counted alone, those with global ones together.
        let pairs = moment.model.pairs.len();
        for group in 0..=pairs {
            verdicts.clear();
            let mut controls = None;
            for i in 0..points {
                let Some(modified) = moment.modified(i) else { continue };
                let own = if modified.global { pairs } else { moment.plan.pairs[i] as usize };
                // A latched point does not separate whatever the controls say.
                if own != group || self.state.latched[i] {
                    continue;
                }
                controls = Some(modified);
                verdicts.push((i as u32, self.judge(&modified, i, forces)));
            }
            let Some(controls) = controls else { continue };
            withdraw(&mut verdicts, &controls);
            for &(i, _) in verdicts.iter().filter(|(_, verdict)| *verdict == Verdict::Change) {
                match self.change(moment, i as usize) {
                    Ok(()) => changed = changed.map(|_| true),
                    Err(failure) => changed = Err(failure),
                }
            }
        }
        self.work.verdicts = verdicts;
        changed
    }

    fn judge(&self, modified: &crate::model::ModifiedHard, i: usize, forces: f64) -> Verdict {
        let work = &self.work;
        let row = &work.rows[i];
        let closed = row.wall == Wall::TwoSided;
        if row.wall == Wall::OneSided {
            // At the end of the way that it may go without pressure: what it carries says that it would go further.
            return if work.forces[i] > FORCE_ROUNDING * forces { Verdict::Change } else { Verdict::Keep };
        }
        let point = Judged {
            closed,
            was_closed: self.state.closed[i],
            overclosure: work.overclosures[i],
            pressure: self.contact_pressure(i),
            overclosure_rounding: OVERCLOSURE_ROUNDING * work.scale,
            pressure_rounding: FORCE_ROUNDING * forces / row.area,
        };
        judge(point, modified)
    }

    /// Changes the status of a point of modified hard contact.
    fn change(&mut self, moment: &Moment<'_>, i: usize) -> Result<(), SolveFailure> {
        let work = &mut self.work;
        let closes = work.rows[i].wall != Wall::TwoSided;
        let dashpot = work.rows[i].dashpot;
        work.rows[i] = moment.normal_row(&self.state, i, closes, 0.0);
        work.rows[i].dashpot = dashpot;
        work.closed[i] = closes;
        work.changes[i] += 1;
        if work.changes[i] > CHANGES_MAX {
            return Err(SolveFailure::NotConverged { points: vec![i as u32] });
        }
        Ok(())
    }

    /// Rough friction: closed points stick, open ones do not; whether a row changed.
    ///
    /// There may be no such state: a point that opens loses its shear, springs back, and is pulled off again from where it stuck.
    /// A point whose sticking changes more than [`CHANGES_MAX`] times has opened for good as far as its old place goes: in this
    /// increment it slides freely where it is closed, and sticks from where it ends.
    fn change_sticking(&mut self, moment: &Moment<'_>) -> bool {
        let points = moment.plan.points();
        let mut changed = false;
        for (k, tangential) in (points..).zip(&moment.plan.tangential) {
            let point = tangential.point as usize;
            let work = &mut self.work;
            let wanted = moment.sticks(point, work.closed[point], self.state.closed[point])
                && work.changes[point] <= CHANGES_MAX;
            if wanted == (work.rows[k].wall == Wall::TwoSided) {
                continue;
            }
            work.rows[k].wall = if wanted { Wall::TwoSided } else { Wall::None };
            work.closed[k] = wanted;
            changed = true;
            if tangential.direction == 0 {
                work.changes[point] = work.changes[point].saturating_add(1);
            }
        }
        changed
    }

    /// Gives tangential dashpots the coefficient at the clearance that was found; whether one changed.
    fn follow_clearances(&mut self, moment: &Moment<'_>, size: f64) -> bool {
        let points = moment.plan.points();
        let mut changed = false;
        for (k, tangential) in (points..).zip(&moment.plan.tangential) {
            let point = tangential.point as usize;
            let start = self.work.starts[k];
            let dashpot = moment.tangential_dashpot(point, self.work.overclosures[point], start, size);
            let coefficient = |d: Option<crate::solve::contact::Dashpot>| d.map_or(0.0, |d| d.coefficient());
            let largest = coefficient(self.work.rows[point].dashpot);
            let row = &mut self.work.rows[k];
            let (old, new) = (coefficient(row.dashpot), coefficient(dashpot));
            if (old - new).abs() > COEFFICIENT_ROUNDING * largest {
                row.dashpot = dashpot;
                changed = true;
            }
        }
        changed
    }

    /// Remembers the penetrations that a solve found.
    fn note_penetrations(&mut self, moment: &Moment<'_>) {
        let work = &mut self.work;
        work.penetrations.clear();
        let found = |i: usize| if moment.penetration_max(i).is_some() { work.overclosures[i] } else { 0.0 };
        work.penetrations.extend((0..moment.plan.points()).map(found));
    }

    /// Augmented Lagrange: where a penetration exceeds its tolerance every multiplier is updated.
    fn augment(&mut self, coupling: &mut Coupling<'_>, moment: &Moment<'_>) -> Augmented {
        let points = moment.plan.points();
        let too_deep = (0..points).any(|i| {
            let Some((tolerance, clearance)) = moment.penetration_max(i) else { return false };
            let h = self.work.penetrations[i];
            // A multiplier that is too large holds a point off.
            let presses = || self.work.rows[i].law(&coupling.system.behaviors, h).pressure != 0.0;
            h > tolerance || -(h + clearance) > tolerance && presses()
        });
        if !too_deep {
            return Augmented::Enough;
        }
        let mut gaps = std::mem::take(&mut self.work.gaps);
        gaps.clear();
        gaps.resize(moment.plan.count(), 0.0);
        let mut plain = true;
        for i in 0..points {
            let Some((_, clearance)) = moment.penetration_max(i) else {
                plain &= !self.work.rows[i].has_curve();
                continue;
            };
            let work = &mut self.work;
            let pressure = work.rows[i].law(&coupling.system.behaviors, work.penetrations[i]).pressure;
            if pressure != 0.0 {
                gaps[i] = work.penetrations[i] + clearance;
            }
            work.multipliers[i] = pressure;
            let dashpot = work.rows[i].dashpot;
            plain &= dashpot.is_none();
            work.rows[i] = moment.normal_row(&self.state, i, false, pressure);
            work.rows[i].dashpot = dashpot;
        }
        plain &= self.work.rows[points..].iter().all(|row| row.dashpot.is_none());
        let solved = plain && self.correct(coupling, moment, &gaps);
        self.work.gaps = gaps;
        if solved { Augmented::Solved } else { Augmented::ToSolve }
    }

    /// A step of augmented Lagrange with the closed points as they are; whether they stay that.
    ///
    /// The penetrations that are left come out of the last ones, with all their digits: `h_free − W F` has lost them.
    fn correct(&mut self, coupling: &mut Coupling<'_>, moment: &Moment<'_>, gaps: &[f64]) -> bool {
        let points = moment.plan.points();
        let work = &mut self.work;
        work.overclosures[..points].iter_mut().zip(&work.penetrations).enumerate().for_each(|(i, (h, exact))| {
            if moment.penetration_max(i).is_some() {
                *h = *exact;
            }
        });
        let mut unknowns = Unknowns {
            forces: &mut work.forces,
            relief: &mut work.relief,
            closed: &mut work.closed,
            overclosures: &mut work.overclosures,
            motions: &mut work.motions,
            springs: &mut work.springs,
        };
        if !coupling.solver.correct(coupling.system, &work.rows, gaps, &mut unknowns) {
            return false;
        }
        let forces = work.forces.iter().fold(0.0f64, |m, f| m.max(f.abs()));
        let (force_rounding, slack) = (FORCE_ROUNDING * forces, OVERCLOSURE_ROUNDING * work.scale);
        let stays = |(i, row): (usize, &crate::solve::contact::Row)| match row.wall {
            Wall::TwoSided => true,
            Wall::OneSided if work.closed[i] => work.forces[i] >= -force_rounding,
            Wall::OneSided => work.overclosures[i] <= row.position + slack,
            Wall::None if i < points && moment.penetration_max(i).is_some() => {
                let pulls = self.state.latched[i] || work.forces[i] > force_rounding;
                let pressure = row.law(&coupling.system.behaviors, work.overclosures[i]).pressure;
                if work.closed[i] { pulls } else { pressure <= 0.0 }
            }
            Wall::None => true,
        };
        if !work.rows.iter().enumerate().all(stays) {
            return false;
        }
        self.note_penetrations(moment);
        true
    }
}

/// What became of a step of augmented Lagrange.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Augmented {
    /// Every penetration is within its tolerance.
    Enough,
    /// Multipliers have grown and the solution has followed.
    Solved,
    /// Multipliers have grown; the solution has to be found again.
    ToSolve,
}
