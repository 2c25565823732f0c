//! For each rule a deck that uses it and a deck that breaks it.

use overclosure::deck::{differences, keywords, summary};
use overclosure::diagnostic::Severity;
use overclosure::law::{NormalBehavior, PressureOverclosure};
use overclosure::model::*;

use crate::base::*;

#[test]
fn the_base_deck_is_read_without_findings() {
    let (model, found) = accepted(BASE, Dialect::Abaqus);
    assert!(found.is_empty(), "{}", listing(&found));
    assert_eq!(model.heading, "two cubes");
    assert_eq!(model.mesh.nodes.len(), 16);
    assert_eq!(model.mesh.node_of_label[&11], NodeId(8));
    assert_eq!(model.mesh.elements.nodes(1).iter().map(|n| n.0).collect::<Vec<_>>(), [8, 9, 10, 11, 12, 13, 14, 15]);
    assert_eq!(model.mesh.elements.kind(0), ElementKind::C3D8);
    assert_eq!(model.mesh.node_sets.iter().map(|s| s.name.as_str()).collect::<Vec<_>>(), ["NALL", "BOTTOM", "TOP"]);
    assert_eq!(model.mesh.element_sets[2].elements, [ElementId(0), ElementId(1)]);
    let upper = ElementFace { element: ElementId(1), face: 0 };
    assert_eq!(model.mesh.surfaces[0].kind, SurfaceKind::Faces(vec![upper]));
    assert_eq!(model.materials[0].density, Some(7.8e-9));
    assert_eq!(model.pairs[0].name, "SECOND_FIRST");
    assert_eq!(model.pairs[0].place.line, 44);
    assert_eq!(model.initial_boundaries.len(), 5);
    let step = &model.steps[0];
    assert_eq!((step.name.as_str(), step.increments_max), ("Step-1", 100));
    let control = step.procedure.implicit_increments().unwrap();
    assert_eq!(
        (control.increment_initial, control.period, control.increment_max, control.direct),
        (0.1, 1.0, 1.0, false)
    );
    assert_eq!(control.increment_min, 1e-5);
    let line = &step.boundaries[0];
    assert_eq!((line.region_name.as_str(), line.direction, line.magnitude, line.place.line), ("TOP", 2, -0.01, 52));
    assert_eq!(step.output.nodes[0].totals, Totals::Only);
    assert_eq!(step.output.contacts[0].variables, ["CPRESS", "CSHEAR1", "CSHEAR2", "COPEN", "CSLIP1", "CSLIP2"]);
    assert!(summary(&model).contains("SECOND_FIRST: secondary 1 faces with 4 nodes"), "{}", summary(&model));
}

#[test]
fn spelling_is_free() {
    let spellings = [
        ("*NODE, NSET=NALL", "** comment\n  *node ,  nset = nall"),
        ("*SURFACE BEHAVIOR", "*SurfaceBehavior"),
        ("INTERACTION=SI, SMALL SLIDING", "inter=si, SmallSliding"),
        ("1, 2, 3, 4\n*NSET", "1,2,3,4,\n\n*NSET"),
        ("1, 1, 2, 3, 4, 5, 6, 7, 8", "1, 1, 2, 3,\n4, 5, 6, 7, 8"),
        ("210000., 0.3", " 2.1D5 ,\t3.e-1 , "),
        ("*ELEMENT, TYPE=C3D8, ELSET=LOWER", "*ELEMENT, TYPE=C3D8,\n** in between\nELSET=LOWER"),
        ("MATERIAL=STEEL", "MATERIAL=\"steel\""),
        ("BOTTOM, 1, 3", "\"bottom\", 1, 3"),
        ("TOP, 1, 2", "top, 1, 2, ,"),
        ("0.1, 1.", "1d-1, 1."),
    ];
    for (from, to) in spellings {
        let (_, found) = accepted(&with(from, to), Dialect::Abaqus);
        assert!(found.is_empty(), "{to:?}: {}", listing(&found));
    }
    let all = spellings.iter().fold(BASE.to_string(), |text, (from, to)| text.replacen(from, to, 1));
    let (model, _) = accepted(&all.replace('\n', "\r\n"), Dialect::Abaqus);
    assert_eq!((model.mesh.nodes.len(), model.materials[0].youngs_modulus), (16, 2.1e5));
    warns(&with("*BOUNDARY\nBOTTOM", "*BOUND\nBOTTOM"), "*BOUNDARY", "*BOUND is read as *BOUNDARY");
}

#[test]
fn sets_hold_numbers_ranges_and_other_sets_in_any_order() {
    let text = with(
        "*NSET, NSET=BOTTOM\n1, 2, 3, 4\n",
        "*NSET, NSET=BOTTOM\nPART, 3\nPART\n*NSET, NSET=PART, GENERATE\n1, 2\n4, 4, 1\n*NSET, NSET=CORNERS, ELSET=LOWER\n",
    );
    let model = model(&text);
    let members = |name: &str| {
        let set = model.mesh.node_sets.iter().find(|set| set.name == name).expect(name);
        set.nodes.iter().map(|node| model.mesh.node_labels[node.index()]).collect::<Vec<_>>()
    };
    assert_eq!(members("BOTTOM"), [1, 2, 3, 4]);
    assert_eq!(members("PART"), [1, 2, 4]);
    assert_eq!(members("CORNERS"), [1, 2, 3, 4, 5, 6, 7, 8]);
    warns(
        &with("1, 2, 3, 4\n*NSET", "1, 2, 3, 4\n*NSET, NSET=R, GENERATE\n1, 4000000000\n*NSET"),
        "*NSET",
        "are not defined",
    );
    refuses(&with("1, 2, 3, 4\n*NSET", "1, 2, 3, 99\n*NSET"), "*NSET", "node 99 is not defined");
    refuses(&with("1, 2, 3, 4\n*NSET", "1, 2, 3, BOTOM\n*NSET"), "*NSET", "no node set BOTOM");
    refuses(&with("LOWER, UPPER\n", "LOWER, UPPER, X\n*ELSET, ELSET=X\nALL\n"), "*ELSET", "contains itself");
    refuses(&with("1, 2, 3, 4\n*NSET", "1, 2, 3, -4\n*NSET"), "*NSET", "-4 is not a whole number");
    refuses(
        &with("*NSET, NSET=BOTTOM\n1, 2, 3, 4", "*NSET, NSET=BOTTOM, GENERATE\n4, 1"),
        "*NSET",
        "ends before it begins",
    );
}

