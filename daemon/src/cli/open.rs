//! Reading a deck for a verb: findings go to stderr, the model to the caller.

use std::path::Path;

use overclosure::deck;
use overclosure::diagnostic::Diagnostic;
use overclosure::model::{Dialect, Model};

use super::{Exit, complain};

/// A deck that can be solved, and what was found on the way.
pub struct OpenedDeck {
    /// The model.
    pub model: Model,
    /// Warnings.
    pub diagnostics: Vec<Diagnostic>,
}

/// Reads a deck and reports every finding on stderr.
pub fn open_deck(path: &Path, dialect: Dialect) -> Result<OpenedDeck, Exit> {
    let reading = deck::read_file(path, dialect).map_err(|error| {
        complain(&format!("error: cannot read {}: {error}", path.display()));
        Exit::InputWrong
    })?;
    report(&reading.diagnostics);
    match reading.model {
        Some(model) => Ok(OpenedDeck { model, diagnostics: reading.diagnostics }),
        None => {
            complain(&count(path, &reading.diagnostics));
            Err(Exit::InputWrong)
        }
    }
}

/// Text of the port declarations: the named file, else `ports.toml` beside the deck, else none.
pub fn read_ports(named: Option<&Path>, deck: &Path) -> Result<Option<String>, Exit> {
    let path = match named {
        Some(path) => path.to_owned(),
        None => {
            let beside = deck.with_file_name("ports.toml");
            if !beside.is_file() {
                return Ok(None);
            }
            beside
        }
    };
    std::fs::read_to_string(&path).map(Some).map_err(|error| {
        complain(&format!("error: cannot read {}: {error}", path.display()));
        Exit::InputWrong
    })
}

/// Every finding on stderr, one per line.
pub fn report(diagnostics: &[Diagnostic]) {
    let lines: Vec<String> = diagnostics.iter().map(ToString::to_string).collect();
    if !lines.is_empty() {
        complain(&lines.join("\n"));
    }
}

/// `deck.inp: 2 errors, 1 warning`.
pub fn count(path: &Path, diagnostics: &[Diagnostic]) -> String {
    let errors = diagnostics.iter().filter(|d| d.is_error()).count();
    let warnings = diagnostics.len() - errors;
    let plural = |n: usize, word: &str| format!("{n} {word}{}", if n == 1 { "" } else { "s" });
    format!("{}: {}, {}", path.display(), plural(errors, "error"), plural(warnings, "warning"))
}
