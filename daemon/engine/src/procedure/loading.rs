//! Loads and prescribed displacements in time: which columns a deck needs and what each is worth at any moment.
//!
//! A column is one line of `*BOUNDARY`, `*CLOAD`, `*DLOAD` or `*DSLOAD`; the same line in a later step continues it. A value
//! without an amplitude goes linearly from where it was to its magnitude, or has it at once, as the step says; a line that a later
//! step does not repeat holds (and goes on following an amplitude on total time); one removed by OP=NEW goes to zero.
//!
//! The coefficient of a `*BOUNDARY` is the displacement, whatever is prescribed: velocities and accelerations are integrated exactly
//! from displacement and velocity at the start of the step ([`Loading::motion`]).

use rustc_hash::{FxHashMap, FxHashSet};

use crate::diagnostic::Diagnostic;
use crate::model::{AmplitudeClock, AmplitudeId, Boundary, BoundaryKind, DefaultAmplitude, LoadKind, Model, NodeId};
use crate::port::{Port, Quantity};
pub use crate::procedure::courses::{ColumnMotion, Course, value_at};
use crate::procedure::courses::{Integrals, StepTime};
use crate::solve::columns::{Column, force_pattern, merge};

/// All columns and their courses.
pub struct Loading {
    /// Patterns, one per column.
    pub columns: Vec<Column>,
    /// Per step and column.
    pub courses: Vec<Vec<Course>>,
    /// Per step and column: what takes the course. Loads count as displacements: their coefficient is what the course says.
    pub kinds: Vec<Vec<BoundaryKind>>,
    /// Per column: velocity of its direction at the start of the analysis, from `*INITIAL CONDITIONS` [length/time].
    pub rates_initial: Vec<f64>,
    /// Column of each input port.
    pub input_columns: Vec<usize>,
    /// Input ports: lines of the last step with a non-zero magnitude.
    pub inputs: Vec<Port>,
    integrals: Integrals,
}

/// What identifies a line across steps: kind, region, detail and its rank among equal lines of one step.
#[derive(Clone, PartialEq, Eq, Hash)]
struct Key {
    name: String,
    rank: usize,
}

struct Line<'a> {
    /// The same in every step, whatever is prescribed.
    name: String,
    /// Name of the port.
    port: String,
    quantity: Quantity,
    description: String,
    magnitude: f64,
    amplitude: Option<AmplitudeId>,
    kind: BoundaryKind,
    source: Source<'a>,
}

enum Source<'a> {
    Boundary(&'a Boundary),
    Load(&'a LoadKind),
}

/// Lines of a step in port order: boundaries, then loads, as the deck has them.
fn lines(model: &Model, step: usize) -> Vec<Line<'_>> {
    let step = &model.steps[step];
    // Directions of hidden nodes are rotations of their reference node: degrees of freedom 4 to 6.
    let dof = |nodes: &[NodeId], direction: u8| {
        nodes.first().map_or(direction + 1, |&node| model.mesh.dof_of(node, direction))
    };
    let boundaries = step.boundaries.iter().map(move |b| {
        let dof = dof(&b.nodes, b.direction);
        let (prefix, what, quantity) = match (b.kind, dof > 3) {
            (BoundaryKind::Displacement, false) => ("boundary", "displacement", Quantity::Length),
            (BoundaryKind::Displacement, true) => ("boundary", "rotation", Quantity::Angle),
            (BoundaryKind::Velocity, false) => ("velocity", "velocity", Quantity::Velocity),
            (BoundaryKind::Velocity, true) => ("velocity", "angular velocity", Quantity::AngularVelocity),
            (BoundaryKind::Acceleration, false) => ("acceleration", "acceleration", Quantity::Acceleration),
            (BoundaryKind::Acceleration, true) => {
                ("acceleration", "angular acceleration", Quantity::AngularAcceleration)
            }
        };
        Line {
            name: format!("boundary.{}.{dof}", b.region_name),
            port: format!("{prefix}.{}.{dof}", b.region_name),
            quantity,
            description: format!("Prescribed {what} {dof} of {}", b.region_name),
            magnitude: b.magnitude,
            amplitude: b.amplitude,
            kind: b.kind,
            source: Source::Boundary(b),
        }
    });
    let loads = step.loads.iter().map(move |l| {
        let region = &l.region_name;
        let (name, quantity, description) = match &l.kind {
            LoadKind::Concentrated { direction, nodes } => match dof(nodes, *direction) {
                dof @ 4.. => (
                    format!("cload.{region}.{dof}"),
                    Quantity::Moment,
                    format!("Moment in degree of freedom {dof} on {region}"),
                ),
                dof => (
                    format!("cload.{region}.{dof}"),
                    Quantity::Force,
                    format!("Force in direction {dof} on each node of {region}"),
                ),
            },
            LoadKind::FacePressure { label, .. } => (
                format!("dload.{region}.P{label}"),
                Quantity::Pressure,
                format!("Pressure on face {label} of the elements of {region}"),
            ),
            LoadKind::Gravity { .. } => (
                format!("dload.{region}.GRAV"),
                Quantity::Acceleration,
                format!("Acceleration on the mass of {region}"),
            ),
            LoadKind::SurfacePressure { .. } => {
                (format!("dsload.{region}.P"), Quantity::Pressure, format!("Pressure on the surface {region}"))
            }
        };
        Line {
            port: name.clone(),
            name,
            quantity,
            description,
            magnitude: l.magnitude,
            amplitude: l.amplitude,
            kind: BoundaryKind::Displacement,
            source: Source::Load(&l.kind),
        }
    });
    boundaries.chain(loads).collect()
}

