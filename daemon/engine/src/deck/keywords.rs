//! What the reader knows about keywords: types of the table, look-up, and the uniform checks of parameters.
//!
//! The tables themselves stand in `model_table`, `contact_table`, `general_table`, `body_table`, `dynamic_table` and `step_table` (keywords that are read) and `other_table`
//! (keywords that are known but not read).

use std::sync::LazyLock;

use rustc_hash::FxHashMap;

use super::body_table::BODIES;
use super::contact_table::CONTACT;
use super::dynamic_table::DYNAMICS;
use super::general_table::GENERAL;
use super::lex::key;
use super::model_table::MODEL;
use super::other_table::OTHER;
use super::step_table::STEPS;

/// What becomes of a keyword, a parameter or a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// It is read.
    Read,
    /// It changes nothing in the answer: ignored with a warning that gives this reason.
    Ignored(&'static str),
    /// It is read without meaning anything here; not worth a warning.
    Silent,
    /// It would change the answer: an error that gives this remedy.
    Refused(&'static str),
}

/// Where a keyword may stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placement {
    /// Before the first `*STEP`.
    Model,
    /// Between `*STEP` and `*END STEP`.
    Step,
    /// Anywhere.
    Anywhere,
    /// In the model part, after `*MATERIAL`.
    Material,
    /// In the model part, after `*SURFACE INTERACTION`.
    Interaction,
}

/// What the lines under a keyword hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DataLines {
    /// Nothing.
    Forbidden,
    /// Free text without meaning for the answer.
    Text,
    /// Fields that are read with the rest of the deck.
    Fields,
    /// Nodes.
    Nodes,
    /// Elements.
    Elements,
    /// Members of a set.
    Members,
    /// Members of a surface.
    Faces,
    /// Whatever; passed over.
    Skipped,
}

/// Values that a parameter takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterValue {
    /// None: present or absent.
    Flag,
    /// Any.
    Any,
    /// Any, or none.
    Optional,
    /// One of a list (upper case, no blanks), each with its effect; an empty entry is the parameter without a value.
    OneOf(&'static [(&'static str, Effect)]),
}

/// A parameter of a keyword.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// Name, upper case.
    pub name: &'static str,
    /// Values.
    pub value: ParameterValue,
    /// Whether the keyword means nothing without it.
    pub required: bool,
    /// What becomes of it.
    pub effect: Effect,
}

/// A keyword.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Keyword {
    /// Name with its star, upper case.
    pub name: &'static str,
    /// Where it may stand.
    pub placement: Placement,
    /// What its lines hold.
    pub data: DataLines,
    /// Parameters that are known.
    pub parameters: &'static [Parameter],
    /// What becomes of it.
    pub effect: Effect,
    /// Whether it only chooses what is written, so that no parameter of it can change the answer.
    pub output_only: bool,
}

impl Parameter {
    const fn new(name: &'static str, value: ParameterValue, effect: Effect) -> Self {
        Self { name, value, required: false, effect }
    }

    /// Read, with any value.
    pub const fn value(name: &'static str) -> Self {
        Self::new(name, ParameterValue::Any, Effect::Read)
    }

    /// Read, with any value, and required.
    pub const fn required(name: &'static str) -> Self {
        Self { required: true, ..Self::value(name) }
    }

    /// Read, without a value.
    pub const fn flag(name: &'static str) -> Self {
        Self::new(name, ParameterValue::Flag, Effect::Read)
    }

    /// Read, with or without a value.
    pub const fn optional(name: &'static str) -> Self {
        Self::new(name, ParameterValue::Optional, Effect::Read)
    }

