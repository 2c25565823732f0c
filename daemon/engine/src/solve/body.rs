//! One elastic body: its factored stiffness, condensed onto the contact points that touch it.

use serde::{Deserialize, Serialize};

use super::assembly::{self, Layout};
use super::budget::{Shortage, condensed_numbers};
use super::columns::Column;
use super::context::Context;
use super::lazy::LazyFactor;
use super::linear::{Dense, Factor, SingularPivot, Symbolic};
use super::motions::Motions;
use super::numbering::{NOT_FREE, NodeGraph, Reach};
use super::plan::BodyPlan;
use super::reactions;
use crate::contact::points::ContactPoint;
use crate::model::NodeId;
use crate::simulation::Phase;

/// A body, factored. Immutable. What serde skips is known without solving anything.
#[derive(Serialize, Deserialize)]
pub struct Body {
    /// Nodes, ascending; positions in this list are body-local node numbers.
    #[serde(skip)]
    pub nodes: Vec<NodeId>,
    /// Unknown of each direction of each node, or `NOT_FREE`.
    pub unknowns: Vec<[u32; 3]>,
    /// Number of unknowns.
    pub count: usize,
    /// Unknowns that no contact point touches; they come first.
    pub interior: usize,
    /// Factor; none for a body whose every direction is prescribed.
    #[serde(skip)]
    factor: Option<LazyFactor>,
    /// Contact points with an unknown in this body.
    pub points: Vec<u32>,
    /// Rows of these points on the unknowns; only of a body that is not condensed.
    #[serde(skip)]
    rows: Option<ContactRows>,
    /// `Y = L_cc⁻¹ B_cᵀ`: retained unknowns x points of this body.
    spread: Dense,
    /// Displacements of the columns on the unknowns.
    pub columns: Dense,
}

/// Rows of contact points on the unknowns of a body.
struct ContactRows {
    normals: Vec<Vec<(u32, f64)>>,
    tangents: [Vec<Vec<(u32, f64)>>; 2],
}

/// What the rest of the model needs of a body at set-up.
#[derive(Serialize, Deserialize)]
pub struct BodyContribution {
    /// `B K⁻¹ Bᵀ`: points x points of this body [length/force].
    pub compliance: Dense,
    /// `T K⁻¹ Bᵀ`: (first tangents, then second tangents) x points.
    pub slip_compliance: Dense,
    /// Products of the right-hand sides with the solutions: `r_iᵀ u_j` over the unknowns.
    pub products: Dense,
    /// `û_iᵀ K û_j` of the displacement columns.
    pub prescribed_energy: Dense,
}

/// Why a body could not be prepared.
#[derive(Debug)]
pub enum BodyError {
    /// A direction of a node has no stiffness.
    NoStiffness {
        /// The node.
        node: NodeId,
        /// Direction, 0..3.
        direction: usize,
    },
    /// It does not fit into memory.
    Memory(Shortage),
}

/// Diagonal of a direction without mass, relative to the largest of the body: next to nothing.
const MASSLESS: f64 = 1e-9;

impl Body {
    /// Assembles, orders and factors a body; condenses it unless `condense` is false.
    pub fn prepare(
        context: &Context<'_>,
        nodes: &[NodeId],
        elements: &[u32],
        motions: &Motions,
        body_points: Vec<u32>,
        condense: bool,
        announce: &mut dyn FnMut(Phase),
    ) -> Result<(Self, BodyContribution), BodyError> {
        announce(Phase::Order);
        let is_free = |node: usize, direction: usize| context.constraints.is_free(nodes[node], direction);
        // Holding the anchors makes the stiffness regular; on loads in balance they carry nothing.
        let anchors = motions.anchors(is_free);
        let plan = BodyPlan::new(context, nodes, elements, &anchors, body_points, condense);
        Self::prepare_by(context, nodes, elements, &plan, announce)
    }

