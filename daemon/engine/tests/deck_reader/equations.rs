//! `*EQUATION`: linear constraints between displacements.

use overclosure::deck::summary;
use overclosure::model::*;

use crate::base::*;

/// The base deck with equations; its nodes 5 to 8 and 11 to 14 are free.
fn equated(lines: &str) -> String {
    with("*MATERIAL", &format!("*EQUATION\n{lines}*MATERIAL"))
}

/// Terms of the equations by the numbers of the deck, directions from 1.
fn terms(text: &str) -> Vec<Vec<(u32, u8, f64)>> {
    let model = model(text);
    let label = |node: NodeId| model.mesh.node_labels[node.index()];
    let of = |equation: &Equation| equation.terms.iter().map(|&(n, d, c)| (label(n), d + 1, c)).collect();
    model.equations.iter().map(of).collect()
}

#[test]
fn equations_are_read_over_several_lines() {
    let text = equated("2\n5, 1, 1., 6, 1, -1.\n5\n7,3,2.,8,3,-1.,\n11,3,-0.5,12,3,-0.25\n13,3,-.25,\n");
    let expected = vec![
        vec![(5, 1, 1.0), (6, 1, -1.0)],
        vec![(7, 3, 2.0), (8, 3, -1.0), (11, 3, -0.5), (12, 3, -0.25), (13, 3, -0.25)],
    ];
    assert_eq!(terms(&text), expected);
    let model = model(&text);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(model.equations.iter().map(|e| lines[e.place.line as usize - 1]).collect::<Vec<_>>(), ["2", "5"]);
    assert!(summary(&model).contains("equations     2"), "{}", summary(&model));
}

#[test]
fn members_of_sets_are_paired_by_their_numbers() {
    let sets = "*NSET, NSET=LEFT\n8, 5\n*NSET, NSET=RIGHT\n6, 7\n*NSET, NSET=ONE\n11\n";
    let text =
        equated("3\nLEFT, 1, 1., RIGHT, 1, -1., ONE, 1, 2.\n").replacen("*SURFACE", &format!("{sets}*SURFACE"), 1);
    let expected = vec![vec![(5, 1, 1.0), (6, 1, -1.0), (11, 1, 2.0)], vec![(8, 1, 1.0), (7, 1, -1.0), (11, 1, 2.0)]];
    assert_eq!(terms(&text), expected);
    assert_eq!(terms(&text.replace("ONE, 1", "11, 1")), expected);
    refuses(&text.replace("NSET=RIGHT\n6, 7", "NSET=RIGHT\n6, 7, 12"), "*EQUATION", "RIGHT has 3 nodes, and LEFT");
    refuses(&text.replace("LEFT, 1, 1.", "12, 1, 1."), "*EQUATION", "RIGHT has 2 nodes, and 12, the first, has 1");
    refuses(&text.replace("NSET=RIGHT\n", "NSET=RIGHT, UNSORTED\n"), "*EQUATION", "RIGHT is UNSORTED");
    refuses(&text.replace("RIGHT, 1", "RIHGT, 1"), "*EQUATION", "there is no node set RIHGT");
    refuses(&text.replace("NSET=ONE\n11\n", "NSET=ONE\n"), "*EQUATION", "node set ONE is empty");
}

#[test]
fn terms_of_one_direction_are_joined_and_those_of_zero_left_out() {
    assert_eq!(terms(&equated("3\n5,1,1.,6,1,-1.,5,1,1.\n")), [[(5, 1, 2.0), (6, 1, -1.0)]]);
    assert_eq!(terms(&equated("3\n5,1,1.,6,1,-1.,7,1,0.\n")), [[(5, 1, 1.0), (6, 1, -1.0)]]);
}

#[test]
fn equations_may_hang_in_chains() {
    assert_eq!(terms(&equated("2\n5,1,1.,6,1,-1.\n2\n6,1,1.,7,1,-1.\n2\n7,1,1.,8,1,-1.\n")).len(), 3);
    // Both independent terms lead to the same direction: no circle.
    assert_eq!(terms(&equated("3\n5,1,1.,6,1,-1.,7,1,1.\n2\n6,1,1.,8,1,-1.\n2\n7,1,1.,8,1,-1.\n")).len(), 3);
}

