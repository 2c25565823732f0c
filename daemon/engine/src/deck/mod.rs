//! The deck reader: Abaqus-format text to a validated [`Model`].

use std::path::Path;

use crate::diagnostic::Diagnostic;
use crate::model::{Dialect, Model};

/// What reading a deck gave.
#[derive(Debug)]
pub struct Reading {
    /// The model, if no finding is an error.
    pub model: Option<Model>,
    /// Every finding, in the order of the deck.
    pub diagnostics: Vec<Diagnostic>,
}

/// Reads a deck from a file; `*INCLUDE` is resolved against its folder.
pub fn read_file(path: &Path, dialect: Dialect) -> std::io::Result<Reading> {
    let _ = (path, dialect);
    todo!()
}

/// Reads a deck from text; `*INCLUDE` is refused with a diagnostic (text sent over a wire has no folder).
pub fn read_text(text: &str, dialect: Dialect) -> Reading {
    let _ = (text, dialect);
    todo!()
}
