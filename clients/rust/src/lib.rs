//! Client of the overclosure daemon.
//!
//! [`Client`] and [`Session`] are async and need a multi-threaded tokio runtime; [`blocking`] has the same calls for
//! programs without one. Every call is safe to repeat, and is repeated when the daemon does not answer: see
//! [`Options::attempts`].
//!
//! ```no_run
//! use overclosure_client::blocking::Client;
//! use overclosure_client::{OpenRequest, Options};
//!
//! # fn main() -> Result<(), overclosure_client::CallError> {
//! let client = Client::connect(Options::default())?;
//! let deck = "*HEADING\n...".to_owned();
//! let mut session = client.open(OpenRequest { deck, ..Default::default() })?;
//! let reply = session.advance(0.5, &[("boundary.NTOP.3", -0.0025)])?;
//! println!("{} {:?}", reply.time, reply.outputs);
//! session.close()?;
//! # Ok(())
//! # }
//! ```

#![forbid(unsafe_code)]

pub mod blocking;
mod call;
mod client;
mod error;
pub mod network;
mod session;

pub use client::{Client, Options};
pub use error::CallError;
pub use overclosure_protocol::fault::{Fault, FaultCode, FaultDetails};
pub use overclosure_protocol::message::*;
pub use session::{Frames, Session};
