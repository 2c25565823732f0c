//! The archive: sorted entries, fixed time stamps, the library executable. Same content, same bytes.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Seek, Write};
use std::path::PathBuf;

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Name and content of one entry.
#[derive(Debug, Default)]
pub struct Archive {
    entries: BTreeMap<String, Entry>,
}

#[derive(Debug)]
struct Entry {
    content: Content,
    mode: u32,
}

#[derive(Debug)]
enum Content {
    /// Compressed.
    Bytes(Vec<u8>),
    /// Copied from a file, as it is: floating-point numbers hardly shrink.
    File(PathBuf),
}

impl Archive {
    /// Adds a file that is read.
    pub fn file(&mut self, name: impl Into<String>, bytes: impl Into<Vec<u8>>) {
        self.entries.insert(name.into(), Entry { content: Content::Bytes(bytes.into()), mode: 0o644 });
    }

    /// Adds a large file of numbers that is read; it must last until the archive is written.
    pub fn numbers(&mut self, name: impl Into<String>, file: PathBuf) {
        self.entries.insert(name.into(), Entry { content: Content::File(file), mode: 0o644 });
    }

    /// Adds a file that is loaded or run.
    pub fn executable(&mut self, name: impl Into<String>, bytes: impl Into<Vec<u8>>) {
        self.entries.insert(name.into(), Entry { content: Content::Bytes(bytes.into()), mode: 0o755 });
    }

    /// Writes everything.
    pub fn write(&self, out: impl Write + Seek) -> io::Result<()> {
        let mut writer = ZipWriter::new(out);
        for (name, entry) in &self.entries {
            let options = |length: u64, method| {
                SimpleFileOptions::default()
                    .compression_method(method)
                    .last_modified_time(DateTime::DEFAULT)
                    .unix_permissions(entry.mode)
                    .large_file(length >= u64::from(u32::MAX))
            };
            match &entry.content {
                Content::Bytes(bytes) => {
                    writer.start_file(name.as_str(), options(bytes.len() as u64, CompressionMethod::Deflated))?;
                    writer.write_all(bytes)?;
                }
                Content::File(path) => {
                    let mut file = File::open(path)?;
                    let length = file.metadata()?.len();
                    writer.start_file(name.as_str(), options(length, CompressionMethod::Stored))?;
                    io::copy(&mut file, &mut writer)?;
                }
            }
        }
        writer.finish()?.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    #[test]
    fn order_of_adding_does_not_matter_and_modes_survive() {
        let bytes = |names: &[&str]| {
            let mut archive = Archive::default();
            for name in names {
                archive.file(*name, *b"text");
            }
            archive.executable("binaries/linux64/x.so", *b"code");
            let mut out = Cursor::new(Vec::new());
            archive.write(&mut out).expect("memory");
            out.into_inner()
        };
        let archive = bytes(&["b", "a"]);
        assert_eq!(archive, bytes(&["a", "b"]));
        let mut reader = zip::ZipArchive::new(Cursor::new(archive)).expect("archive");
        let mode = reader.by_name("binaries/linux64/x.so").expect("entry").unix_mode().expect("mode");
        assert_eq!(mode & 0o777, 0o755);
    }
}
