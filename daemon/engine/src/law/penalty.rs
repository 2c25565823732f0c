//! Penalty curves: stiff laws that stand in for hard contact.
//!
//! With `x = h + c0` (linear: stiffness `k`)
//!
//! ```text
//! linear     p = k x                                                   x > 0
//! nonlinear  p = Ki x                                                  0 < x ≤ d
//!            p = Ki x + (Kf − Ki) (x − d)² / (2 (e − d))               d ≤ x ≤ e
//!            p = Ki x + (Kf − Ki) ((e − d)/2 + x − e)                  e ≤ x
//! ```
//!
//! * Kinks of the slope: `h = −c0`, where pressure begins. Pressure and slope are continuous elsewhere.
//! * Augmented Lagrange uses the linear curve with a multiplier: `p = max(0, λ + k x)`, which is the curve with the
//!   clearance `c0 + λ/k`.
//! * Source: Abaqus Analysis User's Manual (later releases), contact constraint enforcement methods; the ratios are the defaults of
//!   the scripting interface.

use super::{LawPoint, PressureLaw, straight};

/// A penalty curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penalty {
    /// `Ki` [pressure/length].
    initial: f64,
    /// `Kf` [pressure/length].
    last: f64,
    /// `d` \[length\].
    lower: f64,
    /// `e` \[length\].
    upper: f64,
    /// `c0` \[length\].
    clearance: f64,
    /// Whether the first slope goes on into tension.
    extended: bool,
}

impl Penalty {
    /// One stiffness [pressure/length]; pressure begins at a clearance \[length\].
    pub fn linear(stiffness: f64, clearance: f64) -> Self {
        Self { initial: stiffness, last: stiffness, lower: 0.0, upper: 0.0, clearance, extended: false }
    }

    /// Stiffness from `initial` to `last` between the lengths `lower` and `upper`.
    pub fn nonlinear(initial: f64, last: f64, lower: f64, upper: f64, clearance: f64) -> Self {
        Self { initial, last, lower, upper, clearance, extended: false }
    }

    /// The curve of surfaces that may not separate: the first slope goes on into tension.
    pub fn extended(self) -> Self {
        Self { extended: true, ..self }
    }

    /// Stiffness of the straight curve, or the final one.
    pub fn stiffness(&self) -> f64 {
        self.last
    }
}

impl PressureLaw for Penalty {
    fn evaluate(&self, overclosure: f64) -> LawPoint {
        let x = overclosure + self.clearance;
        let Self { initial, last, lower, upper, .. } = *self;
        if x <= 0.0 {
            return if self.extended { straight(x, 0.0, initial, 0.0) } else { LawPoint::default() };
        }
        if x <= lower || initial == last {
            return straight(x, 0.0, initial, 0.0);
        }
        let (rise, width) = (last - initial, upper - lower);
        let cubic = |y: f64| rise * y * y * y / (6.0 * width);
        if x <= upper {
            let y = x - lower;
            return LawPoint {
                pressure: initial * x + rise * y * y / (2.0 * width),
                stiffness: initial + rise * y / width,
                energy: 0.5 * initial * x * x + cubic(y),
            };
        }
        let start = initial * upper + 0.5 * rise * width;
        let energy = 0.5 * initial * upper * upper + if width > 0.0 { cubic(width) } else { 0.0 };
        straight(x - upper, start, last, energy)
    }

    fn kinks(&self) -> Vec<f64> {
        let mut kinks = if self.extended { Vec::new() } else { vec![-self.clearance] };
        if self.upper <= self.lower && self.initial != self.last {
            kinks.push(self.upper - self.clearance);
        }
        kinks
    }

    fn overclosure_at(&self, pressure: f64) -> f64 {
        let Self { initial, last, lower, upper, clearance, .. } = *self;
        if pressure <= 0.0 {
            return if self.extended { super::saturate(pressure / initial - clearance) } else { -clearance };
        }
        let (rise, width) = (last - initial, upper - lower);
        let x = if pressure <= initial * lower || rise == 0.0 {
            pressure / initial
        } else if pressure <= initial * upper + 0.5 * rise * width {
            // Ki (d + y) + (Kf − Ki) y² / (2 w) = p, the positive root without cancellation.
            let (a, b, c) = (rise / (2.0 * width), initial, pressure - initial * lower);
            lower + 2.0 * c / (b + (b * b + 4.0 * a * c).sqrt())
        } else {
            upper + (pressure - initial * upper - 0.5 * rise * width) / last
        };
        super::saturate(x - clearance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::check::{assert_close, check_law};

    #[test]
    fn the_nonlinear_curve_has_its_values() {
        let law = Penalty::nonlinear(100.0, 1e4, 0.01, 0.03, 0.0);
        let rows = [
            (-0.001, 0.0, 0.0),
            (0.005, 0.5, 100.0),
            (0.01, 1.0, 100.0),
            (0.02, 26.75, 5050.0),
            (0.03, 102.0, 1e4),
            (0.05, 302.0, 1e4),
        ];
        for (h, pressure, stiffness) in rows {
            let at = law.evaluate(h);
            assert_close(at.pressure, pressure, 1e-12, 1e-15);
            assert_close(at.stiffness, stiffness, 1e-12, 0.0);
            if pressure > 0.0 {
                assert_close(law.overclosure_at(pressure), h, 1e-12, 0.0);
            }
        }
        check_law(&law, &[-0.01, 0.004, 0.015, 0.02, 0.06], 1e-6);
    }

    #[test]
    fn a_clearance_shifts_the_curve() {
        let law = Penalty::linear(3000.0, 0.002);
        assert_close(law.evaluate(0.001).pressure, 9.0, 1e-14, 0.0);
        assert_close(law.overclosure_at(9.0), 0.001, 1e-13, 0.0);
        check_law(&law, &[-0.01, 0.0, 0.004], 1e-6);
    }
}
