//! All bodies as one sparse system, joined by closed contact: pattern and symbolic factor once, numbers for every set of closed
//! points.

use crate::contact::points::ContactPoint;
use crate::model::NodeId;
use crate::solve::assembly::{self, Layout, LowerMatrix};
use crate::solve::context::Context;
use crate::solve::floating::Floating;
use crate::solve::linear::{Dense, Factor, SingularPivot, Symbolic};
use crate::solve::motions::Motions;
use crate::solve::numbering::{Bodies, NOT_FREE, NodeGraph, Reach};
use crate::solve::ordering;

/// Spring on a motion in this matrix, relative to its mean diagonal entry, below which pivots would be rounding.
const SPRING_MIN: f64 = 1e-9;

/// Spring on a motion that stays where it is, relative to the mean diagonal entry.
const RIGID: f64 = 1e3;

/// Stiffness of the whole structure with room for every contact point.
pub struct Coupled {
    /// Bodies only.
    matrix: LowerMatrix,
    symbolic: Symbolic,
    /// Normal row of each point on the unknowns.
    rows: Vec<Vec<(u32, f64)>>,
    /// Entries that each point adds to, per unit of its stiffness.
    additions: Vec<Vec<(u32, f64)>>,
    /// Anchors of bodies with free motions.
    anchors: Vec<Anchors>,
    /// Mean diagonal entry [force/length].
    mean_stiffness: f64,
}

/// Springs on motions are springs between the anchors: `α = R_a⁻¹ u_a`.
struct Anchors {
    /// First motion of the body.
    first: usize,
    /// `R_a⁻¹`.
    inverse: Dense,
    /// Entry of the matrix for each pair of anchors, lower triangle by columns.
    entries: Vec<u32>,
}

/// The system factored with certain points and springs.
pub struct CoupledFactor {
    factor: Factor,
    /// The points and the compliances that stand for them.
    pub compliance: Vec<(u32, f64)>,
}

impl Coupled {
    /// Assembles and analyses the structure.
    pub fn new(context: &Context<'_>, bodies: &Bodies, motions: &[Motions], floating: &Floating) -> Self {
        let mut nodes: Vec<NodeId> = bodies.nodes.iter().flatten().copied().collect();
        nodes.sort_unstable();
        let mut local = vec![u32::MAX; context.model.mesh.nodes.len()];
        for (i, n) in nodes.iter().enumerate() {
            local[n.index()] = i as u32;
        }
        let elements: Vec<u32> = (0..context.model.mesh.elements.len() as u32).collect();
        let free = |n: NodeId, d: usize| context.constraints.is_free(n, d) && local[n.index()] != u32::MAX;
        let mut cliques: Vec<Vec<NodeId>> = context.points.iter().map(|p| reached(context, p, free)).collect();
        let chosen: Vec<Vec<(NodeId, usize)>> = (motions.iter().zip(&bodies.nodes))
            .map(|(m, own)| {
                let anchors = m.anchors(|node, d| context.constraints.is_free(own[node], d));
                anchors.into_iter().map(|(node, d)| (own[node], d)).collect()
            })
            .collect();
        cliques.extend(chosen.iter().filter(|a| !a.is_empty()).map(|a| a.iter().map(|(n, _)| *n).collect()));
        let reach = Reach::new(&context.model.mesh, &elements, context.constraints).with(cliques);
        let graph = NodeGraph::new(&reach, &nodes, &elements, &local);
        let order = ordering::order(&graph, &[]);
        let mut unknowns = vec![[NOT_FREE; 3]; nodes.len()];
        let mut count = 0;
        for &node in &order {
            for (direction, unknown) in unknowns[node as usize].iter_mut().enumerate() {
                if free(nodes[node as usize], direction) {
                    *unknown = count as u32;
                    count += 1;
                }
            }
        }
        let whole = Context { local: &local, ..*context };
        let layout = Layout { reach: &reach, graph: &graph, order: &order, unknowns: &unknowns, count };
        let matrix = assembly::assemble(&whole, &elements, &layout);
        let symbolic = Symbolic::analyse(&matrix);
        let unknown = |n: NodeId, d: usize| unknowns[local[n.index()] as usize][d];
        let rows: Vec<Vec<(u32, f64)>> = context
            .points
            .iter()
            .map(|p| row(context, p, |n, d| if free(n, d) { unknown(n, d) } else { NOT_FREE }))
            .collect();
        let additions = rows.iter().map(|row| additions(&matrix, row)).collect();
        let anchors = (chosen.iter().enumerate().filter(|(_, a)| !a.is_empty()))
            .map(|(b, anchors)| {
                let at: Vec<usize> = anchors.iter().map(|&(n, d)| unknown(n, d) as usize).collect();
                let values = Dense {
                    rows: at.len(),
                    columns: at.len(),
                    values: (0..at.len())
                        .flat_map(|m| {
                            anchors.iter().map(move |&(n, d)| motions[b].at(m, bodies.local[n.index()] as usize, d))
                        })
                        .collect(),
                };
                let pairs = (0..at.len()).flat_map(|j| (j..at.len()).map(move |i| (i, j)));
                let entries = pairs.map(|(i, j)| matrix.entry(at[i].max(at[j]), at[i].min(at[j])) as u32).collect();
                Anchors { first: floating.offsets[b], inverse: inverse(&values), entries }
            })
            .collect();
        let mean_stiffness = matrix.diagonal().sum::<f64>() / count.max(1) as f64;
        let mean_stiffness = if mean_stiffness > 0.0 { mean_stiffness } else { 1.0 };
        Self { matrix, symbolic, rows, additions, anchors, mean_stiffness }
    }

