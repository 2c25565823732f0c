//! The solver shall reproduce the closed-form values of the law cases in `tests/data/cases.json` within the tolerance that
//! each case states; an expected zero is compared absolutely, against the tolerance times the largest value of the case.

use serde_json::Value;

use super::*;

fn case(id: &str) -> Value {
    let text = include_str!("../../../../tests/data/cases.json");
    let all: Value = serde_json::from_str(text).unwrap();
    let cases = all["cases"].as_array().unwrap();
    cases.iter().find(|c| c["id"] == id).unwrap_or_else(|| panic!("no case {id}")).clone()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is not a number"))
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap_or_else(|| panic!("{value} is not a list")).iter().map(number).collect()
}

fn table(case: &Value) -> Tabular {
    let points: Vec<(f64, f64)> =
        case["inputs"]["pairs_p_h"].as_array().unwrap().iter().map(|p| (number(&p[0]), number(&p[1]))).collect();
    Tabular::new(&points).unwrap()
}

fn exponential(case: &Value) -> Exponential {
    let inputs = &case["inputs"];
    let stiffness_max = inputs.get("Kmax").map(number);
    Exponential::build(number(&inputs["c0"]), number(&inputs["p0"]), stiffness_max).unwrap()
}

/// Compares the listed quantities at the listed overclosures.
fn compare(case: &Value, law: &dyn PressureLaw) {
    let tolerance = number(&case["tolerance"]["value"]);
    let overclosures = numbers(&case["inputs"]["h"]);
    let mut compared = 0;
    for (name, value) in
        [("p", (|p: LawPoint| p.pressure) as fn(LawPoint) -> f64), ("dpdh", |p| p.stiffness), ("U", |p| p.energy)]
    {
        let Some(expected) = case["expected"].get(name).map(numbers) else {
            continue;
        };
        assert_eq!(expected.len(), overclosures.len());
        let largest = expected.iter().fold(0.0f64, |m, e| m.max(e.abs()));
        for (&h, &expected) in overclosures.iter().zip(&expected) {
            let actual = value(law.evaluate(h));
            let allowed = tolerance * if expected == 0.0 { largest } else { expected.abs() };
            assert!(
                (actual - expected).abs() <= allowed,
                "{}: {name}({h}) = {actual}, expected {expected}",
                case["id"]
            );
            compared += 1;
        }
    }
    assert!(compared >= overclosures.len(), "{}: nothing compared", case["id"]);
}

fn assert_relative(case: &Value, actual: f64, expected: &Value) {
    let (expected, tolerance) = (number(expected), number(&case["tolerance"]["value"]));
    assert!((actual - expected).abs() <= tolerance * expected.abs(), "{}: {actual}, expected {expected}", case["id"]);
}

#[test]
fn a01_exponential_at_its_defining_points() {
    let case = case("A01");
    let (law, expected) = (exponential(&case), &case["expected"]);
    assert_eq!(law.evaluate(-0.01), LawPoint::default());
    assert_relative(&case, law.evaluate(0.0).pressure, &expected["p(h=0)"]);
    assert_relative(&case, law.evaluate(0.0).stiffness, &expected["dpdh(h=0)"]);
    assert_relative(&case, law.evaluate(0.0).energy, &expected["U(h=0)"]);
}

#[test]
fn a02_exponential_over_its_curved_range() {
    let case = case("A02");
    compare(&case, &exponential(&case));
}

#[test]
fn a04_exponential_goes_on_straight() {
    let case = case("A04");
    let law = exponential(&case);
    assert_relative(&case, law.continuation_start(), &case["inputs"]["h_lin"]);
    compare(&case, &law);
}

#[test]
fn a05_exponential_with_a_stiffness_limit() {
    let case = case("A05");
    let (law, expected) = (exponential(&case), &case["expected"]);
    assert_relative(&case, law.continuation_start(), &expected["h_star"]);
    assert_relative(&case, law.evaluate(law.continuation_start()).pressure, &expected["p_star"]);
    compare(&case, &law);
}

#[test]
fn a08_linear() {
    let case = case("A08");
    compare(&case, &Linear::new(number(&case["inputs"]["k"])).unwrap());
}

#[test]
fn a09_tabular() {
    let case = case("A09");
    let law = table(&case);
    compare(&case, &law);
    let slopes = numbers(&case["expected"]["dpdh_right_of_vertex_not_tested_at_vertices"]);
    for (h, expected) in [0.005, 0.015, 0.025, 0.05].into_iter().zip(slopes) {
        check::assert_close(law.evaluate(h).stiffness, expected, 1e-12, 0.0);
    }
}

#[test]
fn a10_tabular_that_starts_at_a_clearance() {
    let case = case("A10");
    compare(&case, &table(&case));
}

#[test]
fn a12_linear_without_separation() {
    let case = case("A12");
    let law = LawParameters::Linear { stiffness: number(&case["inputs"]["k"]) }.into();
    compare(&case, &ResolvedLaw::new(&law, Separation::Prevented, LawProcedure::Explicit).unwrap());
}
