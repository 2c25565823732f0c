//! Contact geometry: search, projection, tributary areas.

pub mod adjust;
mod analytical;
mod gap_points;
mod node_areas;
pub mod points;
mod primary;
mod search;
mod secondary;
pub(crate) mod underlying;
