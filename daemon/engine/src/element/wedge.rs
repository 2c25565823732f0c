//! Wedges of six and fifteen nodes: a triangle `ξ, η ≥ 0, ξ + η ≤ 1` times `ζ` in [-1, 1].

use super::basis::Basis;
use super::hexahedron::{GAUSS_2, GAUSS_3, GAUSS_4};

/// Natural coordinates of the corners.
pub const CORNER: [[f64; 3]; 6] =
    [[0.0, 0.0, -1.0], [1.0, 0.0, -1.0], [0.0, 1.0, -1.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];

/// Corners on either side of the midside nodes 7 to 15.
pub const EDGE: [[usize; 2]; 9] = [[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]];

/// Derivatives of the area coordinates.
const SLOPE: [[f64; 2]; 3] = [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]];

/// Six nodes.
pub fn linear([x, y, z]: [f64; 3]) -> Basis {
    let l = [1.0 - x - y, x, y];
    let mut basis = Basis::ZERO;
    for (level, sign) in [(0, -1.0), (1, 1.0)] {
        let f = 0.5 * (1.0 + sign * z);
        for t in 0..3 {
            basis.set(3 * level + t, l[t] * f, [SLOPE[t][0] * f, SLOPE[t][1] * f, 0.5 * sign * l[t]]);
        }
    }
    basis
}

/// Fifteen nodes.
pub fn quadratic([x, y, z]: [f64; 3]) -> Basis {
    let l = [1.0 - x - y, x, y];
    let bubble = 1.0 - z * z;
    let mut basis = Basis::ZERO;
    for (level, sign) in [(0, -1.0), (1, 1.0)] {
        let f = 0.5 * (1.0 + sign * z);
        for t in 0..3 {
            // L (2 L − 1) f − L (1 − ζ²) / 2
            let by_l = (4.0 * l[t] - 1.0) * f - 0.5 * bubble;
            let by_z = 0.5 * sign * l[t] * (2.0 * l[t] - 1.0) + l[t] * z;
            let value = l[t] * (2.0 * l[t] - 1.0) * f - 0.5 * l[t] * bubble;
            basis.set(3 * level + t, value, [SLOPE[t][0] * by_l, SLOPE[t][1] * by_l, by_z]);
            let n = (t + 1) % 3;
            let slope = |i: usize| 4.0 * (SLOPE[t][i] * l[n] + l[t] * SLOPE[n][i]) * f;
            basis.set(6 + 3 * level + t, 4.0 * l[t] * l[n] * f, [slope(0), slope(1), 2.0 * sign * l[t] * l[n]]);
        }
    }
    for t in 0..3 {
        basis.set(12 + t, l[t] * bubble, [SLOPE[t][0] * bubble, SLOPE[t][1] * bubble, -2.0 * z * l[t]]);
    }
    basis
}

/// Points of a triangle times points along ζ.
fn product(triangle: &[([f64; 2], f64)], line: &[(f64, f64)]) -> Vec<([f64; 3], f64)> {
    line.iter().flat_map(|&(z, w)| triangle.iter().map(move |&([x, y], v)| ([x, y, z], v * w))).collect()
}

/// One point of the triangle, exact for linear functions.
const CENTRE: [([f64; 2], f64); 1] = [([1.0 / 3.0, 1.0 / 3.0], 0.5)];

/// Three points of the triangle, exact for quadratic functions.
const THREE: [([f64; 2], f64); 3] =
    [([1.0 / 6.0, 1.0 / 6.0], 1.0 / 6.0), ([2.0 / 3.0, 1.0 / 6.0], 1.0 / 6.0), ([1.0 / 6.0, 2.0 / 3.0], 1.0 / 6.0)];

/// Seven points of the triangle, exact for polynomials of degree 5. Source: Radon (1948).
fn seven() -> [([f64; 2], f64); 7] {
    let root = 15f64.sqrt();
    let (near, far) = ((6.0 - root) / 21.0, (6.0 + root) / 21.0);
    let (light, heavy) = ((155.0 - root) / 2400.0, (155.0 + root) / 2400.0);
    [
        ([1.0 / 3.0, 1.0 / 3.0], 9.0 / 80.0),
        ([near, near], light),
        ([1.0 - 2.0 * near, near], light),
        ([near, 1.0 - 2.0 * near], light),
        ([far, far], heavy),
        ([1.0 - 2.0 * far, far], heavy),
        ([far, 1.0 - 2.0 * far], heavy),
    ]
}

/// Two points on the axis.
pub fn rule_2() -> Vec<([f64; 3], f64)> {
    product(&CENTRE, &GAUSS_2)
}

/// Three points on two levels.
pub fn rule_6() -> Vec<([f64; 3], f64)> {
    product(&THREE, &GAUSS_2)
}

/// Three points on three levels.
pub fn rule_9() -> Vec<([f64; 3], f64)> {
    product(&THREE, &GAUSS_3)
}

/// Seven points on three levels.
pub fn rule_21() -> Vec<([f64; 3], f64)> {
    product(&seven(), &GAUSS_3)
}

/// Seven points on four levels.
pub fn rule_28() -> Vec<([f64; 3], f64)> {
    product(&seven(), &GAUSS_4)
}