#[test]
fn surfaces_are_faces_free_faces_or_nodes() {
    let faces = |text: &str| {
        let model = model(text);
        match &model.mesh.surfaces[0].kind {
            SurfaceKind::Faces(faces) => faces.iter().map(|face| (face.element.0, face.face + 1)).collect::<Vec<_>>(),
            _ => Vec::new(),
        }
    };
    assert_eq!(faces(&with("UPPER, S1", "2, s1\nUPPER, S1")), [(1, 1)]);
    assert_eq!(faces(&with("UPPER, S1", "UPPER")), (1..=6).map(|face| (1, face)).collect::<Vec<_>>());
    // Stacked on the lower cube by shared nodes, the cube between shows four faces only.
    let text = with("*SURFACE, NAME=FIRST", "*SURFACE, NAME=SKIN\nLOWER\n*SURFACE, NAME=FIRST")
        .replace("*NSET, NSET=BOTTOM", "21, 0., 0., -1.\n*NSET, NSET=BOTTOM")
        .replace(
            "18, 0., 1., 2.\n",
            "18, 0., 1., 2.\n21, 0., 0., -1.\n22, 1., 0., -1.\n23, 1., 1., -1.\n24, 0., 1., -1.\n",
        )
        .replace("8\n*ELEMENT", "8\n3, 21, 22, 23, 24, 1, 2, 3, 4\n*ELEMENT")
        .replace("21, 0., 0., -1.\n*NSET", "*NSET");
    let skin = model(&text).mesh.surfaces.into_iter().find(|surface| surface.name == "SKIN").expect("SKIN");
    let SurfaceKind::Faces(skin) = skin.kind else { panic!("nodes") };
    assert_eq!(skin.len(), 10);

    let nodes = with(
        "*SURFACE, NAME=SECOND\nUPPER, S1",
        "*SURFACE, NAME=SECOND, TYPE=NODE\n11\nCONTACT\n*NSET, NSET=CONTACT\n12, 13, 14",
    );
    assert_eq!(model(&nodes).mesh.surfaces[0].kind, SurfaceKind::Nodes((8..12).map(NodeId).collect()));
    refuses(&with("UPPER, S1", "UPPER, S7"), "*SURFACE", "a face S7");
    refuses(&with("UPPER, S1", "UPER, S1"), "*SURFACE", "no element set UPER");
    refuses(&with("UPPER, S1", "3, S1"), "*SURFACE", "element 3 is not defined");
    refuses(&with("UPPER, S1\n", ""), "*SURFACE", "surface SECOND is empty");
    refuses(&with("NAME=FIRST", "NAME=SECOND"), "*SURFACE", "defined twice");
    refuses(&with("NAME=SECOND\nUPPER, S1", "NAME=SECOND, TYPE=NODE\n11, 0.5"), "*SURFACE", "area per node");
    refuses(&with("NAME=SECOND", "NAME=SECOND, TYPE=SEGMENTS"), "*SURFACE", "TYPE=SEGMENTS is not supported");
}

#[test]
fn nodes_and_elements_are_checked() {
    warns(&with("2, 1., 0., 0.\n", "2, 1., 0., 0.\n2, 1., 0., 0.\n"), "*NODE", "node 2 is given twice, with the same");
    warns(&with("18, 0., 1., 2.\n", "18, 0., 1., 2.\n99, 5.\n"), "*NODE", "1 nodes belong to no element");
    warns(&with("2, 1., 0., 0.", "2, 1., 0., 0., 7."), "*NODE", "ignored");
    let cases = [
        ("2, 1., 0., 0.\n", "2, 1., 0., 0.\n2, 1., 0., 0.1\n", "*NODE", "node 2 is given twice, first at (1, 0, 0)"),
        ("2, 1., 0., 0.", "2, 1., x, 0.", "*NODE", "coordinate 2: x is not a number"),
        ("2, 1., 0., 0.", "2, 1., NaN, 0.", "*NODE", "NaN is not a finite number"),
        ("2, 1., 0., 0.", "2, 1., 1e400, 0.", "*NODE", "1e400 is not a finite number"),
        ("2, 1., 0., 0.", "2, 1., 1e300, 0.", "*NODE", "out of any sensible range"),
        ("2, 1., 0., 0.", "2", "*NODE", "no coordinates"),
        ("2, 1., 0., 0.", "0, 1., 0., 0.", "*NODE", "node number"),
        ("*NODE, NSET=NALL", "*NODE, NSET=NALL, SYSTEM=C", "*NODE", "SYSTEM=C is not supported"),
        ("1, 1, 2, 3, 4, 5, 6, 7, 8", "1, 1, 2, 3, 4, 5, 6, 7, 80", "*ELEMENT", "uses node 80, which is not defined"),
        ("1, 1, 2, 3, 4, 5, 6, 7, 8", "1, 1, 2, 3, 4, 5, 6, 7, 7", "*ELEMENT", "element 1 uses node 7 twice"),
        ("1, 1, 2, 3, 4, 5, 6, 7, 8", "1, 5, 6, 7, 8, 1, 2, 3, 4", "*ELEMENT", "element 1 is inverted"),
        ("1, 1, 2, 3, 4, 5, 6, 7, 8", "1, 1, 2, 3, 4, 5, 6, 7", "*ELEMENT", "element 1 has 7 nodes"),
        ("1, 1, 2, 3, 4, 5, 6, 7, 8", "1, 1, 2, 3, 4, 5, 6, 7, 8, 9", "*ELEMENT", "element 1 has 9 nodes"),
        (
            "1, 1, 2, 3, 4, 5, 6, 7, 8\n",
            "1, 1, 2, 3, 4, 5, 6, 7, 8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n",
            "*ELEMENT",
            "given twice",
        ),
        ("TYPE=C3D8, ELSET=LOWER", "TYPE=C3D27, ELSET=LOWER", "*ELEMENT", "element type C3D27 is not supported"),
        ("TYPE=C3D8, ELSET=LOWER", "ELSET=LOWER", "*ELEMENT", "parameter TYPE is missing"),
        (
            "ELSET=ALL, MATERIAL",
            "ELSET=LOWER, MATERIAL",
            "*ELEMENT",
            "1 elements have no section, the first is element 2",
        ),
    ];
    for (from, to, keyword, fragment) in cases {
        refuses(&with(from, to), keyword, fragment);
    }
}

