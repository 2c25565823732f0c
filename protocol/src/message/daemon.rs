//! `info`, `health`, `load`, `schema`.

use super::{MessageShape, choice, message};

message! {
    /// Reply to `info`: who answers, in which version, with which limits.
    pub struct Info/2 {
        /// Daemon id, the third chunk of its keys.
        pub daemon: String,
        /// Always `overclosure`.
        pub product: String,
        /// Version of the product.
        pub version: String,
        /// Version of the protocol, the `v1` of the keys.
        pub protocol: u32,
        /// Media types understood.
        pub encodings: Vec<String>,
        /// Law kinds that `law` evaluates.
        pub law_kinds: Vec<String>,
        /// Dialects in which a deck can be read.
        pub dialects: Vec<String>,
        /// Limits in force.
        pub limits: Limits,
    }
}

message! {
    /// Limits of a daemon; every one of them can be configured.
    pub struct Limits/2 {
        /// Sessions open at the same time.
        pub sessions: u32,
        /// Requests that may wait for one session; one more is refused as busy.
        pub queue: u32,
        /// Bytes of one request.
        pub message_bytes: u64,
        /// Increments that one step request may take.
        pub increments_per_request: u32,
        /// Overclosures in one law request.
        pub law_points: u32,
        /// Replies to mutating requests kept for repetition, per session.
        pub replies_kept: u32,
        /// Threads that one session may ask for.
        pub threads: u32,
        /// Seconds without a request after which a session is closed; 0: never. A running request is not idle.
        #[serde(with = "crate::text::number")]
        pub idle_seconds: f64,
    }
}

choice! {
    /// Whether a daemon takes work.
    pub enum HealthStatus {
        /// It does.
        Ready,
        /// It is shutting down: running requests finish, new ones are refused.
        Draining,
    } default Ready
}

message! {
    /// Reply to `health`.
    pub struct Health/1 {
        /// Whether the daemon takes work.
        pub status: HealthStatus,
        /// Seconds since it started.
        #[serde(with = "crate::text::number")]
        pub uptime_seconds: f64,
        /// Sessions lost to a defect of the solver since the start; each one was answered with a fault.
        pub sessions_failed: u64,
        /// Frames dropped because increments came faster than frames can be sent.
        pub frames_dropped: u64,
    }
}

message! {
    /// Reply to `load`: how busy the daemon is.
    pub struct Load/2 {
        /// Sessions that may still be opened.
        pub sessions_free: u32,
        /// Step requests accepted since the start.
        pub steps: u64,
        /// Increments solved since the start.
        pub increments: u64,
        /// Models in memory; sessions of identical decks share one.
        pub models: u32,
        /// One entry per open session.
        pub sessions: Vec<SessionSummary>,
    }
}

message! {
    /// A session as `load` lists it.
    pub struct SessionSummary/2 {
        /// Session id, the fifth chunk of its keys.
        pub session: String,
        /// Label given when it was opened.
        pub label: String,
        /// Whether a request is being worked on.
        pub working: bool,
        /// Requests waiting.
        pub waiting: u32,
        /// Sequence number that the next step or restore must carry.
        pub sequence_next: u64,
        /// Total time reached \[time\].
        #[serde(with = "crate::text::number")]
        pub time: f64,
        /// Seconds since its last request was answered; 0 while one is being worked on.
        #[serde(with = "crate::text::number")]
        pub idle_seconds: f64,
    }
}

message! {
    /// Reply to `schema`: the fields of everything that travels, in wire order.
    pub struct SchemaReply/1 {
        /// Messages first, then the structs inside them, then enums.
        pub messages: Vec<MessageShape>,
    }
}
