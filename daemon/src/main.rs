//! The `overclosure` binary: solve decks, serve sessions, pack FMUs.

#![forbid(unsafe_code)]

mod cli;
mod serve;

use std::io::IsTerminal;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use tracing_subscriber::EnvFilter;

use cli::Exit;

/// Contact mechanics that other programs can talk to.
#[derive(Parser)]
#[command(name = "overclosure", version, max_term_width = 100, after_help = EXIT_CODES)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

const EXIT_CODES: &str = "\
Exit codes: 0 done; 1 a failure of this program or its surroundings; 2 the input is wrong;
3 not converged or stopped early, with the results up to then kept.
OVERCLOSURE_LOG sets the log on stderr, e.g. info or overclosure=debug.";

#[derive(Subcommand)]
enum Command {
    /// Solves a deck and writes results.
    Run(cli::run::RunArgs),
    /// Reads a deck, reports every finding, solves nothing.
    Check(cli::check::CheckArgs),
    /// Evaluates a pressure-overclosure relationship: CSV on stdout.
    Law(cli::law::LawArgs),
    /// Packs a deck into an FMI 2.0 co-simulation FMU.
    Pack(cli::pack::PackArgs),
    /// Serves sessions over zenoh until it is told to stop.
    Serve(serve::ServeArgs),
    #[command(flatten)]
    Remote(cli::remote::RemoteCommand),
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    start_log(&arguments.command);
    let exit: Exit = match arguments.command {
        Command::Run(arguments) => cli::run::run(arguments),
        Command::Check(arguments) => cli::check::run(arguments),
        Command::Law(arguments) => cli::law::run(arguments),
        Command::Pack(arguments) => cli::pack::run(arguments),
        Command::Serve(arguments) => serve::run(arguments),
        Command::Remote(command) => cli::remote::run(command),
    };
    exit.into()
}

/// Log on stderr. A filter that cannot be read is said, and the default taken.
fn start_log(command: &Command) {
    let default = match command {
        // The two modules left out warn about settings that are meant, and say again what the verb says itself.
        Command::Serve(_) => "info,zenoh=warn,zenoh::net::routing::hat=error,zenoh::net::runtime::orchestrator=off",
        Command::Run(_) | Command::Check(_) | Command::Law(_) | Command::Pack(_) | Command::Remote(_) => {
            "error,overclosure=warn"
        }
    };
    let filter = match std::env::var("OVERCLOSURE_LOG") {
        Err(_) => EnvFilter::new(default),
        Ok(text) => EnvFilter::try_new(&text).unwrap_or_else(|error| {
            cli::complain(&format!("OVERCLOSURE_LOG={text}: {error}; taking {default}"));
            EnvFilter::new(default)
        }),
    };
    // Colours are for people: not in a file, and not for those who set NO_COLOR to anything.
    let colour = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|text| text.is_empty());
    tracing_subscriber::fmt().with_env_filter(filter).with_ansi(colour).with_writer(std::io::stderr).init();
}
