//! Procedures: how time advances through the steps of a deck.

pub mod enforcement;
mod failure;
pub mod interference;
pub mod loading;
pub mod modified_hard;
mod removal;
pub mod rows;
pub mod statics;
