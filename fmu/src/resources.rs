//! What an FMU carries in `resources/`, and how the library finds it.

use std::fs;
use std::path::{Path, PathBuf};

use overclosure::model::Dialect;
use overclosure::simulation::PathChoice;
use serde::{Deserialize, Serialize};

use crate::fingerprint::Fingerprint;

/// Name of the file with [`Options`].
pub const OPTIONS_FILE: &str = "options.json";
/// Name of the deck.
pub const DECK_FILE: &str = "deck.inp";
/// Name of the port selection.
pub const PORTS_FILE: &str = "ports.toml";
/// Name of the prepared model.
pub const PREPARED_FILE: &str = "prepared.ovpm";
/// Layout version of [`Options`] that this library reads.
pub const OPTIONS_FORMAT: u32 = 1;

/// `resources/options.json`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Options {
    /// Layout version.
    pub format: u32,
    /// GUID of the FMU; the importer passes the same one from `modelDescription.xml`.
    pub guid: String,
    /// What is inside.
    pub content: Content,
}

/// What an FMU computes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub enum Content {
    /// A pressure-overclosure law.
    Law,
    /// The deck in [`DECK_FILE`].
    Deck {
        /// What keywords mean.
        dialect: Dialect,
        /// Solver path.
        path: PathChoice,
        /// Whether [`PORTS_FILE`] is there.
        ports: bool,
    },
}

/// Text of a deck FMU.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeckText {
    /// The deck, without `*INCLUDE`.
    pub deck: String,
    /// `ports.toml`, if any.
    pub ports: Option<String>,
    /// What keywords mean.
    pub dialect: Dialect,
    /// Solver path.
    pub path: PathChoice,
    /// The prepared model, if the FMU carries one.
    pub prepared: Option<PathBuf>,
}

impl DeckText {
    /// Tells one prepared model from another.
    pub fn fingerprint(&self) -> u128 {
        Fingerprint::default()
            .with(self.deck.as_bytes())
            .with(self.ports.as_deref().unwrap_or("").as_bytes())
            .with(format!("{:?} {:?} {}", self.dialect, self.path, self.ports.is_some()).as_bytes())
            .value()
    }
}

/// Why the resources cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ResourceError {
    /// The importer's location is not a local file.
    #[error("resource location {location} is not a file on this machine; expected file:///… or a path")]
    NotLocal {
        /// As given.
        location: String,
    },
    /// No location, and the library does not know where it was loaded from.
    #[error("no resource location was given, and the place of the library is unknown")]
    Unknown,
    /// A file is missing or unreadable.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The options are not what this library writes.
    #[error("{}: {source}", path.display())]
    Options {
        /// The file.
        path: PathBuf,
        /// Why.
        source: serde_json::Error,
    },
    /// Written by another version.
    #[error("{}: format {found}, this library reads {OPTIONS_FORMAT}; pack the deck again", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// In the file.
        found: u32,
    },
}

/// Folder behind `fmuResourceLocation`. Without one: `resources` beside `binaries`, seen from the library file.
pub fn locate(location: Option<&str>, library: Option<&Path>) -> Result<PathBuf, ResourceError> {
    match location.map(str::trim).filter(|location| !location.is_empty()) {
        Some(location) => path_of_uri(location),
        None => library
            .and_then(|file| file.ancestors().nth(3))
            .map(|root| root.join("resources"))
            .ok_or(ResourceError::Unknown),
    }
}

/// Reads the options in a resource folder.
pub fn read_options(folder: &Path) -> Result<Options, ResourceError> {
    let path = folder.join(OPTIONS_FILE);
    let text = read(&path)?;
    let options: Options =
        serde_json::from_str(&text).map_err(|source| ResourceError::Options { path: path.clone(), source })?;
    if options.format == OPTIONS_FORMAT {
        Ok(options)
    } else {
        Err(ResourceError::Format { path, found: options.format })
    }
}

