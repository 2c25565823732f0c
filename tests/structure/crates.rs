//! Which crate links what, by `cargo metadata`: normal and build dependencies of this platform, direct or not.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

use serde_json::Value;

/// Dependencies by package name, of the whole graph.
struct Graph {
    edges: BTreeMap<String, BTreeSet<String>>,
    workspace: BTreeSet<String>,
}

fn host() -> String {
    let output = Command::new("rustc").arg("-vV").output().expect("rustc runs where cargo does");
    let text = String::from_utf8(output.stdout).expect("rustc prints text");
    let line = text.lines().find_map(|l| l.strip_prefix("host: "));
    line.expect("rustc -vV names its host").to_owned()
}

impl Graph {
    fn read() -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let output = Command::new(env!("CARGO"))
            .args(["metadata", "--format-version", "1", "--locked", "--filter-platform", &host()])
            .current_dir(root)
            .output()
            .expect("cargo runs");
        assert!(output.status.success(), "cargo metadata: {}", String::from_utf8_lossy(&output.stderr));
        let data: Value = serde_json::from_slice(&output.stdout).expect("cargo metadata prints JSON");
        let list = |value: &Value| value.as_array().expect("a list").clone();
        let text = |value: &Value| value.as_str().expect("a text").to_owned();
        let names: BTreeMap<String, String> =
            list(&data["packages"]).iter().map(|p| (text(&p["id"]), text(&p["name"]))).collect();
        let workspace = list(&data["workspace_members"]).iter().map(|id| names[&text(id)].clone()).collect();
        let mut edges: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for node in list(&data["resolve"]["nodes"]) {
            let from = edges.entry(names[&text(&node["id"])].clone()).or_default();
            for dependency in list(&node["deps"]) {
                let only_for_tests = list(&dependency["dep_kinds"]).iter().all(|kind| kind["kind"] == "dev");
                if !only_for_tests {
                    from.insert(names[&text(&dependency["pkg"])].clone());
                }
            }
        }
        Self { edges, workspace }
    }

    /// Everything that a package links, itself not counted.
    fn reach<'a>(&'a self, package: &'a str) -> BTreeSet<&'a str> {
        let mut seen = BTreeSet::new();
        let mut open = vec![package];
        while let Some(next) = open.pop() {
            let found = self.edges.get(next).unwrap_or_else(|| panic!("no package {next} in the graph"));
            open.extend(found.iter().map(String::as_str).filter(|name| seen.insert(*name)));
        }
        seen
    }
}

/// Package, and what it must not link: names, or prefixes that end in `*`.
const RULES: &[(&str, &[&str])] = &[
    ("overclosure", &["tokio*", "zenoh*", "mio", "socket2", "overclosure-*"]),
    ("overclosure-protocol", &["overclosure", "tokio*", "zenoh*", "faer"]),
    ("overclosure-client", &["overclosure", "overclosure-fmu", "overclosure-daemon", "faer"]),
    (
        "overclosure-fmu",
        &["tokio*", "zenoh*", "overclosure-protocol", "overclosure-client", "overclosure-packer", "fmi-rs", "zip"],
    ),
    ("overclosure-packer", &["tokio*", "zenoh*", "overclosure-protocol", "overclosure-client"]),
];

fn matches(rule: &str, name: &str) -> bool {
    rule.strip_suffix('*').map_or(name == rule, |prefix| name.starts_with(prefix))
}

#[test]
fn each_crate_links_only_what_it_may() {
    let graph = Graph::read();
    let mut broken = Vec::new();
    for (package, forbidden) in RULES {
        for name in graph.reach(package) {
            if forbidden.iter().any(|rule| matches(rule, name)) {
                broken.push(format!("{package} links {name}"));
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn every_crate_of_the_workspace_has_a_rule_or_is_a_leaf() {
    let graph = Graph::read();
    let ruled = RULES.iter().map(|(package, _)| (*package).to_owned());
    let leaves = ["overclosure-daemon", "overclosure-tests"].map(str::to_owned);
    assert_eq!(graph.workspace, ruled.chain(leaves.clone()).collect(), "a new crate needs a rule");
    for (package, links) in &graph.edges {
        for leaf in &leaves {
            assert!(!links.contains(leaf), "{package} links {leaf}, which nothing may");
        }
    }
}

#[test]
fn the_graph_is_really_followed() {
    let graph = Graph::read();
    assert!(graph.reach("overclosure").contains("faer"));
    assert!(graph.reach("overclosure-daemon").contains("tokio"), "zenoh and tokio are reached where they are allowed");
    assert!(graph.reach("overclosure-client").iter().any(|name| name.starts_with("zenoh")));
}
