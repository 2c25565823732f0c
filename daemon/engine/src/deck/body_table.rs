//! Keywords of contact elements and rigid bodies, with every parameter that is known for them.

use super::keywords::DataLines::Fields;
use super::keywords::Placement::Model;
use super::keywords::{Keyword, Parameter as P};

/// Keywords of what meets without a mesh of solids.
pub const BODIES: &[Keyword] = &[Keyword::read("*GAP", Model, Fields, &[P::required("ELSET")])];
