//! `overclosure run`: solves a deck and writes results.

use std::path::PathBuf;

use clap::Args;

use super::{DialectArg, Exit, PathArg};

/// Arguments of `overclosure run`.
#[derive(Args)]
pub struct RunArgs {
    /// The deck; results are named after it.
    deck: PathBuf,
    /// Where results are written [default: beside the deck].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replaces the magnitude of an input of the last step and keeps its amplitude; may be repeated.
    #[arg(long = "set", value_name = "PORT=VALUE")]
    sets: Vec<String>,
    /// What keywords mean where codes disagree.
    #[arg(long, value_enum, default_value = "abaqus")]
    dialect: DialectArg,
    /// Solver path.
    #[arg(long, value_enum, default_value = "auto")]
    path: PathArg,
    /// Threads; the results do not depend on it.
    #[arg(long, value_name = "N", default_value_t = 1)]
    threads: usize,
    /// Names and units of ports [default: ports.toml beside the deck is NOT read unless given].
    #[arg(long, value_name = "FILE")]
    ports: Option<PathBuf>,
    /// Nothing on the terminal but findings.
    #[arg(long)]
    quiet: bool,
}

/// Runs the verb.
pub fn run(arguments: RunArgs) -> Exit {
    let _ = arguments;
    todo!()
}
