//! The text of a deck with every `*INCLUDE` replaced by what it includes: an FMU needs nothing outside itself.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Depth of `*INCLUDE` in `*INCLUDE`; the deck reader has the same limit and has read the deck before.
const DEPTH_MAX: usize = 16;

/// Why a deck cannot be put together.
#[derive(Debug, thiserror::Error)]
pub enum InlineError {
    /// A file cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// `*INCLUDE` without `INPUT=`.
    #[error("{}: *INCLUDE names no file; write *INCLUDE, INPUT=file", path.display())]
    NoInput {
        /// The including file.
        path: PathBuf,
    },
    /// Files that include each other.
    #[error("{}: *INCLUDE is nested more than {DEPTH_MAX} deep", path.display())]
    TooDeep {
        /// The innermost file.
        path: PathBuf,
    },
}

/// Reads a deck and everything that it includes. Names are relative to the folder of the including file.
/// Bytes that are not UTF-8 (old comments) become replacement characters.
pub fn inline(path: &Path) -> Result<String, InlineError> {
    let mut text = String::new();
    append(path, 0, &mut text)?;
    Ok(text)
}

fn append(path: &Path, depth: usize, out: &mut String) -> Result<(), InlineError> {
    if depth > DEPTH_MAX {
        return Err(InlineError::TooDeep { path: path.into() });
    }
    let bytes = fs::read(path).map_err(|source| InlineError::Unreadable { path: path.into(), source })?;
    let text = String::from_utf8_lossy(&bytes);
    let mut lines = text.trim_start_matches('\u{feff}').lines();
    while let Some(line) = lines.next() {
        if !is_include(line) {
            out.push_str(line);
            out.push('\n');
            continue;
        }
        let mut card = line.to_string();
        while card.trim_end().ends_with(',') {
            match lines.next() {
                Some(next) => card.push_str(next),
                None => break,
            }
        }
        let input = input_of(&card).ok_or_else(|| InlineError::NoInput { path: path.into() })?;
        append(&path.parent().unwrap_or(Path::new("")).join(input), depth + 1, out)?;
    }
    Ok(())
}

fn is_include(line: &str) -> bool {
    let keyword = line.trim_start().split(',').next().unwrap_or("");
    keyword.strip_prefix('*').is_some_and(|word| word.trim().eq_ignore_ascii_case("INCLUDE"))
}

fn input_of(card: &str) -> Option<&str> {
    card.split(',').skip(1).find_map(|parameter| {
        let (name, value) = parameter.split_once('=')?;
        let value = value.trim().trim_matches('"').trim();
        (name.trim().eq_ignore_ascii_case("INPUT") && !value.is_empty()).then_some(value)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn included_text_stands_where_it_was_included() {
        let folder = tempfile::tempdir().expect("folder");
        fs::create_dir(folder.path().join("sub")).expect("folder");
        let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("write");
        write("deck.inp", "*HEADING\n** *INCLUDE, INPUT=no\n * include , input = sub/a.inc\n*STEP\n");
        write("sub/a.inc", "*NODE\n*Include,\n INPUT=\"b.inc\"\n");
        write("sub/b.inc", "1, 0, 0, 0");
        let text = inline(&folder.path().join("deck.inp")).expect("inline");
        assert_eq!(text, "*HEADING\n** *INCLUDE, INPUT=no\n*NODE\n1, 0, 0, 0\n*STEP\n");
    }

    #[test]
    fn a_file_that_includes_itself_ends() {
        let folder = tempfile::tempdir().expect("folder");
        let deck = folder.path().join("deck.inp");
        fs::write(&deck, "*INCLUDE, INPUT=deck.inp\n").expect("write");
        assert!(matches!(inline(&deck), Err(InlineError::TooDeep { .. })));
    }

    #[test]
    fn a_missing_file_is_named() {
        let folder = tempfile::tempdir().expect("folder");
        let deck = folder.path().join("deck.inp");
        fs::write(&deck, "*INCLUDE, INPUT=gone.inc\n").expect("write");
        let error = inline(&deck).expect_err("missing");
        assert!(error.to_string().contains("gone.inc"), "{error}");
    }
}
