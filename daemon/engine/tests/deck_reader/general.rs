//! General contact of explicit analyses.

use overclosure::model::*;

use crate::base::*;

const PAIR: &str = "*CONTACT PAIR, INTERACTION=SI, SMALL SLIDING\nSECOND, FIRST\n";
const ALL: &str = "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n";
const SI: &str = "*CONTACT PROPERTY ASSIGNMENT\n, , SI\n";

/// The base deck as an explicit analysis with these cards in place of its pair; a second interaction is there.
fn general(cards: &str) -> String {
    let other = "*SURFACE INTERACTION, NAME=HARD\n";
    explicit_deck(&with(PAIR, "")).replacen("*STEP\n", &format!("{other}{cards}*STEP\n"), 1)
}

/// Surfaces of each part by name, with interaction, weight, and names of the couples that it leaves out.
fn parts(text: &str) -> Vec<(String, [String; 2], String, f64, usize)> {
    let model = model(text);
    let name = |surface: SurfaceId| model.mesh.surfaces[surface.index()].name.clone();
    let part = |pair: &ContactPair| match &pair.members {
        PairMembers::General(part) => (
            pair.name.clone(),
            part.surfaces.map(name),
            model.interactions[pair.interaction.index()].name.clone(),
            pair.explicit.weight.0,
            part.excluded.len(),
        ),
        other => panic!("{other:?}"),
    };
    assert!(model.pairs.iter().all(|pair| pair.explicit.constraint == MechanicalConstraint::Penalty));
    model.pairs.iter().map(part).collect()
}

fn all(name: &str) -> [String; 2] {
    [name.to_string(), name.to_string()]
}

#[test]
fn all_exterior_is_every_outer_face() {
    let text = general(&format!("{ALL}{SI}"));
    let model = model(&text);
    let surface = model.mesh.surfaces.iter().find(|surface| surface.name == "ALL_EXTERIOR").expect("the surface");
    let SurfaceKind::Faces(faces) = &surface.kind else { panic!("{surface:?}") };
    assert_eq!(faces.len(), 12);
    assert_eq!(parts(&text), [("GENERAL_CONTACT".into(), all("ALL_EXTERIOR"), "SI".into(), 0.5, 0)]);
    // Where two elements share a face, it is not an outer one.
    let shared = text.replace("2, 11, 12, 13, 14, 15", "2, 5, 6, 7, 8, 15").replace("UPPER, S1", "UPPER, S2");
    let model = accepted(&shared, Dialect::Abaqus).0;
    let surface = model.mesh.surfaces.iter().find(|surface| surface.name == "ALL_EXTERIOR").expect("the surface");
    assert!(matches!(&surface.kind, SurfaceKind::Faces(faces) if faces.len() == 10));
}

#[test]
fn without_an_assignment_general_contact_is_hard() {
    let found = parts(&general(ALL));
    assert_eq!(found, [("GENERAL_CONTACT".into(), all("ALL_EXTERIOR"), "default".into(), 0.5, 0)]);
}

#[test]
fn couples_with_properties_of_their_own_are_parts() {
    let text = general(&format!(
        "{ALL}*CONTACT EXCLUSIONS\nFIRST, FIRST\n{SI}SECOND, FIRST, HARD\n\
         *CONTACT FORMULATION, TYPE=PURE MASTER-SLAVE\nFIRST, SECOND, MASTER\n\
         *CONTACT CONTROLS ASSIGNMENT, TYPE=SCALE PENALTY\nFIRST, SECOND, 0.1\n"
    ));
    let pure = ["SECOND".to_string(), "FIRST".to_string()];
    let expected = [
        ("GENERAL_CONTACT".to_string(), all("ALL_EXTERIOR"), "SI".to_string(), 0.5, 2),
        ("GENERAL_SECOND_FIRST".to_string(), pure, "HARD".to_string(), 1.0, 1),
    ];
    assert_eq!(parts(&text), expected);
    let contact = &model(&text).steps[0].contact;
    assert_eq!([0, 1].map(|pair| contact.controls_of(pair).scale_penalty), [1.0, 0.1]);
    assert!([0, 1].iter().all(|&pair| contact.is_active(pair)));
}

