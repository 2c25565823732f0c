//! Keywords of contact elements and rigid bodies, with every parameter that is known for them.

use super::keywords::DataLines::{Fields, Forbidden};
use super::keywords::Effect::{Read, Refused};
use super::keywords::Placement::Model;
use super::keywords::{Keyword, Parameter as P};

/// Keywords of what meets without a mesh of solids.
pub const BODIES: &[Keyword] = &[
    Keyword::read("*GAP", Model, Fields, &[P::required("ELSET")]),
    Keyword::read(
        "*RIGID BODY",
        Model,
        Forbidden,
        &[
            P::required("REF NODE"),
            P::value("ELSET"),
            P::value("NSET"),
            P::value("TIE NSET"),
            P::value("PIN NSET"),
            P::value("ROT NODE"),
            P::value("ANALYTICAL SURFACE"),
            P::one_of(
                "POSITION",
                &[
                    ("INPUT", Read),
                    ("CENTEROFMASS", Refused("give the reference node the coordinates that it shall have")),
                ],
            ),
            P::silent("ISOTHERMAL"),
            P::refused("DENSITY", "give the weight to elements of the body by their material, or to MASS elements"),
            P::refused("NODAL THICKNESS", "facets have no thickness"),
            P::refused("OFFSET", "move the nodes of the facets"),
        ],
    ),
];
