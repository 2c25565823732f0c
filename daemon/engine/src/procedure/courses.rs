//! What the coefficient of a column does during a step: its value at any time, and for prescribed directions its rates.

use rustc_hash::FxHashMap;

use crate::model::{Amplitude, AmplitudeClock, AmplitudeId, BoundaryKind, Model};

/// What a column does during a step. For a prescribed velocity or acceleration it is this that takes the course, and the displacement
/// is its integral.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Course {
    /// Not begun yet, or standing at its last value.
    Hold,
    /// From the value at the start of the step linearly to the magnitude at its end.
    Ramp {
        /// Value at the end of the step.
        magnitude: f64,
    },
    /// The magnitude from the start of the step on.
    Step {
        /// The value.
        magnitude: f64,
    },
    /// Linearly over the step, from a value that the deck fixes: accelerations, which are not part of the state.
    Line {
        /// Value at the start of the step.
        from: f64,
        /// Value at the end of the step.
        magnitude: f64,
    },
    /// Magnitude times amplitude.
    Curve {
        /// Factor of the amplitude.
        magnitude: f64,
        /// The amplitude.
        amplitude: AmplitudeId,
    },
}

impl Course {
    /// The same course with another magnitude.
    pub fn with_magnitude(self, magnitude: f64) -> Self {
        match self {
            Self::Hold => Self::Hold,
            Self::Ramp { .. } => Self::Ramp { magnitude },
            Self::Step { .. } => Self::Step { magnitude },
            Self::Line { from, .. } => Self::Line { from, magnitude },
            Self::Curve { amplitude, .. } => Self::Curve { magnitude, amplitude },
        }
    }
}

/// A time of a step, with what a course needs to know of the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepTime {
    /// Total time at the start of the step.
    pub step_start: f64,
    /// Time since the start of the step.
    pub step_time: f64,
    /// Length of the step.
    pub period: f64,
}

impl StepTime {
    /// A time of a step of a model, by its position.
    pub fn of(model: &Model, step: usize, step_start: f64, step_time: f64) -> Self {
        Self { step_start, step_time, period: model.steps[step].procedure.period() }
    }

    /// Step time, but not beyond the end of the step: there it stands still.
    fn time(&self) -> f64 {
        self.step_time.min(self.period)
    }

    fn clock(&self, amplitude: &Amplitude) -> f64 {
        match amplitude.clock {
            AmplitudeClock::Step => self.time(),
            AmplitudeClock::Total => self.step_start + self.time(),
        }
    }
}

/// Coefficient of a prescribed direction and its rates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ColumnMotion {
    /// Displacement \[length\], or rotation.
    pub value: f64,
    /// Velocity [length/time]; at a kink of an amplitude that before it, at the start of a step that behind it.
    pub rate: f64,
    /// Acceleration [length/time²], with the same choice at kinks; jumps of the velocity have none.
    pub acceleration: f64,
}

impl ColumnMotion {
    /// What a line of a kind prescribes.
    pub fn of(&self, kind: BoundaryKind) -> f64 {
        match kind {
            BoundaryKind::Displacement => self.value,
            BoundaryKind::Velocity => self.rate,
            BoundaryKind::Acceleration => self.acceleration,
        }
    }
}

/// Motion of a direction whose displacement, velocity or acceleration, as its kind says, goes linearly to a value within a length of
/// time: what an input does that is driven from outside. `start` is the motion at the start of that time, `elapsed` what has passed of it.
pub fn driven(kind: BoundaryKind, start: ColumnMotion, to: f64, elapsed: f64, length: f64) -> ColumnMotion {
    let begin = match kind {
        BoundaryKind::Displacement => start.value,
        BoundaryKind::Velocity => start.rate,
        BoundaryKind::Acceleration => start.acceleration,
    };
    let value = if elapsed >= length { to } else { begin + (to - begin) * (elapsed / length) };
    let slope = if length > 0.0 { (to - begin) / length } else { 0.0 };
    let (first, second) = line(begin, slope, elapsed);
    of_kind(kind, start, value, slope, elapsed, first, second)
}

/// Integral and double integral of what begins with a value and grows with a slope.
fn line(from: f64, slope: f64, time: f64) -> (f64, f64) {
    (time * (from + 0.5 * slope * time), time * time * (0.5 * from + slope * time / 6.0))
}

