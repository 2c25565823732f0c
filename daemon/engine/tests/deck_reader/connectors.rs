//! Bars, springs and point masses: elements that are not solids, and their sections.

use overclosure::deck::summary;
use overclosure::model::*;

use crate::base::*;

/// The base deck with a bar, the three springs and a mass on the corners of the cubes.
const CARDS: &str = "\
*ELEMENT, TYPE=T3D2, ELSET=BARS
21, 5, 15
*ELEMENT, TYPE=SPRINGA, ELSET=AXIAL
22, 6, 16
*ELEMENT, TYPE=SPRING1, ELSET=GROUND
23, 7
*ELEMENT, TYPE=SPRING2, ELSET=PAIRS
24, 8, 18
*ELEMENT, TYPE=MASS, ELSET=MASSES
25, 17
*SOLID SECTION, ELSET=BARS, MATERIAL=STEEL
0.5
*SPRING, ELSET=AXIAL

100.
*SPRING, ELSET=GROUND
3
200.
*SPRING, ELSET=PAIRS
1, 2
300.
*MASS, ELSET=MASSES
4.
";

/// The base deck with a piece of the cards replaced.
fn connected(from: &str, to: &str) -> String {
    assert!(CARDS.contains(from), "the cards do not contain {from:?}");
    with("*MATERIAL", &format!("{}*MATERIAL", CARDS.replacen(from, to, 1)))
}

#[test]
fn connectors_are_read_with_their_sections() {
    let (model, found) = accepted(&connected("", ""), Dialect::Abaqus);
    assert!(found.is_empty(), "{}", listing(&found));
    let mesh = &model.mesh;
    let kinds =
        [ElementKind::T3D2, ElementKind::SpringA, ElementKind::Spring1, ElementKind::Spring2, ElementKind::Mass];
    assert_eq!((2..7).map(|e| mesh.elements.kind(e)).collect::<Vec<_>>(), kinds);
    assert_eq!(mesh.elements.nodes(2), [NodeId(4), NodeId(12)]);
    assert_eq!(mesh.elements.nodes(6), [NodeId(14)]);
    let none = MaterialId::NONE;
    let steel = MaterialId(0);
    assert_eq!(mesh.element_materials, [steel, steel, steel, none, none, none, none]);
    let spring = |stiffness, directions| Connector::Spring { stiffness, directions };
    let expected = [
        Connector::Bar { area: 0.5 },
        spring(100.0, [0, 0]),
        spring(200.0, [2, 0]),
        spring(300.0, [0, 1]),
        Connector::Mass { mass: 4.0, alpha: 0.0 },
    ];
    assert_eq!((2..7).map(|e| mesh.connectors[&ElementId(e)]).collect::<Vec<_>>(), expected);
    assert_eq!(mesh.connectors.len(), 5);
    let text = summary(&model);
    assert!(text.contains("7: 2 C3D8, 1 T3D2, 1 SPRINGA, 1 SPRING1, 1 SPRING2, 1 MASS"), "{text}");
}

#[test]
fn a_spring_along_its_line_may_leave_out_the_blank_line() {
    for lines in ["\n100.\n", "100.\n", ",\n100.,\n", " , , \n 1.d2\n"] {
        let model = model(&connected("\n100.\n", lines));
        let expected = Connector::Spring { stiffness: 100.0, directions: [0, 0] };
        assert_eq!(model.mesh.connectors[&ElementId(3)], expected, "{lines:?}");
    }
    warns(&connected("100.\n", "100., , 293.\n"), "*SPRING", "temperature behind the stiffness");
}

#[test]
fn a_bar_without_an_area_has_area_one_and_a_warning() {
    for lines in ["\n", ",\n", ""] {
        let text = connected("MATERIAL=STEEL\n0.5\n", &format!("MATERIAL=STEEL\n{lines}"));
        warns(&text, "*SOLID SECTION", "gives no area: 1 is taken");
        assert_eq!(model(&text).mesh.connectors[&ElementId(2)], Connector::Bar { area: 1.0 });
    }
    let solids = with("MATERIAL=STEEL\n*SURFACE", "MATERIAL=STEEL\n,\n*SURFACE");
    assert!(read(&solids).diagnostics.is_empty(), "solids have no area");
}

