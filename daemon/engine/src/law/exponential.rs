//! Exponential pressure-overclosure relationship of the Abaqus manual.
//!
//! ```text
//! u = (c0 + h) / c0,  a = p0 / (e - 1)
//! p(h)  = 0                              h <= -c0
//! p(h)  = a u (exp(u) - 1)               -c0 < h <= h_s
//! p'(h) = (a / c0) ((u + 1) exp(u) - 1)
//! U(h)  = a c0 ((u - 1) exp(u) + 1 - u^2/2)
//! p(h)  = p(h_s) + p'(h_s) (h - h_s)     h > h_s
//! ```
//!
//! * `h` overclosure \[length\], positive when the bodies overlap; `p` pressure \[pressure\], positive in compression;
//!   `c0` clearance at which the pressure begins \[length\]; `p0` pressure at zero clearance \[pressure\]; `U` energy
//!   \[pressure*length\]; `h_s` the overclosure where the straight continuation begins \[length\].
//! * Without a stiffness limit `h_s = 6 c0` (the straight continuation of Abaqus/Standard, kept in Abaqus/Explicit as
//!   a guard against overflow). With a limit `k_max` [pressure/length] (Abaqus/Explicit) `h_s` is where the slope
//!   reaches it: `(u + 1) exp(u) = 1 + k_max c0 / a`, so `u = W0(e (1 + k_max c0 / a)) - 1` with Lambert's W. That may
//!   be a clearance; the pressure at zero clearance is then less than `p0`.
//! * Domain: every finite `h`; `c0`, `p0`, `k_max` positive and finite.
//! * Kinks: none. Pressure and slope are continuous at `-c0` (both 0) and at `h_s`.
//! * Source: Abaqus Analysis User's Manual v6.5, 22.1.2, "Softened contact defined with an exponential law", and Theory
//!   Manual 5.2.1. The manual shows the curve as a picture; this expression has every property that the text states.
//!
//! CalculiX uses the same keyword for another curve: [`super::CalculixExponential`].

use std::f64::consts::E;

use super::error::{require_in_range, require_positive};
use super::{LawError, LawPoint, PressureLaw, saturate, straight};

/// `u` at which the straight continuation begins when no stiffness limit is given: `h = 6 c0`.
const CONTINUATION: f64 = 7.0;

/// The exponential curve with its straight continuation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponential {
    clearance_at_zero_pressure: f64,
    pressure_at_zero_clearance: f64,
    stiffness_max: Option<f64>,
    /// `p0 / (e - 1)` \[pressure\].
    scale: f64,
    /// Overclosure where the straight continuation begins \[length\].
    switch: f64,
    /// Values there.
    at_switch: LawPoint,
}

impl Exponential {
    /// With the straight continuation beyond an overclosure of six times the clearance. Refuses parameters
    /// (clearance \[length\], pressure \[pressure\]) that are not positive and finite.
    pub fn new(clearance_at_zero_pressure: f64, pressure_at_zero_clearance: f64) -> Result<Self, LawError> {
        Self::build(clearance_at_zero_pressure, pressure_at_zero_clearance, None)
    }

    /// With a limit of the slope [pressure/length], beyond which the curve goes on straight (Abaqus/Explicit).
    pub fn with_stiffness_max(
        clearance_at_zero_pressure: f64,
        pressure_at_zero_clearance: f64,
        stiffness_max: f64,
    ) -> Result<Self, LawError> {
        Self::build(clearance_at_zero_pressure, pressure_at_zero_clearance, Some(stiffness_max))
    }

    pub(super) fn build(c0: f64, p0: f64, stiffness_max: Option<f64>) -> Result<Self, LawError> {
        if let Some(error) = violations(c0, p0, stiffness_max).into_iter().next() {
            return Err(error);
        }
        let scale = p0 / (E - 1.0);
        let u = match stiffness_max {
            None => CONTINUATION,
            Some(limit) => reduced_at_slope(limit * (c0 / scale)),
        };
        let mut at_switch = curve(u, scale, c0);
        if let Some(limit) = stiffness_max {
            at_switch.stiffness = limit;
        }
        Ok(Self {
            clearance_at_zero_pressure: c0,
            pressure_at_zero_clearance: p0,
            stiffness_max,
            scale,
            switch: c0 * (u - 1.0),
            at_switch,
        })
    }

    /// Clearance at which the pressure begins, c0 \[length\].
    pub fn clearance_at_zero_pressure(&self) -> f64 {
        self.clearance_at_zero_pressure
    }

    /// Pressure at zero clearance, p0 \[pressure\].
    pub fn pressure_at_zero_clearance(&self) -> f64 {
        self.pressure_at_zero_clearance
    }

    /// Limit of the slope [pressure/length], if given.
    pub fn stiffness_max(&self) -> Option<f64> {
        self.stiffness_max
    }

    /// Overclosure at which the straight continuation begins \[length\]; negative when that is a clearance.
    pub fn continuation_start(&self) -> f64 {
        self.switch
    }
}

