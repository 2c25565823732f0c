//! Contact rows on independent directions: what a contact force moves, and how much.
//!
//! A row is `∂h/∂q = b`; a contact force `F` pushes with `−b F` and accelerates by `−M⁻¹ b F`. Directions that contact touches are
//! *slots*; the slots of a node, or of a group of coupled directions, stand together as a *unit*.

use rustc_hash::FxHashMap;

use super::inertia::{Inertia, terms_of};
use crate::contact::points::ContactPoint;
use crate::nodal::Nodal;

/// Largest unit that the explicit corrector solves; larger ones are left to the coupled one.
const UNIT_MAX: usize = 12;
/// A share of a primary node below this is rounding.
const SHARE_ROUNDING: f64 = 1e-9;

/// Slots of a node or a group.
#[derive(Clone, Copy, Debug)]
pub struct Unit {
    /// First slot.
    pub first: u32,
    /// Number of slots.
    pub count: u32,
    /// Group; none for a node whose directions stand alone.
    pub group: Option<u32>,
}

/// What a row has of a unit on its primary side.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// The unit.
    pub unit: u32,
    /// Sum of the shape functions of its nodes.
    pub share: f64,
    /// Where its entries begin and end.
    pub entries: (u32, u32),
}

/// One row.
#[derive(Clone, Debug)]
pub struct SlotRow {
    /// Slot and `b`, slots ascending.
    pub entries: Vec<(u32, f64)>,
    /// Slot and `M⁻¹ b`, free slots only.
    pub answers: Vec<(u32, f64)>,
    /// `b M⁻¹ b` [1/mass].
    pub compliance: f64,
    /// Entries of the secondary node, if it stands alone.
    pub own: Option<(u32, u32)>,
    /// Its mass along the row: infinite where it is prescribed.
    pub own_mass: f64,
    /// Primary side.
    pub parts: Vec<Part>,
    /// Whether the corrector of the manual covers it: a secondary node of its own, shares that are not negative, units of
    /// moderate size.
    pub simple: bool,
}

/// All slots and rows.
#[derive(Default)]
pub struct Slots {
    /// Flat position of each slot.
    pub at: Vec<u32>,
    /// 1/m of slots of nodes; 0 where prescribed, without mass, or of a group.
    pub inverse: Vec<f64>,
    /// Whether each slot is prescribed.
    pub prescribed: Vec<bool>,
    /// Unit of each slot.
    pub unit: Vec<u32>,
    /// Units.
    pub units: Vec<Unit>,
    /// Rows, as in [`Nodal`].
    pub rows: Vec<SlotRow>,
}

/// Finds slots as rows need them.
struct Builder<'a> {
    inertia: &'a Inertia,
    slots: Slots,
    /// Unit of each node (even) and group (odd).
    unit_of: FxHashMap<u64, u32>,
}

impl Slots {
    /// Of all contact rows.
    pub fn new(inertia: &Inertia, nodal: &Nodal, row_points: &[ContactPoint]) -> Self {
        let mut builder = Builder { inertia, slots: Self::default(), unit_of: FxHashMap::default() };
        for (i, point) in row_points.iter().enumerate() {
            let row = builder.row(nodal.row(i), point);
            builder.slots.rows.push(row);
        }
        builder.slots
    }

    /// `b x` over slots.
    pub fn along(&self, row: usize, x: &[f64]) -> f64 {
        self.rows[row].entries.iter().map(|&(slot, b)| b * x[slot as usize]).sum()
    }

    /// Numbers of eight bytes that it holds.
    pub fn numbers(&self) -> usize {
        let of_row = |r: &SlotRow| 2 * (r.entries.len() + r.answers.len()) + 3 * r.parts.len() + 16;
        3 * self.at.len() + 2 * self.units.len() + self.rows.iter().map(of_row).sum::<usize>()
    }
}

