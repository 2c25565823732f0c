//! Contact geometry: search, projection, tributary areas.

pub mod adjust;
mod analytical;
mod gap_points;
mod general;
mod node_areas;
pub mod points;
mod primary;
mod search;
mod secondary;
mod side;
pub(crate) mod underlying;
