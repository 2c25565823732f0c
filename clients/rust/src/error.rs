//! Why a call failed.

use overclosure_protocol::fault::Fault;

/// Why a call failed, after the attempts that [`crate::Options`] allows.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CallError {
    /// No connection could be made within [`crate::Options::timeout_connect`].
    #[error("no daemon answers at {endpoint}; start one with `overclosure serve`")]
    NotReached {
        /// Where it should listen.
        endpoint: String,
        /// What the transport says, seldom more than that it tried.
        detail: String,
    },
    /// Nobody answers at that key: the daemon is not running, has another id, or is being reconnected to.
    #[error("no daemon answers at {key}")]
    Unavailable {
        /// The key asked.
        key: String,
    },
    /// The daemon did not answer in time. It may still be working; repeating the call is safe.
    #[error("no answer from {key} within {seconds} s")]
    Timeout {
        /// The key asked.
        key: String,
        /// Seconds waited.
        seconds: f64,
    },
    /// The daemon refused.
    #[error(transparent)]
    Fault(#[from] Fault),
    /// The connection, or bytes that are no reply of ours.
    #[error("{detail}")]
    Transport {
        /// What happened.
        detail: String,
    },
}

impl CallError {
    pub(crate) fn transport(detail: impl ToString) -> Self {
        Self::Transport { detail: detail.to_string() }
    }

    /// Whether repeating the same call may help.
    pub fn retryable(&self) -> bool {
        match self {
            Self::NotReached { .. } | Self::Unavailable { .. } | Self::Timeout { .. } => true,
            Self::Fault(fault) => fault.retryable,
            Self::Transport { .. } => false,
        }
    }
}
