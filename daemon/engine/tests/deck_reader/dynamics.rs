//! Dynamic steps: procedures, masses, damping, initial velocities, and values over time.

use overclosure::deck::summary;
use overclosure::diagnostic::Severity;
use overclosure::model::*;

use crate::base::*;

/// The base deck with another procedure, moved by a velocity.
fn dynamic(procedure: &str) -> String {
    with("*STATIC\n0.1, 1.\n", procedure).replace("*BOUNDARY\nTOP, 3", "*BOUNDARY, TYPE=VELOCITY\nTOP, 3")
}

fn procedure(lines: &str) -> Procedure {
    model(&dynamic(lines)).steps[0].procedure.clone()
}

fn implicit(lines: &str) -> DynamicControl {
    match procedure(lines) {
        Procedure::Dynamic(control) => control,
        other => panic!("{other:?}"),
    }
}

fn explicit(lines: &str) -> ExplicitControl {
    match procedure(lines) {
        Procedure::Explicit(control) => control,
        other => panic!("{other:?}"),
    }
}

const DEFAULT: DynamicControl = DynamicControl {
    increment_initial: 0.1,
    period: 1.0,
    increment_min: 1e-5,
    increment_max: 1.0,
    direct: false,
    alpha: -0.05,
    half_increment: HalfIncrement::Relative(0.1),
    initial_accelerations: true,
    mass: MassMatrix::ByOrder,
};

#[test]
fn implicit_steps_are_read_with_their_defaults() {
    let cases = [
        ("*DYNAMIC\n0.1, 1.\n", DEFAULT),
        (
            "*DYNAMIC, ALPHA=0., HAFTOL=5.\n0.1, 1.\n",
            DynamicControl { alpha: 0.0, half_increment: HalfIncrement::Force(5.0), ..DEFAULT },
        ),
        (
            "*DYNAMIC, ALPHA=-0.3333334, NOHAF\n0.1, 1.\n",
            DynamicControl { alpha: -1.0 / 3.0, half_increment: HalfIncrement::Unchecked, ..DEFAULT },
        ),
        (
            "*DYNAMIC, HALFINC SCALE FACTOR=3., INITIAL=NO, MASS=LUMPED\n0.1, 1.\n",
            DynamicControl {
                half_increment: HalfIncrement::Relative(3.0),
                initial_accelerations: false,
                mass: MassMatrix::Lumped,
                ..DEFAULT
            },
        ),
        (
            "*DYNAMIC, DIRECT, INITIAL, MASS=CONSISTENT\n0.1, 1.\n",
            DynamicControl { direct: true, mass: MassMatrix::Consistent, ..DEFAULT },
        ),
        (
            "*DYNAMIC\n0.1, 2., 1e-3, 0.5\n",
            DynamicControl { period: 2.0, increment_min: 1e-3, increment_max: 0.5, ..DEFAULT },
        ),
        (
            "*DYNAMIC\n, 2.\n",
            DynamicControl { increment_initial: 2.0, period: 2.0, increment_min: 2e-5, increment_max: 2.0, ..DEFAULT },
        ),
    ];
    for (lines, expected) in cases {
        assert_eq!(implicit(lines), expected, "{lines}");
    }
    let text = summary(&model(&dynamic("*DYNAMIC\n0.1, 1.\n")));
    assert!(text.contains("Step-1: *DYNAMIC, period 1, automatic increments from 0.1"), "{text}");
}

#[test]
fn the_dialect_of_calculix_has_consistent_masses() {
    let read = |lines| match accepted(&dynamic(lines), Dialect::Calculix).0.steps[0].procedure {
        Procedure::Dynamic(control) => (control.alpha, control.mass),
        ref other => panic!("{other:?}"),
    };
    assert_eq!(read("*DYNAMIC\n0.1, 1.\n"), (-0.05, MassMatrix::Consistent));
    assert_eq!(read("*DYNAMIC, ALPHA=-0.3, MASS=LUMPED, SOLVER=SPOOLES\n0.1, 1.\n"), (-0.3, MassMatrix::Lumped));
    let text = dynamic("*DYNAMIC, EXPLICIT\n, 1.\n");
    finds(&text, Dialect::Calculix, Severity::Error, "*DYNAMIC", "explicit steps of CalculiX are not solved");
}

