//! When something is due within a step: every so many increments, or where an increment reaches the end of an interval.

use crate::model::{OutputFrequency, RestartFrequency, Step};
use crate::simulation::IncrementReport;

/// When the question is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Moment {
    /// At an increment with others to follow.
    Within,
    /// At the last increment of a step: every request is due.
    LastOfStep,
    /// After the last increment of a run that stopped: what is due at a last increment and was not due before.
    Stopped,
}

/// Part of an interval by which the end of an increment may miss the end of the interval: times are sums that round.
const ROUNDING: f64 = 1e-9;

/// An increment within its step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    /// Number, from 1.
    pub increment: u32,
    /// Step time at which it begins.
    pub start: f64,
    /// Step time at which it ends.
    pub end: f64,
    /// Length of the step.
    pub period: f64,
}

impl Span {
    /// An increment of a step.
    pub(super) fn of(step: &Step, report: &IncrementReport) -> Self {
        let end = report.step_time;
        Self { increment: report.increment, start: end - report.increment_size, end, period: step.procedure.period() }
    }

    /// Whether a request is due at this increment, wherever the step ends. It depends on nothing but the increment itself, so that a
    /// run that goes on from a snapshot writes what the whole run writes.
    fn regular(&self, frequency: OutputFrequency) -> bool {
        match frequency {
            OutputFrequency::Increments(every) => every != 0 && self.increment.is_multiple_of(every),
            OutputFrequency::Intervals(parts) => self.reaches(self.period / f64::from(parts)),
            OutputFrequency::TimeInterval(interval) => self.reaches(interval),
        }
    }

    /// Whether a multiple of an interval lies beyond the start and not beyond the end.
    fn reaches(&self, interval: f64) -> bool {
        let passed = |time: f64| (time / interval + ROUNDING).floor();
        passed(self.end) > passed(self.start)
    }

    /// Whether a request is due.
    pub(super) fn is_due(&self, frequency: OutputFrequency, moment: Moment) -> bool {
        let regular = self.regular(frequency);
        match moment {
            Moment::Within => regular,
            Moment::LastOfStep => !frequency.is_never(),
            Moment::Stopped => !frequency.is_never() && !regular,
        }
    }

    /// Whether something that several requests share is due. A step that does not mention it gets it once, at its end.
    pub(super) fn any_due(&self, frequencies: impl Iterator<Item = OutputFrequency>, moment: Moment) -> bool {
        let (mut silent, mut wanted, mut regular) = (true, false, false);
        for frequency in frequencies {
            silent = false;
            wanted |= !frequency.is_never();
            regular |= self.regular(frequency);
        }
        wanted |= silent;
        match moment {
            Moment::Within => regular,
            Moment::LastOfStep => wanted,
            Moment::Stopped => wanted && !regular,
        }
    }

    /// Whether a snapshot is due: always where the step or the run ends, since that is where it goes on.
    pub(super) fn snapshot_is_due(&self, frequency: RestartFrequency, moment: Moment) -> bool {
        let regular = match frequency {
            RestartFrequency::Increments(every) => self.regular(OutputFrequency::Increments(every)),
            RestartFrequency::Intervals(parts) => self.regular(OutputFrequency::Intervals(parts)),
            RestartFrequency::StepEnd => false,
        };
        match moment {
            Moment::Within => regular,
            Moment::LastOfStep => true,
            Moment::Stopped => !regular,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Increments of a size up to the end of a step of length 1.
    fn spans(size: f64) -> impl Iterator<Item = Span> {
        let count = (1.0 / size - 1e-9).ceil() as u32;
        let at = move |k: u32| (f64::from(k) * size).min(1.0);
        (1..=count).map(move |k| {
            let end = at(k);
            Span { increment: k, start: end - (end - at(k - 1)), end, period: 1.0 }
        })
    }

    fn ends(frequency: OutputFrequency, size: f64) -> Vec<f64> {
        spans(size).filter(|span| span.is_due(frequency, Moment::Within)).map(|span| span.end).collect()
    }

    #[test]
    fn each_interval_is_written_once_at_the_increment_that_reaches_its_end() {
        for (frequency, size, expected) in [
            (OutputFrequency::Intervals(4), 0.125, &[0.25, 0.5, 0.75, 1.0][..]),
            (OutputFrequency::Intervals(2), 0.3, &[0.6, 1.0]),
            (OutputFrequency::TimeInterval(0.4), 0.3, &[0.6, 0.8999999999999999]),
            (OutputFrequency::Increments(3), 0.125, &[0.375, 0.75]),
            (OutputFrequency::Increments(0), 0.5, &[]),
        ] {
            assert_eq!(ends(frequency, size), expected, "{frequency:?} {size}");
        }
        // Intervals that are shorter than the increments: every increment, once.
        assert_eq!(ends(OutputFrequency::Intervals(1000), 0.25).len(), 4);
        // Sizes that are no binary fractions: as many outputs as intervals, whatever rounds.
        for size in [1e-3, 0.7e-3, 1.0 / 3000.0, 0.037] {
            assert_eq!(ends(OutputFrequency::Intervals(20), size).len(), 20, "{size}");
        }
    }

    #[test]
    fn the_ends_of_step_and_run_are_always_due() {
        let span = |increment: u32| Span { increment, start: 0.3, end: 0.4, period: 1.0 };
        let third = RestartFrequency::Increments(3);
        let (halves, tenths) = (RestartFrequency::Intervals(2), RestartFrequency::Intervals(10));
        for (frequency, increment, moment, expected) in [
            (third, 2, Moment::Within, false),
            (third, 3, Moment::Within, true),
            (third, 4, Moment::LastOfStep, true),
            (third, 4, Moment::Stopped, true),
            (third, 6, Moment::Stopped, false),
            (halves, 3, Moment::Within, false),
            (halves, 3, Moment::LastOfStep, true),
            (tenths, 3, Moment::Within, true),
            (tenths, 3, Moment::Stopped, false),
            (RestartFrequency::StepEnd, 3, Moment::Within, false),
            (RestartFrequency::StepEnd, 3, Moment::LastOfStep, true),
            (RestartFrequency::StepEnd, 3, Moment::Stopped, true),
        ] {
            let due = span(increment).snapshot_is_due(frequency, moment);
            assert_eq!(due, expected, "{frequency:?} {increment} {moment:?}");
        }
    }
}
