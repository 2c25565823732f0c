//! Findings while a deck is read: collected with their place, capped by kind, sorted at the end.

use std::panic::Location;

use rustc_hash::{FxHashMap, FxHasher};
use std::hash::Hasher;

use crate::diagnostic::{Diagnostic, Severity};

use super::lex::nearest;
use super::source::SourceMap;

/// Findings of one kind that are listed singly; further ones are counted.
pub const REPEATS_MAX: usize = 20;

/// Findings that are listed at all; further ones are counted.
pub const FINDINGS_MAX: usize = 1000;

/// Misspelt words for which a likely one is searched.
const SUGGESTIONS_MAX: usize = 100;

/// Physical line of the deck, counted over all files in reading order. [`SourceMap`] knows file and line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct At(pub u32);

impl At {
    /// The deck as a whole; sorts behind every line.
    pub const DECK: At = At(u32::MAX);
}

struct Item {
    at: At,
    severity: Severity,
    keyword: String,
    message: String,
    remedy: String,
}

#[derive(Default)]
struct Kind {
    count: usize,
    /// Position in `items` of the line that counts what is beyond [`REPEATS_MAX`].
    overflow: Option<usize>,
}

/// Collects findings. Two findings are of one kind when the same line of the reader reports them for the same keyword.
#[derive(Default)]
pub struct Report {
    items: Vec<Item>,
    kinds: FxHashMap<(u64, u32, u32), Kind>,
    errors: usize,
    /// Findings beyond [`FINDINGS_MAX`], and whether an error is among them.
    unlisted: (usize, bool),
    suggestions: usize,
}

impl Report {
    /// A finding that stops the deck.
    #[track_caller]
    pub fn error(&mut self, at: At, keyword: &str, message: impl Into<String>, remedy: impl Into<String>) {
        self.push(Severity::Error, at, keyword, message.into(), remedy.into());
    }

    /// A finding that leaves the answer standing.
    #[track_caller]
    pub fn warning(&mut self, at: At, keyword: &str, message: impl Into<String>, remedy: impl Into<String>) {
        self.push(Severity::Warning, at, keyword, message.into(), remedy.into());
    }

    /// A finding of a severity that a table decides.
    #[track_caller]
    pub fn push(&mut self, severity: Severity, at: At, keyword: &str, message: String, remedy: String) {
        if severity == Severity::Error {
            self.errors += 1;
        }
        if self.items.len() >= FINDINGS_MAX {
            self.unlisted.0 += 1;
            self.unlisted.1 |= severity == Severity::Error;
            return;
        }
        let caller = Location::caller();
        let mut hasher = FxHasher::default();
        hasher.write(caller.file().as_bytes());
        hasher.write(keyword.as_bytes());
        hasher.write_u8(u8::from(severity == Severity::Error));
        let kind = self.kinds.entry((hasher.finish(), caller.line(), caller.column())).or_default();
        kind.count += 1;
        if kind.count <= REPEATS_MAX {
            self.items.push(Item { at, severity, keyword: keyword.into(), message, remedy });
            return;
        }
        let more = kind.count - REPEATS_MAX;
        let findings = if more == 1 { "finding" } else { "findings" };
        let message = format!("{more} more {findings} of this kind from here on, not listed");
        match kind.overflow {
            Some(position) => self.items[position].message = message,
            None => {
                kind.overflow = Some(self.items.len());
                self.items.push(Item { at, severity, keyword: keyword.into(), message, remedy: String::new() });
            }
        }
    }

    /// Whether a finding stops the deck.
    pub fn has_errors(&self) -> bool {
        self.errors > 0
    }

    /// The candidate most like a misspelt word, if one is near. After many searches none is found: the first ones help.
    pub fn suggest<'c>(&mut self, word: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
        self.suggestions += 1;
        if self.suggestions > SUGGESTIONS_MAX {
            return None;
        }
        nearest(word, candidates)
    }

    /// Every finding, in the order of the deck; findings about the deck as a whole come last.
    pub fn finish(mut self, map: &SourceMap) -> Vec<Diagnostic> {
        if self.unlisted.0 > 0 {
            let severity = if self.unlisted.1 { Severity::Error } else { Severity::Warning };
            let message = format!("{} more findings are not listed", self.unlisted.0);
            let remedy = "mend those that are".to_string();
            self.items.push(Item { at: At::DECK, severity, keyword: String::new(), message, remedy });
        }
        self.items.sort_by_key(|item| item.at);
        let diagnostic = |item: Item| Diagnostic {
            severity: item.severity,
            place: map.place(item.at),
            keyword: item.keyword,
            message: item.message,
            remedy: item.remedy,
        };
        self.items.into_iter().map(diagnostic).collect()
    }
}

/// Text of the deck for a message: one line, no control characters, at most 40 characters.
pub fn excerpt(text: &[u8]) -> String {
    const CHARACTERS_MAX: usize = 40;
    let text = String::from_utf8_lossy(&text[..text.len().min(4 * CHARACTERS_MAX)]);
    let mut short: String =
        text.chars().take(CHARACTERS_MAX).map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect();
    if text.chars().count() > CHARACTERS_MAX {
        short.push('…');
    }
    short
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeated_findings_are_counted_beyond_the_cap() {
        let mut report = Report::default();
        for line in 1..=25 {
            report.error(At(line), "*NODE", "bad", "mend it");
        }
        report.warning(At(3), "*STEP", "other", "");
        let found = report.finish(&SourceMap::default());
        assert_eq!(found.len(), REPEATS_MAX + 2);
        assert_eq!(found[3].message, "other");
        assert!(found.last().is_some_and(|d| d.message.starts_with("5 more findings")));
    }

    #[test]
    fn the_list_of_findings_is_bounded() {
        let mut report = Report::default();
        for line in 1..=5000 {
            report.error(At(line), &format!("*{line}"), "bad", "mend it");
        }
        let found = report.finish(&SourceMap::default());
        assert_eq!(found.len(), FINDINGS_MAX + 1);
        assert_eq!(found[FINDINGS_MAX].message, "4000 more findings are not listed");
    }

    #[test]
    fn excerpts_are_short_and_printable() {
        assert_eq!(excerpt(b"ab\x07c"), "ab\u{fffd}c");
        assert_eq!(excerpt(&[b'x'; 500]).chars().count(), 41);
    }
}
