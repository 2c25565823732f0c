//! The deck reader through its public face: for each rule a deck that uses it and a deck that breaks it.

use overclosure::deck::{Reading, differences, keywords, read_file, read_text, summary};
use overclosure::diagnostic::{Diagnostic, Severity};
use overclosure::law::{NormalBehavior, PressureOverclosure};
use overclosure::model::*;

/// Two unit cubes, one on the other, pressed together.
const BASE: &str = "\
*HEADING
two cubes
*NODE, NSET=NALL
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 1., 0., 1.
7, 1., 1., 1.
8, 0., 1., 1.
11, 0., 0., 1.
12, 1., 0., 1.
13, 1., 1., 1.
14, 0., 1., 1.
15, 0., 0., 2.
16, 1., 0., 2.
17, 1., 1., 2.
18, 0., 1., 2.
*ELEMENT, TYPE=C3D8, ELSET=LOWER
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=C3D8, ELSET=UPPER
2, 11, 12, 13, 14, 15, 16, 17, 18
*NSET, NSET=BOTTOM
1, 2, 3, 4
*NSET, NSET=TOP
15, 16, 17, 18
*ELSET, ELSET=ALL
LOWER, UPPER
*SURFACE, NAME=SECOND
UPPER, S1
*SURFACE, NAME=FIRST
LOWER, S2
*MATERIAL, NAME=STEEL
*ELASTIC
210000., 0.3
*DENSITY
7.8e-9
*SOLID SECTION, ELSET=ALL, MATERIAL=STEEL
*SURFACE INTERACTION, NAME=SI
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
1e6
*CONTACT PAIR, INTERACTION=SI, SMALL SLIDING
SECOND, FIRST
*BOUNDARY
BOTTOM, 1, 3
TOP, 1, 2
*STEP
*STATIC
0.1, 1.
*BOUNDARY
TOP, 3, 3, -0.01
*NODE PRINT, NSET=TOP, TOTALS=ONLY
RF
*CONTACT FILE
CSTR, CDIS
*END STEP
";

/// The base deck with a piece of text replaced. The piece must be there.
fn with(from: &str, to: &str) -> String {
    assert!(BASE.contains(from), "the base deck does not contain {from:?}");
    BASE.replacen(from, to, 1)
}

fn read(text: &str) -> Reading {
    read_text(text, Dialect::Abaqus)
}

fn listing(diagnostics: &[Diagnostic]) -> String {
    diagnostics.iter().map(|d| format!("{d}\n")).collect()
}

/// The model of a deck that must be accepted.
fn accepted(text: &str, dialect: Dialect) -> (Model, Vec<Diagnostic>) {
    let reading = read_text(text, dialect);
    let found = listing(&reading.diagnostics);
    (reading.model.unwrap_or_else(|| panic!("refused:\n{found}")), reading.diagnostics)
}

fn model(text: &str) -> Model {
    accepted(text, Dialect::Abaqus).0
}

/// Asserts that a deck gives a finding of this severity, keyword and text, and that only errors keep the model back.
#[track_caller]
fn finds(text: &str, dialect: Dialect, severity: Severity, keyword: &str, fragment: &str) {
    let reading = read_text(text, dialect);
    let is_it = |d: &&Diagnostic| d.severity == severity && d.keyword == keyword && d.message.contains(fragment);
    let found = listing(&reading.diagnostics);
    assert!(reading.diagnostics.iter().any(|d| is_it(&d)), "no {severity:?} of {keyword} with {fragment:?}:\n{found}");
    assert_eq!(reading.model.is_none(), reading.diagnostics.iter().any(Diagnostic::is_error), "{found}");
    for d in &reading.diagnostics {
        assert!(!d.is_error() || !d.remedy.is_empty() || d.message.contains("of this kind"), "no remedy: {d}");
    }
}

#[track_caller]
fn refuses(text: &str, keyword: &str, fragment: &str) {
    finds(text, Dialect::Abaqus, Severity::Error, keyword, fragment);
}

#[track_caller]
fn warns(text: &str, keyword: &str, fragment: &str) {
    finds(text, Dialect::Abaqus, Severity::Warning, keyword, fragment);
    assert!(read(text).model.is_some(), "{}", listing(&read(text).diagnostics));
}

