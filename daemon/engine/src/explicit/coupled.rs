//! Kinematic contact as one local problem: softened laws, and hard points that the corrector of the manual does not cover.
//!
//! ```text
//! h_i = d_i − τ Σ_j (B M⁻¹ Bᵀ)_ij f_j          f_i = A p(h_i) + c (h_i − h_i,before) / Δt     softened
//!                                              h_i ≤ 0, f_i ≥ 0, h_i f_i = 0                   hard
//! ```
//!
//! The forces act on both sides, so momentum is kept; what is transmitted obeys the law at the corrected place whatever the masses.
//! Against a rigid primary each point is the scalar equation `m (d − h) / τ = A p(h)`. Points are solved in turn until none changes
//! (Gauss-Seidel; the problem is that of a convex function, so it ends).

use super::hard::Correction;
use super::slots::Slots;

/// Turns after which what is left is accepted: each turn removes a part of the rest.
const TURNS_MAX: usize = 2000;
/// Change of a force, relative to the largest, that ends the turns.
const SETTLED: f64 = 1e-14;
/// Change, relative to the largest force, that is accepted when there are no turns left.
const ACCEPTED: f64 = 1e-9;

/// What a row does.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// Pushes as much as it takes to leave no depth.
    Wall,
    /// Pushes or pulls as much.
    TwoSided,
    /// The same while another one of the list, by its position, carries a force: sticking.
    Sticks(usize),
    /// Pushes by a law: position of the point in `curves`.
    Law,
}

/// A row of the local problem.
#[derive(Clone, Copy, Debug)]
pub struct Local {
    /// The row.
    pub row: u32,
    /// Contact point.
    pub point: u32,
    /// Its predicted place [length].
    pub depth: f64,
    /// What it does.
    pub kind: Kind,
    /// Its force, from which turns begin \[force\].
    pub force: f64,
}

/// Force of a law at a place: total, and how much of it is viscous. Increasing where it acts.
pub trait LocalLaw {
    /// At an overclosure of a contact point [length]: force and its viscous part \[force\].
    fn force(&self, point: u32, overclosure: f64) -> (f64, f64);
    /// Overclosure at which force begins; none where it may pull.
    fn onset(&self, point: u32) -> Option<f64>;
}

/// Solves the local problem; corrections are added to `out`. False if the turns were not enough.
pub fn solve(slots: &Slots, list: &mut [Local], tau: f64, law: &dyn LocalLaw, out: &mut Correction) -> bool {
    for local in &*list {
        push(slots, local.row, local.force, &mut out.acceleration);
    }
    let (mut change, mut scale) = (0.0f64, 0.0f64);
    for _ in 0..TURNS_MAX {
        (change, scale) = (0.0, 0.0);
        for k in 0..list.len() {
            let Local { row, point, depth, kind, force } = list[k];
            let compliance = tau * slots.rows[row as usize].compliance;
            let here = depth + tau * along_change(slots, row, out) + compliance * force;
            let next = match kind {
                Kind::Wall => {
                    if compliance > 0.0 {
                        (here / compliance).max(0.0)
                    } else {
                        0.0
                    }
                }
                Kind::TwoSided => {
                    if compliance > 0.0 {
                        here / compliance
                    } else {
                        0.0
                    }
                }
                Kind::Sticks(normal) if list[normal].force != 0.0 && compliance > 0.0 => here / compliance,
                Kind::Sticks(_) => 0.0,
                Kind::Law => root(law, point, here, compliance),
            };
            push(slots, row, next - force, &mut out.acceleration);
            list[k].force = next;
            change = change.max((next - force).abs());
            scale = scale.max(next.abs());
        }
        if change <= SETTLED * scale {
            break;
        }
    }
    for local in &*list {
        for &(slot, b) in &slots.rows[local.row as usize].entries {
            out.thrust[slot as usize] -= b * local.force;
        }
        out.forces[local.row as usize] += local.force;
        if matches!(local.kind, Kind::Law) {
            let compliance = tau * slots.rows[local.row as usize].compliance;
            let free = local.depth + tau * along_change(slots, local.row, out) + compliance * local.force;
            let place = free - compliance * local.force;
            out.viscous[local.row as usize] += law.force(local.point, place).1;
        }
    }
    change <= ACCEPTED * scale
}

/// Relative acceleration that corrections give a row.
fn along_change(slots: &Slots, row: u32, out: &Correction) -> f64 {
    slots.along(row as usize, &out.acceleration)
}

fn push(slots: &Slots, row: u32, force: f64, acceleration: &mut [f64]) {
    if force != 0.0 {
        for &(slot, y) in &slots.rows[row as usize].answers {
            acceleration[slot as usize] -= y * force;
        }
    }
}

/// Force with `free − compliance f = h`, `f = law(h)`: Newton's steps by the secant, held in a bracket.
pub fn root(law: &dyn LocalLaw, point: u32, free: f64, compliance: f64) -> f64 {
    let onset = law.onset(point);
    if onset.is_some_and(|onset| free <= onset) {
        return 0.0;
    }
    let at_free = law.force(point, free).0;
    if compliance == 0.0 || at_free == 0.0 {
        return at_free;
    }
    // residual(f) = law(free − compliance f) − f falls from law(free) at 0 to −f_max where the law ends.
    let residual = |f: f64| law.force(point, free - compliance * f).0 - f;
    let far = match onset {
        Some(onset) => (free - onset) / compliance,
        None => at_free,
    };
    let (mut low, mut high) = if far < 0.0 { (far, 0.0) } else { (0.0, far) };
    let (mut at_low, mut at_high) = (residual(low), residual(high));
    if at_low <= 0.0 || at_high >= 0.0 {
        return if at_low <= 0.0 { low } else { high };
    }
    let (mut side, mut width) = (0i8, high - low);
    for step in 0..200 {
        // The Illinois rule; where four steps have not halved the bracket the next one does, so that it ends whatever the curve.
        let slow = step % 4 == 3 && high - low > 0.5 * width;
        if step % 4 == 3 {
            width = high - low;
        }
        let cut = if slow { 0.5 * (low + high) } else { high - at_high * ((high - low) / (at_high - at_low)) };
        if !(cut > low && cut < high) {
            break;
        }
        let value = residual(cut);
        if value == 0.0 {
            return cut;
        }
        if value > 0.0 {
            (low, at_low) = (cut, value);
            if side == 1 {
                at_high *= 0.5;
            }
            side = 1;
        } else {
            (high, at_high) = (cut, value);
            if side == -1 {
                at_low *= 0.5;
            }
            side = -1;
        }
        if high - low <= f64::EPSILON * high.abs().max(low.abs()) {
            break;
        }
    }
    if at_low.abs() < at_high.abs() { low } else { high }
}