impl PressureLaw for Exponential {
    fn evaluate(&self, overclosure: f64) -> LawPoint {
        if overclosure >= self.switch {
            let LawPoint { pressure, stiffness, energy } = self.at_switch;
            return straight(overclosure - self.switch, pressure, stiffness, energy);
        }
        // The sum is exact near -c0, where the quotient h/c0 + 1 would cancel.
        let u = (self.clearance_at_zero_pressure + overclosure) / self.clearance_at_zero_pressure;
        if u <= 0.0 {
            return LawPoint::default();
        }
        curve(u, self.scale, self.clearance_at_zero_pressure)
    }

    fn kinks(&self) -> Vec<f64> {
        Vec::new()
    }

    fn overclosure_at(&self, pressure: f64) -> f64 {
        let c0 = self.clearance_at_zero_pressure;
        if pressure <= 0.0 {
            -c0
        } else if pressure >= self.at_switch.pressure {
            saturate(self.switch + (pressure - self.at_switch.pressure) / self.at_switch.stiffness)
        } else {
            c0 * reduced_at_pressure(pressure / self.scale) - c0
        }
    }
}

/// The curve itself at `u` in (0, switch].
fn curve(u: f64, scale: f64, c0: f64) -> LawPoint {
    let (grown, exp) = (u.exp_m1(), u.exp());
    LawPoint {
        pressure: scale * (u * grown),
        stiffness: (scale / c0) * (grown + u * exp),
        energy: saturate(scale * c0 * reduced_energy(u, exp)),
    }
}

/// `(u - 1) exp(u) + 1 - u^2/2`, which cancels below u = 1/2: there by its series, sum of u^(k+2) / (k! (k+2)).
fn reduced_energy(u: f64, exp: f64) -> f64 {
    if u >= 0.5 {
        return (u - 1.0) * exp + 1.0 - 0.5 * u * u;
    }
    let (mut power, mut sum) = (u * u, 0.0);
    for k in 1..=18 {
        power *= u / f64::from(k);
        sum += power / f64::from(k + 2);
    }
    sum
}

/// `u` with `(u + 1) exp(u) - 1 = kappa`. The function is increasing and convex and both starting values lie to the right
/// of the root, so Newton's iteration falls towards it.
fn reduced_at_slope(kappa: f64) -> f64 {
    newton((0.5 * kappa).min(kappa.ln_1p()), |u| {
        let (grown, exp) = (u.exp_m1(), u.exp());
        (grown + u * exp - kappa, (u + 2.0) * exp)
    })
}

/// `u` with `u (exp(u) - 1) = y`. Increasing and convex; at most the first step comes from the left.
fn reduced_at_pressure(y: f64) -> f64 {
    newton(if y < 1.0 { y.sqrt() } else { y.ln_1p() }, |u| {
        let (grown, exp) = (u.exp_m1(), u.exp());
        (u * grown - y, grown + u * exp)
    })
}

/// Newton's iteration for a positive root; stops at four units in the last place, because below that it may oscillate.
fn newton(start: f64, value_and_slope: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut u = start;
    // Quadratic convergence from a start within a factor of a few: six steps suffice, the bound is a safeguard.
    for _ in 0..60 {
        let (value, slope) = value_and_slope(u);
        if value == 0.0 || slope == 0.0 {
            break;
        }
        let change = value / slope;
        u -= change;
        if change.abs() <= 4.0 * f64::EPSILON * u {
            break;
        }
    }
    u
}

