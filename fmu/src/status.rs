//! Status codes of FMI 2.0, and why a call did not succeed.

/// `fmi2Status`.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Status {
    /// Done.
    Ok = 0,
    /// Done; somebody should read the log.
    Warning = 1,
    /// Not done, the importer may try otherwise.
    Discard = 2,
    /// Not done.
    Error = 3,
    /// The instance cannot be used any more.
    Fatal = 4,
}

/// Why a call did not succeed, as a sentence for the log.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Fault {
    /// The request was not taken; the instance stands as before the call.
    #[error("{0}")]
    Refused(String),
    /// The solution could not be continued; the instance stands at the last good time.
    #[error("{reason}")]
    Failed {
        /// What the solver said.
        reason: String,
        /// Time since the start of the experiment that was reached \[time\].
        elapsed: f64,
    },
}
