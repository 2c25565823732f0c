//! Contact pairs of explicit analyses: steps add and delete them, and weights say which surface is secondary.

use overclosure::deck::summary;
use overclosure::law::{NormalBehavior, PressureLaw, PressureOverclosure, Separation};
use overclosure::model::*;

use crate::base::*;

const LAW: &str = "PRESSURE-OVERCLOSURE=LINEAR\n1e6\n";
const CARD: &str = "*CONTACT PAIR, INTERACTION=SI, SMALL SLIDING\nSECOND, FIRST\n";

/// The base deck as an explicit analysis with these pairs in place of its own, and cards in each of its steps.
fn steps(pairs: &str, cards: &[&str]) -> String {
    let text = explicit_deck(&with(CARD, pairs));
    let first = text.replacen("*NODE PRINT", &format!("{}*NODE PRINT", cards[0]), 1);
    let later = |card: &&str| format!("*STEP\n*DYNAMIC, EXPLICIT\n, 1.\n{card}*END STEP\n");
    first + &cards[1..].iter().map(later).collect::<String>()
}

fn pair(parameters: &str) -> String {
    CARD.replace(", SMALL SLIDING", &format!(", SMALL SLIDING{parameters}"))
}

/// Name, weight and constraint of the only pair.
fn roles(text: &str) -> (String, f64, MechanicalConstraint) {
    let model = model(text);
    assert_eq!(model.pairs.len(), 1);
    let pair = &model.pairs[0];
    (pair.name.clone(), pair.explicit.weight.0, pair.explicit.constraint)
}

use MechanicalConstraint::{Kinematic, Penalty};

#[test]
fn the_weight_says_which_surface_is_secondary() {
    let second_first = |weight| ("SECOND_FIRST".to_string(), weight, Kinematic);
    let cases = [
        ("", second_first(0.5)),
        (", WEIGHT=0.5", second_first(0.5)),
        (", WEIGHT=0", second_first(1.0)),
        (", WEIGHT=0.25", second_first(0.75)),
        (", WEIGHT=1", ("FIRST_SECOND".to_string(), 1.0, Kinematic)),
        (", MECHANICAL CONSTRAINT=KINEMATIC", second_first(0.5)),
        (", MECHANICAL CONSTRAINT=PENALTY", ("SECOND_FIRST".to_string(), 0.5, Penalty)),
    ];
    for (parameters, expected) in cases {
        assert_eq!(roles(&steps(&pair(parameters), &[""])), expected, "{parameters}");
    }
    let text = summary(&model(&steps(&pair(", MECHANICAL CONSTRAINT=PENALTY, WEIGHT=0"), &[""])));
    assert!(text.contains("SECOND_FIRST: secondary 1 faces with 4 nodes; primary 1 faces"), "{text}");
    assert!(text.contains("linear, by penalty, pure"), "{text}");
    let listed = summary(&model(&steps(CARD, &[""])));
    assert!(listed.contains("linear, kinematic, balanced by 0.5"), "{listed}");
    for weight in ["-0.1", "1.1", "x"] {
        let fragment = format!("WEIGHT={weight} is not a number from 0 to 1");
        refuses(&steps(&pair(&format!(", WEIGHT={weight}")), &[""]), "*CONTACT PAIR", &fragment);
    }
}

#[test]
fn nodes_and_deformable_bodies_are_secondary_unless_told_otherwise() {
    let nodes = |parameters: &str| {
        steps(&pair(parameters), &[""]).replace("NAME=FIRST\nLOWER, S2", "NAME=FIRST, TYPE=NODE\n5, \n6\n7\n8")
    };
    for constraint in ["", ", MECHANICAL CONSTRAINT=PENALTY"] {
        let found = roles(&nodes(constraint));
        assert_eq!((found.0.as_str(), found.1), ("FIRST_SECOND", 1.0));
    }
    refuses(&nodes(", WEIGHT=0"), "*CONTACT PAIR", "the primary surface FIRST is made of nodes");
    refuses(&nodes(", WEIGHT=0.5"), "*CONTACT PAIR", "the primary surface FIRST is made of nodes");
    // A rigid body above: balanced by penalty, as the manual has it for rigid elements.
    let rigid = |parameters: &str| {
        steps(&pair(parameters), &[""])
            .replace("*STEP\n", "*RIGID BODY, ELSET=UPPER, REF NODE=15\n*STEP\n")
            .replace("TOP, 1, 2\n", "15, 1, 2\n")
            .replace("TOP, 3, 3", "15, 3, 3")
    };
    assert_eq!(roles(&rigid("").replace("SECOND, FIRST", "FIRST, SECOND")), ("FIRST_SECOND".into(), 1.0, Kinematic));
    assert_eq!(roles(&rigid(", WEIGHT=1")), ("FIRST_SECOND".into(), 1.0, Kinematic));
    assert_eq!(roles(&rigid(", MECHANICAL CONSTRAINT=PENALTY")), ("SECOND_FIRST".into(), 0.5, Penalty));
}

