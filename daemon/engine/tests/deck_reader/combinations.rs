//! Combinations of contact options that the manual forbids, one deck for each.

use overclosure::deck::{FEATURES, Family, Offer, RULES};
use overclosure::diagnostic::Severity;
use overclosure::model::{Dialect, InteractionId};

use crate::base::*;

const LAW: &str = "PRESSURE-OVERCLOSURE=LINEAR\n1e6\n";
const BEHAVIOR: &str = "*SURFACE BEHAVIOR";

/// The base deck as an explicit analysis, with another `*SURFACE BEHAVIOR`.
fn explicit(behavior: &str) -> String {
    explicit_deck(&with(LAW, behavior))
}

/// Asserts an error of each of these kinds on a deck.
#[track_caller]
fn refuses_all(text: &str, findings: &[(&str, &str)]) {
    for (keyword, fragment) in findings {
        refuses(text, keyword, fragment);
    }
}

#[test]
fn the_exponential_law_never_prevents_separation() {
    let behavior = "PRESSURE-OVERCLOSURE=EXPONENTIAL, NO SEPARATION\n0.01, 5.\n";
    let always = (BEHAVIOR, "the exponential law cannot be combined with NO SEPARATION in any analysis");
    let standard = (BEHAVIOR, "in implicit and static analyses NO SEPARATION belongs to hard contact");
    refuses_all(&with(LAW, behavior), &[always, standard]);
    refuses(&explicit(behavior), always.0, always.1);
    let listed = listing(&read(&explicit(behavior)).diagnostics);
    assert!(!listed.contains(standard.1), "{listed}");
}

#[test]
fn in_standard_softened_laws_separate_and_are_enforced_as_they_are() {
    for (law, data) in [("LINEAR", "1."), ("TABULAR", "0., 0.\n1., 1."), ("EXPONENTIAL", "0.01, 5.")] {
        let name = law.to_lowercase();
        for option in ["NO SEPARATION", "AUGMENTED LAGRANGE", "PENALTY"] {
            let text = with(LAW, &format!("PRESSURE-OVERCLOSURE={law}, {option}\n{data}\n"));
            refuses(&text, BEHAVIOR, &format!("the {name} law cannot be combined with {option}"));
        }
    }
}

#[test]
fn general_contact_has_neither_exponential_law_nor_no_separation_nor_tables_that_begin_elsewhere() {
    let general = |behavior: &str| {
        explicit(behavior)
            .replace("*CONTACT PAIR, INTERACTION=SI, SMALL SLIDING\nSECOND, FIRST\n", "")
            .replace("*NODE PRINT", "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n*NODE PRINT")
    };
    let exponential = general("PRESSURE-OVERCLOSURE=EXPONENTIAL\n0.01, 5.\n");
    refuses(&exponential, BEHAVIOR, "the exponential law is not available for general contact");
    let table = general("PRESSURE-OVERCLOSURE=TABULAR\n0., 0.01\n1., 0.02\n");
    refuses(&table, BEHAVIOR, "the table does not begin at zero overclosure, as general contact needs it");
    refuses(&general("NO SEPARATION\n"), BEHAVIOR, "NO SEPARATION is not available for general contact");
    let listed = listing(&read(&general("PRESSURE-OVERCLOSURE=TABULAR\n0., 0.\n1., 0.02\n")).diagnostics);
    assert!(!listed.contains(BEHAVIOR), "{listed}");
}

#[test]
fn no_separation_in_explicit_needs_pure_weighting_and_a_mesh_that_stays() {
    let weighted =
        |weight: &str| explicit("NO SEPARATION\n").replace("SMALL SLIDING", &format!("SMALL SLIDING{weight}"));
    let balanced = "NO SEPARATION cannot be combined with balanced weighting";
    refuses(&weighted(""), BEHAVIOR, balanced);
    refuses(&weighted(", WEIGHT=0.5"), BEHAVIOR, balanced);
    for weight in [", WEIGHT=0.", ", WEIGHT=1."] {
        let listed = listing(&read(&weighted(weight)).diagnostics);
        assert!(!listed.contains(balanced), "{listed}");
    }
    let adaptive = weighted(", WEIGHT=1.").replace("*NODE PRINT", "*ADAPTIVE MESH, ELSET=UPPER\n*NODE PRINT");
    refuses_all(
        &adaptive,
        &[(BEHAVIOR, "NO SEPARATION cannot be combined with *ADAPTIVE MESH"), ("*ADAPTIVE MESH", "not supported")],
    );
}

