//! `overclosure pack`: a deck, or a pressure-overclosure law, into an FMU.

use std::path::{Path, PathBuf};

use clap::{ArgGroup, Args, ValueEnum};
use overclosure_packer::{
    Carried, DeckRequest, LIBRARY_VARIABLE, PackError, PackReport, find_library, pack_deck, pack_law,
};

use super::open::{WHAT_BECOMES_AN_INPUT, count, read_ports, report};
use super::{DialectArg, Exit, PathArg, complain};

/// Arguments of `overclosure pack`.
#[derive(Args)]
#[command(
    group = ArgGroup::new("content").required(true),
    after_help = "\
The FMU is tried before it is reported: an importer loads it, steps it, saves and restores its state, and every output is
compared with the engine. If anything differs, the exit code is 1 and no file is left.

The FMU library is looked for beside the executable, then in ../lib/overclosure seen from it, then where the environment
variable OVERCLOSURE_FMU_LIB says."
)]
pub struct PackArgs {
    /// The deck; files that it includes are packed with it.
    #[arg(group = "content")]
    deck: Option<PathBuf>,
    /// Pack a pressure-overclosure law instead of a deck.
    #[arg(long, group = "content", conflicts_with_all = ["ports", "dialect", "path", "with_prepared", "backend"])]
    law: bool,
    /// The FMU to write; an existing file is replaced.
    #[arg(short, long, value_name = "FILE.fmu")]
    output: PathBuf,
    /// Names and units of ports [default: DECKNAME.ports.toml or ports.toml beside the deck, if there is one].
    #[arg(long, value_name = "PORTS.toml")]
    ports: Option<PathBuf>,
    /// What keywords mean where codes disagree.
    #[arg(long, value_enum, default_value = "abaqus")]
    dialect: DialectArg,
    /// Solver path.
    #[arg(long, value_enum, default_value = "auto")]
    path: PathArg,
    /// Puts the prepared model into the FMU: large, but its instances start at once.
    #[arg(long)]
    with_prepared: bool,
    /// Where the solver is.
    #[arg(long, value_enum, default_value = "embedded")]
    backend: BackendArg,
}

/// `--backend`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum BackendArg {
    /// Inside the FMU.
    Embedded,
    /// In a daemon; not available in this version.
    Attached,
}

/// Runs the verb.
pub fn run(arguments: PackArgs) -> Exit {
    if arguments.backend == BackendArg::Attached {
        complain(
            "error: --backend attached is not available in this version; \
             --backend embedded puts the solver into the FMU",
        );
        return Exit::InputWrong;
    }
    let library = match library() {
        Ok(library) => library,
        Err(exit) => return exit,
    };
    let output = arguments.output;
    let packed = match &arguments.deck {
        None => pack_law(&library, &output),
        Some(deck) => {
            let ports = match read_ports(arguments.ports.as_deref(), deck) {
                Ok(ports) => ports,
                Err(exit) => return exit,
            };
            pack_deck(&DeckRequest {
                deck: deck.clone(),
                output: output.clone(),
                ports,
                dialect: arguments.dialect.into(),
                path: arguments.path.into(),
                carried: if arguments.with_prepared { Carried::Prepared } else { Carried::Deck },
                library,
            })
        }
    };
    match packed {
        Ok(packed) => {
            if packed.inputs == 0 {
                complain(&format!("note: the FMU has no inputs; {WHAT_BECOMES_AN_INPUT}"));
            }
            tell(&output, &packed);
            Exit::Done
        }
        Err(error) => refuse(arguments.deck.as_deref(), &error),
    }
}

fn library() -> Result<PathBuf, Exit> {
    let executable = std::env::current_exe().map_err(|error| {
        complain(&format!("error: cannot tell where this executable is: {error}"));
        Exit::OurFailure
    })?;
    let named = std::env::var_os(LIBRARY_VARIABLE).map(PathBuf::from);
    find_library(&executable, named.as_deref()).map_err(|places| {
        let places = places.join("\n  ");
        complain(&format!("error: the FMU library is at none of these places:\n  {places}"));
        Exit::OurFailure
    })
}

fn tell(output: &Path, packed: &PackReport) {
    report(&packed.warnings);
    for note in &packed.notes {
        complain(&format!("note: {note}"));
    }
    complain(&format!(
        "{}: {} inputs, {} outputs, GUID {}; tried: steps, saved states and reset agree with the engine bit for bit",
        output.display(),
        packed.inputs,
        packed.outputs,
        packed.guid
    ));
}

fn refuse(deck: Option<&Path>, error: &PackError) -> Exit {
    match error {
        PackError::Deck(findings) => {
            report(findings);
            complain(&count(deck.unwrap_or(Path::new("deck")), findings));
            Exit::InputWrong
        }
        PackError::Input { .. } | PackError::Inline(_) => {
            complain(&format!("error: {error}"));
            Exit::InputWrong
        }
        PackError::Preload { .. } => {
            complain(&format!("error: {error}"));
            Exit::NotConverged
        }
        PackError::Library { .. } | PackError::Write { .. } | PackError::Trial(_) => {
            complain(&format!("error: {error}"));
            Exit::OurFailure
        }
    }
}
