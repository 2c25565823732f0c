//! Faces of 3, 4, 6 and 8 nodes as carriers of pressure and of contact. Four-node faces are done in `quad.rs`.

use super::quad::{self, cross, dot, norm, sub};
use crate::model::FACE_NODES_MAX;

/// Closest point of the face to a position.
#[derive(Clone, Copy, Debug)]
pub struct Projection {
    /// Natural coordinates, within [-1, 1]².
    pub natural: [f64; 2],
    /// The closest point itself [length].
    pub foot: [f64; 3],
    /// Distance from the foot to the position [length].
    pub distance: f64,
    /// Unit outward normal of the face at the foot.
    pub normal: [f64; 3],
}

/// Shape functions of a face at one point, with first and second derivatives; zero beyond the node count.
#[derive(Clone, Copy)]
struct Functions {
    value: [f64; FACE_NODES_MAX],
    /// ∂/∂ξ, ∂/∂η.
    first: [[f64; 2]; FACE_NODES_MAX],
    /// ∂²/∂ξ², ∂²/∂η², ∂²/∂ξ∂η.
    second: [[f64; 3]; FACE_NODES_MAX],
}

/// Natural coordinates of the corners of quadrilaterals.
const SQUARE: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// Natural coordinates of the corners of triangles.
const TRIANGLE: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];

/// Derivatives of the area coordinates.
const SLOPE: [[f64; 2]; 3] = [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]];

/// Natural coordinates of the corners of a face by its node count.
fn corners(count: usize) -> &'static [[f64; 2]] {
    if count == 3 || count == 6 { &TRIANGLE } else { &SQUARE }
}

fn functions(count: usize, [x, y]: [f64; 2]) -> Functions {
    let mut f = Functions {
        value: [0.0; FACE_NODES_MAX],
        first: [[0.0; 2]; FACE_NODES_MAX],
        second: [[0.0; 3]; FACE_NODES_MAX],
    };
    let l = [1.0 - x - y, x, y];
    match count {
        3 => {
            f.value[..3].copy_from_slice(&l);
            f.first[..3].copy_from_slice(&SLOPE);
        }
        6 => {
            for a in 0..3 {
                let (s, b) = (SLOPE[a], (a + 1) % 3);
                let t = SLOPE[b];
                f.value[a] = l[a] * (2.0 * l[a] - 1.0);
                f.first[a] = s.map(|s| (4.0 * l[a] - 1.0) * s);
                f.second[a] = [4.0 * s[0] * s[0], 4.0 * s[1] * s[1], 4.0 * s[0] * s[1]];
                f.value[3 + a] = 4.0 * l[a] * l[b];
                f.first[3 + a] = std::array::from_fn(|i| 4.0 * (s[i] * l[b] + l[a] * t[i]));
                f.second[3 + a] = [8.0 * s[0] * t[0], 8.0 * s[1] * t[1], 4.0 * (s[0] * t[1] + s[1] * t[0])];
            }
        }
        4 => {
            for (a, c) in SQUARE.iter().enumerate() {
                let (p, q) = (1.0 + c[0] * x, 1.0 + c[1] * y);
                f.value[a] = 0.25 * p * q;
                f.first[a] = [0.25 * c[0] * q, 0.25 * p * c[1]];
                f.second[a] = [0.0, 0.0, 0.25 * c[0] * c[1]];
            }
        }
        _ => {
            for (a, c) in SQUARE.iter().enumerate() {
                let (u, v) = (c[0] * x, c[1] * y);
                let (p, q) = (1.0 + u, 1.0 + v);
                f.value[a] = 0.25 * p * q * (u + v - 1.0);
                f.first[a] = [0.25 * c[0] * q * (2.0 * u + v), 0.25 * c[1] * p * (u + 2.0 * v)];
                f.second[a] = [0.5 * q, 0.5 * p, 0.25 * c[0] * c[1] * (2.0 * u + 2.0 * v + 1.0)];
            }
            for (a, sign) in [(4, -1.0), (6, 1.0)] {
                let q = 1.0 + sign * y;
                f.value[a] = 0.5 * (1.0 - x * x) * q;
                f.first[a] = [-x * q, 0.5 * sign * (1.0 - x * x)];
                f.second[a] = [-q, 0.0, -x * sign];
            }
            for (a, sign) in [(5, 1.0), (7, -1.0)] {
                let p = 1.0 + sign * x;
                f.value[a] = 0.5 * (1.0 - y * y) * p;
                f.first[a] = [0.5 * sign * (1.0 - y * y), -y * p];
                f.second[a] = [0.0, -p, -y * sign];
            }
        }
    }
    f
}

