//! Reading a deck for a verb: findings go to stderr, the model to the caller.

use std::path::{Path, PathBuf};

use overclosure::deck;
use overclosure::diagnostic::Diagnostic;
use overclosure::model::{Dialect, Model};

use super::{Exit, complain};

/// Said where a deck has no inputs.
pub const WHAT_BECOMES_AN_INPUT: &str =
    "a *BOUNDARY, *CLOAD, *DLOAD or *DSLOAD line of the last *STEP becomes one when its magnitude is not zero";

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

/// Text of the port declarations: the named file, else `DECKNAME.ports.toml` or `ports.toml` beside the deck, the first
/// that is there, else none. A file that nobody named is told on stderr.
pub fn read_ports(named: Option<&Path>, deck: &Path) -> Result<Option<String>, Exit> {
    let path = match named {
        Some(path) => path.to_owned(),
        None => match ports_beside(deck) {
            None => return Ok(None),
            Some(path) => {
                complain(&format!("ports: names and units from {}", path.display()));
                path
            }
        },
    };
    std::fs::read_to_string(&path).map(Some).map_err(|error| {
        complain(&format!("error: cannot read {}: {error}", path.display()));
        Exit::InputWrong
    })
}

/// The declarations that apply to a deck unless others are named: those for this deck go before those for its folder.
fn ports_beside(deck: &Path) -> Option<PathBuf> {
    [deck.with_extension("ports.toml"), deck.with_file_name("ports.toml")].into_iter().find(|path| path.is_file())
}

/// Every finding on stderr, one per line.
pub fn report(diagnostics: &[Diagnostic]) {
    let lines: Vec<String> = diagnostics.iter().map(ToString::to_string).collect();
    if !lines.is_empty() {
        complain(&lines.join("\n"));
    }
}

/// Every finding, and their number: the deck cannot be taken.
pub fn refuse(path: &Path, findings: &[Diagnostic]) -> Exit {
    report(findings);
    complain(&count(path, findings));
    Exit::InputWrong
}

/// `deck.inp: 2 errors, 1 warning`.
pub fn count(path: &Path, diagnostics: &[Diagnostic]) -> String {
    let errors = diagnostics.iter().filter(|d| d.is_error()).count();
    let warnings = diagnostics.len() - errors;
    let plural = |n: usize, word: &str| format!("{n} {word}{}", if n == 1 { "" } else { "s" });
    format!("{}: {}, {}", path.display(), plural(errors, "error"), plural(warnings, "warning"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn declarations_of_the_deck_go_before_those_of_its_folder() {
        let folder = tempfile::tempdir().expect("folder");
        let deck = folder.path().join("punch.v2.inp");
        assert_eq!(ports_beside(&deck), None);
        let shared = folder.path().join("ports.toml");
        std::fs::write(&shared, "").expect("write");
        assert_eq!(ports_beside(&deck).as_ref(), Some(&shared));
        let own = folder.path().join("punch.v2.ports.toml");
        std::fs::write(&own, "").expect("write");
        assert_eq!(ports_beside(&deck).as_ref(), Some(&own));
        assert_eq!(ports_beside(&folder.path().join("hertz.inp")).as_ref(), Some(&shared));
    }
}