#[test]
fn connectors_that_make_no_sense_are_refused() {
    let cases = [
        ("21, 5, 15\n", "21, 5, 11\n", "*ELEMENT", "element 21 has no length"),
        ("22, 6, 16\n", "22, 6, 12\n", "*ELEMENT", "element 22 has no length"),
        ("24, 8, 18\n", "24, 8, 8\n", "*ELEMENT", "element 24 uses node 8 twice"),
        ("23, 7\n", "23, 7, 8\n", "*ELEMENT", "element 23 has 2 nodes; SPRING1 has 1"),
        ("21, 5, 15\n", "21, 5\n", "*ELEMENT", "element 21 has 1 nodes; T3D2 has 2"),
        ("25, 17\n", "25, 99\n", "*ELEMENT", "element 25 uses node 99"),
        ("0.5\n", "-0.5\n", "*SOLID SECTION", "cross-section area -0.5 is not positive"),
        ("0.5\n", "0.5, 2.\n", "*SOLID SECTION", "is not read here"),
        ("\n100.\n", "3\n100.\n", "*SPRING", "SPRINGA takes 1 lines of data"),
        ("\n100.\n", "\n100.\n200.\n", "*SPRING", "SPRINGA takes 1 lines of data"),
        ("\n100.\n", "\n", "*SPRING", "a line of data of SPRINGA is missing"),
        ("\n100.\n", "\n-100.\n", "*SPRING", "stiffness -100 is negative"),
        ("3\n200.\n", "200.\n", "*SPRING", "a line of data of SPRING1 is missing"),
        ("3\n200.\n", "4\n200.\n", "*SPRING", "direction at node 1: 4 does not exist"),
        ("3\n200.\n", "3, 1\n200.\n", "*SPRING", "is not read here"),
        ("1, 2\n300.\n", "1\n300.\n", "*SPRING", "direction at node 2 is missing"),
        ("1, 2\n300.\n", "1, 0\n300.\n", "*SPRING", "direction at node 2: 0 does not exist"),
        ("1, 2\n300.\n", "1, 2\nstiff\n", "*SPRING", "stiffness: stiff is not a number"),
        ("4.\n", "-4.\n", "*MASS", "mass -4 is negative"),
        ("*MASS, ELSET=MASSES\n4.\n", "*MASS, ELSET=MASSES\n", "*MASS", "the data line is missing"),
        ("4.\n", "4.\n5.\n", "*MASS", "a second data line"),
        ("*SPRING, ELSET=GROUND", "*SPRING, ELSET=GROUND, NONLINEAR", "*SPRING", "NONLINEAR is not supported"),
        ("*SPRING, ELSET=GROUND", "*SPRING, ELSET=GROUND, ORIENTATION=O", "*SPRING", "ORIENTATION is not supported"),
        ("*SPRING, ELSET=GROUND", "*SPRING", "*SPRING", "parameter ELSET is missing"),
        ("*MASS, ELSET=MASSES", "*MASS, ELSET=MASES", "*MASS", "there is no element set MASES"),
    ];
    for (from, to, keyword, fragment) in cases {
        refuses(&connected(from, to), keyword, fragment);
    }
    let found = read(&connected("ELSET=GROUND\n3\n", "ELSET=GROUND, NONLINEAR\n3\n")).diagnostics;
    assert_eq!(found.len(), 1, "a refused spring is complained about once: {}", listing(&found));
}

#[test]
fn every_element_needs_a_section_that_its_type_takes() {
    let cases = [
        ("*SPRING, ELSET=GROUND\n3\n200.\n", "", "*ELEMENT", "1 elements have no *SPRING, the first is element 23"),
        ("*MASS, ELSET=MASSES\n4.\n", "", "*ELEMENT", "1 elements have no *MASS, the first is element 25"),
        (
            "*SOLID SECTION, ELSET=BARS, MATERIAL=STEEL\n0.5\n",
            "",
            "*ELEMENT",
            "1 elements have no section, the first is element 21",
        ),
        ("*SPRING, ELSET=GROUND", "*SPRING, ELSET=LOWER", "*SPRING", "element 1 of type C3D8 takes no *SPRING"),
        ("*SPRING, ELSET=GROUND", "*SPRING, ELSET=BARS", "*SPRING", "element 21 of type T3D2 takes no *SPRING"),
        ("*MASS, ELSET=MASSES", "*MASS, ELSET=GROUND", "*MASS", "element 23 of type SPRING1 takes no *MASS"),
        ("ELSET=BARS, MAT", "ELSET=AXIAL, MAT", "*SOLID SECTION", "element 22 of type SPRINGA takes no *SOLID SECTION"),
        (
            "*SPRING, ELSET=GROUND",
            "*ELSET, ELSET=BOTH\nGROUND, PAIRS\n*SPRING, ELSET=BOTH",
            "*SPRING",
            "the set holds SPRING1 (element 23) and SPRING2 (element 24)",
        ),
        (
            "*MASS, ELSET=MASSES\n4.\n",
            "*MASS, ELSET=MASSES\n4.\n*MASS, ELSET=MASSES\n5.\n",
            "*MASS",
            "element 25 has a section with other values already",
        ),
    ];
    for (from, to, keyword, fragment) in cases {
        refuses(&connected(from, to), keyword, fragment);
    }
    let bare = CARDS.split("*SOLID SECTION").next().expect("elements");
    let found = read(&with("*MATERIAL", &format!("{bare}*MATERIAL"))).diagnostics;
    assert_eq!(found.len(), 3, "one finding per kind of section: {}", listing(&found));
}

