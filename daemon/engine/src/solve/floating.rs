//! Bodies that only contact holds: their rigid motions at the contact points and under the loads.
//!
//! With motions `α` of the bodies, `u = G (f − Bᵀ F) + R α` and `Rᵀ (f − Bᵀ F) = 0`. At the contact points `D = B R` and
//! `D_t = T R`; `R` vanishes on prescribed directions, so reactions and couplings keep their formulas.

use super::columns::{Column, merge};
use super::constraints::Constraints;
use super::linear::{self, Dense};
use super::motions::Motions;
use super::numbering::Bodies;
use super::parts::Sample;
use crate::contact::points::ContactPoint;
use crate::model::{Model, NodeId};

/// Overclosure per unit of motion (its largest displacement is 1) below which contact does not resist it.
const RESISTED_MIN: f64 = 1e-12;
/// Part of a load, against what its forces would do without cancelling, that is rounding.
pub const LOAD_ROUNDING: f64 = 1e-11;

/// All free motions of a model, body by body.
pub struct Floating {
    /// First motion of each body; one more than there are bodies.
    pub offsets: Vec<usize>,
    /// `D`: contact points x motions. Zero where contact does not resist a motion.
    pub gaps: Dense,
    /// `D_t`: (first tangents, then second) x motions.
    pub slips: Dense,
    /// Whether some contact point resists the motion.
    pub resisted: Vec<bool>,
    /// Combinations of the motions, of one body or several, that no contact point resists: motions x combinations.
    pub loose: Dense,
}

/// What columns do to the motions.
pub struct MotionLoads {
    /// `Rᵀ f` of unit coefficients: motions x columns; zero for displacement columns.
    pub loads: Dense,
    /// The same sums with every term positive: the scale of their rounding.
    pub scales: Dense,
}

impl Floating {
    /// Motions of all bodies. Within each body they are recombined into some that contact resists and some that it never
    /// does.
    pub fn new(
        model: &Model,
        constraints: &Constraints,
        points: &[ContactPoint],
        bodies: &Bodies,
        motions: &mut [Motions],
    ) -> Self {
        let mut resisted = Vec::new();
        let mut offsets = vec![0];
        for (b, body) in motions.iter_mut().enumerate() {
            let mut kinds = vec![true; body.count()];
            if body.count() > 0 {
                let gaps = gaps_of(points, bodies, b, body);
                let (values, vectors) = linear::singular(&gaps);
                let held = values.iter().filter(|v| **v > RESISTED_MIN * values[0].max(1.0)).count();
                if held > 0 && held < values.len() {
                    let groups = [columns(&vectors, 0..held), columns(&vectors, held..values.len())];
                    body.combine(model, constraints, &bodies.nodes[b], &bodies.local, &groups);
                }
                kinds[held..].fill(false);
            }
            offsets.push(offsets[b] + kinds.len());
            resisted.extend(kinds);
        }
        let count = offsets[motions.len()];
        let mut out = Self {
            offsets,
            gaps: Dense::zeros(points.len(), count),
            slips: Dense::zeros(2 * points.len(), count),
            resisted,
            loose: Dense::default(),
        };
        if count > 0 {
            out.fill(points, bodies, motions);
            let (values, vectors) = linear::singular(&out.gaps);
            let held = values.iter().filter(|v| **v > RESISTED_MIN * values[0].max(1.0)).count();
            out.loose = columns(&vectors, held..count);
        }
        out
    }

    /// The loose combinations as forces on the free directions: what they measure of a displacement is how far it goes along
    /// them.
    pub fn loose_columns(&self, constraints: &Constraints, bodies: &Bodies, motions: &[Motions]) -> Vec<Column> {
        let of_combination = |z: usize| {
            let mut entries = Vec::new();
            for (b, of_body) in motions.iter().enumerate() {
                let amounts = &self.loose.column(z)[self.offsets[b]..self.offsets[b + 1]];
                if amounts.iter().all(|a| *a == 0.0) {
                    continue;
                }
                for (i, &node) in bodies.nodes[b].iter().enumerate() {
                    for d in (0..3).filter(|&d| constraints.is_free(node, d)) {
                        let moved: f64 = amounts.iter().enumerate().map(|(m, a)| a * of_body.at(m, i, d)).sum();
                        entries.push((node, d as u8, moved));
                    }
                }
            }
            Column::Force(merge(entries))
        };
        (0..self.loose.columns).map(of_combination).collect()
    }

