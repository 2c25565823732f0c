//! Analytical surfaces, bars as secondary surfaces and given clearances, from decks.

use std::sync::Arc;

use crate::contact::points;
use crate::deck::read_text;
use crate::model::{Dialect, Model};
use crate::simulation::*;

/// A deformable block of 2 x 1 x 1, its lower face at z = 0 fixed along z; surfaces TOP and BASE.
const BLOCK: &str = "\
*NODE
1, 0., 0., 0.
2, 2., 0., 0.
3, 2., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 2., 0., 1.
7, 2., 1., 1.
8, 0., 1., 1.
100, 1., 0.5, 3.
*ELEMENT, TYPE=C3D8, ELSET=BLOCK
1, 1, 2, 3, 4, 5, 6, 7, 8
*MATERIAL, NAME=M
*ELASTIC
200., 0.
*SOLID SECTION, ELSET=BLOCK, MATERIAL=M
*SURFACE, NAME=TOP
BLOCK, S2
*SURFACE INTERACTION, NAME=I
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
250.
*BOUNDARY
1, 1, 3
2, 2, 3
3, 3
4, 3
";

fn step(loads: &str) -> String {
    format!("*STEP\n*STATIC\n1., 1.\n{loads}*END STEP\n")
}

fn read(deck: &str) -> Model {
    let reading = read_text(deck, Dialect::Abaqus);
    reading.model.unwrap_or_else(|| panic!("{:?}", reading.diagnostics))
}

fn solve(deck: &str) -> (Simulation, NodalSolution) {
    let prepared = PreparedModel::prepare(read(deck), &PrepareOptions::default(), &mut |_| {});
    let mut simulation = Simulation::new(Arc::new(prepared.unwrap_or_else(|e| panic!("{e:?}"))));
    let end = simulation.time_end();
    let outcome = simulation.advance(end, &mut ());
    assert!(matches!(outcome, Ok(AdvanceOutcome::Reached)), "{outcome:?}");
    let solution = simulation.recover();
    (simulation, solution)
}

fn node(simulation: &Simulation, label: u32) -> usize {
    simulation.prepared().model().mesh.node_of_label[&label].index()
}

fn rotation(simulation: &Simulation, label: u32) -> usize {
    let mesh = &simulation.prepared().model().mesh;
    mesh.rotation_of(mesh.node_of_label[&label]).expect("a reference node").index()
}

fn same(actual: [f64; 3], expected: [f64; 3], tolerance: f64) {
    assert!(
        actual.iter().zip(expected).all(|(a, e)| (a - e).abs() <= tolerance),
        "{actual:?} is not {expected:?} within {tolerance:e}"
    );
}

/// A plane at height z above the block that looks down, moved by node 100.
fn plane(z: f64) -> String {
    // Sweep along −y: local z is +y, local x is −x and local y is z x x = (0, 1, 0) x (−1, 0, 0) = (0, 0, 1).
    // The profile runs towards −x locally, so its left is down.
    format!(
        "*SURFACE, NAME=PLANE, TYPE=CYLINDER\n1., 0., {z}, 0., 0., {z}\n1., -1., {z}\nSTART, 3., 0.\nLINE, -3., 0.\n\
         *RIGID BODY, REF NODE=100, ANALYTICAL SURFACE=PLANE\n*CONTACT PAIR, INTERACTION=I, SMALL SLIDING\nTOP, PLANE\n"
    )
}

#[test]
fn a_plane_pressed_on_a_block_compresses_it_and_its_law() {
    let deck = format!("{BLOCK}{}*BOUNDARY\n100, 1, 2\n100, 4, 6\n{}", plane(1.0), step("*CLOAD\n100, 3, -30.\n"));
    let (simulation, solution) = solve(&deck);
    // 15 over the law of 250 and over E / L = 200.
    let (block, law) = (15.0 / 200.0, 15.0 / 250.0);
    same(solution.displacement[node(&simulation, 100)], [0.0, 0.0, -(block + law)], 1e-10);
    for label in 5..=8 {
        assert!((solution.displacement[node(&simulation, label)][2] + block).abs() < 1e-10);
    }
    assert!(simulation.contact_results().iter().all(|p| (p.pressure - 15.0).abs() < 1e-8));
}

