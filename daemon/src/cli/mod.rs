//! Command line verbs: one file each. Every verb returns an [`Exit`] and has told the user why.

pub mod check;
pub mod law;
pub mod memory;
pub mod open;
pub mod pack;
pub mod remote;
pub mod run;

mod clock;
mod increments;
mod interrupt;
mod monitor;
mod pace;
mod progress;
mod restart;
mod settings;

use std::io::Write;
use std::process::ExitCode;

use clap::ValueEnum;
use overclosure::model::Dialect;
use overclosure::simulation::PathChoice;

/// How a verb ended, as the exit code tells it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// 0.
    Done,
    /// 1: a failure of this program or of what it stands on: disk, network.
    OurFailure,
    /// 2: the input is wrong; every finding has been reported.
    InputWrong,
    /// 3: not converged, or stopped before the end; results up to then are kept.
    NotConverged,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(match exit {
            Exit::Done => 0,
            Exit::OurFailure => 1,
            Exit::InputWrong => 2,
            Exit::NotConverged => 3,
        })
    }
}

/// One line or more on stderr. A stderr that nobody reads is no reason to stop.
pub fn complain(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

/// Text on stdout. A reader that went away (`| head`) ends the verb quietly; another failure is ours.
pub fn print(text: &str) -> Result<(), Exit> {
    let mut stdout = std::io::stdout().lock();
    stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()).map_err(|error| closed(&error))
}

/// What a failed write to stdout means.
pub fn closed(error: &std::io::Error) -> Exit {
    if error.kind() == std::io::ErrorKind::BrokenPipe {
        return Exit::Done;
    }
    complain(&format!("error: cannot write to standard output: {error}"));
    Exit::OurFailure
}

/// `--dialect`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum DialectArg {
    /// Decks mean what Abaqus means.
    Abaqus,
    /// Decks mean what CalculiX means, where that changes the answer.
    Calculix,
}

impl From<DialectArg> for Dialect {
    fn from(dialect: DialectArg) -> Self {
        match dialect {
            DialectArg::Abaqus => Self::Abaqus,
            DialectArg::Calculix => Self::Calculix,
        }
    }
}

/// `--path`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum PathArg {
    /// By estimated cost.
    Auto,
    /// Condensed onto contact.
    Dense,
    /// Newton on the sparse system.
    Sparse,
}

impl From<PathArg> for PathChoice {
    fn from(path: PathArg) -> Self {
        match path {
            PathArg::Auto => Self::Auto,
            PathArg::Dense => Self::Dense,
            PathArg::Sparse => Self::Sparse,
        }
    }
}
