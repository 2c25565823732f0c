"""Columns and stacked blocks with closed-form answers (B01, B02, B04)."""

import math

import pytest

import support
from verification.catalogue import reference
from verification.columns import LAWS, Block, output_of, stack

# Block of area 2 above a wall block whose nodes are all fixed; contact alone holds the block against its load.
PRESSED_STEP = [
    "*BOUNDARY",
    "BOTTOM_ALL, 1, 3",
    "TOP_ALL, 1, 2",
    "*STEP",
    "*STATIC",
    "0.25, 1.",
    "*DSLOAD",
    "TOP_UP, P, 15.",
    *output_of("TOP_ALL"),
]

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


@pytest.mark.parametrize("young", [500.0, 5e8])
@pytest.mark.parametrize("law", LAWS)
def test_b01_a_block_that_contact_alone_holds_sinks_to_the_overclosure_of_its_load(write_deck, tmp_path, law, young):
    """The case has a rigid block; without lateral strain an elastic one sinks as far, however soft it is."""
    case = reference("B01")
    expected, allowed = case["expected"], case["tolerance"]["value"]
    assert 15.0 * case["inputs"]["A"] == case["inputs"]["F"]
    blocks = {"TOP": Block((0.0, 0.0, 0.0), (1.0, 2.0, 1.0), (2, 2, 2), young), "BOTTOM": COLUMN["BOTTOM"]}
    result = support.run(write_deck(stack(blocks, LAWS[law], PRESSED_STEP)), tmp_path)
    points = result.last("contact")
    assert len(points) == 9
    overclosure = expected[f"h_{law}"]
    for point in points:
        assert support.close(-float(point["COPEN"]), overclosure, allowed, max(overclosure, 0.01))
        assert float(point["CPRESS"]) == pytest.approx(expected["CPRESS"], rel=allowed)
        assert point["status"] == "CL"
    assert float(result.last("history")[0]["CFNM[TOP_DOWN_BOTTOM_UP]"]) == pytest.approx(expected["CFNM"], rel=allowed)
    # The feet sink by the overclosure, the head by what the block yields besides.
    lowest = min(float(row["U3"]) for row in result.last("nodes"))
    assert lowest == pytest.approx(-overclosure - 15.0 / young, rel=allowed, abs=1e-12)
    assert result.summary()["audit"] == []


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


def dead_pressure(case):
    """What drives B04 when contact alone holds the upper block."""
    return ["*DSLOAD", f"TOP_UP, P, {case['inputs']['p']!r}"]


def test_b04_under_dead_pressure_matching_meshes_transmit_it_uniformly(write_deck, tmp_path):
    case = reference("B04")
    expected = case["expected"]
    deck = write_deck(stack(stacked((2, 2, 3), (2, 2, 1)), LINEAR_100, b04_step(dead_pressure(case))))
    result = support.run(deck, tmp_path)
    points = result.last("contact")
    assert len(points) == 9
    for point in points:
        assert float(point["CPRESS"]) == pytest.approx(expected["CPRESS_everywhere"], rel=1e-10)
        assert float(point["COPEN"]) == pytest.approx(expected["COPEN"], rel=1e-10)
    top = sorted(float(row["U3"]) for row in result.last("nodes"))[:9]
    assert top == pytest.approx([-expected["top_displacement_down"]] * 9, rel=1e-10)
    assert float(result.last("history")[0]["RF3[BOTTOM_LOW]"]) == pytest.approx(4.0 * case["inputs"]["p"], rel=1e-10)


def test_b04_under_dead_pressure_nonmatching_meshes_keep_the_resultant(write_deck, tmp_path):
    case = reference("B04")
    deck = write_deck(stack(stacked((3, 3, 3), (2, 2, 2)), LINEAR_100, b04_step(dead_pressure(case))))
    row = support.run(deck, tmp_path).last("history")[0]
    # Dead load: equilibrium alone gives the force, whatever the meshes.
    assert float(row["CFN3[TOP_DOWN_BOTTOM_UP]"]) == pytest.approx(4.0 * case["inputs"]["p"], rel=1e-10)
    assert float(row["RF3[BOTTOM_LOW]"]) == pytest.approx(4.0 * case["inputs"]["p"], rel=1e-10)


def test_b04_under_dead_tension_says_which_body_nothing_holds(write_deck, tmp_path):
    deck = write_deck(stack(stacked((2, 2, 3), (2, 2, 1)), LINEAR_100, b04_step(["*DSLOAD", "TOP_UP, P, -1.5"])))
    done = support.call("run", deck, "--out", tmp_path, "--quiet")
    assert done.returncode in (2, 3)
    assert "ETOP" in done.stderr and "translation along 3" in done.stderr
