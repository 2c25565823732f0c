//! `overclosure check`: reads a deck, reports what it found and what it understood. Solves nothing.

use std::path::PathBuf;

use clap::Args;
use overclosure::deck;
use overclosure::diagnostic::Diagnostic;
use overclosure::port::{self, Port, PortList};
use overclosure::simulation::PreparedModel;

use super::open::{WHAT_BECOMES_AN_INPUT, count, open_deck, read_ports, report};
use super::{DialectArg, Exit, complain, print};

/// Arguments of `overclosure check`.
#[derive(Args)]
#[command(after_help = "\
Findings go to stderr, what was understood to stdout, with inputs and outputs under the names that port declarations give.
Bodies that nothing holds are found too; nothing is factored, so that a large deck takes seconds.")]
pub struct CheckArgs {
    /// The deck.
    deck: PathBuf,
    /// What keywords mean where codes disagree.
    #[arg(long, value_enum, default_value = "abaqus")]
    dialect: DialectArg,
    /// Names and units of ports [default: DECKNAME.ports.toml or ports.toml beside the deck, if there is one].
    #[arg(long, value_name = "FILE")]
    ports: Option<PathBuf>,
}

/// Runs the verb.
pub fn run(arguments: CheckArgs) -> Exit {
    match examine(&arguments).and_then(|text| print(&text)) {
        Ok(()) => Exit::Done,
        Err(exit) => exit,
    }
}

/// Reports every finding and returns what was understood.
fn examine(arguments: &CheckArgs) -> Result<String, Exit> {
    let ports_toml = read_ports(arguments.ports.as_deref(), &arguments.deck);
    let opened = open_deck(&arguments.deck, arguments.dialect.into())?;
    let ports_toml = ports_toml?;
    let mut diagnostics = opened.diagnostics;
    let mut text = deck::summary(&opened.model);
    let mut found = PreparedModel::examine(&opened.model);
    let ports = port::ports_of(&opened.model, ports_toml.as_deref()).unwrap_or_else(|findings| {
        found.extend(findings);
        PortList::default()
    });
    report(&found);
    diagnostics.extend(found);
    complain(&count(&arguments.deck, &diagnostics));
    if diagnostics.iter().any(Diagnostic::is_error) {
        return Err(Exit::InputWrong);
    }
    list(&mut text, &ports);
    Ok(text)
}

/// The ports of the deck, by their names on the command line, on the wire and in an FMU.
fn list(text: &mut String, ports: &PortList) {
    let of_kind = |kind: &'static str, ports: &[Port]| -> String {
        let unit = |p: &Port| p.unit.as_ref().map_or_else(String::new, |u| format!(" [{u}]"));
        ports.iter().map(|p| format!("{kind:<14}{}: {}{}\n", p.name, p.description, unit(p))).collect()
    };
    text.push_str(&of_kind("input", &ports.inputs));
    if ports.inputs.is_empty() {
        text.push_str(&format!("{:<14}none; {WHAT_BECOMES_AN_INPUT}\n", "inputs"));
    }
    text.push_str(&of_kind("output", &ports.outputs));
}