/// Reads the deck and the port selection in a resource folder, and finds the prepared model.
pub fn read_deck(folder: &Path, dialect: Dialect, path: PathChoice, ports: bool) -> Result<DeckText, ResourceError> {
    let deck = read(&folder.join(DECK_FILE))?;
    let ports = if ports { Some(read(&folder.join(PORTS_FILE))?) } else { None };
    let prepared = Some(folder.join(PREPARED_FILE)).filter(|file| file.exists());
    Ok(DeckText { deck, ports, dialect, path, prepared })
}

fn read(path: &Path) -> Result<String, ResourceError> {
    fs::read_to_string(path).map_err(|source| ResourceError::Unreadable { path: path.into(), source })
}

/// Importers write `file:///p`, `file:/p`, `file:////p`, `file://localhost/p`, with and without percent-encoding, or a plain path.
fn path_of_uri(location: &str) -> Result<PathBuf, ResourceError> {
    let not_local = || ResourceError::NotLocal { location: location.into() };
    let scheme_length = location.find(':').filter(|&end| is_scheme(&location[..end]));
    let Some(end) = scheme_length else {
        return Ok(PathBuf::from(location));
    };
    if !location[..end].eq_ignore_ascii_case("file") {
        return Err(not_local());
    }
    let rest = &location[end + 1..];
    let path = match rest.strip_prefix("//") {
        Some(after) if after.starts_with('/') => after,
        Some(after) => {
            let (host, path) = after.split_at(after.find('/').ok_or_else(not_local)?);
            if !host.eq_ignore_ascii_case("localhost") {
                return Err(not_local());
            }
            path
        }
        None if rest.is_empty() => return Err(not_local()),
        None => rest,
    };
    let decoded = percent_decode(path).ok_or_else(not_local)?;
    // file:////p is an absolute path with one slash too many.
    let trimmed = decoded.trim_start_matches('/');
    Ok(PathBuf::from(if decoded.starts_with('/') { format!("/{trimmed}") } else { decoded }))
}

fn is_scheme(text: &str) -> bool {
    text.len() > 1
        && text.starts_with(|c: char| c.is_ascii_alphabetic())
        && text.chars().all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c))
}

/// A percent sign that is not followed by two hexadecimal digits stands for itself: some importers do not encode.
fn percent_decode(text: &str) -> Option<String> {
    let bytes = text.as_bytes();
    let mut decoded = Vec::with_capacity(bytes.len());
    let mut at = 0;
    while at < bytes.len() {
        let digits = bytes.get(at + 1..at + 3).and_then(|digits| std::str::from_utf8(digits).ok());
        let byte = digits
            .filter(|digits| bytes[at] == b'%' && digits.bytes().all(|digit| digit.is_ascii_hexdigit()))
            .and_then(|digits| u8::from_str_radix(digits, 16).ok());
        decoded.push(byte.unwrap_or(bytes[at]));
        at += if byte.is_some() { 3 } else { 1 };
    }
    String::from_utf8(decoded).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_form_of_a_location_is_understood() {
        for location in [
            "/tmp/a b/resources",
            "file:/tmp/a%20b/resources",
            "file:///tmp/a%20b/resources",
            "file:////tmp/a%20b/resources",
            "file://localhost/tmp/a%20b/resources",
            "FILE:///tmp/a b/resources",
        ] {
            let path = locate(Some(location), None).expect(location);
            assert_eq!(path, Path::new("/tmp/a b/resources"), "{location}");
        }
        assert_eq!(locate(Some("file:///tmp/x/"), None).expect("slash"), Path::new("/tmp/x/"));
        assert_eq!(locate(Some("file:///tmp/100%/x"), None).expect("bare percent"), Path::new("/tmp/100%/x"));
    }

    #[test]
    fn without_a_location_the_library_tells() {
        let library = Path::new("/tmp/fmu/binaries/linux64/x.so");
        for location in [None, Some(""), Some("  ")] {
            assert_eq!(locate(location, Some(library)).expect("known"), Path::new("/tmp/fmu/resources"));
        }
        assert!(matches!(locate(None, None), Err(ResourceError::Unknown)));
    }

    #[test]
    fn places_elsewhere_are_refused() {
        for location in ["http://host/resources", "file://other/resources", "file:"] {
            assert!(matches!(locate(Some(location), None), Err(ResourceError::NotLocal { .. })), "{location}");
        }
    }
}