#[test]
fn steps_add_and_delete_pairs() {
    let delete = "*CONTACT PAIR, OP=DELETE\nFIRST, SECOND\n";
    let active = |text: &str| -> Vec<Vec<bool>> {
        let model = model(text);
        model.steps.iter().map(|s| (0..model.pairs.len()).map(|p| s.contact.is_active(p)).collect()).collect()
    };
    // In the model part, or in the first step; deleted, and brought back.
    assert_eq!(active(&steps(CARD, &["", delete, "", CARD])), [[true], [false], [false], [true]]);
    assert_eq!(active(&steps("", &[CARD, "", delete])), [[true], [true], [false]]);
    assert_eq!(active(&steps("", &["", CARD])), [[false], [true]]);
    let weighted = CARD.replace("SI, SMALL", "SI, WEIGHT=0, SMALL");
    let unnamed = CARD.replace("INTERACTION=SI", "INTERACTION=NONE");
    let adjusted = CARD.replace(", SMALL SLIDING", ", ADJUST=0.1");
    let cases = [
        (vec![delete], "FIRST and SECOND are no contact pair that acts here"),
        (vec![CARD, delete, delete], "FIRST and SECOND are no contact pair that acts here"),
        (vec![CARD, CARD], "the pair SECOND_FIRST is given twice"),
        (vec![CARD, delete, &weighted], "comes back otherwise than it was deleted"),
        (vec!["*CONTACT PAIR\n"], "the data line is missing"),
        (vec!["*CONTACT PAIR\nSECOND\n"], "the second surface is missing"),
        (vec!["*CONTACT PAIR\nSECOND, SECOND\n"], "secondary and primary of the same pair"),
        (vec![&unnamed], "no surface interaction NONE"),
        (vec![&adjusted], "ADJUST belongs to pairs of static and implicit"),
    ];
    for (cards, fragment) in cases {
        refuses(&steps("", &cards), "*CONTACT PAIR", fragment);
    }
    refuses(&steps(delete, &[""]), "*CONTACT PAIR", "OP=DELETE before the first step");
    warns(
        &steps("", &[&CARD.replace(", SMALL SLIDING", "")]),
        "*CONTACT PAIR",
        "finite sliding is solved as small sliding",
    );
    refuses(
        &steps(CARD, &["*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nSECOND, FIRST\n"]),
        "*MODEL CHANGE",
        "belongs to static",
    );
    refuses(
        &steps(CARD, &["*CONTACT INTERFERENCE\nSECOND, FIRST, 0.1\n"]),
        "*CONTACT INTERFERENCE",
        "belongs to static",
    );
    for name in ["WEIGHT=0.5", "MECHANICAL CONSTRAINT=PENALTY", "OP=ADD"] {
        refuses(&with("SMALL SLIDING", name), "*CONTACT PAIR", "belongs to pairs of explicit analyses");
    }
}

#[test]
fn pairs_without_an_interaction_are_hard() {
    let found = model(&steps("", &["*CONTACT PAIR, SMALL SLIDING\nSECOND, FIRST\n"]));
    let interaction = &found.interactions[found.pairs[0].interaction.index()];
    assert_eq!((interaction.name.as_str(), &interaction.normal), ("default", &NormalBehavior::Hard));
    assert_eq!(interaction.explicit_damping.definition, DampingDefinition::CriticalFraction(0.03));
}

