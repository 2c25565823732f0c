//! Saved states of an instance: versioned, checksummed, little-endian, free of pointers.
//!
//! ```text
//! 8 bytes  "OVCLFMUS"
//! u32      version of this layout
//! u32      length of the head
//! head     postcard: which FMU, phase, clock, values
//! rest     bytes of the backend (for a deck: a checkpoint of the engine)
//! u32      CRC-32 of everything before
//! ```

use serde::{Deserialize, Serialize};

use crate::lifecycle::Phase;
use crate::variables::Values;

const MAGIC: &[u8; 8] = b"OVCLFMUS";
const VERSION: u32 = 1;
const FRAME: usize = MAGIC.len() + 4 + 4 + 4;

/// Times of an instance, on the importer's clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// Start of the experiment.
    pub start: f64,
    /// End of the experiment, if the importer fixed one.
    pub stop: Option<f64>,
    /// The present communication point.
    pub now: f64,
    /// Time of the last good solution; differs from `now` after a failed step.
    pub reached: f64,
}

/// What is saved besides the bytes of the backend.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Head {
    /// GUID of the FMU that the state belongs to.
    pub guid: String,
    /// Phase at the time of saving.
    pub phase: Phase,
    /// Times.
    pub clock: Clock,
    /// Values of all variables.
    pub values: Values,
}

/// Why bytes are not a state of this FMU.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SnapshotError {
    /// Too short, wrong magic, wrong lengths, wrong checksum.
    #[error("not a saved state or damaged: {detail}")]
    Damaged {
        /// What does not fit.
        detail: String,
    },
    /// Another layout.
    #[error("saved state has layout version {found}, this library reads version {VERSION}")]
    Version {
        /// In the bytes.
        found: u32,
    },
    /// Another FMU.
    #[error("saved state belongs to the FMU {found}, this one is {expected}")]
    OtherFmu {
        /// In the bytes.
        found: String,
        /// Of this FMU.
        expected: String,
    },
}

/// Bytes of a state.
pub fn encode(head: &Head, backend: &[u8]) -> Result<Vec<u8>, SnapshotError> {
    let head = postcard::to_stdvec(head).map_err(damaged)?;
    let head_length = u32::try_from(head.len()).map_err(damaged)?;
    let mut bytes = Vec::with_capacity(FRAME + head.len() + backend.len());
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&VERSION.to_le_bytes());
    bytes.extend_from_slice(&head_length.to_le_bytes());
    bytes.extend_from_slice(&head);
    bytes.extend_from_slice(backend);
    let checksum = crc32fast::hash(&bytes);
    bytes.extend_from_slice(&checksum.to_le_bytes());
    Ok(bytes)
}

/// Head and backend bytes of a state of the FMU with this GUID.
pub fn decode<'a>(bytes: &'a [u8], guid: &str) -> Result<(Head, &'a [u8]), SnapshotError> {
    if bytes.len() < FRAME {
        return Err(damaged(format!("{} bytes are fewer than any state has", bytes.len())));
    }
    if !bytes.starts_with(MAGIC) {
        return Err(damaged("it does not begin like one"));
    }
    let version = read_u32(bytes, MAGIC.len());
    if version != VERSION {
        return Err(SnapshotError::Version { found: version });
    }
    let (content, _) = bytes.split_at(bytes.len() - 4);
    if crc32fast::hash(content) != read_u32(bytes, content.len()) {
        return Err(damaged("the checksum differs"));
    }
    let body = &content[FRAME - 4..];
    let head_length = read_u32(bytes, MAGIC.len() + 4) as usize;
    if head_length > body.len() {
        return Err(damaged("the head is longer than the state"));
    }
    let (head, backend) = body.split_at(head_length);
    let head: Head = postcard::from_bytes(head).map_err(damaged)?;
    if head.guid != guid {
        return Err(SnapshotError::OtherFmu { found: head.guid, expected: guid.into() });
    }
    Ok((head, backend))
}

fn read_u32(bytes: &[u8], at: usize) -> u32 {
    let mut word = [0; 4];
    word.copy_from_slice(&bytes[at..at + 4]);
    u32::from_le_bytes(word)
}

fn damaged(detail: impl ToString) -> SnapshotError {
    SnapshotError::Damaged { detail: detail.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn head() -> Head {
        let values = Values { reals: vec![1.0, f64::MIN_POSITIVE], integers: vec![-3], strings: vec!["a:b".into()] };
        Head { guid: "{1}".into(), phase: Phase::StepComplete, clock: Clock::default(), values }
    }

    #[test]
    fn a_state_survives_its_bytes() {
        let bytes = encode(&head(), &[1, 2, 3]).expect("encodes");
        let (decoded, backend) = decode(&bytes, "{1}").expect("decodes");
        assert_eq!(decoded, head());
        assert_eq!(backend, [1, 2, 3]);
    }

    #[test]
    fn every_changed_byte_and_every_cut_is_noticed() {
        let bytes = encode(&head(), &[1, 2, 3]).expect("encodes");
        for position in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[position] ^= 0x10;
            assert!(decode(&changed, "{1}").is_err(), "byte {position}");
            assert!(decode(&bytes[..position], "{1}").is_err(), "cut at {position}");
        }
    }

    #[test]
    fn a_state_of_another_fmu_is_refused() {
        let bytes = encode(&head(), &[]).expect("encodes");
        assert!(matches!(decode(&bytes, "{2}"), Err(SnapshotError::OtherFmu { .. })));
    }
}
