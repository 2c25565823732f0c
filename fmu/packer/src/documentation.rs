//! `documentation/`: a page about the FMU for the person who imports it, and the licences.

use std::fmt::Write;

use overclosure_fmu::variables::{Causality, Kind, Variable};

use crate::archive::Archive;
use crate::description::GENERATION_TOOL;

const LICENSE: &str = "\
The shared library in this FMU is licensed under MIT OR Apache-2.0, at your option; both texts are beside this file.
third-party.txt lists the libraries that are linked into it, with their licences.
The deck in resources/ belongs to whoever packed it.
";

const STYLE: &str = "body{font-family:sans-serif;max-width:60em;margin:2em auto;line-height:1.4}\
table{border-collapse:collapse}td,th{border:1px solid #bbb;padding:.2em .6em;text-align:left;vertical-align:top}\
code{background:#f2f2f2}";

/// What the page says about this FMU.
#[derive(Clone, Debug)]
pub struct Page<'a> {
    /// Name of the model.
    pub name: &'a str,
    /// Paragraphs: what it is, how it was built.
    pub about: Vec<String>,
    /// How it behaves, one item each.
    pub behaviour: Vec<&'static str>,
    /// Variables.
    pub variables: &'a [Variable],
}

/// Behaviour that every FMU has.
pub const COMMON_BEHAVIOUR: [&str; 6] = [
    "A call that is refused (a number that is not finite, an unknown value reference, a step into the past, a wrong \
     order) returns fmi2Error and changes nothing; the reason is in the log when debug logging is on.",
    "Steps may have any size from zero on. A zero step refreshes the outputs.",
    "States can be saved, set and serialised. Continuing from a state gives the same bits as the first time, in \
     another process too; damaged or foreign bytes are refused.",
    "fmi2Reset returns to the state after fmi2Instantiate; saved states stay valid.",
    "Any number of instances may live in one process, each used by one thread at a time.",
    "Everything is inside: no tool, no network, no file outside this FMU.",
];

/// Behaviour of a deck.
pub const DECK_BEHAVIOUR: [&str; 6] = [
    "Inputs are the loads and prescribed displacements of the last step of the deck. Steps before it run during \
     initialisation; time 0 of the experiment is the beginning of the last step.",
    "An input that is never set follows the deck. One that is set reaches its value linearly over the next \
     communication step and keeps it until it is set again; set during initialisation, it has it from the start.",
    "Outputs answer to new inputs at the next step (ModelStructure lists no direct dependency).",
    "Units are those of the deck. Variables have a unit only where a ports file declared one.",
    "When the solver cannot continue, fmi2DoStep returns fmi2Error. Outputs and fmi2LastSuccessfulTime are those of \
     the last good increment; set a saved state or reset to go on.",
    "After the end of the deck inputs keep their values and steps go on.",
];

/// Behaviour of a law.
pub const LAW_BEHAVIOUR: [&str; 7] = [
    "Outputs follow inputs and parameters at once, without a step.",
    "Parameters may be set before the initialisation ends and between steps. Only those of the chosen law count. A \
     combination that makes no law is refused with the parameter's name: at the end of the initialisation, or when it is \
     set, in which case the values before it are kept.",
    "law.kind chooses the law; importers without enumerations set law.kind_integer instead (0 leaves the choice to law.kind).",
    "A table is given as text in table.text, or, when that is empty, by table.n, table.pressure[i] and \
     table.overclosure[i]. Between steps, set table.n after the points.",
    "Contact damping acts beside any law when damping.coefficient is not zero: viscous_pressure is the coefficient times \
     closing_velocity, up to the clearance damping.clearance; force and power include it, pressure does not.",
    "law.separation = 1 means surfaces that have met before and may not part: linear, tabular and the penalties go on into \
     tension with their first slope; the exponential laws are refused.",
    "Energy is per area, stored_energy is for the whole area; likewise stiffness and force_stiffness.",
];

/// Adds the documentation.
pub fn add(archive: &mut Archive, page: &Page) {
    archive.file("documentation/index.html", html(page));
    archive.file("documentation/licenses/license.txt", LICENSE);
    archive.file("documentation/licenses/LICENSE-MIT.txt", include_str!("../../../LICENSE-MIT"));
    archive.file("documentation/licenses/LICENSE-APACHE.txt", include_str!("../../../LICENSE-APACHE"));
    archive.file("documentation/licenses/third-party.txt", include_str!("../third-party.txt"));
}

fn html(page: &Page) -> String {
    let name = escape(page.name);
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{name}</title><style>{STYLE}</style></head>\n\
         <body>\n<h1>{name}</h1>\n<p><img src=\"../model.png\" alt=\"\"></p>\n"
    );
    for paragraph in &page.about {
        let _ = writeln!(out, "<p>{}</p>", escape(paragraph));
    }
    let _ = writeln!(out, "<p>Packed by {GENERATION_TOOL}.</p>\n<h2>Behaviour</h2>\n<ul>");
    for item in page.behaviour.iter().chain(&COMMON_BEHAVIOUR) {
        let _ = writeln!(out, "<li>{}</li>", escape(item));
    }
    out.push_str("</ul>\n<h2>Variables</h2>\n<table>\n");
    out.push_str("<tr><th>name</th><th>role</th><th>type</th><th>unit</th><th>start</th><th>meaning</th></tr>\n");
    for variable in page.variables {
        row(&mut out, variable);
    }
    out.push_str("</table>\n</body></html>\n");
    out
}

fn row(out: &mut String, variable: &Variable) {
    let role = match variable.causality {
        Causality::TunableParameter => "parameter",
        Causality::Input => "input",
        Causality::Output => "output",
    };
    let (kind, unit, start) = match &variable.kind {
        Kind::Real { start, unit, .. } => ("Real", unit.as_deref().unwrap_or(""), format!("{start:?}")),
        Kind::Integer { start, .. } => ("Integer", "", start.to_string()),
        Kind::Enumeration { start, definition } => ("Enumeration", "", definition.items[*start as usize - 1].0.into()),
        Kind::String { start } => ("String", "", start.clone()),
    };
    let start = if variable.causality == Causality::Output { String::new() } else { start };
    let _ = writeln!(
        out,
        "<tr><td><code>{}</code></td><td>{role}</td><td>{kind}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
        escape(&variable.name),
        escape(unit),
        escape(&start),
        escape(&variable.description)
    );
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use overclosure_fmu::backend::law;

    #[test]
    fn every_variable_is_on_the_page_and_text_is_escaped() {
        let variables = law::variables();
        let page =
            Page { name: "a<b", about: vec!["x & y".into()], behaviour: LAW_BEHAVIOUR.to_vec(), variables: &variables };
        let html = html(&page);
        assert!(html.contains("a&lt;b") && html.contains("x &amp; y"));
        for variable in &variables {
            assert!(html.contains(&format!("<code>{}</code>", variable.name)), "{}", variable.name);
        }
    }
}
