//! What an explicit increment costs on a block of a million unknowns, against one product with its stiffness matrix.
//!
//! ```sh
//! cargo bench -p overclosure --bench explicit                       # 70 x 70 x 68 nodes of C3D8
//! cargo bench -p overclosure --bench explicit -- 40 out.json        # 40 nodes along every edge
//! ```
//!
//! One run, one thread: how fast the machine copies memory; then for each deck ten products and ten increments by turns, so that both
//! see the machine in the same state. Times are those on a processor, where the system tells them, and by the clock. The product is the symmetric one of 3 x 3 blocks over all nodes, each block read once. The lower
//! half of the block flies towards the upper one, so that waves run through all of it; with contact, the face below meets a rigid
//! floor from the first increment on. Time per increment is that of `advance`, everything included.

mod block;
mod clock;

use std::sync::Arc;

use block::{Block, Contact};
use clock::{median, smallest, spent};
use overclosure::benchmark::StiffnessProduct;
use overclosure::deck;
use overclosure::model::Dialect;
use overclosure::simulation::{AdvanceOutcome, IncrementReport, PrepareOptions, PreparedModel, Simulation, Watch};
use serde_json::{Value, json};

/// Products, and increments, in one turn.
const TURN: usize = 10;
/// Turns of each deck.
const TURNS: usize = 12;
/// What an increment may cost, in products.
const WANTED: f64 = 1.4;

/// What is in contact, and whether there is bulk viscosity.
#[derive(Clone, Copy)]
struct Case {
    name: &'static str,
    bulk_viscosity: bool,
    /// `MECHANICAL CONSTRAINT` of the face below.
    contact: Option<&'static str>,
}

const CASES: [Case; 4] = [
    Case { name: "no contact, no bulk viscosity", bulk_viscosity: false, contact: None },
    Case { name: "no contact", bulk_viscosity: true, contact: None },
    Case { name: "face in kinematic contact", bulk_viscosity: true, contact: Some("KINEMATIC") },
    Case { name: "face in penalty contact", bulk_viscosity: true, contact: Some("PENALTY") },
];

/// The deck of a case.
fn text(nodes: [u32; 3], case: Case) -> String {
    let mut step = String::from("*DYNAMIC, EXPLICIT\n, 1.E-3\n");
    step.push_str(if case.bulk_viscosity { "*BULK VISCOSITY\n0.06, 1.2\n" } else { "*BULK VISCOSITY\n0., 0.\n" });
    if let Some(constraint) = case.contact {
        step.push_str("*CONTACT PAIR, INTERACTION=HARD, MECHANICAL CONSTRAINT=");
        step.push_str(constraint);
        step.push_str("\nFACE, FLOOR\n");
    }
    // With contact the whole block falls; the upper half is slower, so that waves run all the same.
    let (lower, upper) = if case.contact.is_some() { (-2000.0, -1000.0) } else { (500.0, -500.0) };
    let contact = case.contact.map(|_| Contact { gap: 0.0, pair: false });
    Block { nodes, contact, lower, upper }.deck(&step)
}

/// What the increments of one turn told.
#[derive(Default)]
struct Seen {
    increments: usize,
    size: f64,
}

impl Watch for Seen {
    fn increment(&mut self, _: &Simulation, report: &IncrementReport) {
        self.increments += 1;
        self.size = report.stable_increment.unwrap_or(report.increment_size);
    }
}

/// Bytes read and written per second while a large array is copied [GB/s].
fn copying() -> f64 {
    let from = vec![1.0f64; 48 << 20];
    let mut to = vec![0.0f64; from.len()];
    let times: Vec<f64> =
        (0..TURNS).map(|_| spent(|| std::hint::black_box(&mut to).copy_from_slice(&from)).wall).collect();
    2e-6 * size_of_val(&from[..]) as f64 / smallest(&times)
}

fn measure(nodes: [u32; 3], case: Case) -> Value {
    let reading = deck::read_text(&text(nodes, case), Dialect::Abaqus);
    let model = reading.model.unwrap_or_else(|| panic!("{:?}", reading.diagnostics));
    let mut product = StiffnessProduct::of(&model);
    let (unknowns, bytes) = (3 * model.mesh.nodes.len(), product.bytes());
    let mut prepared = None;
    let preparing = spent(|| prepared = Some(PreparedModel::prepare(model, &PrepareOptions::default(), &mut |_| {})));
    let prepared = prepared.expect("it was just prepared").unwrap_or_else(|e| panic!("{e:?}"));
    let points = prepared.contact_points().len();
    let mut simulation = Simulation::new(Arc::new(prepared));
    let (mut time, mut size) = (0.0, 1e-9);
    let (mut products, mut increments, mut walls) = (Vec::new(), Vec::new(), Vec::new());
    for turn in 0..=TURNS {
        let product = spent(|| {
            for _ in 0..TURN {
                std::hint::black_box(product.run());
            }
        });
        let mut seen = Seen::default();
        // Half an increment short of a multiple: the last one is cut to end there.
        time += (TURN as f64 - 0.5) * size;
        let advance = spent(|| assert_eq!(simulation.advance(time, &mut seen), Ok(AdvanceOutcome::Reached)));
        size = seen.size;
        // The first turn finds the size of the increment.
        if turn > 0 {
            products.push(product.processor / TURN as f64);
            increments.push(advance.processor / seen.increments as f64);
            walls.push(advance.wall / seen.increments as f64 / (product.wall / TURN as f64));
        }
    }
    let ratio = median(products.iter().zip(&increments).map(|(p, i)| i / p).collect());
    let best = smallest(&increments) / smallest(&products);
    let speed = 1e-6 * bytes as f64 / smallest(&products);
    let [product, increment, wall] = [products, increments, walls].map(median);
    println!(
        "{}: {unknowns} unknowns, {points} contact points, set up in {:.1} s\n  product {product:.1} ms ({speed:.1} GB/s at best), \
         increment {increment:.1} ms: {ratio:.2} products ({best:.2} by the best of each, {wall:.2} by the clock); wanted {WANTED}",
        case.name,
        1e-3 * preparing.processor
    );
    json!({
        "case": case.name, "unknowns": unknowns, "contact_points": points, "prepare_s": 1e-3 * preparing.processor,
        "product_bytes": bytes, "product_ms": product, "product_gb_per_s": speed, "increment_ms": increment, "ratio": ratio,
        "ratio_of_best": best, "ratio_by_the_clock": wall, "wanted": WANTED,
    })
}

fn main() {
    // cargo adds --bench.
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let edge = words.first().map(|word| word.parse::<u32>().expect("the number of nodes along an edge is whole"));
    let nodes = edge.map_or([70, 70, 68], |n| [n; 3]);
    let copy = copying();
    println!("memory is copied at {copy:.1} GB/s, read and written bytes together");
    let cases: Vec<Value> = CASES.into_iter().map(|case| measure(nodes, case)).collect();
    if let Some(path) = words.get(1) {
        let report = json!({ "copy_gb_per_s": copy, "cases": cases });
        std::fs::write(path, format!("{report:#}\n")).expect("the report can be written");
    }
}
