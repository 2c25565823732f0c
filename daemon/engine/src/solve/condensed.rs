//! The condensed model: everything that increments need, in contact points and columns only.
//!
//! With coefficients `a` of the columns and contact forces `F`
//!
//! ```text
//! u = Σ a_j u_j − K⁻¹ Bᵀ F + R α
//! h = h_0 + H a − W F + D α                          overclosures
//! g = H_t a − W_t F + D_t α                          relative tangential displacements
//! d_i = f_iᵀ u = Σ G_ij a_j − H_iᵀ F + (Rᵀ f_i)ᵀ α   generalised displacement of a force column
//! R_i = û_iᵀ RF = Σ G_ij a_j + H_iᵀ F                generalised reaction of a displacement column
//! ```
//!
//! `α` are the motions of bodies that only contact holds (`floating.rs`). The last two need no solves of their own: by reciprocity the response of an output to contact forces is the overclosure
//! that the output's own column causes.

use rustc_hash::FxHashMap;

use super::body::{Body, BodyContribution};
use super::columns::Column;
use super::contact::ContactSystem;
use super::context::Context;
use super::floating::{Floating, MotionLoads};
use super::linear::Dense;
use super::numbering::{Bodies, NOT_FREE};
use crate::model::NodeId;

/// A solution in the condensed unknowns.
#[derive(Clone, Copy)]
pub struct Response<'a> {
    /// Coefficients `a` of the leading columns.
    pub coefficients: &'a [f64],
    /// Contact forces `F`.
    pub forces: &'a [f64],
    /// Motions `α`.
    pub motions: &'a [f64],
}

/// Dense operators on contact points and columns.
pub struct Condensed {
    /// `W_t`: first tangents, then second.
    pub slip_compliance: Dense,
    /// `h_0`: initial overclosures [length].
    pub initial: Vec<f64>,
    /// `H`: points x columns.
    pub gap_columns: Dense,
    /// `H_t`: (first tangents, then second) x columns.
    pub slip_columns: Dense,
    /// `G`.
    pub coupling: Dense,
    /// `D_t`.
    pub slip_motions: Dense,
    /// `Rᵀ f`: motions x columns.
    pub motion_loads: Dense,
    /// Scale of the rounding in `Rᵀ f`.
    pub motion_load_scales: Dense,
    /// Which columns are displacements.
    pub is_displacement: Vec<bool>,
    /// `û_iᵀ K û_i` of displacement columns before the interior gives way: the scale of the rounding in `G`.
    pub unrelieved: Vec<f64>,
}

impl Condensed {
    /// Puts the contributions of the bodies together; the second result is `W` [length/force], empty unless the
    /// bodies are condensed.
    pub fn new(
        context: &Context<'_>,
        numbering: &Bodies,
        bodies: &[Body],
        contributions: &[BodyContribution],
        floating: &Floating,
        motion_loads: MotionLoads,
        condensed: bool,
    ) -> (Self, Dense) {
        let (points, columns) = (context.points, context.columns);
        let (n, m) = (points.len(), columns.len());
        let mut compliance = if condensed { Dense::zeros(n, n) } else { Dense::default() };
        let mut slip_compliance = if condensed { Dense::zeros(2 * n, n) } else { Dense::default() };
        let mut products = Dense::zeros(m, m);
        let mut prescribed_energy = Dense::zeros(m, m);
        for (body, part) in bodies.iter().zip(contributions) {
            let k = body.points.len();
            for (j, &q) in body.points.iter().enumerate().filter(|_| condensed) {
                for (i, &p) in body.points.iter().enumerate() {
                    compliance.column_mut(q as usize)[p as usize] += part.compliance.column(j)[i];
                    for t in 0..2 {
                        slip_compliance.column_mut(q as usize)[t * n + p as usize] +=
                            part.slip_compliance.column(j)[t * k + i];
                    }
                }
            }
            for (sum, value) in products.values.iter_mut().zip(&part.products.values) {
                *sum += value;
            }
            for (sum, value) in prescribed_energy.values.iter_mut().zip(&part.prescribed_energy.values) {
                *sum += value;
            }
        }
        let (gap_columns, slip_columns) = responses(context, numbering, bodies);
        let is_displacement: Vec<bool> = columns.iter().map(Column::is_displacement).collect();
        let coupling = couplings(columns, &products, &prescribed_energy);
        let initial = points.iter().map(|p| -p.clearance).collect();
        let unrelieved = (0..m).map(|i| prescribed_energy.column(i)[i]).collect();
        (
            Self {
                slip_compliance,
                initial,
                gap_columns,
                slip_columns,
                coupling,
                slip_motions: floating.slips.clone(),
                motion_loads: motion_loads.loads,
                motion_load_scales: motion_loads.scales,
                is_displacement,
                unrelieved,
            },
            compliance,
        )
    }

    /// Overclosures without contact forces; coefficients of the leading columns.
    pub fn free_overclosures(&self, coefficients: &[f64], out: &mut [f64]) {
        out.copy_from_slice(&self.initial);
        self.gap_columns.multiply_add(coefficients, out);
    }

    /// `Rᵀ f` into `load` and the scale of its rounding into `scale`, one value per motion.
    pub fn motion_load(&self, coefficients: &[f64], load: &mut [f64], scale: &mut [f64]) {
        load.fill(0.0);
        scale.fill(0.0);
        self.motion_loads.multiply_add(coefficients, load);
        for (j, a) in coefficients.iter().enumerate() {
            for (sum, s) in scale.iter_mut().zip(self.motion_load_scales.column(j)) {
                *sum += (a * s).abs();
            }
        }
    }

