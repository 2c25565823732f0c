//! The contact points as the solver sees them.

use super::row::Row;
use super::view::{Compliance, View};
use crate::law::NormalBehavior;
use crate::solve::linear::Dense;
use crate::solve::sparse::SparseStructure;

/// How contact forces meet the bodies.
pub enum Structure {
    /// Condensed: `W` as a matrix.
    Dense(Dense),
    /// By sparse solves.
    Sparse(Box<SparseStructure>),
}

/// Contact points, what their forces do, and the motions that they hold: immutable.
pub struct ContactSystem {
    /// `W = B K⁻¹ Bᵀ` [length/force], as a matrix or by solves.
    pub structure: Structure,
    /// Number of rows.
    pub count: usize,
    /// Behaviours that curves refer to.
    pub behaviors: Vec<NormalBehavior>,
    /// `D`: points x motions of bodies that only contact holds.
    pub gap_motions: Dense,
    /// Whether contact resists the motion on its own.
    pub resisted: Vec<bool>,
    /// `Z`: combinations of the motions that no point resists.
    pub loose: Dense,
    /// Size of the model: what rounding of coordinates is judged against [length].
    pub extent: f64,
    /// Springs on the motions to begin with: soft against the bodies where contact may hold them [force/length].
    pub springs: Vec<f64>,
}

impl ContactSystem {
    /// `W F`: by how much contact forces take the overclosures back.
    pub fn relief(&self, forces: &[f64], out: &mut [f64]) {
        self.held(&[], None).relief(forces, out);
    }

    /// `W_t F`, added to `out`; `dense` is `W_t` where there is one.
    pub fn slip_relief(&self, dense: &Dense, forces: &[f64], out: &mut [f64]) {
        match &self.structure {
            Structure::Dense(_) => dense.multiply_add(forces, out),
            Structure::Sparse(sparse) => sparse.slip(forces, out),
        }
    }

    /// The rows without springs on motions, or with a matrix that has them.
    pub(super) fn held<'a>(&'a self, rows: &'a [Row], with_springs: Option<Compliance<'a>>) -> View<'a> {
        let compliance = with_springs.unwrap_or(match &self.structure {
            Structure::Dense(w) => Compliance::Dense(w),
            Structure::Sparse(sparse) => Compliance::Sparse(sparse, None),
        });
        View { compliance, rows, behaviors: &self.behaviors, extent: self.extent }
    }

    /// Final overclosures `h_free − W F + D α` from `free` and the `relief` `W F`. The one place where they are computed, so that a
    /// restored state has the same bits.
    pub fn overclosures(&self, free: &[f64], relief: &[f64], motions: &[f64], out: &mut [f64]) {
        for ((h, free), relief) in out.iter_mut().zip(free).zip(relief) {
            *h = free - relief;
        }
        self.gap_motions.multiply_add(motions, out);
    }

    /// Compliance of a row against itself; its scale where it is not known exactly [length/force].
    pub fn own(&self, row: usize) -> f64 {
        self.held(&[], None).own(row)
    }

    /// Energy stored in curves at the closed points: before the first increment nothing is closed yet, however far the meshes
    /// overlap.
    pub fn energy(&self, rows: &[Row], overclosures: &[f64], closed: &[bool]) -> f64 {
        (rows.iter().zip(overclosures).zip(closed).filter(|(_, closed)| **closed))
            .map(|((row, h), _)| row.area * row.law(&self.behaviors, *h).energy)
            .sum()
    }
}

/// Springs to begin with: soft against the bodies where contact may hold each motion.
pub fn initial_springs(structure: &Structure, gap_motions: &Dense) -> Vec<f64> {
    let own = |i: usize| match structure {
        Structure::Dense(w) => w.column(i)[i],
        Structure::Sparse(sparse) => sparse.own[i],
    };
    let of_motion = |m: usize| {
        let stiffness = |(i, d): (usize, &f64)| d * d / own(i);
        let all: Vec<f64> =
            gap_motions.column(m).iter().enumerate().map(stiffness).filter(|s| s.is_finite() && *s > 0.0).collect();
        if all.is_empty() { 1.0 } else { super::SPRING_RATIO * all.iter().sum::<f64>() / all.len() as f64 }
    };
    (0..gap_motions.columns).map(of_motion).collect()
}
