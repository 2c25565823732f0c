//! Contact geometry: search, projection, tributary areas.

pub mod adjust;
mod gap_points;
mod node_areas;
pub mod points;
mod search;
mod underlying;
