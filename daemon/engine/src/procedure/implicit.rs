//! Implicit dynamic increments: the operator of Hilber, Hughes and Taylor with the statuses of hard contact as they are at the start.
//!
//! What changes hard contact on the way is an event: `impact.rs` finds it, the increment ends there, and velocities and
//! accelerations are those behind it. Softened contact, penalties and dampers are forces like others, solved for in the increment.

use crate::diagnostic::Diagnostic;
use crate::implicit::{Hht, Operator, Operators};
use crate::model::{BoundaryKind, DynamicControl, Procedure};
use crate::nodal::{load, place};
use crate::procedure::enforcement::{Coupling, IncrementCounts};
use crate::procedure::failure::Failure;
use crate::procedure::interference;
use crate::procedure::interval::{Event, Found, Interval};
use crate::simulation::Simulation;

/// Events at one time before an increment is given up.
const EVENTS_MAX: usize = 1000;
/// Events in a row that are located in time. Those that still follow happen at the start of their increment.
const LOCATED_MAX: u32 = 20;

/// Work space of implicit increments: nodal vectors.
#[derive(Default)]
pub(crate) struct ImplicitWork {
    pub operators: Operators,
    /// Displacement, velocity and acceleration at the end of the attempt.
    pub displacement: Vec<[f64; 3]>,
    pub velocity: Vec<[f64; 3]>,
    pub acceleration: Vec<[f64; 3]>,
    /// Forces on the way.
    pub force: Vec<[f64; 3]>,
    pub change: Vec<[f64; 3]>,
    /// Loads at the start and at the end of the increment.
    pub loads: [Vec<[f64; 3]>; 2],
}

impl ImplicitWork {
    /// For a number of nodes.
    pub fn new(nodes: usize) -> Self {
        let vector = || vec![[0.0; 3]; nodes];
        Self {
            displacement: vector(),
            velocity: vector(),
            acceleration: vector(),
            force: vector(),
            change: vector(),
            loads: [vector(), vector()],
            ..Self::default()
        }
    }
}

/// The findings of a factorisation, in words.
pub(crate) fn words(errors: &[Diagnostic]) -> String {
    let texts: Vec<String> = errors.iter().map(|e| format!("{}; {}", e.message, e.remedy)).collect();
    texts.join("; ")
}

impl Simulation {
    /// Control of the present step.
    pub(crate) fn dynamic_control(&self) -> DynamicControl {
        match self.prepared.model.steps[self.state.step as usize].procedure {
            Procedure::Dynamic(control) => control,
            Procedure::Static(_) | Procedure::Explicit(_) => unreachable!("only implicit dynamic steps ask"),
        }
    }

    /// Tries an implicit dynamic increment to a step time; where hard contact changes on the way it ends there.
    pub(crate) fn attempt_dynamic(&mut self, end: f64, size: f64, interval: &Interval) -> Result<Found, Failure> {
        let mut counts = IncrementCounts::default();
        if self.state.motion.as_ref().is_some_and(|motion| motion.increment_last == 0.0) {
            self.begin_dynamics(interval, &mut counts)?;
        }
        let begun = self.state.step_time;
        let mut event = None;
        // New inputs at the same time act from now on: a motion does not jump.
        let mut easy = true;
        for tried in 0.. {
            if size == 0.0 {
                break;
            }
            if tried == EVENTS_MAX {
                return Err(Failure::Events);
            }
            self.trial(end, size, interval, &mut counts)?;
            let Some(found) = self.next_event() else {
                easy = self.check_half_increment(end, size, interval)?;
                self.accept_motion(end, size)?;
                self.count_located(|_| 0);
                break;
            };
            let located = found.fraction * size;
            let so_far = self.state.motion.as_ref().map_or(0, |motion| motion.located);
            // Before the first moment that can be told from the start nothing has moved.
            let moves = located > interval.tolerance && begun + located > begun && so_far < LOCATED_MAX;
            if moves {
                self.trial(begun + located, located, interval, &mut counts)?;
                self.accept_motion(begun + located, located)?;
                self.count_located(|before| before + 1);
            }
            let kind = self.change_contact(&found, &mut counts)?;
            event = if event == Some(Event::Impact) { event } else { Some(kind) };
            if moves {
                break;
            }
        }
        let changes = self.status_changes();
        Ok(Found { counts, changes, easy, event })
    }

    fn count_located(&mut self, next: impl Fn(u32) -> u32) {
        let motion = self.state.motion.as_mut().expect("a dynamic step has a motion");
        motion.located = next(motion.located);
    }

