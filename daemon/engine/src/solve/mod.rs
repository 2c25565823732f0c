//! Linear algebra and the contact solve.
