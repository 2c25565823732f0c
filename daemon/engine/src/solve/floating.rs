//! Bodies that only contact holds: their rigid motions at the contact points and under the loads.
//!
//! With motions `α` of the bodies, `u = G (f − Bᵀ F) + R α` and `Rᵀ (f − Bᵀ F) = 0`. At the contact points `D = B R` and
//! `D_t = T R`; `R` vanishes on prescribed directions, so reactions and couplings keep their formulas.

use super::columns::{Column, merge};
use super::constraints::Constraints;
use super::linear::{self, Dense};
use super::motions::{self, Motions};
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
    /// Whether contact resists the motion on its own: independent columns of `D`, as many as there are. Together with the loose
    /// combinations these motions span all.
    pub resisted: Vec<bool>,
    /// Combinations of the motions, of one body or several, that no contact point resists: motions x combinations.
    pub loose: Dense,
}

/// What columns do to the motions.
pub struct MotionLoads {
    /// `Rᵀ f` of unit coefficients: motions x columns; zero for displacement columns.
    pub loads: Dense,
    /// The same sums with the lengths of forces and motions: the scale of their rounding.
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
        let mut offsets = vec![0];
        for (b, body) in motions.iter_mut().enumerate() {
            if body.count() > 0 {
                let (values, vectors) = linear::singular(&gaps_of(points, bodies, b, body));
                let held = values.iter().filter(|v| **v > RESISTED_MIN * values[0].max(1.0)).count();
                if held > 0 && held < values.len() {
                    let groups = [columns(&vectors, 0..held), columns(&vectors, held..values.len())];
                    body.combine(model, constraints, &bodies.nodes[b], &bodies.local, &groups);
                }
            }
            offsets.push(offsets[b] + body.count());
        }
        let count = offsets[motions.len()];
        let mut out = Self {
            offsets,
            gaps: Dense::zeros(points.len(), count),
            slips: Dense::zeros(2 * points.len(), count),
            resisted: vec![false; count],
            loose: Dense::default(),
        };
        if count > 0 {
            out.fill(points, bodies, motions);
            let (values, vectors) = linear::singular(&out.gaps);
            let held = values.iter().filter(|v| **v > RESISTED_MIN * values[0].max(1.0)).count();
            out.loose = columns(&vectors, held..count);
            motions::echelon(&mut out.loose);
            out.resisted = independent(&out.gaps, held);
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
        self.gaps.columns
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
                            0 => self.gaps.column_mut(column)[p] += moved,
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
            // Entries of one node stand together: rounding is judged against the lengths of its force and its motion.
            for of_node in entries.chunk_by(|a, b| a.0 == b.0) {
                let node = of_node[0].0;
                let body = bodies.of_node[node.index()];
                if body == u32::MAX {
                    continue;
                }
                let (body, local) = (body as usize, bodies.local[node.index()] as usize);
                let force = of_node.iter().map(|e| e.2 * e.2).sum::<f64>().sqrt();
                for m in 0..motions[body].count() {
                    let at = |d: usize| motions[body].at(m, local, d);
                    let length = (0..3).map(|d| at(d) * at(d)).sum::<f64>().sqrt();
                    let work: f64 = of_node.iter().map(|e| e.2 * at(usize::from(e.1))).sum();
                    out.loads.column_mut(j)[self.offsets[body] + m] += work;
                    out.scales.column_mut(j)[self.offsets[body] + m] += force * length;
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

/// A choice of independent columns, the largest first.
fn independent(matrix: &Dense, count: usize) -> Vec<bool> {
    let mut rest = matrix.clone();
    let mut chosen = vec![false; matrix.columns];
    let square = |rest: &Dense, m: usize| rest.column(m).iter().map(|x| x * x).sum::<f64>();
    for _ in 0..count {
        let candidates = (0..rest.columns).filter(|&m| !chosen[m]);
        let Some(pivot) = candidates.max_by(|&a, &b| square(&rest, a).total_cmp(&square(&rest, b)).then(b.cmp(&a)))
        else {
            break;
        };
        chosen[pivot] = true;
        let length = square(&rest, pivot).sqrt();
        let unit: Vec<f64> = rest.column(pivot).iter().map(|x| x / length).collect();
        for m in 0..rest.columns {
            let along: f64 = rest.column(m).iter().zip(&unit).map(|(x, u)| x * u).sum();
            rest.column_mut(m).iter_mut().zip(&unit).for_each(|(x, u)| *x -= along * u);
        }
    }
    chosen
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
