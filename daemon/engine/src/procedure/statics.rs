//! Static increments: fixed or automatic, cut back when no equilibrium is found.

use crate::model::StaticControl;
use crate::procedure::enforcement::IncrementCounts;
use crate::procedure::failure::Failure;
use crate::procedure::interference;
use crate::procedure::loading::value_at;
use crate::simulation::{AdvanceOutcome, CutbackReport, IncrementReport, Simulation, StatusChange, Watch};
use crate::solve::condensed::Response;
use crate::solve::contact::Wall;

/// Automatic increments: growth after two increments in a row without a cutback (Abaqus: 1.5 after two easy ones). How many
/// iterations they took says nothing: each solve is convex and ends, from any start.
const GROWTH: f64 = 1.5;
/// Automatic increments: what is left of an increment that failed (Abaqus: 0.25).
const CUTBACK: f64 = 0.25;
/// Two times closer than this part of the period are the same time: sums of increments round.
const TIME_TOLERANCE: f64 = 1e-12;
/// Part of a face that a closed point may slide before small sliding no longer describes it.
const SLIDING_MAX: f64 = 0.5;

/// Interval over which driven inputs go from their last values to their pending ones.
struct Interval {
    start: f64,
    end: f64,
    /// Times this close to the end are the end.
    tolerance: f64,
    /// Column, value at the start, value at the end.
    driven: Vec<(usize, f64, f64)>,
}

impl Simulation {
    /// Runs the present step to a step time. The step's own end is always the end of an increment.
    pub(crate) fn advance_step(&mut self, target: f64, watch: &mut dyn Watch) -> AdvanceOutcome {
        let prepared = self.prepared.clone();
        let step = self.state.step as usize;
        let Some(control) = prepared.model.steps[step].procedure.implicit_increments() else {
            return AdvanceOutcome::Stopped { reason: "explicit steps are not solved yet".into() };
        };
        let tolerance = TIME_TOLERANCE * control.period.max(target.abs());
        let interval = self.begin_interval(target, tolerance);
        let outcome = self.advance_interval(&interval, control, watch);
        // The list is used again: an increment allocates nothing.
        self.work.driven = interval.driven;
        outcome
    }

    fn advance_interval(
        &mut self,
        interval: &Interval,
        control: StaticControl,
        watch: &mut dyn Watch,
    ) -> AdvanceOutcome {
        let prepared = self.prepared.clone();
        let step = self.state.step as usize;
        let (target, tolerance) = (interval.end, interval.tolerance);
        let limit = prepared.model.steps[step].increments_max;
        let mut done = 0;
        if target <= self.state.step_time + tolerance && self.state.pending.iter().any(Option::is_some) {
            // New inputs at the same time: they act at once.
            if let Err(reason) = self.attempt(self.state.step_time, interval) {
                return AdvanceOutcome::Stopped { reason: reason.describe(self) };
            }
            self.refresh();
        }
        while self.state.step_time < target - tolerance {
            if watch.cancelled() {
                return AdvanceOutcome::Cancelled;
            }
            if done == limit {
                return AdvanceOutcome::Stopped {
                    reason: format!("{limit} increments were not enough; raise INC on *STEP"),
                };
            }
            let mut attempt = 1;
            loop {
                let proposed = self.proposed_time(&control);
                let (end, clipped) = next_time(&control, self.state.step_time, proposed, target, tolerance);
                let size = end - self.state.step_time;
                match self.attempt(end, interval) {
                    Ok((counts, changes)) => {
                        done += 1;
                        self.complete(&control, clipped, attempt, counts);
                        let report = self.report(size, attempt, counts, changes);
                        watch.increment(self, &report);
                        break;
                    }
                    Err(failure) => {
                        let smaller = CUTBACK * size;
                        if control.direct || smaller < control.increment_min || failure.is_final() {
                            return AdvanceOutcome::Stopped { reason: failure.describe(self) };
                        }
                        let report = CutbackReport {
                            step: self.state.step + 1,
                            increment: self.state.counts[step].increments + 1,
                            attempt,
                            increment_size: size,
                            next_size: smaller,
                            reason: failure.describe(self),
                        };
                        watch.cutback(self, &report);
                        attempt += 1;
                        self.state.counts[step].cutbacks += 1;
                        self.set_increment(smaller);
                        self.state.easy_increments = 0;
                    }
                }
            }
        }
        self.finish_interval(interval);
        AdvanceOutcome::Reached
    }