#[test]
fn explicit_steps_are_read_with_their_defaults() {
    let default = ExplicitControl {
        period: 1.0,
        increments: ExplicitIncrements::Automatic { scale: 1.0 },
        increment_max: None,
        bulk_viscosity: [0.06, 1.2],
        mass_scaling: Vec::new(),
    };
    assert_eq!(explicit("*DYNAMIC, EXPLICIT\n, 1.\n"), default);
    let scaled = explicit("*DYNAMIC, EXPLICIT, SCALE FACTOR=0.5\n, 1., , 0.01\n");
    let increments = ExplicitIncrements::Automatic { scale: 0.5 };
    assert_eq!(scaled, ExplicitControl { increments, increment_max: Some(0.01), ..default.clone() });
    let direct = ExplicitControl { increments: ExplicitIncrements::Direct(0.25), ..default.clone() };
    assert_eq!(explicit("*DYNAMIC, EXPLICIT, DIRECT USER CONTROL\n0.25, 1.\n"), direct);
    assert_eq!(explicit("*DYNAMIC, EXPLICIT, DIRECT\n0.25, 1.\n"), direct);
    let viscous = explicit("*DYNAMIC, EXPLICIT\n, 1.\n*BULK VISCOSITY\n0., 0.5\n");
    assert_eq!(viscous.bulk_viscosity, [0.0, 0.5]);
    let scaled = explicit(
        "*DYNAMIC, EXPLICIT\n, 1.\n*FIXED MASS SCALING, ELSET=UPPER, FACTOR=4.\n\
         *FIXED MASS SCALING, DT=1e-6, TYPE=BELOW MIN\n*FIXED MASS SCALING, FACTOR=2., DT=1e-5\n",
    );
    let scaling = |element_set, kind| MassScaling { element_set, kind };
    let upper = scaled.mass_scaling[0].element_set;
    let expected = [
        scaling(upper, MassScalingKind::Factor(4.0)),
        scaling(None, MassScalingKind::BelowMin(1e-6)),
        scaling(None, MassScalingKind::Factor(2.0)),
        scaling(None, MassScalingKind::Uniform(1e-5)),
    ];
    assert!(upper.is_some());
    assert_eq!(scaled.mass_scaling, expected);
    for word in ["ELEMENT BY ELEMENT", "FIXED TIME INCREMENTATION"] {
        warns(&dynamic(&format!("*DYNAMIC, EXPLICIT, {word}\n, 1.\n")), "*DYNAMIC", &format!("{word} is ignored"));
    }
}

#[test]
fn viscosity_and_scaled_masses_stay_until_a_step_changes_them() {
    let text = dynamic("*DYNAMIC, EXPLICIT\n, 1.\n*BULK VISCOSITY\n0.1, 2.\n*FIXED MASS SCALING, FACTOR=4.\n");
    let later = "*STEP\n*DYNAMIC, EXPLICIT\n, 1.\n*END STEP\n";
    let other = later.replace("*END", "*BULK VISCOSITY\n0.2\n*FIXED MASS SCALING, DT=1e-6\n*END");
    let model = model(&format!("{text}{later}{other}"));
    let control = |step: usize| match &model.steps[step].procedure {
        Procedure::Explicit(control) => (control.bulk_viscosity, control.mass_scaling[0].kind),
        other => panic!("{other:?}"),
    };
    assert_eq!(control(0), ([0.1, 2.0], MassScalingKind::Factor(4.0)));
    assert_eq!(control(1), control(0));
    assert_eq!(control(2), ([0.2, 2.0], MassScalingKind::Uniform(1e-6)));
}

