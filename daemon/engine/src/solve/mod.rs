//! Linear algebra and the contact solve: bodies are factored once and condensed onto their contact points.

pub mod assembly;
pub mod block_matrix;
#[cfg(test)]
mod block_matrix_tests;
pub mod bodies;
pub mod body;
pub mod budget;
pub mod columns;
pub mod condensed;
pub mod constraints;
pub mod contact;
pub mod context;
pub mod floating;
pub mod inertia;
#[cfg(test)]
mod inertia_tests;
pub mod lazy;
pub mod linear;
pub mod loose;
pub mod motions;
pub mod numbering;
mod ordering;
pub mod parts;
pub mod plan;
pub mod reactions;
mod rigid;
pub mod sparse;
