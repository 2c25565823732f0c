//! Tetrahedra of four and ten nodes on `ξ, η, ζ ≥ 0, ξ + η + ζ ≤ 1`.

use super::basis::Basis;

/// Natural coordinates of the corners.
pub const CORNER: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Corners on either side of the midside nodes 5 to 10.
pub const EDGE: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

/// Derivatives of the volume coordinates.
const SLOPE: [[f64; 3]; 4] = [[-1.0, -1.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn volume_coordinates([x, y, z]: [f64; 3]) -> [f64; 4] {
    [1.0 - x - y - z, x, y, z]
}

/// Four nodes.
pub fn linear(natural: [f64; 3]) -> Basis {
    let mut basis = Basis::ZERO;
    for (a, l) in volume_coordinates(natural).into_iter().enumerate() {
        basis.set(a, l, SLOPE[a]);
    }
    basis
}

/// Ten nodes.
pub fn quadratic(natural: [f64; 3]) -> Basis {
    let l = volume_coordinates(natural);
    let mut basis = Basis::ZERO;
    for a in 0..4 {
        basis.set(a, l[a] * (2.0 * l[a] - 1.0), SLOPE[a].map(|s| (4.0 * l[a] - 1.0) * s));
    }
    for (e, [a, b]) in EDGE.into_iter().enumerate() {
        let slope = std::array::from_fn(|i| 4.0 * (SLOPE[a][i] * l[b] + l[a] * SLOPE[b][i]));
        basis.set(4 + e, 4.0 * l[a] * l[b], slope);
    }
    basis
}

/// One point: exact for linear functions.
pub fn rule_1() -> Vec<([f64; 3], f64)> {
    vec![([0.25; 3], 1.0 / 6.0)]
}

/// Four points: exact for quadratic functions.
pub fn rule_4() -> Vec<([f64; 3], f64)> {
    let far = (5.0 + 3.0 * 5f64.sqrt()) / 20.0;
    let near = (5.0 - 5f64.sqrt()) / 20.0;
    (0..4).map(|a| (CORNER[a].map(|c| near + (far - near) * c), 1.0 / 24.0)).collect()
}

/// Fourteen points: exact for polynomials of degree 5. Source: Walkington (2000), Quadrature on simplices of arbitrary dimension.
pub fn rule_14() -> Vec<([f64; 3], f64)> {
    // Along the medians, either side of the centroid: three volume coordinates are equal.
    const MEDIAN: [(f64, f64); 2] =
        [(0.310_885_919_263_300_6, 0.018_781_320_953_002_643), (0.092_735_250_310_891_23, 0.012_248_840_519_393_659)];
    // Between the midpoints of opposite edges: two pairs are equal.
    const BETWEEN: (f64, f64) = (0.045_503_704_125_649_65, 0.007_091_003_462_846_911);
    let mut rule = Vec::with_capacity(14);
    for (equal, weight) in MEDIAN {
        rule.extend(CORNER.map(|corner| (corner.map(|c| equal + (1.0 - 4.0 * equal) * c), weight)));
    }
    let (equal, weight) = BETWEEN;
    for edge in EDGE {
        let at = |i: usize| edge.iter().map(|&corner| CORNER[corner][i]).sum::<f64>();
        rule.push((std::array::from_fn(|i| equal + (0.5 - 2.0 * equal) * at(i)), weight));
    }
    rule
}