    /// The same with numbering and pattern that are known, for matrices of one pattern.
    pub fn prepare_by(
        context: &Context<'_>,
        nodes: &[NodeId],
        elements: &[u32],
        plan: &BodyPlan,
        announce: &mut dyn FnMut(Phase),
    ) -> Result<(Self, BodyContribution), BodyError> {
        let BodyPlan { order, unknowns, count, interior, points, condense, symbolic } = plan;
        let (count, interior, condense) = (*count, *interior, *condense);
        announce(Phase::Assemble);
        let reach = Reach::new(&context.model.mesh, elements, context.constraints);
        let graph = plan.graph(context, &reach, nodes, elements);
        let layout = Layout { reach: &reach, graph: &graph, order, unknowns, count };
        let mut matrix = assembly::assemble(context, elements, &layout);
        if context.blend.stiffness == 0.0 {
            matrix.fill_diagonal(MASSLESS);
        }
        let factor = if count == 0 {
            None
        } else {
            announce(Phase::Symbolic);
            let symbolic = symbolic.get_or_init(|| Symbolic::analyse(&matrix));
            let condensed = if condense { condensed_numbers(count - interior, points.len()) } else { 0 };
            let columns = 2 * count * context.columns.len();
            let numbers = symbolic.size().values + 2 * matrix.values.len() + condensed + columns;
            context.budget.take(numbers).map_err(BodyError::Memory)?;
            announce(Phase::Numeric);
            let factor =
                Factor::new(&matrix, symbolic.clone()).map_err(|pivot| no_stiffness(nodes, unknowns, pivot))?;
            Some(LazyFactor::computed(factor))
        };
        drop(matrix);
        announce(Phase::Condense);
        let mut body = Self {
            nodes: nodes.to_vec(),
            unknowns: unknowns.clone(),
            count,
            interior,
            factor,
            points: points.clone(),
            rows: None,
            spread: Dense::default(),
            columns: Dense::default(),
        };
        let contribution = match condense {
            true => body.condense(context, elements),
            false => body.keep_rows(context, elements),
        };
        Ok((body, contribution))
    }

    /// Takes its place in the model after it was read from disk; false if it does not fit there. `factors` are those that
    /// were not taken yet.
    pub fn return_to(
        &mut self,
        context: &Context<'_>,
        nodes: &[NodeId],
        points: &[u32],
        contribution: &BodyContribution,
        factors: &mut impl Iterator<Item = LazyFactor>,
    ) -> bool {
        let (k, m) = (points.len(), context.columns.len());
        let retained = self.count.checked_sub(self.interior);
        let BodyContribution { compliance, slip_compliance, products, prescribed_energy } = contribution;
        let shapes = [
            (&self.spread, retained, k),
            (&self.columns, Some(self.count), m),
            (compliance, Some(k), k),
            (slip_compliance, Some(2 * k), k),
            (products, Some(m), m),
            (prescribed_energy, Some(m), m),
        ];
        let free = self.unknowns.iter().flatten().filter(|&&u| u != NOT_FREE);
        let numbers = free.clone().count() == self.count && free.clone().all(|&u| (u as usize) < self.count);
        let fits = self.unknowns.len() == nodes.len()
            && self.points == points
            && numbers
            && shapes.iter().all(|(matrix, rows, columns)| matrix.has_shape(*rows, *columns));
        self.nodes = nodes.to_vec();
        self.factor = if self.count == 0 { None } else { factors.next() };
        fits && self.factor.is_some() == (self.count > 0)
    }

    /// Factors again, with the bits of the first time: for a body whose factor on disk is lost.
    fn refactor(&self, context: &Context<'_>, elements: &[u32]) -> Factor {
        let reach = Reach::new(&context.model.mesh, elements, context.constraints);
        let graph = NodeGraph::new(&reach, &self.nodes, elements, context.local);
        // Nodes in the order of their unknowns; those without any have no part in the matrix.
        let mut order: Vec<u32> = (0..self.nodes.len() as u32).collect();
        order.sort_by_key(|&node| self.unknowns[node as usize].into_iter().min());
        let layout =
            Layout { reach: &reach, graph: &graph, order: &order, unknowns: &self.unknowns, count: self.count };
        let matrix = assembly::assemble(context, elements, &layout);
        Factor::new(&matrix, Symbolic::analyse(&matrix)).unwrap_or_else(|pivot| {
            panic!("a matrix that was factored before has no pivot in unknown {}", pivot.unknown)
        })
    }