/// Motion from what is prescribed, its slope and its integrals since the start.
fn of_kind(
    kind: BoundaryKind,
    start: ColumnMotion,
    value: f64,
    slope: f64,
    time: f64,
    first: f64,
    second: f64,
) -> ColumnMotion {
    match kind {
        BoundaryKind::Displacement => ColumnMotion { value, rate: slope, acceleration: 0.0 },
        BoundaryKind::Velocity => ColumnMotion { value: start.value + first, rate: value, acceleration: slope },
        BoundaryKind::Acceleration => ColumnMotion {
            value: start.value + start.rate * time + second,
            rate: start.rate + first,
            acceleration: value,
        },
    }
}

/// Value of a column at a time of a step. Of a prescribed velocity or acceleration this is not the displacement:
/// [`Integrals::motion_at`] is.
pub fn value_at(model: &Model, course: Course, step: usize, start_value: f64, step_start: f64, step_time: f64) -> f64 {
    shape(model, course, start_value, &StepTime::of(model, step, step_start, step_time))
}

fn shape(model: &Model, course: Course, start: f64, at: &StepTime) -> f64 {
    let (time, period) = (at.time(), at.period);
    let between = |from: f64, magnitude: f64| {
        if time >= period { magnitude } else { from + (magnitude - from) * (time / period) }
    };
    match course {
        Course::Hold => start,
        Course::Ramp { magnitude } => between(start, magnitude),
        Course::Line { from, magnitude } => between(from, magnitude),
        Course::Step { magnitude } => magnitude,
        Course::Curve { magnitude, amplitude } => {
            let amplitude = &model.amplitudes[amplitude.index()];
            magnitude * amplitude.evaluate(at.clock(amplitude))
        }
    }
}

/// Integrals of amplitudes from the start of a step on, exact: amplitudes are straight between their points.
#[derive(Default)]
pub struct Integrals {
    /// By amplitude and the bits of the clock where the step starts.
    curves: FxHashMap<(AmplitudeId, u64), Vec<Knot>>,
}

/// A kink of an amplitude, or the start of the step.
#[derive(Clone, Copy)]
struct Knot {
    clock: f64,
    factor: f64,
    /// ∫ factor from the start of the step.
    first: f64,
    /// ∬ factor from the start of the step.
    second: f64,
}

impl Integrals {
    /// Prepares an amplitude for a step that starts at a total time.
    pub fn prepare(&mut self, model: &Model, amplitude: AmplitudeId, step_start: f64) {
        let curve = &model.amplitudes[amplitude.index()];
        let start = start_clock(curve, step_start);
        self.curves.entry((amplitude, start.to_bits())).or_insert_with(|| knots(curve, start));
    }

    /// Displacement, velocity and acceleration of a prescribed direction at a time of a step, from displacement and velocity at
    /// its start (`start`; its acceleration is not looked at). Amplitudes of velocities and accelerations have been prepared.
    ///
    /// ```text
    /// velocity v(t):      u = u_0 + ∫ v dt
    /// acceleration a(t):  u = u_0 + v_0 t + ∬ a dt dt
    /// ```
    pub fn motion_at(
        &self,
        model: &Model,
        course: Course,
        kind: BoundaryKind,
        start: ColumnMotion,
        at: &StepTime,
    ) -> ColumnMotion {
        let (time, period) = (at.time(), at.period);
        let begin = match kind {
            BoundaryKind::Displacement => start.value,
            BoundaryKind::Velocity => start.rate,
            BoundaryKind::Acceleration => 0.0,
        };
        let value = shape(model, course, begin, at);
        let between = |from: f64, to: f64| {
            let slope = (to - from) / period;
            let (first, second) = line(from, slope, time);
            (slope, first, second)
        };
        // Slope of the shape, its integral and the integral of that, all since the start of the step.
        let (slope, first, second) = match course {
            Course::Hold | Course::Step { .. } => between(value, value),
            Course::Ramp { magnitude } => between(begin, magnitude),
            Course::Line { from, magnitude } => between(from, magnitude),
            Course::Curve { magnitude, amplitude } => {
                let curve = &model.amplitudes[amplitude.index()];
                let clock = at.clock(curve);
                let (first, second) = match kind {
                    BoundaryKind::Displacement => (0.0, 0.0),
                    _ => self.integrals(amplitude, start_clock(curve, at.step_start), clock, curve),
                };
                let is_start = at.step_time <= 0.0;
                (magnitude * slope(curve, clock, is_start), magnitude * first, magnitude * second)
            }
        };
        of_kind(kind, start, value, slope, time, first, second)
    }

