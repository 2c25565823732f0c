"""No separation (B14 to B16), alone and with rough friction (B24)."""

import csv
import io

import pytest

import support
from verification.columns import Block, output_of, stack
from verification.points import Point, deck, driver, moved, node, rows, step

TIED = ["*SURFACE BEHAVIOR, NO SEPARATION"]
BONDED = [*TIED, "*FRICTION, ROUGH"]
# A second point moves beside the one that does not, so that nothing is small against nothing where paths and frames are compared.
BESIDE = ["*BOUNDARY", f"{node(1)}, 3, 3, -0.01"]


def solve(write_deck, tmp_path, text):
    """Points by increment of a run with a clean audit."""
    result = support.run(write_deck(text), tmp_path)
    assert result.summary()["audit"] == []
    return rows(result), result


def forces(*lines):
    """`*CLOAD` lines `(direction, force)` on the first point."""
    return ["*CLOAD", *(f"{node()}, {direction}, {force!r}" for direction, force in lines)]


@pytest.mark.parametrize("behavior", [TIED, ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD, NO SEPARATION"]])
@pytest.mark.parametrize(("area", "loads"), [(2.0, (10.0, -25.0)), (0.5, (3.0, -1.0, 8.0, -40.0)), (1.0, (7.0, 0.0))])
def test_b14_a_latched_point_carries_tension(write_deck, tmp_path, area, loads, behavior):
    """Nothing but contact holds the point."""
    lines = [line for load in loads for line in step(*forces((3, -load)), *BESIDE)]
    found, _ = solve(write_deck, tmp_path, deck([Point(), Point(clearance=1.0)], behavior, lines, area=area))
    for load, (point, _) in zip(loads, found, strict=True):
        assert point.pressure == pytest.approx(load / area, abs=1e-12)
        assert point.overclosure == pytest.approx(0.0, abs=1e-12)
        assert point.status == "CL"


def test_b14_a_latched_block_hangs_on_its_contact(write_deck, tmp_path):
    """A block of area 2 pushed by a pressure of 5 and pulled by 12.5."""
    blocks = {
        "TOP": Block((0.0, 0.0, 0.0), (1.0, 2.0, 1.0), (2, 2, 2), 700.0),
        "BOTTOM": Block((-0.5, -0.5, -1.0), (1.5, 2.5, 0.0), (1, 1, 1), 1000.0),
    }
    lines = ["*BOUNDARY", "BOTTOM_ALL, 1, 3", "TOP_ALL, 1, 2"]
    for pressure in (5.0, -12.5):
        lines += ["*STEP", "*STATIC", "0.25, 1.", "*DSLOAD", f"TOP_UP, P, {pressure!r}", *output_of("TOP_ALL")]
    found, result = solve(write_deck, tmp_path, stack(blocks, TIED, lines))
    for points, pressure in ((found[-1], -12.5), (found[len(found) // 2 - 1], 5.0)):
        assert len(points) == 9
        for point in points:
            assert point.pressure == pytest.approx(pressure, abs=1e-12 * 25)
            assert point.overclosure == pytest.approx(0.0, abs=1e-12)
            assert point.status == "CL"
    top = [float(row["U3"]) for row in result.last("nodes")]
    assert max(top) == pytest.approx(12.5 / 700.0, rel=1e-11)


@pytest.mark.parametrize(("stiffness", "area"), [(250.0, 2.0), (3.0e4, 0.1)])
@pytest.mark.parametrize("load", [10.0, -25.0, 0.5])
def test_b15_the_explicit_linear_law_balances_both_signs(stiffness, area, load):
    overclosure = load / (area * stiffness)
    words = ["--param", f"stiffness={stiffness!r}", "--param", "separation=prevented", "--param", "procedure=explicit"]
    done = support.call("law", "linear", *words, f"--at={overclosure!r}")
    assert done.returncode == 0, done.stderr
    (row,) = csv.DictReader(io.StringIO(done.stdout))
    assert area * float(row["pressure"]) == pytest.approx(load, rel=1e-12)
    assert float(row["stiffness"]) == stiffness


@pytest.mark.parametrize(("gap", "stiffness", "area"), [(0.05, 400.0, 2.0), (0.003, 1500.0, 0.25)])
def test_b16_a_point_is_open_until_it_first_closes(write_deck, tmp_path, gap, stiffness, area):
    """Driven away, near, onto the wall, away again: only the last is held."""
    path = [-0.5, 0.9, 0.2, 1.4, 0.1, -2.0, 0.5]
    lines = []
    for at in path:
        lines += step("*BOUNDARY", f"{driver()}, 3, 3, {-at * gap!r}")
    found, _ = solve(write_deck, tmp_path, deck([Point(gap, driver=stiffness)], TIED, lines, area=area))
    latched = False
    for at, (point,) in zip(path, found, strict=True):
        latched = latched or at > 1.0
        expected = (at - 1.0) * gap
        if latched:
            assert point.pressure == pytest.approx(stiffness * expected / area, abs=1e-12 * stiffness * gap / area)
            assert point.overclosure == pytest.approx(0.0, abs=1e-12)
            assert point.status == "CL"
        else:
            assert point.pressure == 0.0
            assert point.overclosure == pytest.approx(expected, rel=1e-12)
            assert point.status == "OP"


def test_b16_a_point_that_closes_within_a_step_is_latched_from_there(write_deck, tmp_path):
    """Eight increments to and eight away; the latch closes at the fifth, where the gap is passed."""
    gap, stiffness = 0.01, 100.0
    lines = step("*BOUNDARY", f"{driver()}, 3, 3, {-2.0 * gap * 0.8!r}", increments=8)
    lines += step("*BOUNDARY", f"{driver()}, 3, 3, {2.0 * gap!r}", increments=8)
    found, _ = solve(write_deck, tmp_path, deck([Point(gap, driver=stiffness)], TIED, lines))
    ends = [1.6 * i / 8 for i in range(1, 9)] + [1.6 - 3.6 * i / 8 for i in range(1, 9)]
    latched = False
    for at, (point,) in zip(ends, found, strict=True):
        latched = latched or at > 1.0 + 1e-12
        expected = (at - 1.0) * gap
        assert point.status == ("CL" if latched else "OP")
        assert point.pressure == pytest.approx(stiffness * expected if latched else 0.0, abs=1e-12)
        assert point.overclosure == pytest.approx(0.0 if latched else expected, abs=1e-14)


def test_a_pair_that_is_removed_forgets_its_latch(write_deck, tmp_path):
    """Closed and pulled; removed: free; added again away from the wall: open; closed again: held."""
    gap, stiffness = 0.01, 100.0

    def move(at, *cards):
        return step(*cards, "*BOUNDARY", f"{driver()}, 3, 3, {-at * gap!r}")

    change = "*MODEL CHANGE, TYPE=CONTACT PAIR, {}\nPOINTS, WALL"
    lines = move(1.5) + move(0.5) + move(0.5, change.format("REMOVE")) + move(0.3, change.format("ADD")) + move(2.0)
    lines += move(0.0)
    found, _ = solve(write_deck, tmp_path, deck([Point(gap, driver=stiffness)], TIED, lines))
    expected = [(0.5, True), (-0.5, True), (-0.5, None), (-0.7, False), (1.0, True), (-1.0, True)]
    for (at, closed), points in zip(expected, found, strict=False):
        if closed is None:
            assert all(point.pressure == 0.0 for point in points)
            continue
        (point,) = points
        assert point.status == ("CL" if closed else "OP")
        assert point.pressure == pytest.approx(stiffness * at * gap if closed else 0.0, abs=1e-12)


# Stiffness of the springs, area, and loads (1, 2, 3) of the steps; the first step closes.
BONDS = [
    (100.0, 2.0, [(0.0, 0.0, -10.0), (3.0, -4.0, 25.0), (-6.0, 1.0, 2.0)]),
    (1.0e4, 0.5, [(0.0, 0.0, -1.0), (1.0, 2.0, 0.0), (50.0, -20.0, 7.0)]),
    (0.0, 1.5, [(0.0, 0.0, -4.0), (2.0, 0.7, 9.0)]),
]


@pytest.mark.parametrize(("stiffness", "area", "loads"), BONDS)
def test_b24_rough_and_no_separation_bond_for_any_load(write_deck, tmp_path, stiffness, area, loads):
    """No slip and no opening; tractions are the loads over the area, whatever springs stand beside."""
    pushed = [forces(*zip((1, 2, 3), load, strict=True)) for load in loads]
    lines = [line for load in pushed for line in step(*load, *BESIDE, increments=2)]
    text = deck([Point(spring=stiffness, lateral=stiffness or 1e-3), Point(clearance=1.0)], BONDED, lines, area=area)
    found, result = solve(write_deck, tmp_path, text)
    for load, (point, _), place in zip(loads, found[1::2], moved(result)[1::2], strict=True):
        scale = max(map(abs, load)) / area
        assert point.status == "ST"
        assert point.pressure == pytest.approx(-load[2] / area, abs=1e-12 * scale)
        assert point.overclosure == pytest.approx(0.0, abs=1e-12)
        # Shear has the sign of the slip that it resists: that of the load on the secondary node.
        assert point.shear == pytest.approx((load[0] / area, load[1] / area), abs=1e-12 * scale)
        assert point.slip == pytest.approx((0.0, 0.0), abs=1e-12)
        assert place == pytest.approx([0.0] * 3, abs=1e-12)


@pytest.mark.parametrize("lateral", [50.0, 800.0])
def test_b24_a_point_sticks_where_it_was_when_its_increment_began(write_deck, tmp_path, lateral):
    """It slides freely while open; what it slid before stays, what comes after is resisted."""
    gap, stiffness, area = 0.01, 400.0, 2.0
    point = Point(gap, driver=stiffness, lateral=lateral)
    lines = step(*forces((1, 6.0), (2, -2.0)))
    lines += step("*BOUNDARY", f"{driver()}, 3, 3, {-3.0 * gap!r}")
    lines += step(*forces((1, -4.0), (2, 5.0)), "*BOUNDARY", f"{driver()}, 3, 3, {4.0 * gap!r}")
    found, result = solve(write_deck, tmp_path, deck([point], BONDED, lines, area=area))
    [open_], [closed], [pulled] = found
    places = [place[:2] for place in moved(result)]
    assert (open_.status, closed.status, pulled.status) == ("OP", "ST", "ST")
    for place in places:
        assert place == pytest.approx([6.0 / lateral, -2.0 / lateral], rel=1e-12)
    assert open_.shear == (0.0, 0.0)
    assert closed.shear == pytest.approx((0.0, 0.0), abs=1e-12)
    assert pulled.shear == pytest.approx((-10.0 / area, 7.0 / area), rel=1e-12)
    assert pulled.pressure == pytest.approx(-stiffness * 5.0 * gap / area, rel=1e-12)
    assert pulled.overclosure == pytest.approx(0.0, abs=1e-12)


def test_rough_friction_alone_holds_while_closed_and_lets_go(write_deck, tmp_path):
    """Without NO SEPARATION a point that opens slides to where its springs want it."""
    gap, stiffness, lateral = 0.01, 400.0, 100.0
    point = Point(gap, driver=stiffness, lateral=lateral)
    behavior = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD", "*FRICTION, ROUGH"]
    lines = step("*BOUNDARY", f"{driver()}, 3, 3, {-2.0 * gap!r}")
    lines += step(*forces((1, 6.0)))
    lines += step("*BOUNDARY", f"{driver()}, 3, 3, 0.")
    found, result = solve(write_deck, tmp_path, deck([point], behavior, lines))
    assert [p.status for (p,) in found] == ["ST", "ST", "OP"]
    assert found[1][0].shear == pytest.approx((6.0, 0.0), abs=1e-12)
    assert found[2][0].shear == (0.0, 0.0)
    sideways = [place[0] for place in moved(result)]
    assert sideways == pytest.approx([0.0, 0.0, 6.0 / lateral], abs=1e-13)


def test_friction_may_begin_with_the_increment_after_closing(write_deck, tmp_path):
    """FRICTION ONSET=DELAYED: free sideways in the increment of closing, stuck from the place at its end."""
    gap, stiffness, lateral = 0.01, 400.0, 100.0
    point = Point(gap, driver=stiffness, lateral=lateral)
    card = "*CONTACT CONTROLS, MASTER=WALL, SLAVE=POINTS, FRICTION ONSET=DELAYED"
    lines = step(card, *forces((1, 6.0)), "*BOUNDARY", f"{driver()}, 3, 3, {-2.0 * gap!r}")
    lines += step(*forces((1, -2.0)))
    behavior = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD", "*FRICTION, ROUGH"]
    found, result = solve(write_deck, tmp_path, deck([point], behavior, lines))
    [first], [second] = found
    assert first.shear == pytest.approx((0.0, 0.0), abs=1e-12)
    assert first.pressure == pytest.approx(stiffness * gap, rel=1e-12)
    assert second.status == "ST"
    assert second.shear == pytest.approx((-8.0, 0.0), rel=1e-12, abs=1e-12)
    assert [place[0] for place in moved(result)] == pytest.approx([6.0 / lateral] * 2, rel=1e-12)


def test_friction_may_change_from_step_to_step(write_deck, tmp_path):
    """Frictionless, then rough by *CHANGE FRICTION: sticks from the place at the start of that step; then frictionless again."""
    gap, stiffness, lateral = 0.01, 400.0, 100.0
    point = Point(gap, driver=stiffness, lateral=lateral)
    lines = step(*forces((1, 6.0)), "*BOUNDARY", f"{driver()}, 3, 3, {-2.0 * gap!r}")
    lines += step("*CHANGE FRICTION, INTERACTION=SI", "*FRICTION, ROUGH", *forces((1, 10.0)))
    lines += step("*CHANGE FRICTION, INTERACTION=SI, RESET", *forces((1, -5.0)))
    behavior = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"]
    found, result = solve(write_deck, tmp_path, deck([point], behavior, lines))
    assert [p.status for (p,) in found] == ["CL", "ST", "CL"]
    assert [p.shear[0] for (p,) in found] == pytest.approx([0.0, 4.0, 0.0], abs=1e-11)
    sideways = [place[0] for place in moved(result)]
    assert sideways == pytest.approx([6.0 / lateral, 6.0 / lateral, -5.0 / lateral], rel=1e-12)


def test_a_pair_that_is_removed_lets_go_over_the_step(write_deck, tmp_path):
    """What it carries falls linearly to zero, so that the driven point approaches the place of its driver evenly."""
    gap, stiffness, increments = 0.01, 400.0, 4
    lines = step("*BOUNDARY", f"{driver()}, 3, 3, {-3.0 * gap!r}")
    change = "*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nPOINTS, WALL"
    lines += step(change, increments=increments)
    behavior = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"]
    result = support.run(write_deck(deck([Point(gap, driver=stiffness)], behavior, lines)), tmp_path)
    places = [place[2] for place in moved(result)]
    expected = [-gap - 2.0 * gap * i / increments for i in range(increments + 1)]
    assert places == pytest.approx(expected, rel=1e-12)
