//! Inertia of the independent directions: what an acceleration costs once equations and rigid bodies are obeyed.
//!
//! `u = T q`, so independent directions have the inertia `Tᵀ M T` with the lumped mass `M`. Most directions stand alone, with the
//! mass of their node. Directions that others depend on, and rotations, form groups: those of one group are coupled by masses that
//! move with several of them (a rigid body: six directions, whose matrix holds mass, first moments and inertia about the reference
//! node). Prescribed directions belong to groups too; their accelerations are known, and what it takes to move them is their reaction.

use rustc_hash::FxHashMap;

use super::dense::{cholesky_or_held, solve_held};
use crate::model::{Model, NodeId};
use crate::solve::columns::Column;
use crate::solve::constraints::Constraints;
use crate::solve::numbering::Unions;

/// Most directions that masses may couple: their matrix is dense.
const GROUP_MAX: usize = 4000;

/// What a prescribed direction follows: a column with a factor, or none where it stays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// Flat position of the direction.
    pub at: u32,
    /// Column and factor.
    pub column: Option<(u32, f64)>,
}

/// Directions that masses couple.
pub struct Group {
    /// Their flat positions: free ones first, then prescribed ones.
    pub at: Vec<u32>,
    /// How many are free.
    pub free: usize,
    /// What the prescribed ones follow.
    pub known: Vec<Known>,
    /// `Tᵀ M T`, symmetric, row by row.
    mass: Vec<f64>,
    /// Factor of its free part; directions without inertia are held.
    factor: Vec<f64>,
}

/// A direction that follows others: `u = Σ c q`.
#[derive(Clone, Debug)]
pub struct Dependent {
    /// Its flat position.
    pub at: u32,
    /// Flat positions of independent directions, with factors.
    pub terms: Vec<(u32, f64)>,
}

/// Inertia of every direction of every node.
pub struct Inertia {
    /// Mass of each node \[mass\]; 0 for nodes that carry rotations.
    pub masses: Vec<f64>,
    /// One over it; 0 where there is none.
    pub inverse: Vec<f64>,
    /// Bit d of a node: direction d is free and stands alone.
    pub alone: Vec<u8>,
    /// Nodes with other directions, ascending.
    pub others: Vec<u32>,
    /// Inertia blocks of the `others`, row by row; of nodes that carry rotations [mass·length²].
    pub blocks: Vec<[f64; 9]>,
    /// Coupled directions.
    pub groups: Vec<Group>,
    /// Directions that follow others, ascending.
    pub dependents: Vec<Dependent>,
    /// Group and place in it of each direction of one.
    pub member: FxHashMap<u32, (u32, u32)>,
    /// Prescribed directions that stand alone, ascending.
    pub supports: Vec<Known>,
}

/// Independent directions of a direction, with factors.
pub fn terms_of(dependents: &[Dependent], at: u32) -> Vec<(u32, f64)> {
    match dependents.binary_search_by_key(&at, |d| d.at) {
        Ok(found) => dependents[found].terms.clone(),
        Err(_) => vec![(at, 1.0)],
    }
}

