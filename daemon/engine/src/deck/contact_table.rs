//! Keywords of contact that are read, with every parameter that is known for them.

use super::keywords::DataLines::Fields;
use super::keywords::Effect::{Read, Refused};
use super::keywords::Placement::{Interaction, Model, Step};
use super::keywords::{Keyword, Parameter as P};

const NO_MORTAR: &str =
    "mortar contact is not solved; write TYPE=NODE TO SURFACE to have forces act at the secondary nodes";
const NO_SLIDING: &str = "sliding is small";

/// Keywords of contact.
pub const CONTACT: &[Keyword] = &[
    Keyword::read(
        "*SURFACE INTERACTION",
        Model,
        Fields,
        &[
            P::required("NAME"),
            P::silent("UNSYMM"),
            P::silent("TRACKING THICKNESS"),
            P::refused("PAD THICKNESS", "move the nodes of the secondary surface"),
            P::refused("USER", "choose a law with *SURFACE BEHAVIOR"),
            P::refused("DEPVAR", "choose a law with *SURFACE BEHAVIOR"),
            P::refused("PROPERTIES", "choose a law with *SURFACE BEHAVIOR"),
        ],
    ),
    Keyword::read(
        "*SURFACE BEHAVIOR",
        Interaction,
        Fields,
        &[
            P::one_of(
                "PRESSURE-OVERCLOSURE",
                &[
                    ("HARD", Read),
                    ("LINEAR", Read),
                    ("TABULAR", Read),
                    ("EXPONENTIAL", Read),
                    ("TIED", Refused("tied contact is not solved; choose HARD, LINEAR, TABULAR or EXPONENTIAL")),
                    ("SCALEFACTOR", Refused("choose HARD, LINEAR, TABULAR or EXPONENTIAL")),
                    ("USER", Refused("choose HARD, LINEAR, TABULAR or EXPONENTIAL")),
                ],
            ),
            P::flag("AUGMENTED LAGRANGE"),
            P::flag("NO SEPARATION"),
            P::flag("DIRECT"),
            P::one_of("PENALTY", &[("", Read), ("LINEAR", Read), ("NONLINEAR", Read)]),
        ],
    ),
    Keyword::read(
        "*CONTACT DAMPING",
        Interaction,
        Fields,
        &[
            P::one_of("DEFINITION", &[("DAMPINGCOEFFICIENT", Read), ("CRITICALDAMPINGFRACTION", Read)]),
            P::value("TANGENT FRACTION"),
        ],
    ),
    Keyword::read(
        "*FRICTION",
        Interaction,
        Fields,
        &[
            P::silent("SLIP TOLERANCE"),
            P::silent("ELASTIC SLIP"),
            P::silent("LAGRANGE"),
            P::value("TAUMAX"),
            P::silent("SHEAR TRACTION SLOPE"),
            P::flag("ROUGH"),
            P::refused("USER", "contact is solved without friction"),
            P::refused("ANISOTROPIC", "contact is solved without friction"),
            P::refused("EXPONENTIAL DECAY", "contact is solved without friction"),
            P::refused("TEST DATA", "contact is solved without friction"),
            P::refused("DEPENDENCIES", "contact is solved without friction"),
            P::refused("DEPVAR", "contact is solved without friction"),
            P::refused("PROPERTIES", "contact is solved without friction"),
        ],
    ),
    Keyword::read(
        "*CONTACT PAIR",
        Model,
        Fields,
        &[
            P::value("INTERACTION"),
            P::one_of(
                "TYPE",
                &[
                    ("NODETOSURFACE", Read),
                    ("SURFACETOSURFACE", Read),
                    ("MORTAR", Refused(NO_MORTAR)),
                    ("LINMORTAR", Refused(NO_MORTAR)),
                    ("PGLINMORTAR", Refused(NO_MORTAR)),
                    ("PGMORTAR", Refused(NO_MORTAR)),
                    (
                        "MASSLESS",
                        Refused(
                            "it belongs to explicit steps of CalculiX, which are not solved: write TYPE=NODE TO SURFACE",
                        ),
                    ),
                ],
            ),
            P::flag("SMALL SLIDING"),
            P::silent("NO THICKNESS"),
            P::value("CPSET"),
            P::value("EXTENSION ZONE"),
            P::value("ADJUST"),
            P::value("HCRIT"),
            P::ignored("SMOOTH", "sliding is small; the primary surface is used as meshed"),
            P::ignored("SLIDE DISTANCE", NO_SLIDING),
            P::ignored("TRACKING", NO_SLIDING),
            P::ignored("SUPPLEMENTARY CONSTRAINTS", "node-to-surface contact has one point per secondary node"),
            P::refused("TIED", "tied contact is not solved"),
            P::refused("GEOMETRIC CORRECTION", "the primary surface is used as meshed"),
            P::refused("MINIMUM DISTANCE", "the distances of the mesh are used"),
            P::one_of("MECHANICAL CONSTRAINT", &[("KINEMATIC", Read), ("PENALTY", Read)]),
            P::value("WEIGHT"),
            P::one_of("OP", &[("ADD", Read), ("DELETE", Read)]),
        ],
    ),
    Keyword::read(
        "*CLEARANCE",
        Model,
        Fields,
        &[
            P::value("MASTER"),
            P::value("SLAVE"),
            P::value("CPSET"),
            P::value("VALUE"),
            P::flag("TABULAR"),
            P::refused("INPUT", "bring the lines in with *INCLUDE under the keyword"),
            P::refused("BOLT", "threads are not modelled: mesh them, or give clearances"),
        ],
    ),
    Keyword::read(
        "*CONTACT CONTROLS",
        Step,
        Fields,
        &[
            P::value("MASTER"),
            P::value("SLAVE"),
            P::value("ABSOLUTE PENETRATION TOLERANCE"),
            P::value("RELATIVE PENETRATION TOLERANCE"),
            P::value("STIFFNESS SCALE FACTOR"),
            P::value("MAXCHP"),
            P::value("PERRMX"),
            P::value("UERRMX"),
            P::flag("AUTOMATIC TOLERANCES"),
            P::flag("APPROACH"),
            P::optional("STABILIZE"),
            P::value("TANGENT FRACTION"),
            P::one_of("FRICTION ONSET", &[("IMMEDIATE", Read), ("DELAYED", Read)]),
            P::optional("SLIDE DISTANCE"),
            P::flag("RESET"),
            P::ignored(
                "LAGRANGE MULTIPLIER",
                "every enforcement converges to what it states, whether multipliers are unknowns or not",
            ),
            P::ignored("PERTURBATION TANGENT SCALE FACTOR", "it acts in linear perturbation steps only"),
            P::value("CPSET"),
            P::value("SCALE PENALTY"),
            P::optional("FASTLOCALTRK"),
            P::optional("GLOBTRKINC"),
            P::optional("WARP CHECK PERIOD"),
            P::optional("WARP CUT OFF"),
        ],
    ),
    Keyword::read(
        "*CONTACT INTERFERENCE",
        Step,
        Fields,
        &[
            P::one_of("TYPE", &[("CONTACTPAIR", Read), ("ELEMENT", Read)]),
            P::flag("SHRINK"),
            P::value("AMPLITUDE"),
            P::one_of("OP", &[("MOD", Read), ("NEW", Read)]),
        ],
    ),
    Keyword::read(
        "*MODEL CHANGE",
        Step,
        Fields,
        &[
            P::one_of(
                "TYPE",
                &[("CONTACTPAIR", Read), ("ELEMENT", Refused("elements stay; switch contact with TYPE=CONTACT PAIR"))],
            ),
            P::one_of(
                "ADD",
                &[
                    ("", Read),
                    ("STRAINFREE", Refused("elements stay; switch contact with TYPE=CONTACT PAIR")),
                    ("WITHSTRAIN", Refused("elements stay; switch contact with TYPE=CONTACT PAIR")),
                ],
            ),
            P::flag("REMOVE"),
            P::refused("ACTIVATE", "elements stay; switch contact with TYPE=CONTACT PAIR"),
            P::silent("RESTART"),
        ],
    ),
    Keyword::read(
        "*CHANGE FRICTION",
        Step,
        Fields,
        &[
            P::value("INTERACTION"),
            P::value("ELSET"),
            P::flag("RESET"),
            P::refused("AMPLITUDE", "the new friction holds from the start of the step"),
        ],
    ),
];
