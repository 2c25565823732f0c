//! The one error reply.

use std::fmt;

use crate::message::{Finding, choice, message};

choice! {
    /// What went wrong. The position is the postcard tag: append only.
    pub enum FaultCode {
        /// The request cannot be read or contradicts itself.
        BadRequest,
        /// Its encoding or message version is not understood.
        UnsupportedEncoding,
        /// It is larger than the daemon accepts.
        TooLarge,
        /// No such verb.
        UnknownVerb,
        /// The key could mean several daemons, sessions or verbs.
        WildcardKey,
        /// No such session: never opened, closed, or lost.
        UnknownSession,
        /// No such port, or a port named twice.
        UnknownPort,
        /// No such field.
        UnknownField,
        /// NaN or infinity where a number is needed.
        NotFinite,
        /// The target time lies before the present time.
        TimeInPast,
        /// The deck cannot be solved; `details.findings` holds every diagnostic.
        DeckRefused,
        /// The law or its parameters are refused.
        LawRefused,
        /// The sequence number lies ahead; `details.sequence_expected` is the right one.
        SequenceGap,
        /// The sequence number was used and its reply is no longer kept.
        SequenceExpired,
        /// The sequence number was used by a different request.
        SequenceConflict,
        /// The queue is full; try again later.
        Busy,
        /// A limit of the daemon is reached; `details.limit` is its value.
        LimitExceeded,
        /// The state is damaged, of another version or of another deck.
        CheckpointRefused,
        /// The preload did not converge.
        PreloadStopped,
        /// A defect of the solver ended the session; the daemon lives.
        SessionFailed,
        /// The daemon is shutting down.
        ShuttingDown,
        /// A defect of the daemon.
        Internal,
    } default Internal
}

impl FaultCode {
    /// Whether the same request may succeed later without any change.
    pub fn retryable(self) -> bool {
        matches!(self, Self::Busy)
    }
}

message! {
    /// What a program needs beside the text.
    pub struct FaultDetails/1 {
        /// Every diagnostic of a refused deck.
        pub findings: Vec<Finding>,
        /// The sequence number that the session expects.
        pub sequence_expected: Option<u64>,
        /// The limit that was reached.
        pub limit: Option<u64>,
    }
}

message! {
    /// The error reply of every verb.
    pub struct Fault/1 {
        /// What went wrong.
        pub code: FaultCode,
        /// For people: what is wrong, where, what to do.
        pub message: String,
        /// Whether the same request may succeed later without any change.
        pub retryable: bool,
        /// What a program needs beside the text.
        pub details: FaultDetails,
    }
}

impl Fault {
    /// A fault without details.
    pub fn new(code: FaultCode, message: impl Into<String>) -> Self {
        Self { code, message: message.into(), retryable: code.retryable(), details: FaultDetails::default() }
    }
}

/// Code and message, then the findings, one line each.
impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.code, self.message)?;
        self.details.findings.iter().try_for_each(|finding| write!(f, "\n{finding}"))
    }
}

impl std::error::Error for Fault {}
