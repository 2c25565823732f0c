//! Kinematic contact: which points are corrected, in which order, and how balanced pairs are weighted.
//!
//! The increment is predicted without contact; then pure pairs are corrected, then balanced ones. A balanced pair is corrected twice
//! from the same prediction, with either surface as the secondary one; the corrections are weighted with `f` and `1 − f`. Hard
//! contact is corrected a second time for what the weighting leaves.

use super::coupled::{self, Kind, Local, LocalLaw};
use super::hard::{Active, Correction, HardWork, correct};
use super::phase::Phase;
use super::plan::{Balanced, StepPlan};
use super::rules::{Law, Laws, Rule};

/// Corrections of a balanced pair.
const PASSES: usize = 2;

/// Where points are, and what they remember.
pub struct Places<'a> {
    /// Predicted `h` of each row, of tangential ones the slip since sticking began [length].
    pub predicted: &'a [f64],
    /// Overclosure at the start of the increment [length].
    pub start: &'a [f64],
    /// Forces of the increment before \[force\].
    pub forces: &'a [f64],
    /// Whether points may not separate any more.
    pub latched: &'a [bool],
    /// `τ` [time²].
    pub tau: f64,
    /// Size of the increment \[time\].
    pub size: f64,
}

/// Why contact cannot be corrected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// A secondary node that is prescribed along its normal.
    Prescribed(u32),
    /// The local problem does not settle.
    Unsettled(u32),
}

/// Work space.
pub struct KinematicWork {
    hard: HardWork,
    active: Vec<Active>,
    local: Vec<Local>,
    trial: Correction,
    other: Correction,
}

impl KinematicWork {
    /// For a phase.
    pub fn new(phase: &Phase) -> Self {
        let (slots, rows) = (phase.slots.at.len(), phase.slots.rows.len());
        Self {
            hard: HardWork::new(&phase.slots),
            active: Vec::with_capacity(rows),
            local: Vec::with_capacity(rows),
            trial: Correction::new(slots, rows),
            other: Correction::new(slots, rows),
        }
    }
}

/// Laws at the places of an increment.
struct Here<'a> {
    laws: &'a Laws,
    rules: &'a [Rule],
    places: &'a Places<'a>,
}

impl LocalLaw for Here<'_> {
    fn force(&self, point: u32, overclosure: f64) -> (f64, f64) {
        let (i, rule) = (point as usize, &self.rules[point as usize]);
        let latched = self.places.latched[i];
        let at = self.laws.evaluate(rule, overclosure, latched);
        let elastic = rule.area * at.pressure;
        if at.pressure == 0.0 && !latched {
            return (0.0, 0.0);
        }
        let rate = (overclosure - self.places.start[i]) / self.places.size;
        let viscous = rule.viscosity(at.stiffness) * rate;
        let total = elastic + viscous;
        if total < 0.0 && !latched { (0.0, -elastic) } else { (total, viscous) }
    }

    fn onset(&self, point: u32) -> Option<f64> {
        let rule = &self.rules[point as usize];
        (!self.places.latched[point as usize]).then(|| self.laws.onset(rule))
    }
}

/// Corrects an increment; `out` is cleared first.
pub fn solve(
    phase: &Phase,
    plan: &StepPlan,
    laws: &Laws,
    places: &Places<'_>,
    work: &mut KinematicWork,
    out: &mut Correction,
) -> Result<(), Refusal> {
    out.clear();
    let here = Here { laws, rules: &plan.rules, places };
    one_way(phase, plan, &here, &plan.pure, true, work, out)?;
    for Balanced { weight, own, mirrored } in &plan.balanced {
        for pass in 0..PASSES {
            // Both from the same prediction.
            let mut other = std::mem::take(&mut work.other);
            other.clear();
            for (points, share) in [(own, *weight), (mirrored, 1.0 - *weight)] {
                let mut trial = std::mem::take(&mut work.trial);
                trial.clear();
                trial.acceleration.copy_from_slice(&out.acceleration);
                let done = one_way(phase, plan, &here, points, pass == 0, work, &mut trial);
                trial.acceleration.iter_mut().zip(&out.acceleration).for_each(|(t, o)| *t -= o);
                other.add(share, &trial);
                work.trial = trial;
                done?;
            }
            out.add(1.0, &other);
            work.other = other;
        }
    }
    Ok(())
}

