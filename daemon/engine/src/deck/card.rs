//! Cards: a keyword line with its parameters and what stands under it.

use std::ops::Range;

use rustc_hash::FxHashSet;

use super::data::Lines;
use super::keywords::{Effect, Found, Keyword, Parameter, ParameterValue, find, find_parameter, keywords};
use super::lex::{fields, key, unquoted};
use super::report::{At, Report, excerpt};
use crate::diagnostic::Severity;
use crate::model::ElementKind;

/// Everything that the lines of a deck say, before any reference is followed.
#[derive(Default)]
pub struct Deck {
    /// Lines of `*HEADING`.
    pub heading: String,
    /// Nodes of every `*NODE`, in order.
    pub nodes: NodeTable,
    /// Elements of every `*ELEMENT`, in order.
    pub elements: ElementTable,
    /// Keyword lines in order.
    pub cards: Vec<Card>,
    /// Labels whose lines were refused: further complaints about them would say nothing new.
    pub refused_nodes: FxHashSet<u32>,
    /// The same for elements.
    pub refused_elements: FxHashSet<u32>,
    /// Something that may have defined nodes, elements or names was not read, so what seems to be missing may not be.
    pub incomplete: bool,
    /// Reading stopped before the end of the input: what follows is unknown.
    pub stopped: bool,
}

/// Nodes as written.
#[derive(Default)]
pub struct NodeTable {
    /// Numbers.
    pub labels: Vec<u32>,
    /// Coordinates.
    pub coordinates: Vec<[f64; 3]>,
    /// Lines.
    pub at: Vec<At>,
}

/// Elements as written.
#[derive(Default)]
pub struct ElementTable {
    /// Numbers.
    pub labels: Vec<u32>,
    /// Types as written; the dialect is not looked at yet.
    pub kinds: Vec<ElementKind>,
    /// Labels of the nodes of all elements, as many for each as its type has.
    pub nodes: Vec<u32>,
    /// Lines.
    pub at: Vec<At>,
}

/// A keyword line and what stands under it.
pub struct Card {
    /// The keyword.
    pub keyword: &'static Keyword,
    /// Line of the keyword.
    pub at: At,
    /// Parameters that are read.
    pub parameters: Parameters,
    /// Data lines.
    pub body: Body,
    /// A fault was found on the keyword line: what it defines is not to be relied on.
    pub faulty: bool,
}

/// Data lines of a card.
pub enum Body {
    /// None, or none that is kept.
    Nothing,
    /// Lines, kept as text.
    Lines(Lines),
    /// Rows of [`Deck::nodes`].
    Nodes(Range<u32>),
    /// Rows of [`Deck::elements`].
    Elements(Range<u32>),
    /// Members of a set or of a node-based surface.
    Members(Members),
    /// Faces of a surface.
    Faces(Faces),
}

/// Members of a set, in no particular order.
#[derive(Default)]
pub struct Members {
    /// Single labels.
    pub labels: Vec<(u32, At)>,
    /// `first, last, increment` of GENERATE.
    pub ranges: Vec<([u32; 3], At)>,
    /// Other sets.
    pub names: Vec<(Box<str>, At)>,
}

/// Members of an element-based surface; face 1 to 6, or 0 for all free faces.
#[derive(Default)]
pub struct Faces {
    /// Element label and face.
    pub labels: Vec<(u32, u8, At)>,
    /// Element set and face.
    pub names: Vec<(Box<str>, u8, At)>,
}

