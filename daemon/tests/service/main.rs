//! The daemon as a whole: the real executable on a free loopback port, driven through the clients and bare zenoh.

#![allow(clippy::unwrap_used, reason = "tests")]

mod command_line;
mod contact;
mod faults;
mod lifecycle;
mod load;
mod process;
mod support;
