//! Contact that changes from step to step.

use overclosure::deck::summary;
use overclosure::model::*;

use crate::base::*;

/// The base deck with hard contact and cards in each of its steps.
fn steps(behavior: &str, cards: &[&str]) -> String {
    let text = with("PRESSURE-OVERCLOSURE=LINEAR\n1e6\n", behavior);
    let (before, step) = text.split_at(text.find("*STEP\n").expect("a step"));
    let later = "*STEP\n*STATIC\n1., 1.\n*END STEP\n";
    let first = |card: &str| step.replacen("*NODE PRINT", &format!("{card}*NODE PRINT"), 1);
    let more: String = cards[1..].iter().map(|card| later.replacen("*END", &format!("{card}*END"), 1)).collect();
    format!("{before}{}{more}", first(cards[0]))
}

fn contact(behavior: &str, cards: &[&str]) -> Vec<StepContact> {
    model(&steps(behavior, cards)).steps.into_iter().map(|step| step.contact).collect()
}

const PAIR: &str = "SLAVE=SECOND, MASTER=FIRST";

#[test]
fn controls_stay_until_they_are_changed_or_reset() {
    let found = contact(
        "AUGMENTED LAGRANGE\n",
        &[
            "*CONTACT CONTROLS, RELATIVE PENETRATION TOLERANCE=0.01\n",
            "",
            "*CONTACT CONTROLS, SLAVE=SECOND, MASTER=FIRST, ABS=2e-4, STIFFNESS SCALE FACTOR=5.\n",
            "*CONTACT CONTROLS, STIFFNESS SCALE FACTOR=7.\n",
            "*CONTACT CONTROLS, SLAVE=SECOND, MASTER=FIRST, RESET\n",
            "*CONTACT CONTROLS, SLAVE=SECOND, MASTER=FIRST, ABS=2e-4\n",
            "*CONTACT CONTROLS, RESET, FRICTION ONSET=DELAYED\n",
            "*CONTACT CONTROLS, RESET\n",
        ],
    );
    let default = ContactControls::default();
    let relative = ContactControls { penetration_tolerance: PenetrationTolerance::Relative(0.01), ..default };
    let own = ContactControls {
        penetration_tolerance: PenetrationTolerance::Absolute(2e-4),
        stiffness_scale: 5.0,
        ..default
    };
    let controls: Vec<_> = found.iter().map(|step| step.controls_of(0)).collect();
    let seven = ContactControls { stiffness_scale: 7.0, ..relative };
    let delayed = ContactControls { friction_onset: FrictionOnset::Delayed, ..default };
    let both = ContactControls { penetration_tolerance: PenetrationTolerance::Absolute(2e-4), ..seven };
    // RESET without a pair resets the controls of every pair.
    assert_eq!(controls, [relative, relative, own, own, seven, both, delayed, default]);
    assert!(found[7].controls.is_empty());
}

#[test]
fn modified_hard_contact_is_stated_as_a_whole() {
    let modified = |points_max, tension_max, overclosure_max, global| {
        Some(ModifiedHard { points_max, tension_max, overclosure_max, global })
    };
    let found = contact(
        "\n",
        &[
            "*CONTACT CONTROLS, MAXCHP=3, UERRMX=0.02, PERRMX=1.5\n",
            &format!("*CONTACT CONTROLS, {PAIR}, MAXCHP=1, PERRMX=2.\n"),
        ],
    );
    assert_eq!(found[0].controls_of(0).modified, modified(3, 1.5, 0.02, true));
    assert_eq!(found[1].controls_of(0).modified, modified(1, 2.0, 0.0, false));
    let dropped = steps("\n", &["*CONTACT CONTROLS, MAXCHP=3, UERRMX=0.02\n", "*CONTACT CONTROLS, MAXCHP=1\n"]);
    warns(&dropped, "*CONTACT CONTROLS", "UERRMX was 0.02 before and is 0 from this step on");
}

