//! Shape functions of every element shape, with their derivatives by the natural coordinates.
//!
//! Tetrahedra and the triangles of wedges live on `ξ, η(, ζ) ≥ 0, ξ + η (+ ζ) ≤ 1`; everything else on [-1, 1].

use crate::model::{ELEMENT_NODES_MAX, ElementShape};

/// Shape functions at one point; entries beyond the node count are zero.
#[derive(Clone, Copy, Debug)]
pub struct Basis {
    /// N_a.
    pub value: [f64; ELEMENT_NODES_MAX],
    /// ∂N_a/∂ξ, ∂N_a/∂η, ∂N_a/∂ζ.
    pub derivative: [[f64; 3]; ELEMENT_NODES_MAX],
}

impl Basis {
    pub(super) const ZERO: Self = Self { value: [0.0; ELEMENT_NODES_MAX], derivative: [[0.0; 3]; ELEMENT_NODES_MAX] };

    pub(super) fn set(&mut self, node: usize, value: f64, derivative: [f64; 3]) {
        self.value[node] = value;
        self.derivative[node] = derivative;
    }
}

/// Shape functions of a shape.
pub fn evaluate(shape: ElementShape, natural: [f64; 3]) -> Basis {
    match shape {
        ElementShape::Tetrahedron4 => super::tetrahedron::linear(natural),
        ElementShape::Tetrahedron10 => super::tetrahedron::quadratic(natural),
        ElementShape::Wedge6 => super::wedge::linear(natural),
        ElementShape::Wedge15 => super::wedge::quadratic(natural),
        ElementShape::Hexahedron8 => super::hexahedron::linear(natural),
        ElementShape::Hexahedron20 => super::hexahedron::quadratic(natural),
        ElementShape::Line2 | ElementShape::Point1 | ElementShape::Triangle3 | ElementShape::Quadrilateral4 => {
            unreachable!("only solids have shape functions")
        }
    }
}

/// Corners on either side of each midside node, in their order; none where a shape has no midside nodes.
pub fn edges(shape: ElementShape) -> &'static [[usize; 2]] {
    match shape {
        ElementShape::Tetrahedron10 => &super::tetrahedron::EDGE,
        ElementShape::Wedge15 => &super::wedge::EDGE,
        ElementShape::Hexahedron20 => &super::hexahedron::EDGE,
        _ => &[],
    }
}

/// Natural coordinates of a node: of a corner, or halfway between two.
pub fn node(shape: ElementShape, node: usize) -> [f64; 3] {
    let corners: &[[f64; 3]] = match shape {
        ElementShape::Tetrahedron4 | ElementShape::Tetrahedron10 => &super::tetrahedron::CORNER,
        ElementShape::Wedge6 | ElementShape::Wedge15 => &super::wedge::CORNER,
        ElementShape::Hexahedron8 | ElementShape::Hexahedron20 => &super::brick::CORNER,
        ElementShape::Line2 | ElementShape::Point1 | ElementShape::Triangle3 | ElementShape::Quadrilateral4 => {
            unreachable!("only solids have natural coordinates")
        }
    };
    match node.checked_sub(corners.len()) {
        None => corners[node],
        Some(edge) => {
            let [a, b] = edges(shape)[edge].map(|corner| corners[corner]);
            std::array::from_fn(|i| 0.5 * (a[i] + b[i]))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::ElementKind;

    #[test]
    fn shape_functions_are_one_at_their_node_and_add_up_to_one() {
        for kind in ElementKind::SOLIDS {
            let shape = kind.shape();
            for a in 0..shape.node_count() {
                let basis = evaluate(shape, node(shape, a));
                for b in 0..ELEMENT_NODES_MAX {
                    assert!((basis.value[b] - f64::from(u8::from(a == b))).abs() < 1e-15, "{shape:?} {a} {b}");
                }
            }
            let basis = evaluate(shape, [0.21, 0.17, 0.3]);
            assert!((basis.value.iter().sum::<f64>() - 1.0).abs() < 1e-14, "{shape:?}");
        }
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let at = [0.21, 0.17, 0.3];
        for kind in ElementKind::SOLIDS {
            let shape = kind.shape();
            let basis = evaluate(shape, at);
            for d in 0..3 {
                let shifted = |by: f64| {
                    let mut natural = at;
                    natural[d] += by;
                    evaluate(shape, natural).value
                };
                let (up, down) = (shifted(1e-5), shifted(-1e-5));
                for a in 0..ELEMENT_NODES_MAX {
                    let slope = (up[a] - down[a]) / 2e-5;
                    assert!((slope - basis.derivative[a][d]).abs() < 1e-9, "{shape:?} node {a} direction {d}");
                }
            }
        }
    }
}