#[test]
fn a_refused_block_is_complained_about_once() {
    for (from, to) in [
        ("TYPE=C3D8, ELSET=LOWER", "TYPE=C3D8H, ELSET=LOWER"),
        ("2, 1., 0., 0.", "2, 1., x, 0."),
        ("UPPER, S1", "UPPER, SPOS"),
        ("210000., 0.3", "210000., 0.5"),
        ("*ELASTIC\n210000., 0.3", "*HYPERELASTIC\n1., 2."),
    ] {
        let reading = read(&with(from, to));
        assert_eq!(reading.diagnostics.len(), 1, "{to}: {}", listing(&reading.diagnostics));
    }
}

#[test]
fn materials_and_sections_are_checked() {
    let cases = [
        ("210000., 0.3", "-1., 0.3", "*ELASTIC", "modulus -1 is not positive"),
        ("210000., 0.3", "210000., 0.5", "*ELASTIC", "ratio 0.5 is not between"),
        ("210000., 0.3", "210000., -1.", "*ELASTIC", "ratio -1 is not between"),
        ("210000., 0.3", "210000.", "*ELASTIC", "Poisson's ratio is missing"),
        ("210000., 0.3", "210000., 0.3, 20.\n200000., 0.3, 100.", "*ELASTIC", "second data line"),
        ("*ELASTIC\n210000., 0.3\n", "", "*MATERIAL", "has no *ELASTIC"),
        ("*ELASTIC\n", "*ELASTIC, TYPE=ORTHOTROPIC\n", "*ELASTIC", "TYPE=ORTHOTROPIC is not supported"),
        ("7.8e-9", "0.", "*DENSITY", "density 0 is not positive"),
        ("MATERIAL=STEEL", "MATERIAL=STEAL", "*SOLID SECTION", "no material STEAL"),
        ("ELSET=ALL, MATERIAL", "ELSET=EVERY, MATERIAL", "*SOLID SECTION", "no element set EVERY"),
        (", MATERIAL=STEEL", "", "*SOLID SECTION", "parameter MATERIAL is missing"),
        ("*MATERIAL, NAME=STEEL\n", "", "*ELASTIC", "no material is being defined"),
        (
            "*DENSITY\n7.8e-9",
            "*MATERIAL, NAME=B\n*ELASTIC\n1., 0.\n*SOLID SECTION, ELSET=UPPER, MATERIAL=B",
            "*SOLID SECTION",
            "of material B already",
        ),
    ];
    for (from, to, keyword, fragment) in cases {
        refuses(&with(from, to), keyword, fragment);
    }
    warns(
        &with("*DENSITY", "*MATERIAL, NAME=SPARE\n*ELASTIC\n1., 0.\n*DENSITY"),
        "*MATERIAL",
        "material SPARE is not used",
    );
    warns(&with("*DENSITY", "*EXPANSION\n1e-5\n*DENSITY"), "*EXPANSION", "ignored");
    warns(
        &with("ELSET=ALL, MATERIAL", "ELSET=ALL, ORIENTATION=O, MATERIAL"),
        "*SOLID SECTION",
        "ORIENTATION is ignored",
    );
}

#[test]
fn laws_are_read() {
    let normal =
        |from: &str, to: &str, dialect: Dialect| accepted(&with(from, to), dialect).0.interactions.remove(0).normal;
    let behavior = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e6\n";
    let abaqus = Dialect::Abaqus;
    assert_eq!(normal(behavior, "", abaqus), NormalBehavior::Hard);
    assert_eq!(normal(behavior, "*SURFACE BEHAVIOR\n", abaqus), NormalBehavior::Hard);
    assert_eq!(
        normal(behavior, "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD, DIRECT\n", abaqus),
        NormalBehavior::Hard
    );
    let NormalBehavior::Softened(PressureOverclosure::Linear(linear)) = normal("1e6", "1e6", abaqus) else {
        panic!("not linear")
    };
    assert_eq!(linear.stiffness(), 1e6);
    let tabular = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR\n0., -0.02\n3., 0.\n12., 0.03\n";
    let NormalBehavior::Softened(PressureOverclosure::Tabular(law)) = normal(behavior, tabular, abaqus) else {
        panic!("not tabular")
    };
    assert_eq!(law.points(), [(0.0, -0.02), (3.0, 0.0), (12.0, 0.03)]);
    let exponential = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=EXPONENTIAL\n0.01, 5.\n";
    let NormalBehavior::Softened(PressureOverclosure::Exponential(law)) = normal(behavior, exponential, abaqus) else {
        panic!("not exponential")
    };
    assert_eq!((law.clearance_at_zero_pressure(), law.pressure_at_zero_clearance()), (0.01, 5.0));
    let law = normal(behavior, exponential, Dialect::Calculix);
    let NormalBehavior::Softened(PressureOverclosure::CalculixExponential(law)) = law else { panic!("not CalculiX's") };
    assert_eq!((law.clearance(), law.pressure()), (0.01, 5.0));
    assert_eq!(model(&with("NAME=SI\n", "NAME=SI\n0.25\n")).interactions[0].node_area, Some(0.25));
    assert!(accepted(&with("1e6\n", "1e6\n*FRICTION\n0.,\n"), abaqus).1.is_empty());
}

