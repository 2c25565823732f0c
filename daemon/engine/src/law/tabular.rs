//! Tabular (piecewise linear) pressure-overclosure relationship.
//!
//! ```text
//! p(h) = 0                                                h <= h_1
//! p(h) = p_i + s_i (h - h_i)                   h_i <= h <= h_i+1,  s_i = (p_i+1 - p_i) / (h_i+1 - h_i)
//! p(h) = p_n + s_n-1 (h - h_n)                            h >= h_n
//! U(h) = integral of p from h_1 to h
//! ```
//!
//! * `h` overclosure \[length\], positive when the bodies overlap; `p` pressure \[pressure\], positive in compression;
//!   `(p_i, h_i)` the points of the table in the manual's order; `U` energy \[pressure*length\].
//! * Domain: every finite `h`. At least two points, pressure and overclosure strictly increasing, `p_1 = 0`.
//!   `h_1` may be negative: pressure then begins at a clearance.
//! * Kinks: every point of the table. At `h_1` the slope is 0, at the others it is that of the segment to the right.
//! * Source: Abaqus Analysis User's Manual v6.5, 22.1.2, "Softened contact defined in tabular form".

use super::{LawError, LawPoint, PressureLaw, saturate, straight};

/// A vertex and the segment that begins there.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Segment {
    overclosure: f64,
    pressure: f64,
    /// Slope to the right; the last vertex repeats the last slope.
    stiffness: f64,
    /// Energy at the vertex.
    energy: f64,
}

/// Piecewise linear pressure.
#[derive(Clone, Debug, PartialEq)]
pub struct Tabular {
    segments: Vec<Segment>,
}

impl Tabular {
    /// From points (pressure \[pressure\], overclosure \[length\]), the manual's order. Refuses fewer than two points,
    /// numbers that are not finite, values that do not increase, and a first pressure other than 0.
    pub fn new(points: &[(f64, f64)]) -> Result<Self, LawError> {
        match violations(points).into_iter().next() {
            Some(error) => Err(error),
            None => Ok(Self { segments: segments(points) }),
        }
    }

    /// The points (pressure, overclosure).
    pub fn points(&self) -> Vec<(f64, f64)> {
        self.segments.iter().map(|s| (s.pressure, s.overclosure)).collect()
    }

    /// Overclosure at which pressure begins \[length\].
    pub fn onset(&self) -> f64 {
        self.segments[0].overclosure
    }

    /// Slope of the first segment [pressure/length].
    pub fn stiffness_first(&self) -> f64 {
        self.segments[0].stiffness
    }
}

impl PressureLaw for Tabular {
    fn evaluate(&self, overclosure: f64) -> LawPoint {
        if overclosure <= self.onset() {
            return LawPoint::default();
        }
        let right = self.segments.partition_point(|s| s.overclosure <= overclosure);
        // NaN compares below nothing, so it finds no segment; the first one turns it into NaN.
        let s = &self.segments[right.max(1) - 1];
        straight(saturate(overclosure - s.overclosure), s.pressure, s.stiffness, s.energy)
    }

    fn kinks(&self) -> Vec<f64> {
        self.segments.iter().map(|s| s.overclosure).collect()
    }

    fn overclosure_at(&self, pressure: f64) -> f64 {
        if pressure <= 0.0 {
            return self.onset();
        }
        let right = self.segments.partition_point(|s| s.pressure <= pressure);
        let s = &self.segments[right.max(1) - 1];
        saturate(s.overclosure + (pressure - s.pressure) / s.stiffness)
    }
}

fn segments(points: &[(f64, f64)]) -> Vec<Segment> {
    let mut segments = Vec::with_capacity(points.len());
    let mut energy = 0.0;
    for pair in points.windows(2) {
        let [(p0, h0), (p1, h1)] = [pair[0], pair[1]];
        segments.push(Segment { overclosure: h0, pressure: p0, stiffness: slope(pair[0], pair[1]), energy });
        energy = saturate(energy + (0.5 * p0 + 0.5 * p1) * (h1 - h0));
    }
    if let (Some(&(pressure, overclosure)), Some(&Segment { stiffness, .. })) = (points.last(), segments.last()) {
        segments.push(Segment { overclosure, pressure, stiffness, energy });
    }
    segments
}

fn slope(from: (f64, f64), to: (f64, f64)) -> f64 {
    (to.0 - from.0) / (to.1 - from.1)
}

