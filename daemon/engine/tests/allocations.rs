//! A further increment whose active set stays takes nothing from the heap: counted on the thread that computes it.

mod punch;

use std::sync::Arc;

use overclosure::deck;
use overclosure::model::Dialect;
use overclosure::simulation::{AdvanceOutcome, IncrementReport, PrepareOptions, PreparedModel, Simulation, Watch};
use punch::Drive;

const LAWS: [(&str, &str); 4] = [
    ("linear", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n3.5e6"),
    ("exponential", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=EXPONENTIAL\n1e-4, 100."),
    ("tabular", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR\n0., 0.\n2000., 5e-4\n8000., 1e-3"),
    ("hard", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"),
];

/// Counts without a heap of its own.
#[derive(Default)]
struct Count {
    increments: u32,
    changes: usize,
}

impl Watch for Count {
    fn increment(&mut self, _: &Simulation, report: &IncrementReport) {
        self.increments += 1;
        self.changes += report.status_changes.len();
    }
}

/// A punch with some of its points open, driven from outside.
fn loaded(behavior: &str, drive: Drive) -> Simulation {
    let reading = deck::read_text(&punch::deck(5, behavior, drive), Dialect::Abaqus);
    let model = reading.model.unwrap_or_else(|| panic!("{:?}", reading.diagnostics));
    let prepared = PreparedModel::prepare(model, &PrepareOptions::default(), &mut |_| {});
    let mut simulation = Simulation::new(Arc::new(prepared.unwrap_or_else(|e| panic!("{e:?}"))));
    act(&mut simulation, drive, 1.0);
    assert_eq!(simulation.advance(0.5, &mut ()), Ok(AdvanceOutcome::Reached));
    simulation
}

/// A share of the load on the top, the corner lifted against it.
fn act(simulation: &mut Simulation, drive: Drive, share: f64) {
    let corner = match drive {
        Drive::Displacement => 0.2,
        Drive::Force => -1.0,
    };
    for (name, part) in drive.inputs().into_iter().zip([1.0, corner]) {
        let input = simulation.prepared().ports().input(name).expect("an input of the deck");
        simulation.set(input, part * share * drive.full()).expect("a finite value");
    }
}

/// One more increment with a little more load; returns the allocations and what happened.
fn further(simulation: &mut Simulation, drive: Drive, number: u32) -> (u64, Count) {
    let mut count = Count::default();
    let target = 0.5 + 0.01 * f64::from(number);
    act(simulation, drive, 1.0 + 1e-5 * f64::from(number));
    let mut outcome = None;
    let info = allocation_counter::measure(|| outcome = Some(simulation.advance(target, &mut count)));
    assert_eq!(outcome, Some(Ok(AdvanceOutcome::Reached)));
    (info.count_total, count)
}

#[test]
fn an_increment_whose_active_set_stays_takes_nothing_from_the_heap() {
    let mut taken = Vec::new();
    let held = LAWS.into_iter().map(|law| (law, Drive::Displacement));
    let floating = LAWS.into_iter().filter(|(law, _)| *law == "hard").map(|law| (law, Drive::Force));
    for ((law, behavior), drive) in held.chain(floating) {
        let law = format!("{law}, {drive:?}");
        let mut simulation = loaded(behavior, drive);
        let closed = simulation.contact_results().iter().filter(|p| p.pressure > 0.0).count();
        assert!(0 < closed && closed < simulation.contact_results().len(), "{law}: {closed} points closed");
        for number in 1..=20 {
            let (allocations, Count { increments, changes }) = further(&mut simulation, drive, number);
            assert_eq!((increments, changes), (1, 0), "{law}, increment {number}: increments and changes of status");
            if allocations > 0 {
                taken.push(format!("{law}, increment {number}: {allocations}"));
            }
        }
    }
    assert!(taken.is_empty(), "allocations:\n{}", taken.join("\n"));
}

#[test]
fn the_counter_counts() {
    let info = allocation_counter::measure(|| drop(std::hint::black_box(vec![0u8; 16])));
    assert_eq!(info.count_total, 1);
}
