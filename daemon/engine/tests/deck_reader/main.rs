//! The deck reader through its public face.

mod adjust;
mod base;
mod combinations;
mod connectors;
mod contact;
mod contact_steps;
mod damage;
mod dynamics;
mod equations;
mod explicit;
mod general;
mod restart;
mod rules;
