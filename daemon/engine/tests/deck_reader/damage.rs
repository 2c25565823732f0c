//! Files that are missing, cut, damaged, binary, endless, or made to exhaust the reader.

use overclosure::deck::{read_file, read_text, summary};
use overclosure::diagnostic::Diagnostic;
use overclosure::model::Dialect;

use crate::base::*;

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
