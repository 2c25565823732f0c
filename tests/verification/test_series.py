"""Columns in series through each law (B03), and laws inverted by dead loads (A07)."""

import itertools
from decimal import Decimal, getcontext

import pytest

import support
from verification.columns import LAWS, Block, output_of, stack
from verification.points import Point, deck, node, rows, step

TABLE = [(0.0, 0.0), (2.0, 0.01), (10.0, 0.02), (40.0, 0.03)]
C0, P0 = 0.01, 5.0


def exponential(h, clearance=C0, pressure=P0):
    """Pressure of the exponential law of Abaqus/Standard: a straight line beyond six times the clearance."""
    getcontext().prec = 40
    u = 1 + Decimal(h) / Decimal(clearance)
    scale = Decimal(pressure) / (Decimal(1).exp() - 1)
    if u <= 0:
        return 0.0
    if u <= 7:
        return float(scale * u * (u.exp() - 1))
    seven = Decimal(7)
    return float(scale * (seven * (seven.exp() - 1) + (8 * seven.exp() - 1) * (u - 7)))


def tabular(h):
    """Pressure of the table."""
    if h <= 0.0:
        return 0.0
    for (p0, h0), (p1, h1) in itertools.pairwise(TABLE):
        if h <= h1 or h1 == TABLE[-1][1]:
            return p0 + (p1 - p0) * (h - h0) / (h1 - h0)
    raise ValueError(h)


PRESSURES = {
    "linear": lambda h: 250.0 * max(h, 0.0),
    "exponential": exponential,
    "tabular": tabular,
    "hard": None,
}


def balance(push, gap, compliance, pressure):
    """Overclosure and pressure: `push - gap - h = C p(h)`, by bisection; a hard law leaves no overclosure."""
    if pressure is None:
        return min(0.0, push - gap), max(0.0, push - gap) / compliance
    low, high = -1.0, 1.0
    while (middle := 0.5 * (low + high)) not in (low, high):
        low, high = (middle, high) if push - gap - middle > compliance * pressure(middle) else (low, middle)
    return low, (push - gap - low) / compliance


# Push, gap, Young's moduli and lengths above and below.
SERIES = [
    (0.08, 0.0, (500.0, 1.0), (1000.0, 1.0)),
    (0.08, 0.013, (120.0, 2.0), (75.0, 0.5)),
    (0.0225, 0.006, (500.0, 1.0), (400.0, 3.0)),
    (0.3, 0.0, (9000.0, 1.5), (20000.0, 1.0)),
    (0.05, -0.02, (60.0, 1.0), (90.0, 1.0)),
]


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("push", "gap", "above", "below"), SERIES)
def test_b03_two_columns_in_series_with_a_gap(write_deck, tmp_path, law, push, gap, above, below):
    (young_above, length_above), (young_below, length_below) = above, below
    blocks = {
        "TOP": Block((0.0, 0.0, gap), (1.0, 2.0, gap + length_above), (2, 2, 2), young_above),
        "BOTTOM": Block((0.0, 0.0, -length_below), (1.0, 2.0, 0.0), (2, 2, 2), young_below),
    }
    lines = ["*BOUNDARY", "BOTTOM_LOW, 1, 3", "TOP_HIGH, 1, 2", "*STEP", "*STATIC", "0.25, 1.", "*BOUNDARY"]
    lines += [f"TOP_HIGH, 3, 3, {-push!r}", *output_of("TOP_HIGH")]
    result = support.run(write_deck(stack(blocks, LAWS[law], lines)), tmp_path)
    compliance = length_above / young_above + length_below / young_below
    overclosure, pressure = balance(push, gap, compliance, PRESSURES[law])
    for point in rows(result)[-1]:
        assert point.pressure == pytest.approx(pressure, rel=1e-10, abs=1e-12)
        assert point.overclosure == pytest.approx(overclosure, rel=1e-10, abs=1e-10 * C0)
        assert point.status == ("CL" if pressure > 1e-9 else "OP")
    force = float(result.last("history")[0]["RF3[TOP_HIGH]"])
    assert force == pytest.approx(-2.0 * pressure, rel=1e-10, abs=1e-11)
    assert result.summary()["audit"] == []


# Parts of p0, from the take-off to far beyond the straight continuation.
PARTS = [1e-12, 1e-6, 1e-3, 0.1, 0.9999, 1.0, 7.0, 7.4, 400.0, 4462.0, 4464.0, 1e5, 1e9]


@pytest.mark.parametrize(("clearance", "pressure"), [(0.01, 5.0), (2.0e-4, 900.0)])
def test_a07_a_dead_load_inverts_the_exponential_law(write_deck, tmp_path, clearance, pressure):
    """`u = 1 + h / c0` solves `u (e^u - 1) = (e - 1) p / p0`, to 1e-10 of itself; then the straight part."""
    behavior = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=EXPONENTIAL", f"{clearance!r}, {pressure!r}"]
    for number, part in enumerate(PARTS):
        text = deck([Point(spring=0.0)], behavior, step("*CLOAD", f"{node()}, 3, {-part * pressure!r}"))
        [[point]] = rows(support.run(write_deck(text, f"{number}.inp"), tmp_path / str(number)))
        assert point.pressure == pytest.approx(part * pressure, rel=1e-10)
        u = 1.0 + point.overclosure / clearance
        assert u == pytest.approx(inverse(part), rel=1e-10, abs=1e-14), part


def inverse(part):
    """Solution of `u (e^u - 1) = (e - 1) part` to 40 digits, by bisection; beyond u = 7 that of the tangent there."""
    getcontext().prec = 40
    wanted = (Decimal(1).exp() - 1) * Decimal(part)
    seven = Decimal(7)
    top = seven * (seven.exp() - 1)
    if wanted > top:
        return float(seven + (wanted - top) / (8 * seven.exp() - 1))
    low, high = Decimal(0), seven
    for _ in range(140):
        middle = (low + high) / 2
        low, high = (middle, high) if middle * (middle.exp() - 1) < wanted else (low, middle)
    return float(low)


@pytest.mark.parametrize("exponent", [2, 4, 6])
def test_a_law_far_stiffer_than_what_is_underneath_gives_the_same_answer(write_deck, tmp_path, exponent):
    """Beyond a thousand times the underlying stiffness the law is solved in its mixed form; the root is the same."""
    young, push = 500.0, 0.02
    slope = young * 10.0**exponent
    blocks = {
        "TOP": Block((0.0, 0.0, 0.0), (1.0, 1.0, 1.0), (1, 1, 1), young),
        "BOTTOM": Block((-0.5, -0.5, -1.0), (1.5, 1.5, 0.0), (1, 1, 1), 1000.0),
    }
    lines = ["*BOUNDARY", "BOTTOM_ALL, 1, 3", "TOP_HIGH, 1, 2", "*STEP", "*STATIC", "0.5, 1.", "*BOUNDARY"]
    lines += [f"TOP_HIGH, 3, 3, {-push!r}", *output_of("TOP_HIGH")]
    behavior = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", repr(slope)]
    for point in rows(support.run(write_deck(stack(blocks, behavior, lines)), tmp_path))[-1]:
        assert point.pressure == pytest.approx(push * young * slope / (young + slope), rel=1e-10)
        assert point.overclosure == pytest.approx(push * young / (young + slope), rel=1e-9, abs=1e-14 * push)
