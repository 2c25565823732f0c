//! The list of linked libraries that every FMU carries is the list of libraries that are linked.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

const LIST: &str = "third-party.txt";

/// Name and licence of everything that the FMU library links, by cargo.
fn linked() -> BTreeSet<String> {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--locked", "-p", "overclosure-fmu", "-e", "normal,no-proc-macro", "--prefix", "none"])
        .args(["-f", "{p}|{l}"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines()
        .filter_map(|line| line.split_once('|'))
        .map(|(package, license)| {
            let name = package.split(' ').next().unwrap();
            format!("{name}: {}", license.trim_end_matches(" (*)"))
        })
        .filter(|line| !line.starts_with("overclosure"))
        .collect()
}

#[test]
fn the_list_names_what_is_linked() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(LIST);
    let text = std::fs::read_to_string(&path).unwrap();
    let listed: BTreeSet<String> = text.lines().filter(|line| line.contains(": ")).map(str::to_owned).collect();
    let linked = linked();
    assert!(linked.len() > 10, "{linked:?}");
    let missing: Vec<_> = linked.difference(&listed).collect();
    let surplus: Vec<_> = listed.difference(&linked).collect();
    assert!(missing.is_empty() && surplus.is_empty(), "{LIST}: missing {missing:#?}, surplus {surplus:#?}");
}
