//! Linear algebra and the contact solve: bodies are factored once and condensed onto their contact points.

pub mod assembly;
pub mod bodies;
pub mod body;
pub mod budget;
pub mod columns;
pub mod condensed;
pub mod constraints;
pub mod contact;
pub mod context;
pub mod floating;
pub mod lazy;
pub mod linear;
pub mod loose;
pub mod motions;
pub mod numbering;
mod ordering;
pub mod parts;
pub mod reactions;
mod rigid;
pub mod sparse;