#[test]
fn a_held_plane_gives_its_force_and_moment_to_the_reference_node() {
    let top = "*BOUNDARY\n5, 3, 3, 0.04\n8, 3, 3, 0.04\n";
    let deck = format!("{BLOCK}{}*BOUNDARY\n100, ENCASTRE\n{}", plane(1.0), step(top));
    let (simulation, solution) = solve(&deck);
    // Nodes 5 and 8 at x = 0 press with 0.5 · 250 · 0.04 = 5 each; 6 and 7 stay, as nothing lifts them.
    let up = solution.displacement[node(&simulation, 6)][2];
    let forces = [5.0, 250.0 * 0.5 * up.max(0.0)];
    let total = 2.0 * (forces[0] + forces[1]);
    same(solution.reaction[node(&simulation, 100)], [0.0, 0.0, -total], 1e-9);
    // Moment about (1, 0.5): r x F summed, F = up on the plane, the support gives the opposite.
    let moment = 2.0 * (forces[0] - forces[1]);
    same(solution.reaction[rotation(&simulation, 100)], [0.0, -moment, 0.0], 1e-9);
}

#[test]
fn a_plane_turns_until_its_moment_is_in_balance() {
    let deck = format!(
        "{BLOCK}{}*BOUNDARY\n100, 1, 2\n100, 4\n100, 6\n1, 1, 3\n2, 1, 3\n3, 1, 3\n4, 1, 3\n5, 1, 3\n6, 1, 3\n7, 1, 3\n8, 1, 3\n{}",
        plane(1.0),
        step("*CLOAD\n100, 3, -30.\n100, 5, 6.\n")
    );
    let (simulation, solution) = solve(&deck);
    // Four springs of 0.5 · 250 at x − 1 = ±1: stiffness 500, and 500 about y.
    same(solution.displacement[node(&simulation, 100)], [0.0, 0.0, -0.06], 1e-11);
    same(solution.displacement[rotation(&simulation, 100)], [0.0, 6.0 / 500.0, 0.0], 1e-11);
}

#[test]
fn a_node_beside_a_sphere_is_pushed_along_the_radius() {
    let deck = "\
*NODE
1, 3., 0., -3.9
100, 0., 0., 0.
*ELEMENT, TYPE=SPRING1, ELSET=SX
1, 1
*ELEMENT, TYPE=SPRING1, ELSET=SZ
2, 1
*SPRING, ELSET=SX
1
100.
*SPRING, ELSET=SZ
3
100.
*SURFACE, NAME=N, TYPE=NODE
1
*SURFACE, NAME=BALL, TYPE=REVOLUTION
0., 0., 0., 0., 0., 1.
START, 5., 0.
CIRCL, 0., -5., 0., 0.
*RIGID BODY, REF NODE=100, ANALYTICAL SURFACE=BALL
*SURFACE INTERACTION, NAME=I
*CONTACT PAIR, INTERACTION=I, SMALL SLIDING
N, BALL
*BOUNDARY
100, ENCASTRE
1, 2
*STEP
*STATIC
*END STEP
";
    let (simulation, solution) = solve(deck);
    let radius = f64::hypot(3.0, 3.9);
    let (n, overlap) = ([3.0 / radius, 0.0, -3.9 / radius], 5.0 - radius);
    // Equal springs: the node moves along the radius by the overlap.
    same(solution.displacement[node(&simulation, 1)], n.map(|n| n * overlap), 1e-13);
    // The force passes through the centre: no moment.
    same(solution.reaction[node(&simulation, 100)], n.map(|n| 100.0 * overlap * n), 1e-11);
    same(solution.reaction[rotation(&simulation, 100)], [0.0; 3], 1e-11);
}

#[test]
fn bars_carry_a_force_per_length() {
    let deck = format!(
        "{BLOCK}*NODE\n11, 0.2, 0.5, 1.\n12, 0.7, 0.5, 1.\n13, 1.7, 0.5, 1.\n*ELEMENT, TYPE=T3D2, ELSET=ROPE\n11, 11, 12\n12, 12, 13\n\
         *SOLID SECTION, ELSET=ROPE, MATERIAL=M\n0.1\n*SURFACE, NAME=ROPE\nROPE,\n*CONTACT PAIR, INTERACTION=I, SMALL SLIDING\nROPE, TOP\n\
         *BOUNDARY\n1, 1, 3\n2, 1, 3\n3, 1, 3\n4, 1, 3\n5, 1, 3\n6, 1, 3\n7, 1, 3\n8, 1, 3\n11, 1, 2\n12, 1, 2\n13, 1, 2\n{}",
        step("*CLOAD\n11, 3, -5.\n12, 3, -15.\n13, 3, -10.\n")
    );
    let (simulation, solution) = solve(&deck);
    let results = simulation.contact_results();
    let (points, _) = points::find(simulation.prepared().model());
    // Tributary lengths 0.25, 0.75, 0.5; force per length 20 everywhere, so 20 / 250.
    for ((result, point), (label, length)) in results.iter().zip(&points).zip([(11, 0.25), (12, 0.75), (13, 0.5)]) {
        assert!((point.area - length).abs() < 1e-14 && (result.pressure - 20.0).abs() < 1e-9, "{result:?}");
        assert!((solution.displacement[node(&simulation, label)][2] + 0.08).abs() < 1e-11);
    }
    assert!((points[0].length - 0.75).abs() < 1e-14);
}

