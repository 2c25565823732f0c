//! What the analyst reads when an input is wrong: every finding, with its place and its remedy.

use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

use serde::Serialize;

/// How much a finding weighs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The answer stands; the user should know.
    Warning,
    /// The deck cannot be solved as it is written.
    Error,
}

/// Where a finding stands. Cheap to clone: the file name is shared.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// File of the line; `None` for text that came without a file (a deck sent to the daemon).
    pub file: Option<Arc<PathBuf>>,
    /// Line number, counted from 1; 0 when the finding is about the deck as a whole.
    pub line: u32,
}

impl Place {
    /// The deck as a whole.
    pub fn nowhere() -> Self {
        Self { file: None, line: 0 }
    }
}

/// One finding about a deck.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Error or warning.
    pub severity: Severity,
    /// File and line.
    pub place: Place,
    /// Keyword that the line belongs to, with its star, e.g. `*SURFACE BEHAVIOR`; empty when none does.
    pub keyword: String,
    /// What is wrong.
    pub message: String,
    /// What the user can do.
    pub remedy: String,
}

impl Diagnostic {
    /// A finding that stops the deck.
    pub fn error(place: Place, keyword: &str, message: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            place,
            keyword: keyword.into(),
            message: message.into(),
            remedy: remedy.into(),
        }
    }

    /// A finding that leaves the answer standing.
    pub fn warning(place: Place, keyword: &str, message: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(place, keyword, message, remedy) }
    }

    /// Whether this finding stops the deck.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let severity = match self.severity {
            Severity::Warning => "warning",
            Severity::Error => "error",
        };
        if let Some(file) = &self.place.file {
            write!(f, "{}:", file.display())?;
        }
        if self.place.line > 0 {
            if self.place.file.is_none() {
                write!(f, "line ")?;
            }
            write!(f, "{}: ", self.place.line)?;
        } else if self.place.file.is_some() {
            write!(f, " ")?;
        }
        write!(f, "{severity}: ")?;
        if !self.keyword.is_empty() {
            write!(f, "{}: ", self.keyword)?;
        }
        write!(f, "{}", self.message)?;
        if !self.remedy.is_empty() {
            write!(f, "; {}", self.remedy)?;
        }
        Ok(())
    }
}
