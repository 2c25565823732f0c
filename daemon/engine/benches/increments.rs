//! What a further increment costs on a deck that is set up: milliseconds per increment, medians.
//!
//! ```sh
//! cargo bench -p overclosure --bench increments               # punch 26
//! cargo bench -p overclosure --bench increments -- 16 out.json
//! cargo bench -p overclosure --bench increments -- 26 floating.json force     # contact alone holds the punch
//! ```
//!
//! `stays`: the load moves a little about a loaded state, and no point changes its status. `changes`: a corner of the punch is
//! lifted, and a few points (1 to 10) open in each increment. Every increment is checked to be of its kind.
//! Wall time; where the system tells it (Linux) also how long the thread was on a processor,
//! which differs much from the wall time on a machine that is busy.

#[path = "../tests/punch/mod.rs"]
mod punch;

use std::sync::Arc;
use std::time::Instant;

use overclosure::deck;
use overclosure::model::Dialect;
use overclosure::simulation::{AdvanceOutcome, IncrementReport, PrepareOptions, PreparedModel, Simulation, Watch};
use punch::Drive;
use serde_json::{Value, json};

const LINEAR: &str = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n3.5e6";
const INCREMENTS: usize = 200;
/// Points that may change in an increment of the second kind.
const FEW: std::ops::RangeInclusive<usize> = 1..=10;
/// Smallest and largest change of the corner per increment, relative to the depth; adapted to the number of changes.
const LIFT: [f64; 2] = [1e-6, 0.05];

/// Points that changed, and iterations.
#[derive(Clone, Copy, Default)]
struct Seen {
    increments: usize,
    changes: usize,
    iterations: u32,
}

impl Watch for Seen {
    fn increment(&mut self, _: &Simulation, report: &IncrementReport) {
        self.increments += 1;
        self.changes += report.status_changes.len();
        self.iterations += report.equilibrium_iterations + report.severe_discontinuity_iterations;
    }
}

/// A set-up punch and its inputs.
struct Bench {
    simulation: Simulation,
    rest: usize,
    corner: usize,
    drive: Drive,
    time: f64,
}

/// Milliseconds of one increment.
#[derive(Clone, Copy)]
struct Cost {
    wall: f64,
    seen: Seen,
}

impl Bench {
    fn new(n: u32, drive: Drive) -> Self {
        let reading = deck::read_text(&punch::deck(n, LINEAR, drive), Dialect::Calculix);
        let model = reading.model.unwrap_or_else(|| panic!("{:?}", reading.diagnostics));
        let prepared = PreparedModel::prepare(model, &PrepareOptions::default(), &mut |_| {});
        let prepared = Arc::new(prepared.unwrap_or_else(|e| panic!("{e:?}")));
        let [rest, corner] = drive.inputs().map(|name| prepared.ports().input(name).expect("an input of the deck"));
        Self { simulation: Simulation::new(prepared), rest, corner, drive, time: 0.0 }
    }

    /// One advance to new displacements of the top.
    fn advance(&mut self, rest: f64, corner: f64) -> Cost {
        self.time += 1e-4;
        let mut seen = Seen::default();
        let wall = Instant::now();
        self.simulation.set(self.rest, rest).expect("a finite value");
        self.simulation.set(self.corner, corner).expect("a finite value");
        let outcome = self.simulation.advance(self.time, &mut seen);
        let wall = 1e3 * wall.elapsed().as_secs_f64();
        assert_eq!(outcome, Ok(AdvanceOutcome::Reached));
        Cost { wall, seen }
    }

    /// Increments about a loaded state.
    fn stays(&mut self) -> Vec<Cost> {
        let corner = 0.5 * self.drive.full();
        self.advance(self.drive.full(), corner);
        let costs = (0..INCREMENTS).map(|i| {
            let share = 1.0 + 1e-5 * (0.1 * i as f64).sin();
            let cost = self.advance(share * self.drive.full(), share * corner);
            assert_eq!((cost.seen.increments, cost.seen.changes), (1, 0), "increment {i}: the active set has to stay");
            cost
        });
        costs.collect()
    }

    /// Lifts the corner from the pressed state until it opens no more points, and down again, as often as needed. The size of the
    /// lift follows the number of changes; increments without or with too many changes are not counted.
    fn changes(&mut self) -> Vec<Cost> {
        let (mut corner, mut lift, mut direction) = (self.drive.full(), 1e-3, 1.0);
        self.advance(self.drive.full(), corner);
        let mut costs = Vec::new();
        for _ in 0..20 * INCREMENTS {
            corner -= direction * lift * self.drive.full();
            let cost = self.advance(self.drive.full(), corner);
            let changes = cost.seen.changes;
            if FEW.contains(&changes) {
                costs.push(cost);
            } else {
                lift = (if changes == 0 { 1.2 } else { 0.5 } * lift).clamp(LIFT[0], LIFT[1]);
            }
            let share = corner / self.drive.full();
            if share.abs() > 1.0 {
                direction = share.signum();
            }
            if costs.len() == INCREMENTS {
                return costs;
            }
        }
        panic!("only {} of {INCREMENTS} increments changed {FEW:?} points", costs.len());
    }
}

/// Time that this thread was on a processor [ms].
fn processor_milliseconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(text.split_whitespace().next()?.parse::<f64>().ok()? * 1e-6)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Measures one kind of increment and tells about it.
fn measure(name: &str, wanted: f64, run: impl FnOnce() -> Vec<Cost>) -> Value {
    let start = processor_milliseconds();
    let costs = run();
    let spent = processor_milliseconds().zip(start).map(|(end, start)| end - start);
    let seconds: f64 = costs.iter().map(|c| c.wall).sum();
    let wall = median(costs.iter().map(|c| c.wall).collect());
    let slowest = costs.iter().map(|c| c.wall).fold(0.0, f64::max);
    let iterations = median(costs.iter().map(|c| f64::from(c.seen.iterations)).collect());
    let changes = median(costs.iter().map(|c| c.seen.changes as f64).collect());
    println!(
        "{name:<8} {} increments: median {wall:.3} ms, slowest {slowest:.3} ms, {iterations} iterations, {changes} changes; \
         wanted {wanted} ms",
        costs.len()
    );
    if let Some(spent) = spent {
        println!(
            "{:<8} all together {seconds:.1} ms; the thread was on a processor for {spent:.1} ms of the whole pass",
            ""
        );
    }
    json!({
        "increments": costs.len(), "median_ms": wall, "slowest_ms": slowest, "median_iterations": iterations,
        "median_changes": changes, "wanted_ms": wanted,
    })
}

fn main() {
    // cargo adds --bench.
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let n = words.first().map_or(26, |word| word.parse().expect("the size is a whole number"));
    let drive = if words.iter().any(|word| word == "force") { Drive::Force } else { Drive::Displacement };
    let mut bench = Bench::new(n, drive);
    let points = bench.simulation.prepared().contact_points().len();
    println!("punch {n}, driven by {drive:?}: {points} contact points");
    let stays = measure("stays", 5.0, || bench.stays());
    let changes = measure("changes", 50.0, || bench.changes());
    if let Some(path) = words.get(1) {
        let report = json!({ "punch": n, "contact_points": points, "stays": stays, "changes": changes });
        std::fs::write(path, format!("{report:#}\n")).expect("the report can be written");
    }
}
