//! Rigid bodies, from decks: against hand statics and against the same bodies without them.

use std::sync::Arc;

use crate::deck::read_text;
use crate::model::{Dialect, Model, NodeId};
use crate::simulation::*;

/// A unit cube of 2 x 1 x 1 with its lower face at z = 0, and a node to refer to.
const CUBE: &str = "\
*NODE
1, 0., 0., 0.
2, 2., 0., 0.
3, 2., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 2., 0., 1.
7, 2., 1., 1.
8, 0., 1., 1.
100, 0.5, 0.5, 2.
*ELEMENT, TYPE=C3D8, ELSET=CUBE
1, 1, 2, 3, 4, 5, 6, 7, 8
*MATERIAL, NAME=M
*ELASTIC
200., 0.3
*DENSITY
5.
*SOLID SECTION, ELSET=CUBE, MATERIAL=M
";

/// A wall of one facet below the cube, which looks up.
const WALL: &str = "\
*NODE
21, -1., -1., 0.
22, 3., -1., 0.
23, 3., 2., 0.
24, -1., 2., 0.
200, 0., 0., -1.
*ELEMENT, TYPE=R3D4, ELSET=WALL
2, 21, 22, 23, 24
*RIGID BODY, REF NODE=200, ELSET=WALL
*BOUNDARY
200, ENCASTRE
*SURFACE, NAME=WALL
WALL, SPOS
*SURFACE, NAME=BASE
CUBE, S1
*SURFACE INTERACTION, NAME=I
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
250.
*CONTACT PAIR, INTERACTION=I, SMALL SLIDING
BASE, WALL
";

fn step(loads: &str) -> String {
    format!("*STEP\n*STATIC\n1., 1.\n{loads}*END STEP\n")
}

fn read(deck: &str, dialect: Dialect) -> Model {
    let reading = read_text(deck, dialect);
    reading.model.unwrap_or_else(|| panic!("{:?}", reading.diagnostics))
}

fn solved(model: Model) -> Simulation {
    let prepared = PreparedModel::prepare(model, &PrepareOptions::default(), &mut |_| {});
    let mut simulation = Simulation::new(Arc::new(prepared.unwrap_or_else(|e| panic!("{e:?}"))));
    let end = simulation.time_end();
    let outcome = simulation.advance(end, &mut ());
    assert!(matches!(outcome, Ok(AdvanceOutcome::Reached)), "{outcome:?}");
    simulation
}

