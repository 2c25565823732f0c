//! Events of hard contact in implicit dynamics: points that close or open within an increment.
//!
//! Where a point would overlap at the end of an increment, or a closed one would pull, the increment ends at the mean of the times
//! at which that happens, all going linearly. There every listed point changes at once:
//!
//! ```text
//! M Δv + Bᵀ H = 0,  B (v + Δv) = 0      impulses H of points that close: closed points have one normal velocity
//! M a + Bᵀ Λ = −r,  B a = 0             accelerations behind the event; a point that would pull opens
//! ```
//!
//! Energy that is lost is `½ Σ H (B v⁻ + B v⁺)`. A closing point is where it touches from then on: what is left of its clearance is kept
//! as an offset. Source: Abaqus Theory Manual 2.4.2; offset and guards are our rules.

use crate::model::Enforcement;
use crate::nodal::{largest, load};
use crate::procedure::enforcement::IncrementCounts;
use crate::procedure::failure::Failure;
use crate::procedure::implicit::words;
use crate::procedure::interval::{Event, Interval};
use crate::simulation::Simulation;
use crate::solve::contact::{Problem, Row, Unknowns, Wall};

/// Overclosure of an open point, relative to the largest, that is rounding.
const OVERCLOSURE_ROUNDING: f64 = 1e-12;
/// The same relative to the size of the model.
const PLACE_ROUNDING: f64 = 1e-14;
/// Tension or impulse, relative to the largest force, that is rounding.
const FORCE_ROUNDING: f64 = 1e-11;

/// What hard contact is about to do.
pub(crate) struct Upcoming {
    /// When, as a part of the increment.
    pub fraction: f64,
    /// Points that close.
    pub closing: Vec<u32>,
    /// Points that open.
    pub opening: Vec<u32>,
}

impl Simulation {
    /// What the trial in the work space violates; none if nothing.
    pub(crate) fn next_event(&self) -> Option<Upcoming> {
        let prepared = &self.prepared;
        let moment = Self::moment(prepared, self.state.step as usize, self.state.step_time);
        let (state, work) = (&self.state, &self.work);
        let weight = 1.0 + self.dynamic_control().alpha;
        let slack = OVERCLOSURE_ROUNDING * work.scale + PLACE_ROUNDING * prepared.extent;
        let forces = work.forces.iter().fold(0.0f64, |m, f| m.max(f.abs()));
        let scale = state.motion.as_ref().map_or(0.0, |motion| motion.force_scale(state.increment_next)).max(forces);
        let mut event = Upcoming { fraction: 0.0, closing: Vec::new(), opening: Vec::new() };
        for i in (0..prepared.points.len()).filter(|&i| is_hard(&moment, i)) {
            let closed = work.rows[i].wall == Wall::TwoSided;
            let multiplier = weight * work.forces[i];
            if closed && self.may_open(i) && multiplier < -FORCE_ROUNDING * scale {
                let before = state.forces[i].max(0.0);
                event.fraction += before / (before - multiplier);
                event.opening.push(i as u32);
            } else if !closed && work.overclosures[i] > slack {
                let before = (-self.derived.overclosures[i]).max(0.0);
                event.fraction += before / (before + work.overclosures[i]);
                event.closing.push(i as u32);
            }
        }
        let count = event.closing.len() + event.opening.len();
        event.fraction /= count as f64;
        (count > 0).then_some(event)
    }

    /// Changes hard contact in the present state, with the impulses and accelerations that follow.
    pub(crate) fn change_contact(&mut self, event: &Upcoming, counts: &mut IncrementCounts) -> Result<Event, Failure> {
        let prepared = self.prepared.clone();
        let moment = Self::moment(&prepared, self.state.step as usize, self.state.step_time);
        counts.solves.severe_discontinuity_iterations += 1;
        for &i in &event.opening {
            self.open(i as usize);
        }
        // At the mean of their times some points overlap already that do so no more at the end of the increment.
        let slack = OVERCLOSURE_ROUNDING * self.work.scale + PLACE_ROUNDING * prepared.extent;
        let overlaps =
            |i: &usize| is_hard(&moment, *i) && !self.state.closed[*i] && self.derived.overclosures[*i] > slack;
        let mut closing: Vec<usize> = (0..prepared.points.len()).filter(overlaps).collect();
        closing.extend(event.closing.iter().map(|&i| i as usize).filter(|i| !overlaps(i)));
        for &i in &closing {
            let motion = self.state.motion.as_mut().expect("a dynamic step has a motion");
            motion.offsets[i] += self.derived.overclosures[i];
            self.state.closed[i] = true;
            self.state.stuck[i] = moment.sticks(i, true, false);
            self.state.latched[i] |= moment.latches(i);
        }
        if !closing.is_empty() {
            self.strike(counts)?;
        }
        self.accelerate(counts)?;
        self.measure_energies();
        self.settle_overclosures();
        Ok(if closing.is_empty() { Event::Release } else { Event::Impact })
    }