#[test]
fn controls_are_checked() {
    for (parameters, fragment) in [
        ("ABSOLUTE PENETRATION TOLERANCE=0.", "ABSOLUTE PENETRATION TOLERANCE=0. is not positive"),
        ("RELATIVE PENETRATION TOLERANCE=-1.", "RELATIVE PENETRATION TOLERANCE=-1. is not positive"),
        ("STIFFNESS SCALE FACTOR=0.", "STIFFNESS SCALE FACTOR=0. is not positive"),
        ("STIFFNESS SCALE FACTOR=nan", "STIFFNESS SCALE FACTOR=nan is not a"),
        ("MAXCHP=1.5", "MAXCHP=1.5 is not a whole number"),
        ("MAXCHP=-1", "MAXCHP=-1 is negative"),
        ("MAXCHP=many", "MAXCHP=many is not a number"),
        ("MAXCHP=1, UERRMX=-0.1", "UERRMX=-0.1 is negative"),
        ("MAXCHP=1, PERRMX=-0.1", "PERRMX=-0.1 is negative"),
        ("UERRMX=0.1", "UERRMX and PERRMX need MAXCHP"),
        ("PERRMX=0.1", "UERRMX and PERRMX need MAXCHP"),
        ("AUTOMATIC TOLERANCES, MAXCHP=1", "AUTOMATIC TOLERANCES cannot be combined"),
        ("ABS=0.1, REL=0.1", "ABSOLUTE and RELATIVE PENETRATION TOLERANCE exclude each other"),
        ("SLAVE=SECOND, MAXCHP=1", "SLAVE and MASTER name a pair together"),
        ("SLAVE=FIRST, MASTER=SECOND, MAXCHP=1", "FIRST and SECOND are no contact pair"),
        ("SLAVE=THIRD, MASTER=FIRST, MAXCHP=1", "no surface THIRD"),
        ("TANGENT FRACTION=0.5", "TANGENT FRACTION belongs to STABILIZE"),
        ("FRICTION ONSET=LATE", "FRICTION ONSET=LATE is not known"),
        ("SCALE PENALTY=2.", "SCALE PENALTY belongs to explicit steps"),
        ("MAXCHP=1\n1., 2.", "a data line is read behind STABILIZE only"),
        ("STABILIZE=0.", "STABILIZE=0. is not positive"),
        ("STABILIZE\n-1.", "damping coefficient -1 is not positive"),
        ("STABILIZE\n1., 2.", "part left at the end of the step 2 is not from 0 to 1"),
        ("STABILIZE\n1., 0., 0.", "clearance without damping 0 is not positive"),
    ] {
        let text = steps("\n", &[&format!("*CONTACT CONTROLS, {parameters}\n")]);
        refuses(&text, "*CONTACT CONTROLS", fragment);
    }
}

#[test]
fn controls_that_have_no_effect_are_named() {
    for (behavior, parameters, fragment) in [
        ("\n", "ABS=0.1", "the penetration tolerance has no effect: no pair is enforced by AUGMENTED LAGRANGE"),
        ("\n", "SLAVE=SECOND, MASTER=FIRST, ABS=0.1", "the penetration tolerance has no effect: the pair is not"),
        ("\n", "STIFFNESS SCALE FACTOR=2.", "STIFFNESS SCALE FACTOR has no effect"),
        ("AUGMENTED LAGRANGE\n", "MAXCHP=1, UERRMX=1.", "MAXCHP, PERRMX and UERRMX have no effect"),
        ("\n", "AUTOMATIC TOLERANCES", "AUTOMATIC TOLERANCES has no effect"),
        ("\n", "APPROACH", "APPROACH has no effect"),
        ("\n", "SLIDE DISTANCE=3.", "SLIDE DISTANCE has no effect"),
    ] {
        let text = steps(behavior, &[&format!("*CONTACT CONTROLS, {parameters}\n")]);
        warns(&text, "*CONTACT CONTROLS", fragment);
        assert_eq!(model(&text).steps[0].contact.controls_of(0).modified, None);
    }
    let softened = "PRESSURE-OVERCLOSURE=LINEAR\n1.\n";
    for behavior in [softened, "AUGMENTED LAGRANGE\n", "PENALTY\n"] {
        let text = steps(behavior, &["*CONTACT CONTROLS, SLAVE=SECOND, MASTER=FIRST, MAXCHP=1, UERRMX=1.\n"]);
        refuses(&text, "*CONTACT CONTROLS", "name a pair that is not hard contact enforced by multipliers");
    }
}

#[test]
fn stabilization_is_automatic_scaled_or_given() {
    let stabilization =
        |card: &str| contact("\n", &[&format!("*CONTACT CONTROLS, {card}\n")])[0].controls_of(0).stabilization;
    let default =
        Stabilization { coefficient: None, factor: 1.0, fraction_end: 0.0, clearance: None, tangent_fraction: 1.0 };
    assert_eq!(stabilization("STABILIZE"), Some(default));
    assert_eq!(stabilization("STABILIZE=0.1"), Some(Stabilization { factor: 0.1, ..default }));
    assert_eq!(
        stabilization("STABILIZE, TANGENT FRACTION=0."),
        Some(Stabilization { tangent_fraction: 0.0, ..default })
    );
    let given = Stabilization { coefficient: Some(5.0), fraction_end: 0.5, clearance: Some(0.2), ..default };
    assert_eq!(stabilization("STABILIZE\n5., 0.5, 0.2"), Some(given));
}

