//! Rigid motions of a body that supports, equations and springs leave free.
//!
//! Each part moves by `t_d + (ω x r)_d` with `r` the position from the centroid of the body over its size. Prescribed
//! directions, equations, nodes shared by parts and elongations of bars and springs are homogeneous rows on these
//! parameters; their common kernel is what the structure does not resist: `K R = 0`, and `R` keeps every constraint.

use super::assembly::coordinates;
use super::constraints::Constraints;
use super::linear::{self, Dense};
use super::parts::{Parts, Sample};
use super::rigid;
use crate::element::connector;
use crate::model::{Connector, ElementId, Model, NodeId};

/// A motion counts as free when the constraints resist it by less than this part of the best-held motion (squares).
const HELD_RELATIVE_MIN: f64 = 1e-12;
/// Entries of a motion below this part of its largest are rounding.
const ROUNDING: f64 = 1e-12;
/// Parameters beyond which the kernel is not looked for: what then moves without resistance shows as a missing pivot.
const PARAMETERS_MAX: usize = 1500;

/// Free motions of one body.
pub struct Motions {
    /// `R`: (3 directions per body-local node) x motions; the largest entry of each motion is 1.
    pub rows: Dense,
    /// Parameters of the parts for each motion.
    parameters: Dense,
    parts: Parts,
    centroid: [f64; 3],
    size: f64,
}

impl Motions {
    /// None: of a body that its inertia holds.
    pub fn none() -> Self {
        Self {
            rows: Dense::default(),
            parameters: Dense::default(),
            parts: Parts::default(),
            centroid: [0.0; 3],
            size: 1.0,
        }
    }

    /// Free motions of a body; `local` maps nodes to body-local numbers.
    pub fn find(model: &Model, constraints: &Constraints, nodes: &[NodeId], elements: &[u32], local: &[u32]) -> Self {
        let mesh = &model.mesh;
        let parts = Parts::find(mesh, nodes, elements, local, |n, d| constraints.is_free(n, d));
        let count = nodes.len() as f64;
        let mut centroid = [0.0; 3];
        for n in nodes {
            for (c, x) in centroid.iter_mut().zip(mesh.nodes[n.index()]) {
                *c += x / count;
            }
        }
        let far = |n: &NodeId| (0..3).map(|d| (mesh.nodes[n.index()][d] - centroid[d]).abs()).fold(0.0, f64::max);
        let size = nodes.iter().map(far).fold(0.0f64, f64::max);
        let size = if size > 0.0 { size } else { 1.0 };
        let mut out = Self { rows: Dense::default(), parameters: Dense::default(), parts, centroid, size };
        if out.parts.parameters() <= PARAMETERS_MAX {
            let gram = out.gram(model, constraints, nodes, elements, local);
            out.parameters = kernel(&gram);
            out.fill_rows(model, constraints, nodes, local);
        }
        out
    }

    /// Number of motions.
    pub fn count(&self) -> usize {
        self.rows.columns
    }

    /// Displacement of a direction of a body-local node in a motion.
    pub fn at(&self, motion: usize, node: usize, direction: usize) -> f64 {
        self.rows.column(motion)[3 * node + direction]
    }

    /// Replaces the motions by combinations of them, one a column, made simple within the given groups of columns.
    pub fn combine(
        &mut self,
        model: &Model,
        constraints: &Constraints,
        nodes: &[NodeId],
        local: &[u32],
        groups: &[Dense],
    ) {
        let p = self.parameters.rows;
        let mut all = Dense { rows: p, columns: 0, values: Vec::new() };
        for group in groups {
            let mut mixed = Dense::zeros(p, group.columns);
            for j in 0..group.columns {
                self.parameters.multiply_add(group.column(j), mixed.column_mut(j));
            }
            echelon(&mut mixed);
            all.values.extend(mixed.values);
            all.columns += group.columns;
        }
        self.parameters = all;
        self.fill_rows(model, constraints, nodes, local);
    }

    /// Directions to hold so that no motion is left: a pivoted choice among the free ones, far apart and
    /// independent. Body-local nodes; as many as there are motions.
    pub fn anchors(&self, is_free: impl Fn(usize, usize) -> bool) -> Vec<(usize, usize)> {
        let k = self.count();
        let mut rest = self.rows.clone();
        let mut chosen: Vec<(usize, usize)> = Vec::with_capacity(k);
        for _ in 0..k {
            let square = |rest: &Dense, row: usize| (0..k).map(|m| rest.column(m)[row].powi(2)).sum::<f64>();
            let free = (0..rest.rows).filter(|&row| is_free(row / 3, row % 3));
            let Some(pivot) = free.max_by(|&a, &b| square(&rest, a).total_cmp(&square(&rest, b)).then(b.cmp(&a)))
            else {
                break;
            };
            let length = square(&rest, pivot).sqrt();
            let unit: Vec<f64> = (0..k).map(|m| rest.column(m)[pivot] / length).collect();
            for row in 0..rest.rows {
                let along: f64 = (0..k).map(|m| rest.column(m)[row] * unit[m]).sum();
                for m in 0..k {
                    rest.column_mut(m)[row] -= along * unit[m];
                }
            }
            chosen.push((pivot / 3, pivot % 3));
        }
        chosen
    }