    /// At the start of a dynamic step: loads as they are then, forces of softened contact, and accelerations from equilibrium.
    pub(crate) fn begin_dynamics(&mut self, interval: &Interval, counts: &mut IncrementCounts) -> Result<(), Failure> {
        let prepared = self.prepared.clone();
        let mut coefficients = Vec::new();
        self.coefficients_at(self.state.step_time, interval, &mut coefficients);
        for (j, column) in prepared.loading.columns.iter().enumerate() {
            if !column.is_displacement() {
                self.state.coefficients[j] = coefficients[j];
            }
        }
        self.settle_overclosures();
        self.state_rows();
        let behaviors = &prepared.model.interactions;
        for i in 0..prepared.points.len() {
            let row = &self.work.rows[i];
            if row.wall == Wall::None {
                let force = row.area * row.law_of(|b| &behaviors[b].normal, self.derived.overclosures[i]).pressure;
                self.state.forces[i] = force;
                self.state.closed[i] = force != 0.0;
            }
        }
        if self.dynamic_control().initial_accelerations {
            self.accelerate(counts)?;
        } else {
            load(&prepared.loading.columns, &self.state.coefficients, &mut self.implicit.loads[1]);
            self.balance_motion(0.0);
        }
        self.measure_energies();
        self.settle_overclosures();
        let motion = self.state.motion.as_mut().expect("a dynamic step has a motion");
        motion.energy_start = motion.energies.total;
        // A step that has begun does not begin again.
        motion.increment_last = f64::MIN_POSITIVE;
        Ok(())
    }

    /// Whether a closed point may open: one that has done so in vain at this time stays closed, though it may pull, until time goes on.
    fn may_open(&self, i: usize) -> bool {
        !self.state.latched[i] && self.state.motion.as_ref().is_none_or(|motion| !motion.opened[i])
    }

    fn open(&mut self, i: usize) {
        let motion = self.state.motion.as_mut().expect("a dynamic step has a motion");
        motion.opened[i] = true;
        self.state.closed[i] = false;
        self.state.stuck[i] = false;
        self.state.forces[i] = 0.0;
        for (k, tangential) in (self.prepared.points.len()..).zip(&self.prepared.rows.tangential) {
            if tangential.point as usize == i {
                self.state.forces[k] = 0.0;
            }
        }
    }

    /// Rows as the state has them, without dashpots, into the work space.
    fn state_rows(&mut self) {
        let prepared = self.prepared.clone();
        let moment = Self::moment(&prepared, self.state.step as usize, self.state.step_time);
        let (state, rows) = (&self.state, &mut self.work.rows);
        rows.clear();
        let points = prepared.points.len();
        rows.extend((0..points).map(|i| moment.normal_row(state, i, state.closed[i], state.multipliers[i])));
        for &tangential in &prepared.rows.tangential {
            rows.push(moment.tangential_row(state, tangential, state.stuck[tangential.point as usize]));
        }
    }

    /// Impulses of the closed points: they take the normal velocities.
    fn strike(&mut self, counts: &mut IncrementCounts) -> Result<(), Failure> {
        let prepared = self.prepared.clone();
        let nodal = prepared.nodal();
        self.implicit.force.fill([0.0; 3]);
        let before: Vec<f64> = {
            let motion = self.state.motion.as_ref().expect("a dynamic step has a motion");
            (0..nodal.rows()).map(|row| nodal.along(row, &motion.velocity)).collect()
        };
        self.work.free.clone_from(&before);
        let (model, form) = (prepared.implicit(), self.dynamic_control().mass);
        let motion = self.state.motion.as_ref().expect("as above");
        model.mass(form).multiply(&motion.velocity, &mut self.implicit.change);
        let momentum = largest(&self.implicit.change);
        let impulses = self.hold(momentum, counts)?;
        let motion = self.state.motion.as_mut().expect("as above");
        for (v, change) in motion.velocity.iter_mut().zip(&self.implicit.change) {
            (0..3).for_each(|d| v[d] += change[d]);
        }
        let lost = |(row, impulse): (usize, &f64)| 0.5 * impulse * (before[row] + nodal.along(row, &motion.velocity));
        let loss: f64 = impulses.iter().enumerate().filter(|(_, h)| **h != 0.0).map(lost).sum();
        motion.energies.impact_loss += loss;
        Ok(())
    }

