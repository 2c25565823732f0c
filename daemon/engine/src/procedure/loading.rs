//! Loads and prescribed displacements in time: which columns a deck needs and what each is worth at any moment.
//!
//! A column is one line of `*BOUNDARY`, `*CLOAD`, `*DLOAD` or `*DSLOAD`; the same line in a later step continues it. In a
//! static step a value without an amplitude goes linearly from where it was to its magnitude; a line that a later step
//! does not repeat holds (and goes on following an amplitude on total time); one removed by OP=NEW ramps to zero.

use rustc_hash::{FxHashMap, FxHashSet};

use crate::diagnostic::Diagnostic;
use crate::model::{AmplitudeClock, AmplitudeId, Boundary, LoadKind, Model, NodeId};
use crate::port::{Port, Quantity};
use crate::solve::columns::{Column, force_pattern, merge};

/// What a column does during a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Course {
    /// Not begun yet, or standing at its last value.
    Hold,
    /// From the value at the start of the step linearly to the magnitude at its end.
    Ramp {
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

/// All columns and their courses.
pub struct Loading {
    /// Patterns, one per column.
    pub columns: Vec<Column>,
    /// Per step and column.
    pub courses: Vec<Vec<Course>>,
    /// Column of each input port.
    pub input_columns: Vec<usize>,
    /// Input ports: lines of the last step with a non-zero magnitude.
    pub inputs: Vec<Port>,
}

/// What identifies a line across steps: kind, region, detail and its rank among equal lines of one step.
#[derive(Clone, PartialEq, Eq, Hash)]
struct Key {
    name: String,
    rank: usize,
}

struct Line<'a> {
    name: String,
    quantity: Quantity,
    description: String,
    magnitude: f64,
    amplitude: Option<AmplitudeId>,
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
    let boundaries = step.boundaries.iter().map(move |b| Line {
        name: format!("boundary.{}.{}", b.region_name, dof(&b.nodes, b.direction)),
        quantity: if dof(&b.nodes, b.direction) > 3 { Quantity::Angle } else { Quantity::Length },
        description: match dof(&b.nodes, b.direction) {
            dof @ 4.. => format!("Prescribed rotation {dof} of {}", b.region_name),
            dof => format!("Prescribed displacement {dof} of {}", b.region_name),
        },
        magnitude: b.magnitude,
        amplitude: b.amplitude,
        source: Source::Boundary(b),
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
            name,
            quantity,
            description,
            magnitude: l.magnitude,
            amplitude: l.amplitude,
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
        let seen = taken.entry(line.name.clone()).or_insert(0);
        *seen += 1;
        let name = if *seen == 1 { line.name } else { format!("{}_{seen}", line.name) };
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
        let mut kinds: Vec<&'static str> = Vec::new();
        let mut column_of_line = Vec::new();
        for (s, step) in model.steps.iter().enumerate() {
            // What an earlier step left behind; OP=NEW ramps the loads of its kind to zero.
            let previous = courses.last().cloned().unwrap_or_default();
            let mut now: Vec<Course> = previous.iter().map(|c| carried_over(model, *c)).collect();
            for (course, kind) in now.iter_mut().zip(&kinds) {
                let removed = step.loads_removed;
                if matches!(
                    (*kind, removed.cload, removed.dload, removed.dsload),
                    ("cload", true, ..) | ("dload", _, true, _) | ("dsload", .., true)
                ) {
                    *course = Course::Ramp { magnitude: 0.0 };
                }
            }
            let mut ranks: FxHashMap<String, usize> = FxHashMap::default();
            column_of_line.clear();
            for line in lines(model, s) {
                let rank = ranks.entry(line.name.clone()).or_insert(0);
                *rank += 1;
                let key = Key { name: line.name.clone(), rank: *rank };
                let known = of_key.get(&key).copied();
                // A zero displacement that was never anything else is a support, not a column.
                if known.is_none() && line.magnitude == 0.0 && matches!(line.source, Source::Boundary(_)) {
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
                    kinds.push(line.name.split('.').next().map_or("", |k| match k {
                        "cload" => "cload",
                        "dload" => "dload",
                        "dsload" => "dsload",
                        _ => "boundary",
                    }));
                    now.push(Course::Hold);
                    of_key.insert(key, index);
                    index
                });
                if let Source::Boundary(b) = line.source {
                    owners.claim(b, column, s);
                }
                now[column] = match line.amplitude {
                    Some(amplitude) => Course::Curve { magnitude: line.magnitude, amplitude },
                    None => Course::Ramp { magnitude: line.magnitude },
                };
                column_of_line.push(Some(column));
            }
            courses.push(now);
        }
        if !owners.conflicts.is_empty() {
            return Err(owners.conflicts);
        }
        for step in &mut courses {
            step.resize(columns.len(), Course::Hold);
        }
        let mut inputs = Vec::new();
        let mut input_columns = Vec::new();
        for (line, port) in input_lines(model) {
            if let Some(column) = column_of_line[line] {
                inputs.push(port);
                input_columns.push(column);
            }
        }
        Ok(Self { columns, courses, input_columns, inputs })
    }
}

impl Loading {
    /// Coefficients of the columns at the end of every step, as the deck has them.
    pub fn step_ends(&self, model: &Model) -> Vec<Vec<f64>> {
        let mut ends: Vec<Vec<f64>> = Vec::with_capacity(self.courses.len());
        let mut begun = 0.0;
        for (s, courses) in self.courses.iter().enumerate() {
            let period = model.steps[s].procedure.period();
            let value = |(j, course): (usize, &Course)| {
                let start = ends.last().map_or(0.0, |last| last[j]);
                value_at(model, *course, s, start, begun, period)
            };
            ends.push(courses.iter().enumerate().map(value).collect());
            begun += period;
        }
        ends
    }
}

/// Each prescribed direction follows one column; a node named twice in a set counts once.
fn merge_last(entries: Vec<(NodeId, u8, f64)>) -> Vec<(NodeId, u8, f64)> {
    let mut merged = merge(entries);
    for entry in &mut merged {
        entry.2 = 1.0;
    }
    merged
}

/// A step that does not mention a line: it holds its value, but a curve on total time goes on.
fn carried_over(model: &Model, course: Course) -> Course {
    match course {
        Course::Curve { amplitude, .. } if model.amplitudes[amplitude.index()].clock == AmplitudeClock::Total => course,
        _ => Course::Hold,
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

/// Value of a column at a moment of a step.
pub fn value_at(model: &Model, course: Course, step: usize, start_value: f64, step_start: f64, step_time: f64) -> f64 {
    let period = model.steps[step].procedure.period();
    // Beyond its period a step stands still.
    let time = step_time.min(period);
    match course {
        Course::Hold => start_value,
        Course::Ramp { magnitude } if time >= period => magnitude,
        Course::Ramp { magnitude } => start_value + (magnitude - start_value) * (time / period),
        Course::Curve { magnitude, amplitude } => {
            let amplitude = &model.amplitudes[amplitude.index()];
            let clock = match amplitude.clock {
                AmplitudeClock::Step => time,
                AmplitudeClock::Total => step_start + time,
            };
            magnitude * amplitude.evaluate(clock)
        }
    }
}
