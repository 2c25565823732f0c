//! Pairs that a step removes or brings back (`*MODEL CHANGE`).
//!
//! The contact forces that a pair has when it is removed go linearly to zero over the step, so that nothing snaps. Its latches,
//! multipliers and sticking points are forgotten: a pair that comes back meets as on the first day.

use crate::simulation::Simulation;

impl Simulation {
    /// At the start of a step: what the pairs carried that have just been removed.
    pub(crate) fn remove_pairs(&mut self) {
        let prepared = self.prepared.clone();
        let step = self.state.step as usize;
        let before = step.checked_sub(1).map(|before| Self::moment(&prepared, before, 0.0));
        let now = Self::moment(&prepared, step, 0.0);
        let points = prepared.rows.points();
        let point_of = |row: usize| match row.checked_sub(points) {
            None => row,
            Some(k) => prepared.rows.tangential[k].point as usize,
        };
        let state = &mut self.state;
        for row in 0..prepared.rows.count() {
            let point = point_of(row);
            let goes = !now.is_active(point) && before.is_some_and(|before| before.is_active(point));
            state.removed[row] = if goes { state.forces[row] } else { 0.0 };
        }
        for i in (0..points).filter(|&i| !now.is_active(i)) {
            state.closed[i] = false;
            state.stuck[i] = false;
            state.latched[i] = false;
            state.multipliers[i] = 0.0;
        }
    }

    /// At the start of a step: allowed overclosures begin with it, and pairs that come back have overclosures again.
    pub(crate) fn begin_overclosures(&mut self) {
        let prepared = self.prepared.clone();
        let step = self.state.step as usize;
        let (before, now) = (Self::moment(&prepared, step - 1, f64::MAX), Self::moment(&prepared, step, 0.0));
        // The work space holds the free overclosures at the end of the last step.
        let old = self.work.free.clone();
        let coefficients = std::mem::take(&mut self.state.coefficients);
        self.free_overclosures(&coefficients, 0.0);
        self.state.coefficients = coefficients;
        let (state, work) = (&mut self.state, &mut self.work);
        prepared.statics().contact.relief(&state.forces, &mut work.relief);
        prepared.statics().contact.overclosures(&work.free, &work.relief, &state.motions, &mut work.overclosures);
        for i in (0..prepared.points.len()).filter(|&i| now.penetration_max(i).is_some()) {
            state.penetrations[i] = match before.is_active(i) {
                true => state.penetrations[i] + (work.free[i] - old[i]),
                false => work.overclosures[i],
            };
        }
    }

    /// Takes what removed pairs still carry at a step time out of the problem in the work space; whether there is any.
    pub(crate) fn take_removed(&mut self, time: f64) -> bool {
        if self.state.removed.iter().all(|f| *f == 0.0) {
            return false;
        }
        let prepared = self.prepared.clone();
        let left = 1.0 - Self::moment(&prepared, self.state.step as usize, time).progress;
        let (state, work) = (&self.state, &mut self.work);
        work.given.clear();
        work.given.extend(state.removed.iter().map(|f| left * f));
        prepared.statics().contact.relief(&work.given, &mut work.relief);
        work.free.iter_mut().zip(&work.relief).for_each(|(h, relief)| *h -= relief);
        let motions = &prepared.statics().contact.gap_motions;
        for (m, load) in work.load.iter_mut().enumerate() {
            *load -= motions.column(m).iter().zip(&work.given).map(|(d, f)| d * f).sum::<f64>();
        }
        for (force, removed) in work.forces.iter_mut().zip(&state.removed) {
            if *removed != 0.0 {
                *force = 0.0;
            }
        }
        prepared.statics().contact.relief(&work.forces, &mut work.relief);
        true
    }

    /// Puts it back into the solution.
    pub(crate) fn give_removed(&mut self, coefficients: &[f64], time: f64) {
        self.free_overclosures(coefficients, time);
        let prepared = self.prepared.clone();
        let work = &mut self.work;
        work.forces.iter_mut().zip(&work.given).for_each(|(force, given)| *force += given);
        prepared.statics().contact.relief(&work.forces, &mut work.relief);
        prepared.statics().contact.overclosures(&work.free, &work.relief, &work.motions, &mut work.overclosures);
    }
}
