//! Data lines that are kept as text until the second pass, and their fields.

use super::card::{Body, Card};
use super::lex::{self, NumberFault, fields};
use super::report::{At, Report, excerpt};

/// Data lines of a card, one behind the other in one string: a deck may have millions of them.
#[derive(Default)]
pub struct Lines {
    text: String,
    /// Place and first byte of each line.
    starts: Vec<(At, usize)>,
}

impl Lines {
    /// Adds a line.
    pub fn push(&mut self, at: At, line: &str) {
        self.starts.push((at, self.text.len()));
        self.text.push_str(line);
    }

    /// A line by its number from 0.
    pub fn get(&self, index: usize) -> Option<DataLine<'_>> {
        let &(at, start) = self.starts.get(index)?;
        let end = self.starts.get(index + 1).map_or(self.text.len(), |&(_, next)| next);
        Some(DataLine { at, text: &self.text[start..end] })
    }

    /// Lines in order.
    pub fn iter(&self) -> impl Iterator<Item = DataLine<'_>> {
        (0..self.starts.len()).filter_map(|index| self.get(index))
    }
}

static NO_LINES: Lines = Lines { text: String::new(), starts: Vec::new() };

impl Card {
    /// Data lines that are kept as text.
    pub fn lines(&self) -> &Lines {
        match &self.body {
            Body::Lines(lines) => lines,
            _ => &NO_LINES,
        }
    }

    /// The first data line.
    pub fn first_line(&self) -> Option<DataLine<'_>> {
        self.lines().get(0)
    }

    /// The only data line of a card; none or more are reported.
    #[track_caller]
    pub fn single_row(&self, what: &str, report: &mut Report) -> Option<Row<'_>> {
        let name = self.keyword.name;
        if let Some(second) = self.lines().get(1) {
            report.error(second.at, name, "a second data line is not read here", format!("write one line: {what}"));
        }
        let first = self.first_line();
        if first.is_none() {
            report.error(self.at, name, "the data line is missing", format!("write one line: {what}"));
        }
        first.map(|line| line.row(name))
    }
}

/// A data line.
#[derive(Clone, Copy)]
pub struct DataLine<'a> {
    /// Where.
    pub at: At,
    /// The line.
    pub text: &'a str,
}

impl<'a> DataLine<'a> {
    /// The line, ready to be read field by field.
    pub fn row(self, keyword: &'static str) -> Row<'a> {
        let text = |field| std::str::from_utf8(field).expect("commas split UTF-8 text into UTF-8 text");
        Row { at: self.at, keyword, fields: fields(self.text.as_bytes()).map(text).collect() }
    }
}

/// Fields of a data line, with the place to complain about.
pub struct Row<'a> {
    /// Where.
    pub at: At,
    /// Keyword of the card.
    pub keyword: &'static str,
    /// Fields without the blanks around them.
    pub fields: Vec<&'a str>,
}

impl<'a> Row<'a> {
    /// A field; empty when it is blank or missing.
    pub fn text(&self, index: usize) -> &'a str {
        self.fields.get(index).copied().unwrap_or("")
    }

    /// A real, or the default for a blank; `None` when it is bad or missing, which is reported.
    #[track_caller]
    pub fn real(&self, index: usize, what: &str, default: Option<f64>, report: &mut Report) -> Option<f64> {
        let text = self.text(index);
        if text.is_empty() {
            if default.is_none() {
                report.error(
                    self.at,
                    self.keyword,
                    format!("{what} is missing"),
                    format!("give it as item {} of the line", index + 1),
                );
            }
            return default;
        }
        let reject = |fault: NumberFault, report: &mut Report| {
            let message = format!("{what}: {} {}", excerpt(text.as_bytes()), fault.text());
            report.error(self.at, self.keyword, message, "write a number such as 1.5e3; commas stand between numbers");
        };
        lex::real(text.as_bytes()).map_err(|fault| reject(fault, report)).ok()
    }

    /// A whole number, or the default for a blank; `None` when it is bad or missing, which is reported.
    #[track_caller]
    pub fn whole(&self, index: usize, what: &str, default: Option<u32>, report: &mut Report) -> Option<u32> {
        let value = self.real(index, what, default.map(f64::from), report)?;
        if value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value) {
            return Some(value as u32);
        }
        let message = format!("{what}: {} is not a whole number", excerpt(self.text(index).as_bytes()));
        report.error(self.at, self.keyword, message, "write a number such as 3");
        None
    }

    /// Complains about fields from `count` on that are not blank.
    #[track_caller]
    pub fn at_most(&self, count: usize, report: &mut Report) {
        let extra = self.fields.iter().skip(count).find(|field| !field.is_empty());
        if let Some(extra) = extra {
            let message = format!("item {} is not read here: {}", self.fields.len(), excerpt(extra.as_bytes()));
            report.error(self.at, self.keyword, message, format!("the line has at most {count} items"));
        }
    }
}