    /// Number of motions.
    pub fn count(&self) -> usize {
        self.resisted.len()
    }

    fn fill(&mut self, points: &[ContactPoint], bodies: &Bodies, motions: &[Motions]) {
        let n = points.len();
        for (p, point) in points.iter().enumerate() {
            let directions = [point.normal.map(|x| -x), point.tangents[0], point.tangents[1]];
            for (kind, &v) in directions.iter().enumerate() {
                point.row(v, |node, direction, value| {
                    let body = bodies.of_node[node.index()];
                    if body == u32::MAX {
                        return;
                    }
                    let (body, local) = (body as usize, bodies.local[node.index()] as usize);
                    for m in 0..motions[body].count() {
                        let column = self.offsets[body] + m;
                        let moved = value * motions[body].at(m, local, direction);
                        match kind {
                            0 if self.resisted[column] => self.gaps.column_mut(column)[p] += moved,
                            0 => {}
                            t => self.slips.column_mut(column)[(t - 1) * n + p] += moved,
                        }
                    }
                });
            }
        }
    }

    /// `Rᵀ f` of every column.
    pub fn loads(&self, columns: &[Column], bodies: &Bodies, motions: &[Motions]) -> MotionLoads {
        let mut out = MotionLoads {
            loads: Dense::zeros(self.count(), columns.len()),
            scales: Dense::zeros(self.count(), columns.len()),
        };
        for (j, column) in columns.iter().enumerate() {
            let Column::Force(entries) = column else { continue };
            for &(node, direction, value) in entries {
                let body = bodies.of_node[node.index()];
                if body == u32::MAX {
                    continue;
                }
                let (body, local) = (body as usize, bodies.local[node.index()] as usize);
                for m in 0..motions[body].count() {
                    let work = value * motions[body].at(m, local, usize::from(direction));
                    out.loads.column_mut(j)[self.offsets[body] + m] += work;
                    out.scales.column_mut(j)[self.offsets[body] + m] += work.abs();
                }
            }
            for (load, scale) in out.loads.column_mut(j).iter_mut().zip(out.scales.column(j)) {
                if load.abs() <= LOAD_ROUNDING * scale {
                    *load = 0.0;
                }
            }
        }
        out
    }

    /// Body and motion that dominate a combination of the motions.
    pub fn describe(&self, motions: &[Motions], combination: &[f64]) -> (Sample, String) {
        let square = |b: usize| combination[self.offsets[b]..self.offsets[b + 1]].iter().map(|x| x * x).sum::<f64>();
        let body = (0..motions.len())
            .max_by(|&a, &b| square(a).total_cmp(&square(b)).then(b.cmp(&a)))
            .expect("a combination of motions belongs to bodies");
        motions[body].describe(&combination[self.offsets[body]..self.offsets[body + 1]])
    }
}

/// Some columns of a matrix.
fn columns(matrix: &Dense, range: std::ops::Range<usize>) -> Dense {
    Dense {
        rows: matrix.rows,
        columns: range.len(),
        values: matrix.values[range.start * matrix.rows..range.end * matrix.rows].to_vec(),
    }
}

/// `D` of one body.
fn gaps_of(points: &[ContactPoint], bodies: &Bodies, body: usize, motions: &Motions) -> Dense {
    let mut gaps = Dense::zeros(points.len(), motions.count());
    for (p, point) in points.iter().enumerate() {
        point.row(point.normal.map(|x| -x), |node: NodeId, direction, value| {
            if bodies.of_node[node.index()] as usize == body {
                let local = bodies.local[node.index()] as usize;
                for m in 0..motions.count() {
                    gaps.column_mut(m)[p] += value * motions.at(m, local, direction);
                }
            }
        });
    }
    gaps
}