#[test]
fn connectors_have_no_faces() {
    let cases = [
        ("UPPER, S1", "UPPER, S1\n21, S1", "*SURFACE", "element 21 of type T3D2 has no faces"),
        ("UPPER, S1", "UPPER, S1\nAXIAL", "*SURFACE", "element 22 of type SPRINGA has no faces"),
        ("UPPER, S1", "UPPER, S1\n25", "*SURFACE", "element 25 of type MASS has no faces"),
        ("*NODE PRINT", "*DLOAD\nPAIRS, P1, 1.\n*NODE PRINT", "*DLOAD", "element 24 of type SPRING2 has no faces"),
    ];
    for (from, to, keyword, fragment) in cases {
        refuses(&connected("", "").replacen(from, to, 1), keyword, fragment);
    }
}

#[test]
fn gravity_asks_bars_for_a_density_and_masses_for_none() {
    let loaded = |set: &str, from: &str| {
        let load = format!("*DLOAD\n{set}, GRAV, 10., 0., 0., -1.\n*NODE PRINT");
        connected("", "").replacen("*NODE PRINT", &load, 1).replacen(from, "", 1)
    };
    assert!(read(&loaded("MASSES", "*DENSITY\n7.8e-9\n")).diagnostics.is_empty());
    assert!(read(&loaded("BARS", "")).diagnostics.is_empty());
    refuses(&loaded("BARS", "*DENSITY\n7.8e-9\n"), "*DLOAD", "material STEEL, which has no density");
    refuses(&loaded("", "*DENSITY\n7.8e-9\n"), "*DLOAD", "material STEEL, which has no density");
    warns(&loaded("AXIAL", ""), "*DLOAD", "springs and dashpots have no mass");
}

/// The base deck as an implicit dynamic one with dashpots, a mass and rotary inertia.
const DYNAMIC: &str = "\
*ELEMENT, TYPE=DASHPOTA, ELSET=AXIAL
31, 5, 15
*ELEMENT, TYPE=DASHPOT1, ELSET=GROUND
32, 7
*ELEMENT, TYPE=DASHPOT2, ELSET=PAIRS
33, 8, 18
*ELEMENT, TYPE=MASS, ELSET=MASSES
34, 17
*ELEMENT, TYPE=ROTARYI, ELSET=WHEEL
35, 17
*DASHPOT, ELSET=AXIAL

100.
*DASHPOT, ELSET=GROUND
3
200.
*DASHPOT, ELSET=PAIRS
1, 2
300.
*MASS, ELSET=MASSES, ALPHA=0.5
4.
*ROTARY INERTIA, ELSET=WHEEL, ALPHA=0.25
3., 2., 1., 0.1, 0.2, -0.3
";

fn moving(from: &str, to: &str) -> String {
    assert!(DYNAMIC.contains(from), "the cards do not contain {from:?}");
    let text = with("*MATERIAL", &format!("{}*MATERIAL", DYNAMIC.replacen(from, to, 1)));
    let text = text.replace("*STATIC\n", "*DYNAMIC\n").replace("*BOUNDARY\nTOP, 3", "*BOUNDARY, TYPE=VELOCITY\nTOP, 3");
    text.replace("PRESSURE-OVERCLOSURE=LINEAR\n1e6\n", "\n")
}

#[test]
fn dashpots_and_inertia_are_read_with_their_sections() {
    let (model, found) = accepted(&moving("", ""), Dialect::Abaqus);
    assert!(found.is_empty(), "{}", listing(&found));
    let mesh = &model.mesh;
    let dashpot = |coefficient, directions| Connector::Dashpot { coefficient, directions };
    let expected = [
        dashpot(100.0, [0, 0]),
        dashpot(200.0, [2, 0]),
        dashpot(300.0, [0, 1]),
        Connector::Mass { mass: 4.0, alpha: 0.5 },
        Connector::RotaryInertia { inertia: [3.0, 2.0, 1.0, 0.1, 0.2, -0.3], alpha: 0.25 },
    ];
    assert_eq!((2..7).map(|e| mesh.connectors[&ElementId(e)]).collect::<Vec<_>>(), expected);
    // Node 17 is the 15th; its rotations are the displacements of a node behind the 16 of the deck.
    assert_eq!((mesh.node_count(), mesh.hidden_nodes), (16, 1));
    assert_eq!(mesh.rotations, [(NodeId(14), NodeId(16))]);
    assert_eq!(mesh.elements.nodes(6), [NodeId(16)]);
    assert_eq!(mesh.node_labels[16], 17);
}

