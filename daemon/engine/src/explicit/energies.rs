//! Where energy goes in explicit increments.
//!
//! With `½ v(n−½) M v(n+½)` as kinetic energy, the trapezoidal rule on every force but the internal ones makes the sum constant to
//! rounding, as long as increments have one size:
//!
//! ```text
//! W(n+1) − W(n) = ½ (f(n) + f(n+1)) · Δt v(n+½)
//! ```
//!
//! Half of what a force does over an increment is booked when it is known, the other half when the next force is. Loads and reactions
//! make ALLWK, dampers ALLVD. What contact takes beyond its dampers is stored in its laws, `Σ A U(h)`, or lost
//! (IMPACT_LOSS): in the corrector of kinematic contact, and by a little, of either sign, where a penalty closes or opens within an
//! increment.
//!
//! Between increments of two sizes `Δ₋` and `Δ₊` the kinetic energy is `½ M (v₋ v₊ − ½ (Δ₊ − Δ₋) v a)` with the velocity
//! `v = v₊ − ½ Δ₊ a` at `t(n)`: the part of first order in the change of the size is left out.

use serde::{Deserialize, Serialize};

use crate::simulation::Energies;

/// Power of forces at the velocities before and after [energy/time].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Power {
    /// Of loads and reactions.
    pub external: [f64; 2],
    /// That dampers take.
    pub viscous: [f64; 2],
    /// That contact takes without its dampers.
    pub contact: [f64; 2],
}

/// Energies so far, with the first halves of the increment to come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    /// Of loads and reactions.
    pub external: f64,
    /// That dampers have taken.
    pub viscous: f64,
    /// That contact has taken without its dampers.
    pub contact: f64,
    /// Stored in the laws of contact where the count of `contact` begins.
    pub stored_start: f64,
    /// IMPACT_LOSS at the start of the last increment.
    pub lost: f64,
}

/// What is known of an increment at its start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stand {
    /// `½ u K u`.
    pub strain: f64,
    /// Kinetic energy.
    pub kinetic: f64,
    /// `Σ A U(h)`.
    pub stored: f64,
}

impl Ledger {
    /// Lets what is stored count from now on: what is lost stays.
    pub fn count_anew(&mut self, stored: f64, power: &Power, before: f64) {
        let taken = self.contact + 0.5 * before * power.contact[0];
        self.stored_start = self.lost - taken + stored;
    }

    /// Energies at the start of an increment; `before` and `size` are the sizes of the increment before and of this one. What the first
    /// increment meets acts from the middle of one of its size before it, where its velocities belong.
    pub fn book(&mut self, stand: Stand, power: &Power, before: f64, size: f64) -> Energies {
        let book = |sum: &mut f64, power: [f64; 2]| {
            let now = *sum + 0.5 * before * power[0];
            *sum = now + 0.5 * size * power[1];
            now
        };
        let external_work = book(&mut self.external, power.external);
        let viscous = book(&mut self.viscous, power.viscous);
        let taken = book(&mut self.contact, power.contact);
        let impact_loss = taken - (stand.stored - self.stored_start);
        self.lost = impact_loss;
        let total = stand.strain + stand.kinetic + viscous + stand.stored + impact_loss - external_work;
        Energies {
            strain: stand.strain,
            kinetic: stand.kinetic,
            external_work,
            viscous,
            contact: stand.stored,
            impact_loss,
            total,
            ..Energies::default()
        }
    }
}
