//! Contact geometry: search, projection, tributary areas.

pub mod adjust;
pub mod points;
mod search;
