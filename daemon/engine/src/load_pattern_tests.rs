//! Load patterns of connectors, from decks.

use crate::deck::read_text;
use crate::model::{Dialect, NodeId};
use crate::solve::columns::force_pattern;

/// A bar of length 7 from node 1 to node 2, a spring beside it and a mass of 5 at node 2.
const DECK: &str = "\
*NODE
1, 0., 0., 0.
2, 2., 3., 6.
*ELEMENT, TYPE=T3D2, ELSET=BAR
1, 1, 2
*ELEMENT, TYPE=SPRINGA, ELSET=SPRING
2, 1, 2
*ELEMENT, TYPE=MASS, ELSET=MASS
3, 2
*MATERIAL, NAME=M
*ELASTIC
200., 0.3
*DENSITY
4.
*SOLID SECTION, ELSET=BAR, MATERIAL=M
0.5
*SPRING, ELSET=SPRING

10.
*MASS, ELSET=MASS
5.
*STEP
*STATIC
*DLOAD
, GRAV, 9.81, 0., 0., -1.
*END STEP
";

#[test]
fn gravity_pulls_half_of_a_bar_to_each_end_and_all_of_a_mass() {
    let reading = read_text(DECK, Dialect::Abaqus);
    let model = reading.model.unwrap_or_else(|| panic!("{:?}", reading.diagnostics));
    let pattern = force_pattern(&model, &model.steps[0].loads[0].kind);
    // 4 · 0.5 · 7 / 2 at each end.
    assert_eq!(pattern.entries(), [(NodeId(0), 2, -7.0), (NodeId(1), 2, -7.0 - 5.0)]);
}