    fn integrals(&self, amplitude: AmplitudeId, start: f64, clock: f64, curve: &Amplitude) -> (f64, f64) {
        let knots = &self.curves[&(amplitude, start.to_bits())];
        // The first knot is the start of the step.
        let behind = knots.partition_point(|knot| knot.clock <= clock).max(1);
        let knot = knots[behind - 1].extended(clock, curve.evaluate(clock));
        (knot.first, knot.second)
    }
}

impl Knot {
    /// Further along a straight piece.
    fn extended(self, clock: f64, factor: f64) -> Self {
        let length = clock - self.clock;
        Self {
            clock,
            factor,
            first: self.first + 0.5 * length * (self.factor + factor),
            second: self.second + length * self.first + length * length * (2.0 * self.factor + factor) / 6.0,
        }
    }
}

fn start_clock(amplitude: &Amplitude, step_start: f64) -> f64 {
    match amplitude.clock {
        AmplitudeClock::Step => 0.0,
        AmplitudeClock::Total => step_start,
    }
}

fn knots(amplitude: &Amplitude, start: f64) -> Vec<Knot> {
    let mut knots = vec![Knot { clock: start, factor: amplitude.evaluate(start), first: 0.0, second: 0.0 }];
    for &(time, factor) in amplitude.points.iter().filter(|&&(time, _)| time > start) {
        knots.push(knots[knots.len() - 1].extended(time, factor));
    }
    knots
}

