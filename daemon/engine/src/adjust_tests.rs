//! Adjusted contact points, from decks.

use crate::contact::points;
use crate::deck::read_text;
use crate::model::Dialect;

/// A block with a sloping top, z = 1 + x / 4, and three nodes of a surface over or under it.
const DECK: &str = "\
*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 1., 0., 1.25
7, 1., 1., 1.25
8, 0., 1., 1.
11, 0.3, 0.3, 1.1
12, 0.6, 0.6, 1.1
13, 0.5, 0.5, 1.6
*ELEMENT, TYPE=C3D8, ELSET=BLOCK
1, 1, 2, 3, 4, 5, 6, 7, 8
*MATERIAL, NAME=M
*ELASTIC
200., 0.3
*SOLID SECTION, ELSET=BLOCK, MATERIAL=M
*SURFACE, NAME=TOP
BLOCK, S2
*SURFACE, NAME=POINTS, TYPE=NODE
11
12
13
*SURFACE INTERACTION, NAME=I
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
1.
*CONTACT PAIR, INTERACTION=I, SMALL SLIDING, ADJUST=0.1
POINTS, TOP
*BOUNDARY
1, 1, 3
*STEP
*STATIC
*END STEP
";

#[test]
fn adjusted_points_are_closed_to_the_bit_and_others_keep_their_clearance() {
    let reading = read_text(DECK, Dialect::Abaqus);
    let model = reading.model.unwrap_or_else(|| panic!("{:?}", reading.diagnostics));
    let nodes = &model.mesh.nodes;
    let normal = [-0.25, 0.0, 1.0].map(|x| x / 1.0625f64.sqrt());
    // Clearance before: (z - 1 - x / 4) times the normal's share of z.
    for (node, start) in [(8, [0.3, 0.3, 1.1]), (9, [0.6, 0.6, 1.1])] {
        let clearance = (start[2] - 1.0 - start[0] / 4.0) * normal[2];
        for i in 0..3 {
            assert!((nodes[node][i] - (start[i] - clearance * normal[i])).abs() < 1e-14, "{:?}", nodes[node]);
        }
    }
    assert_eq!(nodes[10], [0.5, 0.5, 1.6]);
    let (points, _) = points::find(&model);
    assert_eq!(points.iter().map(|p| p.clearance).take(2).collect::<Vec<_>>(), [0.0, 0.0]);
    assert!((points[2].clearance - 0.475 * normal[2]).abs() < 1e-12);
}
