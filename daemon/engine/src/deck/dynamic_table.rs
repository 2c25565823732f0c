//! Keywords of dynamics that are read: procedures, mass, damping, initial velocities, with every parameter that is known for them.

use super::keywords::DataLines::{Fields, Forbidden};
use super::keywords::Effect::{self, Read, Refused, Silent};
use super::keywords::Placement::{Anywhere, Material, Model, Step};
use super::keywords::{Keyword, Parameter as P};

const NO_HEAT: &str = "temperatures are not solved for: leave it out";
const HHT: &str = "the time operator is that of Hilber, Hughes and Taylor: choose its ALPHA";
const STABLE: &str =
    "the stable increment is estimated element by element, and with the contact stiffness, in every increment";
const VELOCITIES: &str = "initial velocities are read: write TYPE=VELOCITY";
const ONE_FACTOR: &str = "give one factor: damping is the same at all temperatures and frequencies";
const MASS_PROPORTIONAL: &str = "give damping in proportion to the mass by ALPHA";

/// Keywords of dynamics.
pub const DYNAMICS: &[Keyword] = &[
    Keyword::read(
        "*DYNAMIC",
        Step,
        Fields,
        &[
            P::one_of(
                "EXPLICIT",
                &[
                    ("", Read),
                    ("1", Refused("explicit steps of CalculiX are not solved: write EXPLICIT alone")),
                    ("2", Refused("explicit steps of CalculiX are not solved: write EXPLICIT alone")),
                    ("3", Refused("explicit steps of CalculiX are not solved: write EXPLICIT alone")),
                    ("4", Refused("explicit steps of CalculiX are not solved: write EXPLICIT alone")),
                ],
            ),
            P::value("ALPHA"),
            P::value("HAFTOL"),
            P::value("HALFINC SCALE FACTOR"),
            P::flag("NOHAF"),
            P::one_of("DIRECT", &[("", Read), ("NOSTOP", Refused("increments that do not converge stop the step"))]),
            P::one_of("INITIAL", &[("", Read), ("YES", Read), ("NO", Read)]),
            P::one_of("MASS", &[("LUMPED", Read), ("CONSISTENT", Read)]),
            P::one_of(
                "APPLICATION",
                &[
                    ("TRANSIENTFIDELITY", Silent),
                    ("MODERATEDISSIPATION", Refused(HHT)),
                    ("QUASI-STATIC", Refused("write *STATIC, or *DYNAMIC with loads that grow slowly")),
                ],
            ),
            P::one_of(
                "TIME INTEGRATOR",
                &[("HHT-TF", Silent), ("HHT-MD", Refused(HHT)), ("BWE", Refused(HHT)), ("HYBRID", Refused(HHT))],
            ),
            P::one_of(
                "IMPACT",
                &[
                    ("AVERAGETIME", Silent),
                    (
                        "CURRENTTIME",
                        Refused("impacts are located at the average of the times at which points meet: leave it out"),
                    ),
                    (
                        "NO",
                        Refused(
                            "hard contact loses the velocities with which points meet: soften it by PRESSURE-OVERCLOSURE=LINEAR for a bounce",
                        ),
                    ),
                ],
            ),
            P::ignored("INCREMENTATION", "increments are chosen by the half-increment residual"),
            P::silent("SOLVER"),
            P::silent("SINGULAR MASS"),
            P::refused("SUBSPACE", "the equations are integrated directly: leave it out"),
            P::refused("ADIABATIC", NO_HEAT),
            P::refused("RELATIVE TO ABSOLUTE", "coordinates do not rotate: leave it out"),
            P::refused("TIME RESET", "total time runs on from step to step"),
            P::refused("TOTAL TIME AT START", "total time starts at 0"),
            P::flag("DIRECT USER CONTROL"),
            P::value("SCALE FACTOR"),
            P::ignored("ELEMENT BY ELEMENT", STABLE),
            P::ignored("FIXED TIME INCREMENTATION", STABLE),
            P::ignored("IMPROVED DT METHOD", STABLE),
            P::silent("PRTYPE"),
        ],
    ),
    Keyword::read("*BULK VISCOSITY", Anywhere, Fields, &[]),
    Keyword::read(
        "*FIXED MASS SCALING",
        Step,
        Forbidden,
        &[
            P::value("ELSET"),
            P::value("FACTOR"),
            P::value("DT"),
            P::one_of("TYPE", &[("UNIFORM", Read), ("BELOWMIN", Read), ("SETEQUALDT", Read)]),
        ],
    ),
    Keyword::read(
        "*INITIAL CONDITIONS",
        Model,
        Fields,
        &[
            P { required: true, ..P::one_of("TYPE", INITIAL_TYPES) },
            P::one_of(
                "DEFINITION",
                &[("COMPONENTS", Silent), ("DIRECTION", Refused("give the velocities in global directions"))],
            ),
            P::refused("INPUT", "bring the lines in with *INCLUDE under the keyword"),
            P::refused("FILE", VELOCITIES),
            P::refused("STEP", VELOCITIES),
            P::refused("INC", VELOCITIES),
            P::refused("USER", "write the values"),
        ],
    ),
    Keyword::read(
        "*DAMPING",
        Material,
        Fields,
        &[
            P::value("ALPHA"),
            P::value("BETA"),
            P::refused("COMPOSITE", "it acts in modal analyses: give ALPHA and BETA"),
            P::refused("STRUCTURAL", "it acts in modal and harmonic analyses: give ALPHA and BETA"),
            P::refused("TABULAR", ONE_FACTOR),
        ],
    ),
    Keyword::read(
        "*DASHPOT",
        Model,
        Fields,
        &[
            P::required("ELSET"),
            P::silent("RTOL"),
            P::refused("NONLINEAR", "a dashpot has one coefficient: force per velocity"),
            P::refused("ORIENTATION", "give directions of a DASHPOT1 or DASHPOT2 in global axes"),
            P::refused("DEPENDENCIES", "give one coefficient"),
        ],
    ),
    Keyword::read(
        "*ROTARY INERTIA",
        Model,
        Fields,
        &[
            P::required("ELSET"),
            P::value("ALPHA"),
            P::refused("ORIENTATION", "give the moments of inertia in global axes"),
            P::refused("COMPOSITE", MASS_PROPORTIONAL),
        ],
    ),
];

