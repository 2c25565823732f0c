//! A result file and what can go wrong with it.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// A result file that could not be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {source}", path.display())]
pub struct OutputError {
    /// The file.
    pub path: PathBuf,
    /// What the system says.
    pub source: io::Error,
}

impl OutputError {
    /// To be used with `map_err`.
    pub(super) fn at(path: &Path) -> impl FnOnce(io::Error) -> Self + '_ {
        move |source| Self { path: path.to_owned(), source }
    }
}

/// A text file that grows by blocks.
pub(super) struct TextFile {
    path: PathBuf,
    writer: BufWriter<File>,
}

impl TextFile {
    /// `DIRECTORY/JOB SUFFIX` without the blank, replacing what is there.
    pub(super) fn create(directory: &Path, job: &str, suffix: &str) -> Result<Self, OutputError> {
        let path = directory.join(format!("{job}{suffix}"));
        let file = File::create(&path).map_err(OutputError::at(&path))?;
        Ok(Self { path, writer: BufWriter::new(file) })
    }

    /// Writes a block and hands it to the system.
    pub(super) fn append(&mut self, text: &str) -> Result<(), OutputError> {
        self.writer.write_all(text.as_bytes()).and_then(|()| self.writer.flush()).map_err(OutputError::at(&self.path))
    }
}
