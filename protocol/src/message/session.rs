//! `open`, `ports`, `report`, `close`: the life of a session.

use super::{Counts, choice, message};

choice! {
    /// What a keyword means where codes disagree.
    pub enum Dialect {
        /// Decks mean what Abaqus means.
        Abaqus,
        /// Decks mean what CalculiX means, where that changes the answer.
        Calculix,
    } default Abaqus
}

choice! {
    /// Which solver path to take.
    pub enum SolverPath {
        /// By estimated cost.
        Auto,
        /// Condensed onto contact, dense.
        Dense,
        /// Newton on the sparse system.
        Sparse,
    } default Auto
}

message! {
    /// Request of `open`: reads a deck, prepares it and runs every step but the last.
    #[serde(default, deny_unknown_fields)]
    pub struct OpenRequest/1 {
        /// Idempotency key chosen by the client; repeating an open with the same key returns the same session. Empty: none.
        pub token: String,
        /// Name for people, shown in `load`.
        pub label: String,
        /// How keywords are read.
        pub dialect: Dialect,
        /// Solver path.
        pub path: SolverPath,
        /// Threads for the preparation; 0 and 1 both mean one. The numbers do not depend on it.
        pub threads: u32,
        /// Text of a `ports.toml`.
        pub ports_toml: Option<String>,
        /// Inputs whose deck magnitude is replaced while the deck's amplitude is kept.
        pub magnitudes: Vec<InputValue>,
        /// Text of the deck. `*INCLUDE` is refused: a text has no folder.
        pub deck: String,
    }
}

message! {
    /// Reply to `open`.
    pub struct OpenReply/1 {
        /// Session id, the fifth chunk of its keys.
        pub session: String,
        /// Sequence number that the first step or restore must carry.
        pub sequence_next: u64,
        /// Total time after the preload \[time\].
        #[serde(with = "crate::text::number")]
        pub time: f64,
        /// Total time at which the last step ends by the deck \[time\].
        #[serde(with = "crate::text::number")]
        pub time_end: f64,
        /// Warnings about the deck.
        pub warnings: Vec<Finding>,
        /// What the audit of the present solution found; empty when clean.
        pub audit: Vec<String>,
        /// Inputs and outputs.
        pub ports: Ports,
        /// Present output values, in port order.
        #[serde(with = "crate::text::numbers")]
        pub outputs: Vec<f64>,
    }
}

choice! {
    /// How much a finding weighs.
    pub enum Severity {
        /// The answer stands; the user should know.
        Warning,
        /// The deck cannot be solved as it is written.
        Error,
    } default Warning
}

message! {
    /// A finding about a deck.
    pub struct Finding/1 {
        /// Error or warning.
        pub severity: Severity,
        /// Line of the deck, from 1; 0 when the finding is about the deck as a whole.
        pub line: u32,
        /// Keyword that the line belongs to, with its star; may be empty.
        pub keyword: String,
        /// What is wrong.
        pub message: String,
        /// What the user can do; may be empty.
        pub remedy: String,
    }
}

choice! {
    /// Dimension of a port.
    pub enum Quantity {
        /// Length.
        Length,
        /// Force.
        Force,
        /// Pressure.
        Pressure,
        /// Length per time squared.
        Acceleration,
        /// Length squared.
        Area,
        /// Energy.
        Energy,
        /// Time.
        Time,
        /// Whole number.
        Count,
        /// \[radian\]
        Angle,
        /// [force·length]
        Moment,
        /// Length per time.
        Velocity,
        /// [radian/time]
        AngularVelocity,
        /// [radian/time²]
        AngularAcceleration,
    } default Count
}

message! {
    /// A scalar port.
    pub struct Port/1 {
        /// Name, unique within the session.
        pub name: String,
        /// Dimension.
        pub quantity: Quantity,
        /// Unit declared by `ports.toml`; none otherwise, then units are the deck's.
        pub unit: Option<String>,
        /// One sentence for people.
        pub description: String,
    }
}

/// `line 41: error: *KEYWORD: what is wrong; what to do`.
impl std::fmt::Display for Finding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.line > 0 {
            write!(f, "line {}: ", self.line)?;
        }
        write!(f, "{}: ", self.severity)?;
        if !self.keyword.is_empty() {
            write!(f, "{}: ", self.keyword)?;
        }
        f.write_str(&self.message)?;
        if self.remedy.is_empty() { Ok(()) } else { write!(f, "; {}", self.remedy) }
    }
}

message! {
    /// Reply to `ports`: values are exchanged in this order.
    pub struct Ports/1 {
        /// What a client may set.
        pub inputs: Vec<Port>,
        /// What a client may read.
        pub outputs: Vec<Port>,
    }
}

message! {
    /// A value for an input, by name.
    #[serde(deny_unknown_fields)]
    pub struct InputValue/1 {
        /// Name of the input.
        pub name: String,
        /// Value in the deck's units.
        #[serde(with = "crate::text::number")]
        pub value: f64,
    }
}

message! {
    /// What a step of the deck has done so far.
    pub struct StepSummary/3 {
        /// Name of the step.
        pub name: String,
        /// Its procedure, e.g. `*STATIC`.
        pub procedure: String,
        /// Total time reached \[time\].
        #[serde(with = "crate::text::number")]
        pub time_reached: f64,
        /// Work done.
        pub counts: Counts,
    }
}

message! {
    /// Reply to `report`.
    pub struct Report/3 {
        /// The session.
        pub session: String,
        /// Sequence number that the next step or restore must carry.
        pub sequence_next: u64,
        /// Total time reached \[time\].
        #[serde(with = "crate::text::number")]
        pub time: f64,
        /// Steps begun, in order.
        pub steps: Vec<StepSummary>,
        /// What the audit of the present solution found; empty when clean.
        pub audit: Vec<String>,
        /// Warnings about the deck.
        pub warnings: Vec<Finding>,
    }
}

message! {
    /// Reply to `close`.
    pub struct CloseReply/1 {
        /// The session that ended.
        pub session: String,
        /// Total time it had reached \[time\].
        #[serde(with = "crate::text::number")]
        pub time: f64,
    }
}