#[test]
fn procedures_are_checked() {
    let cases = [
        ("*DYNAMIC\n", "the data line is missing"),
        ("*DYNAMIC\n0.1\n", "the step has no period"),
        ("*DYNAMIC\n0.1, 0.\n", "the step has no period"),
        ("*DYNAMIC\n0.1, -1.\n", "period -1 is negative"),
        ("*DYNAMIC\n2., 1.\n", "longer than the period"),
        ("*DYNAMIC, DIRECT\n0.001, 1.\n", "1000 fixed increments are needed"),
        ("*DYNAMIC, ALPHA=0.1\n0.1, 1.\n", "ALPHA=0.1 is not a number from -1/3 to 0"),
        ("*DYNAMIC, ALPHA=-0.4\n0.1, 1.\n", "ALPHA=-0.4 is not a number from -1/3 to 0"),
        ("*DYNAMIC, HAFTOL=0.\n0.1, 1.\n", "HAFTOL=0. is not a positive number"),
        ("*DYNAMIC, HAFTOL=1., NOHAF\n0.1, 1.\n", "HAFTOL and NOHAF both say"),
        ("*DYNAMIC, ADIABATIC\n0.1, 1.\n", "ADIABATIC is not supported"),
        ("*DYNAMIC, SCALE FACTOR=0.5\n0.1, 1.\n", "SCALE FACTOR belongs to explicit steps"),
        ("*DYNAMIC, APPLICATION=QUASI-STATIC\n0.1, 1.\n", "APPLICATION=QUASI-STATIC is not supported"),
        ("*DYNAMIC, EXPLICIT\n", "the data line is missing"),
        ("*DYNAMIC, EXPLICIT\n,\n", "period is missing"),
        ("*DYNAMIC, EXPLICIT\n, 0.\n", "period 0 is not positive"),
        ("*DYNAMIC, EXPLICIT\n, -1.\n", "period -1 is not positive"),
        ("*DYNAMIC, EXPLICIT\n0.1, 1.\n", "increments are chosen automatically"),
        ("*DYNAMIC, EXPLICIT\n, 1., , -1.\n", "largest increment -1 is negative"),
        ("*DYNAMIC, EXPLICIT, ADIABATIC\n, 1.\n", "ADIABATIC is not supported"),
        ("*DYNAMIC, EXPLICIT, ALPHA=0.\n, 1.\n", "ALPHA belongs to implicit steps"),
        ("*DYNAMIC, EXPLICIT, SCALE FACTOR=1.5\n, 1.\n", "SCALE FACTOR=1.5 is not above 0 and at most 1"),
        ("*DYNAMIC, EXPLICIT, SCALE FACTOR=0.\n, 1.\n", "SCALE FACTOR=0. is not above 0"),
        ("*DYNAMIC, EXPLICIT, DIRECT USER CONTROL\n, 1.\n", "increment is missing"),
        ("*DYNAMIC, EXPLICIT, DIRECT USER CONTROL\n2., 1.\n", "the increment 2 is longer than the period"),
        ("*DYNAMIC, EXPLICIT, DIRECT USER CONTROL, SCALE FACTOR=0.5\n0.1, 1.\n", "SCALE FACTOR has no effect"),
    ];
    for (lines, fragment) in cases {
        refuses(&dynamic(lines), "*DYNAMIC", fragment);
    }
    let explicit = |card: &str| dynamic(&format!("*DYNAMIC, EXPLICIT\n, 1.\n{card}"));
    refuses(&explicit("*BULK VISCOSITY\n-0.1\n"), "*BULK VISCOSITY", "linear bulk viscosity -0.1 is negative");
    refuses(&explicit("*FIXED MASS SCALING\n"), "*FIXED MASS SCALING", "one of FACTOR and DT");
    refuses(&explicit("*FIXED MASS SCALING, FACTOR=0.\n"), "*FIXED MASS SCALING", "FACTOR=0. is not a positive number");
    refuses(&explicit("*FIXED MASS SCALING, ELSET=X, FACTOR=2.\n"), "*FIXED MASS SCALING", "no element set X");
    refuses(
        &explicit("*FIXED MASS SCALING, FACTOR=2., TYPE=UNIFORM\n"),
        "*FIXED MASS SCALING",
        "DT, which is not given",
    );
    refuses(&explicit("*VARIABLE MASS SCALING\n"), "*VARIABLE MASS SCALING", "not supported");
    for card in ["*BULK VISCOSITY\n0.1\n", "*FIXED MASS SCALING, FACTOR=2.\n"] {
        let keyword = card.split(['\n', ',']).next().expect("a keyword");
        refuses(&dynamic(&format!("*DYNAMIC\n0.1, 1.\n{card}")), keyword, "belongs to explicit steps");
    }
    refuses(&with("*STEP\n", "*BULK VISCOSITY\n0.1\n*STEP\n"), "*BULK VISCOSITY", "belongs to explicit steps");
    warns(&explicit("").replace("*STEP\n", "*STEP, INC=5\n"), "*STEP", "INC has no effect on an explicit step");
}

