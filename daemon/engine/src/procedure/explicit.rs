//! Explicit increments: as large as is stable, or as the deck says; none is repeated.

use crate::explicit::kinematic::Refusal;
use crate::explicit::{ExplicitModel, ExplicitWork, Found, Memory, UNLIMITED};
use crate::model::{ExplicitControl, ExplicitIncrements, NodeId, Procedure};
use crate::procedure::interval::{Interval, rounded};
use crate::simulation::{AdvanceOutcome, IncrementReport, Simulation, StatusChange, Watch};

/// Automatic increments keep their size until the stable one falls below it, or rises above it by this part: energies add up
/// exactly while the size stays.
const KEPT: f64 = 0.8;
/// Part by which a size of the deck may exceed the stable one: what rounding makes of a limit that an analyst has worked out.
const STABLE_TOLERANCE: f64 = 1e-6;
/// So many of the last increments of a request or a step share the time that is left: sizes that change little change energies
/// little.
const SHARING: f64 = 16.0;
/// Energy, relative to what was there and what loads have done, that only an unstable motion has.
const UNSTABLE: f64 = 100.0;
/// Part of a face that a closed point may slide before small sliding no longer describes it.
const SLIDING_MAX: f64 = 0.5;
/// Points named in a message.
const NAMED: usize = 6;

/// End of an increment and its size.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Next {
    end: f64,
    size: f64,
    /// Whether it is off the grid of sizes.
    clipped: bool,
}

/// End of an automatic increment of a size: on its grid; the last ones before the end of the request or the step share what is left.
fn next_automatic(now: f64, size: f64, grid: f64, bound: f64) -> Next {
    let rest = bound - now;
    let left = (rest / size - 1e-9).ceil().max(1.0);
    if left > SHARING {
        return Next { end: grid, size, clipped: false };
    }
    let share = rest / left;
    let same = (share - size).abs() <= 1e-9 * size;
    let end = if left == 1.0 { bound } else { now + share };
    Next { end, size: if same { size } else { rounded(share) }, clipped: true }
}

/// End of an increment of a given size: on the grid `k · size` of the step, or on the end of the request or the step.
fn next_direct(now: f64, size: f64, bound: f64, tolerance: f64) -> Next {
    let grid = ((now / size + 1e-9).floor() + 1.0) * size;
    let (end, clipped) = if grid > bound + tolerance { (bound, true) } else { (grid, false) };
    let exact = end - now;
    let same = !clipped && (exact - size).abs() <= 1e-9 * size;
    Next { end, size: if same { size } else { exact }, clipped }
}

/// A work space in place of none or of that of another step.
fn work_of<'a>(
    slot: &'a mut Option<ExplicitWork>,
    model: &ExplicitModel,
    nodal: &crate::nodal::Nodal,
    step: usize,
) -> &'a mut ExplicitWork {
    if slot.as_ref().is_none_or(|work| work.step() != step) {
        *slot = None;
    }
    slot.get_or_insert_with(|| ExplicitWork::new(model, nodal, step))
}

impl Simulation {
    fn explicit_control(&self) -> &ExplicitControl {
        match &self.prepared.model.steps[self.state.step as usize].procedure {
            Procedure::Explicit(control) => control,
            Procedure::Static(_) | Procedure::Dynamic(_) => unreachable!("only explicit steps advance here"),
        }
    }

    /// Runs an interval of an explicit step.
    pub(crate) fn advance_explicit(&mut self, interval: &Interval, watch: &mut dyn Watch) -> AdvanceOutcome {
        while self.state.step_time < interval.end - interval.tolerance {
            if watch.cancelled() {
                return AdvanceOutcome::Cancelled;
            }
            match self.explicit_increment(interval) {
                Ok(report) => watch.increment(self, &report),
                Err(reason) => {
                    return AdvanceOutcome::Stopped { reason: format!("after total time {}: {reason}", self.time()) };
                }
            }
            if let Some(reason) = self.explicit_findings() {
                return AdvanceOutcome::Stopped { reason: format!("after total time {}: {reason}", self.time()) };
            }
        }
        self.finish_interval(interval);
        AdvanceOutcome::Reached
    }