/// Slope of an amplitude: at a kink that before it, at the start of a step that behind it.
fn slope(amplitude: &Amplitude, clock: f64, is_start: bool) -> f64 {
    let behind = amplitude.points.partition_point(|&(time, _)| if is_start { time <= clock } else { time < clock });
    match (behind.checked_sub(1).map(|i| amplitude.points[i]), amplitude.points.get(behind)) {
        (Some((t0, v0)), Some(&(t1, v1))) => (v1 - v0) / (t1 - t0),
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const START: ColumnMotion = ColumnMotion { value: 3.0, rate: -2.0, acceleration: f64::NAN };

    fn model(clock: AmplitudeClock) -> Model {
        let points = vec![(0.5, 1.0), (1.0, 3.0), (2.0, -1.0), (2.5, 0.5)];
        Model { amplitudes: vec![Amplitude { name: "A".into(), clock, points }], ..Model::default() }
    }

    fn at(course: Course, kind: BoundaryKind, clock: AmplitudeClock, time: f64) -> ColumnMotion {
        let model = model(clock);
        let step_start = 0.75;
        let mut integrals = Integrals::default();
        integrals.prepare(&model, AmplitudeId(0), step_start);
        let at = StepTime { step_start, step_time: time, period: 4.0 };
        integrals.motion_at(&model, course, kind, START, &at)
    }

    /// Rates are the derivatives of what they are rates of, and everything begins where the step begins.
    #[test]
    fn displacements_are_the_integrals_of_what_is_prescribed() {
        let courses = [
            Course::Hold,
            Course::Ramp { magnitude: 1.5 },
            Course::Step { magnitude: 1.5 },
            Course::Line { from: 0.7, magnitude: 1.5 },
            Course::Curve { magnitude: 1.5, amplitude: AmplitudeId(0) },
        ];
        for course in courses {
            for clock in [AmplitudeClock::Step, AmplitudeClock::Total] {
                for kind in [BoundaryKind::Velocity, BoundaryKind::Acceleration] {
                    let begun = at(course, kind, clock, 0.0);
                    assert_eq!(begun.value, START.value);
                    if kind == BoundaryKind::Acceleration || matches!(course, Course::Hold | Course::Ramp { .. }) {
                        assert_eq!(begun.rate, START.rate, "{course:?}");
                    }
                    // Between the kinks of the amplitude on either clock.
                    for time in [0.1, 0.35, 0.8, 1.1, 1.6, 2.2, 3.0] {
                        let step = 1e-4;
                        let (before, now, behind) = (
                            at(course, kind, clock, time - step),
                            at(course, kind, clock, time),
                            at(course, kind, clock, time + step),
                        );
                        let rate = (behind.value - before.value) / (2.0 * step);
                        let acceleration = (behind.rate - before.rate) / (2.0 * step);
                        assert!((now.rate - rate).abs() < 1e-7, "{course:?} {kind:?} {time}: {now:?}, {rate}");
                        assert!((now.acceleration - acceleration).abs() < 1e-7, "{course:?} {kind:?} {time}: {now:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn integrals_of_straight_pieces_are_exact() {
        let curve = Course::Curve { magnitude: 2.0, amplitude: AmplitudeId(0) };
        // 1 up to 0.5, then to 3 at 1: areas 0.5 and 1, first moments about 1 of 0.375 and 5/24.
        let velocity = at(curve, BoundaryKind::Velocity, AmplitudeClock::Step, 1.0);
        assert!((velocity.value - (3.0 + 2.0 * 1.5)).abs() < 1e-15);
        assert_eq!((velocity.rate, velocity.acceleration), (6.0, 8.0));
        let acceleration = at(curve, BoundaryKind::Acceleration, AmplitudeClock::Step, 1.0);
        assert!((acceleration.value - (3.0 - 2.0 + 2.0 * (0.375 + 5.0 / 24.0))).abs() < 1e-15);
        assert_eq!((acceleration.rate, acceleration.acceleration), (-2.0 + 3.0, 6.0));
        // Beyond the last point the last factor goes on.
        let held = at(curve, BoundaryKind::Velocity, AmplitudeClock::Step, 3.5);
        let later = at(curve, BoundaryKind::Velocity, AmplitudeClock::Step, 4.0);
        assert!((later.value - held.value - 0.5).abs() < 1e-15);
        // Beyond its end the step stands still.
        assert_eq!(at(curve, BoundaryKind::Velocity, AmplitudeClock::Step, 9.0), later);
    }

    /// Halves of an interval lead where the whole does, and there the value is the one that was asked for.
    #[test]
    fn driven_directions_go_on_from_where_they_are() {
        let start = ColumnMotion { value: 3.0, rate: -2.0, acceleration: 0.5 };
        for kind in [BoundaryKind::Displacement, BoundaryKind::Velocity, BoundaryKind::Acceleration] {
            let whole = driven(kind, start, 1.5, 0.8, 0.8);
            let middle = driven(kind, start, 1.5, 0.4, 0.8);
            let halves = driven(kind, middle, 1.5, 0.4, 0.4);
            for (a, b) in
                [(whole.value, halves.value), (whole.rate, halves.rate), (whole.acceleration, halves.acceleration)]
            {
                assert!((a - b).abs() < 1e-14, "{kind:?}: {whole:?}, {halves:?}");
            }
            let asked = match kind {
                BoundaryKind::Displacement => whole.value,
                BoundaryKind::Velocity => whole.rate,
                BoundaryKind::Acceleration => whole.acceleration,
            };
            assert_eq!(asked, 1.5);
            assert_eq!(driven(kind, start, 1.5, 0.0, 0.8).value, start.value);
        }
    }

    #[test]
    fn prescribed_displacements_have_the_slope_of_their_course() {
        let motion = |course, time| at(course, BoundaryKind::Displacement, AmplitudeClock::Step, time);
        assert_eq!(motion(Course::Hold, 1.0), ColumnMotion { value: 3.0, rate: 0.0, acceleration: 0.0 });
        let ramp = motion(Course::Ramp { magnitude: 5.0 }, 1.0);
        assert_eq!(ramp, ColumnMotion { value: 3.5, rate: 0.5, acceleration: 0.0 });
        let curve = Course::Curve { magnitude: 2.0, amplitude: AmplitudeId(0) };
        assert_eq!(motion(curve, 1.0).rate, 8.0);
        assert_eq!(motion(curve, 1.5).rate, -8.0);
        let step = motion(Course::Step { magnitude: 5.0 }, 0.0);
        assert_eq!(step, ColumnMotion { value: 5.0, rate: 0.0, acceleration: 0.0 });
    }
}