#[test]
fn laws_that_are_wrong_or_not_solved_are_refused() {
    let behavior = "PRESSURE-OVERCLOSURE=LINEAR\n1e6\n";
    let cases = [
        ("PRESSURE-OVERCLOSURE=LINEAR\n0.\n", "must be a positive finite number"),
        ("PRESSURE-OVERCLOSURE=LINEAR\n", "data line is missing"),
        ("PRESSURE-OVERCLOSURE=LINEAR\n1e6, 1., 1e-3\n", "more than one item"),
        ("PRESSURE-OVERCLOSURE=TABULAR\n0., 0.\n", "at least two points"),
        ("PRESSURE-OVERCLOSURE=TABULAR\n0., 0.\n1., 0.1\n1., 0.2\n", "does not exceed"),
        ("PRESSURE-OVERCLOSURE=TABULAR\n1., 0.\n2., 0.1\n", "first pressure of a table must be zero"),
        ("PRESSURE-OVERCLOSURE=TABULAR\n0., 0., 20.\n2., 0.1, 20.\n", "item 3 is not read"),
        ("PRESSURE-OVERCLOSURE=EXPONENTIAL\n0., 5.\n", "must be a positive finite number"),
        ("PRESSURE-OVERCLOSURE=EXPONENTIAL\n0.01, -5.\n", "must be a positive finite number"),
        ("PRESSURE-OVERCLOSURE=EXPONENTIAL\n0.01\n", "pressure p0 is missing"),
        (
            "PRESSURE-OVERCLOSURE=EXPONENTIAL, NO SEPARATION\n0.01, 5.\n",
            "exponential law cannot be combined with NO SEPARATION",
        ),
        (
            "PRESSURE-OVERCLOSURE=LINEAR, AUGMENTED LAGRANGE\n1.\n",
            "linear law cannot be combined with AUGMENTED LAGRANGE",
        ),
        ("PRESSURE-OVERCLOSURE=TIED\n1e6\n", "TIED is not supported"),
        ("PRESSURE-OVERCLOSURE=CUBIC\n1e6\n", "PRESSURE-OVERCLOSURE=CUBIC is not known"),
        ("PRESSURE-OVERCLOSURE=HARD\n1e6\n", "hard contact takes no data line"),
        ("PRESSURE-OVERCLOSURE=LINEAR\n1e6\n*SURFACE BEHAVIOR\n", "has a *SURFACE BEHAVIOR already"),
    ];
    for (to, fragment) in cases {
        refuses(&with(behavior, to), "*SURFACE BEHAVIOR", fragment);
    }
    refuses(&with("1e6\n", "1e6\n*FRICTION\n0.1\n"), "*FRICTION", "friction coefficient 0.1");
    refuses(&with("NAME=SI\n", "NAME=SI\n-1.\n"), "*SURFACE INTERACTION", "area per node -1 is not positive");
    refuses(
        &with("*STEP\n", "*CONTACT CONTROLS, ABSOLUTE PENETRATION TOLERANCE=1.\n*STEP\n"),
        "*CONTACT CONTROLS",
        "outside a step",
    );
}

#[test]
fn contact_pairs_are_checked() {
    warns(&with(", SMALL SLIDING", ""), "*CONTACT PAIR", "finite sliding is solved as small sliding");
    assert!(read(&with(", SMALL SLIDING", ", SMALL SLIDING, TYPE=NODE TO SURFACE")).diagnostics.is_empty());
    let cases = [
        (", SMALL SLIDING", ", TYPE=MORTAR", "TYPE=MORTAR is not supported"),
        (", SMALL SLIDING", ", TIED", "TIED is not supported"),
        (", SMALL SLIDING", ", WEIGHT=0.1", "WEIGHT belongs to pairs of explicit analyses"),
        ("INTERACTION=SI,", "INTERACTION=S1,", "no surface interaction S1"),
        ("INTERACTION=SI, ", "", "parameter INTERACTION is missing"),
        ("SECOND, FIRST", "SECOND, THIRD", "no surface THIRD"),
        ("SECOND, FIRST", "SECOND, SECOND", "secondary and primary of the same pair"),
        ("SECOND, FIRST", "SECOND", "the primary surface is missing"),
        ("SECOND, FIRST\n", "", "the data line is missing"),
        ("SECOND, FIRST\n", "SECOND, FIRST\nSECOND, FIRST\n", "given twice"),
    ];
    for (from, to, fragment) in cases {
        refuses(&with(from, to), "*CONTACT PAIR", fragment);
    }
    let nodes = with("NAME=FIRST\nLOWER, S2", "NAME=FIRST, TYPE=NODE\n5, \n6\n7\n8");
    refuses(&nodes, "*CONTACT PAIR", "the primary surface FIRST is made of nodes");
    refuses(
        &with("UPPER, S1", "UPPER, S1\nLOWER, S3"),
        "*CONTACT PAIR",
        "2 nodes stand on both surfaces of the pair, the first is node 5",
    );
}

