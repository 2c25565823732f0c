//! Static increments: fixed or automatic, cut back when no equilibrium is found.

use crate::procedure::enforcement::{Coupling, IncrementCounts};
use crate::procedure::failure::Failure;
use crate::procedure::interference;
use crate::procedure::interval::Interval;
use crate::simulation::{Simulation, StatusChange};
use crate::solve::condensed::Response;

impl Simulation {
    /// Tries to find equilibrium at a step time; the state changes only on success.
    pub(crate) fn attempt_static(
        &mut self,
        time: f64,
        interval: &Interval,
    ) -> Result<(IncrementCounts, Vec<StatusChange>), Failure> {
        let prepared = self.prepared.clone();
        let mut coefficients = std::mem::take(&mut self.work.coefficients);
        self.coefficients_at(time, interval, &mut coefficients);
        self.free_overclosures(&coefficients, time);
        let work = &mut self.work;
        prepared.statics().condensed.motion_load(&coefficients, &mut work.load, &mut work.load_scale);
        work.forces.clone_from(&self.state.forces);
        work.closed.resize(prepared.rows.count(), false);
        work.relief.clone_from(&self.derived.relief);
        work.motions.clone_from(&self.state.motions);
        work.springs.clone_from(&self.state.springs);
        let given = self.take_removed(time);
        self.work.starts.clone_from(&self.derived.overclosures);
        let mut solver = self.solver.take().expect("a deck with a static step has one");
        let mut coupling = Coupling { system: &prepared.statics().contact, solver: &mut solver };
        let solved = self.equilibrium(&mut coupling, time, time - self.state.step_time);
        self.solver = Some(solver);
        let counts = match solved {
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
        if !prepared.statics().loose.is_empty() {
            prepared.statics().loose.settle(
                &prepared.statics().condensed,
                &coefficients,
                &work.forces,
                &mut work.motions,
                &mut work.loose,
            );
            prepared.statics().contact.overclosures(&work.free, &work.relief, &work.motions, &mut work.overclosures);
        }
        let moment = Self::moment(&prepared, self.state.step as usize, time);
        for (i, exact) in work.penetrations.iter().enumerate().filter(|&(i, _)| moment.penetration_max(i).is_some()) {
            work.overclosures[i] = *exact;
        }
        let response = Response { coefficients: &coefficients, forces: &work.forces, motions: &work.motions };
        prepared.statics().condensed.tangential(
            &prepared.statics().contact,
            response,
            &mut work.scratch,
            &mut work.tangential,
        );
        let slid = self.slid();
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
        let strain = prepared.statics().condensed.strain_energy(coefficients, &work.forces, &work.relief);
        let contact = prepared.statics().contact.energy(&work.rows, &work.overclosures, &work.closed);
        let response = Response { coefficients, forces: &work.forces, motions: &work.motions };
        let conjugates = (0..prepared.real_columns).all(|column| {
            let conjugate = prepared.statics().condensed.conjugate(column, response);
            (conjugate * coefficients[column]).is_finite()
        });
        conjugates && strain.is_finite() && contact.is_finite() && self.state.external_work.is_finite()
    }

    /// Makes the solution in the work space the state.
    fn accept(&mut self, time: f64, coefficients: Vec<f64>) -> Vec<StatusChange> {
        let prepared = self.prepared.clone();
        let moment = Self::moment(&prepared, self.state.step as usize, time);
        self.keep_statuses(&moment);
        let (state, work) = (&mut self.state, &mut self.work);
        // A dashpot dissipates its force times what the increment moved it: backward Euler.
        for (i, row) in work.rows.iter().enumerate() {
            state.viscous[i] = row.viscous_force(work.overclosures[i]);
            state.damping_work += state.viscous[i] * (work.overclosures[i] - self.derived.overclosures[i]);
        }
        // Work by the trapezoidal rule on each force-displacement pair.
        let response = Response { coefficients: &coefficients, forces: &work.forces, motions: &work.motions };
        for column in 0..prepared.real_columns {
            let conjugate = prepared.statics().condensed.conjugate(column, response);
            let (a0, a1, c0) = (state.coefficients[column], coefficients[column], state.conjugates[column]);
            state.external_work += match prepared.statics().condensed.is_displacement[column] {
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
        self.status_changes()
    }

    /// Overclosures without contact forces into the work space, less those that are allowed at a step time.
    pub(crate) fn free_overclosures(&mut self, coefficients: &[f64], time: f64) {
        let prepared = &self.prepared;
        prepared.statics().condensed.free_overclosures(coefficients, &mut self.work.free);
        interference::allow(
            &prepared.model,
            &prepared.rows,
            &prepared.statics().condensed.initial,
            self.state.step as usize,
            self.step_start_time(),
            time,
            &mut self.work.free,
        );
    }
}