#[test]
fn pairs_are_removed_and_added_again() {
    let found = contact(
        "\n",
        &[
            "*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nSECOND, FIRST\n",
            "",
            "*MODEL CHANGE, TYPE=CONTACT PAIR, ADD\nSECOND, FIRST\n",
        ],
    );
    assert_eq!(found.iter().map(|step| step.is_active(0)).collect::<Vec<_>>(), [false, false, true]);
    warns(
        &steps("\n", &["*MODEL CHANGE, TYPE=CONTACT PAIR, ADD\nSECOND, FIRST\n"]),
        "*MODEL CHANGE",
        "is active already",
    );
    for (card, fragment) in [
        (", TYPE=CONTACT PAIR\nSECOND, FIRST", "one of ADD and REMOVE"),
        (", TYPE=CONTACT PAIR, ADD, REMOVE\nSECOND, FIRST", "one of ADD and REMOVE"),
        (", TYPE=CONTACT PAIR, REMOVE", "the data line is missing"),
        (", TYPE=CONTACT PAIR, REMOVE\nSECOND", "does not name two surfaces"),
        (", TYPE=CONTACT PAIR, REMOVE\nFIRST, SECOND", "FIRST and SECOND are no contact pair"),
        (", REMOVE\nUPPER", "TYPE is missing, which means elements"),
        (", TYPE=ELEMENT, REMOVE\nUPPER", "TYPE=ELEMENT is not supported"),
    ] {
        refuses(&steps("\n", &[&format!("*MODEL CHANGE{card}\n")]), "*MODEL CHANGE", fragment);
    }
}

#[test]
fn friction_changes_by_interaction() {
    let found = contact(
        "\n",
        &["*CHANGE FRICTION, INTERACTION=SI\n*FRICTION, ROUGH\n", "", "*CHANGE FRICTION, INTERACTION=si, RESET\n"],
    );
    assert_eq!(found[0].frictions, [Friction::Rough]);
    assert_eq!(found[1].frictions, [Friction::Rough]);
    assert!(found[2].frictions.is_empty());
    let smooth = contact("\n*FRICTION, ROUGH\n", &["*CHANGE FRICTION, INTERACTION=SI\n*FRICTION\n0.\n"]);
    assert_eq!(smooth[0].frictions, [Friction::None]);
    for (cards, keyword, fragment) in [
        ("*CHANGE FRICTION, INTERACTION=SI\n", "*CHANGE FRICTION", "no *FRICTION follows"),
        ("*CHANGE FRICTION\n*FRICTION, ROUGH\n", "*CHANGE FRICTION", "INTERACTION or ELSET"),
        ("*CHANGE FRICTION, INTERACTION=SO\n*FRICTION, ROUGH\n", "*CHANGE FRICTION", "no surface interaction SO"),
        ("*CHANGE FRICTION, ELSET=UPPER\n*FRICTION, ROUGH\n", "*CHANGE FRICTION", "no set of contact elements"),
        (
            "*CHANGE FRICTION, INTERACTION=SI\n*FRICTION\n0.2\n",
            "*FRICTION",
            "friction coefficient 0.2 is not supported",
        ),
        ("*CHANGE FRICTION, INTERACTION=SI, RESET\n*FRICTION, ROUGH\n", "*FRICTION", "RESET"),
    ] {
        refuses(&steps("\n", &[cards]), keyword, fragment);
    }
}

