//! What can be asked of the engine, and how it answers when it cannot comply.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

/// Which solver path to take.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PathChoice {
    /// By estimated cost.
    #[default]
    Auto,
    /// Condensed onto contact, dense.
    Dense,
    /// Newton on the sparse system.
    Sparse,
}

/// How a model is prepared.
#[derive(Clone, Debug, Default)]
pub struct PrepareOptions {
    /// Solver path.
    pub path: PathChoice,
    /// Threads that may be used; 0 and 1 both mean one. The bits of the result do not depend on it.
    pub threads: usize,
    /// Memory that preparing may take, in bytes; none: as much as it needs.
    pub memory_limit: Option<u64>,
    /// Text of a `ports.toml`, if any.
    pub ports_toml: Option<String>,
    /// Where the prepared model may already be, if anywhere. The bits of the result do not depend on it. Models that take the
    /// sparse path are not kept.
    pub cache: Option<Cache>,
}

/// Where prepared models are kept on disk.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Cache {
    /// A directory; a model that it lacks is prepared and put there.
    Directory(PathBuf),
    /// One file; it is read and never written.
    File(PathBuf),
}

/// Stages of preparation, announced when they begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Phase {
    /// Contact search and projection.
    Search,
    /// Element matrices.
    Assemble,
    /// Fill-reducing ordering.
    Order,
    /// Symbolic factorisation.
    Symbolic,
    /// Numeric factorisation.
    Numeric,
    /// Condensation onto the contact points.
    Condense,
    /// Prepared models on disk.
    Cache,
    /// Increments.
    Solve,
    /// Writing results.
    Write,
}

/// How an advance ended.
#[derive(Clone, Debug, PartialEq)]
pub enum AdvanceOutcome {
    /// The target time was reached.
    Reached,
    /// The watch asked to stop; the state stands at the last completed increment.
    Cancelled,
    /// The solution could not be continued; the state stands at the last good increment.
    Stopped {
        /// Why, in words: what did not converge, which points chattered or slid too far.
        reason: String,
    },
}

/// Why a value cannot be set.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SetError {
    /// No such input.
    #[error("no input port {index}: this deck has {count}")]
    UnknownInput {
        /// Asked for.
        index: usize,
        /// Number of inputs.
        count: usize,
    },
    /// NaN or infinity.
    #[error("input {port}: {value} is not a finite number")]
    NotFinite {
        /// Name of the port.
        port: String,
        /// The value.
        value: f64,
    },
}

/// Why a target time cannot be taken.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AdvanceError {
    /// NaN or infinity.
    #[error("target time {target} is not a finite number")]
    NotFinite {
        /// The target.
        target: f64,
    },
    /// The target lies before the present time.
    #[error("target time {target} lies before the present time {now}; restore a checkpoint to go back")]
    Past {
        /// Present time.
        now: f64,
        /// The target.
        target: f64,
    },
}

/// Why a checkpoint cannot be restored.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RestoreError {
    /// Too short, wrong magic, wrong checksum.
    #[error("not an overclosure checkpoint or damaged: {detail}")]
    Damaged {
        /// What does not fit.
        detail: String,
    },
    /// Written by another version of the format.
    #[error("checkpoint version {found} cannot be read by this build, which reads version {supported}")]
    Version {
        /// In the bytes.
        found: u32,
        /// Of this build.
        supported: u32,
    },
    /// Belongs to another deck.
    #[error("the checkpoint belongs to another model (fingerprint {found:016x}, this model has {expected:016x})")]
    OtherModel {
        /// In the bytes.
        found: u64,
        /// Of this model.
        expected: u64,
    },
}

/// Why a field cannot be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("no field {name}: available are {available}")]
pub struct FieldError {
    /// Asked for.
    pub name: String,
    /// What there is, comma separated.
    pub available: String,
}