/// Everything that is wrong with the points.
pub(super) fn violations(points: &[(f64, f64)]) -> Vec<LawError> {
    let mut findings = Vec::new();
    if points.len() < 2 {
        findings.push(LawError::TooFewPoints { count: points.len() });
    }
    for (row, &(pressure, overclosure)) in (1..).zip(points) {
        for (quantity, value) in [("pressure", pressure), ("overclosure", overclosure)] {
            if !value.is_finite() {
                findings.push(LawError::PointNotFinite { row, quantity, value });
            }
        }
    }
    if !findings.is_empty() {
        return findings;
    }
    if let Some(&(pressure, overclosure)) = points.first()
        && pressure != 0.0
    {
        findings.push(LawError::FirstPressureNotZero { pressure, overclosure });
    }
    for (row, pair) in (2..).zip(points.windows(2)) {
        let before = findings.len();
        for (quantity, value, previous) in [("pressure", pair[1].0, pair[0].0), ("overclosure", pair[1].1, pair[0].1)] {
            if value <= previous {
                findings.push(LawError::NotIncreasing { row, quantity, value, previous });
            }
        }
        let value = slope(pair[0], pair[1]);
        if findings.len() == before && !(value.is_finite() && value > 0.0) {
            findings.push(LawError::OutOfRange { law: "tabular", quantity: "a slope", value });
        }
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::Linear;
    use crate::law::check::{assert_finite_everywhere, assert_inverse, check_law};

    const POINTS: [(f64, f64); 4] = [(0.0, -0.02), (2.0, 0.01), (10.0, 0.02), (40.0, 0.03)];

    #[test]
    fn slope_and_pressure_are_derivatives() {
        let law = Tabular::new(&POINTS).unwrap();
        check_law(&law, &[-0.03, -0.01, 0.005, 0.015, 0.025, 0.05], 1e-5);
    }

    #[test]
    fn two_points_from_the_origin_are_the_linear_law_to_the_bit() {
        let (table, line) = (Tabular::new(&[(0.0, 0.0), (250.0, 1.0)]).unwrap(), Linear::new(250.0).unwrap());
        for h in [-1.0, 0.0, 1e-9, 0.3, 1.0, 7.0] {
            let (a, b) = (table.evaluate(h), line.evaluate(h));
            assert_eq!(a.stiffness, b.stiffness, "at {h}");
            assert!((a.pressure - b.pressure).abs() <= 1e-15 * b.pressure, "at {h}");
            assert!((a.energy - b.energy).abs() <= 2e-15 * b.energy, "at {h}");
        }
    }

    #[test]
    fn vertices_give_exactly_the_pressures_of_the_table() {
        let law = Tabular::new(&POINTS).unwrap();
        for (p, h) in POINTS {
            assert_eq!(law.evaluate(h).pressure, p);
        }
    }

    #[test]
    fn extremes_saturate_instead_of_overflowing() {
        assert_finite_everywhere(&Tabular::new(&POINTS).unwrap());
        assert_finite_everywhere(&Tabular::new(&[(0.0, -1e308), (1e308, 0.0)]).unwrap());
        assert_finite_everywhere(&Tabular::new(&[(0.0, 0.0), (1e300, 1e-5)]).unwrap());
    }

    #[test]
    fn inverse_returns_the_overclosure() {
        let law = Tabular::new(&POINTS).unwrap();
        assert_inverse(&law, &[-0.019, 0.0, 0.01, 0.013, 0.02, 0.03, 2.0], -0.02);
    }

    #[test]
    fn every_fault_of_a_table_is_reported() {
        let findings = violations(&[(1.0, 0.0), (0.5, 0.1), (3.0, 0.1)]);
        assert_eq!(findings.len(), 3, "{findings:?}");
        assert!(matches!(findings[0], LawError::FirstPressureNotZero { .. }));
        assert!(matches!(findings[1], LawError::NotIncreasing { row: 2, quantity: "pressure", .. }));
        assert!(matches!(findings[2], LawError::NotIncreasing { row: 3, quantity: "overclosure", .. }));
        assert!(matches!(violations(&[(0.0, 0.0)])[..], [LawError::TooFewPoints { count: 1 }]));
        assert!(matches!(
            violations(&[(0.0, 0.0), (f64::NAN, 1.0)])[..],
            [LawError::PointNotFinite { row: 2, quantity: "pressure", .. }]
        ));
        assert!(matches!(violations(&[(0.0, 0.0), (1e308, 1e-308)])[..], [LawError::OutOfRange { .. }]));
    }
}
