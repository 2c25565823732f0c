//! A bound on what a short deck can blow up to: sets named in sets, sets named on a million lines.

use super::super::report::{At, Report};

/// Members that a deck may spread over sets, surfaces and data lines, per node and element.
const MEMBERS_PER_ENTITY: u64 = 64;
/// The same for decks without many nodes.
const MEMBERS_MIN: u64 = 10_000_000;

/// Members that may still be spread.
pub struct Budget {
    left: u64,
    reported: bool,
}

impl Budget {
    /// The budget of a mesh with this many nodes and elements together.
    pub fn of(entities: usize) -> Self {
        Self { left: (entities as u64).saturating_mul(MEMBERS_PER_ENTITY).max(MEMBERS_MIN), reported: false }
    }

    /// Takes members from the budget; false when they are not covered, which is reported once.
    pub fn take(&mut self, members: usize, at: At, keyword: &str, report: &mut Report) -> bool {
        match self.left.checked_sub(members as u64) {
            Some(left) => {
                self.left = left;
                true
            }
            None => {
                if !std::mem::replace(&mut self.reported, true) {
                    let message = "sets are named so often that the model would not fit into memory";
                    report.error(at, keyword, message, "name each set once per purpose");
                }
                false
            }
        }
    }
}
