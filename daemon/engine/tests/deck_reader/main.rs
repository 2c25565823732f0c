//! The deck reader through its public face.

mod base;
mod damage;
mod restart;
mod rules;
