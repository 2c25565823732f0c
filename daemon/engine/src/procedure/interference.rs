//! `*CONTACT INTERFERENCE`: overclosure that contact allows for a while.
//!
//! The overclosure that every law sees is `h − v(t)`. Without an amplitude `v` falls linearly from its value at the start of
//! the step to zero at its end; with one it is the value times the amplitude. Later steps keep the last value.

use crate::model::{AllowedOverclosure, AmplitudeClock, Interference, Model};
use crate::procedure::rows::RowPlan;

/// Factor on an allowed overclosure in a step, at a time of that step that began at a total time.
fn factor(model: &Model, interference: Interference, step: usize, step_start: f64, time: f64) -> f64 {
    let stated = interference.step as usize;
    let period = model.steps[stated].procedure.period();
    let time_stated = if step == stated { time.min(period) } else { period };
    let Some(amplitude) = interference.amplitude else {
        return 1.0 - time_stated / period;
    };
    let amplitude = &model.amplitudes[amplitude.index()];
    amplitude.evaluate(match amplitude.clock {
        AmplitudeClock::Step => time_stated,
        AmplitudeClock::Total => step_start + time,
    })
}

/// Takes what is allowed from the overclosures of the contact points; `initial` are those of the geometry.
pub fn allow(
    model: &Model,
    plan: &RowPlan,
    initial: &[f64],
    step: usize,
    step_start: f64,
    time: f64,
    overclosures: &mut [f64],
) {
    let contact = &model.steps[step].contact;
    if contact.interferences.iter().all(Option::is_none) {
        return;
    }
    for (i, &pair) in plan.pairs.iter().enumerate() {
        if let Some(interference) = contact.interference_of(pair as usize) {
            let allowed = match interference.allowed {
                AllowedOverclosure::Uniform(length) => length,
                AllowedOverclosure::Initial => initial[i].max(0.0),
            };
            overclosures[i] -= allowed * factor(model, interference, step, step_start, time);
        }
    }
}