/// Shape functions of a face by its node count; zero beyond it.
pub fn shape(count: usize, natural: [f64; 2]) -> [f64; FACE_NODES_MAX] {
    if count == 4 {
        let mut out = [0.0; FACE_NODES_MAX];
        out[..4].copy_from_slice(&quad::shape(natural));
        return out;
    }
    functions(count, natural).value
}

/// Position, tangents ∂x/∂ξ and ∂x/∂η, and second derivatives.
struct Place {
    at: [f64; 3],
    tangents: [[f64; 3]; 2],
    curvature: [[f64; 3]; 3],
}

fn place(nodes: &[[f64; 3]], natural: [f64; 2]) -> Place {
    let f = functions(nodes.len(), natural);
    let mut out = Place { at: [0.0; 3], tangents: [[0.0; 3]; 2], curvature: [[0.0; 3]; 3] };
    for (a, x) in nodes.iter().enumerate() {
        for i in 0..3 {
            out.at[i] += f.value[a] * x[i];
            for (t, d) in out.tangents.iter_mut().zip(f.first[a]) {
                t[i] += d * x[i];
            }
            for (c, d) in out.curvature.iter_mut().zip(f.second[a]) {
                c[i] += d * x[i];
            }
        }
    }
    out
}

/// Area of a face as the Jacobian at one place has it: of a flat parallelogram or triangle the area everywhere [length²].
pub fn area_by(nodes: &[[f64; 3]], natural: [f64; 2]) -> f64 {
    let [first, second] = place(nodes, natural).tangents;
    let natural_area = if corners(nodes.len()).len() == 4 { 4.0 } else { 0.5 };
    natural_area * quad::norm(quad::cross(first, second))
}

/// Integration points of a face: enough for shape functions times area vectors of curved faces.
fn rule(count: usize) -> Vec<([f64; 2], f64)> {
    if corners(count).len() == 4 {
        let line = super::hexahedron::GAUSS_3;
        return line.iter().flat_map(|&(y, w)| line.iter().map(move |&(x, v)| ([x, y], v * w))).collect();
    }
    // Radon's seven points, exact to degree 5.
    let root = 15f64.sqrt();
    let mut rule = vec![([1.0 / 3.0; 2], 9.0 / 80.0)];
    for sign in [-1.0, 1.0] {
        let near = (6.0 + sign * root) / 21.0;
        let far = 1.0 - 2.0 * near;
        let weight = (155.0 + sign * root) / 2400.0;
        rule.extend([[near, near], [far, near], [near, far]].map(|natural| (natural, weight)));
    }
    rule
}

/// ∫ N_a n dA: outward area vector of each node [length²]. Times −p it is the nodal force of a pressure p.
pub fn nodal_area_vectors(nodes: &[[f64; 3]]) -> Vec<[f64; 3]> {
    if let Ok(corners) = nodes.try_into() {
        return quad::nodal_area_vectors(corners).to_vec();
    }
    let mut out = vec![[0.0; 3]; nodes.len()];
    for (natural, weight) in rule(nodes.len()) {
        let [t, s] = place(nodes, natural).tangents;
        let area = cross(t, s);
        for (o, n) in out.iter_mut().zip(functions(nodes.len(), natural).value) {
            for i in 0..3 {
                o[i] += weight * n * area[i];
            }
        }
    }
    out
}

/// ∫ N_a dA: tributary area of each node [length²]. Zero or negative at the corners of quadratic faces.
pub fn nodal_areas(nodes: &[[f64; 3]]) -> Vec<f64> {
    if let Ok(corners) = nodes.try_into() {
        return quad::nodal_areas(corners).to_vec();
    }
    let mut out = vec![0.0; nodes.len()];
    for (natural, weight) in rule(nodes.len()) {
        let [t, s] = place(nodes, natural).tangents;
        let area = norm(cross(t, s));
        for (o, n) in out.iter_mut().zip(functions(nodes.len(), natural).value) {
            *o += weight * n * area;
        }
    }
    out
}

/// How far a face may reach out of the box of its nodes, in extents of the box: what its negative shape functions add up to.
pub fn bulge(count: usize) -> f64 {
    match count {
        6 => 0.375,
        8 => 1.0,
        _ => 0.0,
    }
}

