//! How a message is declared: one definition gives the struct, its name and version, and the shape that the `schema`
//! verb and the document tests read.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// A struct that travels: alone as a request or reply, or inside one.
pub trait Message: Serialize + DeserializeOwned {
    /// Name on the wire.
    const NAME: &'static str;
    /// Version on the wire; raised whenever the fields change.
    const VERSION: u32;
    /// Fields in wire order.
    fn shape() -> MessageShape;
}

/// An enum that travels: the position of a variant is its postcard tag, its snake-case name its JSON text.
pub trait Choice {
    /// Name in the documentation.
    const NAME: &'static str;
    /// Names of the variants, in wire order.
    fn shape() -> MessageShape;
}

/// Shape of a struct or of an enum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MessageShape {
    /// `StepRequest/1`; an enum has no version.
    pub name: String,
    /// One line on its purpose.
    pub purpose: String,
    /// Fields in wire order; variants of an enum have an empty kind.
    pub fields: Vec<FieldShape>,
}

/// One field, or one variant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FieldShape {
    /// Name in JSON.
    pub name: String,
    /// Rust type as written: `f64`, `u32`, `u64`, `String`, `Vec<f64>`, `Option<String>`, or another message.
    pub kind: String,
    /// Meaning, unit and sign.
    pub meaning: String,
}

/// A request that says nothing: no bytes at all, or `{}`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Empty;

fn sentence(lines: &[&str]) -> String {
    lines.iter().map(|l| l.trim()).collect::<Vec<_>>().join(" ").replace("\\[", "[").replace("\\]", "]")
}

pub(crate) fn field_shape(name: &str, kind: &str, lines: &[&str]) -> FieldShape {
    FieldShape { name: name.trim_start_matches("r#").into(), kind: kind.replace(' ', ""), meaning: sentence(lines) }
}

pub(crate) fn message_shape(name: &str, lines: &[&str], fields: Vec<FieldShape>) -> MessageShape {
    MessageShape { name: name.into(), purpose: sentence(lines), fields }
}

/// JSON text of a variant: `IncrementLimit` is `increment_limit`.
pub(crate) fn snake_case(name: &str) -> String {
    let mut text = String::new();
    for c in name.chars() {
        if c.is_ascii_uppercase() && !text.is_empty() {
            text.push('_');
        }
        text.push(c.to_ascii_lowercase());
    }
    text
}

macro_rules! message {
    ($(#[doc = $doc:literal])* $(#[serde($($container:tt)*)])? pub struct $name:ident / $version:literal {
        $($(#[doc = $field_doc:literal])* $(#[serde($($attribute:tt)*)])? pub $field:ident: $kind:ty,)*
    }) => {
        $(#[doc = $doc])*
        #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
        $(#[serde($($container)*)])?
        pub struct $name {
            $($(#[doc = $field_doc])* $(#[serde($($attribute)*)])? pub $field: $kind,)*
        }

        impl $crate::message::Message for $name {
            const NAME: &'static str = stringify!($name);
            const VERSION: u32 = $version;

            fn shape() -> $crate::message::MessageShape {
                $crate::message::shape::message_shape(
                    concat!(stringify!($name), "/", $version),
                    &[$($doc),*],
                    vec![$($crate::message::shape::field_shape(stringify!($field), stringify!($kind), &[$($field_doc),*]),)*],
                )
            }
        }
    };
}

macro_rules! choice {
    ($(#[doc = $doc:literal])* pub enum $name:ident {
        $($(#[doc = $variant_doc:literal])* $variant:ident,)*
    } default $chosen:ident) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum $name {
            $($(#[doc = $variant_doc])* $variant,)*
        }

        impl Default for $name {
            fn default() -> Self {
                Self::$chosen
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                match self {
                    $(Self::$variant => f.write_str(&$crate::message::shape::snake_case(stringify!($variant))),)*
                }
            }
        }

        impl $name {
            /// All variants, in wire order.
            pub const ALL: &'static [Self] = &[$(Self::$variant),*];
        }

        impl $crate::message::Choice for $name {
            const NAME: &'static str = stringify!($name);

            fn shape() -> $crate::message::MessageShape {
                $crate::message::shape::message_shape(
                    stringify!($name),
                    &[$($doc),*],
                    vec![$($crate::message::shape::field_shape(
                        &$crate::message::shape::snake_case(stringify!($variant)), "", &[$($variant_doc),*],
                    ),)*],
                )
            }
        }
    };
}

pub(crate) use {choice, message};

/// Shapes of everything that travels, requests and replies first.
pub fn shapes() -> Vec<MessageShape> {
    use super::*;
    use crate::fault::{Fault, FaultCode, FaultDetails};
    vec![
        Fault::shape(),
        Info::shape(),
        Health::shape(),
        Load::shape(),
        SchemaReply::shape(),
        LawRequest::shape(),
        LawReply::shape(),
        OpenRequest::shape(),
        OpenReply::shape(),
        Ports::shape(),
        StepRequest::shape(),
        StepReply::shape(),
        GetRequest::shape(),
        GetReply::shape(),
        FieldRequest::shape(),
        Field::shape(),
        Checkpoint::shape(),
        RestoreRequest::shape(),
        RestoreReply::shape(),
        Report::shape(),
        CloseReply::shape(),
        Frame::shape(),
        FaultDetails::shape(),
        Limits::shape(),
        SessionSummary::shape(),
        Parameter::shape(),
        InputValue::shape(),
        NamedValue::shape(),
        Port::shape(),
        Finding::shape(),
        Counts::shape(),
        StepSummary::shape(),
        FaultCode::shape(),
        HealthStatus::shape(),
        Dialect::shape(),
        SolverPath::shape(),
        Quantity::shape(),
        Severity::shape(),
        StepStatus::shape(),
    ]
}
