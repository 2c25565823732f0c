//! Stiffness underneath contact points and characteristic lengths, from decks.

use crate::contact::underlying::*;
use crate::deck::read_text;
use crate::model::{Dialect, ElementFace, ElementId, Model, NodeId};

/// A block 2 x 3 x 4 of one element, another of 2 x 3 x 1 above it, and node 20 with a spring and a bar.
const DECK: &str = "\
*NODE
1, 0., 0., 0.
2, 2., 0., 0.
3, 2., 3., 0.
4, 0., 3., 0.
5, 0., 0., 4.
6, 2., 0., 4.
7, 2., 3., 4.
8, 0., 3., 4.
31, 0., 0., 4.
32, 2., 0., 4.
33, 2., 3., 4.
34, 0., 3., 4.
35, 0., 0., 5.
36, 2., 0., 5.
37, 2., 3., 5.
38, 0., 3., 5.
20, 1., 1., 4.
21, 1., 1., 6.
*ELEMENT, TYPE=C3D8, ELSET=BLOCK
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=C3D8, ELSET=LID
4, 31, 32, 33, 34, 35, 36, 37, 38
*ELEMENT, TYPE=SPRING1, ELSET=S
2, 20
*ELEMENT, TYPE=T3D2, ELSET=B
3, 20, 21
*SPRING, ELSET=S
3
7.
*MATERIAL, NAME=M
*ELASTIC
200., 0.25
*SOLID SECTION, ELSET=BLOCK, MATERIAL=M
*SOLID SECTION, ELSET=LID, MATERIAL=M
*SOLID SECTION, ELSET=B, MATERIAL=M
0.5
*SURFACE, NAME=TOP
BLOCK, S2
*SURFACE, NAME=LOWER
LID, S1
*SURFACE, NAME=POINTS, TYPE=NODE
33
20
*SURFACE INTERACTION, NAME=I
*CONTACT PAIR, INTERACTION=I, SMALL SLIDING
POINTS, TOP
LOWER, TOP
*STEP
*STATIC
*END STEP
";
/// M = 200 · 0.75 / (1.25 · 0.5).
const M: f64 = 240.0;

fn model() -> Model {
    let reading = read_text(DECK, Dialect::Abaqus);
    reading.model.unwrap_or_else(|| panic!("{:?}", reading.diagnostics))
}

fn close(a: Option<f64>, b: f64) {
    let a = a.unwrap_or_else(|| panic!("none instead of {b}"));
    assert!((a - b).abs() < 1e-12 * b, "{a} is not {b}");
}

#[test]
fn under_a_face_is_the_constrained_modulus_over_the_depth_of_the_element() {
    let model = model();
    let underlying = Underlying::new(&model);
    let face = |face| ElementFace { element: ElementId(0), face };
    close(underlying.of_face(face(1)), M / 4.0);
    close(underlying.of_face(face(2)), M / 3.0);
    close(underlying.force_of_face(face(1)), M / 4.0 * 6.0);
    let nodes = underlying.of_faces(&[face(1), face(2)]);
    close(nodes.get(&NodeId(4)).copied(), 0.5 * (M / 4.0 + M / 3.0));
    close(nodes.get(&NodeId(6)).copied(), M / 4.0);
    assert_eq!(nodes.len(), 6);
}

#[test]
fn connectors_count_by_their_share_along_the_normal() {
    let model = model();
    let underlying = Underlying::new(&model);
    // A spring of 7 and a bar of 200 · 0.5 / 2 = 50, both along 3.
    let node = model.mesh.node_of_label[&20];
    close(underlying.of_connectors(node, [0.0, 0.0, 1.0]), 57.0);
    close(underlying.of_connectors(node, [0.6, 0.0, -0.8]), 57.0 * 0.64);
    assert_eq!(underlying.of_connectors(node, [1.0, 0.0, 0.0]), None);
    assert_eq!(underlying.of_connectors(NodeId(0), [0.0, 0.0, 1.0]), None);
}

#[test]
fn a_node_without_a_surface_takes_its_share_of_the_outer_faces_that_look_along_the_normal() {
    let model = model();
    let underlying = Underlying::new(&model);
    // Node 33 at (2, 3, 4): a quarter of the bottom of 6, or of the side x = 2 of 3.
    let node = model.mesh.node_of_label[&33];
    close(underlying.of_node(node, [0.0, 0.0, -1.0]), M / 1.0 * 6.0 / 4.0);
    close(underlying.of_node(node, [1.0, 0.0, 0.0]), M / 2.0 * 3.0 / 4.0);
    // No face looks up there.
    close(underlying.of_node(node, [0.0, 0.0, 1.0]), M * 6f64.cbrt());
    assert_eq!(underlying.of_node(model.mesh.node_of_label[&20], [0.0, 0.0, 1.0]), None);
}

#[test]
fn points_have_both_sides_in_series_and_one_length_per_pair() {
    let model = model();
    let (points, _) = crate::contact::points::find(&model);
    let [corner, spring] = [&points[0], &points[1]].map(|p| (p.underlying, p.length));
    // Nodes of area 1: forces per length. Below, a face of 6 with depth 4; above, the spring and the bar, or a quarter face.
    let below = M / 4.0 * 6.0;
    close(spring.0, 1.0 / (1.0 / below + 1.0 / 57.0));
    close(corner.0, 1.0 / (1.0 / below + 4.0 / (6.0 * M)));
    close(Some(corner.1), 6f64.sqrt());
    // Faces: depths 4 and 1 in series.
    assert_eq!(points.len(), 6);
    for point in &points[2..] {
        close(point.underlying, M / 5.0);
        close(Some(point.length), 6f64.sqrt());
    }
}

#[test]
fn sides_are_in_series_and_rigid_ones_do_not_count() {
    close(in_series(Some(3.0), Some(6.0)), 2.0);
    close(in_series(Some(3.0), None), 3.0);
    close(in_series(None, Some(6.0)), 6.0);
    assert_eq!(in_series(None, None), None);
}