/// Parameters of a card that are read, or refused.
#[derive(Default)]
pub struct Parameters(Vec<(&'static str, Option<String>)>);

impl Parameters {
    /// Whether the parameter is given.
    pub fn has(&self, name: &str) -> bool {
        self.0.iter().any(|(known, _)| *known == name)
    }

    /// Value of the parameter.
    pub fn value(&self, name: &str) -> Option<&str> {
        self.0.iter().find(|(known, _)| *known == name).and_then(|(_, value)| value.as_deref())
    }

    /// Value in upper case without blanks, empty when there is none: for lists of words.
    pub fn word(&self, name: &str) -> String {
        self.value(name).map(key).unwrap_or_default()
    }
}

/// What a keyword line says.
pub struct Header {
    /// The keyword.
    pub keyword: &'static Keyword,
    /// Parameters that are read.
    pub parameters: Parameters,
    /// A fault was reported.
    pub faulty: bool,
}

/// Reads a keyword line, its continuations joined. `None` when the keyword is unknown, which is reported.
pub fn parse_header(line: &str, at: At, report: &mut Report) -> Option<Header> {
    let text = |field| std::str::from_utf8(field).expect("commas split UTF-8 text into UTF-8 text");
    let mut parts = fields(line.as_bytes()).map(text);
    let word = parts.next().unwrap_or("");
    let keyword = match find(word) {
        Found::Exact(keyword) => keyword,
        Found::Abbreviated(keyword) => {
            let message = format!("{} is read as {}", excerpt(word.as_bytes()), keyword.name);
            report.warning(at, keyword.name, message, "spell the keyword out");
            keyword
        }
        Found::Unknown => {
            unknown_keyword(word, at, report);
            return None;
        }
    };
    match keyword.effect {
        Effect::Refused(remedy) => {
            report.error(at, keyword.name, "the keyword is not supported and would change the answer", remedy);
        }
        Effect::Ignored(why) => report.warning(at, keyword.name, format!("ignored: {why}"), ""),
        Effect::Read | Effect::Silent => {}
    }
    let mut header = Header { keyword, parameters: Parameters::default(), faulty: false };
    if !keyword.is_read() {
        header.note(parts);
        return Some(header);
    }
    for part in parts.filter(|part| !part.is_empty()) {
        let (name, value) = match part.split_once('=') {
            Some((name, value)) => (name.trim(), Some(value.trim())),
            None => (part, None),
        };
        match find_parameter(keyword, name) {
            Some(parameter) => header.take(parameter, value, at, report),
            None => header.unknown_parameter(name, at, report),
        }
    }
    for parameter in keyword.parameters.iter().filter(|parameter| parameter.required) {
        if !header.parameters.has(parameter.name) {
            header.faulty = true;
            report.error(
                at,
                keyword.name,
                format!("parameter {} is missing", parameter.name),
                format!("write {}, {}=…", keyword.name, parameter.name),
            );
        }
    }
    Some(header)
}

fn unknown_keyword(word: &str, at: At, report: &mut Report) {
    let shown = excerpt(word.as_bytes());
    let message = match key(word).as_str() {
        "*" => "the keyword behind the star is missing".to_string(),
        _ => "there is no such keyword".to_string(),
    };
    let remedy = match report.suggest(word, keywords().map(|keyword| keyword.name)) {
        Some(name) => format!("did you mean {name}?"),
        None => "a comment begins with two stars".to_string(),
    };
    report.error(at, &shown, message, remedy);
}

impl Header {
    /// Keeps the parameters of a refused keyword that combinations are judged by; the others do not matter any more.
    fn note<'p>(&mut self, parts: impl Iterator<Item = &'p str>) {
        for part in parts {
            let (name, value) = part.split_once('=').map_or((part, None), |(name, value)| (name, Some(value)));
            if let Some(parameter) = find_parameter(self.keyword, name.trim()) {
                self.parameters.0.push((parameter.name, value.map(|value| unquoted(value.trim()).to_string())));
            }
        }
    }

    fn unknown_parameter(&mut self, name: &str, at: At, report: &mut Report) {
        let remedy = match report.suggest(name, self.keyword.parameters.iter().map(|parameter| parameter.name)) {
            Some(known) => format!("did you mean {known}?"),
            None => "leave it out if the answer does not depend on it".to_string(),
        };
        let message = format!("there is no parameter {}", excerpt(name.as_bytes()));
        let severity = if self.keyword.output_only { Severity::Warning } else { Severity::Error };
        self.faulty |= severity == Severity::Error;
        report.push(severity, at, self.keyword.name, message, remedy);
    }

    fn take(&mut self, parameter: &'static Parameter, value: Option<&str>, at: At, report: &mut Report) {
        let name = parameter.name;
        let mut fault = |message: String, remedy: String| {
            self.faulty = true;
            report.error(at, self.keyword.name, message, remedy);
        };
        let value = value.map(unquoted);
        let effect = match parameter.value {
            ParameterValue::Any if value.is_none_or(str::is_empty) => {
                return fault(format!("parameter {name} has no value"), format!("write {name}=…"));
            }
            ParameterValue::Flag if value.is_some() => {
                return fault(
                    format!("parameter {name} takes no value"),
                    format!("write {name} alone, or leave it out"),
                );
            }
            ParameterValue::OneOf(values) => {
                let word = value.map(key).unwrap_or_default();
                let Some(&(_, effect)) = values.iter().find(|(known, _)| *known == word) else {
                    let read: Vec<_> =
                        values.iter().filter(|(known, effect)| !known.is_empty() && *effect == Effect::Read).collect();
                    let remedy = if read.is_empty() {
                        format!("leave {name} out")
                    } else {
                        format!("choose {}", list_words(&read))
                    };
                    return fault(format!("{name}={} is not known", excerpt(value.unwrap_or("").as_bytes())), remedy);
                };
                effect
            }
            _ => parameter.effect,
        };
        let shown = match value {
            Some(value) if matches!(parameter.value, ParameterValue::OneOf(_)) => {
                format!("{name}={}", excerpt(value.as_bytes()))
            }
            _ => name.to_string(),
        };
        match effect {
            Effect::Refused(remedy) => {
                fault(format!("{shown} is not supported and would change the answer"), remedy.into());
                // Combinations are judged by it all the same.
            }
            Effect::Ignored(why) => {
                return report.warning(at, self.keyword.name, format!("{shown} is ignored: {why}"), "");
            }
            Effect::Silent => return,
            Effect::Read => {}
        }
        let value = value.map(str::to_string);
        let earlier = self.parameters.0.iter().find(|(known, _)| *known == name).map(|(_, earlier)| earlier);
        match earlier {
            Some(earlier) if *earlier != value => {
                fault(format!("parameter {name} is given twice"), "keep one of them".into())
            }
            Some(_) => {}
            None => self.parameters.0.push((name, value)),
        }
    }
}

fn list_words(values: &[&(&'static str, Effect)]) -> String {
    let words: Vec<_> = values.iter().map(|(word, _)| *word).collect();
    words.join(", ")
}
