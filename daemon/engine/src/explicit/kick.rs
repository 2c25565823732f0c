//! An increment of central differences on all directions.
//!
//! ```text
//! v(n+½) = v(n−½) + (Δt(n) + Δt(n+1))/2 a(n)        u(n+1) = u(n) + Δt(n+1) v(n+½)        M a = f − K u
//! ```
//!
//! Directions that stand alone are one pass over the nodal vectors; prescribed ones follow their columns, groups and what depends on
//! them come after.

use super::inertia::{Inertia, Known};
use super::slots::Slots;

/// Times of an increment.
#[derive(Clone, Copy, Debug)]
pub struct Kick {
    /// Mean of this increment and the one before \[time\].
    pub mean: f64,
    /// This increment \[time\].
    pub size: f64,
}

impl Kick {
    /// `τ`: displacement per acceleration [time²].
    pub fn tau(&self) -> f64 {
        self.mean * self.size
    }
}

/// Nodal vectors of a motion.
pub struct Vectors<'a> {
    /// Displacements.
    pub u: &'a mut [[f64; 3]],
    /// Velocities of the middle of the increment before, then of this one.
    pub v: &'a mut [[f64; 3]],
    /// `K u`, then accelerations.
    pub a: &'a mut [[f64; 3]],
    /// Reactions.
    pub r: &'a mut [[f64; 3]],
}

/// Sums over an increment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sums {
    /// `½ v(n−½) M v(n+½)` \[energy\].
    pub kinetic: f64,
    /// Power of the given forces at the velocities before, and after [energy/time].
    pub before: f64,
    /// See `before`.
    pub after: f64,
    /// Largest momentum of a direction [mass·length/time].
    pub momentum: f64,
}

/// Work space.
pub struct KickWork {
    /// Velocities before of the nodes that do not stand alone.
    before: Vec<[f64; 3]>,
    group: Vec<f64>,
}

impl KickWork {
    /// For some inertia.
    pub fn new(inertia: &Inertia) -> Self {
        let largest = inertia.groups.iter().map(|g| g.at.len()).max().unwrap_or(0);
        Self { before: vec![[0.0; 3]; inertia.others.len()], group: vec![0.0; largest] }
    }
}

/// Value that a prescribed direction has under coefficients of the columns; none where it stays.
fn target(known: Known, coefficients: &[f64]) -> Option<f64> {
    known.column.map(|(column, factor)| factor * coefficients[column as usize])
}

/// Moves everything; `forces` act besides `K u`, `coefficients` are those at the end of the increment.
pub fn kick(
    inertia: &Inertia,
    kick: Kick,
    forces: &[[f64; 3]],
    coefficients: &[f64],
    vectors: &mut Vectors<'_>,
    work: &mut KickWork,
) -> Sums {
    let mut sums = pass(inertia, kick, forces, vectors);
    let Vectors { u, v, a, r } = vectors;
    for (&node, before) in inertia.others.iter().zip(&mut work.before) {
        let node = node as usize;
        *before = v[node];
        for d in 0..3 {
            a[node][d] = forces[node][d] - a[node][d];
            sums.before += forces[node][d] * v[node][d];
        }
    }
    let (u, v, a, r) = (u.as_flattened_mut(), v.as_flattened_mut(), a.as_flattened_mut(), r.as_flattened_mut());
    for dependent in &inertia.dependents {
        let force = std::mem::take(&mut a[dependent.at as usize]);
        dependent.terms.iter().for_each(|&(to, factor)| a[to as usize] += factor * force);
    }
    let follow = |known: Known, u: &[f64], v: &mut [f64]| {
        let at = known.at as usize;
        let next = target(known, coefficients).map_or(0.0, |target| (target - u[at]) / kick.size);
        let acceleration = (next - v[at]) / kick.mean;
        v[at] = next;
        acceleration
    };
    for &node in &inertia.others {
        let node = node as usize;
        for d in (0..3).filter(|d| inertia.alone[node] & (1 << d) != 0) {
            let at = 3 * node + d;
            a[at] *= inertia.inverse[node];
            v[at] += kick.mean * a[at];
            u[at] += kick.size * v[at];
        }
    }
    for &known in &inertia.supports {
        let at = known.at as usize;
        let acceleration = follow(known, u, v);
        r[at] = inertia.masses[at / 3] * acceleration - a[at];
        a[at] = acceleration;
        u[at] = target(known, coefficients).unwrap_or(u[at]);
    }
    for group in &inertia.groups {
        let (free, order) = (group.free, group.at.len());
        let x = &mut work.group[..order];
        for (x, &at) in x.iter_mut().zip(&group.at) {
            *x = a[at as usize];
        }
        for (k, &known) in (free..).zip(&group.known) {
            let acceleration = follow(known, u, v);
            // What is pushed before it is known what it takes.
            r[known.at as usize] = -x[k];
            a[known.at as usize] = acceleration;
            u[known.at as usize] = target(known, coefficients).unwrap_or(u[known.at as usize]);
            (0..free).for_each(|i| x[i] -= group.entry(i, k) * acceleration);
        }
        group.accelerate(&mut x[..free]);
        for (x, &at) in x[..free].iter().zip(&group.at) {
            let at = at as usize;
            a[at] = *x;
            v[at] += kick.mean * x;
            u[at] += kick.size * v[at];
        }
        for (k, known) in (free..).zip(&group.known) {
            let inertial: f64 = (0..order).map(|j| group.entry(k, j) * a[group.at[j] as usize]).sum();
            r[known.at as usize] += inertial;
        }
    }
    extend(inertia, u, v, a);
    for ((&node, before), block) in inertia.others.iter().zip(&work.before).zip(&inertia.blocks) {
        let at = 3 * node as usize;
        for d in 0..3 {
            let momentum: f64 = (0..3).map(|e| block[3 * d + e] * v[at + e]).sum();
            sums.kinetic += 0.5 * before[d] * momentum;
            sums.momentum = sums.momentum.max(momentum.abs());
            sums.after += forces[node as usize][d] * v[at + d];
        }
    }
    sums
}