#[test]
fn no_separation_of_a_table_needs_a_point_of_zero_pressure() {
    let text = explicit("PRESSURE-OVERCLOSURE=TABULAR, NO SEPARATION\n1., 0.\n2., 0.1\n");
    refuses(&text, BEHAVIOR, "NO SEPARATION cannot be combined with a table without a point of zero pressure");
}

#[test]
fn damping_of_hard_kinematic_contact_is_ignored_with_a_warning() {
    let damped = explicit("\n*CONTACT DAMPING\n8., 0.1\n");
    let message = "*CONTACT DAMPING is ignored for hard kinematic contact";
    finds(&damped, Dialect::Abaqus, Severity::Warning, "*CONTACT DAMPING", message);
    for text in [
        damped.replace("SMALL SLIDING", "SMALL SLIDING, MECHANICAL CONSTRAINT=PENALTY"),
        explicit(&format!("{LAW}*CONTACT DAMPING\n8., 0.1\n")),
    ] {
        let listed = listing(&read(&text).diagnostics);
        assert!(!listed.contains(message), "{listed}");
    }
}

#[test]
fn the_critical_damping_fraction_belongs_to_explicit_analyses() {
    let behavior = "\n*CONTACT DAMPING, DEFINITION=CRITICAL DAMPING FRACTION\n0.1\n";
    refuses(
        &with(LAW, behavior),
        "*CONTACT DAMPING",
        "the critical damping fraction is not available for contact pairs of",
    );
    let listed = listing(&read(&explicit(behavior)).diagnostics);
    assert!(!listed.contains("critical damping fraction"), "{listed}");
}

#[test]
fn augmented_lagrange_does_not_debond() {
    let debonding = |names: &str| {
        with(LAW, "AUGMENTED LAGRANGE\n").replace("*NODE PRINT", &format!("*DEBOND{names}\n0., 1.\n*NODE PRINT"))
    };
    let message = "AUGMENTED LAGRANGE cannot be combined with *DEBOND";
    for names in ["", ", SLAVE=SECOND, MASTER=FIRST"] {
        refuses_all(&debonding(names), &[(BEHAVIOR, message), ("*DEBOND", "not supported")]);
    }
    let listed = listing(&read(&debonding(", SLAVE=FIRST, MASTER=SECOND")).diagnostics);
    assert!(!listed.contains(message), "{listed}");
}

#[test]
fn modified_hard_contact_belongs_to_standard() {
    let text = explicit("\n").replace("*NODE PRINT", "*CONTACT CONTROLS, MAXCHP=1, UERRMX=0.1\n*NODE PRINT");
    refuses(&text, "*CONTACT CONTROLS", "modified hard contact is not available for contact pairs of explicit");
}

#[test]
fn augmented_lagrange_belongs_to_standard() {
    let message = "augmented Lagrange is not available for contact pairs of explicit analyses";
    refuses(&explicit("AUGMENTED LAGRANGE\n"), BEHAVIOR, message);
}

#[test]
fn a_rigid_surface_is_not_the_secondary_one_of_kinematic_contact() {
    let rigid = explicit("\n")
        .replace("*STEP\n", "*RIGID BODY, ELSET=UPPER, REF NODE=15\n*STEP\n")
        .replace("TOP, 1, 2\n", "15, 1, 2\n")
        .replace("TOP, 3, 3", "15, 3, 3");
    let message = "a rigid surface cannot be the secondary one of kinematic contact";
    for (weight, is_wrong) in [("0", true), ("0.5", true), ("1", false)] {
        let text = rigid.replace("SMALL SLIDING", &format!("SMALL SLIDING, WEIGHT={weight}"));
        let listed = listing(&read(&text).diagnostics);
        assert_eq!(listed.contains(message), is_wrong, "{listed}");
        let penalty = text.replace("SMALL SLIDING", "SMALL SLIDING, MECHANICAL CONSTRAINT=PENALTY");
        assert!(read(&penalty).diagnostics.is_empty(), "{}", listing(&read(&penalty).diagnostics));
    }
    refuses(&rigid, "*CONTACT PAIR", message);
    assert_eq!(model(&rigid.replace("SECOND, FIRST", "FIRST, SECOND")).pairs[0].name, "FIRST_SECOND");
}

