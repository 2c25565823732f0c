//! Exponential pressure-overclosure relationship of CalculiX.
//!
//! ```text
//! b = ln(100) / c0
//! p(h)  = 0                              h <= -c0 (1 + w)
//! p(h)  = p0/100 (1 + (h + c0)/(w c0))   -c0 (1 + w) < h < -c0,   w = 1e-6
//! p(h)  = p0 exp(b h)                    -c0 <= h <= h_s,   h_s = 23 / b
//! p'(h) = b p(h)
//! U(h)  = (p(h) - p0/100) / b + w c0 p0/200
//! p(h)  = p(h_s) + p'(h_s) (h - h_s)     h > h_s
//! ```
//!
//! * `h` overclosure \[length\], positive when the bodies overlap; `p` pressure \[pressure\], positive in compression;
//!   `c0` clearance at which the pressure has fallen to a hundredth of `p0` \[length\]; `p0` pressure at zero clearance
//!   \[pressure\]; `U` energy \[pressure*length\].
//! * Domain: every finite `h`; `c0` and `p0` positive and finite. The meaning is that of CalculiX's node-to-surface contact
//!   (its surface-to-surface contact uses the same curve for `h >= 0` only).
//! * Where CalculiX caps the force of a point at exp(23) in whatever units the deck has, this curve goes on straight, with
//!   continuous pressure and slope, from `p = exp(23) p0`, `h = 4.994 c0`: the same place when `p0` times the area of the
//!   point is 1, and independent of the units.
//! * CalculiX lets the pressure jump from 0 to `p0/100` at `h = -c0`. A body in balance with a pressure in between would have no
//!   solution and a solver would chatter for ever, so the jump is a steep line over a millionth of `c0`.
//! * Kinks: both ends of that line.
//! * Source: CalculiX CrunchiX User's Manual 2.20, *SURFACE BEHAVIOR and "Node-to-Face Penalty Contact".

use super::error::{require_in_range, require_positive};
use super::{LawError, LawPoint, PressureLaw, saturate, straight};

/// ln(100): decay of the exponent over the clearance c0.
const LN_100: f64 = 2.0 * std::f64::consts::LN_10;

/// Width of the line that stands for the jump, relative to c0: far below any overclosure that a user reads.
const JUMP_WIDTH: f64 = 1e-6;

/// Exponent at which the straight continuation begins.
const EXPONENT_MAX: f64 = 23.0;

/// The curve of CalculiX: a factor of 100 for every `clearance`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CalculixExponential {
    clearance: f64,
    pressure: f64,
    /// `ln(100) / c0` [1/length].
    rate: f64,
    /// Overclosure where the straight continuation begins \[length\].
    switch: f64,
    /// Values there.
    at_switch: LawPoint,
}

impl CalculixExponential {
    /// Refuses a clearance c0 \[length\] or a pressure p0 \[pressure\] that is not positive and finite.
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
            at_switch: curve(EXPONENT_MAX, pressure, rate, jump_energy(clearance, pressure)),
        })
    }

    /// Clearance at which the pressure has fallen to a hundredth, c0 \[length\].
    pub fn clearance(&self) -> f64 {
        self.clearance
    }

    /// Pressure at zero clearance, p0 \[pressure\].
    pub fn pressure(&self) -> f64 {
        self.pressure
    }
}

impl CalculixExponential {
    /// Overclosure at which pressure begins \[length\].
    fn onset(&self) -> f64 {
        -self.clearance * (1.0 + JUMP_WIDTH)
    }

    /// The steep line below `h = -c0`.
    fn jump(&self, overclosure: f64) -> LawPoint {
        let distance = overclosure - self.onset();
        if distance <= 0.0 {
            return LawPoint::default();
        }
        straight(distance, 0.0, 0.01 * self.pressure / (JUMP_WIDTH * self.clearance), 0.0)
    }
}

/// Energy of the line that stands for the jump \[pressure*length\].
fn jump_energy(clearance: f64, pressure: f64) -> f64 {
    0.5 * (0.01 * pressure) * (JUMP_WIDTH * clearance)
}

impl PressureLaw for CalculixExponential {
    fn evaluate(&self, overclosure: f64) -> LawPoint {
        if overclosure < -self.clearance {
            return self.jump(overclosure);
        }
        if overclosure > self.switch {
            let LawPoint { pressure, stiffness, energy } = self.at_switch;
            return straight(overclosure - self.switch, pressure, stiffness, energy);
        }
        curve(overclosure * self.rate, self.pressure, self.rate, jump_energy(self.clearance, self.pressure))
    }

    fn kinks(&self) -> Vec<f64> {
        vec![self.onset(), -self.clearance]
    }

    fn overclosure_at(&self, pressure: f64) -> f64 {
        if pressure <= 0.0 {
            self.onset()
        } else if pressure <= 0.01 * self.pressure {
            self.onset() + JUMP_WIDTH * self.clearance * (pressure / (0.01 * self.pressure))
        } else if pressure >= self.at_switch.pressure {
            saturate(self.switch + (pressure - self.at_switch.pressure) / self.at_switch.stiffness)
        } else {
            (pressure / self.pressure).ln() / self.rate
        }
    }
}

/// The curve at the exponent `x = b h`. The energy is `p0/(100 b) (exp(x + ln 100) - 1)`, which does not cancel at its beginning.
fn curve(x: f64, p0: f64, rate: f64, energy_before: f64) -> LawPoint {
    let pressure = p0 * x.exp();
    LawPoint {
        pressure,
        stiffness: pressure * rate,
        energy: saturate(energy_before + (0.01 * p0 / rate) * (x + LN_100).exp_m1().max(0.0)),
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
        let end = curve(EXPONENT_MAX, pressure, rate, 0.0);
        require_in_range(&mut findings, LAW, "the largest curved pressure", end.pressure);
        require_in_range(&mut findings, LAW, "the largest slope", end.stiffness);
        require_in_range(&mut findings, LAW, "the slope at the jump", 0.01 * pressure / (JUMP_WIDTH * clearance));
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
    fn the_jump_is_a_line_whose_slope_is_its_derivative() {
        let law = CalculixExponential::new(0.01, 1.0).unwrap();
        check_law(&law, &[-0.01 * (1.0 + 0.5e-6)], 1e-11);
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
        assert_inverse(&law, &[-0.0099, -0.002, 0.004, 0.03, 0.2], -0.01 * (1.0 + 1e-6));
        let middle = law.overclosure_at(0.01);
        assert_close(law.evaluate(middle).pressure, 0.01, 1e-9, 0.0);
    }

    #[test]
    fn every_wrong_parameter_is_named() {
        let text: Vec<String> = violations(0.0, f64::INFINITY).iter().map(ToString::to_string).collect();
        assert!(text[0].contains("clearance") && text[0].contains('0'), "{text:?}");
        assert!(text[1].contains("pressure") && text[1].contains("inf"), "{text:?}");
    }
}
