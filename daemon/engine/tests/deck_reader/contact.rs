//! Interactions and pairs: enforcement, separation, damping, friction, clearances.

use overclosure::deck::summary;
use overclosure::law::{NormalBehavior, Separation};
use overclosure::model::*;

use crate::base::*;

const LAW: &str = "PRESSURE-OVERCLOSURE=LINEAR\n1e6\n";

/// Interaction of the base deck with another `*SURFACE BEHAVIOR`; the deck must be read without findings.
fn interaction(behavior: &str) -> SurfaceInteraction {
    let (mut model, found) = accepted(&with(LAW, behavior), Dialect::Abaqus);
    assert!(found.is_empty(), "{behavior}: {}", listing(&found));
    model.interactions.remove(0)
}

#[test]
fn hard_contact_is_enforced_by_multipliers_unless_the_deck_says_otherwise() {
    for behavior in ["\n", "PRESSURE-OVERCLOSURE=HARD\n", "DIRECT\n"] {
        let found = interaction(behavior);
        assert_eq!((found.normal, found.enforcement), (NormalBehavior::Hard, Enforcement::Lagrange), "{behavior}");
    }
    assert_eq!(interaction("DIRECT, PRESSURE-OVERCLOSURE=LINEAR\n1.\n").enforcement, Enforcement::Lagrange);
    let (both, keyword) = ("are two ways to enforce contact", "*SURFACE BEHAVIOR");
    refuses(&with(LAW, "DIRECT, PENALTY\n"), keyword, both);
    refuses(&with(LAW, "AUGMENTED LAGRANGE, PENALTY\n"), keyword, both);
}

#[test]
fn augmented_lagrange_has_a_stiffness_a_clearance_and_a_factor() {
    let linear = |stiffness, clearance, scale| LinearPenalty { stiffness, clearance, scale };
    for (behavior, expected) in [
        ("AUGMENTED LAGRANGE\n", linear(None, 0.0, 1.0)),
        ("AUGM, PRESSURE-OVERCLOSURE=HARD\n", linear(None, 0.0, 1.0)),
        ("AUGMENTED LAGRANGE\n5e5\n", linear(Some(5e5), 0.0, 1.0)),
        ("AUGMENTED LAGRANGE\n5e5, 0.01, 2.\n", linear(Some(5e5), 0.01, 2.0)),
        ("AUGMENTED LAGRANGE\n, 0.01\n", linear(None, 0.01, 1.0)),
        ("AUGMENTED LAGRANGE\n, , 3.\n", linear(None, 0.0, 3.0)),
    ] {
        assert_eq!(interaction(behavior).enforcement, Enforcement::AugmentedLagrange(expected), "{behavior}");
    }
    for (line, fragment) in [
        ("0.", "penalty stiffness 0 is not positive"),
        ("-1.", "penalty stiffness -1 is not positive"),
        ("1., -0.1", "clearance at zero pressure -0.1 is negative"),
        ("1., 0., 0.", "scale factor 0 is not positive"),
        ("1., 0., 1., 1.", "item 4 is not read"),
        ("stiff", "penalty stiffness: stiff is not a number"),
        ("1.\n2.", "second data line"),
    ] {
        refuses(&with(LAW, &format!("AUGMENTED LAGRANGE\n{line}\n")), "*SURFACE BEHAVIOR", fragment);
    }
}

#[test]
fn penalties_are_linear_or_not() {
    let linear = LinearPenalty { stiffness: Some(3e5), clearance: 0.02, scale: 1.0 };
    assert_eq!(interaction("PENALTY\n").enforcement, Enforcement::Penalty(LinearPenalty::default()));
    assert_eq!(interaction("PENALTY=LINEAR\n3e5, 0.02\n").enforcement, Enforcement::Penalty(linear));
    let default = NonlinearPenalty::default();
    assert_eq!(interaction("PENALTY=NONLINEAR\n").enforcement, Enforcement::NonlinearPenalty(default));
    let given = NonlinearPenalty {
        stiffness_final: Some(1e6),
        clearance: 0.01,
        scale: 0.5,
        upper_limit: 0.05,
        stiffness_ratio: 0.1,
        lower_ratio: 0.25,
    };
    let found = interaction("PENALTY=NONLINEAR\n1e6, 0.01, 0.5, 0.05, 0.1, 0.25\n").enforcement;
    assert_eq!(found, Enforcement::NonlinearPenalty(given));
    for (line, fragment) in [
        ("1e6, 0., 1., 0.", "upper limit of the quadratic range 0 is not positive"),
        ("1e6, 0., 1., 0.03, 2.", "initial over final stiffness 2 is not between 0 and 1"),
        ("1e6, 0., 1., 0.03, 0.", "initial over final stiffness 0 is not between 0 and 1"),
        ("1e6, 0., 1., 0.03, 0.01, 1.", "lower over upper limit 1 is not between 0 and 1"),
        ("-1e6", "final stiffness -1000000 is not positive"),
    ] {
        refuses(&with(LAW, &format!("PENALTY=NONLINEAR\n{line}\n")), "*SURFACE BEHAVIOR", fragment);
    }
    refuses(&with(LAW, "PENALTY=CUBIC\n"), "*SURFACE BEHAVIOR", "PENALTY=CUBIC is not known");
}

