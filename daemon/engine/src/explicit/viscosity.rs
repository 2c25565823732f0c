//! Bulk viscosity: a pressure that resists the rate of volume, `σ = b₁ ρ c L ε̇` and in compression also `−ρ (b₂ L ε̇)²`.
//!
//! It smears shocks over some elements and damps what shakes single elements. Not part of the stresses of results; what it
//! dissipates is. Source: Abaqus manual v6.5, 6.3.3, "Bulk viscosity".

use super::elements::Part;
use crate::model::Model;

/// Elements with bulk viscosity, one after another.
#[derive(Default)]
pub struct BulkViscosity {
    /// Start of each element's nodes.
    starts: Vec<u32>,
    nodes: Vec<u32>,
    gradients: Vec<[f64; 3]>,
    /// `b₁ ρ c L V` and `b₂² ρ L² V` of each element.
    coefficients: Vec<[f64; 2]>,
}

impl BulkViscosity {
    /// Of elements with their mass scaled; nothing where both parameters are zero.
    pub fn new(model: &Model, parts: &[Part], factors: &[f64], [linear, quadratic]: [f64; 2]) -> Self {
        let mut out = Self { starts: vec![0], ..Self::default() };
        if linear == 0.0 && quadratic == 0.0 {
            return out;
        }
        for (part, factor) in parts.iter().zip(factors) {
            let Some(volume) = &part.volume else { continue };
            out.nodes.extend(model.mesh.elements.nodes(part.element as usize).iter().map(|n| n.0));
            out.gradients.extend_from_slice(&volume.gradient);
            out.starts.push(out.nodes.len() as u32);
            // Of a density that is scaled: ρ c grows with its root.
            let linear = linear * volume.impedance * factor.sqrt() * volume.volume;
            out.coefficients.push([linear, quadratic * quadratic * volume.square * factor * volume.volume]);
        }
        out
    }

    /// Whether nothing is damped.
    pub fn is_empty(&self) -> bool {
        self.coefficients.is_empty()
    }

    /// Numbers of eight bytes that it holds.
    pub fn numbers(&self) -> usize {
        self.starts.len() / 2 + self.nodes.len() / 2 + 3 * self.gradients.len() + 2 * self.coefficients.len()
    }

    /// Adds the nodal forces at some velocities; returns the largest ratio of the quadratic part to the linear one.
    pub fn resist(&self, velocity: &[[f64; 3]], forces: &mut [[f64; 3]]) -> f64 {
        let (mut start, mut ratio) = (0, 0.0f64);
        for (&end, &[linear, quadratic]) in self.starts[1..].iter().zip(&self.coefficients) {
            let range = start as usize..end as usize;
            start = end;
            let (nodes, gradients) = (&self.nodes[range.clone()], &self.gradients[range]);
            let mut rate = 0.0;
            for (&node, g) in nodes.iter().zip(gradients) {
                let v = &velocity[node as usize];
                rate += g[0] * v[0] + g[1] * v[1] + g[2] * v[2];
            }
            let squeezed = quadratic * (-rate).max(0.0);
            if squeezed > ratio * linear && linear > 0.0 {
                ratio = squeezed / linear;
            }
            let pull = rate * (linear + squeezed);
            for (&node, g) in nodes.iter().zip(gradients) {
                let f = &mut forces[node as usize];
                for d in 0..3 {
                    f[d] -= pull * g[d];
                }
            }
        }
        ratio
    }
}