    /// Read, one of a list.
    pub const fn one_of(name: &'static str, values: &'static [(&'static str, Effect)]) -> Self {
        Self::new(name, ParameterValue::OneOf(values), Effect::Read)
    }

    /// Ignored with a warning.
    pub const fn ignored(name: &'static str, why: &'static str) -> Self {
        Self::new(name, ParameterValue::Optional, Effect::Ignored(why))
    }

    /// Ignored without a word.
    pub const fn silent(name: &'static str) -> Self {
        Self::new(name, ParameterValue::Optional, Effect::Silent)
    }

    /// Refused.
    pub const fn refused(name: &'static str, remedy: &'static str) -> Self {
        Self::new(name, ParameterValue::Optional, Effect::Refused(remedy))
    }
}

impl Keyword {
    /// A keyword that is read.
    pub const fn read(
        name: &'static str,
        placement: Placement,
        data: DataLines,
        parameters: &'static [Parameter],
    ) -> Self {
        Self { name, placement, data, parameters, effect: Effect::Read, output_only: false }
    }

    /// A keyword that is read and only chooses what is written.
    pub const fn output(name: &'static str, data: DataLines, parameters: &'static [Parameter]) -> Self {
        Self { output_only: true, ..Self::read(name, Placement::Step, data, parameters) }
    }

    /// Whether the reader does something with it.
    pub fn is_read(&self) -> bool {
        self.effect == Effect::Read
    }
}

/// Every keyword that the reader knows: those it reads first, then the others.
pub fn keywords() -> impl Iterator<Item = &'static Keyword> {
    MODEL.iter().chain(CONTACT).chain(GENERAL).chain(BODIES).chain(DYNAMICS).chain(STEPS).chain(OTHER)
}

static BY_KEY: LazyLock<FxHashMap<String, &'static Keyword>> =
    LazyLock::new(|| keywords().map(|keyword| (key(keyword.name), keyword)).collect());

/// What a word on a keyword line stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    /// The keyword, spelt out.
    Exact(&'static Keyword),
    /// The only keyword that begins so.
    Abbreviated(&'static Keyword),
    /// No keyword.
    Unknown,
}

/// Fewest letters of an abbreviated keyword.
const ABBREVIATION_LETTERS_MIN: usize = 4;

/// Looks a keyword up, with its star, in any case and with blanks anywhere.
pub fn find(word: &str) -> Found {
    let word = key(word);
    if let Some(keyword) = BY_KEY.get(&word) {
        return Found::Exact(keyword);
    }
    if word.chars().count() <= ABBREVIATION_LETTERS_MIN {
        return Found::Unknown;
    }
    let mut beginning_so = keywords().filter(|keyword| key(keyword.name).starts_with(&word));
    match (beginning_so.next(), beginning_so.next()) {
        (Some(keyword), None) => Found::Abbreviated(keyword),
        _ => Found::Unknown,
    }
}

/// Looks a parameter up: by its name, or by a beginning that no other parameter of the keyword shares.
pub fn find_parameter(keyword: &'static Keyword, name: &str) -> Option<&'static Parameter> {
    let name = key(name);
    if name.is_empty() {
        return None;
    }
    if let Some(exact) = keyword.parameters.iter().find(|parameter| key(parameter.name) == name) {
        return Some(exact);
    }
    let mut beginning_so = keyword.parameters.iter().filter(|parameter| key(parameter.name).starts_with(&name));
    match (beginning_so.next(), beginning_so.next()) {
        (Some(parameter), None) => Some(parameter),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_keyword_stands_once_in_the_tables() {
        assert_eq!(BY_KEY.len(), keywords().count());
        for keyword in keywords() {
            assert!(keyword.name.starts_with('*') && keyword.name == keyword.name.to_uppercase(), "{}", keyword.name);
            let mut names: Vec<_> = keyword.parameters.iter().map(|p| key(p.name)).collect();
            names.sort();
            names.dedup();
            assert_eq!(names.len(), keyword.parameters.len(), "{}", keyword.name);
        }
    }

    #[test]
    fn words_are_found_in_any_spelling() {
        for word in ["*Contact Pair", "*CONTACTPAIR", "* contact pair "] {
            assert!(matches!(find(word), Found::Exact(k) if k.name == "*CONTACT PAIR"), "{word}");
        }
        assert!(matches!(find("*BOUND"), Found::Abbreviated(k) if k.name == "*BOUNDARY"));
        assert_eq!(find("*SURFA"), Found::Unknown);
        assert_eq!(find("*BO"), Found::Unknown);
        assert_eq!(find("*"), Found::Unknown);
    }

    #[test]
    fn parameters_may_be_abbreviated_when_unique() {
        let Found::Exact(pair) = find("*CONTACT PAIR") else { panic!("no *CONTACT PAIR") };
        assert_eq!(find_parameter(pair, "inter").map(|p| p.name), Some("INTERACTION"));
        assert_eq!(find_parameter(pair, "SmallSliding").map(|p| p.name), Some("SMALL SLIDING"));
        assert_eq!(find_parameter(pair, "SM"), None);
    }
}
