//! Keywords of the model part that are read, but for contact (`contact_table`), with every parameter that is known for them.

use super::keywords::DataLines::{Elements, Faces, Fields, Forbidden, Members, Nodes, Text};
use super::keywords::Effect::{Read, Refused};
use super::keywords::Placement::{Anywhere, Material, Model};
use super::keywords::{Keyword, Parameter as P};

const WRITE_INTO_DECK: &str = "bring the lines in with *INCLUDE under the keyword";
const FLAT_DECK: &str = "write the deck without parts and assemblies";
const NO_DAMPING: &str = "it acts in modal analyses only";
const STATICS_ONLY: &str = "it belongs to modal and harmonic analyses, which are not solved";

/// Keywords that describe the model.
pub const MODEL: &[Keyword] = &[
    Keyword::read("*HEADING", Anywhere, Text, &[P::silent("SPARSE"), P::silent("UNSYMM")]),
    Keyword::read(
        "*INCLUDE",
        Anywhere,
        Fields,
        &[P::required("INPUT"), P::refused("PASSWORD", "decrypt the file first")],
    ),
    Keyword::read(
        "*NODE",
        Model,
        Nodes,
        &[
            P::value("NSET"),
            P::one_of(
                "SYSTEM",
                &[
                    ("R", Read),
                    ("C", Refused("write rectangular coordinates")),
                    ("S", Refused("write rectangular coordinates")),
                ],
            ),
            P::refused("INPUT", WRITE_INTO_DECK),
        ],
    ),
    Keyword::read(
        "*ELEMENT",
        Model,
        Elements,
        &[
            P::required("TYPE"),
            P::value("ELSET"),
            P::refused("INPUT", WRITE_INTO_DECK),
            P::refused("OFFSET", "write the element numbers as they shall be"),
            P::ignored("SOLID ELEMENT NUMBERING", "element numbers are taken as written"),
        ],
    ),
    Keyword::read(
        "*NSET",
        Anywhere,
        Members,
        &[
            P::required("NSET"),
            P::value("ELSET"),
            P::flag("GENERATE"),
            P::ignored("FREQUENCY", "a set is a definition, not a request for output"),
            P::flag("UNSORTED"),
            P::silent("INTERNAL"),
            P::refused("INSTANCE", FLAT_DECK),
        ],
    ),
    Keyword::read(
        "*ELSET",
        Anywhere,
        Members,
        &[
            P::required("ELSET"),
            P::flag("GENERATE"),
            P::silent("UNSORTED"),
            P::silent("INTERNAL"),
            P::refused("INSTANCE", FLAT_DECK),
        ],
    ),
    Keyword::read(
        "*SURFACE",
        Anywhere,
        Faces,
        &[
            P::required("NAME"),
            P::one_of(
                "TYPE",
                &[
                    ("ELEMENT", Read),
                    ("NODE", Read),
                    ("CUTTINGSURFACE", Refused("name the faces of the surface")),
                    ("CYLINDER", Read),
                    ("REVOLUTION", Read),
                    (
                        "SEGMENTS",
                        Refused("it belongs to plane models: sweep the profile with TYPE=CYLINDER or TYPE=REVOLUTION"),
                    ),
                    ("USER", Refused("mesh the rigid body with elements")),
                    ("EULERIANMATERIAL", Refused("name the faces of the surface")),
                ],
            ),
            P::silent("INTERNAL"),
            P::silent("REGION TYPE"),
            P::silent("NO OFFSET"),
            P::silent("NO THICK"),
            P::silent("SCALE THICK"),
            P::silent("MAX RATIO"),
            P::refused("COMBINE", "write the faces of the combined surface"),
            P::refused("CROP", "write the faces of the cropped surface"),
            P::refused("FILLET RADIUS", "write the fillets as CIRCL segments of the profile"),
            P::refused("INSTANCE", FLAT_DECK),
            P::ignored("TRIM", "free faces of solids are never trimmed"),
            P::ignored("PROPERTY", "node-to-surface contact uses the mesh as it is"),
        ],
    ),
    Keyword::read("*MATERIAL", Model, Forbidden, &[P::required("NAME"), P::silent("RTOL"), P::silent("SRATE FACTOR")]),
    Keyword::read(
        "*ELASTIC",
        Material,
        Fields,
        &[
            P::one_of(
                "TYPE",
                &[
                    ("ISOTROPIC", Read),
                    ("ISO", Read),
                    ("ORTHOTROPIC", Refused("only isotropic elasticity is solved")),
                    ("ORTHO", Refused("only isotropic elasticity is solved")),
                    ("ENGINEERINGCONSTANTS", Refused("only isotropic elasticity is solved")),
                    ("EC", Refused("only isotropic elasticity is solved")),
                    ("ANISOTROPIC", Refused("only isotropic elasticity is solved")),
                    ("ANISO", Refused("only isotropic elasticity is solved")),
                    ("LAMINA", Refused("only isotropic elasticity is solved")),
                    ("TRACTION", Refused("only isotropic elasticity is solved")),
                    ("COUPLEDTRACTION", Refused("only isotropic elasticity is solved")),
                    ("SHEAR", Refused("only isotropic elasticity is solved")),
                ],
            ),
            P::ignored("MODULI", "without viscoelasticity both moduli are the same"),
            P::refused("DEPENDENCIES", "give one line: modulus, Poisson's ratio"),
        ],
    ),
    Keyword::read(
        "*DENSITY",
        Material,
        Fields,
        &[
            P::refused("DEPENDENCIES", "give one line: density"),
            P::refused("PORE FLUID", "give the density of the solid"),
        ],
    ),
    Keyword::read(
        "*SOLID SECTION",
        Model,
        Fields,
        &[
            P::required("ELSET"),
            P::required("MATERIAL"),
            P::ignored("ORIENTATION", "the material is isotropic; stresses are written in global directions"),
            P::ignored("CONTROLS", "no element that is read has hourglass or other controls"),
            P::silent("OFFSET"),
            P::silent("STACK DIRECTION"),
            P::refused("COMPOSITE", "give each layer its own elements and section"),
            P::refused("NODAL THICKNESS", "solids have no thickness"),
            P::refused("REF NODE", "solids have no reference node"),
            P::refused("SYMMETRIC", "give each layer its own elements and section"),
        ],
    ),
    Keyword::read(
        "*SPRING",
        Model,
        Fields,
        &[
            P::required("ELSET"),
            P::silent("RTOL"),
            P::refused("NONLINEAR", "a spring has one stiffness: force per elongation, in tension and compression"),
            P::refused("ORIENTATION", "give directions of a SPRING1 or SPRING2 in global axes"),
            P::refused("COMPLEX STIFFNESS", STATICS_ONLY),
            P::refused("DEPENDENCIES", "give one stiffness"),
        ],
    ),
    Keyword::read(
        "*MASS",
        Model,
        Fields,
        &[
            P::required("ELSET"),
            P::one_of(
                "TYPE",
                &[("ISOTROPIC", Read), ("ANISOTROPIC", Refused("a mass is the same in every direction"))],
            ),
            P::refused("ORIENTATION", "a mass is the same in every direction"),
            P::value("ALPHA"),
            P::ignored("COMPOSITE", NO_DAMPING),
        ],
    ),
    Keyword::read(
        "*EQUATION",
        Model,
        Fields,
        &[
            P::refused("INPUT", WRITE_INTO_DECK),
            P::refused("REMOVE", "an equation holds in every step"),
            P::refused("REMOVE ALL", "an equation holds in every step"),
        ],
    ),
    Keyword::read(
        "*AMPLITUDE",
        Anywhere,
        Fields,
        &[
            P::required("NAME"),
            P::one_of("TIME", &[("STEPTIME", Read), ("STEP", Read), ("TOTALTIME", Read), ("TOTAL", Read)]),
            P::one_of(
                "VALUE",
                &[("RELATIVE", Read), ("ABSOLUTE", Refused("write factors of the magnitude, VALUE=RELATIVE"))],
            ),
            P::one_of(
                "DEFINITION",
                &[
                    ("TABULAR", Read),
                    ("ACTUATOR", Refused("write the curve as a table")),
                    ("BUBBLE", Refused("write the curve as a table")),
                    ("DECAY", Refused("write the curve as a table")),
                    ("EQUALLYSPACED", Refused("write times with the values, DEFINITION=TABULAR")),
                    ("MODULATED", Refused("write the curve as a table")),
                    ("PERIODIC", Refused("write the curve as a table")),
                    ("PSD", Refused("write the curve as a table")),
                    ("SMOOTHSTEP", Refused("write the curve as a table")),
                    ("SOLUTIONDEPENDENT", Refused("write the curve as a table")),
                    ("SPECTRUM", Refused("write the curve as a table")),
                    ("USER", Refused("write the curve as a table")),
                ],
            ),
            P::value("SMOOTH"),
            P::refused("INPUT", WRITE_INTO_DECK),
            P::refused("USER", "write the curve as a table"),
            P::refused("SHIFTX", "write the shifted times"),
            P::refused("SHIFTY", "write the shifted values"),
            P::refused("FIXED INTERVAL", "write times with the values"),
        ],
    ),
    Keyword::read(
        "*BOUNDARY",
        Anywhere,
        Fields,
        &[
            P::one_of("OP", &[("MOD", Read), ("NEW", Read)]),
            P::value("AMPLITUDE"),
            P::one_of("TYPE", &[("DISPLACEMENT", Read), ("VELOCITY", Read), ("ACCELERATION", Read)]),
            P::silent("REGION TYPE"),
            P::refused("FIXED", "prescribe the displacements reached in the step before"),
            P::refused("LOAD CASE", STATICS_ONLY),
            P::refused("USER", "write the values"),
            P::refused("SUBMODEL", "write the values of the global model"),
            P::refused("STEP", "write the values of the global model"),
            P::refused("BASE NAME", STATICS_ONLY),
            P::refused("BLOCKING", STATICS_ONLY),
            P::refused("MASS FLOW", "only solids are solved"),
            P::refused("TIMEDELAY", "put the delay into the amplitude"),
            P::refused("SECTOR", "write the values of each sector"),
        ],
    ),
];
