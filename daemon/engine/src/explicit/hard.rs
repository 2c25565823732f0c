//! The corrector of hard kinematic contact, as the manual has it.
//!
//! With `τ = Δt (Δt_before + Δt) / 2`, the depth `d_i` that the prediction leaves at a secondary node of mass `m_i`, the row `g_ij` of
//! its constraint on the directions of a primary unit `j` (a node with its shape function `N_ij`, or a rigid body) and its share `N_ij`:
//!
//! ```text
//! F_i  = m_i d_i / τ                                               resisting force
//! (M_j + Σ_i m_i g_ij g_ijᵀ / N_ij) a_j = −Σ_i F_i g_ij            primary correction
//! f_i  = F_i + m_i Σ_j g_ij · a_j                                  contact force, m_i times the correction of the secondary node
//! ```
//!
//! For a node whose points look in one direction `n` this is `a_j = −Σ N_ij F_i n / (m_j + Σ N_ij m_i)`. Every depth becomes zero and
//! momentum is kept. Prescribed directions have infinite mass. Points whose force would pull are left out and the rest is solved
//! again, unless they may not separate. Source: Abaqus manual v6.5, 21.4.4, "The kinematic contact algorithm".

use super::dense::{cholesky_or_held, solve_held};
use super::inertia::Inertia;
use super::slots::{Slots, Unit};

/// A row that takes part.
#[derive(Clone, Copy, Debug)]
pub struct Active {
    /// The row.
    pub row: u32,
    /// Contact point whose row, or tangential row, it is.
    pub point: u32,
    /// What it must move back [length].
    pub depth: f64,
    /// Whether it may pull.
    pub two_sided: bool,
}

/// Accelerations and forces that contact adds.
#[derive(Clone, Default)]
pub struct Correction {
    /// Of each slot [length/time²].
    pub acceleration: Vec<f64>,
    /// On each slot \[force\].
    pub thrust: Vec<f64>,
    /// Of each row \[force\].
    pub forces: Vec<f64>,
    /// Their viscous parts.
    pub viscous: Vec<f64>,
}

impl Correction {
    /// Nothing yet.
    pub fn new(slots: usize, rows: usize) -> Self {
        let zeros = |n: usize| vec![0.0; n];
        Self { acceleration: zeros(slots), thrust: zeros(slots), forces: zeros(rows), viscous: zeros(rows) }
    }

    /// Nothing again.
    pub fn clear(&mut self) {
        for values in [&mut self.acceleration, &mut self.thrust, &mut self.forces, &mut self.viscous] {
            values.fill(0.0);
        }
    }

    /// Adds a share of another one.
    pub fn add(&mut self, share: f64, other: &Self) {
        let add = |to: &mut [f64], from: &[f64]| to.iter_mut().zip(from).for_each(|(t, f)| *t += share * f);
        add(&mut self.acceleration, &other.acceleration);
        add(&mut self.thrust, &other.thrust);
        add(&mut self.forces, &other.forces);
        add(&mut self.viscous, &other.viscous);
    }
}

/// Work space of the corrector.
pub struct HardWork {
    /// Where the matrix of each unit begins.
    offsets: Vec<usize>,
    matrices: Vec<f64>,
    /// Right-hand sides, then accelerations, by slot.
    values: Vec<f64>,
    /// Units of the present rows.
    touched: Vec<u32>,
    is_touched: Vec<bool>,
    /// Force of each active row.
    forces: Vec<f64>,
    /// A number for each slot.
    pub scratch: Vec<f64>,
}

impl HardWork {
    /// For some slots.
    pub fn new(slots: &Slots) -> Self {
        let mut offsets = Vec::with_capacity(slots.units.len());
        let mut total = 0;
        let mut used = vec![false; slots.units.len()];
        slots.rows.iter().filter(|r| r.simple).flat_map(|r| &r.parts).for_each(|p| used[p.unit as usize] = true);
        for (unit, used) in slots.units.iter().zip(&used) {
            offsets.push(total);
            total += if *used { (unit.count * unit.count) as usize } else { 0 };
        }
        Self {
            offsets,
            matrices: vec![0.0; total],
            values: vec![0.0; slots.at.len()],
            touched: Vec::with_capacity(slots.units.len()),
            is_touched: vec![false; slots.units.len()],
            forces: Vec::with_capacity(slots.rows.len()),
            scratch: vec![0.0; slots.at.len()],
        }
    }
}

