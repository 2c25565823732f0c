//! The order of mutating requests: each is done once, however often it arrives.

use std::collections::VecDeque;

use overclosure_protocol::fault::{Fault, FaultCode};
use overclosure_protocol::message::{RestoreReply, StepReply};

/// A reply that may be asked for again.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Of a step.
    Step(StepReply),
    /// Of a restore.
    Restore(RestoreReply),
}

/// Next sequence number and the last replies of one session.
pub struct Ledger {
    next: u64,
    kept: VecDeque<Entry>,
    capacity: usize,
}

struct Entry {
    sequence: u64,
    /// Tells a repetition from another request with the same number.
    fingerprint: u64,
    outcome: Outcome,
}

impl Ledger {
    /// Starts at 1 and keeps `capacity` replies.
    pub fn new(capacity: u32) -> Self {
        Self { next: 1, kept: VecDeque::new(), capacity: capacity as usize }
    }

    /// The number that the next request must carry.
    pub fn next(&self) -> u64 {
        self.next
    }

    /// `None`: do the work, then [`Ledger::record`] it. `Some`: the stored reply of the same request.
    pub fn admit(&self, sequence: u64, fingerprint: u64) -> Result<Option<Outcome>, Fault> {
        let refuse = |code, message| {
            let mut fault = Fault::new(code, message);
            fault.details.sequence_expected = Some(self.next);
            Err(fault)
        };
        if sequence == self.next {
            return Ok(None);
        }
        if sequence > self.next {
            let text = format!("sequence number {sequence} leaves a gap: {} is expected", self.next);
            return refuse(FaultCode::SequenceGap, text);
        }
        match self.kept.iter().find(|e| e.sequence == sequence) {
            Some(entry) if entry.fingerprint == fingerprint => Ok(Some(entry.outcome.clone())),
            Some(_) => {
                let text =
                    format!("sequence number {sequence} was used by a different request; {} is expected", self.next);
                refuse(FaultCode::SequenceConflict, text)
            }
            None => {
                let text =
                    format!("the reply to sequence number {sequence} is no longer kept; {} is expected", self.next);
                refuse(FaultCode::SequenceExpired, text)
            }
        }
    }

    /// Stores the reply of the admitted request and moves on.
    pub fn record(&mut self, fingerprint: u64, outcome: Outcome) {
        if self.kept.len() == self.capacity {
            self.kept.pop_front();
        }
        self.kept.push_back(Entry { sequence: self.next, fingerprint, outcome });
        self.next += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(sequence: u64) -> Outcome {
        Outcome::Step(StepReply { sequence, ..Default::default() })
    }

    fn code(verdict: Result<Option<Outcome>, Fault>) -> FaultCode {
        verdict.expect_err("refused").code
    }

    #[test]
    fn a_repeated_request_gets_the_stored_reply() {
        let mut ledger = Ledger::new(4);
        assert_eq!(ledger.admit(1, 10), Ok(None));
        ledger.record(10, outcome(1));
        assert_eq!(ledger.admit(1, 10), Ok(Some(outcome(1))));
        assert_eq!(ledger.admit(2, 10), Ok(None), "the same content under the next number is a new request");
    }

    #[test]
    fn gaps_conflicts_and_forgotten_numbers_are_refused_with_the_expected_one() {
        let mut ledger = Ledger::new(2);
        for sequence in 1..=3 {
            ledger.record(sequence * 10, outcome(sequence));
        }
        assert_eq!(code(ledger.admit(5, 0)), FaultCode::SequenceGap);
        assert_eq!(code(ledger.admit(3, 31)), FaultCode::SequenceConflict);
        assert_eq!(code(ledger.admit(1, 10)), FaultCode::SequenceExpired);
        assert_eq!(code(ledger.admit(0, 0)), FaultCode::SequenceExpired);
        let fault = ledger.admit(9, 0).expect_err("a gap");
        assert_eq!(fault.details.sequence_expected, Some(4));
    }
}