#[test]
fn equations_that_make_no_sense_are_refused() {
    let cases = [
        ("", "the data lines are missing"),
        ("1\n5,1,1.\n", "an equation of 1 terms couples nothing"),
        ("two\n5,1,1.,6,1,-1.\n", "number of terms: two is not a number"),
        ("5,1,1.,6,1,-1.\n", "is not read here"),
        ("3\n5,1,1.,6,1,-1.\n", "the equation has 2 of its 3 terms"),
        ("2\n5,1,1.,6,1,-1.,7,1,1.\n", "3 terms follow, and 2 are announced"),
        ("2\n5,1,1.,6,1\n", "5 items are no whole number of terms"),
        ("2\n5,1,1.,6,4,-1.\n", "direction 4 does not exist"),
        ("2\n5,0,1.,6,1,-1.\n", "direction 0 does not exist"),
        ("2\n5,1,1.,66,1,-1.\n", "node 66 is not defined"),
        ("2\n5,1,0.,6,1,-1.\n", "the coefficient of the first term, direction 1 of node 5, is 0"),
        ("3\n5,1,1.,6,1,-1.,5,1,-1.\n", "the coefficient of the first term, direction 1 of node 5, is 0"),
        ("2\n5,1,1.,5,1,1.\n", "no more than that direction 1 of node 5 is 0"),
        ("2\n5,1,1.,6,1,-1.\n2\n5,1,1.,7,1,-1.\n", "direction 1 of node 5 is the first term of two equations"),
        ("2\n1,1,1.,6,1,-1.\n", "direction 1 of node 1 is the first term and is prescribed"),
        ("2\n15,3,1.,6,1,-1.\n", "direction 3 of node 15 is the first term and is prescribed"),
        ("2\n5,1,1.,6,1,-1.\n2\n6,1,1.,5,1,-1.\n", "in a circle: direction 1 of node 5, direction 1 of node 6"),
        (
            "2\n5,1,1.,6,1,-1.\n2\n6,1,1.,7,1,-1.\n2\n7,1,1.,6,1,-2.\n",
            "in a circle: direction 1 of node 6, direction 1 of node 7",
        ),
    ];
    for (lines, fragment) in cases {
        refuses(&equated(lines), "*EQUATION", fragment);
    }
    refuses(&with("*MATERIAL", "*EQUATION, INPUT=x.inp\n*MATERIAL"), "*EQUATION", "INPUT is not supported");
    refuses(&with("*NODE PRINT", "*EQUATION\n2\n5,1,1.,6,1,-1.\n*NODE PRINT"), "*EQUATION", "within a step");
    refuses(&with("*MATERIAL", "*EQUATION, REMOVE\n5,1\n*MATERIAL"), "*EQUATION", "REMOVE is not supported");
}

#[test]
fn every_fault_of_a_card_is_found_at_once() {
    let found = read(&equated("2\n5,1,1.,66,1,-1.\n2\n6,1,0.,7,1,1.\n2\n1,1,1.,8,1,1.\n")).diagnostics;
    assert_eq!(found.len(), 3, "{}", listing(&found));
}

#[test]
fn a_long_chain_of_equations_is_followed_in_bounded_space() {
    let nodes: String = (100..30_100).map(|n| format!("{n}, 9., 9., {n}.\n")).collect();
    let chain: String = (100..30_099).map(|n| format!("2\n{n},1,1.,{},1,-1.\n", n + 1)).collect();
    let text = equated(&chain).replacen("18, 0., 1., 2.\n", &format!("18, 0., 1., 2.\n{nodes}"), 1);
    assert_eq!(model(&text).equations.len(), 29_999);
    let closed = text.replacen("*EQUATION\n", "*EQUATION\n2\n30099,1,1.,100,1,-1.\n", 1);
    refuses(&closed, "*EQUATION", "in a circle");
}

#[test]
fn nodes_of_equations_serve_a_purpose() {
    let lonely = |text: &str| text.replacen("18, 0., 1., 2.\n", "18, 0., 1., 2.\n99, 0., 0., 9.\n", 1);
    warns(&lonely(BASE), "*NODE", "1 nodes belong to no element, the first is node 99");
    let found = read(&lonely(&equated("2\n5,1,1.,99,1,-1.\n"))).diagnostics;
    assert!(found.is_empty(), "{}", listing(&found));
}
