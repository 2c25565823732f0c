//! Which module names what, and where `unsafe` stands, by reading the sources.

use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().expect("the checkout exists")
}

/// Rust files below a folder, relative to the checkout, with their code: comments and text literals blanked.
fn sources(folder: &str) -> Vec<(String, String)> {
    let mut open = vec![root().join(folder)];
    let mut found = Vec::new();
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(&next).expect("a folder of the checkout").map(|e| e.expect("an entry").path()) {
            let name = entry.file_name().and_then(|n| n.to_str()).unwrap_or_default().to_owned();
            if entry.is_dir() {
                let built = name == "target" || name == "node_modules" || name == "out" || name.starts_with('.');
                if !built {
                    open.push(entry);
                }
            } else if name.ends_with(".rs") {
                let text = fs::read_to_string(&entry).expect("a source file is text");
                let path = entry.strip_prefix(root()).expect("below the checkout").display().to_string();
                found.push((path, code(&text)));
            }
        }
    }
    found.sort();
    assert!(!found.is_empty(), "no Rust file below {folder}");
    found
}

/// The code of a file: line comments, block comments and the content of text literals removed.
fn code(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let skip = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if let Some(length) = raw_literal(rest) {
            length
        } else if c == '"' {
            literal(rest)
        } else if rest.starts_with("'\"'") || rest.starts_with("b'\"'") {
            rest.find("\"'").map_or(rest.len(), |end| end + 2)
        } else {
            out.push(c);
            rest = &rest[c.len_utf8()..];
            continue;
        };
        out.push(' ');
        rest = &rest[skip..];
    }
    out
}

/// Length of a plain text literal at the start.
fn literal(text: &str) -> usize {
    let mut escaped = false;
    for (at, c) in text.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return at + 1,
            _ => {}
        }
    }
    text.len()
}

/// Length of a raw text literal at the start, if there is one.
fn raw_literal(text: &str) -> Option<usize> {
    let after = text.strip_prefix('r')?;
    let hashes = after.len() - after.trim_start_matches('#').len();
    let body = after[hashes..].strip_prefix('"')?;
    let end = format!("\"{}", "#".repeat(hashes));
    let length = body.find(&end).map_or(body.len(), |at| at + end.len());
    Some(text.len() - body.len() + length)
}

/// Whether a word stands in code, not as part of a longer name.
fn names(code: &str, word: &str) -> bool {
    let part_of_name = |c: char| c.is_alphanumeric() || c == '_';
    code.match_indices(word).any(|(at, _)| {
        let before = code[..at].chars().next_back();
        let after = code[at + word.len()..].chars().next();
        !before.is_some_and(part_of_name) && !after.is_some_and(part_of_name)
    })
}

fn offenders(folder: &str, allowed: impl Fn(&str) -> bool, forbidden: &[&str]) -> Vec<String> {
    let mut found = Vec::new();
    for (path, code) in sources(folder) {
        for word in forbidden {
            if !allowed(&path) && names(&code, word) {
                found.push(format!("{path} names {word}"));
            }
        }
    }
    found
}

#[test]
fn unsafe_stands_in_the_ffi_file_alone() {
    let found = offenders("", |path| path == "fmu/src/ffi.rs", &["unsafe"]);
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn laws_import_nothing_of_the_engine() {
    // `crate::law` is the module itself; anything else of the crate is another part of the engine.
    for (path, code) in sources("daemon/engine/src/law") {
        for (at, _) in code.match_indices("crate::") {
            let rest = &code[at + "crate::".len()..];
            assert!(
                rest.starts_with("law"),
                "{path} imports crate::{}",
                rest.split_whitespace().next().unwrap_or_default()
            );
        }
        assert!(!names(&code, "faer"), "{path} names faer");
    }
}

#[test]
fn one_folder_names_the_linear_algebra_and_one_file_the_ordering_library() {
    let linear = |path: &str| path.starts_with("daemon/engine/src/solve/linear/");
    let ordering = |path: &str| path == "daemon/engine/src/solve/ordering.rs";
    let everywhere = ["daemon", "fmu", "protocol", "clients/rust"];
    let found: Vec<String> = everywhere
        .iter()
        .flat_map(|folder| {
            [offenders(folder, linear, &["faer"]), offenders(folder, ordering, &["feral_scotch"])].concat()
        })
        .collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn procedures_and_the_solver_never_see_the_deck_reader() {
    for folder in ["procedure", "solve", "contact", "element"] {
        for (path, code) in sources(&format!("daemon/engine/src/{folder}")) {
            assert!(!code.contains("crate::deck"), "{path} imports the deck reader");
        }
    }
}

#[test]
fn the_engine_has_no_clock_no_socket_and_no_thread_of_its_own() {
    for word in ["Instant", "SystemTime", "TcpStream", "UdpSocket"] {
        let found = offenders("daemon/engine/src", |_| false, &[word]);
        assert!(found.is_empty(), "{}", found.join("\n"));
    }
}

#[test]
fn the_code_filter_removes_comments_and_literals() {
    let text = "a // unsafe\n/* unsafe */ b \"un\\\"safe unsafe\" r#\"unsafe \"x\" \"# '\"' c unsafe_code";
    let code = code(text);
    assert!(!names(&code, "unsafe"), "{code}");
    assert!(names(&code, "a") && names(&code, "b") && names(&code, "c"));
    assert!(names("x = unsafe { y }", "unsafe"));
}