    /// Relative tangential displacements.
    pub fn tangential(&self, contact: &ContactSystem, response: Response<'_>, scratch: &mut [f64], out: &mut [f64]) {
        scratch.fill(0.0);
        contact.slip_relief(&self.slip_compliance, response.forces, scratch);
        out.fill(0.0);
        self.slip_columns.multiply_add(response.coefficients, out);
        self.slip_motions.multiply_add(response.motions, out);
        for (o, s) in out.iter_mut().zip(&*scratch) {
            *o -= s;
        }
    }

    /// Generalised displacement of a force column, or generalised reaction of a displacement column.
    pub fn conjugate(&self, column: usize, response: Response<'_>) -> f64 {
        let m = self.coupling.rows;
        let by_columns: f64 =
            response.coefficients.iter().enumerate().map(|(j, a)| self.coupling.values[j * m + column] * a).sum();
        let by_contact: f64 = self.gap_columns.column(column).iter().zip(response.forces).map(|(h, f)| h * f).sum();
        if self.is_displacement[column] {
            return by_columns + by_contact;
        }
        let by_motions: f64 = self.motion_loads.column(column).iter().zip(response.motions).map(|(r, a)| r * a).sum();
        by_columns - by_contact + by_motions
    }

    /// Strain energy of the bodies: `½ Σ_dd a G a + ½ Σ_ff a G a + ½ Fᵀ W F − Fᵀ Σ_f H a`; `relief` is `W F`. Motions store
    /// none.
    pub fn strain_energy(&self, coefficients: &[f64], forces: &[f64], relief: &[f64]) -> f64 {
        let m = self.coupling.rows;
        let mut energy = 0.0;
        for (j, aj) in coefficients.iter().enumerate() {
            for (i, ai) in coefficients.iter().enumerate() {
                if self.is_displacement[i] == self.is_displacement[j] {
                    energy += 0.5 * ai * aj * self.coupling.values[j * m + i];
                }
            }
        }
        energy += 0.5 * relief.iter().zip(forces).map(|(w, f)| w * f).sum::<f64>();
        for (j, aj) in coefficients.iter().enumerate().filter(|&(j, _)| !self.is_displacement[j]) {
            energy -= aj * self.gap_columns.column(j).iter().zip(forces).map(|(h, f)| h * f).sum::<f64>();
        }
        energy
    }
}

/// `G`: what each column does to the generalised value of each other.
fn couplings(columns: &[Column], products: &Dense, prescribed_energy: &Dense) -> Dense {
    let m = columns.len();
    let mut out = Dense::zeros(m, m);
    let at = |d: &Dense, i: usize, j: usize| d.values[j * m + i];
    for j in 0..m {
        for i in 0..m {
            let value = match (columns[i].is_displacement(), columns[j].is_displacement()) {
                // û_iᵀ (K u_j)_p, the right-hand side of i being −K_fp û_i.
                (true, true) => at(prescribed_energy, i, j) - at(products, i, j),
                (false, false) => at(products, i, j),
                (false, true) => at(products, i, j) + overlap(&columns[i], &columns[j]),
                (true, false) => -(at(products, j, i) + overlap(&columns[j], &columns[i])),
            };
            out.values[j * m + i] = value;
        }
    }
    out
}

/// Sum of products of the entries that two columns share.
fn overlap(a: &Column, b: &Column) -> f64 {
    let (mut a, mut b) = (a.entries().iter().peekable(), b.entries().iter().peekable());
    let mut sum = 0.0;
    while let (Some(x), Some(y)) = (a.peek(), b.peek()) {
        match (x.0, x.1).cmp(&(y.0, y.1)) {
            std::cmp::Ordering::Less => drop(a.next()),
            std::cmp::Ordering::Greater => drop(b.next()),
            std::cmp::Ordering::Equal => {
                sum += x.2 * y.2;
                a.next();
                b.next();
            }
        }
    }
    sum
}

/// `H` and `H_t`: what unit coefficients do at the contact points.
fn responses(context: &Context<'_>, numbering: &Bodies, bodies: &[Body]) -> (Dense, Dense) {
    let (points, columns) = (context.points, context.columns);
    let (n, m) = (points.len(), columns.len());
    // Dependent directions stand here with what prescribed ones do to them.
    let mut prescribed: FxHashMap<(NodeId, u8), Vec<(usize, f64)>> = FxHashMap::default();
    for (j, column) in columns.iter().enumerate() {
        if let Column::Displacement(entries) = column {
            for &(node, direction, value) in entries {
                prescribed.entry((node, direction)).or_default().push((j, value));
            }
        }
    }
    let mut gap = Dense::zeros(n, m);
    let mut slip = Dense::zeros(2 * n, m);
    let mut row = vec![0.0; m];
    for (p, point) in points.iter().enumerate() {
        let directions = [point.normal.map(|x| -x), point.tangents[0], point.tangents[1]];
        for (kind, &v) in directions.iter().enumerate() {
            row.fill(0.0);
            point.row(v, |node, direction, value| {
                for &(j, pattern) in prescribed.get(&(node, direction as u8)).map_or(&[][..], Vec::as_slice) {
                    row[j] += value * pattern;
                }
                context.constraints.expand(node, direction, value, |n, d, share| {
                    let body = numbering.of_node[n.index()];
                    if body == u32::MAX {
                        return;
                    }
                    let body = &bodies[body as usize];
                    let unknown = body.unknowns[numbering.local[n.index()] as usize][d];
                    if unknown != NOT_FREE {
                        for (r, j) in row.iter_mut().zip(0..m) {
                            *r += share * body.columns.column(j)[unknown as usize];
                        }
                    }
                });
            });
            for (j, value) in row.iter().enumerate() {
                match kind {
                    0 => gap.column_mut(j)[p] = *value,
                    t => slip.column_mut(j)[(t - 1) * n + p] = *value,
                }
            }
        }
    }
    (gap, slip)
}