/// Input ports of a deck with the index of their line; a repeated name gets `_2`, `_3`, ….
fn input_lines(model: &Model) -> Vec<(usize, Port)> {
    let mut taken: FxHashMap<String, usize> = FxHashMap::default();
    let last = model.steps.len() - 1;
    let mut out = Vec::new();
    for (index, line) in lines(model, last).into_iter().enumerate() {
        if line.magnitude == 0.0 {
            continue;
        }
        let seen = taken.entry(line.port.clone()).or_insert(0);
        *seen += 1;
        let name = if *seen == 1 { line.port } else { format!("{}_{seen}", line.port) };
        out.push((index, Port { name, quantity: line.quantity, unit: None, description: line.description }));
    }
    out
}

/// Input ports of a validated model, without preparing it.
pub fn inputs_of(model: &Model) -> Vec<Port> {
    input_lines(model).into_iter().map(|(_, port)| port).collect()
}

impl Loading {
    /// Columns and courses of a model.
    pub fn new(model: &Model) -> Result<Self, Vec<Diagnostic>> {
        let mut of_key: FxHashMap<Key, usize> = FxHashMap::default();
        let mut columns = Vec::new();
        let mut courses: Vec<Vec<Course>> = Vec::new();
        let mut owners = Owners::default();
        let mut families: Vec<&'static str> = Vec::new();
        let mut kinds: Vec<Vec<BoundaryKind>> = Vec::new();
        let mut integrals = Integrals::default();
        let mut column_of_line = Vec::new();
        let mut begun = 0.0;
        for (s, step) in model.steps.iter().enumerate() {
            // What an earlier step left behind; OP=NEW ramps the loads of its kind to zero.
            let previous = courses.last().cloned().unwrap_or_default();
            let mut kinds_now = kinds.last().cloned().unwrap_or_default();
            let carried = previous.iter().zip(&kinds_now).map(|(&c, &kind)| carried_over(model, c, kind, s, begun));
            let mut now: Vec<Course> = carried.collect();
            if s > 0 {
                begun += model.steps[s - 1].procedure.period();
            }
            if !step.procedure.is_dynamic() {
                // Nothing moves on by itself in a static step.
                let moving =
                    now.iter_mut().zip(&mut kinds_now).filter(|(_, kind)| **kind != BoundaryKind::Displacement);
                moving.for_each(|(course, kind)| (*course, *kind) = (Course::Hold, BoundaryKind::Displacement));
            }
            for (course, family) in now.iter_mut().zip(&families) {
                let removed = step.loads_removed;
                if matches!(
                    (*family, removed.cload, removed.dload, removed.dsload),
                    ("cload", true, ..) | ("dload", _, true, _) | ("dsload", .., true)
                ) {
                    *course = without_amplitude(step.default_amplitude, 0.0);
                }
            }
            let mut ranks: FxHashMap<String, usize> = FxHashMap::default();
            column_of_line.clear();
            for line in lines(model, s) {
                let rank = ranks.entry(line.name.clone()).or_insert(0);
                *rank += 1;
                let key = Key { name: line.name.clone(), rank: *rank };
                let known = of_key.get(&key).copied();
                // What was never moved and has no displacement or velocity is a support, not a column.
                let is_still = line.magnitude == 0.0 && line.kind != BoundaryKind::Acceleration;
                if known.is_none() && is_still && matches!(line.source, Source::Boundary(_)) {
                    if let Source::Boundary(b) = line.source {
                        owners.support(b, s);
                    }
                    column_of_line.push(None);
                    continue;
                }
                let column = known.unwrap_or_else(|| {
                    let index = columns.len();
                    columns.push(match line.source {
                        Source::Boundary(b) => {
                            Column::Displacement(merge_last(b.nodes.iter().map(|&n| (n, b.direction, 1.0)).collect()))
                        }
                        Source::Load(kind) => force_pattern(model, kind),
                    });
                    families.push(line.name.split('.').next().map_or("", |k| match k {
                        "cload" => "cload",
                        "dload" => "dload",
                        "dsload" => "dsload",
                        _ => "boundary",
                    }));
                    now.push(Course::Hold);
                    kinds_now.push(BoundaryKind::Displacement);
                    of_key.insert(key, index);
                    index
                });
                if let Source::Boundary(b) = line.source {
                    owners.claim(b, column, s);
                    if b.kind == BoundaryKind::Acceleration {
                        owners.begin_together(model, b, s);
                    }
                }
                now[column] = match (line.amplitude, without_amplitude(step.default_amplitude, line.magnitude)) {
                    (Some(amplitude), _) => Course::Curve { magnitude: line.magnitude, amplitude },
                    (None, Course::Ramp { magnitude }) if line.kind == BoundaryKind::Acceleration => {
                        // Where the deck has left an acceleration; anything else begins without one.
                        let was = match (now[column], kinds_now[column]) {
                            (Course::Step { magnitude }, BoundaryKind::Acceleration) => magnitude,
                            _ => 0.0,
                        };
                        Course::Line { from: was, magnitude }
                    }
                    (None, course) => course,
                };
                kinds_now[column] = line.kind;
                column_of_line.push(Some(column));
            }
            for (course, kind) in now.iter().zip(&kinds_now) {
                if let (Course::Curve { amplitude, .. }, BoundaryKind::Velocity | BoundaryKind::Acceleration) =
                    (course, kind)
                {
                    integrals.prepare(model, *amplitude, begun);
                }
            }
            courses.push(now);
            kinds.push(kinds_now);
        }
        if !owners.conflicts.is_empty() {
            return Err(owners.conflicts);
        }
        for step in &mut courses {
            step.resize(columns.len(), Course::Hold);
        }
        for step in &mut kinds {
            step.resize(columns.len(), BoundaryKind::Displacement);
        }
        let rates_initial = columns.iter().map(|column| rate_initial(model, column)).collect();
        let mut inputs = Vec::new();
        let mut input_columns = Vec::new();
        for (line, port) in input_lines(model) {
            if let Some(column) = column_of_line[line] {
                inputs.push(port);
                input_columns.push(column);
            }
        }
        Ok(Self { columns, courses, kinds, rates_initial, input_columns, inputs, integrals })
    }
}