/// Corrects some points, each with its own secondary node; `softened`: whether softened ones take part.
fn one_way(
    phase: &Phase,
    plan: &StepPlan,
    here: &Here<'_>,
    points: &[u32],
    softened: bool,
    work: &mut KinematicWork,
    out: &mut Correction,
) -> Result<(), Refusal> {
    let places = here.places;
    let slots = &phase.slots;
    let depth = |row: u32, out: &Correction| {
        places.predicted[row as usize] + places.tau * slots.along(row as usize, &out.acceleration)
    };
    work.active.clear();
    for &point in points.iter().filter(|&&p| plan.simple[p as usize]) {
        let latched = places.latched[point as usize];
        let depth_normal = depth(point, out);
        if depth_normal <= 0.0 && !latched {
            continue;
        }
        if slots.rows[point as usize].own_mass.is_infinite() {
            return Err(Refusal::Prescribed(point));
        }
        work.active.push(Active { row: point, point, depth: depth_normal, two_sided: latched });
        for row in sticking_rows(&here.rules[point as usize]) {
            if slots.rows[row as usize].own_mass.is_finite() {
                work.active.push(Active { row, point, depth: depth(row, out), two_sided: true });
            }
        }
    }
    correct(slots, &phase.inertia, &mut work.active, places.tau, &mut work.hard, out);
    work.local.clear();
    for &point in points.iter().filter(|&&p| !plan.simple[p as usize]) {
        let rule = &here.rules[point as usize];
        let hard = rule.law == Law::Hard;
        let latched = places.latched[point as usize];
        let depth_normal = depth(point, out);
        let onset = here.laws.onset(rule);
        // Others may push a point further in: those that are near take part.
        let near = depth_normal > onset - 0.5 * (depth_normal - places.start[point as usize]).abs();
        if (!hard && !softened) || !(near || latched) {
            continue;
        }
        if slots.rows[point as usize].compliance == 0.0 || slots.rows[point as usize].own_mass.is_infinite() {
            if depth_normal > onset {
                return Err(Refusal::Prescribed(point));
            }
            continue;
        }
        let kind = match (hard, latched) {
            (false, _) => Kind::Law,
            (true, true) => Kind::TwoSided,
            (true, false) => Kind::Wall,
        };
        let normal = work.local.len();
        // What was carried before is where turns begin.
        let force = if softened && !hard { places.forces[point as usize] / rule.share } else { 0.0 };
        work.local.push(Local { row: point, point, depth: depth_normal, kind, force });
        for row in sticking_rows(rule) {
            work.local.push(Local { row, point, depth: depth(row, out), kind: Kind::Sticks(normal), force: 0.0 });
        }
    }
    if work.local.is_empty() {
        return Ok(());
    }
    // Depths hold what is corrected so far: the local problem begins at nothing.
    let before = &mut work.hard.scratch;
    before.copy_from_slice(&out.acceleration);
    out.acceleration.fill(0.0);
    let settled = coupled::solve(slots, &mut work.local, places.tau, here, out);
    out.acceleration.iter_mut().zip(&*before).for_each(|(a, b)| *a += b);
    if settled { Ok(()) } else { Err(Refusal::Unsettled(work.local[0].point)) }
}

/// Tangential rows of a point that sticks while it is closed.
fn sticking_rows(rule: &Rule) -> impl Iterator<Item = u32> + use<> {
    let first = if rule.rough { rule.tangential } else { None };
    first.into_iter().flat_map(|first| [first, first + 1])
}
