//! A deck that is in order, and the questions that the tests ask about its variants.

use overclosure::deck::{Reading, read_text};
use overclosure::diagnostic::{Diagnostic, Severity};
use overclosure::model::{Dialect, Model};

/// Two unit cubes, one on the other, pressed together.
pub const BASE: &str = "\
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
pub fn with(from: &str, to: &str) -> String {
    assert!(BASE.contains(from), "the base deck does not contain {from:?}");
    BASE.replacen(from, to, 1)
}

/// A static deck like the base deck as an explicit analysis of the same length: the top moves with the velocity.
pub fn explicit_deck(text: &str) -> String {
    let text = text.replace("*STATIC\n0.1, 1.\n", "*DYNAMIC, EXPLICIT\n, 1.\n");
    text.replace("*BOUNDARY\nTOP, 3", "*BOUNDARY, TYPE=VELOCITY\nTOP, 3")
}

pub fn read(text: &str) -> Reading {
    read_text(text, Dialect::Abaqus)
}

pub fn listing(diagnostics: &[Diagnostic]) -> String {
    diagnostics.iter().map(|d| format!("{d}\n")).collect()
}

/// The model of a deck that must be accepted.
pub fn accepted(text: &str, dialect: Dialect) -> (Model, Vec<Diagnostic>) {
    let reading = read_text(text, dialect);
    let found = listing(&reading.diagnostics);
    (reading.model.unwrap_or_else(|| panic!("refused:\n{found}")), reading.diagnostics)
}

pub fn model(text: &str) -> Model {
    accepted(text, Dialect::Abaqus).0
}

/// Asserts that a deck gives a finding of this severity, keyword and text, and that only errors keep the model back.
#[track_caller]
pub fn finds(text: &str, dialect: Dialect, severity: Severity, keyword: &str, fragment: &str) {
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
pub fn refuses(text: &str, keyword: &str, fragment: &str) {
    finds(text, Dialect::Abaqus, Severity::Error, keyword, fragment);
}

#[track_caller]
pub fn warns(text: &str, keyword: &str, fragment: &str) {
    finds(text, Dialect::Abaqus, Severity::Warning, keyword, fragment);
    assert!(read(text).model.is_some(), "{}", listing(&read(text).diagnostics));
}