impl Loading {
    /// Displacement, velocity and acceleration of a column that prescribes a direction, or the value of a load and its slope, at a time
    /// of a step; `course` is that of the deck or with another magnitude, `start` what the column had at the start of the step.
    pub fn motion(
        &self,
        model: &Model,
        step: usize,
        column: usize,
        course: Course,
        start: ColumnMotion,
        at: &StepTime,
    ) -> ColumnMotion {
        self.integrals.motion_at(model, course, self.kinds[step][column], start, at)
    }

    /// Coefficients of the columns at the end of every step, as the deck has them.
    pub fn step_ends(&self, model: &Model) -> Vec<Vec<f64>> {
        let mut ends: Vec<Vec<f64>> = Vec::with_capacity(self.courses.len());
        let start = |&rate: &f64| ColumnMotion { rate, ..Default::default() };
        let mut motions: Vec<ColumnMotion> = self.rates_initial.iter().map(start).collect();
        let mut begun = 0.0;
        for (s, courses) in self.courses.iter().enumerate() {
            let period = model.steps[s].procedure.period();
            let at = StepTime { step_start: begun, step_time: period, period };
            for (column, (motion, &course)) in motions.iter_mut().zip(courses).enumerate() {
                *motion = self.motion(model, s, column, course, *motion, &at);
            }
            ends.push(motions.iter().map(|motion| motion.value).collect());
            begun += period;
        }
        ends
    }
}