#[test]
fn one_deck_is_of_one_product() {
    let further = |procedure: &str| format!("*STEP\n{procedure}*END STEP\n");
    let (statics, implicit, explicit) = ("*STATIC\n1., 1.\n", "*DYNAMIC\n0.1, 1.\n", "*DYNAMIC, EXPLICIT\n, 1.\n");
    for (first, second) in [(implicit, explicit), (explicit, implicit), (explicit, statics)] {
        let text = format!("{}{}", dynamic(first), further(second));
        let keyword = second.split(['\n', ',']).next().expect("a keyword");
        refuses(&text, keyword, "two products");
    }
    for (first, second) in [(implicit, statics), (implicit, implicit), (explicit, explicit)] {
        assert!(model(&format!("{}{}", dynamic(first), further(second))).steps.len() == 2);
    }
}

#[test]
fn elements_need_mass_in_dynamic_steps() {
    for procedure in ["*DYNAMIC\n0.1, 1.\n", "*DYNAMIC, EXPLICIT\n, 1.\n"] {
        let text = dynamic(procedure).replace("*DENSITY\n7.8e-9\n", "");
        let message =
            "material STEEL has no density, and 2 elements of it need mass in a dynamic step, the first is element 1";
        refuses(&text, "*MATERIAL", message);
        assert!(listing(&read(&text).diagnostics).starts_with("line 34: error: *MATERIAL"));
        for density in ["0.", "-1."] {
            let text = dynamic(procedure).replace("7.8e-9", density);
            refuses(&text, "*DENSITY", "is not positive");
            assert!(!listing(&read(&text).diagnostics).contains("has no density"));
        }
    }
    assert!(read(&with("*DENSITY\n7.8e-9\n", "")).diagnostics.is_empty());
    // Solids of rigid bodies may be without mass.
    let rigid = dynamic("*DYNAMIC\n0.1, 1.\n")
        .replace("*DENSITY\n7.8e-9\n*SOLID SECTION, ELSET=ALL", "*SOLID SECTION, ELSET=UPPER")
        .replace("MATERIAL=STEEL\n*SURFACE", "MATERIAL=STEEL\n*SOLID SECTION, ELSET=LOWER, MATERIAL=HEAVY\n*SURFACE")
        .replace("*MATERIAL, ", "*MATERIAL, NAME=HEAVY\n*ELASTIC\n1., 0.\n*DENSITY\n1.\n*MATERIAL, ")
        .replace("*STEP\n", "*RIGID BODY, ELSET=UPPER, REF NODE=15\n*STEP\n")
        .replace("TOP, 1, 2\n", "15, 1, 2\n")
        .replace("TOP, 3, 3", "15, 3, 3");
    assert!(model(&rigid).materials[1].density.is_none());
}

#[test]
fn damping_belongs_to_materials() {
    let damped = |card: &str| dynamic("*DYNAMIC\n0.1, 1.\n").replace("*DENSITY", &format!("{card}*DENSITY"));
    let damping = |card: &str| model(&damped(card)).materials[0].damping;
    assert_eq!(damping(""), Rayleigh::default());
    assert_eq!(damping("*DAMPING, ALPHA=3., BETA=1e-4\n"), Rayleigh { alpha: 3.0, beta: 1e-4 });
    assert_eq!(damping("*DAMPING, BETA=1e-4\n"), Rayleigh { alpha: 0.0, beta: 1e-4 });
    let cases = [
        ("*DAMPING\n", "neither ALPHA nor BETA is given"),
        ("*DAMPING, ALPHA=-1.\n", "ALPHA=-1. is not a number from 0 on"),
        ("*DAMPING, BETA=x\n", "BETA=x is not a number from 0 on"),
        ("*DAMPING, COMPOSITE=0.1\n", "COMPOSITE is not supported"),
        ("*DAMPING, ALPHA=1.\n2.\n", "no data line is read"),
    ];
    for (card, fragment) in cases {
        refuses(&damped(card), "*DAMPING", fragment);
    }
    let statics = with("*DENSITY", "*DAMPING, ALPHA=3.\n*DENSITY");
    warns(&statics, "*DAMPING", "damping has no effect in a static step");
}