#[test]
fn the_base_deck_is_read_without_findings() {
    let (model, found) = accepted(BASE, Dialect::Abaqus);
    assert!(found.is_empty(), "{}", listing(&found));
    assert_eq!(model.heading, "two cubes");
    assert_eq!(model.mesh.nodes.len(), 16);
    assert_eq!(model.mesh.node_of_label[&11], NodeId(8));
    assert_eq!(model.mesh.elements[1].nodes.map(|n| n.0), [8, 9, 10, 11, 12, 13, 14, 15]);
    assert_eq!(model.mesh.elements[0].kind, ElementKind::C3D8);
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
    let Procedure::Static(control) = step.procedure.clone();
    assert_eq!(
        (control.increment_initial, control.period, control.increment_max, control.direct),
        (0.1, 1.0, 1.0, false)
    );
    assert_eq!(control.increment_min, 1e-5);
    let line = &step.boundaries[0];
    assert_eq!((line.region_name.as_str(), line.direction, line.magnitude, line.place.line), ("TOP", 2, -0.01, 52));
    assert_eq!(step.output.nodes[0].totals, Totals::Only);
    assert_eq!(step.output.contacts[0].variables, ["CSTR", "CDIS"]);
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
            SurfaceKind::Nodes(_) => Vec::new(),
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
    refuses(&with("UPPER, S1", "UPPER, S7"), "*SURFACE", "no face S7");
    refuses(&with("UPPER, S1", "UPER, S1"), "*SURFACE", "no element set UPER");
    refuses(&with("UPPER, S1", "3, S1"), "*SURFACE", "element 3 is not defined");
    refuses(&with("UPPER, S1\n", ""), "*SURFACE", "surface SECOND is empty");
    refuses(&with("NAME=FIRST", "NAME=SECOND"), "*SURFACE", "defined twice");
    refuses(&with("NAME=SECOND\nUPPER, S1", "NAME=SECOND, TYPE=NODE\n11, 0.5"), "*SURFACE", "area per node");
    refuses(&with("NAME=SECOND", "NAME=SECOND, TYPE=CYLINDER"), "*SURFACE", "TYPE=CYLINDER is not supported");
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
        ("TYPE=C3D8, ELSET=LOWER", "TYPE=C3D20R, ELSET=LOWER", "*ELEMENT", "element type C3D20R is not supported"),
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
        ("TYPE=C3D8, ELSET=LOWER", "TYPE=C3D8R, ELSET=LOWER"),
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
    assert_eq!(model(&with("NAME=SI\n", "NAME=SI\n0.25\n")).interactions[0].node_area, 0.25);
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
        ("NO SEPARATION\n", "NO SEPARATION is not supported"),
        ("AUGMENTED LAGRANGE\n", "AUGMENTED LAGRANGE is not supported"),
        ("PENALTY\n", "PENALTY is not supported"),
        ("PRESSURE-OVERCLOSURE=TIED\n1e6\n", "TIED is not supported"),
        ("PRESSURE-OVERCLOSURE=CUBIC\n1e6\n", "PRESSURE-OVERCLOSURE=CUBIC is not known"),
        ("PRESSURE-OVERCLOSURE=HARD\n1e6\n", "hard contact takes no data line"),
        ("PRESSURE-OVERCLOSURE=LINEAR\n1e6\n*SURFACE BEHAVIOR\n", "has a *SURFACE BEHAVIOR already"),
    ];
    for (to, fragment) in cases {
        refuses(&with(behavior, to), "*SURFACE BEHAVIOR", fragment);
    }
    refuses(&with("1e6\n", "1e6\n*FRICTION\n0.1\n"), "*FRICTION", "friction coefficient 0.1");
    refuses(&with("1e6\n", "1e6\n*FRICTION, ROUGH\n"), "*FRICTION", "ROUGH is not supported");
    refuses(&with("1e6\n", "1e6\n*CONTACT DAMPING\n1., 0.1\n"), "*CONTACT DAMPING", "not supported");
    refuses(&with("NAME=SI\n", "NAME=SI\n-1.\n"), "*SURFACE INTERACTION", "area per node -1 is not positive");
    refuses(
        &with("*STEP\n", "*CONTACT CONTROLS, ABSOLUTE PENETRATION TOLERANCE=1.\n*STEP\n"),
        "*CONTACT CONTROLS",
        "not supported",
    );
}

