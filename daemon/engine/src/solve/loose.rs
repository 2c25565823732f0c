//! Motions that nothing resists stay where they are: of all places that the rest of the solution allows, the one with no displacement
//! along them.

use super::condensed::{Condensed, Response};
use super::linear::{self, Dense, DenseScratch};

/// Takes the part of a solution along loose motions out.
#[derive(Default)]
pub struct Loose {
    /// `Z`: motions x combinations.
    combinations: Dense,
    /// Column that measures each combination: `(R Z)ᵀ u`.
    first_column: usize,
    /// Factor of `Zᵀ Rᵀ R Z`.
    factor: Vec<f64>,
}

impl Loose {
    /// For combinations that the columns from `first_column` on measure.
    pub fn new(combinations: &Dense, first_column: usize, condensed: &Condensed) -> Self {
        let k = combinations.columns;
        let mut factor = Vec::with_capacity(k * k);
        for j in 0..k {
            let load = condensed.motion_loads.column(first_column + j);
            factor.extend((0..k).map(|i| combinations.column(i).iter().zip(load).map(|(z, r)| z * r).sum::<f64>()));
        }
        let independent = linear::cholesky_in_place(&mut factor, k, &mut DenseScratch::default());
        // Singular vectors of distinct motions are independent; were they not, the motions would be left alone.
        let combinations = if independent { combinations.clone() } else { Dense::default() };
        Self { combinations, first_column, factor }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.combinations.columns == 0
    }

    /// Moves the motions so that `(R Z)ᵀ u = 0`; `amounts` is work space.
    pub fn settle(
        &self,
        condensed: &Condensed,
        coefficients: &[f64],
        forces: &[f64],
        motions: &mut [f64],
        amounts: &mut Vec<f64>,
    ) {
        let k = self.combinations.columns;
        amounts.clear();
        let response = Response { coefficients, forces, motions };
        amounts.extend((0..k).map(|z| -condensed.conjugate(self.first_column + z, response)));
        linear::cholesky_solve(&self.factor, k, amounts);
        self.combinations.multiply_add(amounts, motions);
    }
}
