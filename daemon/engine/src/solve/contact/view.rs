//! The compliance that contact forces work against, with every motion held.

use super::row::{Row, Wall};
use crate::law::NormalBehavior;
use crate::solve::linear::Dense;
use crate::solve::sparse::SparseStructure;

/// Rounding of an overclosure, in units of the last place of the terms of its sum.
const ROUNDING_DENSE: f64 = 16.0;
/// The same where each product is a sparse solve.
const ROUNDING_SPARSE: f64 = 4096.0;

/// Springs on motions: `D` and `ε`.
#[derive(Clone, Copy)]
pub(super) struct Springs<'a> {
    pub gaps: &'a Dense,
    pub springs: &'a [f64],
    pub resisted: &'a [bool],
}

/// `W`, or `W + D ε⁻¹ Dᵀ`.
#[derive(Clone, Copy)]
pub(super) enum Compliance<'a> {
    Dense(&'a Dense),
    Sparse(&'a SparseStructure, Option<Springs<'a>>),
}

/// The points with a compliance that holds every motion.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub compliance: Compliance<'a>,
    pub rows: &'a [Row],
    pub behaviors: &'a [NormalBehavior],
    pub extent: f64,
}

impl View<'_> {
    /// By how much forces take the overclosures back.
    pub fn relief(&self, forces: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        match self.compliance {
            Compliance::Dense(w) => w.multiply_add(forces, out),
            Compliance::Sparse(structure, springs) => {
                structure.relief(forces, out);
                if let Some(s) = springs {
                    for m in (0..s.springs.len()).filter(|&m| s.resisted[m]) {
                        let d = s.gaps.column(m);
                        let moved = d.iter().zip(forces).map(|(d, f)| d * f).sum::<f64>() / s.springs[m];
                        out.iter_mut().zip(d).for_each(|(o, d)| *o += moved * d);
                    }
                }
            }
        }
    }

    /// Compliance of a point against itself; its scale where it is not known exactly.
    pub fn own(&self, i: usize) -> f64 {
        match self.compliance {
            Compliance::Dense(w) => w.column(i)[i],
            Compliance::Sparse(structure, springs) => {
                let moved = |s: Springs<'_>| -> f64 {
                    (0..s.springs.len())
                        .filter(|&m| s.resisted[m])
                        .map(|m| s.gaps.column(m)[i].powi(2) / s.springs[m])
                        .sum()
                };
                structure.own[i] + springs.map_or(0.0, moved)
            }
        }
    }

    /// Rounding of the overclosure at a point: a sum whose terms may cancel.
    pub fn rounding(&self, i: usize, free: f64, overclosure: f64, forces: &[f64]) -> f64 {
        match self.compliance {
            Compliance::Dense(w) => {
                let terms: f64 = w.column(i).iter().zip(forces).map(|(w, f)| (w * f).abs()).sum();
                ROUNDING_DENSE * f64::EPSILON * (free.abs() + terms)
            }
            Compliance::Sparse(..) => {
                let terms = (free - overclosure).abs() + self.own(i) * forces[i].abs();
                ROUNDING_SPARSE * f64::EPSILON * (free.abs() + terms)
            }
        }
    }

    /// Whether a row has a wall.
    pub fn has_wall(&self, i: usize) -> bool {
        self.rows[i].wall != Wall::None
    }
}