fn without_amplitude(default: DefaultAmplitude, magnitude: f64) -> Course {
    match default {
        DefaultAmplitude::Ramp => Course::Ramp { magnitude },
        DefaultAmplitude::Step => Course::Step { magnitude },
    }
}

/// Velocity of a direction at the start of the analysis [length/time].
fn initial_velocity(model: &Model, node: NodeId, direction: u8) -> f64 {
    let found = model.initial_velocities.iter().rfind(|v| (v.node, v.direction) == (node, direction));
    found.map_or(0.0, |velocity| velocity.value)
}

/// Initial velocity of the direction that a column prescribes: that of its first node; where an acceleration moves them all have it.
fn rate_initial(model: &Model, column: &Column) -> f64 {
    let Column::Displacement(entries) = column else { return 0.0 };
    entries.first().map_or(0.0, |&(node, direction, _)| initial_velocity(model, node, direction))
}

/// Each prescribed direction follows one column; a node named twice in a set counts once.
fn merge_last(entries: Vec<(NodeId, u8, f64)>) -> Vec<(NodeId, u8, f64)> {
    let mut merged = merge(entries);
    for entry in &mut merged {
        entry.2 = 1.0;
    }
    merged
}

/// A step that does not mention a line: it holds its value, but a curve on total time goes on. A velocity or acceleration keeps what it
/// had at the end of the step before, which begins at total time `begun`.
fn carried_over(model: &Model, course: Course, kind: BoundaryKind, step: usize, begun: f64) -> Course {
    if let Course::Curve { amplitude, .. } = course
        && model.amplitudes[amplitude.index()].clock == AmplitudeClock::Total
    {
        return course;
    }
    match (kind, course) {
        (BoundaryKind::Displacement, _) => Course::Hold,
        (_, Course::Ramp { magnitude } | Course::Line { magnitude, .. } | Course::Step { magnitude }) => {
            Course::Step { magnitude }
        }
        (_, Course::Curve { .. }) => {
            let before = step - 1;
            let period = model.steps[before].procedure.period();
            Course::Step { magnitude: value_at(model, course, before, 0.0, begun, period) }
        }
        (_, Course::Hold) => Course::Hold,
    }
}

/// Which column moves each prescribed direction.
#[derive(Default)]
struct Owners {
    of: FxHashMap<(NodeId, u8), usize>,
    reported: FxHashSet<(usize, usize)>,
    conflicts: Vec<Diagnostic>,
}

impl Owners {
    fn claim(&mut self, line: &Boundary, column: usize, step: usize) {
        for &node in &line.nodes {
            let owner = *self.of.entry((node, line.direction)).or_insert(column);
            if owner != column && self.reported.insert((owner, column)) {
                self.conflict(line, step);
            }
        }
    }

    /// Nodes that one line accelerates move as one: they need one initial velocity.
    fn begin_together(&mut self, model: &Model, line: &Boundary, step: usize) {
        let velocity = |&node: &NodeId| initial_velocity(model, node, line.direction);
        let first = line.nodes.first().map_or(0.0, velocity);
        if line.nodes.iter().any(|node| velocity(node) != first) {
            self.conflicts.push(Diagnostic::error(
                line.place.clone(),
                "*BOUNDARY",
                format!(
                    "step {}: nodes of {} that one acceleration moves in direction {} have different initial velocities",
                    step + 1,
                    line.region_name,
                    line.direction + 1
                ),
                "give them one initial velocity, or a line for each velocity",
            ));
        }
    }

    /// A support in a later step over a direction that an earlier step has moved.
    fn support(&mut self, line: &Boundary, step: usize) {
        if step > 0 && line.nodes.iter().any(|&n| self.of.contains_key(&(n, line.direction))) {
            self.conflict(line, step);
        }
    }

    fn conflict(&mut self, line: &Boundary, step: usize) {
        self.conflicts.push(Diagnostic::error(
            line.place.clone(),
            "*BOUNDARY",
            format!(
                "step {}: direction {} of {} is moved by another line too",
                step + 1,
                line.direction + 1,
                line.region_name
            ),
            "prescribe each direction through one set, the same in every step",
        ));
    }
}
