//! `law`: stateless evaluation of a pressure-overclosure relationship in batches.

use super::message;

message! {
    /// Request of `law`.
    #[serde(deny_unknown_fields)]
    pub struct LawRequest/1 {
        /// Law kind, e.g. `linear`, `tabular`, `exponential`.
        pub kind: String,
        /// Parameters by name.
        #[serde(default)]
        pub parameters: Vec<Parameter>,
        /// Overclosures \[length\], positive when the bodies overlap.
        #[serde(with = "crate::text::numbers")]
        pub overclosure: Vec<f64>,
    }
}

message! {
    /// A parameter of a law, written as on the command line.
    #[serde(deny_unknown_fields)]
    pub struct Parameter/1 {
        /// Name, e.g. `clearance_at_zero_pressure` or `c0`.
        pub name: String,
        /// Value, e.g. `0.01`, `p1:h1,p2:h2` or `prevented`.
        pub value: String,
    }
}

message! {
    /// Reply to `law`: four arrays of equal length.
    pub struct LawReply/1 {
        /// Law kind evaluated.
        pub kind: String,
        /// Overclosures as requested \[length\], positive when the bodies overlap.
        #[serde(with = "crate::text::numbers")]
        pub overclosure: Vec<f64>,
        /// Contact pressure \[pressure\], positive pushes the bodies apart.
        #[serde(with = "crate::text::numbers")]
        pub pressure: Vec<f64>,
        /// Slope of the pressure over the overclosure \[pressure/length\].
        #[serde(with = "crate::text::numbers")]
        pub stiffness: Vec<f64>,
        /// Integral of the pressure over the overclosure \[pressure*length\].
        #[serde(with = "crate::text::numbers")]
        pub energy: Vec<f64>,
    }
}
