//! Procedures: how time advances through the steps of a deck.

pub mod enforcement;
mod failure;
pub mod interference;
pub mod interval;
pub mod loading;
pub mod modified_hard;
pub mod motion;
mod removal;
pub mod rows;
pub mod statics;