#[test]
fn the_extension_zone_is_a_part_of_a_face() {
    let zone = |value: &str| with("*CONTACT PAIR, ", &format!("*CONTACT PAIR, EXTENSION ZONE={value}, "));
    assert_eq!(model(BASE).pairs[0].surfaces().expect("surfaces").extension_zone, 0.1);
    assert_eq!(model(&zone("0.2")).pairs[0].surfaces().expect("surfaces").extension_zone, 0.2);
    for wrong in ["0.3", "-0.1", "wide", "nan"] {
        refuses(&zone(wrong), "*CONTACT PAIR", "EXTENSION ZONE");
    }
}

#[test]
fn boundaries_are_checked() {
    for named in ["ENCASTRE", "PINNED"] {
        let model = model(&with("BOTTOM, 1, 3", &format!("BOTTOM, {named}")));
        assert_eq!(
            model.initial_boundaries.iter().map(|b| b.direction).collect::<Vec<_>>(),
            [0, 1, 2, 0, 1],
            "{named}"
        );
    }
    assert_eq!(model(&with("BOTTOM, 1, 3", "BOTTOM, 3\nBOTTOM, XSYMM\nBOTTOM, YSYMM")).initial_boundaries.len(), 5);
    assert_eq!(model(&with("TOP, 3, 3, -0.01", "15, 3, , -0.01")).steps[0].boundaries[0].region, Region::Label(15));
    let single =
        model(&with("BOTTOM, 1, 3\n", "4, 1, 3\n3, 1, 3\nBOTTOM, 1\n2, 1, 3\n2, 1, 3\n1, 1, 3\n")).initial_boundaries;
    let nodes: Vec<_> = single.iter().map(|b| (b.direction, b.nodes.iter().map(|n| n.0).collect::<Vec<_>>())).collect();
    let bottom = vec![0, 1, 2, 3];
    let expected = [(0, &bottom), (1, &bottom), (2, &bottom), (0, &bottom)].map(|(d, nodes)| (d, nodes.clone()));
    assert_eq!(nodes[..4], expected, "lines of single nodes are joined per direction");
    warns(&with("BOTTOM, 1, 3", "BOTTOM, 1, 6"), "*BOUNDARY", "degrees of freedom 4 to 6 are ignored");
    warns(&with("-0.01\n", "-0.01\n15, 3, 3, 0.\n"), "*BOUNDARY", "this line counts");
    let overridden = model(&with("-0.01\n", "-0.01\n15, 3, 3, 0.\n"));
    assert_eq!(overridden.steps[0].boundaries.iter().map(|b| b.nodes.len()).collect::<Vec<_>>(), [3, 1]);
    let cases = [
        ("BOTTOM, 1, 3", "BOTTOM, 1, 3, 0.1", "value 0.1 before the first step"),
        ("BOTTOM, 1, 3", "BOTTOM, 11, 11", "degrees of freedom 11 to 11 do not exist"),
        ("BOTTOM, 1, 3", "BOTTOM, 3, 1", "degrees of freedom 3 to 1 do not exist"),
        ("BOTTOM, 1, 3", "BOTTOM", "first degree of freedom is missing"),
        ("BOTTOM, 1, 3", "BOTTOM, CLAMPED", "no boundary type CLAMPED"),
        ("BOTTOM, 1, 3", "BUTTON, 1, 3", "no node set BUTTON"),
        ("BOTTOM, 1, 3", "77, 1, 3", "node 77 is not defined"),
        ("BOTTOM, 1, 3", ", 1, 3", "node set is missing"),
        ("TOP, 3, 3, -0.01", "TOP, 3, 3, nan", "nan is not a finite number"),
        ("TOP, 3, 3, -0.01", "TOP, 3, 3, -0.01\n15, 3, 3, -0.02", "prescribed as -0.01 and as -0.02 in one step"),
        ("*BOUNDARY\nTOP, 3", "*BOUNDARY, AMPLITUDE=A\nTOP, 3", "no amplitude A"),
        ("*BOUNDARY\nTOP, 3", "*BOUNDARY, OP=NEW\nTOP, 3", "OP=NEW would free degree of freedom 1 of node 1"),
        ("*BOUNDARY\nTOP, 3", "*BOUNDARY, FIXED\nTOP, 3", "FIXED is not supported"),
        ("*BOUNDARY\nTOP, 3", "*BOUNDARY, TYPE=VELOCITY\nTOP, 3", "TYPE=VELOCITY in a static step"),
    ];
    for (from, to, fragment) in cases {
        refuses(&with(from, to), "*BOUNDARY", fragment);
    }
    let all = with("*BOUNDARY\nTOP, 3", "*BOUNDARY, OP=NEW\nBOTTOM, 1, 3\nTOP, 1, 2\nTOP, 3");
    assert_eq!(model(&all).steps[0].boundaries.len(), 6);
}

#[test]
fn steps_may_change_values_but_not_what_is_prescribed() {
    let second = |lines: &str| format!("{BASE}*STEP, NAME=Back, INC=7\n*STATIC\n{lines}*END STEP\n");
    let model = model(&second("*BOUNDARY, OP=MOD\nTOP, 3, 3, 0.\n"));
    assert_eq!((model.steps[1].name.as_str(), model.steps[1].increments_max), ("Back", 7));
    assert_eq!(model.steps[1].output, model.steps[0].output, "requests hold on");
    refuses(
        &second("*BOUNDARY\n5, 3, 3, 0.\n"),
        "*BOUNDARY",
        "degree of freedom 3 of node 5 is prescribed here for the first time",
    );
    refuses(&second("*BOUNDARY, OP=NEW\nBOTTOM, 1, 3\n"), "*BOUNDARY", "would free degree of freedom 1 of node 15");
    let replaced = accepted(&second("*NODE PRINT\nU\n"), Dialect::Abaqus).0;
    assert_eq!(replaced.steps[1].output.nodes.len(), 1);
    assert_eq!(replaced.steps[1].output.nodes[0].variables, ["U"]);
    assert_eq!(replaced.steps[1].output.contacts.len(), 1);
}

