//! Quadrature tables of every kind: shape functions at integration points, made once.

use std::sync::LazyLock;

use super::basis::{self, Basis};
use super::{hexahedron, tetrahedron, wedge};
use crate::model::{ElementKind, ElementShape};

/// An integration point with the shape functions there.
pub struct Sample {
    /// Weight on the parent shape.
    pub weight: f64,
    /// Shape functions.
    pub basis: Basis,
}

/// What does not depend on the coordinates of an element.
pub struct Table {
    /// Number of nodes.
    pub count: usize,
    /// Points of stiffness and stress.
    pub points: Vec<Sample>,
    /// Further points where the volume must be positive: those that CalculiX takes for masses.
    pub further: Vec<Sample>,
    /// Points of masses and nodal volumes: enough for products of two shape functions times volume on straight-sided elements.
    pub products: Vec<Sample>,
    /// Row per node, column per stress point: the least-squares polynomial through the points, at the nodes.
    pub extrapolation: Vec<Vec<f64>>,
}

type Rule = Vec<([f64; 3], f64)>;

static TABLES: LazyLock<Vec<Table>> = LazyLock::new(|| ElementKind::SOLIDS.into_iter().map(Table::new).collect());

/// The table of a kind. The stress points of C3D8R are those of its one-point field.
pub fn of(kind: ElementKind) -> &'static Table {
    // The discriminants follow the order of `SOLIDS`; a test holds it.
    &TABLES[kind as usize]
}

fn samples(shape: ElementShape, rule: &Rule) -> Vec<Sample> {
    rule.iter().map(|&(natural, weight)| Sample { weight, basis: basis::evaluate(shape, natural) }).collect()
}

impl Table {
    fn new(kind: ElementKind) -> Self {
        let shape = kind.shape();
        let (rule, further): (Rule, Rule) = match kind {
            ElementKind::C3D4 => (tetrahedron::rule_1(), tetrahedron::rule_4()),
            ElementKind::C3D10 => (tetrahedron::rule_4(), tetrahedron::rule_4()),
            ElementKind::C3D6 => (wedge::rule_2(), wedge::rule_6()),
            ElementKind::C3D15 => (wedge::rule_9(), wedge::rule_9()),
            ElementKind::C3D8 | ElementKind::C3D8Full | ElementKind::C3D8I => {
                (hexahedron::rule_8(), hexahedron::rule_8())
            }
            ElementKind::C3D8R | ElementKind::C3D8RCalculix => (vec![([0.0; 3], 8.0)], hexahedron::rule_8()),
            ElementKind::C3D20 => (hexahedron::rule_27(), hexahedron::rule_27()),
            ElementKind::C3D20R => (hexahedron::rule_8(), hexahedron::rule_27()),
            _ => unreachable!("only solids have tables"),
        };
        Self {
            count: shape.node_count(),
            points: samples(shape, &rule),
            further: samples(shape, &further),
            products: samples(shape, &products(shape)),
            extrapolation: extrapolation(kind, &rule),
        }
    }
}

/// Rule that integrates products of two shape functions times the volume of a straight-sided element.
fn products(shape: ElementShape) -> Rule {
    match shape {
        ElementShape::Tetrahedron4 => tetrahedron::rule_4(),
        ElementShape::Tetrahedron10 => tetrahedron::rule_14(),
        ElementShape::Wedge6 => wedge::rule_21(),
        ElementShape::Wedge15 => wedge::rule_28(),
        ElementShape::Hexahedron8 => hexahedron::rule_27(),
        ElementShape::Hexahedron20 => hexahedron::rule_64(),
        ElementShape::Line2 | ElementShape::Point1 | ElementShape::Triangle3 | ElementShape::Quadrilateral4 => {
            unreachable!("only solids have tables")
        }
    }
}

/// Polynomials that the stresses of a kind are taken for.
fn monomials(kind: ElementKind, [x, y, z]: [f64; 3]) -> Vec<f64> {
    match kind {
        ElementKind::C3D4 | ElementKind::C3D8R | ElementKind::C3D8RCalculix => vec![1.0],
        ElementKind::C3D6 => vec![1.0, z],
        ElementKind::C3D10 => vec![1.0, x, y, z],
        ElementKind::C3D15 => vec![1.0, x, y, z, x * z, y * z],
        _ => vec![1.0, x, y, z, x * y, y * z, z * x, x * y * z],
    }
}

/// Φ_nodes (Φᵀ Φ)⁻¹ Φᵀ with the monomials Φ at the points.
fn extrapolation(kind: ElementKind, rule: &Rule) -> Vec<Vec<f64>> {
    let at_points: Vec<Vec<f64>> = rule.iter().map(|&(natural, _)| monomials(kind, natural)).collect();
    let m = at_points[0].len();
    let mut normal = vec![vec![0.0; m]; m];
    for row in &at_points {
        for i in 0..m {
            for j in 0..m {
                normal[i][j] += row[i] * row[j];
            }
        }
    }
    let at_nodes = |a: usize| monomials(kind, basis::node(kind.shape(), a));
    (0..kind.node_count())
        .map(|a| {
            let weights = solve(normal.clone(), at_nodes(a));
            at_points.iter().map(|row| row.iter().zip(&weights).map(|(p, w)| p * w).sum()).collect()
        })
        .collect()
}

/// Solves a small symmetric positive definite system by elimination.
fn solve(mut matrix: Vec<Vec<f64>>, mut rhs: Vec<f64>) -> Vec<f64> {
    let n = rhs.len();
    for k in 0..n {
        for i in k + 1..n {
            let factor = matrix[i][k] / matrix[k][k];
            for j in k..n {
                matrix[i][j] -= factor * matrix[k][j];
            }
            rhs[i] -= factor * rhs[k];
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| matrix[k][j] * rhs[j]).sum();
        rhs[k] = (rhs[k] - known) / matrix[k][k];
    }
    rhs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_stand_in_the_order_of_the_kinds() {
        for (position, kind) in ElementKind::SOLIDS.into_iter().enumerate() {
            assert_eq!(kind as usize, position);
            assert_eq!(of(kind).count, kind.node_count());
        }
    }

    #[test]
    fn weights_add_up_to_the_volume_of_the_parent() {
        for kind in ElementKind::SOLIDS {
            let volume = match kind.shape() {
                ElementShape::Tetrahedron4 | ElementShape::Tetrahedron10 => 1.0 / 6.0,
                ElementShape::Wedge6 | ElementShape::Wedge15 => 1.0,
                _ => 8.0,
            };
            for points in [&of(kind).points, &of(kind).further, &of(kind).products] {
                assert!((points.iter().map(|p| p.weight).sum::<f64>() - volume).abs() < 1e-14, "{kind:?}");
            }
        }
    }

    #[test]
    fn extrapolation_keeps_what_the_polynomial_can_be() {
        for kind in ElementKind::SOLIDS {
            let table = of(kind);
            for row in &table.extrapolation {
                assert!((row.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{kind:?}");
            }
        }
        // A field linear in ζ, on the nodes of a twenty-node brick.
        let table = of(ElementKind::C3D20);
        let field: Vec<f64> = hexahedron::rule_27().iter().map(|(natural, _)| 1.0 + 2.0 * natural[2]).collect();
        for (a, row) in table.extrapolation.iter().enumerate() {
            let value: f64 = row.iter().zip(&field).map(|(e, f)| e * f).sum();
            assert!((value - 1.0 - 2.0 * basis::node(ElementShape::Hexahedron20, a)[2]).abs() < 1e-13);
        }
    }
}
