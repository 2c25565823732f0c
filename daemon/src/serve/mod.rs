//! `overclosure serve`: the daemon.

use clap::Args;

use crate::cli::Exit;

/// Arguments of `overclosure serve`.
#[derive(Args)]
pub struct ServeArgs {}

/// Runs the verb.
pub fn run(arguments: ServeArgs) -> Exit {
    let _ = arguments;
    todo!()
}
