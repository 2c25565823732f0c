//! Procedures: how time advances through the steps of a deck.

pub mod loading;
pub mod statics;