    /// Solves an increment with the statuses of hard contact at its start; the result is in the work space.
    fn trial(&mut self, end: f64, size: f64, interval: &Interval, counts: &mut IncrementCounts) -> Result<(), Failure> {
        let prepared = self.prepared.clone();
        let (nodal, model) = (prepared.nodal(), prepared.implicit());
        let control = self.dynamic_control();
        let hht = Hht::new(control.alpha, size);
        let (weight, step) = (1.0 + control.alpha, self.state.step as usize);
        let mut now = std::mem::take(&mut self.work.columns);
        self.columns_at(end, interval, &mut now);
        self.work.coefficients.clear();
        self.work.coefficients.extend(now.iter().map(|column| column.value));
        self.work.columns = now;
        let motion = self.state.motion.as_ref().expect("a dynamic step has a motion");
        let work = &mut self.implicit;
        // Trial motion: free directions without acceleration, prescribed ones where they will be.
        let columns = &prepared.loading.columns;
        work.displacement.clone_from(&motion.displacement);
        for &at in &nodal.prescribed {
            work.displacement.as_flattened_mut()[at] = 0.0;
        }
        place(columns, &self.work.coefficients, &mut work.displacement);
        let flat = |v: &[[f64; 3]], i: usize| v.as_flattened()[i];
        let mut next = nodal.prescribed.iter().peekable();
        for i in 0..3 * motion.displacement.len() {
            let (u0, v0, a0) =
                (flat(&motion.displacement, i), flat(&motion.velocity, i), flat(&motion.acceleration, i));
            let (v, a) = if next.next_if(|&&at| at == i).is_some() {
                hht.correct(u0, v0, a0, flat(&work.displacement, i))
            } else {
                let (u, v) = hht.predict(u0, v0, a0);
                work.displacement.as_flattened_mut()[i] = u;
                (v, 0.0)
            };
            work.velocity.as_flattened_mut()[i] = v;
            work.acceleration.as_flattened_mut()[i] = a;
        }
        // Where velocities or accelerations are prescribed they are known.
        for ((column, now), &kind) in columns.iter().zip(&self.work.columns).zip(&prepared.loading.kinds[step]) {
            if kind != BoundaryKind::Displacement {
                for &(node, d, share) in column.entries() {
                    work.velocity[node.index()][usize::from(d)] = share * now.rate;
                    work.acceleration[node.index()][usize::from(d)] = share * now.acceleration;
                }
            }
        }
        for vector in [&mut work.displacement, &mut work.velocity, &mut work.acceleration] {
            nodal.extend(vector);
        }
        // ρ = f_1 + α/(1+α) r_0 − M a/(1+α) − K u − C v
        load(columns, &self.work.coefficients, &mut work.loads[1]);
        for ((force, load), unbalance) in work.force.iter_mut().zip(&work.loads[1]).zip(&motion.unbalance) {
            for d in 0..3 {
                force[d] = load[d] + control.alpha / weight * unbalance[d];
            }
        }
        model.mass(control.mass).multiply_add(-1.0 / weight, &work.acceleration, &mut work.force);
        model.stiffness.multiply_add(-1.0, &work.displacement, &mut work.force);
        if let Some(damping) = model.damping(control.mass) {
            damping.multiply_add(-1.0, &work.velocity, &mut work.force);
        }
        nodal.restrict(&mut work.force);
        // Overclosures without contact forces.
        let free = &mut self.work.free;
        free.clear();
        let of_row = |row: usize| nodal.initial[row] - motion.offsets[row] + nodal.along(row, &work.displacement);
        free.extend((0..nodal.rows()).map(of_row));
        let begun = self.step_starts[step];
        interference::allow(&prepared.model, &prepared.rows, &nodal.initial, step, begun, end, free);
        let mut operators = std::mem::take(&mut work.operators);
        let solved = match operators.increment(&prepared, &hht, control.mass) {
            Err(errors) => Err(Failure::Singular(words(&errors))),
            Ok((operator, fresh)) => {
                counts.solves.factorizations += u32::from(fresh);
                operator.begin(&work.force, &mut self.work.free);
                let solved = self.contact_forces(operator, &hht, end, counts);
                if solved.is_ok() {
                    let work = &mut self.implicit;
                    work.change.fill([0.0; 3]);
                    operator.end(&self.work.forces, &mut work.change);
                }
                solved
            }
        };
        let work = &mut self.implicit;
        work.operators = operators;
        solved?;
        nodal.extend(&mut work.change);
        let (speed, curvature) = (hht.speed(), hht.curvature());
        let trial = work.displacement.iter_mut().zip(&mut work.velocity).zip(&mut work.acceleration);
        for (((u, v), a), change) in trial.zip(&work.change) {
            for d in 0..3 {
                u[d] += change[d];
                v[d] += speed * change[d];
                a[d] += curvature * change[d];
            }
        }
        let finite =
            work.displacement.as_flattened().iter().chain(work.acceleration.as_flattened()).all(|x| x.is_finite());
        if finite { Ok(()) } else { Err(Failure::Overflow) }
    }

    /// Forces of contact for the free overclosures in the work space.
    fn contact_forces(
        &mut self,
        operator: &mut Operator,
        hht: &Hht,
        end: f64,
        counts: &mut IncrementCounts,
    ) -> Result<(), Failure> {
        let prepared = self.prepared.clone();
        let nodal = prepared.nodal();
        let motion = self.state.motion.as_ref().expect("a dynamic step has a motion");
        let work = &mut self.work;
        for (row, start) in work.starts.iter_mut().enumerate() {
            let along = |x: &[[f64; 3]]| nodal.along(row, x);
            let h0 = self.derived.overclosures[row];
            *start = hht.dashpot_start(h0, along(&motion.velocity), along(&motion.acceleration));
        }
        work.forces.clone_from(&self.state.forces);
        work.closed.clone_from(&self.state.closed);
        work.motions.clear();
        operator.system.relief(&work.forces, &mut work.relief);
        let Operator { system, solver, .. } = operator;
        let solved = self.equilibrium(&mut Coupling { system, solver }, end, 1.0 / hht.speed());
        let solved = solved.map_err(Failure::Solve)?;
        counts.solves.equilibrium_iterations += solved.solves.equilibrium_iterations;
        counts.solves.severe_discontinuity_iterations += solved.solves.severe_discontinuity_iterations;
        counts.augmentations += solved.augmentations;
        Ok(())
    }
}