/// Projects a position onto the face: the closest point, found by Newton's method on the squared distance inside the face and
/// along its edges. `None` for a face without area.
pub fn project(nodes: &[[f64; 3]], position: [f64; 3]) -> Option<Projection> {
    let distance = |natural: [f64; 2]| norm(sub(position, place(nodes, natural).at));
    let natural = match inside(nodes, position) {
        Some(natural) => natural,
        None => along_edges(nodes, position),
    };
    let foot = place(nodes, natural);
    let [t, s] = foot.tangents;
    let area = cross(t, s);
    let length = norm(area);
    if length <= 1e-12 * norm(t) * norm(s) || length == 0.0 {
        return None;
    }
    let normal = area.map(|x| x / length);
    Some(Projection { natural, foot: foot.at, distance: distance(natural), normal })
}

/// Number of corners of a face by its node count.
pub fn corner_count(count: usize) -> usize {
    corners(count).len()
}

/// Edges of a face on which natural coordinates lie; edge k goes from corner k to the next.
pub fn edges_at(count: usize, [x, y]: [f64; 2], tolerance: f64) -> Vec<usize> {
    let distances: &[f64] =
        if corner_count(count) == 3 { &[y, 1.0 - x - y, x] } else { &[1.0 + y, 1.0 - x, 1.0 - y, 1.0 + x] };
    (0..distances.len()).filter(|&k| distances[k] <= tolerance).collect()
}

/// Corner that two edges of a face share.
pub fn shared_corner(count: usize, first: usize, second: usize) -> usize {
    if (first + 1) % corner_count(count) == second { second } else { first }
}

/// Stationary minimum of the distance inside the face, if Newton's method ends in one.
fn inside(nodes: &[[f64; 3]], position: [f64; 3]) -> Option<[f64; 2]> {
    let triangle = corners(nodes.len()).len() == 3;
    let starts: &[[f64; 2]] = if triangle {
        &[[1.0 / 3.0, 1.0 / 3.0], [0.6, 0.2], [0.2, 0.6], [0.2, 0.2]]
    } else {
        &[[0.0, 0.0], [-0.6, -0.6], [0.6, -0.6], [0.6, 0.6], [-0.6, 0.6]]
    };
    let squared = |natural: [f64; 2]| {
        let r = sub(position, place(nodes, natural).at);
        dot(r, r)
    };
    let mut natural = starts.iter().copied().min_by(|a, b| squared(*a).total_cmp(&squared(*b)))?;
    for _ in 0..50 {
        let p = place(nodes, natural);
        let r = sub(position, p.at);
        let [t, s] = p.tangents;
        let gradient = [-dot(r, t), -dot(r, s)];
        let gauss = [dot(t, t), dot(s, s), dot(t, s)];
        let full: [f64; 3] = std::array::from_fn(|i| gauss[i] - dot(r, p.curvature[i]));
        let definite = |h: &[f64; 3]| h[0] > 0.0 && h[0] * h[1] - h[2] * h[2] > 1e-9 * gauss[0] * gauss[1];
        let h = if definite(&full) { full } else { gauss };
        let det = h[0] * h[1] - h[2] * h[2];
        if det <= 1e-24 * (h[0] * h[1]).max(f64::MIN_POSITIVE) {
            return None;
        }
        let step = [-(h[1] * gradient[0] - h[2] * gradient[1]) / det, -(h[0] * gradient[1] - h[2] * gradient[0]) / det];
        let size = step[0].abs().max(step[1].abs());
        // Long steps of a curved face are shortened: the minimum is wanted, not any stationary point.
        let mut part = if size > 1.0 && nodes.len() > 4 { 1.0 / size } else { 1.0 };
        let before = squared(natural);
        let moved = |part: f64| [natural[0] + part * step[0], natural[1] + part * step[1]];
        while squared(moved(part)) > before * (1.0 + 1e-12) && part > 1e-3 {
            part *= 0.5;
        }
        natural = moved(part);
        if natural.iter().any(|n| n.abs() > 3.0) {
            return None;
        }
        if size < 1e-14 {
            break;
        }
    }
    contains(triangle, natural).then_some(natural)
}

fn contains(triangle: bool, [x, y]: [f64; 2]) -> bool {
    const HAIR: f64 = 1e-12;
    if triangle {
        x >= -HAIR && y >= -HAIR && x + y <= 1.0 + HAIR
    } else {
        x.abs() <= 1.0 + HAIR && y.abs() <= 1.0 + HAIR
    }
}

