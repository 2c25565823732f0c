//! Analytical rigid surfaces: `*SURFACE, TYPE=CYLINDER` and `TYPE=REVOLUTION`.
//!
//! ```text
//! CYLINDER     a and b on the first line: origin, and a point on the local x-axis; c on the second: a point along the direction
//!              in which the profile is swept, which is the negative local z-axis. Then the profile in (x, y).
//! REVOLUTION   a and b: origin, and a point on the axis, the local z-axis. Then the profile in (r, z).
//! profile      START, x, y;  LINE, x, y;  CIRCL, x, y, centre x, centre y
//! ```

use crate::contact::points::direction;
use crate::element::quad::{cross, dot, norm, sub};
use crate::model::{AnalyticalSurface, Segment, SurfaceKind, Sweep};

use super::super::card::Card;
use super::super::data::Row;
use super::super::lex::key;
use super::super::report::excerpt;
use super::Builder;

const SURFACE: &str = "*SURFACE";
const PROFILE: &str = "write START, x, y, then LINE, x, y or CIRCL, x, y, centre x, centre y";
/// Part of the radius by which the ends of an arc may lie off its circle: decks are written with few digits.
const OFF_CIRCLE: f64 = 1e-3;
/// Sine below which directions are parallel.
const PARALLEL: f64 = 1e-6;

impl Builder<'_> {
    /// Surface of a card; none when it is wrong, which is reported.
    pub(super) fn analytical_surface(&mut self, card: &Card, sweep: Sweep) -> Option<SurfaceKind> {
        let rows: Vec<Row<'_>> = card.lines().iter().map(|line| line.row(SURFACE)).collect();
        let count = if sweep == Sweep::Translation { 2 } else { 1 };
        let is_profile = |row: &Row<'_>| key(row.text(0)) == "START";
        let begin = rows.iter().position(is_profile);
        let Some(begin) = begin else {
            self.report.error(card.at, SURFACE, "the profile has no START", PROFILE);
            return None;
        };
        if begin != count {
            let what = match sweep {
                Sweep::Translation => "write a line with the points a and b, a line with the point c, then the profile",
                Sweep::Revolution => "write a line with the points a and b, then the profile",
            };
            let message =
                format!("{begin} lines stand before START; TYPE={} has {count}", card.parameters.word("TYPE"));
            self.report.error(rows[begin].at, SURFACE, message, what);
            return None;
        }
        let first = self.numbers::<6>(&rows[0], 0)?;
        let [a, b] = [[first[0], first[1], first[2]], [first[3], first[4], first[5]]];
        let axes = match sweep {
            Sweep::Translation => {
                let c = self.numbers::<3>(&rows[1], 0)?;
                let (x, generator) = (sub(b, a), sub(c, a));
                if norm(cross(x, generator)) <= PARALLEL * norm(x) * norm(generator) {
                    let message = "the points a, b and c lie on one line";
                    self.report.error(
                        rows[1].at,
                        SURFACE,
                        message,
                        "give b on the local x-axis, and c along the sweep",
                    );
                    return None;
                }
                let x = direction(x);
                let along = dot(generator, x);
                let z = direction(std::array::from_fn(|i| along * x[i] - generator[i]));
                [x, cross(z, x), z]
            }
            Sweep::Revolution => {
                let z = sub(b, a);
                if norm(z) == 0.0 {
                    self.report.error(rows[0].at, SURFACE, "the points a and b coincide", "give b on the axis");
                    return None;
                }
                let z = direction(z);
                let least = (0..3).min_by(|&i, &j| z[i].abs().total_cmp(&z[j].abs())).unwrap_or(0);
                let unit: [f64; 3] = std::array::from_fn(|i| f64::from(u8::from(i == least)));
                let x = direction(cross(unit, z));
                [x, cross(z, x), z]
            }
        };
        let segments = self.profile(&rows[begin..], sweep)?;
        let index = self.model.mesh.analytical.len() as u32;
        self.model.mesh.analytical.push(AnalyticalSurface { body: None, sweep, origin: a, axes, segments });
        Some(SurfaceKind::Analytical(index))
    }

    fn numbers<const N: usize>(&mut self, row: &Row<'_>, first: usize) -> Option<[f64; N]> {
        row.at_most(first + N, self.report);
        let mut out = [0.0; N];
        for (i, value) in out.iter_mut().enumerate() {
            *value = row.real(first + i, "coordinate", None, self.report)?;
        }
        Some(out)
    }

    fn profile(&mut self, rows: &[Row<'_>], sweep: Sweep) -> Option<Vec<Segment>> {
        let mut at = self.numbers::<2>(&rows[0], 1)?;
        let mut segments = Vec::new();
        for row in &rows[1..] {
            let segment = match key(row.text(0)).as_str() {
                "LINE" => Segment { start: at, end: self.numbers::<2>(row, 1)?, centre: None },
                "CIRCL" => {
                    let [x, y, centre @ ..] = self.numbers::<4>(row, 1)?;
                    Segment { start: at, end: [x, y], centre: Some(centre) }
                }
                "PARAB" => {
                    let remedy = "approximate the parabola by arcs: CIRCL, x, y, centre x, centre y";
                    self.report.error(row.at, SURFACE, "parabolic segments are not solved", remedy);
                    return None;
                }
                _ => {
                    let message = format!("there is no segment {}", excerpt(row.text(0).as_bytes()));
                    self.report.error(row.at, SURFACE, message, PROFILE);
                    return None;
                }
            };
            if let Some((message, remedy)) = fault(&segment, sweep) {
                self.report.error(row.at, SURFACE, message, remedy);
                return None;
            }
            at = segment.end;
            segments.push(segment);
        }
        if segments.is_empty() {
            self.report.error(rows[0].at, SURFACE, "the profile has no segment behind START", PROFILE);
            return None;
        }
        Some(segments)
    }
}

/// What is wrong with a segment, and what to do.
fn fault(segment: &Segment, sweep: Sweep) -> Option<(String, &'static str)> {
    let far = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let (start, end) = (segment.start, segment.end);
    if far(start, end) == 0.0 {
        return Some(("the segment ends where it begins".into(), "remove it; a circle takes three arcs or more"));
    }
    if sweep == Sweep::Revolution && (start[0] < 0.0 || end[0] < 0.0) {
        return Some(("the profile crosses the axis: r is negative".into(), "give r >= 0"));
    }
    let centre = segment.centre?;
    let (one, other) = (far(start, centre), far(end, centre));
    if (one - other).abs() > OFF_CIRCLE * one.max(other) {
        let message = format!("the ends of the arc are {one} and {other} away from its centre");
        return Some((message, "give the centre of the arc"));
    }
    let cross = (start[0] - centre[0]) * (end[1] - centre[1]) - (start[1] - centre[1]) * (end[0] - centre[0]);
    (cross.abs() <= PARALLEL * one * other).then(|| {
        ("the arc is 180 degrees long, or has no length".into(), "divide it: an arc is shorter than 180 degrees")
    })
}
