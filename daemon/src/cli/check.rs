//! `overclosure check`: reads a deck, reports what it found and what it understood. Solves nothing.

use std::path::PathBuf;

use clap::Args;
use overclosure::deck;
use overclosure::diagnostic::Diagnostic;
use overclosure::model::Model;
use overclosure::port::{self, Port, PortList};
use overclosure::simulation::{PathChoice, PrepareOptions, PreparedModel};

use super::open::{WHAT_BECOMES_AN_INPUT, count, open_deck, read_ports, report};
use super::{DialectArg, Exit, complain, print};

/// Arguments of `overclosure check`.
#[derive(Args)]
#[command(after_help = "\
Findings go to stderr, what was understood to stdout. Bodies that nothing holds are found too.
Where port declarations apply, the deck is prepared as for a run, and outputs are listed with the inputs.")]
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
    let (ports, found) = match ports_toml {
        None => {
            let inputs = port::inputs_of(&opened.model);
            (PortList { inputs, outputs: Vec::new() }, PreparedModel::examine(&opened.model))
        }
        Some(_) => declared(opened.model, ports_toml),
    };
    report(&found);
    diagnostics.extend(found);
    complain(&count(&arguments.deck, &diagnostics));
    if diagnostics.iter().any(Diagnostic::is_error) {
        return Err(Exit::InputWrong);
    }
    list(&mut text, &ports);
    Ok(text)
}

/// Ports under their declared names, and what was found. Declarations speak of outputs, which only preparation knows.
fn declared(model: Model, ports_toml: Option<String>) -> (PortList, Vec<Diagnostic>) {
    let options = PrepareOptions { path: PathChoice::Auto, threads: 1, ports_toml };
    match PreparedModel::prepare(model, &options, &mut |_| {}) {
        Ok(prepared) => (prepared.ports().clone(), prepared.warnings().to_vec()),
        Err(findings) => (PortList::default(), findings),
    }
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
