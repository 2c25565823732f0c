//! From one time to another in increments: fixed or automatic, cut back when no solution is found.

use crate::model::{BoundaryKind, StaticControl};
use crate::procedure::courses::{self, ColumnMotion, StepTime};
use crate::procedure::enforcement::IncrementCounts;
use crate::procedure::failure::Failure;
use crate::simulation::{AdvanceOutcome, CutbackReport, IncrementReport, Simulation, StatusChange, Watch};

/// Automatic static increments: growth after two easy increments in a row (as in Abaqus). How many iterations they took says
/// nothing: each solve is convex and ends, from any start.
const GROWTH: f64 = 1.5;
/// What is left of a static increment that failed (as in Abaqus).
const CUTBACK: f64 = 0.25;
/// Dynamic increments are base · 2^k, so that few sizes have to be factored.
const DOUBLED: f64 = 2.0;
/// What is left of the size after an impact: the accelerations that follow need small increments.
const AFTER_IMPACT: f64 = 1.0 / 16.0;
/// Two times closer than this part of the period are the same time: sums of increments round.
const TIME_TOLERANCE: f64 = 1e-12;
/// An increment this close to the size that was asked for, relative to it, has that size.
const SIZE_ROUNDING: f64 = 1e-9;
/// Half of the last digit that sizes of other increments keep: 40 of 52 binary digits.
const HALF_KEPT: u64 = 1 << 11;

/// An increment that was found.
pub(crate) struct Found {
    pub counts: IncrementCounts,
    pub changes: Vec<StatusChange>,
    /// Whether it was accurate enough for a larger one to be tried.
    pub easy: bool,
    /// What ended it before its time.
    pub event: Option<Event>,
}

/// Changes of hard contact within a dynamic increment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Event {
    /// Points closed: an impact.
    Impact,
    /// Points opened.
    Release,
}

/// Interval over which driven inputs go from their last values to their pending ones.
pub(crate) struct Interval {
    pub start: f64,
    pub end: f64,
    /// Times this close to the end are the end.
    pub tolerance: f64,
    /// Columns of inputs that are driven from outside.
    pub driven: Vec<Driven>,
}

/// A column that an input drives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Driven {
    pub column: usize,
    /// Its motion at the start of the interval.
    pub start: ColumnMotion,
    /// What its line prescribes at the end: a load, displacement, velocity or acceleration.
    pub to: f64,
}

