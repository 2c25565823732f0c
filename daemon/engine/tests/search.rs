//! Where secondary nodes find the primary surface, by decks whose answer does not depend on how it is found.

use std::path::Path;
use std::sync::Arc;

use overclosure::deck;
use overclosure::model::Dialect;
use overclosure::simulation::{AdvanceOutcome, PrepareOptions, PreparedModel, Simulation};

/// Text of a deck of `tests/decks`.
fn text(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/decks").join(format!("{name}.inp"));
    std::fs::read_to_string(path).expect("the deck is there")
}

/// Reads, prepares and solves a deck of `tests/decks`.
fn solved(name: &str) -> Simulation {
    solve(&text(name))
}

/// Reads, prepares and solves a deck.
fn solve(text: &str) -> Simulation {
    let reading = deck::read_text(text, Dialect::Abaqus);
    let model = reading.model.unwrap_or_else(|| panic!("{:?}", reading.diagnostics));
    let prepared = PreparedModel::prepare(model, &PrepareOptions::default(), &mut |_| {});
    let mut simulation = Simulation::new(Arc::new(prepared.unwrap_or_else(|e| panic!("{e:?}"))));
    let end = simulation.time_end();
    assert_eq!(simulation.advance(end, &mut ()), Ok(AdvanceOutcome::Reached));
    assert_eq!(simulation.audit(), Vec::<String>::new());
    simulation
}

fn force(simulation: &Simulation) -> [f64; 3] {
    simulation.history().pairs[0].force
}

/// A flat punch over an arc of facets, pushed 0.05 beyond a gap of 1 or of 3: the same contact.
#[test]
fn a_convex_surface_is_found_from_any_distance() {
    let (near, far) = (solved("convex_gap_1"), solved("convex_gap_3"));
    assert_eq!(near.contact_results().len(), 18);
    assert_eq!(far.contact_results().len(), 18);
    for d in 0..3 {
        assert!((force(&near)[d] - force(&far)[d]).abs() < 1e-9 * force(&near)[2], "{d}");
    }
}

/// A block beside a frictionless wall goes straight down on a floor: the wall gives nothing, and the floor what it gives when
/// neither the wall nor the side of the block is in the pair, where no node has to choose.
#[test]
fn a_node_in_a_corner_meets_floor_and_wall_each_on_its_own() {
    for name in ["corner_touching", "corner_equal_gaps", "corner_wall_nearer"] {
        let both = text(name);
        let floor_only = both.replace("WALL, S4\n", "").replace("UPP, S6\n", "");
        assert!(
            both.contains("WALL, S4\n") && both.contains("UPP, S6\n"),
            "{name}: the lines that are taken out are there"
        );
        let (corner, floor) = (solve(&both), solve(&floor_only));
        let ([wall, _, pressed], [_, _, expected]) = (force(&corner), force(&floor));
        assert!(wall.abs() < 1e-9 * expected && expected > 1.0, "{name}: {wall}");
        assert!((pressed - expected).abs() < 1e-9 * expected, "{name}: {pressed} {expected}");
        assert!(corner.contact_results().iter().all(|p| p.clearance > -1e-12), "{name}: nothing sinks in");
    }
}

/// A vertical side over a horizontal floor does not look at it, however both are turned.
#[test]
fn a_side_wall_does_not_look_at_the_floor_it_stands_on() {
    for name in ["side_wall", "side_wall_turned"] {
        assert!(solved(name).contact_results().is_empty(), "{name}");
    }
}

/// A node that hangs over the edge of a skewed face by 0.06, with 0.141 allowed.
#[test]
fn overhang_is_measured_from_the_rim_and_not_from_a_corner() {
    let s = solved("skewed_rim");
    assert!(force(&s)[2] > 0.0);
}

/// A body whose bottom is paired with its own top starts a whole height inside.
#[test]
fn a_deep_start_is_pointed_out() {
    let s = solved("own_top");
    let warnings: Vec<String> = s.prepared().warnings().iter().map(ToString::to_string).collect();
    assert!(warnings.iter().any(|w| w.contains("more than half a face inside")), "{warnings:?}");
}