#[test]
fn rotary_inertia_of_a_rigid_body_turns_with_its_reference_node() {
    let rigid = moving("35, 17", "35, 15")
        .replace("*STEP\n", "*RIGID BODY, ELSET=UPPER, REF NODE=15\n*STEP\n")
        .replace("TOP, 1, 2\n", "15, 1, 2\n")
        .replace("TOP, 3, 3", "15, 3, 3");
    let mesh = model(&rigid).mesh;
    assert_eq!((mesh.hidden_nodes, mesh.rotations.as_slice()), (1, [(NodeId(12), NodeId(16))].as_slice()));
    assert_eq!(mesh.elements.nodes(6), [NodeId(16)]);
    refuses(&rigid.replace("35, 15", "35, 17"), "*ELEMENT", "follows the reference node of a rigid body");
    // Rotations of such a node are prescribed, loaded and thrown like those of a reference node.
    let turned = moving("", "")
        .replace("*BOUNDARY, TYPE=VELOCITY\n", "*BOUNDARY, TYPE=VELOCITY\n17, 4, 4, 2.\n")
        .replace("*NODE PRINT", "*CLOAD\n17, 5, 3.\n*NODE PRINT")
        .replace("*STEP\n", "*INITIAL CONDITIONS, TYPE=VELOCITY\n17, 6, 7.\n*STEP\n");
    let model = model(&turned);
    assert_eq!(
        (model.steps[0].boundaries[0].nodes.as_slice(), model.steps[0].boundaries[0].direction),
        ([NodeId(16)].as_slice(), 0)
    );
    let LoadKind::Concentrated { nodes, direction } = &model.steps[0].loads[0].kind else { panic!("a force") };
    assert_eq!((nodes.as_slice(), *direction), ([NodeId(16)].as_slice(), 1));
    assert_eq!(model.initial_velocities, [InitialVelocity { node: NodeId(16), direction: 2, value: 7.0 }]);
}

#[test]
fn dashpots_and_inertia_are_checked() {
    let cases = [
        ("\n100.\n", "\n-100.\n", "*DASHPOT", "damping coefficient -100 is negative"),
        ("3\n200.\n", "4\n200.\n", "*DASHPOT", "direction at node 1: 4 does not exist"),
        ("3\n200.\n", "200.\n", "*DASHPOT", "a line of data of DASHPOT1 is missing"),
        ("1, 2\n300.\n", "1, 2\n300.\n400.\n", "*DASHPOT", "DASHPOT2 takes 2 lines of data"),
        ("*DASHPOT, ELSET=AXIAL", "*DASHPOT, NONLINEAR, ELSET=AXIAL", "*DASHPOT", "NONLINEAR is not supported"),
        ("*DASHPOT, ELSET=AXIAL", "*DASHPOT, ELSET=MASSES", "*DASHPOT", "takes no *DASHPOT"),
        ("*DASHPOT, ELSET=GROUND\n3\n200.\n", "", "*ELEMENT", "1 elements have no *DASHPOT, the first is element 32"),
        ("31, 5, 15", "31, 5, 11", "*ELEMENT", "has no length"),
        ("ALPHA=0.5", "ALPHA=-0.5", "*MASS", "ALPHA=-0.5 is not a number from 0 on"),
        ("3., 2., 1., 0.1, 0.2, -0.3", "0., 0., 0.", "*ROTARY INERTIA", "the moments of inertia are zero"),
        ("3., 2., 1., 0.1, 0.2, -0.3", "1., 1., 1., 2.", "*ROTARY INERTIA", "no body has the moments of inertia"),
        ("3., 2., 1., 0.1, 0.2, -0.3", "-1., 1., 1.", "*ROTARY INERTIA", "no body has the moments of inertia"),
    ];
    for (from, to, keyword, fragment) in cases {
        refuses(&moving(from, to), keyword, fragment);
    }
    let statics = moving("", "").replace("*DYNAMIC\n", "*STATIC\n").replace("TYPE=VELOCITY", "TYPE=DISPLACEMENT");
    refuses(&statics, "*DASHPOT", "dashpots act in dynamic steps, and the deck has none");
    let both = format!("{}*STEP\n*STATIC\n1., 1.\n*END STEP\n", moving("", ""));
    warns(&both, "*DASHPOT", "dashpots have no force in the static steps of the deck");
}
