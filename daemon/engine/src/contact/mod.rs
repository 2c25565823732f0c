//! Contact geometry: search, projection, tributary areas.

pub mod points;
mod search;
