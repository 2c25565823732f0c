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

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: QuadCorners = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

    #[test]
    fn areas_of_a_rectangle_are_quarters() {
        for a in nodal_areas(&UNIT) {
            assert!((a - 0.5).abs() < 1e-15);
        }
        for v in nodal_area_vectors(&UNIT) {
            assert!((v[2] - 0.5).abs() < 1e-15 && v[0] == 0.0 && v[1] == 0.0);
        }
    }
}
