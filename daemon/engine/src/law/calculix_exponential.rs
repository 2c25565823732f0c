//! Exponential pressure-overclosure relationship of CalculiX.
//!
//! ```text
//! b = ln(100) / c0
//! p(h)  = 0                              h < -c0
//! p(h)  = p0 exp(b h)                    -c0 <= h <= h_s,   h_s = 23 / b
//! p'(h) = b p(h)
//! U(h)  = (p(h) - p0/100) / b
//! p(h)  = p(h_s) + p'(h_s) (h - h_s)     h > h_s
//! ```
//!
//! * `h` overclosure [length], positive when the bodies overlap; `p` pressure [pressure], positive in compression;
//!   `c0` clearance at which the pressure has fallen to a hundredth of `p0` [length]; `p0` pressure at zero clearance
//!   [pressure]; `U` energy [pressure*length].
//! * Domain: every finite `h`; `c0` and `p0` positive and finite. The meaning is that of CalculiX's node-to-surface contact
//!   (its surface-to-surface contact uses the same curve for `h >= 0` only).
//! * Where CalculiX caps the force of a point at exp(23) in whatever units the deck has, this curve goes on straight, with
//!   continuous pressure and slope, from `p = exp(23) p0`, `h = 4.994 c0`: the same place when `p0` times the area of the
//!   point is 1, and independent of the units.
//! * Kinks: the pressure itself jumps from 0 to `p0/100` at `h = -c0`.
//! * Source: CalculiX CrunchiX User's Manual 2.20, *SURFACE BEHAVIOR and "Node-to-Face Penalty Contact".

use super::error::{require_in_range, require_positive};
use super::{LawError, LawPoint, PressureLaw, saturate, straight};

/// ln(100): decay of the exponent over the clearance c0.
const LN_100: f64 = 2.0 * std::f64::consts::LN_10;

/// Exponent at which the straight continuation begins.
const EXPONENT_MAX: f64 = 23.0;

/// The curve of CalculiX: a factor of 100 for every `clearance`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CalculixExponential {
    clearance: f64,
    pressure: f64,
    /// `ln(100) / c0` [1/length].
    rate: f64,
    /// Overclosure where the straight continuation begins [length].
    switch: f64,
    /// Values there.
    at_switch: LawPoint,
}

impl CalculixExponential {
    /// Refuses a clearance c0 [length] or a pressure p0 [pressure] that is not positive and finite.
    pub fn new(clearance: f64, pressure: f64) -> Result<Self, LawError> {
        if let Some(error) = violations(clearance, pressure).into_iter().next() {
            return Err(error);
        }
        let rate = LN_100 / clearance;
        Ok(Self {
            clearance,
            pressure,
            rate,
            switch: EXPONENT_MAX / rate,
            at_switch: curve(EXPONENT_MAX, pressure, rate),
        })
    }

    /// Clearance at which the pressure has fallen to a hundredth, c0 [length].
    pub fn clearance(&self) -> f64 {
        self.clearance
    }

    /// Pressure at zero clearance, p0 [pressure].
    pub fn pressure(&self) -> f64 {
        self.pressure
    }
}

impl PressureLaw for CalculixExponential {
    fn evaluate(&self, overclosure: f64) -> LawPoint {
        if overclosure < -self.clearance {
            return LawPoint::default();
        }
        if overclosure > self.switch {
            let LawPoint { pressure, stiffness, energy } = self.at_switch;
            return straight(overclosure - self.switch, pressure, stiffness, energy);
        }
        curve(overclosure * self.rate, self.pressure, self.rate)
    }

    fn kinks(&self) -> Vec<f64> {
        vec![-self.clearance]
    }

    fn overclosure_at(&self, pressure: f64) -> f64 {
        if pressure <= 0.01 * self.pressure {
            -self.clearance
        } else if pressure >= self.at_switch.pressure {
            saturate(self.switch + (pressure - self.at_switch.pressure) / self.at_switch.stiffness)
        } else {
            (pressure / self.pressure).ln() / self.rate
        }
    }
}

/// The curve at the exponent `x = b h`. The energy is `p0/(100 b) (exp(x + ln 100) - 1)`, which does not cancel at its beginning.
fn curve(x: f64, p0: f64, rate: f64) -> LawPoint {
    let pressure = p0 * x.exp();
    LawPoint {
        pressure,
        stiffness: pressure * rate,
        energy: saturate((0.01 * p0 / rate) * (x + LN_100).exp_m1().max(0.0)),
    }
}

/// Everything that is wrong with the parameters.
pub(super) fn violations(clearance: f64, pressure: f64) -> Vec<LawError> {
    const LAW: &str = "calculix-exponential";
    let mut findings = Vec::new();
    require_positive(&mut findings, "clearance (c0)", clearance);
    require_positive(&mut findings, "pressure (p0)", pressure);
    if findings.is_empty() {
        let rate = LN_100 / clearance;
        require_in_range(&mut findings, LAW, "ln(100)/clearance", rate);
        require_in_range(&mut findings, LAW, "the end of the curved range", EXPONENT_MAX / rate);
        let end = curve(EXPONENT_MAX, pressure, rate);
        require_in_range(&mut findings, LAW, "the largest curved pressure", end.pressure);
        require_in_range(&mut findings, LAW, "the largest slope", end.stiffness);
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::check::{assert_close, assert_finite_everywhere, assert_inverse, check_law};

    #[test]
    fn slope_and_pressure_are_derivatives() {
        let law = CalculixExponential::new(0.01, 1.0).unwrap();
        check_law(&law, &[-0.02, -0.0099, -0.005, 0.0, 0.02, 0.0499, 0.0501, 0.3], 1e-7);
    }

    #[test]
    fn every_clearance_changes_the_pressure_a_hundredfold() {
        let law = CalculixExponential::new(0.01, 1.0).unwrap();
        for (h, p) in [(-0.01, 0.01), (-0.005, 0.1), (0.0, 1.0), (0.005, 10.0), (0.01, 100.0), (0.02, 1e4)] {
            assert_close(law.evaluate(h).pressure, p, 1e-13, 0.0);
        }
        assert_eq!(law.evaluate(-0.010001), LawPoint::default());
    }

    #[test]
    fn extremes_saturate_instead_of_overflowing() {
        for (c0, p0) in [(0.01, 1.0), (1e-100, 1e100), (1e150, 1e-150), (1e-300, 1e-300)] {
            assert_finite_everywhere(&CalculixExponential::new(c0, p0).unwrap());
        }
    }

    #[test]
    fn inverse_returns_the_overclosure() {
        let law = CalculixExponential::new(0.01, 2.0).unwrap();
        assert_inverse(&law, &[-0.0099, -0.002, 0.004, 0.03, 0.2], -0.01);
    }

    #[test]
    fn every_wrong_parameter_is_named() {
        let text: Vec<String> = violations(0.0, f64::INFINITY).iter().map(ToString::to_string).collect();
        assert!(text[0].contains("clearance") && text[0].contains('0'), "{text:?}");
        assert!(text[1].contains("pressure") && text[1].contains("inf"), "{text:?}");
    }
}