#[test]
fn laws_of_explicit_contact_are_read() {
    let interaction =
        |behavior: &str, pairs: &str| model(&steps(pairs, &[""]).replace(LAW, behavior)).interactions[0].clone();
    let limited = interaction("PRESSURE-OVERCLOSURE=EXPONENTIAL\n0.01, 5., 2e4\n", CARD).normal;
    let NormalBehavior::Softened(PressureOverclosure::Exponential(law)) = limited else { panic!("{limited:?}") };
    // Kmax = 2e4 is reached at h = 0.01887: beyond, the slope stays.
    assert!((law.evaluate(0.05).stiffness - 2e4).abs() < 1e-6);
    let pure = pair(", WEIGHT=0");
    for behavior in [
        "PRESSURE-OVERCLOSURE=LINEAR, NO SEPARATION\n1e6\n",
        "PRESSURE-OVERCLOSURE=TABULAR, NO SEPARATION\n0., 0.\n1., 0.1\n",
    ] {
        assert_eq!(interaction(behavior, &pure).separation, Separation::Prevented);
        refuses(
            &steps(CARD, &[""]).replace(LAW, behavior),
            "*SURFACE BEHAVIOR",
            "cannot be combined with balanced weighting",
        );
    }
    refuses(
        &steps(CARD, &[""]).replace(LAW, "PRESSURE-OVERCLOSURE=EXPONENTIAL\n0.01, 5., -1.\n"),
        "*SURFACE BEHAVIOR",
        "stiffness",
    );
    let damped = |card: &str| interaction(&format!("{LAW}*CONTACT DAMPING{card}"), CARD).explicit_damping;
    let coefficient = |value, tangent_fraction| ExplicitDamping {
        definition: DampingDefinition::Coefficient(value),
        tangent_fraction,
    };
    assert_eq!(damped("\n0.\n"), coefficient(0.0, 1.0));
    assert_eq!(damped(", DEFINITION=DAMPING COEFFICIENT, TANGENT FRACTION=0.5\n7.\n"), coefficient(7.0, 0.5));
    let critical = damped(", DEFINITION=CRITICAL DAMPING FRACTION\n0.1\n").definition;
    assert_eq!(critical, DampingDefinition::CriticalFraction(0.1));
    let with_damping = |card: &str| steps(CARD, &[""]).replace(LAW, &format!("{LAW}*CONTACT DAMPING{card}"));
    refuses(&with_damping("\n-1.\n"), "*CONTACT DAMPING", "the damping coefficient -1 is negative");
    warns(&with_damping("\n1., 0.1, 0.5\n"), "*CONTACT DAMPING", "damped while surfaces touch");
    let hard = steps(CARD, &[""]).replace(LAW, "\n*CONTACT DAMPING\n1.\n");
    warns(&hard, "*CONTACT DAMPING", "ignored for hard kinematic contact");
    assert!(
        read(&hard.replace("SMALL SLIDING", "SMALL SLIDING, MECHANICAL CONSTRAINT=PENALTY")).diagnostics.is_empty()
    );
    let rough = |word: &str| steps(CARD, &[""]).replace(LAW, &format!("{LAW}*FRICTION{word}"));
    refuses(&rough(", ROUGH, TAUMAX=0.\n"), "*FRICTION", "TAUMAX=0 is not allowed");
    assert!(read(&rough(", ROUGH, TAUMAX=5.\n")).diagnostics.is_empty());
}

