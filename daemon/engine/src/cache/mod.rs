//! Prepared models on disk: what is expensive to compute of a model, so that a second start need not compute it.
//!
//! The deck is read and examined again on every start; a file holds only what follows from it at great cost. All numbers
//! are little-endian.
//!
//! ```text
//! bytes 0..4    "OVPM"
//! bytes 4..8    version of this layout, u32
//! bytes 8..16   build of the engine, u64: the bits of another build may differ
//! bytes 16..24  key of the model, u64
//! bytes 24..28  number n of sections, u32
//! bytes 28..    length of each section, n x u64
//! then          CRC-32 of everything before it, u32
//! then          the sections, each followed by its CRC-32, u32
//! ```
//!
//! The first section is read at once: what was kept of the bodies, in postcard. Each other section is the factor of one
//! body, read when a field is first recovered: the length of the block structure, u64, the structure in postcard, and
//! the numbers of L, f64.
//!
//! A file is written under another name, flushed to the disk and renamed, so that there is never half a file under the
//! right name, whoever else writes it at the same time. A file of another build, layout or model is passed over; so is a
//! damaged one, with a warning.

mod read;
mod write;

#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

pub use read::{Refused, open};
pub use write::write;

const MAGIC: [u8; 4] = *b"OVPM";
/// Raised whenever the layout or the meaning of the sections changes.
const VERSION: u32 = 1;
/// Length of the header before the section lengths.
const HEADER: usize = 28;

/// Build of the engine: a checksum of its version and sources, from `build.rs`.
const BUILD: u64 = match u64::from_str_radix(env!("OVERCLOSURE_BUILD"), 16) {
    Ok(build) => build,
    Err(_) => panic!("build.rs gives sixteen hexadecimal digits"),
};

/// Where the model of a fingerprint is kept in a cache directory.
pub fn file_in(directory: &Path, fingerprint: u64) -> PathBuf {
    directory.join(format!("{fingerprint:016x}.ovpm"))
}
