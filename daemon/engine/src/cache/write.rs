//! Writing a prepared model.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use serde::Serialize;

use super::{BUILD, HEADER, MAGIC, VERSION};
use crate::solve::linear::Factor;

/// Bytes handed to the system at a time.
const BLOCK: usize = 1 << 20;

/// Writes what was kept of the bodies and their factors; replaces a file that is there.
pub fn write<T: Serialize>(path: &Path, key: u64, bodies: &T, factors: &[&Factor]) -> io::Result<()> {
    if let Some(directory) = path.parent() {
        fs::create_dir_all(directory)?;
    }
    let (temporary, file) = create_beside(path)?;
    let written = fill(file, key, bodies, factors).and_then(|()| fs::rename(&temporary, path));
    if written.is_err() {
        // The first error is the one to report.
        let _ = fs::remove_file(&temporary);
        return written;
    }
    sync_directory(path)
}

/// A new file in the same directory under a name that no other writer has.
fn create_beside(path: &Path) -> io::Result<(PathBuf, File)> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    loop {
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let mut name = path.as_os_str().to_owned();
        name.push(format!(".{}-{count}.tmp", std::process::id()));
        let name = PathBuf::from(name);
        match OpenOptions::new().write(true).create_new(true).open(&name) {
            Ok(file) => return Ok((name, file)),
            // Left behind by a process of the same number that was killed.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
}

fn fill<T: Serialize>(file: File, key: u64, bodies: &T, factors: &[&Factor]) -> io::Result<()> {
    let encode_failed = |error: postcard::Error| io::Error::other(error);
    let bodies = postcard::to_stdvec(bodies).map_err(encode_failed)?;
    let structures: Vec<Vec<u8>> =
        factors.iter().map(|f| postcard::to_stdvec(f.blocks())).collect::<Result<_, _>>().map_err(encode_failed)?;
    let factor_lengths = structures.iter().zip(factors).map(|(s, f)| 8 + s.len() + 8 * f.values().len());
    let lengths: Vec<u64> = std::iter::once(bodies.len()).chain(factor_lengths).map(|l| l as u64).collect();
    let mut writer = Checked { inner: BufWriter::with_capacity(BLOCK, file), crc: crc32fast::Hasher::new() };
    writer.put(&header(key, &lengths))?;
    writer.end_section()?;
    writer.put(&bodies)?;
    writer.end_section()?;
    for (structure, factor) in structures.iter().zip(factors) {
        writer.put(&(structure.len() as u64).to_le_bytes())?;
        writer.put(structure)?;
        writer.put_numbers(factor.values())?;
        writer.end_section()?;
    }
    let file = writer.inner.into_inner().map_err(io::IntoInnerError::into_error)?;
    file.sync_all()
}

fn header(key: u64, lengths: &[u64]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(HEADER + 8 * lengths.len());
    bytes.extend(MAGIC);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(BUILD.to_le_bytes());
    bytes.extend(key.to_le_bytes());
    bytes.extend((lengths.len() as u32).to_le_bytes());
    bytes.extend(lengths.iter().flat_map(|l| l.to_le_bytes()));
    bytes
}

/// A writer that knows the checksum of the section that it is in.
struct Checked {
    inner: BufWriter<File>,
    crc: crc32fast::Hasher,
}

impl Checked {
    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.crc.update(bytes);
        self.inner.write_all(bytes)
    }

    fn put_numbers(&mut self, values: &[f64]) -> io::Result<()> {
        let mut bytes = Vec::with_capacity(BLOCK);
        for part in values.chunks(BLOCK / 8) {
            bytes.clear();
            bytes.extend(part.iter().flat_map(|v| v.to_le_bytes()));
            self.put(&bytes)?;
        }
        Ok(())
    }

    fn end_section(&mut self) -> io::Result<()> {
        let crc = std::mem::take(&mut self.crc).finalize();
        self.inner.write_all(&crc.to_le_bytes())
    }
}

/// Makes the new name last: on Unix a directory is a file that can be flushed.
#[cfg(unix)]
fn sync_directory(path: &Path) -> io::Result<()> {
    match path.parent().filter(|p| !p.as_os_str().is_empty()) {
        Some(directory) => File::open(directory)?.sync_all(),
        None => File::open(".")?.sync_all(),
    }
}

#[cfg(not(unix))]
fn sync_directory(_: &Path) -> io::Result<()> {
    Ok(())
}
