"""Initial conditions: interference that is resolved over a step (B13) and clearances that override the geometry (B28)."""

import pytest

import support
from verification.points import Point, amplitude, deck, driver, moved, node, rows, step

HARD = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"]
LINEAR = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", "750."]
SPRINGS = [(200.0, 0.02), (3000.0, 0.004)]
INCREMENTS = 5


def solve(write_deck, tmp_path, text):
    """Points by increment and displacements of the first node away from the wall."""
    result = support.run(write_deck(text), tmp_path)
    assert result.summary()["audit"] == []
    return rows(result), [place[2] for place in moved(result)]


def interference(*words, data="POINTS, WALL"):
    """`*CONTACT INTERFERENCE` of the pair."""
    return [", ".join(["*CONTACT INTERFERENCE", *words]), data]


def pressed_out(spring, overclosure, area, stiffness):
    """Displacement and pressure of a point on a spring with this overclosure left to resolve; hard if `stiffness` is none."""
    if overclosure <= 0.0:
        return 0.0, 0.0
    share = 1.0 if stiffness is None else area * stiffness / (spring + area * stiffness)
    return overclosure * share, spring * overclosure * share / area


@pytest.mark.parametrize("behavior", [HARD, LINEAR], ids=["hard", "linear"])
@pytest.mark.parametrize(("spring", "depth"), SPRINGS)
def test_b13_shrink_resolves_the_initial_overclosure_over_the_step(write_deck, tmp_path, behavior, spring, depth):
    """What is allowed falls linearly from the overclosure itself to zero, for each point its own."""
    area, depths = 1.4, [depth, 0.25 * depth, -0.5 * depth]
    points = [Point(clearance=-d, spring=spring) for d in depths]
    lines = step(*interference("SHRINK"), increments=INCREMENTS) + step()
    found, _ = solve(write_deck, tmp_path, deck(points, behavior, lines, area=area))
    stiffness = 750.0 if behavior is LINEAR else None
    for number, increment in enumerate(found, 1):
        part = min(1.0, number / INCREMENTS)
        for own, point in zip(depths, increment, strict=True):
            shift, pressure = pressed_out(spring, part * own, area, stiffness)
            assert point.pressure == pytest.approx(pressure, rel=1e-11, abs=1e-12)
            assert point.status == ("CL" if own > 0.0 else "OP")
            assert shift == pytest.approx(area * point.pressure / spring, rel=1e-11, abs=1e-14)


def test_b13_shrink_ignores_an_amplitude(write_deck, tmp_path):
    spring, depth = 200.0, 0.02
    lines = step(*interference("SHRINK", "AMPLITUDE=FLAT"), increments=INCREMENTS)
    text = deck([Point(clearance=-depth, spring=spring)], HARD, lines, model=amplitude("FLAT", [1.0, 1.0]))
    found, _ = solve(write_deck, tmp_path, text)
    pressures = [increment[0].pressure for increment in found]
    assert pressures == pytest.approx([spring * depth * i / INCREMENTS for i in range(1, INCREMENTS + 1)], rel=1e-11)


@pytest.mark.parametrize("factor", [0.4, 1.0, 2.5])
@pytest.mark.parametrize(("spring", "depth"), SPRINGS)
def test_b13_an_allowed_interference_acts_at_once_and_ramps_to_zero(write_deck, tmp_path, spring, depth, factor):
    """`h_eff = h - v (1 - t)`: less than the overclosure allowed, the rest is resolved at once; more, nothing until it is used up."""
    lines = step(*interference(data=f"POINTS, WALL, {factor * depth!r}"), increments=INCREMENTS) + step()
    found, motion = solve(write_deck, tmp_path, deck([Point(clearance=-depth, spring=spring)], HARD, lines))
    for number, ((point,), u) in enumerate(zip(found, motion, strict=True), 1):
        left = depth - factor * depth * max(0.0, 1.0 - number / INCREMENTS)
        expected, pressure = pressed_out(spring, left, 1.0, None)
        assert u == pytest.approx(expected, rel=1e-11, abs=1e-14)
        assert point.pressure == pytest.approx(pressure, rel=1e-11, abs=1e-11)
        if abs(left) > 1e-12:
            assert point.status == ("CL" if left > 0.0 else "OP")


