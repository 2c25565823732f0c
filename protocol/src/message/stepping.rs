//! `step`, `get`, `field`, `checkpoint`, `restore`, and the frames published on the way.

use super::{InputValue, choice, message};

message! {
    /// Request of `step`: sets inputs and advances, in one exchange.
    #[serde(deny_unknown_fields)]
    pub struct StepRequest/1 {
        /// Sequence number: the one that the previous reply announced as next.
        pub sequence: u64,
        /// Total time to reach \[time\]; the present time applies inputs without advancing.
        #[serde(with = "crate::text::number")]
        pub time: f64,
        /// Fields to publish at the end of each increment; the output vector is always published.
        #[serde(default)]
        pub frames: Vec<String>,
        /// Inputs by name: actual values at the end of the interval, reached linearly.
        #[serde(default)]
        pub inputs: Vec<InputValue>,
        /// Inputs by position in the port list.
        #[serde(default)]
        pub indices: Vec<u32>,
        /// Their values, one for each index.
        #[serde(default, with = "crate::text::numbers")]
        pub values: Vec<f64>,
    }
}

choice! {
    /// How a step ended.
    pub enum StepStatus {
        /// The target time was reached.
        Reached,
        /// The solution could not be continued; the state stands at the last good increment, `reason` says why.
        Stopped,
        /// The limit of increments per request was reached first; the next step may go on.
        IncrementLimit,
        /// The daemon is shutting down; the state stood at the last completed increment.
        Cancelled,
    } default Reached
}

message! {
    /// Work done.
    pub struct Counts/3 {
        /// Increments completed.
        pub increments: u32,
        /// Equilibrium iterations.
        pub equilibrium_iterations: u32,
        /// Severe discontinuity iterations: those that changed a contact status.
        pub severe_discontinuity_iterations: u32,
        /// Cutbacks.
        pub cutbacks: u32,
        /// Sparse factorisations.
        pub factorizations: u32,
        /// Augmentations: times that multipliers of augmented Lagrange were brought up to date.
        pub augmentations: u32,
        /// Impacts: instants of implicit dynamic steps at which hard contact closed and velocities jumped.
        pub impacts: u32,
    }
}

message! {
    /// Reply to `step`.
    pub struct StepReply/3 {
        /// Sequence number of the request; the next one is one higher.
        pub sequence: u64,
        /// How the step ended.
        pub status: StepStatus,
        /// Why it stopped; empty when it did not.
        pub reason: String,
        /// Total time reached \[time\].
        #[serde(with = "crate::text::number")]
        pub time: f64,
        /// Work done for this request.
        pub counts: Counts,
        /// What the audit of the present solution found; empty when clean.
        pub audit: Vec<String>,
        /// All output values, in port order.
        #[serde(with = "crate::text::numbers")]
        pub outputs: Vec<f64>,
    }
}

message! {
    /// Request of `get`.
    #[serde(default, deny_unknown_fields)]
    pub struct GetRequest/1 {
        /// Ports to read, inputs or outputs; none means all.
        pub names: Vec<String>,
    }
}

message! {
    /// A value by name.
    pub struct NamedValue/1 {
        /// Name of the port.
        pub name: String,
        /// Its value.
        #[serde(with = "crate::text::number")]
        pub value: f64,
    }
}

message! {
    /// Reply to `get`.
    pub struct GetReply/1 {
        /// Sequence number that the next step or restore must carry.
        pub sequence_next: u64,
        /// Total time \[time\].
        #[serde(with = "crate::text::number")]
        pub time: f64,
        /// Total time at which the last step ends by the deck \[time\].
        #[serde(with = "crate::text::number")]
        pub time_end: f64,
        /// Inputs asked for.
        pub inputs: Vec<NamedValue>,
        /// Outputs asked for.
        pub outputs: Vec<NamedValue>,
    }
}

message! {
    /// Request of `field`.
    #[serde(deny_unknown_fields)]
    pub struct FieldRequest/1 {
        /// Name, e.g. `U`, `RF`, `S`, `CPRESS`, `COPEN`, `CSTATUS`.
        pub name: String,
    }
}

message! {
    /// Reply to `field`: row-major values, one row per label.
    pub struct Field/1 {
        /// Name of the field.
        pub name: String,
        /// Total time \[time\].
        #[serde(with = "crate::text::number")]
        pub time: f64,
        /// Values per row.
        pub components: u32,
        /// Node label of each row.
        pub labels: Vec<u32>,
        /// `labels` times `components` values, in the deck's units.
        #[serde(with = "crate::text::numbers")]
        pub values: Vec<f64>,
    }
}

message! {
    /// Reply to `checkpoint`.
    pub struct Checkpoint/1 {
        /// Total time of the state \[time\].
        #[serde(with = "crate::text::number")]
        pub time: f64,
        /// The state; opaque, versioned, checksummed. Hexadecimal digits in JSON.
        #[serde(with = "crate::text::hex_bytes")]
        pub state: Vec<u8>,
    }
}

message! {
    /// Request of `restore`.
    #[serde(deny_unknown_fields)]
    pub struct RestoreRequest/1 {
        /// Sequence number: the one that the previous reply announced as next.
        pub sequence: u64,
        /// A state of the same deck. Hexadecimal digits in JSON.
        #[serde(with = "crate::text::hex_bytes")]
        pub state: Vec<u8>,
    }
}

message! {
    /// Reply to `restore`.
    pub struct RestoreReply/1 {
        /// Sequence number of the request; the next one is one higher.
        pub sequence: u64,
        /// Total time of the state \[time\].
        #[serde(with = "crate::text::number")]
        pub time: f64,
        /// All output values, in port order.
        #[serde(with = "crate::text::numbers")]
        pub outputs: Vec<f64>,
    }
}

message! {
    /// Published per increment under `frame/outputs` and `frame/{field}`, always in postcard.
    pub struct Frame/1 {
        /// Counts the increments of the session from 1; a gap means frames that were dropped, or increments of an explicit step that were
        /// passed over: no more than some twenty in a second are published, and the last of each request.
        pub number: u64,
        /// Sequence number of the step request that it belongs to.
        pub sequence: u64,
        /// Step of the deck, from 1.
        pub step: u32,
        /// Increment within that step, from 1.
        pub increment: u32,
        /// Total time \[time\].
        #[serde(with = "crate::text::number")]
        pub time: f64,
        /// `outputs` or the name of the field.
        pub field: String,
        /// Values per row; the number of outputs for `outputs`.
        pub components: u32,
        /// Node label of each row; empty for `outputs`.
        pub labels: Vec<u32>,
        /// The values, row by row.
        #[serde(with = "crate::text::numbers")]
        pub values: Vec<f64>,
    }
}
