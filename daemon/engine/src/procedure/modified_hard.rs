//! Modified hard contact: which points keep their status.
//!
//! The state table. *Changed* points have another status than at the start of the increment: there the plain hard conditions
//! decide whether the change persists, the tolerances `UERRMX` and `PERRMX` come back with the next increment.
//!
//! | status | changed | test | verdict |
//! |---|---|---|---|
//! | open | no | `h ≤ 0` | keep |
//! | open | no | `0 < h ≤ UERRMX` | tolerated |
//! | open | no | `h > UERRMX` | change |
//! | closed | yes | `p > 0` | keep |
//! | closed | yes | `p ≤ 0` | change (reversal) |
//! | closed | no | `p ≥ 0` | keep |
//! | closed | no | `−PERRMX ≤ p < 0` | tolerated |
//! | closed | no | `p < −PERRMX` | change |
//! | open | yes | `h ≤ 0` | keep |
//! | open | yes | `h > 0` | change (reversal) |
//!
//! A closed point is held at `h = 0`. Up to `MAXCHP` points may be tolerated; if there are more, none is and all of them change.
//!
//! Source: Abaqus Analysis User's Manual v6.5, 22.1.2. How the count is applied, and that a value exactly at a limit is still
//! tolerated, are our rules: the manual is silent.

use crate::model::ModifiedHard;

/// Part of a limit by which rounding may exceed it.
const ROUNDING: f64 = 1e-10;

/// What becomes of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It satisfies the hard conditions.
    Keep,
    /// It violates them within the tolerances.
    Tolerated,
    /// Its status changes.
    Change,
}

/// A point as it is judged.
#[derive(Clone, Copy, Debug)]
pub struct Judged {
    /// Present status.
    pub closed: bool,
    /// Status at the start of the increment.
    pub was_closed: bool,
    /// `h` \[length\].
    pub overclosure: f64,
    /// `p` \[pressure\].
    pub pressure: f64,
    /// Overclosure that is rounding \[length\].
    pub overclosure_rounding: f64,
    /// Pressure that is rounding \[pressure\].
    pub pressure_rounding: f64,
}

/// The state table.
pub fn judge(point: Judged, controls: &ModifiedHard) -> Verdict {
    let changed = point.closed != point.was_closed;
    let (h, p) = (point.overclosure, point.pressure);
    match (point.closed, changed) {
        (false, false) if h <= point.overclosure_rounding => Verdict::Keep,
        (false, false) if h <= controls.overclosure_max * (1.0 + ROUNDING) => Verdict::Tolerated,
        (false, false) => Verdict::Change,
        (true, true) if p > point.pressure_rounding => Verdict::Keep,
        (true, true) => Verdict::Change,
        (true, false) if p >= -point.pressure_rounding => Verdict::Keep,
        (true, false) if -p <= controls.tension_max * (1.0 + ROUNDING) => Verdict::Tolerated,
        (true, false) => Verdict::Change,
        (false, true) if h <= point.overclosure_rounding => Verdict::Keep,
        (false, true) => Verdict::Change,
    }
}

/// Withdraws the tolerance where more points than `MAXCHP` are tolerated: all of those change.
pub fn withdraw(verdicts: &mut [(u32, Verdict)], controls: &ModifiedHard) {
    let tolerated = verdicts.iter().filter(|(_, verdict)| *verdict == Verdict::Tolerated).count();
    if tolerated > controls.points_max as usize {
        for (_, verdict) in verdicts.iter_mut().filter(|(_, verdict)| *verdict == Verdict::Tolerated) {
            *verdict = Verdict::Change;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Verdict::{Change, Keep, Tolerated};

    const CONTROLS: ModifiedHard =
        ModifiedHard { points_max: 2, tension_max: 3.0, overclosure_max: 0.02, global: false };

    fn point(closed: bool, was_closed: bool, overclosure: f64, pressure: f64) -> Judged {
        Judged { closed, was_closed, overclosure, pressure, overclosure_rounding: 1e-14, pressure_rounding: 1e-12 }
    }

    #[test]
    fn every_row_of_the_table() {
        for (closed, was_closed, h, p, expected) in [
            (false, false, -0.1, 0.0, Keep),
            (false, false, 0.0, 0.0, Keep),
            (false, false, 0.01, 0.0, Tolerated),
            (false, false, 0.02, 0.0, Tolerated),
            (false, false, 0.021, 0.0, Change),
            (true, false, 0.0, 0.5, Keep),
            (true, false, 0.0, 0.0, Change),
            // The tension is within PERRMX, which is not used in the increment of a change.
            (true, false, 0.0, -1.0, Change),
            (true, true, 0.0, 0.0, Keep),
            (true, true, 0.0, -2.0, Tolerated),
            (true, true, 0.0, -3.0, Tolerated),
            (true, true, 0.0, -3.1, Change),
            (false, true, -0.01, 0.0, Keep),
            // The overclosure is within UERRMX, which is not used in the increment of a change.
            (false, true, 0.01, 0.0, Change),
        ] {
            assert_eq!(judge(point(closed, was_closed, h, p), &CONTROLS), expected, "{closed} {was_closed} {h} {p}");
        }
    }

    #[test]
    fn a_point_that_would_be_in_tension_after_closing_opens_again() {
        let open = judge(point(false, false, 0.025, 0.0), &CONTROLS);
        assert_eq!(open, Change);
        assert_eq!(judge(point(true, false, 0.0, -1.0), &CONTROLS), Change);
    }

    #[test]
    fn no_tolerance_is_granted_to_more_points_than_maxchp() {
        let of = |h: f64| judge(point(false, false, h, 0.0), &CONTROLS);
        for (points_max, granted) in [(3, true), (2, false), (0, false)] {
            let mut verdicts: Vec<_> = (0..).zip([0.005, 0.010, 0.015, -1.0].map(of)).collect();
            withdraw(&mut verdicts, &ModifiedHard { points_max, ..CONTROLS });
            let expected = if granted { Tolerated } else { Change };
            assert_eq!(verdicts.iter().map(|v| v.1).collect::<Vec<_>>(), [expected, expected, expected, Keep]);
        }
    }
}
