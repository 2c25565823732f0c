//! How often a run of many increments tells where it is, and how long it will take.

use std::time::{Duration, Instant};

/// Rows beyond those that are always written come at most this often.
const ROW_INTERVAL: Duration = Duration::from_millis(500);
/// An estimate from less than this is none.
const ESTIMATE_AFTER: Duration = Duration::from_secs(2);

/// What has been told, and since when the run goes on.
#[derive(Debug, Default)]
pub struct Pace {
    /// Step that the rows belong to, and how many of them were written.
    step: u32,
    rows: u32,
    written: Option<Instant>,
    /// First increment of this run: when, and how far.
    first: Option<(Instant, f64)>,
}

impl Pace {
    /// Whether the increment gets a row: the first ones of a step do, `at_once` of them, others now and then.
    pub fn is_due(&mut self, now: Instant, step: u32, at_once: u32) -> bool {
        if step != self.step {
            (self.step, self.rows) = (step, 0);
        }
        let due = self.rows < at_once || self.written.is_none_or(|then| now - then >= ROW_INTERVAL);
        if due {
            self.rows = self.rows.saturating_add(1);
            self.written = Some(now);
        }
        due
    }

    /// How long the rest will take at the speed so far; none as long as nothing can be said.
    pub fn left(&mut self, now: Instant, fraction: f64) -> Option<Duration> {
        let (began, from) = *self.first.get_or_insert((now, fraction));
        let (passed, done) = (now - began, fraction - from);
        if passed < ESTIMATE_AFTER || done <= 0.0 {
            return None;
        }
        Duration::try_from_secs_f64(passed.as_secs_f64() * (1.0 - fraction).max(0.0) / done).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_rows_of_a_step_are_written_and_then_two_in_a_second() {
        let (mut pace, begin) = (Pace::default(), Instant::now());
        let at = |milliseconds: u64| begin + Duration::from_millis(milliseconds);
        // An increment per millisecond: three at once, then one every half second.
        let due: Vec<u64> = (0..2000).filter(|&k| pace.is_due(at(k), 1, 3)).collect();
        assert_eq!(due, [0, 1, 2, 502, 1002, 1502]);
        assert!(pace.is_due(at(2000), 2, 3), "a new step begins anew");
    }

    #[test]
    fn what_is_left_follows_from_the_speed_so_far() {
        let (mut pace, begin) = (Pace::default(), Instant::now());
        assert_eq!(pace.left(begin, 0.5), None);
        assert_eq!(pace.left(begin + Duration::from_secs(1), 0.6), None, "too early");
        let left = pace.left(begin + Duration::from_secs(10), 0.75).unwrap();
        assert!((left.as_secs_f64() - 10.0).abs() < 1e-6, "{left:?}");
        assert_eq!(pace.left(begin + Duration::from_secs(10), 0.5), None, "nothing done");
        assert_eq!(pace.left(begin + Duration::from_secs(10), 1.1), Some(Duration::ZERO));
    }
}
