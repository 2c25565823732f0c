//! Keywords of steps that are read: procedure, loads and output, with every parameter that is known for them.

use super::keywords::DataLines::{Fields, Forbidden, Text};
use super::keywords::Effect::{Ignored, Read, Refused, Silent};
use super::keywords::Placement::{Anywhere, Step};
use super::keywords::{Keyword, Parameter as P};

const STATICS_ONLY: &str = "only static steps are solved";
const OUTPUT_DEFAULT: &str =
    "results are written at the increments that FREQUENCY, NUMBER INTERVAL or TIME INTERVAL select";
const TIME_MARKS: &str = "results are written at the increment that reaches the end of an interval";
const OUTPUT_FIXED: &str = "the layout of the result files is fixed";
const SMALL_MOTION: &str = "displacements are small, so loads keep their directions";
const SNAPSHOTS: &str = "a snapshot is written at the increment that reaches the end of an interval";
const LOAD_SIMPLE: &str = "give the load as plain values per set";

/// Keywords that describe steps.
pub const STEPS: &[Keyword] = &[
    Keyword::read(
        "*STEP",
        Anywhere,
        Text,
        &[
            P::value("NAME"),
            P::value("INC"),
            P::one_of("NLGEOM", &[("", Read), ("YES", Read), ("NO", Silent)]),
            P::one_of(
                "AMPLITUDE",
                &[
                    ("RAMP", Read),
                    ("STEP", Refused("give the loads of the step an *AMPLITUDE that is 1 from time 0 on")),
                ],
            ),
            P::one_of("UNSYMM", &[("YES", Silent), ("NO", Silent), ("", Silent)]),
            P::silent("EXTRAPOLATION"),
            P::silent("CONVERT SDI"),
            P::silent("SOLVER"),
            P::refused("PERTURBATION", "write the step as a general step"),
        ],
    ),
    Keyword::read("*END STEP", Step, Forbidden, &[]),
    Keyword::read(
        "*STATIC",
        Step,
        Fields,
        &[
            P::one_of("DIRECT", &[("", Read), ("NOSTOP", Refused("increments that do not converge stop the step"))]),
            P::ignored("SOLVER", "the solver is chosen by --path"),
            P::silent("LONG TERM"),
            P::silent("ADIABATIC"),
            P::refused("STABILIZE", "hold every body by boundary conditions or contact"),
            P::refused("ALLSDTOL", "hold every body by boundary conditions or contact"),
            P::refused("RIKS", "prescribe displacements instead"),
            P::refused("FULLY PLASTIC", "only elastic bodies are solved"),
            P::refused("CONTINUE", "hold every body by boundary conditions or contact"),
            P::refused("TIME RESET", "total time runs on from step to step"),
            P::refused("TOTAL TIME AT START", "total time starts at 0"),
        ],
    ),
    Keyword::read(
        "*CLOAD",
        Step,
        Fields,
        &[
            P::one_of("OP", &[("MOD", Read), ("NEW", Read)]),
            P::value("AMPLITUDE"),
            P::silent("REGION TYPE"),
            P::ignored("FOLLOWER", SMALL_MOTION),
            P::refused("CYCLIC MODE", STATICS_ONLY),
            P::refused("LOAD CASE", STATICS_ONLY),
            P::refused("REAL", STATICS_ONLY),
            P::refused("IMAGINARY", STATICS_ONLY),
            P::refused("TIME DELAY", "put the delay into the amplitude"),
            P::refused("SECTOR", "write the values of each sector"),
            P::refused("SUBMODEL", LOAD_SIMPLE),
            P::refused("STEP", LOAD_SIMPLE),
            P::refused("DATA SET", LOAD_SIMPLE),
            P::refused("USER", LOAD_SIMPLE),
            P::refused("OMEGA0", LOAD_SIMPLE),
        ],
    ),
    Keyword::read(
        "*DLOAD",
        Step,
        Fields,
        &[
            P::one_of("OP", &[("MOD", Read), ("NEW", Read)]),
            P::value("AMPLITUDE"),
            P::silent("REGION TYPE"),
            P::silent("CONSTANT RESULTANT"),
            P::ignored("FOLLOWER", SMALL_MOTION),
            P::refused("ORIENTATION", "give the direction in global axes"),
            P::refused("REF NODE", LOAD_SIMPLE),
            P::refused("CYCLIC MODE", STATICS_ONLY),
            P::refused("LOAD CASE", STATICS_ONLY),
            P::refused("REAL", STATICS_ONLY),
            P::refused("IMAGINARY", STATICS_ONLY),
            P::refused("TIME DELAY", "put the delay into the amplitude"),
            P::refused("SECTOR", "write the values of each sector"),
            P::refused("SUBMODEL", LOAD_SIMPLE),
            P::refused("USER", LOAD_SIMPLE),
        ],
    ),
    Keyword::read(
        "*DSLOAD",
        Step,
        Fields,
        &[
            P::one_of("OP", &[("MOD", Read), ("NEW", Read)]),
            P::value("AMPLITUDE"),
            P::silent("REGION TYPE"),
            P::silent("CONSTANT RESULTANT"),
            P::ignored("FOLLOWER", SMALL_MOTION),
            P::refused("ORIENTATION", "give the direction in global axes"),
            P::refused("REF NODE", LOAD_SIMPLE),
            P::refused("CYCLIC MODE", STATICS_ONLY),
            P::refused("LOAD CASE", STATICS_ONLY),
            P::refused("REAL", STATICS_ONLY),
            P::refused("IMAGINARY", STATICS_ONLY),
            P::refused("SUBMODEL", LOAD_SIMPLE),
            P::refused("USER", LOAD_SIMPLE),
        ],
    ),
    Keyword::output(
        "*NODE PRINT",
        Fields,
        &[
            P::value("NSET"),
            P::value("FREQUENCY"),
            P::one_of("TOTALS", &[("NO", Read), ("YES", Read), ("ONLY", Read), ("", Read)]),
            P::one_of("GLOBAL", &[("YES", Silent), ("NO", Ignored("values are written in global directions"))]),
            P::one_of("SUMMARY", &[("YES", Read), ("NO", Read)]),
            P::value("NUMBER INTERVAL"),
            P::ignored("TIME POINTS", OUTPUT_DEFAULT),
        ],
    ),
    Keyword::output(
        "*NODE FILE",
        Fields,
        &[
            P::value("NSET"),
            P::value("FREQUENCY"),
            P::one_of("GLOBAL", &[("YES", Silent), ("NO", Ignored("values are written in global directions"))]),
            P::ignored("OUTPUT", OUTPUT_FIXED),
            P::ignored("CONTACT ELEMENTS", OUTPUT_FIXED),
            P::ignored("LAST ITERATIONS", OUTPUT_FIXED),
            P::ignored("TIME POINTS", OUTPUT_DEFAULT),
        ],
    ),
    Keyword::output(
        "*NODE OUTPUT",
        Fields,
        &[
            P::value("NSET"),
            P::one_of("VARIABLE", &[("ALL", Read), ("PRESELECT", Read)]),
            P::ignored("EXTERIOR", "all nodes of the model are written"),
            P::ignored("TRACER SET", OUTPUT_FIXED),
        ],
    ),
    Keyword::output(
        "*EL PRINT",
        Fields,
        &[
            P::value("ELSET"),
            P::value("FREQUENCY"),
            P::ignored("POSITION", "stresses are written at the nodes"),
            P::one_of("GLOBAL", &[("YES", Silent), ("NO", Ignored("values are written in global directions"))]),
            P::ignored("TOTALS", "stresses have no totals"),
            P::one_of("SUMMARY", &[("YES", Read), ("NO", Read)]),
            P::ignored("TIME POINTS", OUTPUT_DEFAULT),
        ],
    ),
    Keyword::output(
        "*EL FILE",
        Fields,
        &[
            P::value("ELSET"),
            P::value("FREQUENCY"),
            P::ignored("POSITION", "stresses are written at the nodes"),
            P::one_of("GLOBAL", &[("YES", Silent), ("NO", Ignored("values are written in global directions"))]),
            P::ignored("DIRECTIONS", OUTPUT_FIXED),
            P::ignored("OUTPUT", OUTPUT_FIXED),
            P::ignored("SECTION FORCES", OUTPUT_FIXED),
            P::ignored("NSET", "stresses are written at all nodes of the elements"),
            P::ignored("CONTACT ELEMENTS", OUTPUT_FIXED),
            P::ignored("TIME POINTS", OUTPUT_DEFAULT),
        ],
    ),
    Keyword::output(
        "*ELEMENT OUTPUT",
        Fields,
        &[
            P::value("ELSET"),
            P::one_of("VARIABLE", &[("ALL", Read), ("PRESELECT", Read)]),
            P::silent("DIRECTIONS"),
            P::ignored("POSITION", "stresses are written at the nodes"),
            P::ignored("EXTERIOR", "all elements are written"),
        ],
    ),
    Keyword::output(
        "*CONTACT PRINT",
        Fields,
        &[
            P::value("FREQUENCY"),
            P::value("NSET"),
            P::value("MASTER"),
            P::value("SLAVE"),
            P::value("MAIN"),
            P::value("SECONDARY"),
            P::one_of("TOTALS", &[("NO", Read), ("YES", Read), ("", Read)]),
            P::one_of("SUMMARY", &[("YES", Read), ("NO", Read)]),
            P::ignored("TIME POINTS", OUTPUT_DEFAULT),
        ],
    ),
    Keyword::output(
        "*CONTACT FILE",
        Fields,
        &[
            P::value("FREQUENCY"),
            P::value("NSET"),
            P::value("MASTER"),
            P::value("SLAVE"),
            P::value("MAIN"),
            P::value("SECONDARY"),
            P::ignored("CONTACT ELEMENTS", OUTPUT_FIXED),
            P::ignored("TIME POINTS", OUTPUT_DEFAULT),
        ],
    ),
    Keyword::output(
        "*CONTACT OUTPUT",
        Fields,
        &[
            P::one_of("VARIABLE", &[("ALL", Read), ("PRESELECT", Read)]),
            P::ignored("NSET", "frames hold every contact point"),
            P::ignored("MASTER", "frames hold every contact pair"),
            P::ignored("SLAVE", "frames hold every contact pair"),
            P::ignored("SURFACE", "frames hold every contact pair"),
            P::ignored("SECOND SURFACE", "frames hold every contact pair"),
            P::ignored("CPSET", "frames hold every contact pair"),
            P::ignored("GENERAL CONTACT", "frames hold every contact pair"),
        ],
    ),
    Keyword::output(
        "*OUTPUT",
        Fields,
        &[
            P::flag("FIELD"),
            P::flag("HISTORY"),
            P::value("FREQUENCY"),
            P::one_of("VARIABLE", &[("ALL", Read), ("PRESELECT", Read)]),
            P::one_of("OP", &[("NEW", Read), ("ADD", Read), ("REPLACE", Read)]),
            P::silent("NAME"),
            P::ignored("DIAGNOSTICS", "reports of the iterations are always written"),
            P::value("NUMBER INTERVAL"),
            P::value("TIME INTERVAL"),
            P::one_of("TIME MARKS", &[("NO", Silent), ("YES", Ignored(TIME_MARKS)), ("", Ignored(TIME_MARKS))]),
            P::ignored("TIME POINTS", OUTPUT_DEFAULT),
            P::ignored("FILTER", "values are written as they are"),
            P::ignored("SENSOR", "values are written as they are"),
            P::ignored("MODE LIST", STATICS_ONLY),
        ],
    ),
    Keyword::output(
        "*FILE OUTPUT",
        Forbidden,
        &[
            P::value("NUMBER INTERVAL"),
            P::one_of("TIME MARKS", &[("NO", Silent), ("YES", Ignored(TIME_MARKS)), ("", Ignored(TIME_MARKS))]),
        ],
    ),
    Keyword {
        placement: Anywhere,
        ..Keyword::output(
            "*RESTART",
            Forbidden,
            &[
                P::flag("WRITE"),
                P::value("FREQUENCY"),
                P::flag("OVERLAY"),
                P::refused("READ", "name the snapshot on the command line: overclosure run DECK --restart FILE"),
                P::silent("STEP"),
                P::silent("INC"),
                P::silent("END STEP"),
                P::value("NUMBER INTERVAL"),
                P::one_of("TIME MARKS", &[("NO", Silent), ("YES", Ignored(SNAPSHOTS)), ("", Ignored(SNAPSHOTS))]),
            ],
        )
    },
];