/// Nodes all of whose directions stand alone.
fn pass(inertia: &Inertia, kick: Kick, forces: &[[f64; 3]], vectors: &mut Vectors<'_>) -> Sums {
    let (mut kinetic, mut before, mut after, mut largest) = (0.0, 0.0, 0.0, 0.0f64);
    let nodes = vectors.u.iter_mut().zip(vectors.v.iter_mut()).zip(vectors.a.iter_mut());
    let known = inertia.masses.iter().zip(&inertia.inverse).zip(&inertia.alone);
    for (((u, v), a), (f, ((mass, inverse), alone))) in nodes.zip(forces.iter().zip(known)) {
        if *alone != 7 {
            continue;
        }
        let (mut momentum, mut fastest) = (0.0, 0.0f64);
        for d in 0..3 {
            let acceleration = (f[d] - a[d]) * inverse;
            let next = v[d] + kick.mean * acceleration;
            momentum += v[d] * next;
            before += f[d] * v[d];
            after += f[d] * next;
            fastest = fastest.max(next.abs());
            a[d] = acceleration;
            v[d] = next;
            u[d] += kick.size * next;
        }
        kinetic += mass * momentum;
        largest = largest.max(mass * fastest);
    }
    Sums { kinetic: 0.5 * kinetic, before, after, momentum: largest }
}

/// Gives dependent directions what those that they depend on have.
fn extend(inertia: &Inertia, u: &mut [f64], v: &mut [f64], a: &mut [f64]) {
    for dependent in &inertia.dependents {
        let mut sums = [0.0; 3];
        for &(from, factor) in &dependent.terms {
            sums[0] += factor * u[from as usize];
            sums[1] += factor * v[from as usize];
            sums[2] += factor * a[from as usize];
        }
        let at = dependent.at as usize;
        (u[at], v[at], a[at]) = (sums[0], sums[1], sums[2]);
    }
}

/// What a correction by contact does to the energies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Corrected {
    /// Change of the kinetic energy \[energy\].
    pub kinetic: f64,
    /// Power of the contact forces at the velocities before, and after [energy/time].
    pub before: f64,
    /// See `before`.
    pub after: f64,
    /// Change of the power of the other forces after, per force: found by the caller from the change of velocities.
    pub forces: f64,
}

/// Adds corrections of slots to what [`kick`] has found; `forces` as there.
pub fn amend(
    inertia: &Inertia,
    slots: &Slots,
    kick: Kick,
    acceleration: &[f64],
    thrust: &[f64],
    forces: &[[f64; 3]],
    vectors: &mut Vectors<'_>,
) -> Corrected {
    let mut out = Corrected::default();
    let Vectors { u, v, a, r } = vectors;
    let (u, v, a, r) = (u.as_flattened_mut(), v.as_flattened_mut(), a.as_flattened_mut(), r.as_flattened_mut());
    let forces = forces.as_flattened();
    let mut grouped = false;
    for (slot, &at) in slots.at.iter().enumerate() {
        let at = at as usize;
        let before = v[at] - kick.mean * a[at];
        out.before += thrust[slot] * before;
        if slots.prescribed[slot] {
            r[at] -= thrust[slot];
        } else {
            out.kinetic += 0.5 * kick.mean * thrust[slot] * before;
            let change = acceleration[slot];
            a[at] += change;
            v[at] += kick.mean * change;
            u[at] += kick.tau() * change;
            out.forces += forces[at] * kick.mean * change;
        }
        out.after += thrust[slot] * v[at];
    }
    for unit in &slots.units {
        let Some(index) = unit.group else { continue };
        grouped = true;
        let group = &inertia.groups[index as usize];
        let changes = &acceleration[unit.first as usize..(unit.first + unit.count) as usize];
        for (k, known) in (group.free..).zip(&group.known) {
            let inertial: f64 = (0..group.free).map(|j| group.entry(k, j) * changes[j]).sum();
            let at = known.at as usize;
            r[at] += inertial;
            out.kinetic += 0.5 * kick.mean * inertial * (v[at] - kick.mean * a[at]);
        }
    }
    if grouped {
        for dependent in &inertia.dependents {
            let at = dependent.at as usize;
            out.forces -= forces[at] * v[at];
        }
        extend(inertia, u, v, a);
        for dependent in &inertia.dependents {
            let at = dependent.at as usize;
            out.forces += forces[at] * v[at];
        }
    }
    out
}

/// Power of the reactions at the velocities before and after [energy/time].
pub fn reaction_power(inertia: &Inertia, kick: Kick, v: &[[f64; 3]], a: &[[f64; 3]], r: &[[f64; 3]]) -> [f64; 2] {
    let (v, a, r) = (v.as_flattened(), a.as_flattened(), r.as_flattened());
    let mut sums = [0.0; 2];
    let known = inertia.supports.iter().chain(inertia.groups.iter().flat_map(|g| &g.known));
    for at in known.map(|k| k.at as usize) {
        sums[0] += r[at] * (v[at] - kick.mean * a[at]);
        sums[1] += r[at] * v[at];
    }
    sums
}