    fn begin_interval(&mut self, target: f64, tolerance: f64) -> Interval {
        let mut driven = std::mem::take(&mut self.work.driven);
        driven.clear();
        for (input, &column) in self.prepared.loading.input_columns.iter().enumerate() {
            if self.on_last_step() && (self.state.driven[input] || self.state.pending[input].is_some()) {
                let now = self.state.coefficients[column];
                driven.push((column, now, self.state.pending[input].unwrap_or(now)));
            }
        }
        Interval { start: self.state.step_time, end: target, tolerance, driven }
    }

    /// The target is reached: pending values have become actual ones.
    fn finish_interval(&mut self, interval: &Interval) {
        if interval.driven.is_empty() {
            return;
        }
        for input in 0..self.state.pending.len() {
            if self.state.pending[input].take().is_some() {
                self.state.driven[input] = true;
            }
        }
    }

    /// Coefficients of the real columns at a step time.
    fn coefficients_at(&self, time: f64, interval: &Interval, out: &mut Vec<f64>) {
        let prepared = &self.prepared;
        let step = self.state.step as usize;
        out.clear();
        for column in 0..prepared.real_columns {
            let course = self.course(column);
            out.push(value_at(
                &prepared.model,
                course,
                step,
                self.state.step_start[column],
                self.step_start_time(),
                time,
            ));
        }
        for &(column, from, to) in &interval.driven {
            out[column] = if time >= interval.end - interval.tolerance {
                to
            } else {
                from + (to - from) * ((time - interval.start) / (interval.end - interval.start))
            };
        }
    }

    /// Tries to find equilibrium at a step time; the state changes only on success.
    fn attempt(&mut self, time: f64, interval: &Interval) -> Result<(IncrementCounts, Vec<StatusChange>), Failure> {
        let prepared = self.prepared.clone();
        let mut coefficients = std::mem::take(&mut self.work.coefficients);
        self.coefficients_at(time, interval, &mut coefficients);
        self.free_overclosures(&coefficients, time);
        let work = &mut self.work;
        prepared.condensed.motion_load(&coefficients, &mut work.load, &mut work.load_scale);
        work.forces.clone_from(&self.state.forces);
        work.closed.resize(prepared.rows.count(), false);
        work.relief.clone_from(&self.derived.relief);
        work.motions.clone_from(&self.state.motions);
        work.springs.clone_from(&self.state.springs);
        let given = self.take_removed(time);
        let counts = match self.equilibrium(time, time - self.state.step_time) {
            Ok(counts) => counts,
            Err(failure) => {
                self.work.coefficients = coefficients;
                return Err(Failure::Solve(failure));
            }
        };
        if given {
            self.give_removed(&coefficients, time);
        }
        let work = &mut self.work;
        if !prepared.loose.is_empty() {
            prepared.loose.settle(&prepared.condensed, &coefficients, &work.forces, &mut work.motions, &mut work.loose);
            prepared.contact.overclosures(&work.free, &work.relief, &work.motions, &mut work.overclosures);
        }
        let moment = Self::moment(&prepared, self.state.step as usize, time);
        for (i, exact) in work.penetrations.iter().enumerate().filter(|&(i, _)| moment.penetration_max(i).is_some()) {
            work.overclosures[i] = *exact;
        }
        let response = Response { coefficients: &coefficients, forces: &work.forces, motions: &work.motions };
        prepared.condensed.tangential(&prepared.contact, response, &mut work.scratch, &mut work.tangential);
        let (points, n) = (prepared.points.len(), prepared.rows.count());
        let slid: Vec<u32> = (0..points)
            .filter(|&i| {
                work.closed[i]
                    && slid_by(work.tangential[i], work.tangential[n + i]) > SLIDING_MAX * prepared.points[i].face_size
            })
            .map(|i| i as u32)
            .collect();
        if !slid.is_empty() {
            self.work.coefficients = coefficients;
            return Err(Failure::Slid(slid));
        }
        if !self.is_finite(&coefficients) {
            self.work.coefficients = coefficients;
            return Err(Failure::Overflow);
        }
        let changes = self.accept(time, coefficients);
        Ok((counts, changes))
    }

