//! Messages, key expressions and codecs of the overclosure service.
//!
//! Plain data and text only: no engine types and no transport. `PROTOCOL.md` beside this crate says the same for
//! implementers in other languages; a test keeps the two together.
//!
//! * [`key`] — the key expressions, built and parsed.
//! * [`codec`] — encodings, their negotiation, and bounded decoding.
//! * [`message`] — requests and replies.
//! * [`fault`] — the one error reply.
//! * [`arguments`] — requests written as selector parameters, for stock tools.

#![forbid(unsafe_code)]

pub mod arguments;
pub mod codec;
pub mod fault;
pub mod key;
pub mod message;
mod text;

/// Version of the key space and of the message set; the `v1` of every key.
pub const PROTOCOL_VERSION: u32 = 1;

/// Where a daemon listens unless told otherwise.
pub const DEFAULT_ENDPOINT: &str = "tcp/127.0.0.1:7447";
