//! Requests and replies as plain data.
//!
//! Rules that keep them readable by other languages and other versions:
//!
//! * Postcard is positional: fields are never reordered, variants are appended only; a message whose fields change
//!   gets a new version number.
//! * Structs of scalars, texts, lists, options and other structs; enums carry no data.
//! * Bulk arrays stand last, `f64` after everything else.
//! * In JSON, fields of a request that have a default may be left out, and unknown fields are refused.

mod daemon;
mod law;
mod session;
pub(crate) mod shape;
mod stepping;

pub use daemon::{Health, HealthStatus, Info, Limits, Load, SchemaReply, SessionSummary};
pub use law::{LawReply, LawRequest, Parameter};
pub use session::{
    CloseReply, Dialect, Finding, InputValue, OpenReply, OpenRequest, Port, Ports, Quantity, Report, Severity,
    SolverPath, StepSummary,
};
pub use shape::{Choice, Empty, FieldShape, Message, MessageShape, shapes};
pub use stepping::{
    Checkpoint, Counts, Field, FieldRequest, Frame, GetReply, GetRequest, NamedValue, RestoreReply, RestoreRequest,
    StepReply, StepRequest, StepStatus,
};

pub(crate) use shape::{choice, message};