#[test]
fn given_clearances_win_over_the_geometry() {
    let deck = format!(
        "{BLOCK}{}*BOUNDARY\n100, ENCASTRE\n*CLEARANCE, SLAVE=TOP, MASTER=PLANE, VALUE=-0.02\n{}",
        plane(1.5),
        step("")
    );
    let (found, _) = points::find(&read(&deck));
    assert!(found.len() == 4 && found.iter().all(|p| p.clearance == -0.02));
    let free = deck.replace("*CLEARANCE, SLAVE=TOP, MASTER=PLANE, VALUE=-0.02\n", "");
    let (found, _) = points::find(&read(&free));
    assert!(found.iter().all(|p| (p.clearance - 0.5).abs() < 1e-14));
}

#[test]
fn hcrit_says_from_which_overlap_on_the_geometry_is_doubtful() {
    let overlapping = |hcrit: &str| {
        let deck = format!("{BLOCK}{}*BOUNDARY\n100, ENCASTRE\n{}", plane(0.8), step(""));
        let model = read(&deck.replace("SMALL SLIDING\nTOP", &format!("SMALL SLIDING{hcrit}\nTOP")));
        points::find(&model).1.iter().filter(|d| d.message.contains("inside the primary surface")).count()
    };
    // 0.2 of faces of size 1.41.
    assert_eq!((overlapping(""), overlapping(", HCRIT=0.1"), overlapping(", HCRIT=0.3")), (0, 1, 0));
}

#[test]
fn analytical_surfaces_that_make_no_sense_are_refused() {
    let cases = [
        ("1., 0., 1., 0., 0., 1.\n1., -1., 1.\nLINE, -3., 0.\n", "has no START"),
        ("1., 0., 1., 0., 0., 1.\nSTART, 3., 0.\nLINE, -3., 0.\n", "1 lines stand before START"),
        ("1., 0., 1., 0., 0., 1.\n2., 0., 1.\nSTART, 3., 0.\nLINE, -3., 0.\n", "lie on one line"),
        ("1., 0., 1., 0., 0., 1.\n1., -1., 1.\nSTART, 3., 0.\n", "no segment"),
        ("1., 0., 1., 0., 0., 1.\n1., -1., 1.\nSTART, 3., 0.\nLINE, 3., 0.\n", "ends where it begins"),
        ("1., 0., 1., 0., 0., 1.\n1., -1., 1.\nSTART, 3., 0.\nCIRCL, -3., 0., 0., 0.\n", "180 degrees"),
        ("1., 0., 1., 0., 0., 1.\n1., -1., 1.\nSTART, 3., 0.\nCIRCL, 0., 2., 0., 0.\n", "away from its centre"),
        ("1., 0., 1., 0., 0., 1.\n1., -1., 1.\nSTART, 3., 0.\nPARAB, 0., 2., 0., 0.\n", "parabolic"),
        ("1., 0., 1., 0., 0., 1.\n1., -1., 1.\nSTART, 3., 0.\nARC, 0., 2., 0., 0.\n", "no segment ARC"),
    ];
    let good = "1., 0., 1., 0., 0., 1.\n1., -1., 1.\nSTART, 3., 0.\nLINE, -3., 0.\n";
    let deck = format!("{BLOCK}{}*BOUNDARY\n100, ENCASTRE\n{}", plane(1.0), step(""));
    let good = deck.replace("1., 0., 1, 0., 0., 1\n1., -1., 1\nSTART, 3., 0.\nLINE, -3., 0.\n", good);
    read(&good);
    let refused = |deck: &str, message: &str| {
        let reading = read_text(deck, Dialect::Abaqus);
        assert!(reading.model.is_none(), "{message}");
        assert!(
            reading.diagnostics.iter().any(|d| d.message.contains(message)),
            "{message}: {:?}",
            reading.diagnostics
        );
    };
    for (lines, message) in cases {
        let (head, rest) = good.split_once("TYPE=CYLINDER\n").expect("a surface");
        let (_, tail) = rest.split_once("*RIGID").expect("a body");
        refused(&format!("{head}TYPE=CYLINDER\n{lines}*RIGID{tail}"), message);
    }
    refused(&good.replace("TOP, PLANE", "PLANE, TOP"), "it has no nodes");
    let without = good.replace("*RIGID BODY, REF NODE=100, ANALYTICAL SURFACE=PLANE\n", "");
    refused(&without, "belongs to no rigid body");
    refused(&good.replace("ANALYTICAL SURFACE=PLANE", "ANALYTICAL SURFACE=TOP"), "is not analytical");
    refused(&good.replace("TYPE=CYLINDER", "TYPE=SEGMENTS"), "TYPE=SEGMENTS");
}