#[test]
fn no_separation_belongs_to_hard_contact() {
    for behavior in ["NO SEPARATION\n", "PRESSURE-OVERCLOSURE=HARD, NO SEPARATION\n", "NO SEP, AUGMENTED LAGRANGE\n"] {
        let found = interaction(behavior);
        assert_eq!((found.normal, found.separation), (NormalBehavior::Hard, Separation::Prevented), "{behavior}");
    }
    assert_eq!(interaction("PRESSURE-OVERCLOSURE=HARD\n").separation, Separation::Allowed);
}

#[test]
fn contact_damping_has_a_coefficient_a_clearance_and_a_part() {
    let damping = |card: &str| interaction(&format!("{LAW}*CONTACT DAMPING{card}\n")).damping;
    let expected = ContactDamping { coefficient: 8.0, clearance: 0.1, fraction: 0.4, tangent_fraction: 0.0 };
    assert_eq!(damping(", DEFINITION=DAMPING COEFFICIENT\n8., 0.1, 0.4"), Some(expected));
    assert_eq!(damping("\n8., 0.1"), Some(ContactDamping { fraction: 0.0, ..expected }));
    let tangential = Some(ContactDamping { tangent_fraction: 0.5, ..expected });
    assert_eq!(damping(", TANGENT FRACTION=0.5\n8., 0.1, 0.4"), tangential);
    for (card, fragment) in [
        ("", "data line is missing"),
        ("\n0., 0.1", "damping coefficient 0 is not positive"),
        ("\n-1., 0.1", "damping coefficient -1 is not positive"),
        ("\n8.", "clearance c0 without damping is missing"),
        ("\n8., 0.", "the clearance 0 from which on nothing is damped is not positive"),
        ("\n8., 0.1, 1.", "the part 1 of the clearance"),
        ("\n8., 0.1, -0.1", "the part -0.1 of the clearance"),
        ("\n8., 0.1, 0.4, 1.", "item 4 is not read"),
        (", TANGENT FRACTION=-1.\n8., 0.1", "TANGENT FRACTION=-1."),
        ("\n8., 0.1\n*CONTACT DAMPING\n8., 0.1", "has a *CONTACT DAMPING already"),
        (", DEFINITION=VISCOUS\n8., 0.1", "DEFINITION=VISCOUS is not known"),
    ] {
        refuses(&with("1e6\n", &format!("1e6\n*CONTACT DAMPING{card}\n")), "*CONTACT DAMPING", fragment);
    }
    refuses(
        &with("*STEP\n", "*CONTACT DAMPING\n8., 0.1\n*STEP\n"),
        "*CONTACT DAMPING",
        "no interaction is being defined",
    );
}

#[test]
fn friction_is_absent_or_rough() {
    let friction = |card: &str| interaction(&format!("{LAW}*FRICTION{card}\n")).friction;
    assert_eq!(friction(""), Friction::None);
    assert_eq!(friction("\n0."), Friction::None);
    assert_eq!(friction(", ROUGH"), Friction::Rough);
    refuses(&with("1e6\n", "1e6\n*FRICTION, ROUGH\n0.3\n"), "*FRICTION", "rough friction takes no data line");
    refuses(&with("1e6\n", "1e6\n*FRICTION\n0.3\n"), "*FRICTION", "friction coefficient 0.3 is not supported");
    refuses(&with("1e6\n", "1e6\n*FRICTION\n*FRICTION, ROUGH\n"), "*FRICTION", "has a *FRICTION already");
}

