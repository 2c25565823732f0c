//! Areas of the nodes of a node-based secondary surface: 1, CalculiX's share of the outer faces (of a node on no solid the primary face under
//! it) in its dialect, or what the deck gives.

use overclosure::deck;
use overclosure::model::Dialect;
use overclosure::simulation::{PrepareOptions, PreparedModel};

/// Two bricks of 1 x 2 x 3 in a row, a tetrahedron with legs of 1, 2 and 3, one with midside nodes, and a node on a spring: all stand on a
/// slab with these nodes of theirs: 1 (end of the row), 5 (between the bricks), 101 and 201 (corners of tetrahedra), 301 (spring).
fn deck(area: &str) -> String {
    let mut text = String::from("*NODE, NSET=NALL\n");
    for i in 0..3 {
        for (k, (y, z)) in [(0, 0), (2, 0), (2, 3), (0, 3)].into_iter().enumerate() {
            text += &format!("{}, {i}., {y}., {z}.\n", 4 * i + k + 1);
        }
    }
    for (first, x) in [(100, 10.0), (200, 14.0)] {
        for (k, [a, b, c]) in [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]].into_iter().enumerate() {
            text += &format!("{}, {}, {b}, {c}\n", first + k + 1, x + a);
        }
    }
    text += "205, 14.5, 0., 0.\n206, 14.5, 1., 0.\n207, 14., 1., 0.\n208, 14., 0., 1.5\n209, 14.5, 0., 1.5\n210, 14., 1., 1.5\n";
    text += "301, 18., 0., 0.\n";
    for (k, (x, y, z)) in
        [(-5, -5, -1), (25, -5, -1), (25, 5, -1), (-5, 5, -1), (-5, -5, 0), (25, -5, 0), (25, 5, 0), (-5, 5, 0)]
            .into_iter()
            .enumerate()
    {
        text += &format!("{}, {x}., {y}., {z}.\n", 401 + k);
    }
    text += "*ELEMENT, TYPE=C3D8, ELSET=E\n1, 1, 5, 6, 2, 4, 8, 7, 3\n2, 5, 9, 10, 6, 8, 12, 11, 7\n";
    text += "4, 401, 402, 403, 404, 405, 406, 407, 408\n";
    text += "*ELEMENT, TYPE=C3D4, ELSET=E\n101, 101, 102, 103, 104\n";
    text += "*ELEMENT, TYPE=C3D10, ELSET=E\n201, 201, 202, 203, 204, 205, 206, 207, 208, 209, 210\n";
    text += "*ELEMENT, TYPE=SPRING1, ELSET=HELD\n301, 301\n*SPRING, ELSET=HELD\n3\n1.\n";
    text += "*MATERIAL, NAME=M\n*ELASTIC\n1., 0.\n*SOLID SECTION, ELSET=E, MATERIAL=M\n";
    text += "*SURFACE, NAME=FEET, TYPE=NODE\n1\n5\n101\n201\n301\n*SURFACE, NAME=SLAB\n4, S2\n";
    text += &format!("*SURFACE INTERACTION, NAME=I\n{area}*CONTACT PAIR, INTERACTION=I, SMALL SLIDING\nFEET, SLAB\n");
    text + "*BOUNDARY\nNALL, 1, 3\n*STEP\n*STATIC\n*END STEP\n"
}

/// Areas by node label, and the warnings.
fn areas(area: &str, dialect: Dialect) -> (Vec<f64>, Vec<String>) {
    let reading = deck::read_text(&deck(area), dialect);
    let model = reading.model.unwrap_or_else(|| panic!("{:?}", reading.diagnostics));
    let prepared = PreparedModel::prepare(model, &PrepareOptions::default(), &mut |_| {});
    let prepared = prepared.unwrap_or_else(|e| panic!("{e:?}"));
    let areas = prepared.contact_points().iter().map(|p| p.area).collect();
    (areas, prepared.warnings().iter().map(|w| w.message.clone()).collect())
}

fn assert_areas(found: &[f64], expected: [f64; 5]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-13 * expected, "{found} is not {expected}");
    }
}

const WARNING: &str = "1 of 5 secondary nodes have midside nodes on their outer faces";

#[test]
fn a_node_stands_for_one_where_nothing_else_is_said() {
    let (found, warnings) = areas("", Dialect::Abaqus);
    assert_areas(&found, [1.0; 5]);
    assert!(!warnings.iter().any(|w| w.contains(WARNING)), "{warnings:?}");
}

/// A quarter of the three faces at the end of the row; of the four outer ones, not of the inner one, between the bricks; a third of
/// those of the tetrahedron. Nothing is known about the last two.
#[test]
fn in_the_calculix_dialect_it_stands_for_its_share_of_the_outer_faces() {
    let (found, warnings) = areas("", Dialect::Calculix);
    assert_areas(&found, [(2.0 + 3.0 + 6.0) / 4.0, (2.0 + 2.0 + 3.0 + 3.0) / 4.0, (1.0 + 3.0 + 1.5) / 3.0, 1.0, 300.0]);
    assert!(warnings.iter().any(|w| w.contains(WARNING) && w.ends_with(": 201")), "{warnings:?}");
}

#[test]
fn the_area_of_the_interaction_counts_in_both_dialects() {
    for dialect in [Dialect::Abaqus, Dialect::Calculix] {
        let (found, warnings) = areas("0.25\n", dialect);
        assert_areas(&found, [0.25; 5]);
        assert!(!warnings.iter().any(|w| w.contains(WARNING)), "{warnings:?}");
    }
}
