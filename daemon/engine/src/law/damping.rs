//! Contact damping: a viscous pressure that grows with the closing speed.
//!
//! With the clearance `c = −h`
//!
//! ```text
//! p_v = mu(c) dh/dt,   mu = mu0                            c ≤ η c0
//!                      mu = mu0 (c0 − c) / (c0 (1 − η))    η c0 < c < c0
//!                      mu = 0                              c ≥ c0
//! ```
//!
//! Acts at open and closed points; separation gives suction, `p_v < 0`. Source: Abaqus Analysis User's Manual v6.5, 22.1.3,
//! DEFINITION=DAMPING COEFFICIENT in Abaqus/Standard; the ramp is restored from the text.

/// Damping coefficient as a function of the clearance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Damping {
    /// `mu0` \[pressure·time/length\].
    pub coefficient: f64,
    /// `c0` \[length\], positive.
    pub clearance: f64,
    /// `η`, in 0..1.
    pub fraction: f64,
}

impl Damping {
    /// Coefficient \[pressure·time/length\] at an overclosure \[length\], and its slope over the overclosure.
    pub fn at(&self, overclosure: f64) -> (f64, f64) {
        let clearance = -overclosure;
        if clearance >= self.clearance {
            return (0.0, 0.0);
        }
        if clearance <= self.fraction * self.clearance {
            return (self.coefficient, 0.0);
        }
        let slope = self.coefficient / (self.clearance * (1.0 - self.fraction));
        (slope * (self.clearance - clearance), slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::check::assert_close;

    #[test]
    fn the_ramp_ends_at_the_clearance() {
        let damping = Damping { coefficient: 8.0, clearance: 0.1, fraction: 0.4 };
        let rows = [
            (-0.01, 8.0),
            (0.0, 8.0),
            (0.02, 8.0),
            (0.04, 8.0),
            (0.06, 16.0 / 3.0),
            (0.08, 8.0 / 3.0),
            (0.1, 0.0),
            (0.2, 0.0),
        ];
        for (clearance, expected) in rows {
            assert_close(damping.at(-clearance).0, expected, 1e-13, 1e-15);
        }
    }

    #[test]
    fn the_slope_is_that_of_the_coefficient() {
        let damping = Damping { coefficient: 8.0, clearance: 0.1, fraction: 0.4 };
        for clearance in [-0.05, 0.02, 0.05, 0.09, 0.3] {
            let step = 1e-6;
            let difference = (damping.at(-clearance + step).0 - damping.at(-clearance - step).0) / (2.0 * step);
            assert_close(damping.at(-clearance).1, difference, 1e-7, 1e-6);
        }
    }
}