    /// One increment; the error is why there is none, in words.
    fn explicit_increment(&mut self, interval: &Interval) -> Result<IncrementReport, String> {
        let prepared = self.prepared.clone();
        let (model, nodal, step) = (prepared.explicit(), prepared.nodal(), self.state.step as usize);
        let columns = &prepared.loading.columns;
        let now = self.state.step_time;
        let mut loads = std::mem::take(&mut self.work.scratch);
        self.coefficients_at(now, interval, &mut loads);
        let mut slot = self.explicit.take();
        let work = work_of(&mut slot, model, nodal, step);
        let control = self.explicit_control().clone();
        // What limits without contact also limits what contact is asked to allow.
        let (wished, scale) = match control.increments {
            ExplicitIncrements::Direct(size) => (size, 1.0),
            ExplicitIncrements::Automatic { scale } => {
                let largest = control.increment_max.unwrap_or(f64::INFINITY);
                // Up to it laws are looked at: an increment is its part.
                (model.free_increment(step).min(largest / scale).min(control.period / scale), scale)
            }
        };
        let (stable, row) = {
            let mut memory = self.memory();
            model.look(nodal, columns, &loads, &mut memory, work);
            model.stable_increment(wished, scale, &memory, work)
        };
        let result = if work.is_finite() {
            self.choose(&control, wished, stable, row, interval, work)
        } else {
            Err(self.beyond_numbers())
        };
        let result = result.and_then(|next| {
            let mut coefficients = std::mem::take(&mut self.work.coefficients);
            self.coefficients_at(next.end, interval, &mut coefficients);
            let found = {
                let mut memory = self.memory();
                model.advance(nodal, columns, &loads, &coefficients, next.size, &mut memory, work)
            };
            match found {
                Ok(found) => {
                    std::mem::swap(&mut self.state.coefficients, &mut coefficients);
                    self.work.coefficients = coefficients;
                    Ok(self.accept_explicit(next, interval, found, stable))
                }
                Err(refusal) => {
                    self.work.coefficients = coefficients;
                    self.take_back(next.size);
                    Err(self.describe_refusal(refusal))
                }
            }
        });
        self.explicit = slot;
        self.work.scratch = loads;
        result
    }