impl Inertia {
    /// From the diagonal blocks of the lumped mass matrix, one per node, row by row, and the columns that move prescribed
    /// directions. The error is a number of coupled directions that is too large.
    pub fn new(
        model: &Model,
        constraints: &Constraints,
        columns: &[Column],
        blocks: &[[f64; 9]],
    ) -> Result<Self, usize> {
        let count = model.mesh.nodes.len();
        let analyst = model.mesh.node_count();
        let flat = crate::nodal::flat;
        let dependents: Vec<Dependent> = (constraints.dependents().into_iter())
            .map(|((node, direction), terms)| Dependent {
                at: flat(node, usize::from(direction)) as u32,
                terms: terms.iter().map(|&(n, d, factor)| (flat(n, usize::from(d)) as u32, factor)).collect(),
            })
            .collect();
        let is_dependent = |at: u32| dependents.binary_search_by_key(&at, |d| d.at).is_ok();
        let is_prescribed = |at: u32| constraints.is_prescribed(NodeId(at / 3), at as usize % 3);
        let mut courses: FxHashMap<u32, (u32, f64)> = FxHashMap::default();
        for (column, index) in columns.iter().zip(0u32..) {
            for &(node, d, factor) in column.entries().iter().filter(|_| column.is_displacement()) {
                courses.insert(flat(node, usize::from(d)) as u32, (index, factor));
            }
        }
        let known = |at: u32| Known { at, column: courses.get(&at).copied() };
        let rotations = (3 * analyst as u32..3 * count as u32).filter(|&at| !is_dependent(at));
        let mut members: Vec<u32> =
            dependents.iter().flat_map(|d| d.terms.iter().map(|t| t.0)).chain(rotations).collect();
        members.sort_unstable();
        members.dedup();
        let (mut groups, group_of) = groups(&members, &dependents, blocks);
        if let Some(large) = groups.iter().map(|g| g.at.len()).find(|&n| n > GROUP_MAX) {
            return Err(large);
        }
        let mut member = FxHashMap::default();
        for (group, index) in groups.iter_mut().zip(0u32..) {
            // Stable: each half stays ascending.
            group.at.sort_by_key(|&at| is_prescribed(at));
            group.free = group.at.iter().filter(|&&at| !is_prescribed(at)).count();
            group.known = group.at[group.free..].iter().map(|&at| known(at)).collect();
            group.mass = vec![0.0; group.at.len() * group.at.len()];
            member.extend(group.at.iter().zip(0u32..).map(|(&at, k)| (at, (index, k))));
        }
        for node in nodes_of(&members, &dependents) {
            products(node, &members, &dependents, blocks, &mut |i, j, value| {
                let (row, column) = (member[&members[i]].1 as usize, member[&members[j]].1 as usize);
                let group = &mut groups[group_of[i] as usize];
                group.mass[row * group.at.len() + column] += value;
            });
        }
        groups.iter_mut().for_each(Group::factorise);
        let mut alone = vec![0u8; count];
        let (mut others, mut supports) = (Vec::new(), Vec::new());
        for node in 0..count {
            for d in 0..3 {
                let at = 3 * node as u32 + d as u32;
                if is_dependent(at) || member.contains_key(&at) {
                    continue;
                }
                if is_prescribed(at) {
                    supports.push(known(at));
                } else {
                    alone[node] |= 1 << d;
                }
            }
            if alone[node] != 7 {
                others.push(node as u32);
            }
        }
        let masses: Vec<f64> = (0..count).map(|i| if i < analyst { blocks[i][0] } else { 0.0 }).collect();
        let inverse = masses.iter().map(|&m| if m > 0.0 { 1.0 / m } else { 0.0 }).collect();
        let blocks = others.iter().map(|&node| blocks[node as usize]).collect();
        Ok(Self { masses, inverse, alone, others, blocks, groups, dependents, member, supports })
    }

    /// Whether an independent direction that is not prescribed moves when it is pushed.
    pub fn has_inertia(&self, at: u32) -> bool {
        match self.member.get(&at) {
            Some(&(group, place)) => self.groups[group as usize].has_inertia(place as usize),
            None => self.masses[at as usize / 3] > 0.0,
        }
    }

    /// `b M⁻¹ b` [1/mass] of a row over independent directions, which is sorted and merged.
    pub fn mobility(&self, row: &mut Vec<(u32, f64)>) -> f64 {
        row.sort_by_key(|e| e.0);
        row.dedup_by(|from, to| {
            let same = from.0 == to.0;
            if same {
                to.1 += from.1;
            }
            same
        });
        let mut sum = 0.0;
        let mut groups: Vec<u32> = Vec::new();
        for &(at, b) in &*row {
            match self.member.get(&at) {
                Some(&(group, _)) => groups.push(group),
                None if self.alone[at as usize / 3] & (1 << (at % 3)) == 0 => {}
                // Without mass it moves at once.
                None if self.masses[at as usize / 3] == 0.0 => sum = f64::INFINITY,
                None => sum += b * b * self.inverse[at as usize / 3],
            }
        }
        groups.sort_unstable();
        groups.dedup();
        for group in groups.iter().map(|&g| &self.groups[g as usize]) {
            let here = |at: &u32| row.binary_search_by_key(at, |e| e.0).map_or(0.0, |k| row[k].1);
            let b: Vec<f64> = group.at[..group.free].iter().map(here).collect();
            let mut x = b.clone();
            group.accelerate(&mut x);
            sum += b.iter().zip(&x).map(|(b, x)| b * x).sum::<f64>();
        }
        sum
    }

