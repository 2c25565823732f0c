"""Columns and stacked blocks with closed-form answers (B02, B04)."""

import math

import pytest

import support
from verification.catalogue import reference
from verification.columns import LAWS, Block, output_of, stack

# Column of area 2, length 1 and EA/L = 1000 above a wall block whose nodes are all fixed.
COLUMN = {
    "TOP": Block((0.0, 0.0, 0.0), (1.0, 2.0, 1.0), (1, 1, 1), 500.0),
    "BOTTOM": Block((-0.5, -0.5, -1.0), (1.5, 2.5, 0.0), (1, 1, 1), 1000.0),
}
COLUMN_STEP = [
    "*BOUNDARY",
    "BOTTOM_ALL, 1, 3",
    "TOP_HIGH, 1, 2",
    "*STEP",
    "*STATIC",
    "0.25, 1.",
    "*BOUNDARY",
    "TOP_HIGH, 3, 3, -0.08",
    *output_of("TOP_HIGH"),
]


def solve_column(write_deck, tmp_path, law, *arguments):
    """Overclosure of the points and total force on the column's end."""
    deck = write_deck(stack(COLUMN, LAWS[law], COLUMN_STEP))
    result = support.run(deck, tmp_path, *arguments)
    points = result.last("contact")
    assert len(points) == 4
    return [-float(p["COPEN"]) for p in points], -float(result.last("history")[0]["RF3[TOP_HIGH]"]), result


@pytest.mark.parametrize("law", LAWS)
def test_b02_column_balances_each_law(write_deck, tmp_path, law):
    case = reference("B02")
    expected = case["expected"][law]
    overclosures, force, result = solve_column(write_deck, tmp_path, law)
    assert force == pytest.approx(expected["F"], rel=case["tolerance"]["value"])
    for overclosure in overclosures:
        assert support.close(overclosure, expected["h"], case["tolerance"]["value"], max(expected["h"], 0.01))
    for point in result.last("contact"):
        assert float(point["CPRESS"]) == pytest.approx(expected["F"] / case["inputs"]["A"], rel=1e-10)
        assert point["status"] == "CL"
    step = result.summary()["steps"][0]
    assert step["factorizations"] == 1 and step["cutbacks"] == 0


def test_b02_exponential_means_another_curve_in_the_calculix_dialect(write_deck, tmp_path):
    low, high = 0.0, 0.08
    while high - low > 1e-17:
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        low, high = (middle, high) if 1000.0 * (0.08 - middle) > 2.0 * 5.0 * 100.0 ** (middle / 0.01) else (low, middle)
    overclosures, force, _ = solve_column(write_deck, tmp_path, "exponential", "--dialect", "calculix")
    assert force == pytest.approx(1000.0 * (0.08 - low), rel=1e-10)
    assert overclosures[0] == pytest.approx(low, rel=1e-10)


def stacked(top_divisions, bottom_divisions):
    """The two blocks of B04."""
    return {
        "TOP": Block((0.0, 0.0, 2.0), (2.0, 2.0, 5.0), top_divisions, 200.0),
        "BOTTOM": Block((0.0, 0.0, 0.0), (2.0, 2.0, 2.0), bottom_divisions, 50.0),
    }


def b04_step(drive):
    """Supports of B04, sides free, and what drives it."""
    supports = [f"{name}_{side}, {d}, {d}" for name in ("TOP", "BOTTOM") for side, d in (("X", 1), ("Y", 2))]
    lines = ["*BOUNDARY", "BOTTOM_LOW, 3, 3", *supports, "*STEP", "*STATIC", "1., 1.", *drive]
    return [*lines, *output_of("TOP_HIGH", "BOTTOM_LOW")]


LINEAR_100 = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", "100."]
PUSHED = ["*BOUNDARY", "TOP_HIGH, 3, 3, -0.0975"]


def test_b04_matching_meshes_transmit_a_uniform_pressure(write_deck, tmp_path):
    case = reference("B04")
    inputs, expected = case["inputs"], case["expected"]
    down = (
        inputs["p"] * (inputs["L_top"] / inputs["E_top"] + inputs["L_bottom"] / inputs["E_bottom"])
        + inputs["p"] / inputs["k"]
    )
    assert down == pytest.approx(expected["top_displacement_down"], rel=1e-14)
    deck = write_deck(stack(stacked((2, 2, 3), (2, 2, 1)), LINEAR_100, b04_step(PUSHED)))
    result = support.run(deck, tmp_path)
    points = result.last("contact")
    assert len(points) == 9
    for point in points:
        assert float(point["CPRESS"]) == pytest.approx(expected["CPRESS_everywhere"], rel=1e-10)
        assert float(point["COPEN"]) == pytest.approx(expected["COPEN"], rel=1e-10)
    assert float(result.last("history")[0]["RF3[TOP_HIGH]"]) == pytest.approx(-4.0 * inputs["p"], rel=1e-10)


def test_b04_nonmatching_meshes_keep_the_resultant(write_deck, tmp_path):
    deck = write_deck(stack(stacked((3, 3, 3), (2, 2, 2)), LINEAR_100, b04_step(PUSHED)))
    row = support.run(deck, tmp_path).last("history")[0]
    above, below, contact = (
        float(row[name]) for name in ("RF3[TOP_HIGH]", "RF3[BOTTOM_LOW]", "CFN3[TOP_DOWN_BOTTOM_UP]")
    )
    assert contact == pytest.approx(-above, rel=1e-10)
    assert below == pytest.approx(-above, rel=1e-10)
    # Node-to-surface contact does not pass the patch test on these meshes; its force stays near the uniform one.
    assert math.isclose(contact, 6.0, rel_tol=0.05)
    assert float(row["CAREA[TOP_DOWN_BOTTOM_UP]"]) == pytest.approx(4.0, rel=1e-12)


def test_b04_a_block_held_only_by_contact_is_refused_by_name(write_deck, tmp_path):
    drive = ["*DSLOAD", "TOP_UP, P, 1.5"]
    deck = write_deck(stack(stacked((2, 2, 3), (2, 2, 1)), LINEAR_100, b04_step(drive)))
    done = support.call("run", deck, "--out", tmp_path, "--quiet")
    assert done.returncode == 2
    assert "ETOP" in done.stderr and "contact" in done.stderr
