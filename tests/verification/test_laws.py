"""Laws through `overclosure law`, against closed forms."""

import csv
import io

import pytest

import support
from verification.catalogue import reference

COLUMNS = {"p": "pressure", "dpdh": "stiffness", "U": "energy"}


def evaluate(kind, parameters, overclosures):
    """Rows of `overclosure law` as numbers."""
    arguments = [word for name, value in parameters.items() for word in ("--param", f"{name}={value}")]
    done = support.call("law", kind, *arguments, "--at=" + ",".join(repr(float(h)) for h in overclosures))
    assert done.returncode == 0, done.stderr
    rows = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(io.StringIO(done.stdout))]
    assert [row["overclosure"] for row in rows] == list(overclosures)
    assert set(rows[0]) == {"overclosure", "pressure", "stiffness", "energy"}
    return rows


def check(case, kind, parameters, overclosures, expected):
    """Compares every expected list; an expected zero is compared against the largest value of its list."""
    rows = evaluate(kind, parameters, overclosures)
    tolerance = case["tolerance"]["value"]
    for name, values in expected.items():
        scale = max(abs(v) for v in values)
        for row, value in zip(rows, values, strict=True):
            actual = row[COLUMNS[name]]
            assert support.close(actual, value, tolerance, scale if value == 0 else None), (name, row, value)


def lists(case):
    """The expected lists that have one value per overclosure."""
    return {k: v for k, v in case["expected"].items() if k in COLUMNS}


def table(pairs):
    """The value of the `table` parameter."""
    return ",".join(f"{p}:{h}" for p, h in pairs)


def test_a01_exponential_law_has_its_defining_points():
    case = reference("A01")
    inputs, expected = case["inputs"], case["expected"]
    check(
        case,
        "exponential",
        {"clearance_at_zero_pressure": inputs["c0"], "pressure_at_zero_clearance": inputs["p0"]},
        [-inputs["c0"], 0.0],
        {
            "p": [expected["p(h=-c0)"], expected["p(h=0)"]],
            "dpdh": [expected["dpdh(h=-c0)"], expected["dpdh(h=0)"]],
            "U": [0.0, expected["U(h=0)"]],
        },
    )


@pytest.mark.parametrize("name", ["A02", "A04"])
def test_exponential_law_follows_its_curve_and_its_tangent(name):
    case = reference(name)
    inputs = case["inputs"]
    check(case, "exponential", {"c0": inputs["c0"], "p0": inputs["p0"]}, inputs["h"], lists(case))


def test_a05_explicit_exponential_law_is_limited_in_slope():
    case = reference("A05")
    inputs = case["inputs"]
    parameters = {"c0": inputs["c0"], "p0": inputs["p0"], "kmax": inputs["Kmax"], "procedure": "explicit"}
    check(case, "exponential", parameters, inputs["h"], lists(case))
    switch = case["expected"]["h_star"]
    before, after = evaluate("exponential", parameters, [switch * (1 - 1e-9), switch * (1 + 1e-9)])
    assert before["stiffness"] < after["stiffness"] == inputs["Kmax"]


def test_a08_linear_law_is_exact():
    case = reference("A08")
    check(case, "linear", {"stiffness": case["inputs"]["k"]}, case["inputs"]["h"], lists(case))


@pytest.mark.parametrize("name", ["A09", "A10"])
def test_tabular_law_interpolates_and_extrapolates(name):
    case = reference(name)
    inputs = case["inputs"]
    check(case, "tabular", {"table": table(inputs["pairs_p_h"])}, inputs["h"], lists(case))


def test_a09_tabular_slopes_between_the_vertices():
    case = reference("A09")
    slopes = case["expected"]["dpdh_right_of_vertex_not_tested_at_vertices"]
    check(case, "tabular", {"table": table(case["inputs"]["pairs_p_h"])}, [0.005, 0.015, 0.025, 0.05], {"dpdh": slopes})


def test_a12_linear_law_pulls_when_separation_is_prevented():
    case = reference("A12")
    parameters = {"stiffness": case["inputs"]["k"], "separation": "prevented", "procedure": "explicit"}
    check(case, "linear", parameters, case["inputs"]["h"], lists(case))


def test_a_range_counts_both_ends():
    done = support.call("law", "linear", "--param", "stiffness=2", "--at=-1:1:0.5")
    assert done.returncode == 0, done.stderr
    rows = list(csv.DictReader(io.StringIO(done.stdout)))
    assert [float(r["overclosure"]) for r in rows] == [-1.0, -0.5, 0.0, 0.5, 1.0]
    assert [float(r["pressure"]) for r in rows] == [0.0, 0.0, 0.0, 1.0, 2.0]
