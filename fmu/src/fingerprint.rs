//! A 128-bit fingerprint of content (FNV-1a): for GUIDs and for finding models that are prepared already.
//! Against accident, not against malice.

const OFFSET: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
const PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;

/// Accumulates parts; their boundaries count.
#[derive(Clone, Copy, Debug)]
pub struct Fingerprint(u128);

impl Default for Fingerprint {
    fn default() -> Self {
        Self(OFFSET)
    }
}

impl Fingerprint {
    /// Adds a part.
    #[must_use]
    pub fn with(self, part: &[u8]) -> Self {
        let length = (part.len() as u64).to_le_bytes();
        let bytes = length.iter().chain(part);
        Self(bytes.fold(self.0, |hash, &byte| (hash ^ u128::from(byte)).wrapping_mul(PRIME)))
    }

    /// The number.
    pub fn value(self) -> u128 {
        self.0
    }

    /// In the form of a GUID, with braces.
    pub fn guid(self) -> String {
        let digits = format!("{:032x}", self.0);
        format!("{{{}-{}-{}-{}-{}}}", &digits[..8], &digits[8..12], &digits[12..16], &digits[16..20], &digits[20..])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boundaries_count() {
        let joined = Fingerprint::default().with(b"ab").with(b"c");
        let apart = Fingerprint::default().with(b"a").with(b"bc");
        assert_ne!(joined.value(), apart.value());
    }

    #[test]
    fn guids_have_the_usual_shape() {
        let guid = Fingerprint::default().with(b"deck").guid();
        assert_eq!(guid.len(), 38);
        assert_eq!(guid.matches('-').count(), 4);
    }
}
