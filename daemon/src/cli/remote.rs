//! Client verbs against a daemon.

use clap::Subcommand;

use super::Exit;

/// Verbs that talk to a daemon.
#[derive(Subcommand)]
pub enum RemoteCommand {
    /// Lists the sessions of a daemon.
    Sessions,
    /// Sets inputs and advances a session.
    Step,
    /// Reads ports or fields of a session.
    Get,
    /// Follows the results of a session.
    Watch,
}

/// Runs the verb.
pub fn run(command: RemoteCommand) -> Exit {
    let _ = command;
    todo!()
}
