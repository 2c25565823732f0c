//! The dependency rules of the workspace, held by a test.
//!
//! Which crate may link what, which module may name what, and where `unsafe` may stand. A failure here means that an arrow
//! was added to the architecture: that is a design change, not a test to be adjusted.

mod crates;
mod sources;
