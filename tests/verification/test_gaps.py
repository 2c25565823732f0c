"""GAP elements (B06, B07) and the dimension of a law: pressure, force, or force per length (B08)."""

import itertools

import pytest

import support
from verification.points import node, point, springs

TABLE = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR", "0., 0.", "2., 0.01", "10., 0.02", "40., 0.03"]
HARD = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"]


def gap_deck(kind, data, behavior, steps, *, first=(0.0, 0.0, 0.0), second=(1.0, 0.0, 0.0), spring=400.0, axis=1):
    """Node 11 on a spring along an axis, node 12 fixed, a GAP element from 11 to 12."""
    sideways = [d for d in (1, 2, 3) if d != axis]
    lines = ["*HEADING", "a gap", "*NODE, NSET=POINTS", f"11, {first[0]!r}, {first[1]!r}, {first[2]!r}"]
    lines += ["*NODE, NSET=FIXED", f"12, {second[0]!r}, {second[1]!r}, {second[2]!r}"]
    lines += springs(101, "SPRING1", [node()], [axis], spring) if spring else []
    lines += [f"*ELEMENT, TYPE={kind}, ELSET=GAPS", "201, 11, 12", "*GAP, ELSET=GAPS", data, *behavior]
    lines += ["*BOUNDARY", "FIXED, 1, 3", *(f"11, {d}, {d}" for d in sideways), *steps]
    return "\n".join(lines) + "\n"


def load(force, direction=1):
    """A step with a dead force on node 11."""
    lines = ["*STEP", "*STATIC, DIRECT", "1., 1.", "*CLOAD", f"11, {direction}, {force!r}"]
    return [*lines, "*NODE PRINT, NSET=POINTS", "U, RF", "*CONTACT PRINT", "CSTR, CDIS", "*END STEP"]


def solve(write_deck, tmp_path, text, number=0):
    """Row of the gap and the displacement of its node at the end of each step."""
    result = support.run(write_deck(text, f"deck{number}.inp"), tmp_path / str(number))
    assert result.summary()["audit"] == []
    moved = [[float(row[f"U{d}"]) for d in (1, 2, 3)] for row in result.table("nodes") if row["node"] == "11"]
    return [point(row) for row in result.table("contact")], moved


@pytest.mark.parametrize("normal", ["1., 0., 0.", "", "2.5, 0., 0."])
@pytest.mark.parametrize(("spring", "distance"), [(400.0, 0.05), (75.0, 0.2)])
def test_b06_a_hard_gap_closes_at_its_distance(write_deck, tmp_path, spring, distance, normal):
    """`u = min(F / K, d)`, gap force `F - K d`; at `F = K d` it just touches and may be told as either."""
    forces = [0.5 * spring * distance, spring * distance, 2.5 * spring * distance]
    steps = [line for force in forces for line in load(force)]
    found, moved = solve(
        write_deck, tmp_path, gap_deck("GAPUNI", f"{distance!r}, {normal}".strip(", "), HARD, steps, spring=spring)
    )
    for force, row, displacement in zip(forces, found, moved, strict=True):
        expected = min(force / spring, distance)
        assert displacement[0] == pytest.approx(expected, abs=1e-12)
        assert row.pressure == pytest.approx(max(0.0, force - spring * distance), abs=1e-12 * spring)
        assert row.overclosure == pytest.approx(expected - distance, abs=1e-12)
    assert [found[0].status, found[2].status] == ["OP", "CL"]
    assert found[1].status in ("OP", "CL")


def test_b06_a_negative_distance_is_an_overclosure_at_the_start(write_deck, tmp_path):
    found, moved = solve(write_deck, tmp_path, gap_deck("GAPUNI", "-0.02, 1., 0., 0.", HARD, load(0.0)))
    assert moved[0][0] == pytest.approx(-0.02, rel=1e-12)
    assert found[0].pressure == pytest.approx(8.0, rel=1e-12)


def test_b06_the_normal_is_that_of_the_data_line_not_of_the_nodes(write_deck, tmp_path):
    """Nodes one above the other, contact along x."""
    text = gap_deck("GAPUNI", "0.05, 1., 0., 0.", HARD, load(50.0), second=(0.0, 0.0, 1.0))
    found, moved = solve(write_deck, tmp_path, text)
    assert moved[0][0] == pytest.approx(0.05, abs=1e-12)
    assert found[0].pressure == pytest.approx(30.0, rel=1e-12)


def table_root(spring, force, distance, area):
    """Displacement with `K u + area p(u - d) = F` on the table of A09."""
    points = [(0.0, 0.0), (2.0, 0.01), (10.0, 0.02), (40.0, 0.03)]
    low, high = 0.0, force / spring
    while (middle := 0.5 * (low + high)) not in (low, high):
        low, high = (
            (middle, high)
            if spring * middle + area * interpolate(points, middle - distance) < force
            else (
                low,
                middle,
            )
        )
    return low