#[test]
fn loads_are_read_and_checked() {
    let add = |cards: &str| with("*NODE PRINT", &format!("{cards}*NODE PRINT"));
    let loads =
        add("*CLOAD\n5, 1, 2.5\n*DLOAD\nUPPER, P2, 3.\nLOWER, GRAV, 9.81, 0., 0., -2.\n*DSLOAD\nSECOND, P, 4.\n");
    let steps = model(&loads).steps;
    let kinds: Vec<_> = steps[0].loads.iter().map(|load| (load.region_name.as_str(), load.magnitude)).collect();
    assert_eq!(kinds, [("5", 2.5), ("UPPER", 3.0), ("LOWER", 9.81), ("SECOND", 4.0)]);
    assert_eq!(steps[0].loads[0].kind, LoadKind::Concentrated { nodes: vec![NodeId(4)], direction: 0 });
    assert_eq!(steps[0].loads[2].kind, LoadKind::Gravity { elements: vec![ElementId(0)], direction: [0.0, 0.0, -1.0] });
    assert_eq!(steps[0].loads[3].region, Region::Surface(SurfaceId(0)));
    let calculix = accepted(&add("*DLOAD\nLOWER, GRAV, 9.81, 0., 0., -2.\n"), Dialect::Calculix).0;
    assert_eq!(calculix.steps[0].loads[0].magnitude, 2.0 * 9.81);
    let whole = model(&add("*DLOAD\n, GRAV, 9.81, 0., 0., -1.\n"));
    assert!(matches!(&whole.steps[0].loads[0].kind, LoadKind::Gravity { elements, .. } if elements.len() == 2));

    let cases = [
        ("*CLOAD\n5, 1\n", "*CLOAD", "force is missing"),
        ("*CLOAD\n5, 8, 1.\n", "*CLOAD", "degree of freedom 8 does not exist"),
        ("*CLOAD\nNOPE, 1, 1.\n", "*CLOAD", "no node set NOPE"),
        ("*CLOAD\n5, 1, 1.\n5, 1, 2.\n", "*CLOAD", "given twice in one step"),
        ("*CLOAD, OP=NEW\n5, 1, 1.\n*CLOAD\n6, 1, 1.\n", "*CLOAD", "side by side"),
        ("*CLOAD, AMPLITUDE=RISE\n5, 1, 1.\n", "*CLOAD", "no amplitude RISE"),
        ("*DLOAD\nUPPER, P7, 3.\n", "*DLOAD", "load type P7 is not supported"),
        ("*DLOAD\nUPPER, CENTRIF, 3.\n", "*DLOAD", "load type CENTRIF is not supported"),
        ("*DLOAD\n9, P1, 3.\n", "*DLOAD", "element 9 is not defined"),
        ("*DLOAD\nUPPER, GRAV, 9.81\n", "*DLOAD", "direction of gravity is missing"),
        ("*DSLOAD\nTHIRD, P, 1.\n", "*DSLOAD", "no surface THIRD"),
        ("*DSLOAD\nSECOND, HP, 1.\n", "*DSLOAD", "load type HP is not supported"),
    ];
    for (cards, keyword, fragment) in cases {
        refuses(&add(cards), keyword, fragment);
    }
    warns(&add("*CLOAD\n5, 4, 1.\n"), "*CLOAD", "degree of freedom 4 is ignored");
    warns(&add("*CLOAD\nNALL, 1, 1.\n5, 1, 2.\n"), "*CLOAD", "they add");
    let without = add("*DLOAD\nUPPER, GRAV, 9.81, 0., 0., -1.\n").replace("*DENSITY\n7.8e-9\n", "");
    refuses(&without, "*DLOAD", "no density");
    let second = |cards: &str| format!("{}*STEP\n*STATIC\n{cards}*END STEP\n", add("*CLOAD\nNALL, 1, 1.\n"));
    model(&second("*CLOAD\nNALL, 1, 2.\n"));
    assert!(model(&second("*CLOAD, OP=NEW\n5, 1, 2.\n")).steps[1].loads_removed.cload);
    refuses(&second("*CLOAD\n5, 1, 2.\n"), "*CLOAD", "overlaps the load on NALL of an earlier step");
}

