//! A factor that is in memory, or on disk until it is needed.

use std::sync::OnceLock;

use super::linear::Factor;

/// Reads a factor of so many unknowns; else says why it cannot.
pub type ReadFactor = dyn Fn(usize) -> Result<Factor, String> + Send + Sync;

/// A factor that is there when it is asked for.
pub struct LazyFactor {
    factor: OnceLock<Factor>,
    read: Option<Box<ReadFactor>>,
}

impl LazyFactor {
    /// One that has just been computed.
    pub fn computed(factor: Factor) -> Self {
        Self { factor: OnceLock::from(factor), read: None }
    }

    /// One to be read.
    pub fn stored(read: Box<ReadFactor>) -> Self {
        Self { factor: OnceLock::new(), read: Some(read) }
    }

    /// Whether the factor was computed to prepare its body, and not kept on disk.
    pub fn was_computed(&self) -> bool {
        self.read.is_none()
    }

    /// The factor, if it is in memory.
    pub fn in_memory(&self) -> Option<&Factor> {
        self.factor.get()
    }

    /// The factor of so many unknowns. Where the disk no longer gives it, `rebuild` computes it again: the same bits, only
    /// later.
    pub fn get(&self, unknowns: usize, rebuild: impl FnOnce() -> Factor) -> &Factor {
        self.factor.get_or_init(|| match self.read.as_ref().map(|read| read(unknowns)) {
            Some(Ok(factor)) => factor,
            Some(Err(why)) => {
                tracing::warn!("the factor of a body is computed again: {why}");
                rebuild()
            }
            None => rebuild(),
        })
    }
}
