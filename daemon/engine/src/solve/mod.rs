//! Linear algebra and the contact solve: bodies are factored once and condensed onto their contact points.

pub mod assembly;
pub mod body;
pub mod columns;
pub mod condensed;
pub mod contact;
pub mod linear;
pub mod numbering;
mod ordering;
pub mod rigid;
pub mod supports;