/// Corrects all active rows at once; those that end up pulling are taken out of the list. The corrections are added to `out`.
pub fn correct(
    slots: &Slots,
    inertia: &Inertia,
    active: &mut Vec<Active>,
    tau: f64,
    work: &mut HardWork,
    out: &mut Correction,
) {
    // Each pass takes out at least one point; the last one may have none left.
    loop {
        solve(slots, inertia, active, tau, work);
        let HardWork { forces, .. } = work;
        let mut pulls = false;
        for (a, force) in active.iter_mut().zip(&*forces) {
            if !a.two_sided && *force < 0.0 {
                a.depth = f64::NAN;
                pulls = true;
            }
        }
        if !pulls {
            break;
        }
        drop_marked(active);
    }
    for (a, &force) in active.iter().zip(&work.forces) {
        let row = &slots.rows[a.row as usize];
        let (from, to) = row.own.expect("simple rows have a secondary node of their own");
        for &(slot, b) in &row.entries[from as usize..to as usize] {
            out.acceleration[slot as usize] -= b * slots.inverse[slot as usize] * force;
            out.thrust[slot as usize] -= b * force;
        }
        for part in &row.parts {
            let entries = &row.entries[part.entries.0 as usize..part.entries.1 as usize];
            let along: f64 = entries.iter().map(|&(slot, g)| g * work.values[slot as usize]).sum();
            let share = row.own_mass * (a.depth / tau + along / part.share);
            entries.iter().for_each(|&(slot, g)| out.thrust[slot as usize] -= g * share);
        }
        out.forces[a.row as usize] += force;
    }
    for &unit in &work.touched {
        let Unit { first, count, .. } = slots.units[unit as usize];
        for slot in first as usize..(first + count) as usize {
            out.acceleration[slot] += work.values[slot];
        }
    }
}

/// Takes out the marked normal rows, and with each the tangential rows of its point.
fn drop_marked(active: &mut Vec<Active>) {
    // Rows of a point stand together, the normal one first.
    let mut gone = None;
    active.retain(|a| {
        if a.depth.is_nan() {
            gone = Some(a.point);
        }
        gone != Some(a.point)
    });
}

fn solve(slots: &Slots, inertia: &Inertia, active: &[Active], tau: f64, work: &mut HardWork) {
    work.touched.drain(..).for_each(|unit| work.is_touched[unit as usize] = false);
    for a in active {
        let row = &slots.rows[a.row as usize];
        let mass = row.own_mass;
        for part in &row.parts {
            let unit = slots.units[part.unit as usize];
            let (n, first) = (unit.count as usize, unit.first as usize);
            let matrix = &mut work.matrices[work.offsets[part.unit as usize]..][..n * n];
            if !work.is_touched[part.unit as usize] {
                work.is_touched[part.unit as usize] = true;
                work.touched.push(part.unit);
                own_inertia(slots, inertia, unit, matrix);
                work.values[first..first + n].fill(0.0);
            }
            let entries = &row.entries[part.entries.0 as usize..part.entries.1 as usize];
            for &(slot, g) in entries {
                work.values[slot as usize] -= mass * (a.depth / tau) * g;
                for &(other, h) in entries {
                    matrix[(slot as usize - first) * n + other as usize - first] += mass / part.share * g * h;
                }
            }
        }
    }
    for &index in &work.touched {
        let unit = slots.units[index as usize];
        let (n, first) = (unit.count as usize, unit.first as usize);
        let matrix = &mut work.matrices[work.offsets[index as usize]..][..n * n];
        let values = &mut work.values[first..first + n];
        for k in (0..n).filter(|&k| slots.prescribed[first + k]) {
            for j in 0..n {
                matrix[k * n + j] = 0.0;
                matrix[j * n + k] = 0.0;
            }
            values[k] = 0.0;
        }
        cholesky_or_held(matrix, n);
        solve_held(matrix, n, values);
    }
    work.forces.clear();
    for a in active {
        let row = &slots.rows[a.row as usize];
        let mut moved = 0.0;
        for part in &row.parts {
            let entries = &row.entries[part.entries.0 as usize..part.entries.1 as usize];
            moved += entries.iter().map(|&(slot, g)| g * work.values[slot as usize]).sum::<f64>();
        }
        work.forces.push(row.own_mass * (a.depth / tau + moved));
    }
}

/// Inertia matrix of a unit.
fn own_inertia(slots: &Slots, inertia: &Inertia, unit: Unit, matrix: &mut [f64]) {
    let (n, first) = (unit.count as usize, unit.first as usize);
    matrix.fill(0.0);
    match unit.group {
        None => {
            for k in 0..n {
                matrix[k * n + k] = inertia.masses[slots.at[first + k] as usize / 3];
            }
        }
        Some(g) => {
            let group = &inertia.groups[g as usize];
            for (i, j) in (0..n * n).map(|k| (k / n, k % n)) {
                matrix[i * n + j] = group.entry(i, j);
            }
        }
    }
}
