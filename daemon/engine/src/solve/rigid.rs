//! Rigid motions of a body that its supports do not hold.

use super::linear::eigen;
use crate::model::{Mesh, NodeId};

/// A motion counts as free when the supports resist it by less than this part of the best-held motion.
const HELD_RELATIVE_MIN: f64 = 1e-12;

/// Motions in words that no prescribed direction of the body resists; empty for a held body.
///
/// With r the position from the centroid over the size of the body, direction d of a node moves by
/// `t_d + (ω x r)_d`. The Gram matrix of these rows over the prescribed directions has the free motions as its kernel.
pub fn free_motions(mesh: &Mesh, nodes: &[NodeId], prescribed: impl Fn(NodeId, usize) -> bool) -> Vec<String> {
    let count = nodes.len() as f64;
    let mut centroid = [0.0; 3];
    for n in nodes {
        for i in 0..3 {
            centroid[i] += mesh.nodes[n.index()][i] / count;
        }
    }
    let offset = |n: NodeId| -> [f64; 3] { std::array::from_fn(|i| mesh.nodes[n.index()][i] - centroid[i]) };
    let size = nodes.iter().flat_map(|&n| offset(n)).fold(0.0f64, |m, x| m.max(x.abs())).max(f64::MIN_POSITIVE);
    let mut gram = [[0.0; 6]; 6];
    for &n in nodes {
        let r = offset(n).map(|x| x / size);
        let rotations = [[0.0, -r[2], r[1]], [r[2], 0.0, -r[0]], [-r[1], r[0], 0.0]];
        for d in (0..3).filter(|&d| prescribed(n, d)) {
            let mut row = [0.0; 6];
            row[d] = 1.0;
            for (axis, rotation) in rotations.iter().enumerate() {
                row[3 + axis] = rotation[d];
            }
            for i in 0..6 {
                for j in 0..6 {
                    gram[i][j] += row[i] * row[j];
                }
            }
        }
    }
    let (values, vectors) = eigen(&gram);
    let limit = HELD_RELATIVE_MIN * values[5];
    let kernel: Vec<&[f64; 6]> = values.iter().zip(&vectors).filter(|(v, _)| **v <= limit).map(|(_, x)| x).collect();
    if kernel.is_empty() {
        return Vec::new();
    }
    let resisted = |motion: &[f64; 6]| -> f64 {
        (0..6).map(|i| motion[i] * (0..6).map(|j| gram[i][j] * motion[j]).sum::<f64>()).sum()
    };
    // Motions along and about the axes first; what they do not span is given in numbers.
    let mut words = Vec::new();
    let mut named: Vec<[f64; 6]> = Vec::new();
    for k in 0..6 {
        let mut motion = [0.0; 6];
        motion[k] = 1.0;
        if resisted(&motion) <= limit {
            let kind = if k < 3 { "translation along" } else { "rotation about" };
            words.push(format!("{kind} {}", k % 3 + 1));
            named.push(motion);
        }
    }
    for vector in kernel {
        let mut rest = *vector;
        for known in &named {
            let along: f64 = rest.iter().zip(known).map(|(r, k)| r * k).sum();
            rest.iter_mut().zip(known).for_each(|(r, k)| *r -= along * k);
        }
        let length = rest.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length > 1e-6 {
            let motion = rest.map(|x| x / length);
            words.push(in_numbers(&motion, centroid, size));
            named.push(motion);
        }
    }
    words
}

/// A motion that is not one along or about an axis through the centroid.
fn in_numbers(motion: &[f64; 6], centroid: [f64; 3], size: f64) -> String {
    let (t, w) = (&motion[..3], &motion[3..]);
    let direction = |v: &[f64]| {
        let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let part = |i: usize| round(v[i] / length, 1.0);
        format!("({:.3}, {:.3}, {:.3})", part(0), part(1), part(2))
    };
    if w.iter().map(|x| x * x).sum::<f64>() <= 1e-12 {
        return format!("translation along {}", direction(t));
    }
    let through: [f64; 3] = std::array::from_fn(|i| round(centroid[i] + size * axis_point(t, w, i), size));
    format!(
        "rotation about the direction {} through ({:.4e}, {:.4e}, {:.4e})",
        direction(w),
        through[0],
        through[1],
        through[2]
    )
}

/// Zero instead of a coordinate that is rounding against the size of the body.
fn round(coordinate: f64, size: f64) -> f64 {
    if coordinate.abs() < 1e-9 * size { 0.0 } else { coordinate }
}

/// Point of the axis of a motion nearest to the centroid: `ω x t / ω²`.
fn axis_point(t: &[f64], w: &[f64], i: usize) -> f64 {
    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
    (w[j] * t[k] - w[k] * t[j]) / w.iter().map(|x| x * x).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> (Mesh, Vec<NodeId>) {
        let mut mesh = Mesh::default();
        for k in 0..2 {
            for j in 0..2 {
                for i in 0..2 {
                    mesh.nodes.push([f64::from(i), f64::from(j), f64::from(k)]);
                }
            }
        }
        (mesh, (0..8).map(NodeId).collect())
    }

    #[test]
    fn a_clamped_face_holds_everything() {
        let (mesh, nodes) = cube();
        assert!(free_motions(&mesh, &nodes, |n, _| n.0 < 4).is_empty());
    }

    #[test]
    fn a_body_without_supports_has_all_six() {
        let (mesh, nodes) = cube();
        assert_eq!(free_motions(&mesh, &nodes, |_, _| false).len(), 6);
    }

    #[test]
    fn rollers_leave_the_translation_along_them() {
        let (mesh, nodes) = cube();
        assert_eq!(free_motions(&mesh, &nodes, |_, d| d != 2), vec!["translation along 3"]);
    }

    #[test]
    fn a_face_held_in_its_plane_leaves_three_motions_told_once_each() {
        let (mesh, nodes) = cube();
        let words = free_motions(&mesh, &nodes, |n, d| n.0 >= 4 && d < 2);
        assert_eq!(words.len(), 3, "{words:?}");
        assert_eq!(words[0], "translation along 3");
        assert!(words[1..].iter().all(|w| w.starts_with("rotation about the direction") && w.contains("1.0000e0)")));
    }

    #[test]
    fn a_hinge_line_is_described_by_its_axis() {
        let (mesh, nodes) = cube();
        // Edge along 1 at x2 = x3 = 0.
        let words = free_motions(&mesh, &nodes, |n, _| n.0 < 2);
        assert_eq!(words.len(), 1, "{words:?}");
        assert!(words[0].starts_with("rotation about the direction") && words[0].contains("0.0000e0"), "{words:?}");
    }
}
