//! Conjugate gradients on the contact forces of the active points.
//!
//! Where hard points depend on each other there are many solutions; from zero the method ends on the one that is smallest in the
//! compliance that the preconditioner adds at hard points: forces are shared in proportion to areas.

/// Iterations before the residual is left as it is: the preconditioner is exact but for the compliance that stands in at hard
/// points, so that a handful is usual.
const ITERATIONS_MAX: usize = 60;
/// Compliance that stands in for none, relative to that of the bodies.
const STAND_IN: f64 = 1e-4;
/// Residual, relative to the right-hand side, that is rounding.
const ROUNDING: f64 = 1e-15;

/// `(W + C) F = r` on the active points.
pub struct ActiveSystem<'a> {
    /// `(W + C) x`, into the second argument.
    pub product: &'a mut dyn FnMut(&[f64], &mut [f64]),
    /// An approximate inverse times a vector, into the second argument.
    pub approximate: &'a mut dyn FnMut(&[f64], &mut [f64]),
}

/// Compliance times area that stands in for no compliance at hard points, small against that of the bodies; from the compliance
/// of the bodies and the area of each point.
pub fn stand_in(points: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let terms = points.map(|(own, area)| own * area).filter(|x| *x > 0.0);
    let count = terms.clone().count();
    if count == 0 { 1.0 } else { STAND_IN * terms.sum::<f64>() / count as f64 }
}

/// Solves an active system from zero.
pub fn solve(system: &mut ActiveSystem<'_>, right: &[f64], x: &mut [f64]) {
    let n = right.len();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let norm = |v: &[f64]| v.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let (mut r, mut z, mut p, mut q) = (vec![0.0; n], vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    x.fill(0.0);
    r.copy_from_slice(right);
    let target = ROUNDING * norm(right);
    let (mut best, mut best_x) = (norm(&r), x.to_vec());
    (system.approximate)(&r, &mut z);
    p.copy_from_slice(&z);
    let mut rz = dot(&r, &z);
    let mut idle = 0;
    for _ in 0..ITERATIONS_MAX {
        if best <= target || !rz.is_finite() || rz <= 0.0 {
            break;
        }
        (system.product)(&p, &mut q);
        let curvature = dot(&p, &q);
        if curvature.is_nan() || curvature <= 0.0 {
            break;
        }
        let step = rz / curvature;
        for i in 0..n {
            x[i] += step * p[i];
        }
        // The true residual: the recursive one drifts below what rounding allows.
        (system.product)(x, &mut q);
        for i in 0..n {
            r[i] = right[i] - q[i];
        }
        let now = norm(&r);
        // Rounding: two steps without gain end the search.
        idle = if now < 0.5 * best { 0 } else { idle + 1 };
        if now < best {
            best = now;
            best_x.copy_from_slice(x);
        }
        if idle == 3 {
            break;
        }
        (system.approximate)(&r, &mut z);
        let next = dot(&r, &z);
        let beta = next / rz;
        rz = next;
        for i in 0..n {
            p[i] = z[i] + beta * p[i];
        }
    }
    x.copy_from_slice(&best_x);
}
