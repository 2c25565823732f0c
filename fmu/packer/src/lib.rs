//! The packer: a deck, or a pressure-overclosure law, becomes an FMI 2.0 co-simulation FMU.
//!
//! An FMU is written beside its destination, loaded with an importer of another house, stepped and compared with the
//! engine; only then does it get its name. Same input, same bytes.
//!
//! This is a crate of its own, beside the library that goes into the FMU: the importer exports C functions, and
//! archive and XML writers have no business inside an FMU.

#![forbid(unsafe_code)]

mod archive;
mod description;
mod documentation;
pub mod inline;
mod library;
mod pack;
mod picture;
mod trial;
mod units;

pub use library::{LIBRARY_VARIABLE, find_library};
pub use pack::{Carried, DeckRequest, PackError, PackReport, pack_deck, pack_law};
pub use trial::TrialError;
