//! Hexahedra of eight and twenty nodes on [-1, 1]³: shape functions and rules. The stiffness of the eight-node kinds is in
//! `brick.rs`, `incompatible.rs` and `uniform_strain.rs`.

use super::basis::Basis;
use super::brick::CORNER;

/// Corners on either side of the midside nodes 9 to 20.
pub const EDGE: [[usize; 2]; 12] =
    [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];

/// Two Gauss points on a line.
pub const GAUSS_2: [(f64, f64); 2] = [(-0.577_350_269_189_625_8, 1.0), (0.577_350_269_189_625_8, 1.0)];

/// Three Gauss points on a line.
pub const GAUSS_3: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];

/// Four Gauss points on a line.
pub const GAUSS_4: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    (-0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];

/// Eight nodes.
pub fn linear(natural: [f64; 3]) -> Basis {
    let mut basis = Basis::ZERO;
    for (a, c) in CORNER.iter().enumerate() {
        let f: [f64; 3] = std::array::from_fn(|i| 1.0 + c[i] * natural[i]);
        let slope = [c[0] * f[1] * f[2], c[1] * f[0] * f[2], c[2] * f[0] * f[1]];
        basis.set(a, 0.125 * f[0] * f[1] * f[2], slope.map(|s| 0.125 * s));
    }
    basis
}

/// Twenty nodes.
pub fn quadratic(natural: [f64; 3]) -> Basis {
    let mut basis = Basis::ZERO;
    for (a, c) in CORNER.iter().enumerate() {
        let f: [f64; 3] = std::array::from_fn(|i| 1.0 + c[i] * natural[i]);
        let plane = c[0] * natural[0] + c[1] * natural[1] + c[2] * natural[2] - 2.0;
        let slope = std::array::from_fn(|i| 0.125 * c[i] * f[(i + 1) % 3] * f[(i + 2) % 3] * (plane + f[i]));
        basis.set(a, 0.125 * f[0] * f[1] * f[2] * plane, slope);
    }
    for (e, [first, second]) in EDGE.into_iter().enumerate() {
        // Along the edge a parabola, across it the bilinear function of its place.
        let c: [f64; 3] = std::array::from_fn(|i| 0.5 * (CORNER[first][i] + CORNER[second][i]));
        let factor = |i: usize| {
            if c[i] == 0.0 {
                (1.0 - natural[i] * natural[i], -2.0 * natural[i])
            } else {
                (1.0 + c[i] * natural[i], c[i])
            }
        };
        let (x, y, z) = (factor(0), factor(1), factor(2));
        let slope = [x.1 * y.0 * z.0, x.0 * y.1 * z.0, x.0 * y.0 * z.1];
        basis.set(8 + e, 0.25 * x.0 * y.0 * z.0, slope.map(|s| 0.25 * s));
    }
    basis
}

fn product(line: &[(f64, f64)]) -> Vec<([f64; 3], f64)> {
    let mut rule = Vec::with_capacity(line.len().pow(3));
    for &(z, w) in line {
        for &(y, v) in line {
            rule.extend(line.iter().map(|&(x, u)| ([x, y, z], u * v * w)));
        }
    }
    rule
}

/// 2 x 2 x 2 Gauss points.
pub fn rule_8() -> Vec<([f64; 3], f64)> {
    product(&GAUSS_2)
}

/// 3 x 3 x 3 Gauss points.
pub fn rule_27() -> Vec<([f64; 3], f64)> {
    product(&GAUSS_3)
}

/// 4 x 4 x 4 Gauss points.
pub fn rule_64() -> Vec<([f64; 3], f64)> {
    product(&GAUSS_4)
}