    /// Whether every number that the solution in the work space leads to is one: products of huge inputs are not.
    fn is_finite(&self, coefficients: &[f64]) -> bool {
        let (prepared, work) = (&self.prepared, &self.work);
        let strain = prepared.condensed.strain_energy(coefficients, &work.forces, &work.relief);
        let contact = prepared.contact.energy(&work.rows, &work.overclosures, &work.closed);
        let response = Response { coefficients, forces: &work.forces, motions: &work.motions };
        let conjugates = (0..prepared.real_columns).all(|column| {
            let conjugate = prepared.condensed.conjugate(column, response);
            (conjugate * coefficients[column]).is_finite()
        });
        conjugates && strain.is_finite() && contact.is_finite() && self.state.external_work.is_finite()
    }

    /// Makes the solution in the work space the state.
    fn accept(&mut self, time: f64, coefficients: Vec<f64>) -> Vec<StatusChange> {
        let prepared = self.prepared.clone();
        let (points, n) = (prepared.points.len(), prepared.rows.count());
        let moment = Self::moment(&prepared, self.state.step as usize, time);
        let (state, work) = (&mut self.state, &mut self.work);
        for i in 0..points {
            state.latched[i] |= work.closed[i] && moment.latches(i) && moment.is_active(i);
            // Sticking under rough friction is what the tangential rows say.
            state.stuck[i] = false;
            if moment.penetration_max(i).is_some() {
                state.penetrations[i] = work.penetrations[i];
            }
        }
        for (row, tangential) in work.rows[points..].iter().zip(&prepared.rows.tangential) {
            state.stuck[tangential.point as usize] |= row.wall == Wall::TwoSided;
        }
        for i in 0..points {
            if work.closed[i] && !state.stuck[i] {
                for at in [i, n + i] {
                    state.slip[at] += work.tangential[at] - state.tangential[at];
                }
            }
            // A point that does not stick would begin to where it is.
            if !state.stuck[i] {
                state.origins[i] = work.tangential[i];
                state.origins[points + i] = work.tangential[n + i];
            }
        }
        // A dashpot dissipates its force times what the increment moved it: backward Euler.
        for (i, row) in work.rows.iter().enumerate() {
            state.viscous[i] = row.viscous_force(work.overclosures[i]);
            state.damping_work += state.viscous[i] * (work.overclosures[i] - self.derived.overclosures[i]);
        }
        // Work by the trapezoidal rule on each force-displacement pair.
        let response = Response { coefficients: &coefficients, forces: &work.forces, motions: &work.motions };
        for column in 0..prepared.real_columns {
            let conjugate = prepared.condensed.conjugate(column, response);
            let (a0, a1, c0) = (state.coefficients[column], coefficients[column], state.conjugates[column]);
            state.external_work += match prepared.condensed.is_displacement[column] {
                true => 0.5 * (c0 + conjugate) * (a1 - a0),
                false => 0.5 * (a0 + a1) * (conjugate - c0),
            };
            state.conjugates[column] = conjugate;
        }
        std::mem::swap(&mut state.forces, &mut work.forces);
        std::mem::swap(&mut state.closed, &mut work.closed);
        std::mem::swap(&mut state.tangential, &mut work.tangential);
        std::mem::swap(&mut state.motions, &mut work.motions);
        std::mem::swap(&mut state.springs, &mut work.springs);
        std::mem::swap(&mut state.multipliers, &mut work.multipliers);
        work.coefficients = std::mem::replace(&mut state.coefficients, coefficients);
        state.step_time = time;
        let change = |i: usize| {
            let (from, to) = (self.derived.points[i].status, self.status(&moment, i));
            (from != to).then_some(StatusChange { point: i as u32, from, to })
        };
        (0..points).filter_map(change).collect()
    }

    /// Overclosures without contact forces into the work space, less those that are allowed at a step time.
    pub(crate) fn free_overclosures(&mut self, coefficients: &[f64], time: f64) {
        let prepared = &self.prepared;
        prepared.condensed.free_overclosures(coefficients, &mut self.work.free);
        interference::allow(
            &prepared.model,
            &prepared.rows,
            &prepared.condensed.initial,
            self.state.step as usize,
            self.step_start_time(),
            time,
            &mut self.work.free,
        );
    }