#[test]
fn initial_velocities_are_read_node_by_node() {
    let thrown = |lines: &str| {
        dynamic("*DYNAMIC\n0.1, 1.\n")
            .replace("*STEP\n", &format!("*INITIAL CONDITIONS, TYPE=VELOCITY\n{lines}*STEP\n"))
    };
    let velocity = |node, direction, value| InitialVelocity { node: NodeId(node), direction, value };
    let found = model(&thrown("TOP, 3, -2.\n15, 3, -1.\n1, 1, 4.\n")).initial_velocities;
    // Nodes 15 to 18 are the 13th to 16th; the later line counts.
    let expected = [
        velocity(0, 0, 4.0),
        velocity(12, 2, -1.0),
        velocity(13, 2, -2.0),
        velocity(14, 2, -2.0),
        velocity(15, 2, -2.0),
    ];
    assert_eq!(found, expected);
    let cases = [
        ("99, 1, 1.\n", "node 99 is not defined"),
        ("NOWHERE, 1, 1.\n", "no node set NOWHERE"),
        ("TOP, 0, 1.\n", "degree of freedom 0 does not exist"),
        ("TOP, 7, 1.\n", "degree of freedom 7 does not exist"),
        ("TOP, 4, 1.\n", "node 15 has no degree of freedom 4"),
        ("TOP, 1\n", "velocity is missing"),
        ("TOP, 1, fast\n", "velocity: fast"),
        ("TOP, 1, 1., 2.\n", "item 4 is not read here"),
        ("", "the data line is missing"),
    ];
    for (lines, fragment) in cases {
        refuses(&thrown(lines), "*INITIAL CONDITIONS", fragment);
    }
    for kind in ["STRESS", "TEMPERATURE", "ROTATING VELOCITY"] {
        let text = thrown("TOP, 1, 1.\n").replace("TYPE=VELOCITY\nTOP, 1", &format!("TYPE={kind}\nTOP, 1"));
        refuses(&text, "*INITIAL CONDITIONS", &format!("TYPE={kind} is not supported"));
    }
    let statics = with("*STEP\n", "*INITIAL CONDITIONS, TYPE=VELOCITY\nTOP, 3, 1.\n*STEP\n");
    warns(&statics, "*INITIAL CONDITIONS", "no step is dynamic");
}

#[test]
fn rates_are_prescribed_in_dynamic_steps() {
    for (word, kind) in [
        ("", BoundaryKind::Displacement),
        (", TYPE=DISPLACEMENT", BoundaryKind::Displacement),
        (", TYPE=VELOCITY", BoundaryKind::Velocity),
        (", TYPE=ACCELERATION", BoundaryKind::Acceleration),
    ] {
        for procedure in ["*DYNAMIC\n0.1, 1.\n", "*DYNAMIC, EXPLICIT\n, 1.\n"] {
            let text = with("*STATIC\n0.1, 1.\n", procedure)
                .replace("*STEP\n", "*AMPLITUDE, NAME=RISE\n0., 0., 1., 1.\n*STEP\n")
                .replace("*BOUNDARY\nTOP, 3", &format!("*BOUNDARY, AMPLITUDE=RISE{word}\nTOP, 3"));
            assert_eq!(model(&text).steps[0].boundaries[0].kind, kind);
        }
        if kind != BoundaryKind::Displacement {
            let text = with("*BOUNDARY\nTOP, 3", &format!("*BOUNDARY{word}\nTOP, 3"));
            refuses(&text, "*BOUNDARY", "in a static step");
        }
    }
    let at_once = |procedure| with("*STATIC\n0.1, 1.\n", procedure);
    warns(&at_once("*DYNAMIC\n0.1, 1.\n"), "*BOUNDARY", "TOP is displaced by -0.01 at once");
    warns(&at_once("*DYNAMIC, EXPLICIT\n, 1.\n"), "*BOUNDARY", "TOP is displaced by -0.01 at once");
    let ramped = at_once("*DYNAMIC, EXPLICIT\n, 1.\n").replace("*STEP\n", "*STEP, AMPLITUDE=RAMP\n");
    assert!(read(&ramped).diagnostics.is_empty());
}

#[test]
fn dynamic_steps_reach_values_at_once_unless_they_say_otherwise() {
    let default = |text: &str| model(text).steps[0].default_amplitude;
    assert_eq!(default(BASE), DefaultAmplitude::Ramp);
    assert_eq!(default(&with("*STEP\n", "*STEP, AMPLITUDE=STEP\n")), DefaultAmplitude::Step);
    for lines in ["*DYNAMIC\n0.1, 1.\n", "*DYNAMIC, EXPLICIT\n, 1.\n"] {
        let text = dynamic(lines);
        assert_eq!(default(&text), DefaultAmplitude::Step);
        assert_eq!(default(&text.replace("*STEP\n", "*STEP, AMPLITUDE=RAMP\n")), DefaultAmplitude::Ramp);
    }
}
