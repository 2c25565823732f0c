//! What is packed has been tried, or is not there.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

use overclosure::model::Dialect;
use overclosure::simulation::{PathChoice, Simulation};
use overclosure_fmu::backend::deck::prepare;
use overclosure_fmu::resources::{PREPARED_FILE, read_deck};
use overclosure_packer::{Carried, DeckRequest, PackError, find_library, pack_deck, pack_law};

/// The library stands beside the tests, where cargo builds dependencies.
fn library() -> PathBuf {
    find_library(&std::env::current_exe().unwrap(), None).expect("cargo builds the library before these tests")
}

const DECK: &str = "\
*HEADING
One brick on another, pressed
*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
11, 0, 0, 1
12, 1, 0, 1
13, 1, 1, 1
14, 0, 1, 1
15, 0, 0, 2
16, 1, 0, 2
17, 1, 1, 2
18, 0, 1, 2
*ELEMENT, TYPE=C3D8, ELSET=LOWER
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=C3D8, ELSET=UPPER
2, 11, 12, 13, 14, 15, 16, 17, 18
*NSET, NSET=BOTTOM
1, 2, 3, 4
*NSET, NSET=TOP
15, 16, 17, 18
*INCLUDE, INPUT=material.inc
*SOLID SECTION, ELSET=LOWER, MATERIAL=STEEL
*SOLID SECTION, ELSET=UPPER, MATERIAL=STEEL
*SURFACE, NAME=BELOW, TYPE=ELEMENT
1, S2
*SURFACE, NAME=ABOVE, TYPE=ELEMENT
2, S1
*SURFACE INTERACTION, NAME=SOFT
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
1000.
*CONTACT PAIR, INTERACTION=SOFT
ABOVE, BELOW
*BOUNDARY
BOTTOM, 1, 3
TOP, 1, 2
*STEP, NAME=PRESS
*STATIC
0.1, 1.0
*BOUNDARY
TOP, 3, 3, -0.01
*NODE PRINT, NSET=TOP
U, RF
*END STEP
";

fn request(folder: &tempfile::TempDir) -> DeckRequest {
    let deck = folder.path().join("two bricks.inp");
    fs::write(&deck, DECK).unwrap();
    fs::write(folder.path().join("material.inc"), "*MATERIAL, NAME=STEEL\n*ELASTIC\n1000., 0.3\n").unwrap();
    DeckRequest {
        deck,
        output: folder.path().join("two.fmu"),
        ports: None,
        dialect: Dialect::Abaqus,
        path: PathChoice::Auto,
        carried: Carried::Deck,
        library: library(),
    }
}

fn files(folder: &tempfile::TempDir) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn the_law_is_packed_with_the_same_bytes_twice() {
    let folder = tempfile::tempdir().unwrap();
    let (a, b) = (folder.path().join("a.fmu"), folder.path().join("b.fmu"));
    pack_law(&library(), &a).unwrap();
    pack_law(&library(), &b).unwrap();
    assert_eq!(fs::read(a).unwrap(), fs::read(b).unwrap());
}

#[test]
fn a_deck_with_includes_becomes_one_file() {
    let folder = tempfile::tempdir().unwrap();
    let request = request(&folder);
    let report = pack_deck(&request).unwrap();
    assert_eq!(report.inputs, 1);
    assert!(report.outputs > 10, "{report:?}");
    let first = fs::read(&request.output).unwrap();
    pack_deck(&request).unwrap();
    assert_eq!(first, fs::read(&request.output).unwrap());
    assert_eq!(files(&folder), ["material.inc", "two bricks.inp", "two.fmu"]);
}

#[test]
fn an_fmu_with_the_prepared_model_factors_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let plain = request(&folder);
    let guid = pack_deck(&plain).unwrap().guid;
    let request = DeckRequest { carried: Carried::Prepared, ..plain };
    assert_eq!(pack_deck(&request).unwrap().guid, guid, "what it computes is the same");
    assert_eq!(files(&folder), ["material.inc", "two bricks.inp", "two.fmu"]);
    let unpacked = tempfile::tempdir().unwrap();
    zip::ZipArchive::new(fs::File::open(&request.output).unwrap()).unwrap().extract(unpacked.path()).unwrap();
    let resources = unpacked.path().join("resources");
    for (prepared, factorizations) in [(true, 0), (false, 2)] {
        if !prepared {
            fs::remove_file(resources.join(PREPARED_FILE)).unwrap();
        }
        let text = read_deck(&resources, request.dialect, request.path, false).unwrap();
        let simulation = Simulation::new(Arc::new(prepare(&text).unwrap()));
        assert_eq!(simulation.step_reports()[0].counts.factorizations, factorizations);
    }
}

#[test]
fn a_library_that_is_none_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let broken = folder.path().join("broken.so");
    fs::write(&broken, "not a library").unwrap();
    let error = pack_law(&broken, &folder.path().join("law.fmu")).unwrap_err();
    assert!(matches!(error, PackError::Trial(_)), "{error}");
    assert_eq!(files(&folder), ["broken.so"]);
}

#[test]
fn a_wrong_deck_is_refused_with_its_findings() {
    let folder = tempfile::tempdir().unwrap();
    let request = request(&folder);
    fs::write(&request.deck, DECK.replace("MATERIAL=STEEL", "MATERIAL=WOOD")).unwrap();
    match pack_deck(&request) {
        Err(PackError::Deck(findings)) => assert!(findings.iter().any(|finding| finding.to_string().contains("WOOD"))),
        other => panic!("{other:?}"),
    }
    assert_eq!(files(&folder), ["material.inc", "two bricks.inp"]);
}