    /// Unknowns of this body that a direction of a node belongs to, with the value's share of each.
    fn spread_over(
        &self,
        context: &Context<'_>,
        node: NodeId,
        direction: usize,
        value: f64,
        mut add: impl FnMut(usize, f64),
    ) {
        // A node of another body has a body-local number too: compare the node itself.
        let local = |n: NodeId| context.local[n.index()] as usize;
        if self.nodes.get(local(node)) != Some(&node) {
            return;
        }
        context.constraints.expand(node, direction, value, |n, d, v| {
            let unknown = self.unknowns[local(n)][d];
            if unknown != NOT_FREE {
                add(unknown as usize, v);
            }
        });
    }

    /// Keeps the contact rows instead of condensing.
    fn keep_rows(&mut self, context: &Context<'_>, elements: &[u32]) -> BodyContribution {
        let rows = |pick: &dyn Fn(&ContactPoint) -> [f64; 3]| -> Vec<Vec<(u32, f64)>> {
            let of_point = |&p: &u32| {
                let point = &context.points[p as usize];
                let mut row = Vec::new();
                point.row(pick(point), |node, direction, value| {
                    self.spread_over(context, node, direction, value, |u, v| row.push((u as u32, v)));
                });
                row
            };
            self.points.iter().map(of_point).collect()
        };
        let normals = rows(&|p| p.normal.map(|x| -x));
        let tangents = [rows(&|p| p.tangents[0]), rows(&|p| p.tangents[1])];
        self.rows = Some(ContactRows { normals, tangents });
        let (products, prescribed_energy) = self.solve_columns(context, elements);
        BodyContribution {
            compliance: Dense::default(),
            slip_compliance: Dense::default(),
            products,
            prescribed_energy,
        }
    }

    /// Adds what contact forces do to the overclosures (`W F`) and to the tangential displacements (`W_t F`, first tangents,
    /// then second) of a body that is not condensed; an empty slice is not wanted.
    pub fn respond(&self, forces: &[f64], relief: &mut [f64], slip: &mut [f64]) {
        let (Some(rows), Some(factor)) = (&self.rows, self.factor_in_memory()) else { return };
        if self.points.iter().all(|&p| forces[p as usize] == 0.0) {
            return;
        }
        let mut u = Dense::zeros(self.count, 1);
        for (row, &p) in rows.normals.iter().zip(&self.points) {
            row.iter().for_each(|&(i, v)| u.values[i as usize] += v * forces[p as usize]);
        }
        factor.solve(&mut u);
        let product = |row: &[(u32, f64)]| row.iter().map(|&(i, v)| v * u.values[i as usize]).sum::<f64>();
        if !relief.is_empty() {
            for (row, &p) in rows.normals.iter().zip(&self.points) {
                relief[p as usize] += product(row);
            }
        }
        if !slip.is_empty() {
            let n = slip.len() / 2;
            for (t, tangents) in rows.tangents.iter().enumerate() {
                for (row, &p) in tangents.iter().zip(&self.points) {
                    slip[t * n + p as usize] += product(row);
                }
            }
        }
    }