    /// The state as an increment sees it.
    fn memory(&mut self) -> Memory<'_> {
        let state = &mut self.state;
        let motion = state.motion.as_mut().expect("an explicit step has a motion");
        Memory {
            displacement: &mut motion.displacement,
            velocity: &mut motion.velocity,
            acceleration: &mut motion.acceleration,
            reaction: &mut motion.reaction,
            forces: &mut state.forces,
            viscous: &mut state.viscous,
            closed: &mut state.closed,
            latched: &mut state.latched,
            stuck: &mut state.stuck,
            origins: &mut state.origins,
            ledger: &mut motion.ledger,
            last: motion.size_before,
            begins: motion.increment_last == 0.0,
        }
    }

    /// Size of the increment, given the stable one and the contact row that limits it.
    fn choose(
        &mut self,
        control: &ExplicitControl,
        wished: f64,
        stable: f64,
        row: Option<u32>,
        interval: &Interval,
        work: &ExplicitWork,
    ) -> Result<Next, String> {
        let (now, tolerance) = (self.state.step_time, interval.tolerance);
        let period = control.period;
        let bound = if now < period - tolerance { period.min(interval.end) } else { interval.end };
        match control.increments {
            ExplicitIncrements::Direct(size) => {
                let next = next_direct(now, size, bound, tolerance);
                if next.size > stable * (1.0 + STABLE_TOLERANCE) {
                    let what = self.limiting(row, work);
                    return Err(format!(
                        "increments of {size} are not stable: {what} allows {stable}; use a smaller increment, automatic ones, or *FIXED MASS SCALING"
                    ));
                }
                Ok(next)
            }
            ExplicitIncrements::Automatic { scale } => {
                // Where nothing limits it the deck should: a part of the step is a guess.
                let free = control.increment_max.is_none() && stable >= period;
                let limit = if free { UNLIMITED * period } else { scale * wished.min(stable) };
                if !(limit > 0.0 && limit.is_finite()) {
                    let what = self.limiting(row, work);
                    return Err(format!("{what} allows no increment"));
                }
                let size = self.state.increment_next;
                if !(size <= limit && size >= KEPT * limit) {
                    self.set_increment(limit);
                }
                let size = self.state.increment_next;
                let grid = self.state.increment_anchor + f64::from(self.state.increment_index + 1) * size;
                Ok(next_automatic(now, size, grid, bound))
            }
        }
    }

    /// What limits the stable increment, in words.
    fn limiting(&self, row: Option<u32>, work: &ExplicitWork) -> String {
        let prepared = &self.prepared;
        let mesh = &prepared.model.mesh;
        if let Some(row) = row {
            let point = &prepared.row_points[row as usize];
            let pair = &prepared.model.pairs[point.pair as usize].name;
            return format!("contact of node {} (pair {pair})", mesh.node_labels[point.node.index()]);
        }
        match prepared.explicit().limited_by(work) {
            (Some(element), _) => format!("element {}", mesh.element_labels[element as usize]),
            (None, node) => format!("what is connected to node {}", mesh.node_labels[node]),
        }
    }

    /// Makes an increment the state.
    fn accept_explicit(&mut self, next: Next, interval: &Interval, found: Found, stable: f64) -> IncrementReport {
        let prepared = self.prepared.clone();
        let mut columns = std::mem::take(&mut self.work.columns);
        self.columns_at(next.end, interval, &mut columns);
        let energies = found.energies;
        let points = prepared.points.len();
        let state = &mut self.state;
        let motion = state.motion.as_mut().expect("an explicit step has a motion");
        if motion.increment_last == 0.0 {
            motion.energy_start = energies.total;
        }
        let largest = [energies.strain, energies.kinetic, energies.external_work, energies.viscous, energies.contact];
        motion.energy_max =
            largest.iter().fold(motion.energy_max, |m, e| m.max(e.abs())).max(energies.impact_loss.abs());
        motion.energies = energies;
        motion.momentum_max = motion.momentum_max.max(found.momentum);
        motion.rates.clear();
        motion.rates.extend(columns.iter().map(|column| column.rate));
        motion.curvatures.clear();
        motion.curvatures.extend(columns.iter().map(|column| column.acceleration));
        self.work.columns = columns;
        (motion.increment_last, motion.size_before) = (next.size, next.size);
        let n = prepared.rows.count();
        for (i, point) in prepared.points.iter().enumerate().filter(|(i, _)| state.closed[*i] && !state.stuck[*i]) {
            for (t, tangent) in point.tangents.into_iter().enumerate() {
                let mut rate = 0.0;
                point.row(tangent, |node, d, value| rate += value * motion.velocity[node.index()][d]);
                state.slip[t * n + i] += next.size * rate;
            }
        }
        state.step_time = next.end;
        state.counts[state.step as usize].increments += 1;
        match next.clipped {
            false => state.increment_index += 1,
            true => (state.increment_anchor, state.increment_index) = (next.end, 0),
        }
        let moment = Self::moment(&prepared, self.state.step as usize, self.state.step_time);
        let change = |i: usize| {
            let (from, to) = (self.derived.points[i].status, self.status(&moment, i));
            (from != to).then_some(StatusChange { point: i as u32, from, to })
        };
        let status_changes: Vec<StatusChange> = (0..points).filter_map(change).collect();
        if !status_changes.is_empty() {
            self.state.last_change = self.time();
        }
        self.moved_overclosures();
        self.refresh();
        IncrementReport {
            step: self.state.step + 1,
            increment: self.state.counts[self.state.step as usize].increments,
            attempt: 1,
            time: self.time(),
            step_time: self.state.step_time,
            increment_size: next.size,
            stable_increment: Some(stable),
            status_changes,
            ..IncrementReport::default()
        }
    }

    /// Goes back to the start of an increment whose contact has no solution.
    fn take_back(&mut self, size: f64) {
        let motion = self.state.motion.as_mut().expect("an explicit step has a motion");
        let before = if motion.size_before > 0.0 { motion.size_before } else { size };
        let mean = 0.5 * (before + size);
        let vectors = motion.displacement.iter_mut().zip(&mut motion.velocity).zip(&motion.acceleration);
        for ((u, v), a) in vectors {
            for d in 0..3 {
                u[d] -= size * v[d];
                v[d] -= mean * a[d];
            }
        }
    }

    /// Why an analysis that has just made an increment cannot go on.
    fn explicit_findings(&self) -> Option<String> {
        let prepared = &self.prepared;
        let labels = &prepared.model.mesh.node_labels;
        let motion = self.state.motion.as_ref()?;
        let e = &motion.energies;
        if ![e.strain, e.kinetic, e.total].iter().all(|x| x.is_finite()) {
            let wild = |x: &[f64; 3]| x.iter().any(|x| !x.is_finite());
            let node = motion.displacement.iter().zip(&motion.velocity).position(|(u, v)| wild(u) || wild(v));
            return Some(format!(
                "the motion of node {} leaves the range of numbers; an input is too large for this model",
                labels[node.unwrap_or(0)]
            ));
        }
        let given = motion.energy_start.abs() + e.external_work.abs() + motion.ledger.stored_start.abs();
        if e.strain + e.kinetic.abs() > UNSTABLE * given && given > 0.0 {
            let speed = |v: &[f64; 3]| v.iter().map(|x| x * x).sum::<f64>();
            let fastest = (0..motion.velocity.len())
                .max_by(|&a, &b| speed(&motion.velocity[a]).total_cmp(&speed(&motion.velocity[b])));
            return Some(format!(
                "the motion is unstable: strain energy {} and kinetic energy {} where only {given} was given; the fastest node is {}; use smaller increments",
                e.strain,
                e.kinetic,
                fastest.map_or(0, |n| labels[n])
            ));
        }
        let mut slid: Vec<String> = Vec::new();
        for (_, point) in prepared.points.iter().enumerate().filter(|(i, _)| self.state.closed[*i]) {
            let way = point.tangents.map(|tangent| {
                let mut way = 0.0;
                point.row(tangent, |node, d, value| way += value * motion.displacement[node.index()][d]);
                way
            });
            if way[0].hypot(way[1]) > SLIDING_MAX * point.face_size {
                let pair = &prepared.model.pairs[point.pair as usize].name;
                slid.push(format!("{} (pair {pair})", labels[point.node.index()]));
            }
        }
        if slid.is_empty() {
            return None;
        }
        let more = if slid.len() > NAMED { format!(" and {} more", slid.len() - NAMED) } else { String::new() };
        slid.truncate(NAMED);
        Some(format!(
            "a secondary node slides beyond half a face of the primary surface, which small sliding does not cover: node {}{more}",
            slid.join(", ")
        ))
    }

    /// Loads or contact forces that are no numbers, in words.
    fn beyond_numbers(&self) -> String {
        let point = self.state.forces.iter().take(self.prepared.points.len()).position(|f| !f.is_finite());
        let labels = &self.prepared.model.mesh.node_labels;
        match point {
            Some(i) => format!(
                "the contact force of node {} leaves the range of numbers",
                labels[self.prepared.points[i].node.index()]
            ),
            None => "loads leave the range of numbers; an input is too large for this model".to_owned(),
        }
    }

    fn describe_refusal(&self, refusal: Refusal) -> String {
        let name = |point: u32| {
            let point = &self.prepared.points[point as usize];
            let label = self.prepared.model.mesh.node_labels[NodeId::index(point.node)];
            format!("node {label} (pair {})", self.prepared.model.pairs[point.pair as usize].name)
        };
        match refusal {
            Refusal::Prescribed(point) => format!(
                "secondary {} meets its primary surface, but its motion along the normal is prescribed: kinematic contact cannot correct it; release it, exchange the surfaces, or use MECHANICAL CONSTRAINT=PENALTY",
                name(point)
            ),
            Refusal::Unsettled(point) => {
                format!("kinematic contact around {} does not settle; use MECHANICAL CONSTRAINT=PENALTY", name(point))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_increments_of_a_request_share_what_is_left() {
        let next = next_automatic(0.0, 0.3, 0.3, 10.0);
        assert_eq!(next, Next { end: 0.3, size: 0.3, clipped: false });
        let (mut now, mut count) = (0.0, 0);
        while now < 1.0 {
            let next = next_automatic(now, 0.3, now + 0.3, 1.0);
            assert!(next.clipped && (next.size - 0.25).abs() < 1e-10, "{next:?}");
            (now, count) = (next.end, count + 1);
        }
        assert_eq!((now, count), (1.0, 4));
        let next = next_automatic(0.0, 0.25, 0.25, 1.0);
        assert_eq!(next, Next { end: 0.25, size: 0.25, clipped: true });
    }

    #[test]
    fn fixed_increments_stand_on_their_grid() {
        let mut now = 0.0;
        for k in 1..=50 {
            let next = next_direct(now, 1e-3, 1.0, 1e-12);
            assert_eq!((next.end, next.size, next.clipped), (f64::from(k) * 1e-3, 1e-3, false));
            now = next.end;
        }
        assert_eq!(next_direct(0.05, 1e-3, 0.0505, 1e-12).end, 0.0505);
    }
}
