//! `overclosure check`: reads a deck, reports what it found and what it understood. Solves nothing.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use overclosure::deck;
use overclosure::diagnostic::Diagnostic;
use overclosure::port::{self, Port};
use overclosure::simulation::PreparedModel;

use super::open::{count, open_deck, report};
use super::{DialectArg, Exit, complain, print};

/// Arguments of `overclosure check`.
#[derive(Args)]
#[command(
    after_help = "Findings go to stderr, what was understood to stdout. Bodies that nothing holds are found too."
)]
pub struct CheckArgs {
    /// The deck.
    deck: PathBuf,
    /// What keywords mean where codes disagree.
    #[arg(long, value_enum, default_value = "abaqus")]
    dialect: DialectArg,
}

/// Runs the verb.
pub fn run(arguments: CheckArgs) -> Exit {
    let opened = match open_deck(&arguments.deck, arguments.dialect.into()) {
        Ok(opened) => opened,
        Err(exit) => return exit,
    };
    let mut diagnostics = opened.diagnostics;
    let found = PreparedModel::examine(&opened.model);
    report(&found);
    diagnostics.extend(found);
    complain(&count(&arguments.deck, &diagnostics));
    if diagnostics.iter().any(Diagnostic::is_error) {
        return Exit::InputWrong;
    }
    let mut text = deck::summary(&opened.model);
    list(&mut text, &port::inputs_of(&opened.model));
    match print(&text) {
        Ok(()) => Exit::Done,
        Err(exit) => exit,
    }
}

/// The inputs of the deck, by their names on the command line, on the wire and in an FMU.
fn list(text: &mut String, inputs: &[Port]) {
    for port in inputs {
        // Writing to a string does not fail.
        let _ = writeln!(text, "{:<14}{}: {}", "input", port.name, port.description);
    }
    if inputs.is_empty() {
        text.push_str("inputs        none\n");
    }
}
