//! Keywords of general contact (Abaqus/Explicit) that are read, with every parameter that is known for them.

use super::keywords::DataLines::{Fields, Forbidden};
use super::keywords::Effect::{Read, Refused, Silent};
use super::keywords::Placement::Model;
use super::keywords::{Keyword, Parameter as P};

const EROSION: &str = "elements do not fail";

/// Keywords of general contact; they may stand in explicit steps too.
pub const GENERAL: &[Keyword] = &[
    Keyword::read("*CONTACT", Model, Forbidden, &[P::one_of("OP", &[("MOD", Read), ("NEW", Read)])]),
    Keyword::read(
        "*CONTACT INCLUSIONS",
        Model,
        Fields,
        &[
            P::one_of("ALL EXTERIOR", &[("", Read)]),
            P::refused("ALL ELEMENT BASED", "write ALL EXTERIOR, or name two surfaces on each line"),
        ],
    ),
    Keyword::read("*CONTACT EXCLUSIONS", Model, Fields, &[]),
    Keyword::read("*CONTACT PROPERTY ASSIGNMENT", Model, Fields, &[]),
    Keyword::read(
        "*CONTACT FORMULATION",
        Model,
        Fields,
        &[P::one_of(
            "TYPE",
            &[
                ("PUREMASTER-SLAVE", Read),
                ("PUREMAIN-SECONDARY", Read),
                ("EDGETOEDGE", Refused("nodes meet faces: leave it out")),
                ("POLARITY", Refused("solids have one outer side: leave it out")),
                ("SMALLSLIDING", Silent),
            ],
        )],
    ),
    Keyword::read(
        "*CONTACT CONTROLS ASSIGNMENT",
        Model,
        Fields,
        &[
            P::one_of("TYPE", &[("SCALEPENALTY", Read), ("FOLDINVERSIONCHECK", Silent), ("FOLDTRACKING", Silent)]),
            P::one_of("NODAL EROSION", &[("NO", Silent), ("YES", Refused(EROSION))]),
            P::silent("AUTOMATIC OVERCLOSURE RESOLUTION"),
            P::refused("CONTACT THICKNESS REDUCTION", "solids have no thickness that could be reduced"),
        ],
    ),
];