#[test]
fn sets_of_pairs_are_controlled_and_cleared() {
    let hard = |cards: &[&str]| {
        steps(&pair(", CPSET=TOUCH, MECHANICAL CONSTRAINT=PENALTY, WEIGHT=0"), cards).replace(LAW, "\n")
    };
    let scale = |text: &str| -> Vec<f64> {
        model(text).steps.iter().map(|step| step.contact.controls_of(0).scale_penalty).collect()
    };
    let control = "*CONTACT CONTROLS, CPSET=TOUCH, SCALE PENALTY=0.5\n";
    assert_eq!(scale(&hard(&["", control, "", "*CONTACT CONTROLS, CPSET=touch, RESET\n"])), [1.0, 0.5, 0.5, 1.0]);
    warns(&hard(&["*CONTACT CONTROLS, CPSET=TOUCH, GLOBTRKINC=5\n"]), "*CONTACT CONTROLS", "GLOBTRKINC has no effect");
    warns(
        &hard(&[control]).replace("SI\n*SURFACE BEHAVIOR, \n", &format!("SI\n*SURFACE BEHAVIOR, {LAW}")),
        "*CONTACT CONTROLS",
        "SCALE PENALTY has no effect on the pair SECOND_FIRST",
    );
    let cases = [
        ("*CONTACT CONTROLS, SCALE PENALTY=2.\n", "parameter CPSET is missing"),
        ("*CONTACT CONTROLS, CPSET=TUCH, SCALE PENALTY=2.\n", "no contact pair set TUCH"),
        ("*CONTACT CONTROLS, CPSET=TOUCH, SCALE PENALTY=0.\n", "SCALE PENALTY=0. is not positive"),
        ("*CONTACT CONTROLS, CPSET=TOUCH, STABILIZE\n", "STABILIZE belongs to static and implicit steps"),
        ("*CONTACT CONTROLS, CPSET=TOUCH, MAXCHP=1\n", "modified hard contact is not available"),
        ("*CONTACT CONTROLS, SLAVE=SECOND, MASTER=FIRST\n", "SLAVE belongs to static and implicit steps"),
    ];
    for (card, fragment) in cases {
        refuses(&hard(&[card]), "*CONTACT CONTROLS", fragment);
    }
    refuses(
        &with("*NODE PRINT", "*CONTACT CONTROLS, SCALE PENALTY=2.\n*NODE PRINT"),
        "*CONTACT CONTROLS",
        "belongs to explicit steps",
    );

    let clearances = |text: &str| model(text).pairs[0].surfaces().expect("surfaces").clearances.clone();
    let found = clearances(&hard(&["*CLEARANCE, CPSET=TOUCH, VALUE=0.02\n"]));
    assert_eq!(found, (8..12).map(|n| (NodeId(n), 0.02)).collect::<Vec<_>>());
    let balanced = hard(&["*CLEARANCE, CPSET=TOUCH, VALUE=0.02\n"]).replace(", WEIGHT=0", "");
    assert_eq!(clearances(&balanced).len(), 8);
    let cases = [
        (vec!["*CLEARANCE, CPSET=TOUCH, VALUE=-0.1\n"], "clearance -0.1 is an overclosure"),
        (vec!["", "*CLEARANCE, CPSET=TOUCH, VALUE=0.1\n"], "*CLEARANCE stands outside the first step"),
        (vec!["*CLEARANCE, VALUE=0.1\n"], "parameter CPSET is missing"),
        (vec!["*CLEARANCE, SLAVE=SECOND, MASTER=FIRST, VALUE=0.1\n"], "MASTER belongs to static and implicit"),
    ];
    for (cards, fragment) in cases {
        refuses(&hard(&cards), "*CLEARANCE", fragment);
    }
    let sliding = hard(&["*CLEARANCE, CPSET=TOUCH, VALUE=0.02\n"]).replace(", SMALL SLIDING", "");
    refuses(&sliding, "*CLEARANCE", "*CLEARANCE needs a pair with SMALL SLIDING");
}

#[test]
fn contact_elements_and_implicit_softening_have_their_place() {
    let gap = "*ELEMENT, TYPE=GAPUNI, ELSET=GAPS\n31, 5, 11\n*GAP, ELSET=GAPS\n0., 0., 0., 1.\n*STEP\n";
    refuses(&explicit_deck(&with("*STEP\n", gap)), "*GAP", "contact elements belong to static and implicit analyses");
    let implicit = with("*STATIC\n0.1, 1.\n", "*DYNAMIC\n0.1, 1.\n")
        .replace("*BOUNDARY\nTOP, 3", "*BOUNDARY, TYPE=VELOCITY\nTOP, 3");
    warns(&implicit, "*SURFACE BEHAVIOR", "the linear law makes impacts elastic in an implicit dynamic step");
    assert!(read(&implicit.replace(LAW, "\n")).diagnostics.is_empty());
    assert!(read(&explicit_deck(BASE)).diagnostics.is_empty());
}