    /// What moves most in a combination of the motions, and how, in words.
    pub fn describe(&self, combination: &[f64]) -> (Sample, String) {
        let mut parameters = vec![0.0; self.parameters.rows];
        self.parameters.multiply_add(combination, &mut parameters);
        let of_part = |part: usize| &parameters[self.parts.offsets[part]..self.parts.offsets[part + 1]];
        let square = |part: usize| of_part(part).iter().map(|x| x * x).sum::<f64>();
        let most = (0..self.parts.sample.len())
            .max_by(|&a, &b| square(a).total_cmp(&square(b)).then(b.cmp(&a)))
            .expect("a body has a part");
        let mut motion = [0.0; 6];
        let directions = &self.parts.directions[self.parts.offsets[most]..self.parts.offsets[most + 1]];
        for (&direction, &amount) in directions.iter().zip(of_part(most)) {
            motion[usize::from(direction)] = amount;
        }
        (self.parts.sample[most], rigid::in_words(&motion, self.centroid, self.size))
    }

    /// Row of a direction of a node of a part: the factors of the part's parameters.
    fn row(&self, model: &Model, part: usize, node: NodeId, direction: usize) -> [f64; 6] {
        let mut row = [0.0; 6];
        let directions = &self.parts.directions[self.parts.offsets[part]..self.parts.offsets[part + 1]];
        if let Some(at) = directions.iter().position(|&d| usize::from(d) == direction) {
            row[at] = 1.0;
        }
        if directions.len() == 6 {
            let r: [f64; 3] =
                std::array::from_fn(|d| (model.mesh.nodes[node.index()][d] - self.centroid[d]) / self.size);
            let rotations = [[0.0, -r[2], r[1]], [r[2], 0.0, -r[0]], [-r[1], r[0], 0.0]];
            for (axis, rotation) in rotations.iter().enumerate() {
                row[3 + axis] = rotation[direction];
            }
        }
        row
    }

    /// Sum of the squares of all constraint rows.
    fn gram(
        &self,
        model: &Model,
        constraints: &Constraints,
        nodes: &[NodeId],
        elements: &[u32],
        local: &[u32],
    ) -> Dense {
        let mut gram = Gram { sum: Dense::zeros(self.parts.parameters(), self.parts.parameters()), row: Vec::new() };
        let part_of = |node: NodeId| self.parts.of_node[local[node.index()] as usize] as usize;
        let is_solid = |node: NodeId| matches!(self.parts.sample[part_of(node)], Sample::Element(_));
        let own = |gram: &mut Gram, node: NodeId, direction: usize, factor: f64| {
            let part = part_of(node);
            gram.add(self.parts.offsets[part], &self.row(model, part, node, direction), factor);
        };
        // A dependent direction of a lone node is no parameter: it moves as what it depends on.
        let add = |gram: &mut Gram, node: NodeId, direction: usize, factor: f64| match is_solid(node) {
            true => own(gram, node, direction, factor),
            false => constraints.expand(node, direction, factor, |n, d, f| own(gram, n, d, f)),
        };
        for &node in nodes {
            for direction in (0..3).filter(|&d| is_solid(node) && constraints.is_prescribed(node, d)) {
                add(&mut gram, node, direction, 1.0);
                gram.finish();
            }
        }
        for &(node, part) in &self.parts.shared {
            let node = nodes[node as usize];
            for direction in 0..3 {
                add(&mut gram, node, direction, 1.0);
                let other = part as usize;
                gram.add(self.parts.offsets[other], &self.row(model, other, node, direction), -1.0);
                gram.finish();
            }
        }
        for ((node, direction), terms) in constraints.dependents() {
            if nodes.binary_search(&node).is_err() || !is_solid(node) {
                continue;
            }
            let largest = terms.iter().fold(1.0f64, |m, t| m.max(t.2.abs()));
            own(&mut gram, node, usize::from(direction), 1.0 / largest);
            for &(n, d, factor) in terms {
                own(&mut gram, n, usize::from(d), -factor / largest);
            }
            gram.finish();
        }
        for &e in elements {
            let Some(&section) = model.mesh.connectors.get(&ElementId(e)) else { continue };
            if matches!(section, Connector::Mass { .. } | Connector::Spring { stiffness: 0.0, .. }) {
                continue;
            }
            let kind = model.mesh.elements.kind(e as usize);
            let b = connector::elongation(kind, &coordinates(&model.mesh, e), section);
            for (&node, vector) in model.mesh.elements.nodes(e as usize).iter().zip(b) {
                for (direction, factor) in vector.into_iter().enumerate().filter(|(_, f)| *f != 0.0) {
                    add(&mut gram, node, direction, factor);
                }
            }
            gram.finish();
        }
        gram.sum
    }

