//! The active points of the sparse path: one factorisation of the coupled structure for every set of closed points.

use super::view::{Compliance, Springs, View};
use crate::solve::sparse::{self, ActiveSystem, CoupledFactor, SparseStructure};

/// Springs that differ by more than this factor from those of the factor need a new one.
const SPRING_CHANGE: f64 = 10.0;

/// The last factor and what went into it.
#[derive(Default)]
pub(super) struct SparseWork {
    factor: Option<CoupledFactor>,
    springs: Vec<f64>,
    /// Factorisations so far.
    pub factorizations: u32,
    product_forces: Vec<f64>,
    product_relief: Vec<f64>,
}

impl SparseWork {
    /// Solves `(W + C) F = right` on the active points: `compliances` in their order, 0 for hard ones. `forces` receives the
    /// solution. False when the structure cannot be factored.
    pub fn solve(
        &mut self,
        view: &View<'_>,
        active: &[u32],
        compliances: &[f64],
        right: &[f64],
        forces: &mut [f64],
    ) -> bool {
        let Compliance::Sparse(structure, springs) = view.compliance else { return false };
        if active.is_empty() {
            return true;
        }
        if !self.prepare(structure, springs, view, active, compliances) {
            return false;
        }
        let n = view.rows.len();
        let (mut all, mut relief) =
            (std::mem::take(&mut self.product_forces), std::mem::take(&mut self.product_relief));
        all.resize(n, 0.0);
        relief.resize(n, 0.0);
        if let Some(factor) = &self.factor {
            let mut product = |x: &[f64], out: &mut [f64]| {
                all.fill(0.0);
                for (&i, x) in active.iter().zip(x) {
                    all[i as usize] = *x;
                }
                view.relief(&all, &mut relief);
                for (k, &i) in active.iter().enumerate() {
                    out[k] = relief[i as usize] + compliances[k] * x[k];
                }
            };
            let mut approximate = |r: &[f64], z: &mut [f64]| factor.apply(&structure.coupled, r, z);
            let mut system = ActiveSystem { product: &mut product, approximate: &mut approximate };
            sparse::solve(&mut system, right, forces);
        }
        self.product_forces = all;
        self.product_relief = relief;
        true
    }

    /// Brings the factor up to the active points and springs.
    fn prepare(
        &mut self,
        structure: &SparseStructure,
        springs: Option<Springs<'_>>,
        view: &View<'_>,
        active: &[u32],
        compliances: &[f64],
    ) -> bool {
        let area = |i: u32| view.rows[i as usize].area;
        let shared = sparse::stand_in(active.iter().map(|&i| (structure.own[i as usize], area(i))));
        let stiff = |i: u32, c: f64| c.max(shared / area(i));
        let wanted: Vec<(u32, f64)> = active.iter().zip(compliances).map(|(&i, &c)| (i, stiff(i, c))).collect();
        let of_motions = springs.map_or(&[][..], |s| s.springs);
        let near = |(a, b): (&f64, &f64)| (a / b).max(b / a) <= SPRING_CHANGE;
        if let Some(factor) = &self.factor
            && factor.compliance == wanted
            && self.springs.len() == of_motions.len()
            && self.springs.iter().zip(of_motions).all(near)
        {
            return true;
        }
        self.factorizations += 1;
        let resisted = springs.map_or(&[][..], |s| s.resisted);
        self.springs.clear();
        self.springs.extend_from_slice(of_motions);
        self.factor = structure.coupled.factor(wanted, of_motions, resisted).ok();
        self.factor.is_some()
    }
}
