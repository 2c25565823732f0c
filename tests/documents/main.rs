//! Tables in `docs/` are made from the data that the deck reader works with, and held to it.
//!
//! `OVERCLOSURE_RENEW_DOCUMENTS=1 cargo test --release -p overclosure-tests --test documents` rewrites them.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use overclosure::deck::{
    Confidence, Effect, FEATURES, Family, Keyword, Offer, Parameter, ParameterValue, Placement, RULES, differences,
    keywords,
};
use overclosure::diagnostic::Severity;

const START: &str = "<!-- table: generated -->";
const END: &str = "<!-- end of the table -->";

fn path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../docs").join(name)
}

/// Compares the table of a document with what it should be, or rewrites it when asked to.
fn hold(name: &str, table: &str) {
    let path = path(name);
    let text = fs::read_to_string(&path).expect("the document exists");
    let (before, rest) = text.split_once(START).expect("the document marks the start of its table");
    let (present, after) = rest.split_once(END).expect("the document marks the end of its table");
    if std::env::var_os("OVERCLOSURE_RENEW_DOCUMENTS").is_some() {
        fs::write(&path, format!("{before}{START}\n{table}{END}{after}")).expect("the document can be written");
        return;
    }
    assert!(
        present.trim() == table.trim(),
        "{name} does not show the present table; renew it with OVERCLOSURE_RENEW_DOCUMENTS=1 and read what changed"
    );
}

fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

#[test]
fn the_dialect_table_is_the_readers_own() {
    let mut table = String::from("| where | Abaqus | CalculiX | `--dialect calculix` reads it |\n|---|---|---|---|\n");
    for difference in differences() {
        let [subject, abaqus, calculix, read_as] =
            [difference.subject, difference.abaqus, difference.calculix, difference.read_as].map(cell);
        // Writing to a string does not fail.
        let _ = writeln!(table, "| {subject} | {abaqus} | {calculix} | {read_as} |");
    }
    hold("dialect.md", &table);
}

fn placement(placement: Placement) -> &'static str {
    match placement {
        Placement::Model => "model",
        Placement::Step => "step",
        Placement::Anywhere => "model or step",
        Placement::Material => "after `*MATERIAL`",
        Placement::Interaction => "after `*SURFACE INTERACTION`, `*GAP`",
    }
}

fn read_parameter(parameter: &Parameter) -> String {
    let required = if parameter.required { " (required)" } else { "" };
    let values = match parameter.value {
        ParameterValue::OneOf(values) => {
            let read: Vec<&str> = values
                .iter()
                .filter(|(name, effect)| *effect == Effect::Read && !name.is_empty())
                .map(|(name, _)| *name)
                .collect();
            if read.is_empty() { String::new() } else { format!("={}", read.join("/")) }
        }
        ParameterValue::Flag | ParameterValue::Any | ParameterValue::Optional => String::new(),
    };
    format!("{}{values}{required}", parameter.name)
}

/// Names of the parameters of a keyword with one effect.
fn parameters(keyword: &Keyword, wanted: impl Fn(Effect) -> bool) -> String {
    let found: Vec<&str> = keyword.parameters.iter().filter(|p| wanted(p.effect)).map(|p| p.name).collect();
    found.join(", ")
}

#[test]
fn the_keyword_table_is_the_readers_own() {
    let mut table = String::from(
        "| keyword | where | parameters read | ignored with a warning | refused |\n|---|---|---|---|---|\n",
    );
    for keyword in keywords().filter(|k| k.is_read()) {
        let read: Vec<String> =
            keyword.parameters.iter().filter(|p| p.effect == Effect::Read).map(read_parameter).collect();
        let ignored = parameters(keyword, |e| matches!(e, Effect::Ignored(_)));
        let refused = parameters(keyword, |e| matches!(e, Effect::Refused(_)));
        let place = placement(keyword.placement);
        let _ = writeln!(table, "| `{}` | {place} | {} | {ignored} | {refused} |", keyword.name, read.join(", "));
    }
    let mut groups: BTreeMap<(&str, &str), Vec<&str>> = BTreeMap::new();
    for keyword in keywords() {
        match keyword.effect {
            Effect::Refused(remedy) => groups.entry(("refused", remedy)).or_default().push(keyword.name),
            Effect::Ignored(reason) => groups.entry(("ignored", reason)).or_default().push(keyword.name),
            Effect::Read | Effect::Silent => {}
        }
    }
    for (effect, heading) in [
        ("refused", "Known, and refused because they change the answer"),
        ("ignored", "Known, and ignored with a warning"),
    ] {
        let _ = write!(
            table,
            "\n## {heading}\n\n| {} | keywords |\n|---|---|\n",
            if effect == "refused" { "what to do" } else { "why" }
        );
        for ((_, why), names) in groups.iter().filter(|((e, _), _)| *e == effect) {
            let _ = writeln!(table, "| {} | {} |", cell(why), names.join(", "));
        }
    }
    hold("keywords.md", &table);
}

