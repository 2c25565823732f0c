//! What an implicit dynamic increment costs: factorisations per increment size, and increments in solves.
//!
//! ```sh
//! cargo bench -p overclosure --bench implicit                       # 31 nodes along every edge
//! cargo bench -p overclosure --bench implicit -- 20 out.json
//! ```
//!
//! A block of C3D8 whose halves fly at each other falls onto a rigid floor, hard contact on its whole face. `in flight`: increments of
//! one size before the floor is met, by turns with solves: one forward and one backward substitution with the factored matrix over all
//! unknowns. `impact`: automatic increments through the impact of a block of half as many nodes along every edge; factorisations
//! against sizes of increments and events.

mod block;
mod clock;

use std::collections::BTreeSet;
use std::sync::Arc;

use block::{Block, Contact};
use clock::{median, smallest, spent};
use overclosure::benchmark::FullSolve;
use overclosure::deck;
use overclosure::model::Dialect;
use overclosure::simulation::{AdvanceOutcome, IncrementReport, PrepareOptions, PreparedModel, Simulation, Watch};
use serde_json::{Value, json};

/// Increments, and solves, in one turn.
const TURN: usize = 5;
/// Turns.
const TURNS: usize = 12;
/// Size of the increments in flight \[s\]: a wave passes some bricks.
const SIZE: f64 = 1e-7;
/// What an increment may cost, in solves.
const WANTED: f64 = 1.5;

/// A prepared deck of such a block.
fn prepare(nodes: u32, step: &str, gap: f64) -> Arc<PreparedModel> {
    let block = Block { nodes: [nodes; 3], contact: Some(Contact { gap, pair: true }), lower: -2000.0, upper: -1000.0 };
    let reading = deck::read_text(&block.deck(step), Dialect::Abaqus);
    let model = reading.model.unwrap_or_else(|| panic!("{:?}", reading.diagnostics));
    let prepared = PreparedModel::prepare(model, &PrepareOptions::default(), &mut |_| {});
    Arc::new(prepared.unwrap_or_else(|e| panic!("{e:?}")))
}

/// Sizes and events of the increments that were seen.
#[derive(Default)]
struct Seen {
    increments: usize,
    /// To nine digits: an increment is what the clock moves by.
    sizes: BTreeSet<String>,
    changes: usize,
}

impl Watch for Seen {
    fn increment(&mut self, _: &Simulation, report: &IncrementReport) {
        self.increments += 1;
        self.sizes.insert(format!("{:.8e}", report.increment_size));
        self.changes += usize::from(!report.status_changes.is_empty());
    }
}

fn factorizations(simulation: &Simulation) -> u32 {
    simulation.step_reports().iter().map(|report| report.counts.factorizations).sum()
}

/// Increments of one size without an event, against solves.
fn in_flight(nodes: u32) -> Value {
    let prepared = prepare(nodes, &format!("*DYNAMIC, DIRECT\n{SIZE:?}, 1.E-3\n"), 1.0);
    let (unknowns, points) = (3 * prepared.model().mesh.nodes.len(), prepared.contact_points().len());
    let mut solve = None;
    let factoring = spent(|| solve = Some(FullSolve::of(&prepared, SIZE)));
    let mut solve = solve.expect("it was just made").unwrap_or_else(|e| panic!("{e:?}"));
    let mut simulation = Simulation::new(prepared);
    let (mut solves, mut increments, mut walls) = (Vec::new(), Vec::new(), Vec::new());
    let mut seen = Seen::default();
    for turn in 0..=TURNS {
        let solved = spent(|| {
            for _ in 0..TURN {
                std::hint::black_box(solve.run());
            }
        });
        let (before, end) = (seen.increments, (turn + 1) as f64 * TURN as f64 * SIZE);
        let advance = spent(|| assert_eq!(simulation.advance(end, &mut seen), Ok(AdvanceOutcome::Reached)));
        // The first turn factors.
        if turn > 0 {
            assert_eq!(seen.increments - before, TURN, "increments of one size end on the grid");
            solves.push(solved.processor / TURN as f64);
            increments.push(advance.processor / TURN as f64);
            walls.push(advance.wall / solved.wall);
        }
    }
    assert_eq!(seen.changes, 0, "nothing touches in flight");
    let ratio = median(solves.iter().zip(&increments).map(|(s, i)| i / s).collect());
    let best = smallest(&increments) / smallest(&solves);
    let [solve, increment, wall] = [solves, increments, walls].map(median);
    let factorizations = factorizations(&simulation);
    println!(
        "in flight: {unknowns} unknowns, {points} contact points; factored in {:.1} s; solve {solve:.1} ms, increment {increment:.1} \
         ms: {ratio:.2} solves ({best:.2} by the best of each, {wall:.2} by the clock); wanted {WANTED}; {factorizations} \
         factorisations in {} increments of {} size",
        1e-3 * factoring.processor,
        seen.increments,
        seen.sizes.len()
    );
    json!({
        "unknowns": unknowns, "contact_points": points, "factor_s": 1e-3 * factoring.processor, "solve_ms": solve,
        "increment_ms": increment, "ratio": ratio, "ratio_of_best": best, "ratio_by_the_clock": wall, "wanted": WANTED, "factorizations": factorizations,
        "increments": seen.increments, "sizes": seen.sizes.len(),
    })
}

/// Automatic increments through an impact. A force of 0.1 N is a fifth of what a wave of the impact has at a node.
fn impact(nodes: u32) -> Value {
    let prepared = prepare(nodes, "*DYNAMIC, HAFTOL=0.1\n1.E-7, 2.E-5\n", 0.01);
    let mut simulation = Simulation::new(prepared);
    let mut seen = Seen::default();
    let took = spent(|| assert_eq!(simulation.advance(2e-5, &mut seen), Ok(AdvanceOutcome::Reached)));
    let factorizations = factorizations(&simulation);
    let impacts: u32 = simulation.step_reports().iter().map(|report| report.counts.impacts).sum();
    println!(
        "impact: {} increments of {} sizes, {} of which changed contact, {impacts} impacts: {factorizations} factorisations, {:.1} s",
        seen.increments,
        seen.sizes.len(),
        seen.changes,
        1e-3 * took.processor
    );
    json!({
        "increments": seen.increments, "sizes": seen.sizes.len(), "with_changes": seen.changes, "impacts": impacts,
        "factorizations": factorizations, "seconds": 1e-3 * took.processor,
    })
}

fn main() {
    // cargo adds --bench.
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let nodes = words.first().map_or(31, |word| word.parse().expect("the number of nodes along an edge is whole"));
    let report = json!({ "in_flight": in_flight(nodes), "impact": impact(nodes.div_ceil(2)) });
    if let Some(path) = words.get(1) {
        std::fs::write(path, format!("{report:#}\n")).expect("the report can be written");
    }
}