def interpolate(points, h):
    """Pressure of a table; the last slope goes on."""
    if h <= points[0][1]:
        return 0.0
    for (p0, h0), (p1, h1) in itertools.pairwise(points):
        if h <= h1 or (p1, h1) == points[-1]:
            return p0 + (p1 - p0) * (h - h0) / (h1 - h0)
    raise ValueError(h)


@pytest.mark.parametrize("area", [None, 0.25, 3.0])
@pytest.mark.parametrize(
    ("spring", "distance", "force"), [(400.0, 0.05, 30.0), (90.0, 0.0, 4.0), (1500.0, 0.01, 200.0)]
)
def test_b07_a_gap_follows_a_force_law(write_deck, tmp_path, spring, distance, force, area):
    """Without an area the law is a force, with one a pressure."""
    data = f"{distance!r}, 1., 0., 0." + (f", {area!r}" if area else "")
    found, moved = solve(write_deck, tmp_path, gap_deck("GAPUNI", data, TABLE, load(force), spring=spring))
    u = table_root(spring, force, distance, area or 1.0)
    assert moved[0][0] == pytest.approx(u, rel=1e-11)
    assert found[0].overclosure == pytest.approx(u - distance, rel=1e-10, abs=1e-14)
    assert found[0].pressure == pytest.approx((force - spring * u) / (area or 1.0), rel=1e-10)


@pytest.mark.parametrize("law", ["linear", "exponential"])
def test_b07_other_force_laws(write_deck, tmp_path, law):
    """A dead force on a node that only the gap holds: the law is inverted."""
    behavior = {
        "linear": ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", "250."],
        "exponential": ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=EXPONENTIAL", "0.01, 5."],
    }[law]
    overclosure = {"linear": 0.06, "exponential": 0.00493332585729293}[law]
    found, moved = solve(write_deck, tmp_path, gap_deck("GAPUNI", "0.03, 1., 0., 0.", behavior, load(15.0), spring=0.0))
    assert moved[0][0] == pytest.approx(0.03 + overclosure, rel=1e-10)
    assert found[0].pressure == pytest.approx(15.0, rel=1e-12)


@pytest.mark.parametrize("distance", [0.7, -0.7])
def test_b06_gapspher_limits_the_distance_of_its_nodes(write_deck, tmp_path, distance):
    """`d > 0`: largest distance, `d < 0`: smallest; nodes 0.6 or 0.8 apart, pushed past it by 0.05."""
    apart = 0.6 if distance > 0 else 0.8
    direction = -1.0 if distance > 0 else 1.0
    text = gap_deck("GAPSPHER", f"{distance!r}", HARD, load(direction * 60.0), second=(apart, 0.0, 0.0))
    found, moved = solve(write_deck, tmp_path, text)
    assert moved[0][0] == pytest.approx(direction * 0.1, abs=1e-12)
    assert found[0].pressure == pytest.approx(20.0, rel=1e-11)


@pytest.mark.parametrize("distance", [0.7, -0.7])
def test_b06_gapcyl_limits_the_distance_normal_to_its_axis(write_deck, tmp_path, distance):
    """As the sphere, but what the nodes are apart along the axis does not count."""
    apart = 0.6 if distance > 0 else 0.8
    direction = -1.0 if distance > 0 else 1.0
    text = gap_deck("GAPCYL", f"{distance!r}, 0., 0., 1.", HARD, load(direction * 60.0), second=(apart, 0.0, 5.0))
    found, moved = solve(write_deck, tmp_path, text)
    assert moved[0][0] == pytest.approx(direction * 0.1, abs=1e-12)
    assert found[0].pressure == pytest.approx(20.0, rel=1e-11)


@pytest.mark.parametrize(("overclosure", "value"), [(0.015, 6.0), (0.005, 1.0), (0.05, 100.0)])
def test_b08_a_table_is_a_force_without_an_area_and_a_pressure_with_one(write_deck, tmp_path, overclosure, value):
    """Node 11 is pushed to an overclosure of the gap by prescribed motion; the force is the reaction."""
    for number, (area, factor) in enumerate([(None, 1.0), (1.0, 1.0), (0.25, 0.25)]):
        data = "0.01, 1., 0., 0." + (f", {area!r}" if area else "")
        steps = ["*STEP", "*STATIC, DIRECT", "1., 1.", "*BOUNDARY", f"11, 1, 1, {0.01 + overclosure!r}"]
        steps += ["*NODE PRINT, NSET=POINTS", "U, RF", "*CONTACT PRINT", "CSTR, CDIS", "*END STEP"]
        text = gap_deck("GAPUNI", data, TABLE, steps, spring=0.0)
        result = support.run(write_deck(text, f"deck{number}.inp"), tmp_path / str(number))
        assert float(result.last("nodes")[0]["RF1"]) == pytest.approx(factor * value, rel=1e-12)
        assert point(result.last("contact")[0]).pressure == pytest.approx(value, rel=1e-12)
