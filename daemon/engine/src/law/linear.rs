//! Linear pressure-overclosure relationship.
//!
//! ```text
//! p(h) = k h        h >  0        U(h) = k h^2 / 2
//! p(h) = 0          h <= 0        U(h) = 0
//! ```
//!
//! * `h` overclosure \[length\], positive when the bodies overlap; `p` pressure \[pressure\], positive in compression;
//!   `k` contact stiffness [pressure/length]; `U` energy \[pressure*length\].
//! * Domain: every finite `h`; `k` positive and finite.
//! * Kinks: the slope jumps from 0 to `k` at `h = 0`; at that point it is 0.
//! * Source: Abaqus Analysis User's Manual v6.5, 22.1.2, "Softened contact defined as a linear function".

use super::error::require_positive;
use super::{LawError, LawPoint, PressureLaw, saturate, straight};

/// Pressure proportional to the overclosure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear {
    stiffness: f64,
}

impl Linear {
    /// Refuses a stiffness [pressure/length] that is not finite and positive.
    pub fn new(stiffness: f64) -> Result<Self, LawError> {
        match violations(stiffness).into_iter().next() {
            Some(error) => Err(error),
            None => Ok(Self { stiffness }),
        }
    }

    /// Contact stiffness [pressure/length].
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }
}

impl PressureLaw for Linear {
    fn evaluate(&self, overclosure: f64) -> LawPoint {
        if overclosure <= 0.0 {
            return LawPoint::default();
        }
        straight(overclosure, 0.0, self.stiffness, 0.0)
    }

    fn kinks(&self) -> Vec<f64> {
        vec![0.0]
    }

    fn overclosure_at(&self, pressure: f64) -> f64 {
        if pressure <= 0.0 { 0.0 } else { saturate(pressure / self.stiffness) }
    }
}

/// Everything that is wrong with the parameters.
pub(super) fn violations(stiffness: f64) -> Vec<LawError> {
    let mut findings = Vec::new();
    require_positive(&mut findings, "stiffness (slope k)", stiffness);
    findings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::check::{assert_finite_everywhere, assert_inverse, check_law};

    #[test]
    fn slope_and_pressure_are_derivatives() {
        let law = Linear::new(250.0).unwrap();
        check_law(&law, &[-1.0, -0.01, 0.01, 0.4, 3.0], 1e-4);
    }

    #[test]
    fn touching_without_overclosure_gives_nothing() {
        assert_eq!(Linear::new(250.0).unwrap().evaluate(0.0), LawPoint::default());
        assert_eq!(Linear::new(250.0).unwrap().evaluate(-0.0), LawPoint::default());
    }

    #[test]
    fn extremes_saturate_instead_of_overflowing() {
        for stiffness in [1e-300, 1.0, 1e300] {
            assert_finite_everywhere(&Linear::new(stiffness).unwrap());
        }
        assert_eq!(Linear::new(1e300).unwrap().evaluate(1e300).pressure, f64::MAX);
    }

    #[test]
    fn inverse_returns_the_overclosure() {
        assert_inverse(&Linear::new(250.0).unwrap(), &[1e-12, 0.02, 7.0], 0.0);
    }

    #[test]
    fn stiffness_must_be_positive_and_finite() {
        for stiffness in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let error = Linear::new(stiffness).unwrap_err().to_string();
            assert!(error.contains("stiffness") && error.contains(&stiffness.to_string()), "{error}");
        }
    }
}
