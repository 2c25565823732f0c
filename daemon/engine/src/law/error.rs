//! Why a law cannot be made from its parameters.

/// A parameter that a law refuses. Names are those of the documentation, values those that were given.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LawError {
    /// NaN, infinite, zero or negative where the law needs a positive number.
    #[error("{parameter} must be a positive finite number, not {value}")]
    NotPositive {
        /// Name of the parameter.
        parameter: &'static str,
        /// The value.
        value: f64,
    },
    /// A number outside what the law allows.
    #[error("{parameter} must be {bounds}, not {value}")]
    OutOfBounds {
        /// Name of the parameter.
        parameter: &'static str,
        /// What is allowed, in words.
        bounds: &'static str,
        /// The value.
        value: f64,
    },
    /// A table that is no curve.
    #[error("a table needs at least two points (pressure, overclosure); this one has {count}")]
    TooFewPoints {
        /// Number of points.
        count: usize,
    },
    /// NaN or infinity in a table.
    #[error("table point {row}: {quantity} {value} is not a finite number")]
    PointNotFinite {
        /// Number of the point, from 1.
        row: usize,
        /// `pressure` or `overclosure`.
        quantity: &'static str,
        /// The value.
        value: f64,
    },
    /// A table that does not rise.
    #[error(
        "table point {row}: {quantity} {value} does not exceed {previous} of the point before; \
         both pressure and overclosure must increase from point to point"
    )]
    NotIncreasing {
        /// Number of the point, from 1.
        row: usize,
        /// `pressure` or `overclosure`.
        quantity: &'static str,
        /// The value.
        value: f64,
        /// That of the point before.
        previous: f64,
    },
    /// A table that begins with a jump.
    #[error(
        "the first pressure of a table must be zero, not {pressure} (at overclosure {overclosure}), else the pressure would jump \
         there; begin the table with the overclosure of zero pressure"
    )]
    FirstPressureNotZero {
        /// First pressure.
        pressure: f64,
        /// First overclosure.
        overclosure: f64,
    },
    /// Parameters each in order, but so far apart that the curve leaves the range of numbers.
    #[error(
        "the {law} law cannot be represented: {quantity} of its curve is {value}; the parameters are out of any sensible range"
    )]
    OutOfRange {
        /// Kind of law.
        law: &'static str,
        /// What overflows or vanishes.
        quantity: &'static str,
        /// What it became.
        value: f64,
    },
}

/// Appends a finding unless `value` is positive and finite.
pub(super) fn require_positive(findings: &mut Vec<LawError>, parameter: &'static str, value: f64) {
    if !(value.is_finite() && value > 0.0) {
        findings.push(LawError::NotPositive { parameter, value });
    }
}

/// Appends a finding unless a derived constant is positive and finite.
pub(super) fn require_in_range(findings: &mut Vec<LawError>, law: &'static str, quantity: &'static str, value: f64) {
    if !(value.is_finite() && value > 0.0) {
        findings.push(LawError::OutOfRange { law, quantity, value });
    }
}

/// Appends a finding unless `value` is finite and within what the words say.
pub(super) fn require(
    findings: &mut Vec<LawError>,
    parameter: &'static str,
    bounds: &'static str,
    value: f64,
    within: bool,
) {
    if !(value.is_finite() && within) {
        findings.push(LawError::OutOfBounds { parameter, bounds, value });
    }
}