    fn complete(&mut self, control: &StaticControl, clipped: bool, attempt: u32, counts: IncrementCounts) {
        let step = self.state.step as usize;
        let total = &mut self.state.counts[step];
        total.increments += 1;
        total.equilibrium_iterations += counts.solves.equilibrium_iterations;
        total.severe_discontinuity_iterations += counts.solves.severe_discontinuity_iterations;
        total.factorizations += counts.solves.factorizations;
        total.augmentations += counts.augmentations;
        self.state.easy_increments = if attempt == 1 { self.state.easy_increments + 1 } else { 0 };
        if clipped {
            // Off the grid: the next increments are counted from here.
            self.set_increment(self.state.increment_next);
            return;
        }
        self.state.increment_index += 1;
        if self.state.easy_increments >= 2 {
            self.state.easy_increments = 0;
            let grown = (GROWTH * self.state.increment_next).min(control.increment_max);
            if grown > self.state.increment_next {
                self.set_increment(grown);
            }
        }
    }

    /// Starts to count increments of a size from the present time.
    fn set_increment(&mut self, size: f64) {
        self.state.increment_next = size;
        self.state.increment_anchor = self.state.step_time;
        self.state.increment_index = 0;
    }

    /// End of the next increment if nothing cuts it short, on the grid of the present size.
    ///
    /// Fixed increments stand on the grid `k · size` of the whole step.
    fn proposed_time(&self, control: &StaticControl) -> f64 {
        let now = self.state.step_time;
        if control.direct {
            let size = control.increment_initial;
            return ((now / size + 1e-9).floor() + 1.0) * size;
        }
        self.state.increment_anchor + f64::from(self.state.increment_index + 1) * self.state.increment_next
    }

    fn report(
        &mut self,
        size: f64,
        attempt: u32,
        counts: IncrementCounts,
        status_changes: Vec<StatusChange>,
    ) -> IncrementReport {
        if !status_changes.is_empty() {
            self.state.last_change = self.time();
        }
        self.refresh();
        IncrementReport {
            step: self.state.step + 1,
            increment: self.state.counts[self.state.step as usize].increments,
            attempt,
            severe_discontinuity_iterations: counts.solves.severe_discontinuity_iterations,
            equilibrium_iterations: counts.solves.equilibrium_iterations,
            time: self.time(),
            step_time: self.state.step_time,
            increment_size: size,
            status_changes,
        }
    }
}

/// End of the next increment, and whether the end of the step or of the request cut it short of the proposed one.
///
/// A request that ends on a proposed time to rounding gets the proposed time, so that increments have the same bits
/// whether they are asked for one by one or all at once.
fn next_time(control: &StaticControl, now: f64, proposed: f64, target: f64, tolerance: f64) -> (f64, bool) {
    let mut end = proposed;
    if now < control.period - tolerance && end > control.period - tolerance {
        end = control.period;
    }
    if end > target + tolerance {
        end = target;
    }
    (end, end < proposed - tolerance)
}

/// Length of a tangential displacement from its components [length].
fn slid_by(first: f64, second: f64) -> f64 {
    (first * first + second * second).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn control() -> StaticControl {
        StaticControl { increment_initial: 0.05, period: 1.0, increment_min: 1e-5, increment_max: 1.0, direct: true }
    }

    #[test]
    fn a_request_on_the_grid_to_rounding_ends_on_the_grid() {
        let (grid, sum) = (6.0 * 0.05, 0.05 + 0.05 + 0.05 + 0.05 + 0.05 + 0.05);
        assert_ne!(grid, sum);
        assert_eq!(next_time(&control(), 0.25, grid, sum, 1e-12), (grid, false));
    }

    #[test]
    fn a_request_between_two_grid_times_ends_where_it_asks() {
        assert_eq!(next_time(&control(), 0.05, 0.1, 0.07, 1e-12), (0.07, true));
    }

    #[test]
    fn the_end_of_the_step_is_the_end_of_an_increment() {
        assert_eq!(next_time(&control(), 0.9, 1.2, 2.0, 1e-12), (1.0, true));
        assert_eq!(next_time(&control(), 1.0, 1.3, 2.0, 1e-12), (1.3, false));
    }
}
