//! Mass of solids: attached to all pairs of nodes, or to each node alone.
//!
//! ```text
//! M_ab = m_ab I,  m_ab = ρ ∫ N_a N_b dV                     (consistent)
//! m_a  = Σ_b m_ab = ρ ∫ N_a dV                              (lumped, first order: row sums)
//! m_a  = m_aa · ρ V / Σ_b m_bb                              (lumped, second order)
//! ```
//!
//! Row sums of second-order elements are negative at corners; the diagonal scaled to the mass of the element is positive everywhere.
//! Source: Hinton, Rock, Zienkiewicz (1976), A note on mass lumping and related processes in the finite element method.
//! The integrals are exact on straight-sided elements.

use super::isoparametric::{determinant, jacobian};
use super::matrix::{Stiffness, block_index};
use super::table;
use crate::model::{ELEMENT_NODES_MAX, ElementKind};

/// Whether an element has midside nodes.
fn is_quadratic(kind: ElementKind) -> bool {
    !super::basis::edges(kind.shape()).is_empty()
}

/// Consistent mass of a solid, into `out` \[mass\]: multiples of the unit matrix.
pub fn consistent(kind: ElementKind, coordinates: &[[f64; 3]], density: f64, out: &mut Stiffness) {
    let table = table::of(kind);
    let n = table.count;
    let blocks = out.clear(n);
    for sample in &table.products {
        let mass = density * sample.weight * determinant(&jacobian(sample, coordinates));
        for a in 0..n {
            let share = mass * sample.basis.value[a];
            let row = &mut blocks[block_index(n, a, a)..block_index(n, a, n)];
            for (block, value) in row.iter_mut().zip(&sample.basis.value[a..n]) {
                block[0] += share * value;
            }
        }
    }
    for block in blocks {
        block[4] = block[0];
        block[8] = block[0];
    }
}

/// Mass of each node of a solid \[mass\]; all positive, their sum the mass of the element.
pub fn lumped(kind: ElementKind, coordinates: &[[f64; 3]], density: f64) -> Vec<f64> {
    if !is_quadratic(kind) {
        return super::nodal_volumes(kind, coordinates).into_iter().map(|volume| density * volume).collect();
    }
    let table = table::of(kind);
    let (mut diagonal, mut total) = ([0.0; ELEMENT_NODES_MAX], 0.0);
    for sample in &table.products {
        let mass = density * sample.weight * determinant(&jacobian(sample, coordinates));
        total += mass;
        for (sum, value) in diagonal.iter_mut().zip(&sample.basis.value) {
            *sum += mass * value * value;
        }
    }
    let diagonal = &diagonal[..table.count];
    let scale = total / diagonal.iter().sum::<f64>();
    diagonal.iter().map(|m| scale * m).collect()
}
