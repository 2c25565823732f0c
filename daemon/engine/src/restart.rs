//! Where an analysis stands: what is worth knowing about a checkpoint to go on from.

use serde::Serialize;

use crate::simulation::Simulation;

/// The last completed increment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Standing {
    /// Step number, from 1.
    pub step: u32,
    /// Increment number within the step, from 1; 0 before the first.
    pub increment: u32,
    /// Total time.
    pub time: f64,
}

impl Simulation {
    /// The last completed increment.
    pub fn standing(&self) -> Standing {
        let steps = &self.state.counts;
        Standing {
            step: steps.len() as u32,
            increment: steps.last().map_or(0, |counts| counts.increments),
            time: self.time(),
        }
    }

    /// Magnitude that replaces the deck's at an input, if [`Self::set_magnitude`] gave one, here or before the checkpoint that
    /// was restored.
    pub fn magnitude(&self, input: usize) -> Option<f64> {
        self.state.magnitudes.get(input).copied().flatten()
    }
}
