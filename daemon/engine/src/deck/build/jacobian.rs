//! Smallest Jacobian of a brick at its 2x2x2 integration points.
//!
//! The derivative of the position along a local axis depends on the other two local coordinates only, so four vectors
//! per axis serve all eight points.

/// Corner pairs along each local axis, ordered by the other two axes (second fastest for the first axis in cyclic order).
const EDGES: [[[usize; 2]; 4]; 3] = [
    // along ξ; (η, ζ) = (-,-) (+,-) (-,+) (+,+)
    [[0, 1], [3, 2], [4, 5], [7, 6]],
    // along η; (ζ, ξ) = (-,-) (+,-) (-,+) (+,+)
    [[0, 3], [4, 7], [1, 2], [5, 6]],
    // along ζ; (ξ, η) = (-,-) (+,-) (-,+) (+,+)
    [[0, 4], [1, 5], [3, 7], [2, 6]],
];

/// Smallest determinant of dx/dξ [length³] at the 2x2x2 Gauss points; an eighth of the volume for a box.
/// NaN never comes out: coordinates so large that the determinant overflows count as distorted.
pub fn jacobian_min(corners: &[[f64; 3]; 8]) -> f64 {
    // Weights of the two ends of an edge pair at a Gauss point: (1 ± 1/√3) / 2.
    let near = 0.5 + 0.5 / 3f64.sqrt();
    let far = 1.0 - near;
    // derivatives[axis][i + 2 j]: i and j select the low or high Gauss point on the two other axes.
    let derivatives = EDGES.map(|edges| {
        let half = edges.map(|[a, b]| std::array::from_fn::<f64, 3, _>(|k| 0.5 * (corners[b][k] - corners[a][k])));
        [[near, far], [far, near]].map(|[low_j, high_j]| {
            [[near, far], [far, near]].map(|[low_i, high_i]| {
                std::array::from_fn::<f64, 3, _>(|k| {
                    low_j * (low_i * half[0][k] + high_i * half[1][k])
                        + high_j * (low_i * half[2][k] + high_i * half[3][k])
                })
            })
        })
    });
    let mut smallest = f64::INFINITY;
    for (x, y, z) in (0..8).map(|point| (point & 1, point >> 1 & 1, point >> 2)) {
        let [a, b, c] = [&derivatives[0][z][y], &derivatives[1][x][z], &derivatives[2][y][x]];
        let cross = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]];
        let determinant = a[0] * cross[0] + a[1] * cross[1] + a[2] * cross[2];
        if determinant.is_nan() {
            return f64::NEG_INFINITY;
        }
        smallest = smallest.min(determinant);
    }
    smallest
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBE: [[f64; 3]; 8] = [
        [0., 0., 0.],
        [1., 0., 0.],
        [1., 1., 0.],
        [0., 1., 0.],
        [0., 0., 1.],
        [1., 0., 1.],
        [1., 1., 1.],
        [0., 1., 1.],
    ];

    /// Straight from the shape functions.
    fn reference(corners: &[[f64; 3]; 8]) -> f64 {
        let signs = CUBE.map(|c| c.map(|x| 2.0 * x - 1.0));
        let mut smallest = f64::INFINITY;
        for gauss in CUBE.map(|c| c.map(|x| (2.0 * x - 1.0) / 3f64.sqrt())) {
            let mut jacobian = [[0.0; 3]; 3];
            for (sign, corner) in signs.iter().zip(corners) {
                let factor = |k: usize| 1.0 + sign[k] * gauss[k];
                for (axis, row) in jacobian.iter_mut().enumerate() {
                    let slope = sign[axis] * factor((axis + 1) % 3) * factor((axis + 2) % 3) / 8.0;
                    row.iter_mut().zip(corner).for_each(|(entry, x)| *entry += slope * x);
                }
            }
            let [a, b, c] = jacobian;
            let determinant = a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]);
            smallest = smallest.min(determinant);
        }
        smallest
    }

    #[test]
    fn the_jacobian_agrees_with_the_shape_functions() {
        let mut seed = 7u64;
        let mut random = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 33) as f64 / (1u64 << 31) as f64 - 0.5
        };
        for _ in 0..200 {
            let corners = CUBE.map(|corner| corner.map(|x| x + random()));
            let (ours, expected) = (jacobian_min(&corners), reference(&corners));
            assert!((ours - expected).abs() < 1e-14, "{ours} is not {expected}");
        }
    }

    #[test]
    fn a_mirrored_brick_has_a_negative_jacobian() {
        assert!((jacobian_min(&CUBE) - 0.125).abs() < 1e-15);
        let mirrored = [4, 5, 6, 7, 0, 1, 2, 3].map(|i: usize| CUBE[i]);
        assert!(jacobian_min(&mirrored) < 0.0);
        assert!(jacobian_min(&[[f64::MAX; 3]; 8]) <= 0.0);
    }
}
