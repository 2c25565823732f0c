//! The deck reader through its public face.

mod adjust;
mod base;
mod connectors;
mod damage;
mod equations;
mod restart;
mod rules;
