//! The text of a deck with every `*INCLUDE` replaced by what it includes: an FMU needs nothing outside itself, and a deck
//! that goes over a wire has no folder.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Depth of `*INCLUDE` in `*INCLUDE`; the deck reader has the same limit.
const DEPTH_MAX: usize = 16;
/// Files that one deck may include, counted each time; the deck reader has the same limit.
const INCLUDES_MAX: usize = 10_000;

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
    #[error("{}: *INCLUDE of a file that is being included already", path.display())]
    Cycle {
        /// The file.
        path: PathBuf,
    },
    /// More than are sensible.
    #[error("{}: more than {INCLUDES_MAX} files are included", path.display())]
    TooMany {
        /// The one that is too many.
        path: PathBuf,
    },
    /// Files in files in files.
    #[error("{}: *INCLUDE is nested more than {DEPTH_MAX} deep", path.display())]
    TooDeep {
        /// The innermost file.
        path: PathBuf,
    },
}

/// Reads a deck and everything that it includes. Names are relative to the folder of the including file.
/// Bytes that are not UTF-8 (old comments) become replacement characters.
pub fn inline(path: &Path) -> Result<String, InlineError> {
    let mut inlining = Inlining { text: String::new(), open: Vec::new(), files: 0 };
    inlining.append(path)?;
    Ok(inlining.text)
}

struct Inlining {
    text: String,
    /// Resolved paths of the files being read, outermost first.
    open: Vec<PathBuf>,
    files: usize,
}

impl Inlining {
    fn append(&mut self, path: &Path) -> Result<(), InlineError> {
        let unreadable = |source| InlineError::Unreadable { path: path.into(), source };
        let resolved = path.canonicalize().map_err(unreadable)?;
        if self.open.contains(&resolved) {
            return Err(InlineError::Cycle { path: path.into() });
        }
        if self.open.len() > DEPTH_MAX {
            return Err(InlineError::TooDeep { path: path.into() });
        }
        if self.files > INCLUDES_MAX {
            return Err(InlineError::TooMany { path: path.into() });
        }
        self.files += 1;
        let bytes = fs::read(path).map_err(unreadable)?;
        self.open.push(resolved);
        self.lines(path, &bytes)?;
        self.open.pop();
        Ok(())
    }

    fn lines(&mut self, path: &Path, bytes: &[u8]) -> Result<(), InlineError> {
        let text = String::from_utf8_lossy(bytes);
        let mut lines = text.trim_start_matches('\u{feff}').lines();
        while let Some(line) = lines.next() {
            if !is_include(line) {
                self.text.push_str(line);
                self.text.push('\n');
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
            self.append(&path.parent().unwrap_or(Path::new("")).join(input))?;
        }
        Ok(())
    }
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
        fs::write(&deck, "*INCLUDE, INPUT=deck.inp\n".repeat(50)).expect("write");
        assert!(matches!(inline(&deck), Err(InlineError::Cycle { .. })));
    }

    #[test]
    fn files_that_include_each_other_through_a_third_end_and_twice_the_same_is_fine() {
        let folder = tempfile::tempdir().expect("folder");
        let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("write");
        write("deck.inp", "*INCLUDE, INPUT=a.inc\n*INCLUDE, INPUT=a.inc\n");
        write("a.inc", "1\n");
        assert_eq!(inline(&folder.path().join("deck.inp")).expect("inline"), "1\n1\n");
        write("a.inc", "*INCLUDE, INPUT=b.inc\n");
        write("b.inc", "*INCLUDE, INPUT=deck.inp\n");
        assert!(matches!(inline(&folder.path().join("deck.inp")), Err(InlineError::Cycle { .. })));
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