def test_b13_an_amplitude_scales_the_allowed_interference(write_deck, tmp_path):
    """Allowed 0.5 v, v, 0.25 v, 0, 0; from step to step the last value stays."""
    spring, depth, allowed = 200.0, 0.02, 0.016
    values = [0.5, 1.0, 0.25, 0.0, 0.5]
    card = interference("AMPLITUDE=WAVE", data=f"POINTS, WALL, {allowed!r}")
    lines = step(*card, increments=INCREMENTS) + step()
    text = deck([Point(clearance=-depth, spring=spring)], HARD, lines, model=amplitude("WAVE", [0.0, *values]))
    found, motion = solve(write_deck, tmp_path, text)
    for value, (point,), u in zip([*values, values[-1]], found, motion, strict=True):
        left = depth - value * allowed
        assert u == pytest.approx(left, rel=1e-11)
        assert point.pressure == pytest.approx(spring * left, rel=1e-11)


def test_b13_without_interference_the_overclosure_is_resolved_at_once(write_deck, tmp_path):
    spring, depth = 200.0, 0.02
    found, motion = solve(
        write_deck, tmp_path, deck([Point(clearance=-depth, spring=spring)], HARD, step(increments=INCREMENTS))
    )
    assert motion == pytest.approx([depth] * INCREMENTS, rel=1e-12)
    assert [p.pressure for (p,) in found] == pytest.approx([spring * depth] * INCREMENTS, rel=1e-12)


PLACES = [0.3, 0.0, -0.01]


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("clearance", [0.01, 0.0005, -0.006, 0.0])
def test_b28_a_uniform_clearance_overrides_the_geometry(write_deck, tmp_path, place, clearance):
    """A point anywhere touches after its prescribed clearance; negative, it is pressed out at once. Coordinates stay."""
    stiffness, push = 500.0, 0.02
    model = [f"*CLEARANCE, MASTER=WALL, SLAVE=POINTS, VALUE={clearance!r}"]
    lines = step("*BOUNDARY", f"{driver()}, 3, 3, {-push!r}", increments=4)
    text = deck([Point(clearance=place, driver=stiffness)], HARD, lines, model=model)
    found, motion = solve(write_deck, tmp_path, text)
    for number, ((point,), u) in enumerate(zip(found, motion, strict=True), 1):
        at = push * number / 4 - clearance
        assert u == pytest.approx(-min(push * number / 4, clearance), rel=1e-11, abs=1e-13)
        assert point.pressure == pytest.approx(stiffness * max(0.0, at), rel=1e-11, abs=1e-11)
        assert point.overclosure == pytest.approx(min(0.0, at), abs=1e-13)
        if abs(at) > 1e-9:
            assert point.status == ("CL" if at > 0.0 else "OP")


def test_b28_clearances_by_node_and_by_set(write_deck, tmp_path):
    stiffness, push = 500.0, 0.02
    clearances = [0.004, 0.018, 0.018, -0.003]
    model = ["*NSET, NSET=MIDDLE", f"{node(1)}, {node(2)}", "*CLEARANCE, MASTER=WALL, SLAVE=POINTS, TABULAR"]
    model += [f"{node(0)}, 0.004", "MIDDLE, 0.018", f"{node(3)}, -0.003"]
    points = [Point(clearance=0.1, driver=stiffness) for _ in clearances]
    lines = step("*BOUNDARY", f"DRIVERS, 3, 3, {-push!r}")
    found, _ = solve(write_deck, tmp_path, deck(points, HARD, lines, model=model))
    assert [p.pressure for p in found[0]] == pytest.approx([stiffness * (push - c) for c in clearances], rel=1e-11)


def test_b28_a_clearance_is_measured_by_a_softened_law(write_deck, tmp_path):
    stiffness, push, clearance = 500.0, 0.02, 0.005
    model = [f"*CLEARANCE, MASTER=WALL, SLAVE=POINTS, VALUE={clearance!r}"]
    lines = step("*BOUNDARY", f"{driver()}, 3, 3, {-push!r}")
    found, _ = solve(write_deck, tmp_path, deck([Point(0.2, driver=stiffness)], LINEAR, lines, model=model))
    [[point]] = found
    overclosure = stiffness * (push - clearance) / (stiffness + 750.0)
    assert point.overclosure == pytest.approx(overclosure, rel=1e-11)
    assert point.pressure == pytest.approx(750.0 * overclosure, rel=1e-11)