/// An offer in a cell: whether, and on which condition.
fn offer(offer: Offer) -> String {
    match offer {
        Offer::Yes("") => "yes".into(),
        Offer::Yes(condition) => format!("yes: {condition}"),
        Offer::No(_) => "no".into(),
    }
}

#[test]
fn the_availability_tables_are_the_readers_own() {
    let families: Vec<&str> = Family::ALL.into_iter().map(Family::title).collect();
    let mut table =
        format!("## Features\n\n| feature | asked for by | {} | source | how sure |\n", families.join(" | "));
    table.push_str("|---|---|---|---|---|---|---|---|\n");
    for feature in FEATURES {
        let offers: Vec<String> = Family::ALL.into_iter().map(|family| cell(&offer(feature.offer(family)))).collect();
        let (name, source) = (cell(feature.name), feature.source);
        let _ = writeln!(
            table,
            "| {name} | {} | {} | {} | {} |",
            cell(feature.keyword),
            offers.join(" | "),
            source.section,
            source.confidence.name()
        );
    }
    table.push_str("\n## Why not\n\n| feature | where | reason | what to do |\n|---|---|---|---|\n");
    for feature in FEATURES {
        let mut refused: Vec<(&str, Vec<&str>)> = Vec::new();
        for family in Family::ALL {
            let Offer::No(reason) = feature.offer(family) else { continue };
            match refused.iter_mut().find(|(other, _)| *other == reason) {
                Some((_, families)) => families.push(family.title()),
                None => refused.push((reason, vec![family.title()])),
            }
        }
        for (reason, families) in refused {
            let families = families.join("; ");
            let _ = writeln!(table, "| {} | {families} | {reason} | {} |", cell(feature.name), feature.remedy);
        }
    }
    table
        .push_str("\n## Combinations\n\n| where | combination | finding | reason | what to do | source | how sure |\n");
    table.push_str("|---|---|---|---|---|---|---|\n");
    for rule in RULES {
        let families: Vec<&str> = rule.families.iter().copied().map(Family::title).collect();
        let families = if families.len() == Family::ALL.len() { "everywhere".into() } else { families.join("; ") };
        let finding = match rule.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        let _ = writeln!(
            table,
            "| {families} | {} | {finding} | {} | {} | {} | {} |",
            cell(&rule.combination.replace("the {law} law", "a softened law")),
            cell(rule.reason),
            cell(rule.remedy),
            rule.source.section,
            rule.source.confidence.name()
        );
    }
    hold("availability.md", &table);
}

#[test]
fn what_is_not_read_in_the_manual_says_so() {
    let sources = FEATURES.iter().map(|feature| feature.source).chain(RULES.iter().map(|rule| rule.source));
    for source in sources {
        assert!(!source.section.is_empty());
        assert!(
            source.confidence == Confidence::Text || source.section.contains("later releases"),
            "{}",
            source.section
        );
    }
}

#[test]
fn every_keyword_that_has_to_be_read_is_read() {
    let wanted = [
        "*HEADING",
        "*NODE",
        "*NSET",
        "*ELSET",
        "*ELEMENT",
        "*SURFACE",
        "*MATERIAL",
        "*ELASTIC",
        "*DENSITY",
        "*SOLID SECTION",
        "*AMPLITUDE",
        "*BOUNDARY",
        "*SURFACE INTERACTION",
        "*SURFACE BEHAVIOR",
        "*CONTACT PAIR",
        "*CONTACT DAMPING",
        "*FRICTION",
        "*CHANGE FRICTION",
        "*CONTACT CONTROLS",
        "*CONTACT INTERFERENCE",
        "*CLEARANCE",
        "*MODEL CHANGE",
        "*STEP",
        "*STATIC",
        "*CLOAD",
        "*DLOAD",
        "*DSLOAD",
        "*NODE PRINT",
        "*NODE FILE",
        "*NODE OUTPUT",
        "*EL PRINT",
        "*EL FILE",
        "*CONTACT PRINT",
        "*CONTACT FILE",
        "*OUTPUT",
        "*END STEP",
        "*INCLUDE",
    ];
    for name in wanted {
        assert!(keywords().any(|k| k.name == name && k.is_read()), "{name}");
    }
}