    /// Accelerations of the state under its loads, and the forces of closed hard points.
    fn accelerate(&mut self, counts: &mut IncrementCounts) -> Result<(), Failure> {
        let prepared = self.prepared.clone();
        let (nodal, model, form) = (prepared.nodal(), prepared.implicit(), self.dynamic_control().mass);
        load(&prepared.loading.columns, &self.state.coefficients, &mut self.implicit.loads[1]);
        self.state_rows();
        self.balance_motion(0.0);
        let increment = self.state.increment_next;
        let motion = self.state.motion.as_mut().expect("a dynamic step has a motion");
        let scale = motion.force_scale(increment);
        // Prescribed accelerations stay, the others follow.
        let own = &mut self.implicit;
        own.acceleration.fill([0.0; 3]);
        for &at in &nodal.prescribed {
            own.acceleration.as_flattened_mut()[at] = motion.acceleration.as_flattened()[at];
        }
        nodal.extend(&mut own.acceleration);
        for (force, unbalance) in own.force.iter_mut().zip(&motion.unbalance) {
            *force = unbalance.map(|r| -r);
        }
        model.mass(form).multiply_add(-1.0, &own.acceleration, &mut own.force);
        nodal.restrict(&mut own.force);
        let free = &mut self.work.free;
        free.clear();
        free.extend((0..nodal.rows()).map(|row| nodal.along(row, &own.acceleration)));
        let forces = self.hold(scale, counts)?;
        let motion = self.state.motion.as_mut().expect("as above");
        // A direction may have its mass from those that depend on it.
        let diagonal = |i: usize| model.mass(form).diagonal(crate::model::NodeId(i as u32));
        let mut masses: Vec<[f64; 3]> =
            (0..motion.acceleration.len()).map(|i| [0, 4, 8].map(|entry| diagonal(i)[entry])).collect();
        nodal.restrict_masses(&mut masses);
        for (i, (change, known)) in self.implicit.change.iter().zip(&self.implicit.acceleration).enumerate() {
            for d in 0..3 {
                // A direction without mass has no acceleration of its own: it follows at once.
                let moved = if masses[i][d] == 0.0 { 0.0 } else { change[d] };
                motion.acceleration[i][d] = known[d] + moved;
            }
        }
        nodal.extend(&mut motion.acceleration);
        self.state_rows();
        for (row, (force, held)) in self.state.forces.iter_mut().zip(&forces).enumerate() {
            if self.work.rows[row].wall == Wall::TwoSided {
                *force = *held;
            }
        }
        self.balance_motion(0.0);
        Ok(())
    }

    /// Holds the closed hard points against the rates in `work.free` under the nodal forces in `implicit.force`, with the mass as the only
    /// resistance. A point that would have to pull opens; `scale` is what rounding is judged against. What moves is in `implicit.change`, dependents included.
    fn hold(&mut self, scale: f64, counts: &mut IncrementCounts) -> Result<Vec<f64>, Failure> {
        let prepared = self.prepared.clone();
        let (nodal, form) = (prepared.nodal(), self.dynamic_control().mass);
        let mut operators = std::mem::take(&mut self.implicit.operators);
        let result = match operators.mass(&prepared, form) {
            Err(errors) => Err(Failure::Singular(words(&errors))),
            Ok((operator, fresh)) => {
                counts.solves.factorizations += u32::from(fresh);
                operator.begin(&self.implicit.force, &mut self.work.free);
                self.hold_with(operator, scale)
            }
        };
        self.implicit.operators = operators;
        let forces = result?;
        nodal.extend(&mut self.implicit.change);
        Ok(forces)
    }

    fn hold_with(&mut self, operator: &mut crate::implicit::Operator, scale: f64) -> Result<Vec<f64>, Failure> {
        let prepared = self.prepared.clone();
        let (points, n) = (prepared.points.len(), prepared.rows.count());
        let moment = Self::moment(&prepared, self.state.step as usize, self.state.step_time);
        let wall = |held: bool| if held { Wall::TwoSided } else { Wall::None };
        let (mut forces, mut relief) = (vec![0.0; n], vec![0.0; n]);
        let (mut closed, mut overclosures) = (vec![false; n], vec![0.0; n]);
        loop {
            let state = &self.state;
            let holds = |i: usize| is_hard(&moment, i) && (state.closed[i] || state.latched[i]);
            let tied = |k: usize| {
                let point = prepared.rows.tangential[k].point as usize;
                state.stuck[point] && is_hard(&moment, point)
            };
            let row = |i: usize| Row {
                area: prepared.row_points[i].area,
                wall: wall(if i < points { holds(i) } else { tied(i - points) }),
                ..Row::default()
            };
            let rows: Vec<Row> = (0..n).map(row).collect();
            forces.fill(0.0);
            relief.fill(0.0);
            let problem = Problem { rows: &rows, free: &self.work.free, load: &[], load_scale: &[] };
            let mut unknowns = Unknowns {
                forces: &mut forces,
                relief: &mut relief,
                closed: &mut closed,
                overclosures: &mut overclosures,
                motions: &mut [],
                springs: &mut [],
            };
            operator.solver.solve(&operator.system, problem, &mut unknowns).map_err(Failure::Solve)?;
            let largest = forces.iter().fold(scale, |m, f| m.max(f.abs()));
            let pulls = |&i: &usize| {
                rows[i].wall == Wall::TwoSided && self.may_open(i) && forces[i] < -FORCE_ROUNDING * largest
            };
            let dropped: Vec<usize> = (0..points).filter(pulls).collect();
            if dropped.is_empty() {
                self.implicit.change.fill([0.0; 3]);
                operator.end(&forces, &mut self.implicit.change);
                return Ok(forces);
            }
            dropped.into_iter().for_each(|i| self.open(i));
        }
    }
}

/// Whether hard contact by multipliers acts at a point.
fn is_hard(moment: &crate::procedure::rows::Moment<'_>, i: usize) -> bool {
    moment.is_active(i) && moment.enforcement(i) == Some(Enforcement::Lagrange)
}