    /// Power `v M a` of inertia at the start of an increment of a size, given the velocities of its middle [energy/time].
    pub fn power(&self, v: &[[f64; 3]], a: &[[f64; 3]], size: f64) -> f64 {
        let at = |v: &[f64; 3], a: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|d| v[d] - 0.5 * size * a[d]) };
        let mut sum = 0.0;
        for (((v, a), mass), alone) in v.iter().zip(a).zip(&self.masses).zip(&self.alone) {
            if *alone == 7 {
                let v = at(v, a);
                sum += mass * (v[0] * a[0] + v[1] * a[1] + v[2] * a[2]);
            }
        }
        for (&node, block) in self.others.iter().zip(&self.blocks) {
            let (v, a) = (at(&v[node as usize], &a[node as usize]), &a[node as usize]);
            sum += (0..9).map(|k| block[k] * v[k / 3] * a[k % 3]).sum::<f64>();
        }
        sum
    }

    /// Numbers of eight bytes that it holds.
    pub fn numbers(&self) -> usize {
        let groups: usize = self.groups.iter().map(|g| g.mass.len() + g.factor.len() + g.at.len()).sum();
        let dependents: usize = self.dependents.iter().map(|d| 4 + 2 * d.terms.len()).sum();
        2 * self.masses.len() + self.alone.len() / 8 + 10 * self.others.len() + groups + dependents
    }
}

/// Nodes whose masses move with members of groups.
fn nodes_of(members: &[u32], dependents: &[Dependent]) -> Vec<usize> {
    let mut nodes: Vec<usize> =
        members.iter().copied().chain(dependents.iter().map(|d| d.at)).map(|at| at as usize / 3).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// What the mass of a node adds to the inertia of members: calls `add(row, column, value)` with their positions.
fn products(
    node: usize,
    members: &[u32],
    dependents: &[Dependent],
    blocks: &[[f64; 9]],
    add: &mut dyn FnMut(usize, usize, f64),
) {
    let terms: [Vec<(u32, f64)>; 3] = std::array::from_fn(|d| terms_of(dependents, 3 * node as u32 + d as u32));
    for (d, e) in (0..9).map(|k| (k / 3, k % 3)) {
        let mass = blocks[node][3 * d + e];
        if mass == 0.0 {
            continue;
        }
        for &(row, p) in &terms[d] {
            let Ok(i) = members.binary_search(&row) else { continue };
            for &(column, q) in &terms[e] {
                if let Ok(j) = members.binary_search(&column) {
                    add(i, j, p * q * mass);
                }
            }
        }
    }
}

/// Members that masses couple, without their matrices; and the group of each member.
fn groups(members: &[u32], dependents: &[Dependent], blocks: &[[f64; 9]]) -> (Vec<Group>, Vec<u32>) {
    let mut unions = Unions::new(members.len());
    for node in nodes_of(members, dependents) {
        products(node, members, dependents, blocks, &mut |i, j, _| unions.join(i as u32, j as u32));
    }
    let mut of_root: FxHashMap<u32, u32> = FxHashMap::default();
    let mut groups: Vec<Group> = Vec::new();
    let mut group_of = Vec::with_capacity(members.len());
    for (&at, i) in members.iter().zip(0u32..) {
        let group = *of_root.entry(unions.root(i)).or_insert_with(|| {
            groups.push(Group { at: Vec::new(), free: 0, known: Vec::new(), mass: Vec::new(), factor: Vec::new() });
            groups.len() as u32 - 1
        });
        group_of.push(group);
        groups[group as usize].at.push(at);
    }
    (groups, group_of)
}

impl Group {
    fn factorise(&mut self) {
        let n = self.free;
        self.factor = (0..n * n).map(|k| self.entry(k / n, k % n)).collect();
        cholesky_or_held(&mut self.factor, n);
    }

    /// Whether a direction, by its place, moves when it is pushed.
    pub fn has_inertia(&self, place: usize) -> bool {
        place >= self.free || self.factor[place * self.free + place].is_finite()
    }

    /// Accelerations of the free directions in place of forces.
    pub fn accelerate(&self, x: &mut [f64]) {
        solve_held(&self.factor, self.free, x);
    }

    /// `M_ij`.
    pub fn entry(&self, i: usize, j: usize) -> f64 {
        self.mass[i * self.at.len() + j]
    }
}
