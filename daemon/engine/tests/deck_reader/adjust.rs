//! ADJUST of contact pairs, and pairs of other types that are read as node-to-surface.

use overclosure::deck::summary;
use overclosure::diagnostic::Severity;
use overclosure::model::*;

use crate::base::*;

/// The base deck with the upper cube 0.01 above, or inside, the lower one, and a parameter of the pair.
fn adjusted(gap: f64, parameter: &str) -> String {
    let mut text = with("INTERACTION=SI, SMALL SLIDING", &format!("INTERACTION=SI, SMALL SLIDING{parameter}"));
    for (label, x, y) in [(11, 0, 0), (12, 1, 0), (13, 1, 1), (14, 0, 1)] {
        text = text.replace(&format!("{label}, {x}., {y}., 1."), &format!("{label}, {x}., {y}., {}", 1.0 + gap));
    }
    text
}

/// Heights of the four secondary nodes.
fn heights(model: &Model) -> [f64; 4] {
    std::array::from_fn(|i| model.mesh.nodes[8 + i][2])
}

fn near(heights: [f64; 4], expected: [f64; 4]) -> bool {
    heights.iter().zip(expected).all(|(h, e)| (h - e).abs() < 1e-12)
}

#[test]
fn nodes_within_the_distance_and_overlapping_nodes_are_moved_onto_the_primary_surface() {
    for (gap, distance, moves) in [(0.01, "0.02", true), (0.01, "0.005", false), (-0.01, "0.", true)] {
        let model = model(&adjusted(gap, &format!(", ADJUST={distance}")));
        let expected = if moves { 1.0 } else { 1.0 + gap };
        assert!(near(heights(&model), [expected; 4]), "{:?}", heights(&model));
        let adjust = model.pairs[0].surfaces().expect("surfaces").adjust.expect("ADJUST is given");
        assert_eq!(adjust.moved, if moves { 4 } else { 0 });
        assert!((adjust.distance_max - if moves { 0.01 } else { 0.0 }).abs() < 1e-12);
        assert_eq!(summary(&model).contains("ADJUST moved 4 nodes by up to 1.0000e-2"), moves, "{}", summary(&model));
    }
    let plain = model(&adjusted(0.01, ""));
    assert!(plain.pairs[0].surfaces().expect("surfaces").adjust.is_none() && near(heights(&plain), [1.01; 4]));
}

#[test]
fn nodes_of_a_set_are_moved_wherever_they_are() {
    let text = adjusted(0.1, ", ADJUST=CLOSE")
        .replace("*SURFACE, NAME=SECOND", "*NSET, NSET=CLOSE\n11, 13, 3\n*SURFACE, NAME=SECOND");
    let model = model(&text);
    assert!(near(heights(&model), [1.0, 1.1, 1.0, 1.1]), "{:?}", heights(&model));
    assert_eq!(model.pairs[0].surfaces().expect("surfaces").adjust.map(|adjust| adjust.moved), Some(2));
    warns(&text.replace("11, 13, 3\n", "3\n"), "*CONTACT PAIR", "ADJUST=CLOSE moves nothing");
    refuses(&text.replace("ADJUST=CLOSE", "ADJUST=CLOSED"), "*CONTACT PAIR", "there is no node set CLOSED");
}

#[test]
fn a_node_in_a_corner_is_moved_against_the_floor_and_the_wall() {
    // The lower cube gets a wall beside it: the face x = 0 of the upper cube stands 0.02 from a third cube.
    let wall = "*NODE\n21, -1., 0., 1.\n22, -.02, 0., 1.\n23, -.02, 1., 1.\n24, -1., 1., 1.\n\
        25, -1., 0., 2.\n26, -.02, 0., 2.\n27, -.02, 1., 2.\n28, -1., 1., 2.\n\
        *ELEMENT, TYPE=C3D8, ELSET=WALL\n3, 21, 22, 23, 24, 25, 26, 27, 28\n*ELSET, ELSET=ALL\nWALL\n";
    let text = adjusted(0.01, ", ADJUST=0.05")
        .replace("*NSET, NSET=BOTTOM", &format!("{wall}*NSET, NSET=BOTTOM"))
        .replace("UPPER, S1\n", "UPPER, S1\nUPPER, S6\n")
        .replace("LOWER, S2\n", "LOWER, S2\nWALL, S4\n");
    let model = model(&text);
    for (node, x) in [(8, -0.02), (9, 1.0), (10, 1.0), (11, -0.02)] {
        let [at, _, z] = model.mesh.nodes[node];
        assert!((at - x).abs() < 1e-12 && (z - 1.0).abs() < 1e-12, "node {node} at x = {at}, z = {z}");
    }
}