#[test]
fn amplitudes_are_read_and_checked() {
    let used = with("*BOUNDARY\nTOP, 3", "*BOUNDARY, AMPLITUDE=rise\nTOP, 3");
    let define = |card: &str| used.replacen("*STEP", &format!("{card}*STEP"), 1);
    let model = model(&define("*AMPLITUDE, NAME=RISE, TIME=TOTAL TIME\n0., 0., 0.5, 1.,\n1., 0.25\n"));
    assert_eq!(model.amplitudes[0].points, [(0.0, 0.0), (0.5, 1.0), (1.0, 0.25)]);
    assert_eq!(model.amplitudes[0].clock, AmplitudeClock::Total);
    assert_eq!(model.steps[0].boundaries[0].amplitude, Some(AmplitudeId(0)));
    let cases = [
        ("*AMPLITUDE, NAME=RISE\n0., 0., 0.5\n", "the last time has no value"),
        ("*AMPLITUDE, NAME=RISE\n0., 0., 0., 1.\n", "does not exceed the time before"),
        ("*AMPLITUDE, NAME=RISE\n", "the curve has no points"),
        ("*AMPLITUDE, NAME=RISE, DEFINITION=SMOOTH STEP\n0., 0., 1., 1.\n", "DEFINITION=SMOOTH STEP is not supported"),
        ("*AMPLITUDE, NAME=RISE, VALUE=ABSOLUTE\n0., 0., 1., 1.\n", "VALUE=ABSOLUTE is not supported"),
        ("*AMPLITUDE, NAME=RISE, SMOOTH=0.1\n0., 0., 1., 1.\n", "SMOOTH=0.1 is not supported"),
        ("*AMPLITUDE, NAME=RISE\n0., 0.\n*AMPLITUDE, NAME=rise\n0., 0.\n", "defined twice"),
    ];
    for (card, fragment) in cases {
        refuses(&define(card), "*AMPLITUDE", fragment);
    }
    warns(&with("*STEP", "*AMPLITUDE, NAME=SPARE\n0., 1.\n*STEP"), "*AMPLITUDE", "amplitude SPARE is not used");
}

#[test]
fn steps_are_checked() {
    warns(&with("*STEP\n", "*STEP, NLGEOM\n"), "*STEP", "small displacements");
    assert!(read(&with("*STEP\n", "*STEP, NLGEOM=NO\nsome title\n")).diagnostics.is_empty());
    let control = |lines: &str| {
        let control = model(&with("*STATIC\n0.1, 1.\n", lines)).steps[0].procedure.implicit_increments().unwrap();
        (control.increment_initial, control.period, control.increment_min, control.increment_max, control.direct)
    };
    assert_eq!(control("*STATIC\n"), (1.0, 1.0, 1e-5, 1.0, false));
    assert_eq!(control("*STATIC, DIRECT\n0.5, 2.\n"), (0.5, 2.0, 2e-5, 2.0, true));
    assert_eq!(control("*STATIC\n0.5, 2., 1e-3, 0.75\n"), (0.5, 2.0, 1e-3, 0.75, false));
    assert_eq!(control("*STATIC\n0., 0., 0., 0.\n"), (1.0, 1.0, 1e-5, 1.0, false));
    let cases = [
        ("*STATIC\n0.1, 1.\n", "", "*STEP", "no procedure"),
        ("*STATIC\n0.1, 1.\n", "*VISCO\n0.1, 1.\n", "*VISCO", "not supported"),
        ("*STATIC\n", "*STATIC, STABILIZE\n", "*STATIC", "STABILIZE is not supported"),
        ("*STATIC\n", "*STATIC, DIRECT=NO STOP\n", "*STATIC", "DIRECT=NO STOP is not supported"),
        ("*STATIC\n", "*STATIC\n*STATIC\n", "*STATIC", "a procedure already"),
        ("0.1, 1.", "2., 1.", "*STATIC", "longer than the period"),
        ("0.1, 1.", "-0.1, 1.", "*STATIC", "is negative"),
        ("0.1, 1.", "0.1, 1., 0.2", "*STATIC", "smallest increment"),
        ("0.1, 1.", "0.1, 1., 0.01, 0.05", "*STATIC", "largest increment"),
        ("*STATIC\n0.1, 1.", "*STATIC, DIRECT\n0.001, 1.", "*STATIC", "1000 fixed increments are needed"),
        ("*STEP\n", "*STEP, INC=0\n", "*STEP", "INC=0"),
        ("*STEP\n", "*STEP, PERTURBATION\n", "*STEP", "PERTURBATION is not supported"),
        ("*STEP\n", "*STEP, AMPLITUDE=SMOOTH\n", "*STEP", "AMPLITUDE=SMOOTH is not known"),
        ("*STEP\n", "*STEP\n*STATIC\n*END STEP\n*STEP, NAME=step-1\n", "*STEP", "there is a step step-1 already"),
        ("*STEP\n", "*STEP\n*STEP\n", "*STEP", "the step before is not closed"),
        ("*STEP\n", "*END STEP\n*STEP\n", "*END STEP", "no step to end"),
        ("*STEP\n", "*CLOAD\n5, 1, 1.\n*STEP\n", "*CLOAD", "outside a step"),
        ("*STATIC\n", "*STATIC\n*NODE\n*STATIC\n", "*NODE", "within a step"),
        ("*END STEP\n", "*END STEP\n*BOUNDARY\nTOP, 1\n", "*BOUNDARY", "behind a step"),
        ("*END STEP\n", "", "*STEP", "may have been cut off"),
    ];
    for (from, to, keyword, fragment) in cases {
        refuses(&with(from, to), keyword, fragment);
    }
}