/// Closest point of the edges.
fn along_edges(nodes: &[[f64; 3]], position: [f64; 3]) -> [f64; 2] {
    let corners = corners(nodes.len());
    let mut best = (f64::INFINITY, corners[0]);
    for (i, &from) in corners.iter().enumerate() {
        let to = corners[(i + 1) % corners.len()];
        let direction = [to[0] - from[0], to[1] - from[1]];
        let on = |part: f64| [from[0] + part * direction[0], from[1] + part * direction[1]];
        let squared = |part: f64| {
            let r = sub(position, place(nodes, on(part)).at);
            dot(r, r)
        };
        // The best of a few places, then Newton on the parameter of the edge, which is at most a parabola in space.
        let mut part =
            (0..=8).map(|k| f64::from(k) / 8.0).min_by(|a, b| squared(*a).total_cmp(&squared(*b))).unwrap_or_default();
        for _ in 0..50 {
            let p = place(nodes, on(part));
            let r = sub(position, p.at);
            let t: [f64; 3] =
                std::array::from_fn(|i| direction[0] * p.tangents[0][i] + direction[1] * p.tangents[1][i]);
            let c: [f64; 3] = std::array::from_fn(|i| {
                direction[0] * direction[0] * p.curvature[0][i]
                    + direction[1] * direction[1] * p.curvature[1][i]
                    + 2.0 * direction[0] * direction[1] * p.curvature[2][i]
            });
            let (gauss, full) = (dot(t, t), dot(t, t) - dot(r, c));
            if gauss == 0.0 {
                break;
            }
            let slope = if full > 0.1 * gauss { full } else { gauss };
            let next = (part + dot(r, t) / slope).clamp(0.0, 1.0);
            let change = (next - part).abs();
            part = next;
            if change < 1e-15 {
                break;
            }
        }
        let found = squared(part);
        if found < best.0 {
            best = (found, on(part));
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRI3: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.1], [0.3, 1.5, 0.0]];

    /// How far a position lies beside the normal through its foot.
    fn overhang(p: &Projection, position: [f64; 3]) -> f64 {
        let r = sub(position, p.foot);
        let along = dot(r, p.normal);
        norm(std::array::from_fn(|i| r[i] - along * p.normal[i]))
    }

    const QUAD4: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [2.0, 0.1, 0.2], [2.2, 1.0, -0.1], [0.1, 1.2, 0.3]];

    /// A face with curved edges and a bulge.
    fn curved(count: usize) -> Vec<[f64; 3]> {
        let corners = corners(count);
        let mut natural: Vec<[f64; 2]> = corners.to_vec();
        if count > 4 {
            for (i, a) in corners.iter().enumerate() {
                let b = corners[(i + 1) % corners.len()];
                natural.push([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
            }
        }
        natural.iter().map(|[x, y]| [2.0 * x + 0.1 * y, 1.5 * y, 0.2 * (x - y) - 0.25 * (x * x + y * y)]).collect()
    }

    #[test]
    fn functions_are_one_at_their_node_and_their_derivatives_agree_with_differences() {
        for count in [3, 4, 6, 8] {
            let corners = corners(count);
            for (a, &c) in corners.iter().enumerate() {
                for (b, v) in shape(count, c).into_iter().enumerate() {
                    assert!((v - f64::from(u8::from(a == b))).abs() < 1e-15);
                }
            }
            let at = [0.3, 0.2];
            let f = functions(count, at);
            assert!((f.value.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            let h = 1e-5;
            let (e, w) = (functions(count, [at[0] + h, at[1]]), functions(count, [at[0] - h, at[1]]));
            let (n, s) = (functions(count, [at[0], at[1] + h]), functions(count, [at[0], at[1] - h]));
            for a in 0..count {
                let near = |x: f64, y: f64| assert!((x - y).abs() < 1e-8, "{count} node {a}: {x} {y}");
                near((e.value[a] - w.value[a]) / (2.0 * h), f.first[a][0]);
                near((n.value[a] - s.value[a]) / (2.0 * h), f.first[a][1]);
                near((e.first[a][0] - w.first[a][0]) / (2.0 * h), f.second[a][0]);
                near((n.first[a][1] - s.first[a][1]) / (2.0 * h), f.second[a][1]);
                near((e.first[a][1] - w.first[a][1]) / (2.0 * h), f.second[a][2]);
            }
        }
    }

    #[test]
    fn areas_of_flat_faces() {
        let area = norm(cross(sub(TRI3[1], TRI3[0]), sub(TRI3[2], TRI3[0]))) / 2.0;
        for a in nodal_areas(&TRI3) {
            assert!((a - area / 3.0).abs() < 1e-14);
        }
        // Quadratic faces: nothing at the corners of a triangle, -1/12 at those of a quadrilateral.
        let flat = |count| curved(count).into_iter().map(|[x, y, _]| [x, y, 0.0]).collect::<Vec<_>>();
        let (six, eight) = (nodal_areas(&flat(6)), nodal_areas(&flat(8)));
        for a in 0..3 {
            assert!(six[a].abs() < 1e-14 && (six[3 + a] - 0.5).abs() < 1e-14, "{six:?}");
        }
        for a in 0..4 {
            assert!((eight[a] + 1.0).abs() < 1e-13 && (eight[4 + a] - 4.0).abs() < 1e-13, "{eight:?}");
        }
    }

    #[test]
    fn the_area_vector_of_a_face_depends_on_its_edge_only() {
        // Two curved triangles close a surface when one is turned round.
        let face = curved(6);
        let turned: Vec<_> = [0, 2, 1, 5, 4, 3].map(|i| face[i]).to_vec();
        for i in 0..3 {
            let sum: f64 = nodal_area_vectors(&face).iter().chain(&nodal_area_vectors(&turned)).map(|v| v[i]).sum();
            assert!(sum.abs() < 1e-14);
        }
    }

    #[test]
    fn the_foot_is_a_minimum_of_the_distance() {
        for count in [3, 4, 6, 8] {
            let nodes = match count {
                3 => TRI3.to_vec(),
                4 => QUAD4.to_vec(),
                _ => curved(count),
            };
            let triangle = corners(count).len() == 3;
            for target in [
                [0.5, 0.3, 0.4],
                [2.5, 0.3, -0.5],
                [-0.4, 0.6, 0.2],
                [0.3, 0.2, 1.5],
                [3.0, 3.0, 0.0],
                [0.4, -2.0, 0.1],
            ] {
                let p = project(&nodes, target).expect("the face has area");
                assert!(contains(triangle, p.natural));
                for i in -20..=20 {
                    for j in -20..=20 {
                        let natural = [f64::from(i) / 20.0, f64::from(j) / 20.0];
                        if contains(triangle, natural) {
                            let other = norm(sub(target, place(&nodes, natural).at));
                            assert!(other >= p.distance - 1e-10, "{count} {target:?}: {other} {}", p.distance);
                        }
                    }
                }
                // Above the face the foot is perpendicular.
                let [x, y] = p.natural;
                let interior =
                    if triangle { x > 0.01 && y > 0.01 && x + y < 0.99 } else { x.abs().max(y.abs()) < 0.99 };
                if interior {
                    let beside = overhang(&p, target);
                    assert!(beside < 1e-9, "{count} {target:?}: {beside}");
                }
            }
        }
    }

    #[test]
    fn a_foot_on_an_edge_of_a_skewed_face_is_not_taken_for_its_corner() {
        let face = [[-1.5, -0.25, 0.0], [-0.5, -0.25, 0.0], [1.5, 0.25, 0.0], [0.5, 0.25, 0.0]];
        let p = project(&face, [1.2, 0.31, 0.0]).expect("the face has area");
        assert!((p.foot[0] - 1.2).abs() < 1e-12 && (p.distance - 0.06).abs() < 1e-12, "{p:?}");
        assert_eq!(edges_at(4, p.natural, 1e-9), vec![2]);
    }

    #[test]
    fn edges_meet_in_the_corner_that_both_name() {
        for (count, corners) in [(3, TRIANGLE.to_vec()), (4, SQUARE.to_vec())] {
            for (k, &natural) in corners.iter().enumerate() {
                let edges = edges_at(count, natural, 1e-9);
                assert_eq!(edges.len(), 2);
                assert_eq!(shared_corner(count, edges[0], edges[1]), k, "{count}");
            }
        }
    }

    #[test]
    fn a_face_without_area_has_no_projection() {
        assert!(project(&[[0.0; 3]; 3], [1.0; 3]).is_none());
        assert!(project(&[[0.0; 3]; 8], [1.0; 3]).is_none());
    }

    #[test]
    fn faces_stay_in_the_box_that_is_searched() {
        for count in [6, 8] {
            let nodes = curved(count);
            for i in 0..3 {
                let low = nodes.iter().map(|x| x[i]).fold(f64::INFINITY, f64::min);
                let high = nodes.iter().map(|x| x[i]).fold(f64::NEG_INFINITY, f64::max);
                let reach = bulge(count) * (high - low);
                for step in 0..=100 {
                    let at = f64::from(step) / 100.0;
                    let natural = if count == 6 { [at / 2.0, at / 2.0] } else { [2.0 * at - 1.0, 0.3 * at] };
                    let x = place(&nodes, natural).at[i];
                    assert!(x >= low - reach && x <= high + reach);
                }
            }
        }
    }
}