#[test]
fn pressure_penetration_and_general_contact_are_refused_with_a_reason() {
    let text = with("*NODE PRINT", "*PRESSURE PENETRATION, SLAVE=SECOND, MASTER=FIRST\n11, 5, 1.\n*NODE PRINT");
    refuses(&text, "*PRESSURE PENETRATION", "not supported");
    let text = explicit("\n")
        .replace("*NODE PRINT", "*PRESSURE PENETRATION, SLAVE=SECOND, MASTER=FIRST\n11, 5, 1.\n*NODE PRINT");
    refuses(&text, "*PRESSURE PENETRATION", "pressure penetration is not available for contact pairs of explicit");
    refuses(&with("*NODE PRINT", "*CONTACT\n*NODE PRINT"), "*CONTACT", "within a step");
}

#[test]
fn contact_elements_that_slide_are_refused_with_a_reason() {
    for (kind, reason) in [
        ("ITT31", "sliding is small"),
        ("ISL21", "sliding is small"),
        ("IRS22", "sliding is small"),
        ("INTER4", "*CONTACT PAIR"),
        ("DGAP", "temperatures"),
    ] {
        let text = with("*NSET, NSET=BOTTOM", &format!("*ELEMENT, TYPE={kind}, ELSET=C\n9, 5, 11\n*NSET, NSET=BOTTOM"));
        refuses(&text, "*ELEMENT", &format!("element type {kind} is not supported"));
        let listed = listing(&read(&text).diagnostics);
        assert!(listed.contains(reason), "{listed}");
    }
    let text = with(
        "*STEP\n",
        "*INTERFACE, ELSET=C\n1.\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR, NO SEPARATION\n1.\n*STEP\n",
    );
    refuses(&text, "*INTERFACE", "not supported");
    refuses(&text, BEHAVIOR, "the linear law cannot be combined with NO SEPARATION");
}

#[test]
fn the_data_of_a_refused_law_are_not_complained_about() {
    let found = read(&with(LAW, "PRESSURE-OVERCLOSURE=TIED\n1e6\n")).diagnostics;
    assert_eq!(found.len(), 1, "{}", listing(&found));
}

#[test]
fn interactions_and_pairs_may_stand_in_explicit_steps() {
    let card = "*SURFACE INTERACTION, NAME=SI\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e6\n\
        *CONTACT PAIR, INTERACTION=SI, SMALL SLIDING\nSECOND, FIRST\n";
    let bare = explicit_deck(&with(card, ""));
    let moved = bare.replace("*NODE PRINT", &format!("{card}*NODE PRINT"));
    let found = read(&moved).diagnostics;
    assert!(found.is_empty(), "{}", listing(&found));
    assert_eq!((model(&moved).pairs.len(), model(&moved).pairs[0].interaction), (1, InteractionId(0)));
    let wrong = moved.replace("=LINEAR\n1e6", "=EXPONENTIAL, NO SEPARATION\n0.01, 5.");
    refuses(&wrong, BEHAVIOR, "the exponential law cannot be combined with NO SEPARATION in any analysis");
}

#[test]
fn every_refusal_of_the_tables_has_a_remedy() {
    for rule in RULES {
        assert!(
            !rule.reason.is_empty() && !rule.remedy.is_empty() && !rule.families.is_empty(),
            "{}",
            rule.combination
        );
    }
    for feature in FEATURES {
        let refused = Family::ALL.iter().any(|&family| matches!(feature.offer(family), Offer::No(_)));
        assert_eq!(refused, !feature.remedy.is_empty(), "{}", feature.name);
    }
}
