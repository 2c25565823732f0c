//! Bulk viscosity: a pressure that resists the rate of volume, `σ = b₁ ρ c L ε̇` and in compression also `−ρ (b₂ L ε̇)²`.
//!
//! It smears shocks over some elements and damps what shakes single elements. Not part of the stresses of results; what it
//! dissipates is. Source: Abaqus manual v6.5, 6.3.3, "Bulk viscosity".
//!
//! Bricks of eight nodes have the rate of volume at their centre, `g_a = Σ_r ξ_r(a) j_r` with `j_r = ∂ξ_r/∂x / 8`: three vectors
//! make the gradients of all nodes, half of what an increment would have to read otherwise.

use super::elements::Part;
use crate::element::brick::CORNER;
use crate::model::Model;

/// Elements with bulk viscosity.
#[derive(Default)]
pub struct BulkViscosity {
    bricks: Bricks,
    /// Start of each other element's nodes.
    starts: Vec<u32>,
    nodes: Vec<u32>,
    gradients: Vec<[f64; 3]>,
    /// `b₁ ρ c L V` and `b₂² ρ L² V` of each of them.
    coefficients: Vec<[f64; 2]>,
}

/// Bricks of eight nodes.
#[derive(Default)]
struct Bricks(Vec<Brick>);

struct Brick {
    nodes: [u32; 8],
    /// `j_r` [1/length].
    axes: [[f64; 3]; 3],
    /// As above.
    coefficients: [f64; 2],
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
            let nodes = model.mesh.elements.nodes(part.element as usize);
            // Of a density that is scaled: ρ c grows with its root.
            let linear = linear * volume.impedance * factor.sqrt() * volume.volume;
            let coefficients = [linear, quadratic * quadratic * volume.square * factor * volume.volume];
            if let (Ok(nodes), Ok(gradient)) = (<[_; 8]>::try_from(nodes), volume.gradient[..].try_into()) {
                out.bricks.0.push(Brick { nodes: nodes.map(|n| n.0), axes: axes(gradient), coefficients });
                continue;
            }
            out.nodes.extend(nodes.iter().map(|n| n.0));
            out.gradients.extend_from_slice(&volume.gradient);
            out.starts.push(out.nodes.len() as u32);
            out.coefficients.push(coefficients);
        }
        out
    }

    /// Whether nothing is damped.
    pub fn is_empty(&self) -> bool {
        self.coefficients.is_empty() && self.bricks.0.is_empty()
    }

    /// Numbers of eight bytes that it holds.
    pub fn numbers(&self) -> usize {
        let others =
            self.starts.len() / 2 + self.nodes.len() / 2 + 3 * self.gradients.len() + 2 * self.coefficients.len();
        others + size_of_val(&self.bricks.0[..]) / 8
    }

    /// Adds the nodal forces at some velocities; returns the largest ratio of the quadratic part to the linear one.
    pub fn resist(&self, velocity: &[[f64; 3]], forces: &mut [[f64; 3]]) -> f64 {
        let (mut start, mut ratio) = (0, self.bricks.resist(velocity, forces));
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

/// `j_r = Σ_a ξ_r(a) g_a / 8`, the only three vectors that the gradients at the centre of a brick are made of.
fn axes(gradient: &[[f64; 3]; 8]) -> [[f64; 3]; 3] {
    let part = |r: usize, d: usize| CORNER.iter().zip(gradient).map(|(c, g)| c[r] * g[d]).sum::<f64>() / 8.0;
    std::array::from_fn(|r| std::array::from_fn(|d| part(r, d)))
}

impl Bricks {
    /// As [`BulkViscosity::resist`]. Nodes are taken in pairs along ξ, whose sums and differences make the three products.
    fn resist(&self, velocity: &[[f64; 3]], forces: &mut [[f64; 3]]) -> f64 {
        let mut ratio = 0.0f64;
        for Brick { nodes, axes, coefficients: [linear, quadratic] } in &self.0 {
            let [n0, n1, n2, n3, n4, n5, n6, n7] = nodes.map(|n| n as usize);
            let pair = |a: usize, b: usize| (add(velocity[a], velocity[b]), sub(velocity[b], velocity[a]));
            let [(s0, d0), (s1, d1), (s2, d2), (s3, d3)] = [pair(n0, n1), pair(n3, n2), pair(n4, n5), pair(n7, n6)];
            let along = [add(add(d0, d1), add(d2, d3)), add(sub(s1, s0), sub(s3, s2)), sub(add(s2, s3), add(s0, s1))];
            let rate = dot(axes[0], along[0]) + dot(axes[1], along[1]) + dot(axes[2], along[2]);
            let squeezed = quadratic * (-rate).max(0.0);
            if squeezed > ratio * linear && *linear > 0.0 {
                ratio = squeezed / linear;
            }
            let pull = rate * (linear + squeezed);
            let [x, y, z] = axes.map(|axis| axis.map(|j| pull * j));
            let (sum, difference) = (add(x, y), sub(x, y));
            // Against −x −y −z, x −y −z, …: the signs of the corners.
            for (a, b, force) in [
                (n0, n6, add(sum, z)),
                (n1, n7, sub(z, difference)),
                (n2, n4, sub(z, sum)),
                (n3, n5, add(difference, z)),
            ] {
                forces[a] = add(forces[a], force);
                forces[b] = sub(forces[b], force);
            }
        }
        ratio
    }
}

#[inline(always)]
fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::dilatation;
    use crate::model::ElementKind;

    #[test]
    fn three_vectors_make_the_forces_of_all_eight_gradients() {
        let bend = |[x, y, z]: [f64; 3]| [x + 0.1 * y * z, 0.8 * y - 0.1 * x * z, 1.2 * z + 0.05 * x * y];
        let corners = CORNER.map(bend);
        let volume = dilatation::of(ElementKind::C3D8, &corners);
        let gradient: [[f64; 3]; 8] = volume.gradient[..].try_into().expect("a brick has eight nodes");
        // Nodes that are not in order, in two bricks that have a node in common.
        let nodes = [[3, 0, 7, 1, 2, 6, 4, 5], [8, 9, 10, 11, 12, 13, 14, 3]];
        let coefficients = [0.7, 2.5];
        let bricks = Bricks(nodes.map(|nodes| Brick { nodes, axes: axes(&gradient), coefficients }).into());
        let wave = |i: usize, f: f64| std::array::from_fn(|d| ((3 * i + d) as f64 * f).sin());
        let velocity: Vec<[f64; 3]> = (0..15).map(|i| wave(i, 0.7)).collect();
        let mut forces: Vec<[f64; 3]> = (0..15).map(|i| wave(i, 0.3)).collect();
        let mut wanted = forces.clone();
        let mut largest = 0.0f64;
        for nodes in nodes.map(|n| n.map(|n| n as usize)) {
            let rate: f64 = nodes.iter().zip(&gradient).map(|(&n, g)| dot(velocity[n], *g)).sum();
            let squeezed = 2.5 * (-rate).max(0.0);
            largest = largest.max(squeezed / 0.7);
            for (&n, g) in nodes.iter().zip(&gradient) {
                wanted[n] = sub(wanted[n], g.map(|g| rate * (0.7 + squeezed) * g));
            }
        }
        let ratio = bricks.resist(&velocity, &mut forces);
        assert!((ratio - largest).abs() < 1e-14);
        for (f, w) in forces.as_flattened().iter().zip(wanted.as_flattened()) {
            assert!((f - w).abs() < 1e-14, "{f} {w}");
        }
    }
}