fn solve(deck: &str) -> (Simulation, NodalSolution) {
    let simulation = solved(read(deck, Dialect::Abaqus));
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

#[test]
fn a_rigid_block_on_a_rigid_wall_sinks_into_the_law() {
    let body = "*RIGID BODY, REF NODE=100, ELSET=CUBE\n*BOUNDARY\n100, 1, 2\n100, 6, 6\n";
    let deck = format!("{CUBE}{WALL}{body}{}", step("*CLOAD\n100, 3, -30.\n100, 5, 15.\n"));
    let (simulation, solution) = solve(&deck);
    // 30 over an area of 2 on a law of 250; the force at x = 0.5 with the moment 15 about y acts at x = 1.
    let u = solution.displacement[node(&simulation, 100)];
    same(u, [0.0, 0.0, -0.06], 1e-12);
    same(solution.displacement[rotation(&simulation, 100)], [0.0; 3], 1e-12);
    assert!(simulation.contact_results().iter().all(|p| (p.pressure - 15.0).abs() < 1e-9));
    // The wall takes 30 at (1, 0.5, 0) about (0, 0, −1).
    same(solution.reaction[node(&simulation, 200)], [0.0, 0.0, 30.0], 1e-9);
    same(solution.reaction[rotation(&simulation, 200)], [15.0, -30.0, 0.0], 1e-9);
}

#[test]
fn a_lever_turns_by_its_moment_over_its_rotational_stiffness() {
    let deck = format!(
        "{CUBE}*ELEMENT, TYPE=SPRING1, ELSET=S\n9, 6\n*SPRING, ELSET=S\n3\n400.\n\
         *RIGID BODY, REF NODE=100, ELSET=CUBE\n*BOUNDARY\n100, 1, 4\n100, 6, 6\n{}",
        step("*CLOAD\n1, 3, 30.\n100, 5, -60.\n")
    );
    let (simulation, solution) = solve(&deck);
    // About y at x = 0.5: u3 = −θ (x − 0.5). Moment: −60 − 30 (0 − 0.5) = −45; spring at x − 0.5 = 1.5: 400 · 1.5² = 900.
    let theta = -45.0 / 900.0;
    same(solution.displacement[rotation(&simulation, 100)], [0.0, theta, 0.0], 1e-13);
    // Node 3 at (1.5, 0.5, −2) from the reference: θ × r.
    same(solution.displacement[node(&simulation, 3)], [-2.0 * theta, 0.0, -1.5 * theta], 1e-12);
    // Spring force −400 · 1.5 · 0.05 = −30 balances the load.
    same(solution.reaction[node(&simulation, 100)], [0.0; 3], 1e-10);
}

#[test]
fn weight_of_rigid_solids_acts_at_their_centre() {
    let deck = format!(
        "{CUBE}*RIGID BODY, REF NODE=100, ELSET=CUBE\n*BOUNDARY\n100, ENCASTRE\n{}",
        step("*DLOAD\nCUBE, GRAV, 3., 0., 0., -1.\n")
    );
    let (simulation, solution) = solve(&deck);
    // Volume 2, density 5, acceleration 3: 30 down at x − 0.5 = 0.5 from the reference node.
    same(solution.reaction[node(&simulation, 100)], [0.0, 0.0, 30.0], 1e-12);
    same(solution.reaction[rotation(&simulation, 100)], [0.0, -15.0, 0.0], 1e-12);
}

#[test]
fn a_rigid_face_of_a_solid_does_what_equal_prescribed_displacements_do() {
    let turned = format!(
        "{CUBE}*NSET, NSET=TOP\n5, 6, 7, 8\n*RIGID BODY, REF NODE=100, TIE NSET=TOP\n*BOUNDARY\n1, 1, 3\n2, 2, 3\n4, 3\n3, 3\n{}",
        step(
            "*BOUNDARY\n100, 1, 1, 0.01\n100, 2, 2, 0.\n100, 3, 3, -0.02\n100, 4, 4, 0.03\n100, 5, 5, 0.\n100, 6, 6, 0.04\n"
        )
    );
    let (simulation, solution) = solve(&turned);
    // u = t + θ × r with r from (0.5, 0.5, 2) to the top at z = 1.
    let mut lines = String::from("*BOUNDARY\n");
    let (t, theta) = ([0.01, 0.0, -0.02], [0.03, 0.0, 0.04]);
    for (label, [x, y]) in [(5, [0.0, 0.0]), (6, [2.0, 0.0]), (7, [2.0, 1.0]), (8, [0.0, 1.0])] {
        let r = [x - 0.5, y - 0.5, -1.0];
        let u = [
            t[0] + theta[1] * r[2] - theta[2] * r[1],
            t[1] + theta[2] * r[0] - theta[0] * r[2],
            t[2] + theta[0] * r[1] - theta[1] * r[0],
        ];
        same(solution.displacement[node(&simulation, label)], u, 1e-14);
        for (d, value) in u.iter().enumerate() {
            lines += &format!("{label}, {0}, {0}, {value}\n", d + 1);
        }
    }
    let (plain, expected) = solve(&format!("{CUBE}*BOUNDARY\n1, 1, 3\n2, 2, 3\n4, 3\n3, 3\n{}", step(&lines)));
    let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
    for label in 1..=8 {
        same(solution.displacement[node(&simulation, label)], expected.displacement[node(&plain, label)], 1e-14);
    }
    for (label, [x, y]) in [(5, [0.0, 0.0]), (6, [2.0, 0.0]), (7, [2.0, 1.0]), (8, [0.0, 1.0])] {
        let (r, f) = ([x - 0.5, y - 0.5, -1.0], expected.reaction[node(&plain, label)]);
        for d in 0..3 {
            let (a, b) = ((d + 1) % 3, (d + 2) % 3);
            force[d] += f[d];
            moment[d] += r[a] * f[b] - r[b] * f[a];
        }
    }
    same(solution.reaction[node(&simulation, 100)], force, 1e-11);
    same(solution.reaction[rotation(&simulation, 100)], moment, 1e-11);
}

#[test]
fn a_rot_node_of_calculix_carries_the_rotations() {
    let deck = format!(
        "{CUBE}*NODE\n101, 0., 0., 0.\n*ELEMENT, TYPE=SPRING1, ELSET=S\n9, 6\n*SPRING, ELSET=S\n3\n400.\n\
         *NSET, NSET=ALL\n1, 2, 3, 4, 5, 6, 7, 8\n*RIGID BODY, NSET=ALL, REF NODE=100, ROT NODE=101\n\
         *BOUNDARY\n100, 1, 3\n101, 1\n101, 3\n{}",
        step("*CLOAD\n101, 2, -45.\n")
    );
    let model = read(&deck, Dialect::Calculix);
    assert_eq!((model.mesh.node_count(), model.mesh.nodes.len()), (10, 10));
    let simulation = solved(model);
    same(simulation.recover().displacement[node(&simulation, 101)], [0.0, -0.05, 0.0], 1e-12);
}

#[test]
fn hidden_nodes_stand_behind_those_of_the_analyst_with_the_number_of_their_reference_node() {
    let model = read(
        &format!("{CUBE}{WALL}{}", step("")).replace("*CONTACT PAIR", "*BOUNDARY\n5, 1, 3\n*CONTACT PAIR"),
        Dialect::Abaqus,
    );
    let mesh = &model.mesh;
    assert_eq!((mesh.node_count(), mesh.nodes.len()), (14, 15));
    let (reference, hidden) = mesh.rotations[0];
    assert_eq!((mesh.node_labels[reference.index()], mesh.node_labels[14], hidden), (200, 200, NodeId(14)));
    assert_eq!((mesh.dof_of(reference, 2), mesh.dof_of(hidden, 0)), (3, 4));
    assert_eq!(mesh.node_of_label[&200], reference);
}

#[test]
fn rigid_bodies_that_contradict_themselves_are_refused() {
    let cases = [
        ("*RIGID BODY, REF NODE=100\n", "neither elements nor nodes"),
        ("*RIGID BODY, REF NODE=99, ELSET=CUBE\n", "node 99 is not defined"),
        ("*RIGID BODY, REF NODE=100, ELSET=NONE\n", "no element set NONE"),
        (
            "*RIGID BODY, REF NODE=100, ELSET=CUBE\n*RIGID BODY, REF NODE=100, PIN NSET=TWO\n",
            "reference node of another",
        ),
        (
            "*RIGID BODY, REF NODE=100, ELSET=CUBE\n*RIGID BODY, REF NODE=101, PIN NSET=TWO\n",
            "belongs to another rigid body",
        ),
        (
            "*RIGID BODY, REF NODE=100, PIN NSET=TWO\n*RIGID BODY, REF NODE=1, ELSET=CUBE\n",
            "belongs to another rigid body",
        ),
        (
            "*RIGID BODY, REF NODE=100, PIN NSET=FAR\n*RIGID BODY, REF NODE=101, ELSET=CUBE\n",
            "node of another rigid body",
        ),
        ("*RIGID BODY, REF NODE=100, ELSET=CUBE\n*BOUNDARY\n5, 3\n", "direction 3 of node 5 follows the rigid body"),
        (
            "*RIGID BODY, REF NODE=100, ELSET=CUBE\n*EQUATION\n2\n5, 3, 1., 101, 3, 1.\n",
            "direction 3 of node 5 follows the rigid body, and is the first term",
        ),
        ("*RIGID BODY, REF NODE=100, ELSET=CUBE, ROT NODE=101\n", "ROT NODE is a parameter of CalculiX"),
        ("*RIGID BODY, REF NODE=TWO, ELSET=CUBE\n", "the set has 2 nodes"),
        ("*RIGID BODY, REF NODE=100, ELSET=SPRINGS\n", "cannot be part of a rigid body"),
        ("*ELEMENT, TYPE=R3D3, ELSET=F\n20, 1, 2, 5\n", "1 facets belong to no rigid body"),
        (
            "*ELEMENT, TYPE=R3D3, ELSET=F\n20, 1, 2, 5\n*RIGID BODY, REF NODE=100, ELSET=F\n*SURFACE, NAME=X\nF,\n",
            "write SPOS or SNEG",
        ),
    ];
    for (lines, message) in cases {
        let deck = format!(
            "{CUBE}*NODE\n101, 5., 5., 5.\n*NSET, NSET=TWO\n5, 6\n*NSET, NSET=FAR\n101\n*ELEMENT, TYPE=SPRING1, ELSET=SPRINGS\n9, 5\n\
             *SPRING, ELSET=SPRINGS\n3\n4.\n{lines}{}",
            step("")
        );
        let reading = read_text(&deck, Dialect::Abaqus);
        assert!(reading.model.is_none(), "{lines}");
        assert!(
            reading.diagnostics.iter().any(|d| d.message.contains(message)),
            "{message}: {:?}",
            reading.diagnostics
        );
    }
    let warned = read_text(
        &format!("{CUBE}*BOUNDARY\n1, 1, 6\n2, ENCASTRE\n4, 1, 3\n{}", step("*CLOAD\n5, 4, 1.\n")),
        Dialect::Abaqus,
    );
    let ignored: Vec<_> = warned.diagnostics.iter().filter(|d| d.message.contains("only reference nodes")).collect();
    assert_eq!((ignored.len(), warned.model.is_some()), (2, true), "{:?}", warned.diagnostics);
}
