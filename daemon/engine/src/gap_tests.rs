//! GAP elements as contact points, from the deck.

use crate::contact::points;
use crate::deck::read_text;
use crate::model::Dialect;

/// Two nodes and a spring of 40 along each direction at the second, with a gap between them.
fn deck(kind: &str, second: &str, line: &str) -> String {
    format!(
        "\
*NODE
1, 1., 1., 1.
2, {second}
*ELEMENT, TYPE={kind}, ELSET=G
1, 1, 2
*ELEMENT, TYPE=SPRING1, ELSET=S1
2, 2
*ELEMENT, TYPE=SPRING1, ELSET=S3
3, 2
*SPRING, ELSET=S1
1
40.
*SPRING, ELSET=S3
3
40.
*GAP, ELSET=G
{line}
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
250.
*BOUNDARY
1, 1, 3
*STEP
*STATIC
*END STEP
"
    )
}

fn point(kind: &str, second: &str, line: &str) -> points::ContactPoint {
    let reading = read_text(&deck(kind, second, line), Dialect::Abaqus);
    let model = reading.model.unwrap_or_else(|| panic!("{:?}", reading.diagnostics));
    assert_eq!((model.pairs[0].name.as_str(), model.interactions[0].name.as_str()), ("G", "G"));
    let (points, warnings) = points::find(&model);
    assert!(warnings.is_empty(), "{warnings:?}");
    assert_eq!(points.len(), 1);
    assert_eq!((points[0].node.0, points[0].primary.to_vec()[0].0), (1, 0));
    points.into_iter().next().unwrap()
}

fn close(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-14, "{a} is not {b}");
}

fn same(a: [f64; 3], b: [f64; 3]) {
    a.into_iter().zip(b).for_each(|(a, b)| close(a, b));
}

#[test]
fn gapuni_opens_along_its_direction_or_along_the_line_of_its_nodes() {
    let along = point("GAPUNI", "1., 1., 3.", "0.05, , , , 0.5");
    same(along.normal, [0.0, 0.0, 1.0]);
    close(along.clearance, 0.05);
    assert_eq!((along.area, along.length, along.face_size), (0.5, 2.0, f64::INFINITY));
    // The spring along 3 over the area; node 1 has no elements.
    close(along.underlying.unwrap(), 80.0);
    let given = point("GAPUNIT", "1., 1., 1.", "-0.05, 3., 0., 4.");
    same(given.normal, [0.6, 0.0, 0.8]);
    close(given.clearance, -0.05);
    assert_eq!((given.area, given.length), (1.0, 0.05));
    close(given.underlying.unwrap(), 40.0 * 0.36 + 40.0 * 0.64);
}

#[test]
fn gapcyl_and_gapspher_keep_nodes_within_or_without_a_distance() {
    // From node 1: (3, 1, 4); across the 2-axis (3, 0, 4) of length 5.
    for (line, clearance, sign) in [("6., 0., 2., 0.", 1.0, -1.0), ("-2., 0., 2., 0.", 3.0, 1.0)] {
        let point = point("GAPCYL", "4., 2., 5.", line);
        close(point.clearance, clearance);
        same(point.normal, [sign * 0.6, 0.0, sign * 0.8]);
        close(point.face_size, 5.0);
    }
    for (line, clearance, sign) in [("6.", 1.0, -1.0), ("-7.", -2.0, 1.0)] {
        let point = point("GAPSPHER", "1., 4., 5.", line);
        close(point.clearance, clearance);
        same(point.normal, [0.0, sign * 0.6, sign * 0.8]);
    }
}

#[test]
fn gaps_without_a_direction_a_distance_or_a_card_are_refused() {
    let cases = [
        ("GAPUNI", "1., 1., 1.", "0.05", "give no direction"),
        ("GAPUNI", "1., 1., 2.", "0.05, , , , -1.", "area -1 is not positive"),
        ("GAPCYL", "4., 2., 5.", "6.", "axis of GAPCYL is missing"),
        ("GAPCYL", "1., 5., 1.", "6., 0., 1., 0.", "one line along the axis"),
        ("GAPCYL", "4., 2., 5.", "0., 0., 1., 0.", "0 or missing"),
        ("GAPSPHER", "1., 1., 1.", "6.", "at the same place"),
        ("GAPSPHER", "1., 1., 2.", "6., 1., 0., 0.", "has no direction"),
        ("DGAP", "1., 1., 2.", "6.", "element type DGAP is not supported"),
    ];
    for (kind, second, line, message) in cases {
        let reading = read_text(&deck(kind, second, line), Dialect::Abaqus);
        assert!(reading.diagnostics.iter().any(|d| d.message.contains(message)), "{:?}", reading.diagnostics);
        assert!(reading.model.is_none());
    }
    let without = deck("GAPUNI", "1., 1., 2.", "0.05").replace("*GAP, ELSET=G", "*GAP, ELSET=S1");
    let reading = read_text(&without, Dialect::Abaqus);
    for message in ["takes no *GAP", "have no *GAP"] {
        assert!(reading.diagnostics.iter().any(|d| d.message.contains(message)), "{:?}", reading.diagnostics);
    }
}