impl Builder<'_> {
    /// Group of a flat position.
    fn group(&self, at: u32) -> Option<u32> {
        self.inertia.member.get(&at).map(|&(group, _)| group)
    }

    /// Unit that an independent direction belongs to.
    fn unit(&mut self, at: u32) -> u32 {
        let group = self.group(at);
        let key = group.map_or(2 * u64::from(at / 3), |g| 2 * u64::from(g) + 1);
        if let Some(&unit) = self.unit_of.get(&key) {
            return unit;
        }
        let (inertia, slots) = (self.inertia, &mut self.slots);
        let first = slots.at.len() as u32;
        match group {
            Some(g) => {
                let group = &inertia.groups[g as usize];
                slots.at.extend(&group.at);
                slots.inverse.extend(group.at.iter().map(|_| 0.0));
                slots.prescribed.extend((0..group.at.len()).map(|k| k >= group.free));
            }
            None => {
                let node = at / 3;
                for direction in 0..3 {
                    let here = 3 * node + direction;
                    let alone = inertia.alone[node as usize] & (1 << direction) != 0;
                    let supported = inertia.supports.binary_search_by_key(&here, |k| k.at).is_ok();
                    if alone || supported {
                        slots.at.push(here);
                        slots.inverse.push(if alone { inertia.inverse[node as usize] } else { 0.0 });
                        slots.prescribed.push(supported);
                    }
                }
            }
        }
        let count = slots.at.len() as u32 - first;
        let unit = slots.units.len() as u32;
        slots.units.push(Unit { first, count, group });
        slots.unit.resize(slots.at.len(), unit);
        self.unit_of.insert(key, unit);
        unit
    }

    /// Unit that all directions of a node belong to; none if there are several.
    fn unit_of_node(&mut self, node: u32) -> Option<u32> {
        let mut found = None;
        for at in 3 * node..3 * node + 3 {
            for (independent, _) in terms_of(&self.inertia.dependents, at) {
                let unit = self.unit(independent);
                if found.is_some_and(|f| f != unit) {
                    return None;
                }
                found = Some(unit);
            }
        }
        found
    }

    fn row(&mut self, nodal: &[(u32, f64)], point: &ContactPoint) -> SlotRow {
        let mut sums: Vec<(u32, f64)> = Vec::new();
        for &(at, value) in nodal {
            for (independent, factor) in terms_of(&self.inertia.dependents, at) {
                let unit = self.unit(independent);
                let unit = self.slots.units[unit as usize];
                let slots = &self.slots.at[unit.first as usize..(unit.first + unit.count) as usize];
                let place = slots.iter().position(|&s| s == independent).expect("a unit has all its directions");
                let slot = unit.first + place as u32;
                match sums.iter_mut().find(|(s, _)| *s == slot) {
                    Some((_, sum)) => *sum += factor * value,
                    None => sums.push((slot, factor * value)),
                }
            }
        }
        sums.sort_by_key(|&(slot, _)| slot);
        let answers = self.answers(&sums);
        let b = |slot: u32| sums.binary_search_by_key(&slot, |e| e.0).map_or(0.0, |k| sums[k].1);
        let compliance = answers.iter().map(|&(slot, y)| b(slot) * y).sum();
        let own_unit = self.unit_of_node(point.node.0).filter(|&u| self.slots.units[u as usize].group.is_none());
        let range = |unit: u32| {
            let unit = self.slots.units[unit as usize];
            let (low, high) = (unit.first, unit.first + unit.count);
            let find = |slot: u32| sums.partition_point(|e| e.0 < slot) as u32;
            (find(low), find(high))
        };
        let own = own_unit.map(range);
        let own_mass = own.map_or(0.0, |(from, to)| {
            let mobile = |&(slot, b): &(u32, f64)| b * b * self.slots.inverse[slot as usize];
            1.0 / sums[from as usize..to as usize].iter().map(mobile).sum::<f64>()
        });
        let mut shares: Vec<(u32, f64)> = Vec::new();
        let mut simple = own_unit.is_some();
        for (node, &weight) in point.primary.iter().zip(&point.weights).filter(|(_, w)| w.abs() > SHARE_ROUNDING) {
            match self.unit_of_node(node.0) {
                Some(unit) => match shares.iter_mut().find(|s| s.0 == unit) {
                    Some(share) => share.1 += weight,
                    None => shares.push((unit, weight)),
                },
                None => simple = false,
            }
        }
        let units = &self.slots.units;
        simple &= shares.iter().all(|&(unit, share)| {
            share > 0.0 && units[unit as usize].count as usize <= UNIT_MAX && Some(unit) != own_unit
        });
        let range = |unit: u32| {
            let unit = units[unit as usize];
            let find = |slot: u32| sums.partition_point(|e| e.0 < slot) as u32;
            (find(unit.first), find(unit.first + unit.count))
        };
        let parts = shares.iter().map(|&(unit, share)| Part { unit, share, entries: range(unit) }).collect();
        SlotRow { entries: sums, answers, compliance, own, own_mass, parts, simple }
    }

    /// `M⁻¹ b`.
    fn answers(&self, entries: &[(u32, f64)]) -> Vec<(u32, f64)> {
        let mut out = Vec::new();
        for here in entries.chunk_by(|a, b| self.slots.unit[a.0 as usize] == self.slots.unit[b.0 as usize]) {
            let unit = self.slots.units[self.slots.unit[here[0].0 as usize] as usize];
            match unit.group {
                None => {
                    let moved = |&(slot, b): &(u32, f64)| (slot, b * self.slots.inverse[slot as usize]);
                    out.extend(here.iter().map(moved).filter(|(_, y)| *y != 0.0));
                }
                Some(g) => {
                    let group = &self.inertia.groups[g as usize];
                    let mut x = vec![0.0; group.at.len()];
                    here.iter().for_each(|&(slot, b)| x[(slot - unit.first) as usize] = b);
                    group.accelerate(&mut x);
                    out.extend((0..group.free).map(|k| (unit.first + k as u32, x[k])).filter(|(_, y)| *y != 0.0));
                }
            }
        }
        out
    }
}