#[test]
fn interferences_are_allowed_per_pair() {
    let found = contact(
        "\n",
        &[
            "*CONTACT INTERFERENCE, SHRINK\nSECOND, FIRST\n",
            "",
            "*CONTACT INTERFERENCE, AMPLITUDE=FADE\nSECOND, FIRST, 0.02\n*AMPLITUDE, NAME=FADE\n0., 1., 1., 0.\n",
            "*CONTACT INTERFERENCE, OP=NEW\n",
        ],
    );
    let shrink = Interference { allowed: AllowedOverclosure::Initial, amplitude: None, step: 0 };
    let uniform = Interference { allowed: AllowedOverclosure::Uniform(0.02), amplitude: Some(AmplitudeId(0)), step: 2 };
    let interferences: Vec<_> = found.iter().map(|step| step.interference_of(0)).collect();
    assert_eq!(interferences, [Some(shrink), Some(shrink), Some(uniform), None]);
    for (cards, fragment) in [
        (["\nSECOND, FIRST\n", ""], "overclosure that is allowed is missing"),
        ([", SHRINK\nSECOND, FIRST, 0.1\n", ""], "item 3 is not read"),
        (["\nSECOND, FIRST, 0.1, 1., 0., 0.\n", ""], "a direction in which the secondary surface is shifted"),
        (["\n", ""], "the data line is missing"),
        (["\nFIRST, SECOND, 0.1\n", ""], "are no contact pair"),
        ([", TYPE=ELEMENT\nUPPER, 0.1\n", ""], "no set of contact elements"),
        ([", AMPLITUDE=NONE\nSECOND, FIRST, 0.1\n", ""], "no amplitude NONE"),
    ] {
        let cards =
            cards.map(|card| if card.is_empty() { String::new() } else { format!("*CONTACT INTERFERENCE{card}") });
        refuses(&steps("\n", &cards.each_ref().map(String::as_str)), "*CONTACT INTERFERENCE", fragment);
    }
    let later = steps("\n", &["", "*CONTACT INTERFERENCE, SHRINK\nSECOND, FIRST\n"]);
    refuses(&later, "*CONTACT INTERFERENCE", "SHRINK stands outside the first step");
    let ignored =
        steps("\n", &["*CONTACT INTERFERENCE, SHRINK, AMPLITUDE=A\nSECOND, FIRST\n*AMPLITUDE, NAME=A\n0., 1.\n"]);
    warns(&ignored, "*CONTACT INTERFERENCE", "AMPLITUDE is ignored with SHRINK");
}

#[test]
fn the_summary_names_what_steps_change() {
    let text = steps(
        "\n",
        &[
            "*CONTACT CONTROLS, MAXCHP=2, UERRMX=0.1\n*CONTACT INTERFERENCE, SHRINK\nSECOND, FIRST\n",
            "*CHANGE FRICTION, INTERACTION=SI\n*FRICTION, ROUGH\n",
            "*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nSECOND, FIRST\n",
        ],
    );
    let summary = summary(&model(&text));
    for words in ["modified hard: up to 2 points", "interference", "removed", "rough friction"] {
        assert!(summary.contains(words), "{words}: {summary}");
    }
}

#[test]
fn contact_elements_change_by_their_set() {
    let gaps = "*ELEMENT, TYPE=GAPUNI, ELSET=STOPS\n21, 1, 15\n*GAP, ELSET=STOPS\n0.5, 0., 0., 1., 2.\n\
        *SURFACE BEHAVIOR, AUGMENTED LAGRANGE\n7e4\n*CONTACT DAMPING\n8., 0.1\n*BOUNDARY\nBOTTOM";
    let cards = "*CHANGE FRICTION, ELSET=STOPS\n*FRICTION, ROUGH\n*CONTACT INTERFERENCE, TYPE=ELEMENT\nstops, 0.01\n\
        *CONTACT CONTROLS, STIFFNESS SCALE FACTOR=2.\n";
    let model = model(&steps("\n", &[cards]).replacen("*BOUNDARY\nBOTTOM", gaps, 1));
    let pair = model.pairs.iter().position(|pair| pair.name == "STOPS").expect("a pair of GAP elements");
    let interaction = &model.interactions[model.pairs[pair].interaction.index()];
    let penalty = LinearPenalty { stiffness: Some(7e4), ..LinearPenalty::default() };
    assert_eq!(interaction.enforcement, Enforcement::AugmentedLagrange(penalty));
    assert!(interaction.damping.is_some());
    assert_eq!(model.interactions[0].damping, None);
    let contact = &model.steps[0].contact;
    let mut frictions = [Friction::None; 2];
    frictions[pair] = Friction::Rough;
    assert_eq!(contact.frictions, frictions);
    let allowed = contact.interference_of(pair).map(|interference| interference.allowed);
    assert_eq!(allowed, Some(AllowedOverclosure::Uniform(0.01)));
    assert_eq!(contact.controls_of(pair).stiffness_scale, 2.0);
    let softened = gaps.replace("AUGMENTED LAGRANGE\n7e4", "NO SEPARATION, PRESSURE-OVERCLOSURE=LINEAR\n1.");
    let text = steps("\n", &[""]).replacen("*BOUNDARY\nBOTTOM", &softened, 1);
    refuses(&text, "*SURFACE BEHAVIOR", "the linear law cannot be combined with NO SEPARATION");
}