    /// Rows from the parameters, each motion scaled to a largest entry of 1.
    fn fill_rows(&mut self, model: &Model, constraints: &Constraints, nodes: &[NodeId], local: &[u32]) {
        let k = self.parameters.columns;
        let mut rows = Dense::zeros(3 * nodes.len(), k);
        let own = |node: NodeId, direction: usize, m: usize| -> f64 {
            let part = self.parts.of_node[local[node.index()] as usize] as usize;
            let row = self.row(model, part, node, direction);
            let parameters = &self.parameters.column(m)[self.parts.offsets[part]..self.parts.offsets[part + 1]];
            row.iter().zip(parameters).map(|(r, p)| r * p).sum()
        };
        for (i, &node) in nodes.iter().enumerate() {
            let solid = matches!(self.parts.sample[self.parts.of_node[i] as usize], Sample::Element(_));
            for (m, direction) in (0..k).flat_map(|m| (0..3).map(move |d| (m, d))) {
                let mut sum = 0.0;
                match solid {
                    true => sum = own(node, direction, m),
                    false => constraints.expand(node, direction, 1.0, |n, d, factor| sum += factor * own(n, d, m)),
                }
                rows.column_mut(m)[3 * i + direction] = sum;
            }
        }
        for m in 0..k {
            let largest = rows.column(m).iter().fold(0.0f64, |a, x| a.max(x.abs()));
            let scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
            rows.column_mut(m)
                .iter_mut()
                .for_each(|x| *x = if (*x * scale).abs() < ROUNDING { 0.0 } else { *x * scale });
            self.parameters.column_mut(m).iter_mut().for_each(|x| *x *= scale);
        }
        self.rows = rows;
    }
}

/// Adds up squares of sparse rows.
struct Gram {
    sum: Dense,
    row: Vec<(usize, f64)>,
}

impl Gram {
    fn add(&mut self, offset: usize, factors: &[f64; 6], factor: f64) {
        self.row.extend(factors.iter().enumerate().filter(|(_, f)| **f != 0.0).map(|(i, f)| (offset + i, f * factor)));
    }

    fn finish(&mut self) {
        for &(j, b) in &self.row {
            for &(i, a) in &self.row {
                self.sum.column_mut(j)[i] += a * b;
            }
        }
        self.row.clear();
    }
}

/// Kernel of a positive semi-definite matrix, in simple columns.
pub fn kernel(gram: &Dense) -> Dense {
    let (values, vectors) = linear::eigen(gram);
    let largest = values.last().copied().unwrap_or(0.0);
    let count = values.iter().filter(|v| **v <= HELD_RELATIVE_MIN * largest).count();
    let mut out = Dense { rows: gram.rows, columns: count, values: vectors.values[..count * gram.rows].to_vec() };
    echelon(&mut out);
    out
}

/// Reduces columns so that each has an entry of 1 where the others have 0, largest entries first: motions along and about
/// axes come out as such.
pub fn echelon(columns: &mut Dense) {
    let (rows, k) = (columns.rows, columns.columns);
    let mut done = vec![false; k];
    for _ in 0..k {
        let entries = (0..k).filter(|&m| !done[m]).flat_map(|m| (0..rows).map(move |i| (m, i)));
        let Some((pivot, at)) = entries.reduce(|best, e| {
            // Clearly larger only: ties go to the first, so that rounding does not choose.
            let larger = columns.column(e.0)[e.1].abs() > 1.000_001 * columns.column(best.0)[best.1].abs();
            if larger { e } else { best }
        }) else {
            return;
        };
        done[pivot] = true;
        let scale = 1.0 / columns.column(pivot)[at];
        columns.column_mut(pivot).iter_mut().for_each(|x| *x *= scale);
        let unit = columns.column(pivot).to_vec();
        for m in (0..k).filter(|&m| m != pivot) {
            let factor = columns.column(m)[at];
            for (x, u) in columns.column_mut(m).iter_mut().zip(&unit) {
                *x -= factor * u;
            }
        }
    }
    for x in &mut columns.values {
        if x.abs() < ROUNDING {
            *x = 0.0;
        }
    }
}
