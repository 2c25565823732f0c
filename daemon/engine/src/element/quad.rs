//! Bilinear quadrilateral: element faces as carriers of pressure and of contact.

/// Corner coordinates, counter-clockwise seen from outside [length].
pub type QuadCorners = [[f64; 3]; 4];

/// Signs of the natural coordinates of the corners.
const CORNER: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// 1/√3: natural coordinate of the Gauss points.
const GAUSS: f64 = 0.577_350_269_189_625_8;

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// Shape functions at natural coordinates in [-1, 1]².
pub fn shape(natural: [f64; 2]) -> [f64; 4] {
    CORNER.map(|c| 0.25 * (1.0 + c[0] * natural[0]) * (1.0 + c[1] * natural[1]))
}

/// Position and the two tangents ∂x/∂ξ, ∂x/∂η.
pub fn map(corners: &QuadCorners, natural: [f64; 2]) -> ([f64; 3], [f64; 3], [f64; 3]) {
    let (mut x, mut t, mut s) = ([0.0; 3], [0.0; 3], [0.0; 3]);
    for (corner, c) in corners.iter().zip(CORNER) {
        let (f, g) = (1.0 + c[0] * natural[0], 1.0 + c[1] * natural[1]);
        for i in 0..3 {
            x[i] += 0.25 * f * g * corner[i];
            t[i] += 0.25 * c[0] * g * corner[i];
            s[i] += 0.25 * f * c[1] * corner[i];
        }
    }
    (x, t, s)
}

/// ∫ N_a n dA: outward area vector of each corner [length²]. Times −p it is the nodal force of a pressure p.
pub fn nodal_area_vectors(corners: &QuadCorners) -> [[f64; 3]; 4] {
    let mut out = [[0.0; 3]; 4];
    for c in CORNER {
        let natural = [c[0] * GAUSS, c[1] * GAUSS];
        let (_, t, s) = map(corners, natural);
        let area = cross(t, s);
        for (o, n) in out.iter_mut().zip(shape(natural)) {
            for i in 0..3 {
                o[i] += n * area[i];
            }
        }
    }
    out
}

/// ∫ N_a dA: tributary area of each corner [length²].
pub fn nodal_areas(corners: &QuadCorners) -> [f64; 4] {
    let mut out = [0.0; 4];
    for c in CORNER {
        let natural = [c[0] * GAUSS, c[1] * GAUSS];
        let (_, t, s) = map(corners, natural);
        let area = norm(cross(t, s));
        for (o, n) in out.iter_mut().zip(shape(natural)) {
            *o += n * area;
        }
    }
    out
}

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
    /// How far the position lies outside the face, measured along it [length]; 0 above the face.
    pub overhang: f64,
}

/// Projects a position onto the face: Newton on the squared distance, kept within the face edge by edge.
///
/// Returns `None` for a face without area.
pub fn project(corners: &QuadCorners, position: [f64; 3]) -> Option<Projection> {
    let mut natural = [0.0; 2];
    // Gauss-Newton with projection onto the square; a bilinear face needs a handful of steps.
    for _ in 0..50 {
        let (x, t, s) = map(corners, natural);
        let r = sub(position, x);
        let (a, b, c) = (dot(t, t), dot(t, s), dot(s, s));
        let det = a * c - b * b;
        if det <= 1e-24 * (a * c).max(f64::MIN_POSITIVE) {
            return None;
        }
        let (p, q) = (dot(r, t), dot(r, s));
        let mut next = [natural[0] + (c * p - b * q) / det, natural[1] + (a * q - b * p) / det];
        // On a violated bound, minimise along it: clamp that coordinate and re-solve for the other.
        for k in 0..2 {
            if next[k].abs() > 1.0 {
                next[k] = next[k].clamp(-1.0, 1.0);
                let fixed = next[k] - natural[k];
                let other = 1 - k;
                let (diag, rhs) = if k == 0 { (c, q) } else { (a, p) };
                next[other] = (natural[other] + (rhs - b * fixed) / diag).clamp(-1.0, 1.0);
            }
        }
        let change = (next[0] - natural[0]).abs().max((next[1] - natural[1]).abs());
        natural = next;
        if change < 1e-14 {
            break;
        }
    }
    let (foot, t, s) = map(corners, natural);
    let area = cross(t, s);
    let length = norm(area);
    if length == 0.0 {
        return None;
    }
    let normal = area.map(|x| x / length);
    let r = sub(position, foot);
    let along = dot(r, normal);
    let overhang = norm([r[0] - along * normal[0], r[1] - along * normal[1], r[2] - along * normal[2]]);
    Some(Projection { natural, foot, distance: norm(r), normal, overhang })
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: QuadCorners = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    const WARPED: QuadCorners = [[0.0, 0.0, 0.0], [2.0, 0.1, 0.2], [2.2, 1.0, -0.1], [0.1, 1.2, 0.3]];

    #[test]
    fn areas_of_a_rectangle_are_quarters() {
        for a in nodal_areas(&UNIT) {
            assert!((a - 0.5).abs() < 1e-15);
        }
        for v in nodal_area_vectors(&UNIT) {
            assert!((v[2] - 0.5).abs() < 1e-15 && v[0] == 0.0 && v[1] == 0.0);
        }
    }

    #[test]
    fn a_point_above_the_face_projects_straight_down() {
        let p = project(&UNIT, [0.3, 0.9, 0.7]).expect("face has area");
        assert!((p.foot[0] - 0.3).abs() < 1e-14 && (p.foot[1] - 0.9).abs() < 1e-14);
        assert!((p.distance - 0.7).abs() < 1e-14 && p.overhang < 1e-14);
        assert_eq!(p.normal, [0.0, 0.0, 1.0]);
    }

    #[test]
    fn a_point_beside_the_face_projects_onto_its_nearest_edge_or_corner() {
        let edge = project(&UNIT, [2.5, 0.25, 0.0]).expect("face has area");
        assert!((edge.foot[0] - 2.0).abs() < 1e-14 && (edge.foot[1] - 0.25).abs() < 1e-14);
        assert!((edge.overhang - 0.5).abs() < 1e-14);
        let corner = project(&UNIT, [-1.0, -1.0, 0.0]).expect("face has area");
        assert!((corner.overhang - 2f64.sqrt()).abs() < 1e-14);
    }

    #[test]
    fn the_foot_on_a_warped_face_is_a_minimum_of_the_distance() {
        for target in [[0.7, 0.5, 0.4], [1.9, 1.3, -0.5], [-0.4, 0.6, 0.2], [1.0, 0.5, 2.0]] {
            let p = project(&WARPED, target).expect("face has area");
            for i in -20..=20 {
                for j in -20..=20 {
                    let (x, _, _) = map(&WARPED, [f64::from(i) / 20.0, f64::from(j) / 20.0]);
                    assert!(norm(sub(target, x)) >= p.distance - 1e-12);
                }
            }
        }
    }

    #[test]
    fn a_face_without_area_has_no_projection() {
        assert!(project(&[[0.0; 3]; 4], [1.0; 3]).is_none());
    }
}
