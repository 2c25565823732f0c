//! FMI 2.0 co-simulation library of overclosure.
//!
//! Three layers: C functions ([`ffi`], the only file with `unsafe`) → [`instance::Instance`] with its call-order table
//! ([`lifecycle`]) → a [`backend::Backend`]: a deck solved by the engine, or a pressure-overclosure law.
//!
//! Built as a shared library it is what an FMU carries in `binaries/`. Built as an rlib it tells the packer which
//! variables an FMU has, so that the description and the library cannot disagree.

#![deny(unsafe_code)]

pub mod backend;
#[allow(unsafe_code)]
pub mod ffi;
pub mod fingerprint;
pub mod instance;
pub mod lifecycle;
pub mod log;
pub mod open;
pub mod resources;
pub mod snapshot;
pub mod status;
pub mod variables;
