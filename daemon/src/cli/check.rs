//! `overclosure check`: reads a deck and reports what it found.

use std::path::PathBuf;

use clap::Args;

use super::open::{count, open_deck};
use super::{DialectArg, Exit, complain};

/// Arguments of `overclosure check`.
#[derive(Args)]
pub struct CheckArgs {
    /// The deck.
    deck: PathBuf,
    /// What keywords mean where codes disagree.
    #[arg(long, value_enum, default_value = "abaqus")]
    dialect: DialectArg,
}

/// Runs the verb.
pub fn run(arguments: CheckArgs) -> Exit {
    match open_deck(&arguments.deck, arguments.dialect.into()) {
        Ok(opened) => {
            complain(&count(&arguments.deck, &opened.diagnostics));
            Exit::Done
        }
        Err(exit) => exit,
    }
}
