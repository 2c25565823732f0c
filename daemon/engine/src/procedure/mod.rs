//! Procedures: how time advances through the steps of a deck.

mod accept;
pub mod courses;
pub mod enforcement;
mod explicit;
mod failure;
mod impact;
pub mod implicit;
pub mod interference;
pub mod interval;
pub mod loading;
pub mod modified_hard;
pub mod motion;
mod removal;
pub mod rows;
mod settle;
pub mod statics;