#[test]
fn adjustments_that_make_no_sense_are_refused() {
    for value in ["-0.1", "1e999", "1..2"] {
        refuses(&adjusted(0.01, &format!(", ADJUST={value}")), "*CONTACT PAIR", "is no distance");
    }
    refuses(&adjusted(0.01, ", ADJUST="), "*CONTACT PAIR", "parameter ADJUST has no value");
    // The nodes would come out above the top of their own cube.
    let text = adjusted(-1.5, ", ADJUST=CLOSE")
        .replace("*SURFACE, NAME=SECOND", "*NSET, NSET=CLOSE\n11, 12, 13, 14\n*SURFACE, NAME=SECOND");
    let sunk = text.replace("., 2.\n", "., 0.9\n");
    refuses(&sunk, "*CONTACT PAIR", "ADJUST spoils element 2: it is inverted or distorted");
}

#[test]
fn surface_to_surface_is_read_as_node_to_surface_with_a_warning() {
    for dialect in [Dialect::Abaqus, Dialect::Calculix] {
        let text = with("INTERACTION=SI", "INTERACTION=SI, TYPE=SURFACE TO SURFACE");
        finds(&text, dialect, Severity::Warning, "*CONTACT PAIR", "is solved node-to-surface");
        assert_eq!(accepted(&text, dialect).0.pairs.len(), 1);
        for other in ["MORTAR", "LINMORTAR", "PGMORTAR", "PGLINMORTAR", "MASSLESS"] {
            let text = with("INTERACTION=SI", &format!("INTERACTION=SI, TYPE={other}"));
            finds(&text, dialect, Severity::Error, "*CONTACT PAIR", &format!("TYPE={other} is not supported"));
        }
    }
}

#[test]
fn calculix_reaches_values_before_the_first_step_over_it() {
    let text = with("TOP, 1, 2\n", "TOP, 1, 2\n5, 1, 1, 0.25\n6, 1, 1, 0.25\n5, 1, 1, 0.25\n7, 2, 2, 0.5\n");
    refuses(&text, "*BOUNDARY", "value 0.25 before the first step");
    finds(&text, Dialect::Calculix, Severity::Warning, "*BOUNDARY", "reached over the first step");
    let (model, found) = accepted(&text, Dialect::Calculix);
    assert_eq!(found.len(), 1, "{}", listing(&found));
    assert_eq!(model.initial_boundaries.len(), 5);
    let lines: Vec<_> =
        model.steps[0].boundaries.iter().map(|b| (b.nodes.len(), b.direction, b.magnitude, b.place.line)).collect();
    assert_eq!(lines, [(2, 0, 0.25, 48), (1, 1, 0.5, 51), (4, 2, -0.01, 56)]);
}

#[test]
fn points_surfaces_of_one_node_and_prescribed_ones_are_read() {
    let text = with("UPPER, S1\n", "11\n").replace("NAME=SECOND", "NAME=SECOND, TYPE=NODE");
    assert_eq!(model(&text).mesh.surfaces[0].kind, SurfaceKind::Nodes(vec![NodeId(8)]));
    // A node without elements, all of it prescribed, meets the surface.
    let lonely =
        text.replace("18, 0., 1., 2.\n", "18, 0., 1., 2.\n99, .5, .5, 1.\n").replace("NODE\n11\n", "NODE\n99\n");
    let text = lonely.replace("TOP, 3, 3, -0.01", "TOP, 3, 3, -0.01\n99, 1, 3, -0.01");
    let (model, found) = accepted(&text, Dialect::Abaqus);
    assert!(found.is_empty(), "{}", listing(&found));
    assert_eq!(model.mesh.surfaces[0].kind, SurfaceKind::Nodes(vec![NodeId(16)]));
}