impl Simulation {
    /// Runs the present step to a step time. The step's own end is always the end of an increment.
    pub(crate) fn advance_step(&mut self, target: f64, watch: &mut dyn Watch) -> AdvanceOutcome {
        let prepared = self.prepared.clone();
        let step = self.state.step as usize;
        let procedure = &prepared.model.steps[step].procedure;
        let tolerance = TIME_TOLERANCE * procedure.period().max(target.abs());
        let interval = self.begin_interval(target, tolerance);
        let outcome = match procedure.implicit_increments() {
            Some(control) => self.advance_interval(&interval, control, watch),
            None => self.advance_explicit(&interval, watch),
        };
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
            if let Err(reason) = self.attempt(self.state.step_time, 0.0, interval) {
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
                let begun = self.state.step_time;
                let size = self.size(&control, end, clipped);
                match self.attempt(end, size, interval) {
                    Ok(found) => {
                        done += 1;
                        self.complete(&control, clipped, attempt, &found);
                        let report = self.report(self.state.step_time - begun, attempt, found.counts, found.changes);
                        watch.increment(self, &report);
                        break;
                    }
                    Err(failure) => {
                        let smaller = match prepared.model.steps[step].procedure.is_dynamic() {
                            false => CUTBACK * size,
                            true => self.state.increment_next / DOUBLED,
                        };
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

    /// Tries an increment to a step time; `size` is its length, the same bits for every increment of that size.
    fn attempt(&mut self, end: f64, size: f64, interval: &Interval) -> Result<Found, Failure> {
        let found = |(counts, changes)| Found { counts, changes, easy: true, event: None };
        match self.state.motion {
            None => self.attempt_static(end, interval).map(found),
            Some(_) => self.attempt_dynamic(end, size, interval),
        }
    }

    /// Length of an increment. What a request or the end of the step cuts short is rounded, so that equal requests have equal
    /// sizes whatever the rounding of their times.
    fn size(&self, control: &StaticControl, end: f64, clipped: bool) -> f64 {
        let exact = end - self.state.step_time;
        let nominal = if control.direct { control.increment_initial } else { self.state.increment_next };
        let same = !clipped && (exact - nominal).abs() <= SIZE_ROUNDING * nominal;
        if same { nominal } else { rounded(exact) }
    }

    fn begin_interval(&mut self, target: f64, tolerance: f64) -> Interval {
        let mut driven = std::mem::take(&mut self.work.driven);
        driven.clear();
        for (input, &column) in self.prepared.loading.input_columns.iter().enumerate() {
            if self.on_last_step() && (self.state.driven[input] || self.state.pending[input].is_some()) {
                let start = self.column_now(column);
                let now = start.of(self.kind_of(column));
                driven.push(Driven { column, start, to: self.state.pending[input].unwrap_or(now) });
            }
        }
        Interval { start: self.state.step_time, end: target, tolerance, driven }
    }

    /// The target is reached: pending values have become actual ones.
    pub(crate) fn finish_interval(&mut self, interval: &Interval) {
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
    pub(crate) fn coefficients_at(&self, time: f64, interval: &Interval, out: &mut Vec<f64>) {
        out.clear();
        out.extend((0..self.prepared.real_columns).map(|column| self.column_at(column, time).value));
        for driven in &interval.driven {
            out[driven.column] = self.driven_at(driven, time, interval).value;
        }
    }

    /// Coefficients of the real columns with their rates at a step time.
    pub(crate) fn columns_at(&self, time: f64, interval: &Interval, out: &mut Vec<ColumnMotion>) {
        out.clear();
        out.extend((0..self.prepared.real_columns).map(|column| self.column_at(column, time)));
        for driven in &interval.driven {
            out[driven.column] = self.driven_at(driven, time, interval);
        }
    }

    /// What the deck has of a column at a step time.
    fn column_at(&self, column: usize, time: f64) -> ColumnMotion {
        let (prepared, step) = (&self.prepared, self.state.step as usize);
        let rate = self.state.motion.as_ref().map_or(0.0, |motion| motion.rates_start[column]);
        let start = ColumnMotion { value: self.state.step_start[column], rate, acceleration: 0.0 };
        let at = StepTime::of(&prepared.model, step, self.step_start_time(), time);
        prepared.loading.motion(&prepared.model, step, column, self.course(column), start, &at)
    }

    fn driven_at(&self, driven: &Driven, time: f64, interval: &Interval) -> ColumnMotion {
        let length = interval.end - interval.start;
        let elapsed = if time >= interval.end - interval.tolerance { length } else { time - interval.start };
        courses::driven(self.kind_of(driven.column), driven.start, driven.to, elapsed, length)
    }

    /// What a column's line prescribes in the present step.
    pub(crate) fn kind_of(&self, column: usize) -> BoundaryKind {
        self.prepared.loading.kinds[self.state.step as usize][column]
    }

    /// A column as it stands.
    pub(crate) fn column_now(&self, column: usize) -> ColumnMotion {
        let motion = self.state.motion.as_ref();
        ColumnMotion {
            value: self.state.coefficients[column],
            rate: motion.map_or(0.0, |motion| motion.rates[column]),
            acceleration: motion.map_or(0.0, |motion| motion.curvatures[column]),
        }
    }

    fn complete(&mut self, control: &StaticControl, clipped: bool, attempt: u32, found: &Found) {
        let counts = &found.counts;
        let step = self.state.step as usize;
        let total = &mut self.state.counts[step];
        total.increments += 1;
        total.equilibrium_iterations += counts.solves.equilibrium_iterations;
        total.severe_discontinuity_iterations += counts.solves.severe_discontinuity_iterations;
        total.factorizations += counts.solves.factorizations;
        total.augmentations += counts.augmentations;
        total.impacts += u32::from(found.event == Some(Event::Impact));
        let easy = attempt == 1 && found.easy && found.event.is_none();
        self.state.easy_increments = if easy { self.state.easy_increments + 1 } else { 0 };
        if found.event == Some(Event::Impact) && !control.direct {
            // Powers of two of the base, however small the base is.
            let mut next = self.state.increment_next * AFTER_IMPACT;
            while next < control.increment_min {
                next *= DOUBLED;
            }
            self.set_increment(next);
            return;
        }
        if clipped || found.event.is_some() {
            // Off the grid: the next increments are counted from here.
            self.set_increment(self.state.increment_next);
            return;
        }
        self.state.increment_index += 1;
        if self.state.easy_increments >= 2 {
            self.state.easy_increments = 0;
            let grown = match self.state.motion.is_some() {
                false => (GROWTH * self.state.increment_next).min(control.increment_max),
                true => DOUBLED * self.state.increment_next,
            };
            if grown > self.state.increment_next && grown <= control.increment_max {
                self.set_increment(grown);
            }
        }
    }

    /// Starts to count increments of a size from the present time.
    pub(crate) fn set_increment(&mut self, size: f64) {
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
            stable_increment: None,
            status_changes,
        }
    }
}

/// A length of time with 40 of its 52 binary digits.
pub(crate) fn rounded(size: f64) -> f64 {
    f64::from_bits((size.to_bits() + HALF_KEPT) & !(2 * HALF_KEPT - 1))
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