    /// Number of unknowns.
    pub fn count(&self) -> usize {
        self.matrix.len()
    }

    /// Numbers that the structure and one factorisation of it hold.
    pub fn numbers(&self) -> usize {
        self.symbolic.size().values + 4 * self.matrix.values.len()
    }

    /// Operations of each factorisation.
    pub fn operations(&self) -> f64 {
        self.symbolic.operations()
    }

    /// `bᵀ diag(K)⁻¹ b` of each point.
    pub fn own_compliances(&self) -> Vec<f64> {
        let diagonal: Vec<f64> = self.matrix.diagonal().collect();
        let of_row = |row: &Vec<(u32, f64)>| {
            row.iter().map(|&(u, v)| v * v / diagonal[u as usize]).filter(|c| c.is_finite()).sum()
        };
        self.rows.iter().map(of_row).collect()
    }

    /// Factors the structure with points of given compliances closed and springs on the motions that contact resists.
    pub fn factor(
        &self,
        compliance: Vec<(u32, f64)>,
        springs: &[f64],
        resisted: &[bool],
    ) -> Result<CoupledFactor, SingularPivot> {
        let mut matrix = LowerMatrix {
            starts: self.matrix.starts.clone(),
            rows: self.matrix.rows.clone(),
            values: self.matrix.values.clone(),
        };
        for &(point, c) in &compliance {
            for &(at, product) in &self.additions[point as usize] {
                matrix.values[at as usize] += product / c;
            }
        }
        for anchors in &self.anchors {
            let k = anchors.inverse.rows;
            let spring = |m: usize| match resisted[anchors.first + m] {
                true => springs[anchors.first + m].max(SPRING_MIN * self.mean_stiffness),
                // It stays where it is while the others move.
                false => RIGID * self.mean_stiffness,
            };
            let mut entries = anchors.entries.iter();
            for j in 0..k {
                for i in j..k {
                    let (ci, cj) = (anchors.inverse.column(i), anchors.inverse.column(j));
                    let sum: f64 = (0..k).map(|m| ci[m] * spring(m) * cj[m]).sum();
                    if let Some(&at) = entries.next() {
                        matrix.values[at as usize] += sum;
                    }
                }
            }
        }
        Ok(CoupledFactor { factor: Factor::new(&matrix, self.symbolic.clone())?, compliance })
    }
}