    fn condense(&mut self, context: &Context<'_>, elements: &[u32]) -> BodyContribution {
        let retained = self.count - self.interior;
        let lower = self.factor_in_memory().map_or_else(Dense::default, |f| f.trailing(self.interior));
        // Normal rows, dense on the retained unknowns; tangential rows stay sparse.
        let mut spread = Dense::zeros(retained, self.points.len());
        for (column, &p) in self.points.iter().enumerate() {
            let point = &context.points[p as usize];
            point.row(point.normal.map(|x| -x), |node, direction, value| {
                self.spread_over(context, node, direction, value, |u, v| {
                    spread.values[column * retained + u - self.interior] += v;
                });
            });
        }
        spread.solve_lower(&lower);
        let compliance = spread.gram();
        let mut response = spread.clone();
        response.solve_lower_transposed(&lower);
        let n = self.points.len();
        let mut slip_compliance = Dense::zeros(2 * n, n);
        let mut row: Vec<(usize, f64)> = Vec::new();
        for (k, &p) in self.points.iter().enumerate() {
            let point = &context.points[p as usize];
            for (t, &tangent) in point.tangents.iter().enumerate() {
                row.clear();
                point.row(tangent, |node, direction, value| {
                    self.spread_over(context, node, direction, value, |u, v| row.push((u - self.interior, v)));
                });
                for j in 0..n {
                    let column = response.column(j);
                    slip_compliance.values[j * 2 * n + t * n + k] = row.iter().map(|&(u, v)| v * column[u]).sum();
                }
            }
        }
        self.spread = spread;
        let (products, prescribed_energy) = self.solve_columns(context, elements);
        BodyContribution { compliance, slip_compliance, products, prescribed_energy }
    }

    /// Solves all columns at once; returns `r_iᵀ u_j` over the unknowns and `û_iᵀ K û_j`.
    fn solve_columns(&mut self, context: &Context<'_>, elements: &[u32]) -> (Dense, Dense) {
        let m = context.columns.len();
        let mut rhs = Dense::zeros(self.count, m);
        for (j, column) in context.columns.iter().enumerate() {
            if let Column::Force(entries) = column {
                for &(node, direction, value) in entries {
                    self.spread_over(context, node, direction as usize, value, |u, v| {
                        rhs.values[j * self.count + u] += v;
                    });
                }
            }
        }
        let energy = reactions::couplings(context, elements, |node, direction, j, force| {
            self.spread_over(context, node, direction, force, |u, v| rhs.values[j * self.count + u] -= v);
        });
        let mut solution = rhs.clone();
        if let Some(factor) = self.factor_in_memory() {
            factor.solve(&mut solution);
        }
        let mut products = Dense::zeros(m, m);
        for j in 0..m {
            for i in 0..m {
                products.values[j * m + i] = rhs.column(i).iter().zip(solution.column(j)).map(|(r, u)| r * u).sum();
            }
        }
        self.columns = solution;
        (products, energy)
    }

    /// Drops the displacements of columns that only outputs needed.
    pub fn keep_columns(&mut self, count: usize) {
        self.columns.values.truncate(count * self.count);
        self.columns.values.shrink_to_fit();
        self.columns.columns = count;
    }

    /// Unknowns of the body under given column coefficients and contact forces (one per contact point of the model). The
    /// first time after a start from disk, the factor is read.
    pub fn recover(&self, context: &Context<'_>, elements: &[u32], coefficients: &[f64], forces: &[f64]) -> Vec<f64> {
        let factor = self.factor.as_ref().map(|factor| factor.get(self.count, || self.refactor(context, elements)));
        let mut contact = Dense::zeros(self.count, 1);
        if let Some(rows) = &self.rows {
            for (row, &p) in rows.normals.iter().zip(&self.points) {
                row.iter().for_each(|&(i, v)| contact.values[i as usize] -= v * forces[p as usize]);
            }
            if let Some(factor) = factor {
                factor.solve(&mut contact);
            }
            self.columns.multiply_add(coefficients, &mut contact.values);
            return contact.values;
        }
        // L⁻¹ Bᵀ F is zero on the interior: only the backward half of the solve is left.
        for (k, &p) in self.points.iter().enumerate() {
            let force = forces[p as usize];
            if force != 0.0 {
                for (o, y) in contact.values[self.interior..].iter_mut().zip(self.spread.column(k)) {
                    *o -= force * y;
                }
            }
        }
        if let Some(factor) = factor {
            factor.solve_transposed(&mut contact);
        }
        self.columns.multiply_add(coefficients, &mut contact.values);
        contact.values
    }

