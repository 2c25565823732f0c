//! `law`: stateless evaluation of a pressure-overclosure relationship in batches.

use super::message;

message! {
    /// Request of `law`.
    #[serde(deny_unknown_fields)]
    pub struct LawRequest/1 {
        /// Law kind, e.g. `linear`, `tabular`, `exponential`; all are in `Info.law_kinds`.
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
    /// Reply to `law`: arrays as long as the request's; those that the kind does not have are empty.
    pub struct LawReply/2 {
        /// Law kind evaluated.
        pub kind: String,
        /// Overclosures as requested \[length\], positive when the bodies overlap.
        #[serde(with = "crate::text::numbers")]
        pub overclosure: Vec<f64>,
        /// Contact pressure \[pressure\], positive pushes the bodies apart. Empty for `damping`.
        #[serde(with = "crate::text::numbers")]
        pub pressure: Vec<f64>,
        /// Slope of the pressure over the overclosure \[pressure/length\]. Empty for `damping`.
        #[serde(with = "crate::text::numbers")]
        pub stiffness: Vec<f64>,
        /// Integral of the pressure over the overclosure \[pressure*length\]. Empty for `damping`.
        #[serde(with = "crate::text::numbers")]
        pub energy: Vec<f64>,
        /// Of `damping`: viscous pressure per closing speed \[pressure*time/length\]. Empty for a law.
        #[serde(with = "crate::text::numbers")]
        pub coefficient: Vec<f64>,
        /// Of `damping`: slope of the coefficient over the overclosure \[pressure*time/length^2\]. Empty for a law.
        #[serde(with = "crate::text::numbers")]
        pub coefficient_slope: Vec<f64>,
    }
}
