//! The deck reader: Abaqus-format text to a validated [`Model`].
//!
//! Reading has two passes. The first turns lines into cards and puts nodes, elements and members of sets into compact
//! arrays as they come, so that the text is never held; the second builds the model from the cards, so that references
//! may point forwards. Neither stops at a fault: every finding is in [`Reading::diagnostics`].

mod availability;
mod body_table;
mod build;
mod card;
mod collect;
mod contact_table;
mod data;
mod dialect;
mod dynamic_table;
mod facts;
mod general_table;
mod keywords;
mod lex;
mod members;
mod model_table;
mod other_table;
mod report;
mod rules;
mod source;
mod step_table;
mod summary;

use std::io;
use std::path::Path;

use crate::diagnostic::Diagnostic;
use crate::model::{Dialect, Model};

pub use availability::{Blame, Citation, Confidence, FEATURES, Family, Feature, Offer};
pub use dialect::{Difference, differences};
pub use keywords::{DataLines, Effect, Keyword, Parameter, ParameterValue, Placement, keywords};
pub use rules::{RULES, Rule};
pub use summary::summary;

use report::{At, Report};
use source::{Source, SourceMap};

/// What reading a deck gave.
#[derive(Debug)]
pub struct Reading {
    /// The model, if no finding is an error.
    pub model: Option<Model>,
    /// Every finding, in the order of the deck.
    pub diagnostics: Vec<Diagnostic>,
}

/// Reads a deck from a file; `*INCLUDE` is resolved against the folder of the including file.
///
/// An error means that the file cannot be read; what is wrong within it is in the diagnostics.
pub fn read_file(path: &Path, dialect: Dialect) -> io::Result<Reading> {
    let mut source = Source::open(path)?;
    let mut report = Report::default();
    let deck = collect::collect(&mut source, &mut report)?;
    Ok(finish(deck, dialect, source.into_map(), report))
}

/// Reads a deck from text; `*INCLUDE` is refused with a diagnostic (text sent over a wire has no folder).
pub fn read_text(text: &str, dialect: Dialect) -> Reading {
    let mut source = Source::text(text);
    let mut report = Report::default();
    match collect::collect(&mut source, &mut report) {
        Ok(deck) => finish(deck, dialect, source.into_map(), report),
        Err(error) => {
            report.error(At::DECK, "", format!("the deck cannot be read: {error}"), "send the deck again");
            Reading { model: None, diagnostics: report.finish(&source.into_map()) }
        }
    }
}

fn finish(deck: card::Deck, dialect: Dialect, map: SourceMap, mut report: Report) -> Reading {
    let model = build::build(deck, dialect, &map, &mut report);
    let model = (!report.has_errors()).then_some(model);
    Reading { model, diagnostics: report.finish(&map) }
}