#[test]
fn contact_pairs_are_checked() {
    warns(&with(", SMALL SLIDING", ""), "*CONTACT PAIR", "finite sliding is solved as small sliding");
    warns(&with(", SMALL SLIDING", ", SMALL SLIDING, HCRIT=0.1"), "*CONTACT PAIR", "HCRIT is ignored");
    assert!(read(&with(", SMALL SLIDING", ", SMALL SLIDING, TYPE=NODE TO SURFACE")).diagnostics.is_empty());
    let cases = [
        (", SMALL SLIDING", ", TYPE=SURFACE TO SURFACE", "TYPE=SURFACE TO SURFACE is not supported"),
        (", SMALL SLIDING", ", TYPE=MORTAR", "TYPE=MORTAR is not supported"),
        (", SMALL SLIDING", ", TIED", "TIED is not supported"),
        (", SMALL SLIDING", ", ADJUST=0.1", "ADJUST is not supported"),
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
        ("*BOUNDARY\nTOP, 3", "*BOUNDARY, TYPE=VELOCITY\nTOP, 3", "TYPE=VELOCITY is not supported"),
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
        let Procedure::Static(control) = model(&with("*STATIC\n0.1, 1.\n", lines)).steps[0].procedure.clone();
        (control.increment_initial, control.period, control.increment_min, control.increment_max, control.direct)
    };
    assert_eq!(control("*STATIC\n"), (1.0, 1.0, 1e-5, 1.0, false));
    assert_eq!(control("*STATIC, DIRECT\n0.5, 2.\n"), (0.5, 2.0, 2e-5, 2.0, true));
    assert_eq!(control("*STATIC\n0.5, 2., 1e-3, 0.75\n"), (0.5, 2.0, 1e-3, 0.75, false));
    assert_eq!(control("*STATIC\n0., 0., 0., 0.\n"), (1.0, 1.0, 1e-5, 1.0, false));
    let cases = [
        ("*STATIC\n0.1, 1.\n", "", "*STEP", "no procedure"),
        ("*STATIC\n0.1, 1.\n", "*DYNAMIC\n0.1, 1.\n", "*DYNAMIC", "not supported"),
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
        ("*STEP\n", "*STEP, AMPLITUDE=STEP\n", "*STEP", "AMPLITUDE=STEP is not supported"),
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
        (OutputTarget::Print, Some(SetId(2)), "RF".to_string(), 1),
        (OutputTarget::Field, None, "U".to_string(), 5),
        (OutputTarget::Field, None, "U RF".to_string(), 2),
        (OutputTarget::History, Some(SetId(2)), "RF".to_string(), 1),
    ];
    assert_eq!(nodes, expected);
    assert_eq!(
        output.elements.iter().map(|r| r.target).collect::<Vec<_>>(),
        [OutputTarget::Print, OutputTarget::Field]
    );
    assert_eq!(output.elements[0].variables, ["S"]);
    assert_eq!(output.contacts.len(), 3);
    assert_eq!(found.len(), 2, "{}", listing(&found));
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
fn every_finding_is_given_at_once_with_its_line() {
    let text = with("MATERIAL=STEEL", "MATERIAL=X")
        .replace("BOTTOM, 1, 3", "Y, 1, 3")
        .replace("*NODE PRINT", "*TIE\n*NODE PRINT");
    let found = read(&text).diagnostics;
    let places: Vec<_> = found.iter().filter(|d| d.is_error()).map(|d| (d.place.line, d.keyword.as_str())).collect();
    assert_eq!(places, [(39, "*SOLID SECTION"), (46, "*BOUNDARY"), (53, "*TIE")], "{}", listing(&found));
}

#[test]
fn repeated_findings_are_counted() {
    let lines: String = (100..200).map(|n| format!("{n}, x\n")).collect();
    let found = read(&with("18, 0., 1., 2.\n", &format!("18, 0., 1., 2.\n{lines}"))).diagnostics;
    assert_eq!(found.len(), 21, "{}", listing(&found));
    assert!(found[20].message.starts_with("80 more findings"), "{}", found[20]);
}

#[test]
fn decks_that_blow_up_are_refused_in_bounded_time() {
    let chain: String = (1..6000).map(|n| format!("*NSET, NSET=N{n}\nN{}, {n}\n", n - 1)).collect();
    let nodes: String = (100..20_100).map(|n| format!("{n}, 9., 9., {n}.\n")).collect();
    let text = with("18, 0., 1., 2.\n", &format!("18, 0., 1., 2.\n{nodes}")) + &chain;
    refuses(&text, "*NSET", "node 19 is not defined");
    let repeated = "NALL, 1, 1\n".repeat(100_000);
    let text = with("18, 0., 1., 2.\n", &format!("18, 0., 1., 2.\n{nodes}"));
    refuses(
        &text.replace("BOTTOM, 1, 3\n", &format!("BOTTOM, 1, 3\n{repeated}")),
        "*BOUNDARY",
        "would not fit into memory",
    );
    let words: String = (0..50_000).map(|n| format!("*WORD{n}\n")).collect();
    assert!(read(&words).diagnostics.len() < 1100);
    let ranges = "1, 4000000000\n".repeat(3000);
    refuses(&(text + &format!("*NSET, NSET=R, GENERATE\n{ranges}")), "*NSET", "would not fit into memory");
}

#[test]
fn what_is_not_a_deck_is_refused() {
    refuses("", "", "the deck is empty");
    for text in ["", "*NODE\n1, 0.\0\n"] {
        assert_eq!(read(text).diagnostics.len(), 1, "{}", listing(&read(text).diagnostics));
    }
    refuses("** nothing but comments\n", "", "the deck is empty");
    refuses("Dear reader,\n", "", "text before the first keyword");
    refuses("*NODE\n1, 0.\0\n", "", "it is binary");
    refuses(&"x".repeat(100_000), "", "a line is longer");
    refuses("*NODE\n1, 0., 0., 0.\n", "", "no step");
    let folder = tempfile::tempdir().expect("folder");
    let file = |bytes: &[u8]| {
        let path = folder.path().join("deck.inp");
        std::fs::write(&path, bytes).expect("write");
        listing(&read_file(&path, Dialect::Abaqus).expect("read").diagnostics)
    };
    assert!(file(b"\x1f\x8b\x08garbage").contains("gzip"));
    assert!(file(b"\xff\xfe*\0N\0").contains("UTF-16"));
    assert!(file(b"*NODE, NSET=\xe9\n").contains("not UTF-8"));
    assert!(file(&[0x7f, b'E', b'L', b'F', 2, 1, 1, 0, 0]).contains("binary"));
    let latin = BASE.replace("two cubes", "zwei W\u{fc}rfel").replace("*NSET", "** f\u{fc}r\n*NSET");
    let latin: Vec<u8> = latin.chars().map(|c| c as u8).collect();
    assert_eq!(file(&latin), "", "headings and comments may be in any encoding");
    assert!(read_file(&folder.path().join("none.inp"), Dialect::Abaqus).is_err());
    assert!(read_file(folder.path(), Dialect::Abaqus).is_err());
}

#[test]
fn a_deck_cut_anywhere_is_refused() {
    for end in 0..BASE.len() - "*END STEP\n".len() {
        let reading = read(&BASE[..end]);
        assert!(reading.model.is_none(), "accepted when cut behind {:?}", &BASE[end.saturating_sub(20)..end]);
        assert!(reading.diagnostics.iter().any(Diagnostic::is_error));
    }
}

#[test]
fn files_are_included_relative_to_the_including_file() {
    let folder = tempfile::tempdir().expect("folder");
    std::fs::create_dir(folder.path().join("mesh")).expect("folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("write");
    let nodes = &BASE[BASE.find("1, 0.").expect("nodes")..BASE.find("*ELEMENT").expect("elements")];
    write("mesh/nodes.inc", nodes);
    write("mesh/all.inc", "*NODE, NSET=NALL\n*INCLUDE, INPUT=nodes.inc\n");
    write("deck.inp", &BASE.replace(&format!("*NODE, NSET=NALL\n{nodes}"), "*include, input=mesh/all.inc\n"));
    let reading = read_file(&folder.path().join("deck.inp"), Dialect::Abaqus).expect("read");
    assert!(reading.diagnostics.is_empty(), "{}", listing(&reading.diagnostics));
    assert_eq!(reading.model.expect("model").mesh.node_sets[0].nodes.len(), 16);

    write("mesh/nodes.inc", &nodes.replace("2, 1., 0., 0.", "2, one, 0., 0."));
    let found = read_file(&folder.path().join("deck.inp"), Dialect::Abaqus).expect("read").diagnostics;
    assert_eq!(found[0].place.line, 2);
    assert!(found[0].place.file.as_ref().is_some_and(|file| file.ends_with("mesh/nodes.inc")));

    write("mesh/nodes.inc", "*INCLUDE, INPUT=all.inc\n");
    let found = listing(&read_file(&folder.path().join("deck.inp"), Dialect::Abaqus).expect("read").diagnostics);
    assert!(found.contains("all.inc includes itself"), "{found}");
    write("mesh/all.inc", "*INCLUDE, INPUT=missing.inc\n");
    let found = read_file(&folder.path().join("deck.inp"), Dialect::Abaqus).expect("read").diagnostics;
    assert_eq!(found.len(), 1, "a missing file is the one thing to mend: {}", listing(&found));
    assert!(found[0].message.contains("missing.inc cannot be read"));
    refuses("*INCLUDE, INPUT=x.inc\n", "*INCLUDE", "came without a folder");
}

#[test]
fn the_dialect_of_calculix_changes_what_it_says_it_changes() {
    let (model, found) = accepted(BASE, Dialect::Calculix);
    assert_eq!(model.mesh.elements[0].kind, ElementKind::C3D8Full);
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

/// Small generator of reproducible numbers (SplitMix64).
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % bound as u64) as usize
    }
}