/// Kinds of initial conditions: velocities are read, what bears on nothing that is solved is refused all the same, because it was
/// given for a purpose.
const INITIAL_TYPES: &[(&str, Effect)] = &[
    ("VELOCITY", Read),
    ("ANGULARVELOCITY", Refused("give the velocities of the nodes: TYPE=VELOCITY")),
    ("ROTATINGVELOCITY", Refused("give the velocities of the nodes: TYPE=VELOCITY")),
    ("ROTATIONALVELOCITY", Refused("give the velocities of the nodes: TYPE=VELOCITY")),
    ("CONTACT", Refused("contact states follow from the geometry: move the nodes, or give a *CLEARANCE")),
    ("DISPLACEMENT", Refused("move the nodes, or prescribe the displacements in a static step before")),
    ("STRESS", Refused("bodies are free of stress at the start: load them in a step before")),
    ("PLASTICSTRAIN", Refused("only elastic bodies are solved")),
    ("HARDENING", Refused("only elastic bodies are solved")),
    ("SOLUTION", Refused("no material that is read has state variables")),
    ("TEMPERATURE", Refused("it has no effect on what is solved: remove it")),
    ("FIELD", Refused("it has no effect on what is solved: remove it")),
    ("PRESSURESTRESS", Refused("it has no effect on what is solved: remove it")),
    ("MASSFLOWRATE", Refused("only solids are solved")),
    ("FLUIDPRESSURE", Refused("only solids are solved")),
    ("POREPRESSURE", Refused("only solids are solved")),
    ("SATURATION", Refused("only solids are solved")),
    ("RATIO", Refused("only solids are solved")),
];
