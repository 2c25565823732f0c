//! Memory that a preparation will need, estimated before it is taken.

use std::sync::atomic::{AtomicU64, Ordering};

/// What may be used, and what has been promised so far.
#[derive(Default)]
pub struct Budget {
    limit: Option<u64>,
    promised: AtomicU64,
}

/// More is needed than there is [bytes].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shortage {
    /// Of this part.
    pub part: u64,
    /// Of everything so far, this part included.
    pub needed: u64,
    /// Allowed.
    pub limit: u64,
}

impl Budget {
    /// With a limit, if any [bytes].
    pub fn new(limit: Option<u64>) -> Self {
        Self { limit, promised: AtomicU64::new(0) }
    }

    /// Asks for some more numbers of eight bytes.
    pub fn take(&self, numbers: usize) -> Result<(), Shortage> {
        let part = 8 * numbers as u64;
        let needed = self.promised.fetch_add(part, Ordering::Relaxed) + part;
        match self.limit {
            Some(limit) if needed > limit => Err(Shortage { part, needed, limit }),
            _ => Ok(()),
        }
    }
}

impl Shortage {
    /// In words.
    pub fn describe(&self, what: &str) -> String {
        let size = |bytes: u64| match bytes {
            b if b >= 1 << 30 => format!("{:.1} GB", b as f64 / f64::from(1 << 30)),
            b => format!("{:.1} MB", b as f64 / f64::from(1 << 20)),
        };
        format!(
            "{what} needs about {}, which makes {} in all; {} may be used",
            size(self.part),
            size(self.needed),
            size(self.limit)
        )
    }
}

/// Numbers that condensing a body onto its contact points takes: the trailing factor, the rows and their responses, and the
/// compliances.
pub fn condensed_numbers(retained: usize, points: usize) -> usize {
    retained * retained + 3 * retained * points + 3 * points * points
}

/// Operations that it takes: Cholesky of the trailing block, substitution, product.
pub fn condensed_operations(retained: usize, points: usize) -> f64 {
    let (r, n) = (retained as f64, points as f64);
    r * r * r / 3.0 + 2.0 * r * r * n + r * n * n
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_told_in_numbers() {
        let budget = Budget::new(Some(1 << 31));
        assert_eq!(budget.take(1 << 27), Ok(()));
        let shortage = budget.take(3 << 26).expect_err("2.5 of 2 GB");
        assert_eq!(
            shortage.describe("the factor"),
            "the factor needs about 1.5 GB, which makes 2.5 GB in all; 2.0 GB may be used"
        );
        assert_eq!(Budget::new(None).take(usize::MAX / 16), Ok(()));
    }
}
