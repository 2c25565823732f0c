//! Contact geometry: search, projection, constraint rows.