#[test]
fn hcrit_is_a_length() {
    let text = with(", SMALL SLIDING", ", SMALL SLIDING, HCRIT=0.25");
    warns(&text, "*CONTACT PAIR", "HCRIT has no effect on the answer");
    let model = model(&text);
    assert_eq!(model.pairs[0].surfaces().expect("a pair of surfaces").hcrit, Some(0.25));
    for value in ["0.", "-1.", "deep"] {
        let text = with(", SMALL SLIDING", &format!(", SMALL SLIDING, HCRIT={value}"));
        refuses(&text, "*CONTACT PAIR", &format!("HCRIT={value}: not a positive length"));
    }
}

/// The base deck with a card behind its pair.
fn with_clearance(card: &str) -> String {
    with("SECOND, FIRST\n", &format!("SECOND, FIRST\n*CLEARANCE, {card}\n"))
}

#[test]
fn clearances_override_the_geometry() {
    let clearances = |card: &str| {
        let model = model(&with_clearance(card));
        let surfaces = model.pairs[0].surfaces().expect("a pair of surfaces");
        let label = |node: NodeId| model.mesh.node_labels[node.index()];
        surfaces.clearances.iter().map(|&(node, clearance)| (label(node), clearance)).collect::<Vec<_>>()
    };
    let names = "SLAVE=SECOND, MASTER=FIRST";
    assert_eq!(clearances(&format!("{names}, VALUE=0.01")), [(11, 0.01), (12, 0.01), (13, 0.01), (14, 0.01)]);
    assert_eq!(clearances(&format!("{names}, VALUE=-0.01"))[0], (11, -0.01));
    let table = format!("{names}, TABULAR\n13, -0.02\n11, 0.01");
    assert_eq!(clearances(&table), [(11, 0.01), (13, -0.02)]);
    let set = format!("{names}, TABULAR\nEDGE, 0.03\n*NSET, NSET=EDGE\n12, 13");
    assert_eq!(clearances(&set), [(12, 0.03), (13, 0.03)]);
    for (card, fragment) in [
        ("SLAVE=SECOND, MASTER=FIRST", "one of VALUE and TABULAR"),
        ("SLAVE=SECOND, MASTER=FIRST, VALUE=0.1, TABULAR\n11, 1.", "one of VALUE and TABULAR"),
        ("SLAVE=SECOND, MASTER=FIRST, VALUE=wide", "VALUE=wide is not a number"),
        ("SLAVE=SECOND, MASTER=FIRST, VALUE=0.1\n11, 1.", "no data line is read"),
        ("SLAVE=SECOND, MASTER=FIRST, TABULAR", "the data line is missing"),
        ("SLAVE=SECOND, MASTER=FIRST, TABULAR\n1, 0.1", "node 1 is not on the secondary surface"),
        ("SLAVE=SECOND, MASTER=FIRST, TABULAR\n11", "clearance is missing"),
        ("SLAVE=SECOND, MASTER=FIRST, TABULAR\n11, 0.1, 0., 0., 1.", "a normal given with the clearance"),
        ("SLAVE=FIRST, MASTER=SECOND, VALUE=0.1", "FIRST and SECOND are no contact pair"),
        ("SLAVE=SECOND, VALUE=0.1", "parameter MASTER is missing"),
        ("SLAVE=SECOND, MASTER=FIRST, VALUE=0.1, BOLT=1", "BOLT is not supported"),
    ] {
        refuses(&with_clearance(card), "*CLEARANCE", fragment);
    }
    let finite = with_clearance("SLAVE=SECOND, MASTER=FIRST, VALUE=0.1").replace(", SMALL SLIDING", "");
    refuses(&finite, "*CLEARANCE", "needs a pair with SMALL SLIDING");
    let adjusted = with_clearance("SLAVE=SECOND, MASTER=FIRST, VALUE=0.1").replace("SLIDING", "SLIDING, ADJUST=0.");
    warns(&adjusted, "*CLEARANCE", "ADJUST of the pair moves nodes");
}

#[test]
fn the_summary_tells_how_contact_is_enforced() {
    for (behavior, words) in [
        ("AUGMENTED LAGRANGE, NO SEPARATION\n", &["augmented Lagrange", "no separation"][..]),
        ("PENALTY=NONLINEAR\n", &["nonlinear penalty"][..]),
        ("\n*FRICTION, ROUGH\n*CONTACT DAMPING\n8., 0.1\n", &["rough friction", "damped below a clearance of 0.1"][..]),
    ] {
        let text = summary(&model(&with(LAW, behavior)));
        for word in words {
            assert!(text.contains(word), "{word}: {text}");
        }
    }
}
