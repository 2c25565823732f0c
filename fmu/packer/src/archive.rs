//! The archive: sorted entries, fixed time stamps, the library executable. Same content, same bytes.

use std::collections::BTreeMap;
use std::io::{self, Seek, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Name and content of one entry.
#[derive(Debug, Default)]
pub struct Archive {
    entries: BTreeMap<String, Entry>,
}

#[derive(Debug)]
struct Entry {
    bytes: Vec<u8>,
    mode: u32,
}

impl Archive {
    /// Adds a file that is read.
    pub fn file(&mut self, name: impl Into<String>, bytes: impl Into<Vec<u8>>) {
        self.entries.insert(name.into(), Entry { bytes: bytes.into(), mode: 0o644 });
    }

    /// Adds a file that is loaded or run.
    pub fn executable(&mut self, name: impl Into<String>, bytes: impl Into<Vec<u8>>) {
        self.entries.insert(name.into(), Entry { bytes: bytes.into(), mode: 0o755 });
    }

    /// Writes everything.
    pub fn write(&self, out: impl Write + Seek) -> io::Result<()> {
        let mut writer = ZipWriter::new(out);
        for (name, entry) in &self.entries {
            let options = SimpleFileOptions::default()
                .compression_method(CompressionMethod::Deflated)
                .last_modified_time(DateTime::DEFAULT)
                .unix_permissions(entry.mode)
                .large_file(entry.bytes.len() >= u32::MAX as usize);
            writer.start_file(name.as_str(), options)?;
            writer.write_all(&entry.bytes)?;
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