impl CoupledFactor {
    /// `z = D r − D B K̂⁻¹ Bᵀ D r` on the points of the factor, `D = C⁻¹`.
    pub fn apply(&self, coupled: &Coupled, r: &[f64], z: &mut [f64]) {
        let mut rhs = Dense::zeros(coupled.count(), 1);
        for (&(point, c), r) in self.compliance.iter().zip(r) {
            for &(u, value) in &coupled.rows[point as usize] {
                rhs.values[u as usize] += value * r / c;
            }
        }
        self.factor.solve(&mut rhs);
        for ((&(point, c), r), z) in self.compliance.iter().zip(r).zip(z) {
            let moved: f64 =
                coupled.rows[point as usize].iter().map(|&(u, value)| value * rhs.values[u as usize]).sum();
            *z = (r - moved) / c;
        }
    }
}

/// Free nodes that the row of a point reaches.
fn reached(context: &Context<'_>, point: &ContactPoint, free: impl Fn(NodeId, usize) -> bool) -> Vec<NodeId> {
    let mut nodes = Vec::new();
    point.row([1.0; 3], |node, direction, value| {
        context.constraints.expand(node, direction, value, |n, d, _| {
            if free(n, d) {
                nodes.push(n);
            }
        });
    });
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// Normal row of a point on unknowns, each once.
fn row(context: &Context<'_>, point: &ContactPoint, unknown: impl Fn(NodeId, usize) -> u32) -> Vec<(u32, f64)> {
    let mut row: Vec<(u32, f64)> = Vec::new();
    point.row(point.normal.map(|x| -x), |node, direction, value| {
        context.constraints.expand(node, direction, value, |n, d, v| {
            let u = unknown(n, d);
            match row.iter_mut().find(|(known, _)| *known == u) {
                _ if u == NOT_FREE => {}
                Some((_, sum)) => *sum += v,
                None => row.push((u, v)),
            }
        });
    });
    row
}

/// Entries of the matrix that `b bᵀ` adds to.
fn additions(matrix: &LowerMatrix, row: &[(u32, f64)]) -> Vec<(u32, f64)> {
    let mut out = Vec::new();
    for &(i, a) in row {
        for &(j, b) in row.iter().filter(|(j, _)| *j <= i) {
            out.push((matrix.entry(i as usize, j as usize) as u32, a * b));
        }
    }
    out
}

/// Inverse of a small regular matrix, by elimination with pivoting.
fn inverse(matrix: &Dense) -> Dense {
    let n = matrix.rows;
    let mut a = matrix.clone();
    let mut out = Dense::zeros(n, n);
    (0..n).for_each(|i| out.column_mut(i)[i] = 1.0);
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a.column(k)[i].abs().total_cmp(&a.column(k)[j].abs())).unwrap_or(k);
        for m in [&mut a, &mut out] {
            for j in 0..n {
                m.column_mut(j).swap(k, pivot);
            }
        }
        let scale = 1.0 / a.column(k)[k];
        let factors: Vec<f64> = a.column(k).to_vec();
        for m in [&mut a, &mut out] {
            for j in 0..n {
                let column = m.column_mut(j);
                column[k] *= scale;
                let head = column[k];
                for i in (0..n).filter(|&i| i != k) {
                    column[i] -= factors[i] * head;
                }
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_of_a_small_matrix_needs_a_pivot() {
        let m = Dense { rows: 3, columns: 3, values: vec![0.0, 2.0, 1.0, 1.0, 0.0, 3.0, 4.0, 1.0, 0.0] };
        let i = inverse(&m);
        for a in 0..3 {
            for b in 0..3 {
                let product: f64 = (0..3).map(|k| m.column(k)[a] * i.column(b)[k]).sum();
                assert!((product - f64::from(u8::from(a == b))).abs() < 1e-14);
            }
        }
    }
}