#[test]
fn couples_may_be_included_one_by_one() {
    let found = parts(&general("*CONTACT\n*CONTACT INCLUSIONS\nSECOND, FIRST\n*CONTACT PROPERTY ASSIGNMENT\n, , SI\n"));
    let couple = ["SECOND".to_string(), "FIRST".to_string()];
    assert_eq!(found, [("GENERAL_SECOND_FIRST".to_string(), couple, "SI".to_string(), 0.5, 0)]);
}

#[test]
fn contact_pairs_stay_out_of_general_contact() {
    let text = general(&format!("{ALL}{SI}{}", PAIR.replace("=SI", "=HARD")));
    let model = model(&text);
    let PairMembers::General(part) = &model.pairs[1].members else { panic!("{:?}", model.pairs[1]) };
    let pair = model.pairs[0].surfaces().expect("surfaces");
    assert_eq!(part.excluded, [[pair.secondary, pair.primary]]);
}

#[test]
fn general_contact_changes_as_a_whole() {
    let step = |cards: &str| format!("*STEP\n*DYNAMIC, EXPLICIT\n, 1.\n{cards}*END STEP\n");
    let text = general("").replace("*NODE PRINT", &format!("{ALL}{SI}*NODE PRINT"));
    let anew = format!("*CONTACT, OP=NEW\n*CONTACT INCLUSIONS\nSECOND, FIRST\n{SI}");
    let model = model(&format!("{text}{}{}{}", step(""), step(&anew), step("*CONTACT, OP=NEW\n")));
    let active: Vec<_> = model.steps.iter().map(|s| [0, 1].map(|pair| s.contact.is_active(pair))).collect();
    assert_eq!(active, [[true, false], [true, false], [false, true], [false, false]]);
    refuses(&format!("{text}{}", step(ALL)), "*CONTACT", "general contact is described already");
}

#[test]
fn general_contact_is_checked() {
    let cases = [
        ("*CONTACT\n", "*CONTACT", "nothing is included"),
        ("*CONTACT\n*CONTACT INCLUSIONS\n", "*CONTACT INCLUSIONS", "the data line is missing"),
        ("*CONTACT INCLUSIONS, ALL EXTERIOR\n", "*CONTACT INCLUSIONS", "no general contact is being described here"),
        ("*CONTACT\n*CONTACT INCLUSIONS\nSECOND, THIRD\n", "*CONTACT INCLUSIONS", "no surface THIRD"),
    ];
    for (cards, keyword, fragment) in cases {
        refuses(&general(cards), keyword, fragment);
    }
    let cases = [
        ("*CONTACT PROPERTY ASSIGNMENT\n, ,\n", "*CONTACT PROPERTY ASSIGNMENT", "the surface interaction is missing"),
        ("*CONTACT PROPERTY ASSIGNMENT\n, , X\n", "*CONTACT PROPERTY ASSIGNMENT", "no surface interaction X"),
        (
            "*CONTACT FORMULATION, TYPE=PURE MASTER-SLAVE\nFIRST, SECOND, BOTH\n",
            "*CONTACT FORMULATION",
            "BOTH is no part of a surface",
        ),
        (
            "*CONTACT FORMULATION, TYPE=PURE MASTER-SLAVE\nFIRST, FIRST\n",
            "*CONTACT FORMULATION",
            "has no secondary and primary one",
        ),
        (
            "*CONTACT CONTROLS ASSIGNMENT, TYPE=SCALE PENALTY\nFIRST, SECOND, 0.\n",
            "*CONTACT CONTROLS ASSIGNMENT",
            "factor on the penalty 0 is not positive",
        ),
        (
            "*CONTACT CONTROLS ASSIGNMENT, NODAL EROSION=YES\n",
            "*CONTACT CONTROLS ASSIGNMENT",
            "NODAL EROSION=YES is not supported",
        ),
        ("*CONTACT CLEARANCE ASSIGNMENT\n", "*CONTACT CLEARANCE ASSIGNMENT", "not supported"),
    ];
    for (cards, keyword, fragment) in cases {
        refuses(&general(&format!("{ALL}{cards}")), keyword, fragment);
    }
    let nodes = general("*SURFACE, NAME=POINTS, TYPE=NODE\n5,\n*CONTACT\n*CONTACT INCLUSIONS\nSECOND, POINTS\n");
    refuses(&nodes, "*CONTACT INCLUSIONS", "surface POINTS is made of nodes, and general contact is that of faces");
    refuses(
        &with("*STEP\n", &format!("{ALL}*STEP\n")),
        "*CONTACT",
        "general contact belongs to explicit analyses here",
    );
}