#[test]
fn damaged_decks_give_findings_or_a_model_and_never_a_panic() {
    const WORDS: [&str; 28] = [
        "*",
        "**",
        ",",
        "=",
        "\"",
        "\n",
        "\r\n",
        "0",
        "-1",
        "1e999",
        "nan",
        "4294967296",
        "99999999999999999999",
        "S1",
        "P6",
        "*STEP\n",
        "*END STEP\n",
        "*INCLUDE, INPUT=/dev/null\n",
        "GENERATE",
        "ALL",
        "\u{0}",
        "\u{fc}",
        "1, 4294967295, 1\n",
        "*ELSET, ELSET=ALL\nALL, LOWER\n",
        "*SURFACE, NAME=Z\nALL\n",
        "*OUTPUT, HISTORY\n",
        "*AMPLITUDE, NAME=A\n0,0\n",
        "OP=NEW",
    ];
    let mut random = Random(20_260_421);
    let (mut models, mut refused) = (0, 0);
    for _ in 0..6000 {
        let mut deck: Vec<char> = BASE.chars().collect();
        for _ in 0..=random.below(4) {
            let at = random.below(deck.len() + 1);
            let length = random.below(30).min(deck.len() - at);
            match random.below(6) {
                0 => deck.truncate(at),
                1 => drop(deck.drain(at..at + length)),
                2 => {
                    let piece: Vec<char> = deck[at..at + length].to_vec();
                    let to = random.below(deck.len() + 1);
                    deck.splice(to..to, piece);
                }
                3 if at < deck.len() => deck[at] = char::from(random.below(128) as u8),
                4 => {
                    let other = random.below(deck.len() + 1).min(deck.len().saturating_sub(1));
                    if at < deck.len() {
                        deck.swap(at, other);
                    }
                }
                _ => drop(deck.splice(at..at, WORDS[random.below(WORDS.len())].chars())),
            }
            if deck.is_empty() {
                break;
            }
        }
        let text: String = deck.into_iter().collect();
        for dialect in [Dialect::Abaqus, Dialect::Calculix] {
            let reading = read_text(&text, dialect);
            assert_eq!(reading.model.is_none(), reading.diagnostics.iter().any(Diagnostic::is_error), "{text}");
            if let Some(model) = &reading.model {
                assert!(!model.steps.is_empty() && !model.mesh.elements.is_empty() && !summary(model).is_empty());
                models += 1;
            } else {
                refused += 1;
            }
        }
    }
    assert!(models > 150 && refused > 1000, "the damage is one-sided: {models} models, {refused} refused");
}

/// Reads every `.inp` file of the folder named by `OVERCLOSURE_DECKS`, e.g. an unpacked collection of another solver.
#[test]
#[ignore = "needs a folder of decks in OVERCLOSURE_DECKS"]
fn foreign_decks_give_findings_or_a_model() {
    let folder = std::env::var_os("OVERCLOSURE_DECKS").expect("OVERCLOSURE_DECKS names a folder");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).expect("folder") {
        let path = entry.expect("entry").path();
        if path.extension().is_some_and(|extension| extension == "inp") {
            count += 1;
            let reading = read_file(&path, Dialect::Calculix).expect("read");
            assert_eq!(
                reading.model.is_none(),
                reading.diagnostics.iter().any(Diagnostic::is_error),
                "{}",
                path.display()
            );
        }
    }
    assert!(count > 0, "no decks there");
}
