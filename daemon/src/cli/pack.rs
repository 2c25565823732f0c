//! `overclosure pack`: a deck into an FMU.

use clap::Args;

use super::Exit;

/// Arguments of `overclosure pack`.
#[derive(Args)]
pub struct PackArgs {}

/// Runs the verb.
pub fn run(arguments: PackArgs) -> Exit {
    let _ = arguments;
    todo!()
}
