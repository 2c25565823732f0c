//! What an accepted increment leaves at the contact points: latches, sticking, slip, and which statuses have changed.

use crate::procedure::rows::Moment;
use crate::simulation::{Simulation, StatusChange};
use crate::solve::contact::Wall;

/// Part of a face that a closed point may slide before small sliding no longer describes it.
const SLIDING_MAX: f64 = 0.5;

impl Simulation {
    /// Closed points that the tangential displacements in the work space carry too far.
    pub(crate) fn slid(&self) -> Vec<u32> {
        let (points, n, work) = (self.prepared.points.len(), self.prepared.rows.count(), &self.work);
        let slid_by = |i: usize| work.tangential[i].hypot(work.tangential[n + i]);
        let too_far = |i: &usize| work.closed[*i] && slid_by(*i) > SLIDING_MAX * self.prepared.points[*i].face_size;
        (0..points).filter(too_far).map(|i| i as u32).collect()
    }

    /// Latches, sticking and slip of the solution in the work space.
    pub(crate) fn keep_statuses(&mut self, moment: &Moment<'_>) {
        let prepared = self.prepared.clone();
        let (points, n) = (prepared.points.len(), prepared.rows.count());
        let (state, work) = (&mut self.state, &mut self.work);
        for i in 0..points {
            state.latched[i] |= work.closed[i] && moment.latches(i) && moment.is_active(i);
            // Sticking under rough friction is what the tangential rows say.
            state.stuck[i] = false;
            if moment.penetration_max(i).is_some() {
                state.penetrations[i] = work.penetrations[i];
            }
        }
        for (row, tangential) in work.rows[points..].iter().zip(&prepared.rows.tangential) {
            state.stuck[tangential.point as usize] |= row.wall == Wall::TwoSided;
        }
        for i in 0..points {
            if work.closed[i] && !state.stuck[i] {
                for at in [i, n + i] {
                    state.slip[at] += work.tangential[at] - state.tangential[at];
                }
            }
            // A point that does not stick would begin to where it is.
            if !state.stuck[i] {
                state.origins[i] = work.tangential[i];
                state.origins[points + i] = work.tangential[n + i];
            }
        }
    }

    /// Points whose status differs from the one in the last results.
    pub(crate) fn status_changes(&self) -> Vec<StatusChange> {
        let moment = Self::moment(&self.prepared, self.state.step as usize, self.state.step_time);
        let change = |i: usize| {
            let (from, to) = (self.derived.points[i].status, self.status(&moment, i));
            (from != to).then_some(StatusChange { point: i as u32, from, to })
        };
        (0..self.prepared.points.len()).filter_map(change).collect()
    }
}