/// Everything that is wrong with the parameters.
pub(super) fn violations(c0: f64, p0: f64, stiffness_max: Option<f64>) -> Vec<LawError> {
    let mut findings = Vec::new();
    require_positive(&mut findings, "clearance_at_zero_pressure (c0)", c0);
    require_positive(&mut findings, "pressure_at_zero_clearance (p0)", p0);
    if let Some(limit) = stiffness_max {
        require_positive(&mut findings, "stiffness_max (kmax)", limit);
    }
    if !findings.is_empty() {
        return findings;
    }
    let scale = p0 / (E - 1.0);
    require_in_range(&mut findings, "exponential", "the range of clearance", c0 * CONTINUATION);
    match stiffness_max {
        None => {
            let end = curve(CONTINUATION, scale, c0);
            require_in_range(&mut findings, "exponential", "the largest slope", end.stiffness);
            require_in_range(&mut findings, "exponential", "the largest curved pressure", end.pressure);
        }
        Some(limit) => {
            // Up to about 709 the exponential itself is representable.
            let kappa = limit * (c0 / scale);
            require_in_range(&mut findings, "exponential", "stiffness_max c0 (e-1)/p0", kappa);
            if findings.is_empty() {
                let end = curve(reduced_at_slope(kappa), scale, c0);
                require_in_range(&mut findings, "exponential", "the pressure at stiffness_max", end.pressure);
                require_in_range(&mut findings, "exponential", "the initial slope", scale / c0);
            }
        }
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::check::{assert_close, assert_finite_everywhere, assert_inverse, check_law};

    fn law() -> Exponential {
        Exponential::new(0.01, 5.0).unwrap()
    }

    #[test]
    fn slope_and_pressure_are_derivatives() {
        let samples = [-0.02, -0.009, -0.005, -0.0049, 0.0, 0.01, 0.03, 0.0599, 0.0601, 0.2];
        check_law(&law(), &samples, 1e-6);
        check_law(&law(), &[-0.0099], 1e-8);
        let limited = Exponential::with_stiffness_max(0.01, 5.0, 2e4).unwrap();
        check_law(&limited, &[-0.02, -0.005, 0.0, 0.0188, 0.0189, 0.05, 0.5], 1e-6);
        let early = Exponential::with_stiffness_max(0.01, 5.0, 500.0).unwrap();
        check_law(&early, &[-0.02, -0.008, -0.004, 0.0, 0.05, 0.5], 1e-6);
    }

    #[test]
    fn take_off_is_accurate_to_the_last_digits_near_the_onset() {
        // p = a u (u + u^2/2 + u^3/6 + ...), U = a c0 (u^3/3 + u^4/8 + ...) with u exact by construction.
        let law = Exponential::new(1.0, E - 1.0).unwrap();
        for n in [20, 30, 40, 50] {
            let u = 0.5f64.powi(n);
            let at = law.evaluate(u - 1.0);
            assert_close(at.pressure, u * u * (1.0 + u / 2.0 + u * u / 6.0), 1e-15, 0.0);
            assert_close(at.stiffness, 2.0 * u + 1.5 * u * u, 1e-12, 0.0);
            assert_close(at.energy, u * u * u / 3.0 + u.powi(4) / 8.0, 1e-12, 0.0);
        }
    }

    #[test]
    fn both_forms_of_the_energy_agree_where_they_meet() {
        let u: f64 = 0.5;
        let below = f64::from_bits(u.to_bits() - 1);
        assert_close(reduced_energy(below, below.exp()), reduced_energy(u, u.exp()), 1e-14, 0.0);
    }

    #[test]
    fn clearance_beyond_c0_gives_no_pressure() {
        for h in [-0.01, -0.0100001, -1.0, -1e300] {
            assert_eq!(law().evaluate(h), LawPoint::default());
        }
    }

    #[test]
    fn the_continuation_is_smooth() {
        for law in [law(), Exponential::with_stiffness_max(0.01, 5.0, 500.0).unwrap()] {
            let at = law.continuation_start();
            let (below, above) = (law.evaluate(at - 1e-12), law.evaluate(at + 1e-12));
            assert_close(above.pressure, below.pressure, 1e-9, 0.0);
            assert_close(above.stiffness, below.stiffness, 1e-8, 0.0);
        }
    }

    #[test]
    fn a_low_stiffness_limit_acts_while_the_surfaces_are_apart() {
        let law = Exponential::with_stiffness_max(0.01, 5.0, 500.0).unwrap();
        assert!(law.continuation_start() < 0.0 && law.continuation_start() > -0.01);
        assert!(law.evaluate(0.0).pressure < 5.0);
        assert_eq!(law.evaluate(0.0).stiffness, 500.0);
    }

    #[test]
    fn extremes_saturate_instead_of_overflowing() {
        for (c0, p0) in [(0.01, 5.0), (1e-150, 1e150), (1e150, 1e-150), (1e-9, 1e12), (1e307, 1e300)] {
            assert_finite_everywhere(&Exponential::new(c0, p0).unwrap());
        }
        for limit in [1e-100, 1.0, 1e200] {
            assert_finite_everywhere(&Exponential::with_stiffness_max(0.01, 5.0, limit).unwrap());
        }
    }

    #[test]
    fn inverse_returns_the_overclosure() {
        let samples = [-0.00999, -0.009, -0.003, 0.0, 0.002, 0.01, 0.05, 0.06, 0.3, 1e5];
        assert_inverse(&law(), &samples, -0.01);
        let limited = Exponential::with_stiffness_max(0.01, 5.0, 500.0).unwrap();
        assert_inverse(&limited, &[-0.009, -0.004, 0.0, 0.3], -0.01);
    }

    #[test]
    fn every_wrong_parameter_is_named() {
        assert_eq!(violations(0.0, -1.0, Some(f64::NAN)).len(), 3);
        for (c0, p0, name) in [(-0.01, 5.0, "clearance_at_zero_pressure"), (0.01, 0.0, "pressure_at_zero_clearance")] {
            assert!(Exponential::new(c0, p0).unwrap_err().to_string().contains(name));
        }
        assert!(matches!(Exponential::new(1e-300, 1e300), Err(LawError::OutOfRange { .. })));
        assert!(matches!(Exponential::new(1e308, 1.0), Err(LawError::OutOfRange { .. })));
    }
}