    /// The first half of a solve for nodal forces: `L⁻¹ f`, and what the forces do to the overclosures of this body's points,
    /// added to `overclosures`. Forces on dependent directions must have been moved to independent ones.
    pub fn begin_solve(&self, forces: &[[f64; 3]], overclosures: &mut [f64], half: &mut Dense) {
        half.rows = self.count;
        half.columns = 1;
        half.values.clear();
        half.values.resize(self.count, 0.0);
        for (node, directions) in self.nodes.iter().zip(&self.unknowns) {
            for (&unknown, &force) in directions.iter().zip(&forces[node.index()]) {
                if unknown != NOT_FREE {
                    half.values[unknown as usize] = force;
                }
            }
        }
        let Some(factor) = self.factor_in_memory() else { return };
        if let Some(rows) = &self.rows {
            factor.solve(half);
            for (row, &p) in rows.normals.iter().zip(&self.points) {
                overclosures[p as usize] += row.iter().map(|&(i, v)| v * half.values[i as usize]).sum::<f64>();
            }
            return;
        }
        factor.solve_lower(half);
        let retained = &half.values[self.interior..];
        for (k, &p) in self.points.iter().enumerate() {
            overclosures[p as usize] += self.spread.column(k).iter().zip(retained).map(|(y, x)| y * x).sum::<f64>();
        }
    }

    /// The second half: displacements of the free directions under these forces and contact forces, into `out`.
    pub fn end_solve(&self, contact: &[f64], half: &mut Dense, out: &mut [[f64; 3]]) {
        let Some(factor) = self.factor_in_memory() else { return };
        if let Some(rows) = &self.rows {
            let mut pushed = Dense::zeros(self.count, 1);
            for (row, &p) in rows.normals.iter().zip(&self.points) {
                row.iter().for_each(|&(i, v)| pushed.values[i as usize] += v * contact[p as usize]);
            }
            if pushed.values.iter().any(|&x| x != 0.0) {
                factor.solve(&mut pushed);
                half.values.iter_mut().zip(&pushed.values).for_each(|(u, v)| *u -= v);
            }
        } else {
            for (k, &p) in self.points.iter().enumerate() {
                let force = contact[p as usize];
                if force != 0.0 {
                    for (x, y) in half.values[self.interior..].iter_mut().zip(self.spread.column(k)) {
                        *x -= force * y;
                    }
                }
            }
            factor.solve_transposed(half);
        }
        for (node, directions) in self.nodes.iter().zip(&self.unknowns) {
            for (&unknown, u) in directions.iter().zip(&mut out[node.index()]) {
                if unknown != NOT_FREE {
                    *u = half.values[unknown as usize];
                }
            }
        }
    }

    /// The factor, unless it is on disk or there is none.
    pub fn factor_in_memory(&self) -> Option<&Factor> {
        self.factor.as_ref().and_then(LazyFactor::in_memory)
    }

    /// Whether a factorisation was done to prepare this body.
    pub fn was_factored(&self) -> bool {
        self.factor.as_ref().is_some_and(LazyFactor::was_computed)
    }
}

/// The direction of a node that an unknown without a pivot is.
fn no_stiffness(nodes: &[NodeId], unknowns: &[[u32; 3]], pivot: SingularPivot) -> BodyError {
    let mut all = unknowns.iter().enumerate().flat_map(|(n, us)| us.iter().enumerate().map(move |(d, &u)| (n, d, u)));
    let (node, direction, _) =
        all.find(|&(_, _, u)| u as usize == pivot.unknown).expect("every unknown is a direction of a node");
    BodyError::NoStiffness { node: nodes[node], direction }
}

/// Body-local nodes that the rows of contact points reach, ascending.
pub fn retained_nodes(context: &Context<'_>, nodes: &[NodeId], body_points: &[u32]) -> Vec<u32> {
    let mut touched = vec![false; nodes.len()];
    for &p in body_points {
        context.points[p as usize].row([1.0; 3], |node, direction, value| {
            if nodes.get(context.local[node.index()] as usize) == Some(&node) {
                context.constraints.expand(node, direction, value, |n, d, _| {
                    if context.constraints.is_free(n, d) {
                        touched[context.local[n.index()] as usize] = true;
                    }
                });
            }
        });
    }
    (0..nodes.len() as u32).filter(|&i| touched[i as usize]).collect()
}
