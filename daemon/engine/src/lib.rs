//! Contact mechanics engine: pressure-overclosure laws, deck reader, contact state, statics.
//!
//! Deterministic: same model and calls, same bits. No clocks, no sockets, no threads of its own.

#![forbid(unsafe_code)]

pub mod benchmark;
pub mod deck;
pub mod diagnostic;
pub mod law;
pub mod model;
pub mod output;
pub mod port;
pub mod simulation;

mod audit;
mod cache;
mod condensation;
mod examination;
mod explicit;
mod fields;
mod fingerprint;
mod implicit;
mod kept;
mod nodal;
mod observe;
mod outputs;
mod port_config;
mod prepared;
mod request;
mod restart;
mod results;
mod state;

mod contact;
mod element;
mod procedure;
mod solve;

#[cfg(test)]
mod adjust_tests;
#[cfg(test)]
mod analytical_tests;
#[cfg(test)]
mod column_tests;
#[cfg(test)]
mod explicit_tests;
#[cfg(test)]
mod gap_tests;
#[cfg(test)]
mod implicit_tests;
#[cfg(test)]
mod load_pattern_tests;
#[cfg(test)]
mod patch_tests;
#[cfg(test)]
mod rigid_tests;
#[cfg(test)]
mod test_mesh;
#[cfg(test)]
mod underlying_tests;