#[test]
fn output_requests_are_read() {
    let cards = "*NODE FILE, FREQUENCY=5\nU, U1, NT\n*EL PRINT, ELSET=LOWER\nS11, S\n*CONTACT PRINT\n\
        *OUTPUT, FIELD, VARIABLE=PRESELECT, FREQUENCY=2\n*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=TOP\nRF3\n*RESTART, WRITE\n";
    let (model, found) = accepted(&with("*END STEP", &format!("{cards}*END STEP")), Dialect::Abaqus);
    let output = &model.steps[0].output;
    let nodes: Vec<_> = output.nodes.iter().map(|r| (r.target, r.set, r.variables.join(" "), r.frequency)).collect();
    let expected = [
        (OutputTarget::Print, Some(SetId(2)), "RF".to_string(), OutputFrequency::Increments(1)),
        (OutputTarget::File, None, "U".to_string(), OutputFrequency::Increments(5)),
        (OutputTarget::Field, None, "U RF".to_string(), OutputFrequency::Increments(2)),
        (OutputTarget::History, Some(SetId(2)), "RF".to_string(), OutputFrequency::Increments(1)),
    ];
    assert_eq!(nodes, expected);
    assert_eq!(
        output.elements.iter().map(|r| r.target).collect::<Vec<_>>(),
        [OutputTarget::Print, OutputTarget::Field]
    );
    assert_eq!(output.elements[0].variables, ["S"]);
    assert_eq!(output.contacts.len(), 3);
    assert_eq!(found.len(), 1, "{}", listing(&found));
    warns(&with("*NSET, NSET=TOP", "*NSET, NSET=TOP, FREQUENCY=5"), "*NSET", "FREQUENCY is ignored");
    warns(&with("*END STEP", "*NODE FILE\n*END STEP"), "*NODE FILE", "names no variables");
    warns(&with("*NODE PRINT, ", "*NODE PRINT, COLOUR=RED, "), "*NODE PRINT", "there is no parameter COLOUR");
    refuses(&with("NSET=TOP, TOTALS", "NSET=TIP, TOTALS"), "*NODE PRINT", "no node set TIP");
    refuses(&with("*NODE PRINT, ", "*NODE PRINT, FREQUENCY=x, "), "*NODE PRINT", "FREQUENCY=x is not a whole number");
}

#[test]
fn keywords_and_parameters_that_are_not_known_are_refused_with_a_suggestion() {
    let remedy = |text: &str| listing(&read(text).diagnostics);
    refuses(&with("*SURFACE BEHAVIOR", "*SURFACE BEHAVIOUR"), "*SURFACE BEHAVIOUR", "no such keyword");
    assert!(remedy(&with("*SURFACE BEHAVIOR", "*SURFACE BEHAVIOUR")).contains("did you mean *SURFACE BEHAVIOR?"));
    assert!(remedy(&with("TOP, 3, 3, -0.01", "TPO, 3, 3, -0.01")).contains("did you mean TOP?"));
    refuses(&with("*STEP\n", "*STEP, INCR=5\n"), "*STEP", "there is no parameter INCR");
    refuses(&with("*STEP\n", "*STEP, INC=5, INC=6\n"), "*STEP", "parameter INC is given twice");
    refuses(&with("*STEP\n", "*STEP, INC\n"), "*STEP", "parameter INC has no value");
    refuses(&with("SMALL SLIDING", "SMALL SLIDING=YES"), "*CONTACT PAIR", "takes no value");
    refuses(&with("*STEP\n", "*\n*STEP\n"), "*", "missing");
    refuses(&with("*STEP\n", "*TIE, NAME=T\nA, B\n*STEP\n"), "*TIE", "not supported and would change the answer");
    refuses(&with("*STEP\n", "*PART, NAME=P\n*STEP\n"), "*PART", "not supported");
    warns(&with("*STEP\n", "*PREPRINT, ECHO=NO\n*STEP\n"), "*PREPRINT", "ignored");
    refuses(&with("*MATERIAL, NAME=STEEL\n", "*MATERIAL, NAME=STEEL\n1., 2.\n"), "*MATERIAL", "takes no data lines");
}

#[test]
fn what_belongs_to_a_refused_keyword_is_not_complained_about() {
    let change = "*CHANGE SURFACE BEHAVIOR, INTERACTION=SI\n*SURFACE BEHAVIOR\n*NODE PRINT";
    let found = read(&with("*NODE PRINT", change)).diagnostics;
    assert_eq!(found.len(), 1, "{}", listing(&found));
    refuses(&with("*NODE PRINT", "*FRICTION\n0.3\n*NODE PRINT"), "*FRICTION", "within a step");
}

#[test]
fn every_finding_is_given_at_once_with_its_line() {
    let text = with("MATERIAL=STEEL", "MATERIAL=X")
        .replace("BOTTOM, 1, 3", "Y, 1, 3")
        .replace("*NODE PRINT", "*TIE\n*NODE PRINT");
    let found = read(&text).diagnostics;
    let places: Vec<_> = found.iter().filter(|d| d.is_error()).map(|d| (d.place.line, d.keyword.as_str())).collect();
    assert_eq!(places, [(39, "*SOLID SECTION"), (46, "*BOUNDARY"), (53, "*TIE")], "{}", listing(&found));
}

#[test]
fn the_dialect_of_calculix_changes_what_it_says_it_changes() {
    let (model, found) = accepted(BASE, Dialect::Calculix);
    assert_eq!(model.mesh.elements.kind(0), ElementKind::C3D8Full);
    assert!(found.is_empty(), "{}", listing(&found));
    let warns = |text: &str, keyword: &str, fragment: &str| {
        finds(text, Dialect::Calculix, Severity::Warning, keyword, fragment);
        accepted(text, Dialect::Calculix);
    };
    let behavior = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e6\n";
    warns(&with("1e6\n", "1e6, 1., 1e-3\n"), "*SURFACE BEHAVIOR", "arctangent");
    warns(&with(behavior, "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n"), "*SURFACE BEHAVIOR", "stiff spring");
    warns(&with(behavior, ""), "*SURFACE INTERACTION", "CalculiX would stop");
    warns(
        &with(behavior, "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR\n0., 0.\n1., 1.\n"),
        "*SURFACE BEHAVIOR",
        "last slope",
    );
    assert!(differences().iter().any(|d| d.subject.contains("EXPONENTIAL") && d.follows_calculix));
}

#[test]
fn the_tables_list_what_the_reader_must_know() {
    let names: Vec<_> = keywords().map(|keyword| keyword.name).collect();
    for name in ["*HEADING", "*INCLUDE", "*CONTACT PAIR", "*DSLOAD", "*END STEP", "*TIE", "*DYNAMIC"] {
        assert!(names.contains(&name), "{name}");
    }
}
