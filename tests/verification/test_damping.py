"""Contact damping in statics (A14, A15): the coefficient over the clearance, and what it does to points."""

import math

import pytest

import support
from verification.points import PAIR, Point, controls, deck, driver, node, rows, step

HARD = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"]
# mu0, c0, eta.
CURVES = [(8.0, 0.1, 0.4), (0.3, 2.0, 0.0), (1.0e4, 0.005, 0.9)]
CLEARANCES = [-0.01, 0.0, 0.02, 0.04, 0.06, 0.08, 0.1, 0.2]
PUBLISHED = [8.0, 8.0, 8.0, 8.0, 5.333333333333335, 2.6666666666666674, 0.0, 0.0]


def damping(coefficient, clearance, fraction=None, keyword="*CONTACT DAMPING, DEFINITION=DAMPING COEFFICIENT"):
    """Lines of the interaction."""
    words = [repr(coefficient), repr(clearance), *([repr(fraction)] if fraction is not None else [])]
    return [keyword, ", ".join(words)]


def coefficient(clearance, mu0, c0, eta):
    """`mu0` up to `eta c0`, linear to zero at `c0`."""
    if clearance <= eta * c0:
        return mu0
    return mu0 * (c0 - clearance) / (c0 * (1.0 - eta)) if clearance < c0 else 0.0


def solve(write_deck, tmp_path, text):
    """Result and points by increment."""
    result = support.run(write_deck(text), tmp_path)
    assert result.summary()["audit"] == []
    return result, rows(result)


def reaction(result):
    """Force of the wall on the point away from it, at each increment, from the reaction of its driven node."""
    return [-float(row["RF3"]) for row in result.table("nodes")]


@pytest.mark.parametrize(("mu0", "c0", "eta"), CURVES)
@pytest.mark.parametrize("move", [0.1, -0.05])
def test_a14_the_coefficient_follows_the_clearance_at_the_end(write_deck, tmp_path, mu0, c0, eta, move):
    """A prescribed node moves by a part of c0 in 0.25 of time and ends at each clearance; contact is linear, k = 50 mu0."""
    stiffness, period, area = 50.0 * mu0, 0.25, 1.6
    for number, scaled in enumerate(CLEARANCES):
        end, shift = 10.0 * c0 * scaled, move * c0
        behavior = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", repr(stiffness), *damping(mu0, c0, eta)]
        lines = step("*BOUNDARY", f"{node()}, 3, 3, {-shift!r}", period=period)
        text = deck([Point(clearance=end + shift)], behavior, lines, area=area)
        result = support.run(write_deck(text, f"deck{number}.inp"), tmp_path / str(number))
        viscous = coefficient(end, mu0, c0, eta) * shift / period
        if (mu0, c0, eta) == CURVES[0]:
            assert coefficient(end, mu0, c0, eta) == pytest.approx(PUBLISHED[number], rel=1e-13, abs=1e-13)
        # At c0 itself the rounding of the clearance decides between nothing and next to nothing.
        law = stiffness * max(0.0, -end)
        [force] = reaction(result)
        assert force == pytest.approx(area * (law + viscous), rel=1e-11, abs=1e-12 * mu0 * c0)
        [[point]] = rows(result)
        assert float(result.last("history")[0][f"CFN3[{PAIR}]"]) == pytest.approx(force, rel=1e-12)
        if end > 1e-9 * c0:
            assert point.pressure == pytest.approx(viscous, rel=1e-11, abs=1e-12 * mu0 * c0)


A15 = [
    ((8.0, 0.1, 0.4), 0.07, 0.06, 0.5, 0.10666666666666667),
    ((8.0, 0.1, 0.4), 0.06, 0.07, 0.5, None),
    ((8.0, 0.1, 0.4), 0.03, 0.02, 0.25, None),
    ((250.0, 0.5, 0.0), 0.5, 0.499, 2.0, None),
    ((250.0, 0.5, 0.2), 0.6, 0.2, 0.01, None),
]


@pytest.mark.parametrize(("curve", "start", "end", "period", "published"), A15)
def test_a15_an_open_point_shows_its_viscous_pressure(write_deck, tmp_path, curve, start, end, period, published):
    lines = step("*BOUNDARY", f"{node()}, 3, 3, {end - start!r}", period=period)
    text = deck([Point(clearance=start)], HARD + damping(*curve), lines)
    _, [[point]] = solve(write_deck, tmp_path, text)
    expected = coefficient(end, *curve) * (start - end) / period
    if published:
        assert expected == pytest.approx(published, rel=1e-12)
    assert point.pressure == pytest.approx(expected, rel=1e-12)
    assert point.overclosure == pytest.approx(-end, rel=1e-12)
    assert point.status == "VD"


def test_a_point_beyond_the_damped_clearance_is_open(write_deck, tmp_path):
    lines = step("*BOUNDARY", f"{node()}, 3, 3, -0.01", period=0.5)
    _, [[point]] = solve(write_deck, tmp_path, deck([Point(clearance=0.2)], HARD + damping(8.0, 0.1, 0.4), lines))
    assert (point.status, point.pressure) == ("OP", 0.0)


def test_eta_is_zero_unless_given(write_deck, tmp_path):
    lines = step("*BOUNDARY", f"{node()}, 3, 3, -0.01", period=0.5)
    _, [[point]] = solve(write_deck, tmp_path, deck([Point(clearance=0.07)], HARD + damping(8.0, 0.1), lines))
    assert point.pressure == pytest.approx(8.0 * (0.1 - 0.06) / 0.1 * 0.02, rel=1e-12)


@pytest.mark.parametrize("spring", [20.0, 300.0])
@pytest.mark.parametrize("increments", [1, 7])
def test_a_damped_point_on_a_spring_creeps_by_backward_euler(write_deck, tmp_path, spring, increments):
    """`F(t) = K u + A mu(c0 ramp at the end) (u - u_before) / dt`, a quadratic equation per increment; it stays open."""
    (mu0, c0, eta), start, force, period, area = CURVES[0], 0.09, 0.05 * spring, 0.7, 1.3
    lines = step("*CLOAD", f"{node()}, 3, {-force!r}", increments=increments, period=period)
    text = deck([Point(clearance=start, spring=spring)], HARD + damping(mu0, c0, eta), lines, area=area)
    _, found = solve(write_deck, tmp_path, text)
    u, size = 0.0, period / increments
    for number, (point,) in enumerate(found, 1):
        before, load = u, force * number / increments

        def residual(at, before=before, load=load):
            return spring * at + area * coefficient(start - at, mu0, c0, eta) * (at - before) / size - load

        u = bisect(residual, before, start)
        assert point.overclosure == pytest.approx(u - start, rel=1e-11)
        assert point.pressure == pytest.approx((load - spring * u) / area, rel=1e-10)
        assert point.status == "VD"


def bisect(function, low, high):
    """Root of an increasing function to the last bit."""
    while True:
        middle = 0.5 * (low + high)
        if middle in (low, high):
            return middle
        low, high = (middle, high) if function(middle) < 0.0 else (low, middle)


def test_separation_is_resisted_by_suction(write_deck, tmp_path):
    """A closed hard point is drawn away by its driver: the wall pulls it by mu (h - h_before) / dt."""
    stiffness, (mu0, c0, eta), area, period = 200.0, (8.0, 0.1, 0.4), 2.0, 0.5
    lines = step("*BOUNDARY", f"{driver()}, 3, 3, -0.02")
    lines += step("*BOUNDARY", f"{driver()}, 3, 3, 0.03", period=period)
    _, found = solve(
        write_deck, tmp_path, deck([Point(driver=stiffness)], HARD + damping(mu0, c0, eta), lines, area=area)
    )
    [closed], [opened] = found
    assert closed.status == "CL"
    assert closed.pressure == pytest.approx(stiffness * 0.02 / area, rel=1e-12)
    # Clearance c, below eta c0: K (0.03 - c) = A mu0 c / dt.
    clearance = stiffness * 0.03 / (stiffness + area * mu0 / period)
    assert clearance < eta * c0
    assert opened.overclosure == pytest.approx(-clearance, rel=1e-12)
    assert opened.pressure == pytest.approx(-mu0 * clearance / period, rel=1e-12)
    assert opened.status == "VD"


@pytest.mark.parametrize("left", [0.0, 0.25])
def test_stabilization_damps_within_its_step_and_ramps_down(write_deck, tmp_path, left):
    """`*CONTACT CONTROLS, STABILIZE`: coefficient, part of it at the end of the step, clearance of zero damping."""
    mu0, c0, start, increments, shift = 12.0, 0.5, 0.3, 4, 0.08
    card = [controls("STABILIZE"), f"{mu0!r}, {left!r}, {c0!r}"]
    lines = step(*card, "*BOUNDARY", f"{node()}, 3, 3, {-shift!r}", increments=increments)
    lines += step("*CONTACT CONTROLS, RESET", "*BOUNDARY", f"{node()}, 3, 3, {-2 * shift!r}")
    _, found = solve(write_deck, tmp_path, deck([Point(clearance=start)], HARD, lines))
    for number, (point,) in enumerate(found[:-1], 1):
        factor = 1.0 + (left - 1.0) * number / increments
        end = start - shift * number / increments
        expected = factor * coefficient(end, mu0, c0, 0.0) * shift
        assert point.pressure == pytest.approx(expected, rel=1e-11, abs=1e-13)
    assert found[-1][0].pressure == 0.0 and found[-1][0].status == "OP"


def test_damping_work_is_dissipated(write_deck, tmp_path):
    """ALLVD of a point moved at constant speed within eta c0: A mu0 v^2 t."""
    lines = step("*BOUNDARY", f"{node()}, 3, 3, -0.01", period=0.5, increments=5)
    text = deck([Point(clearance=0.03)], HARD + damping(8.0, 0.1, 0.4), lines, area=3.0)
    result, _ = solve(write_deck, tmp_path, text)
    last = result.last("history")[0]
    expected = 3.0 * 8.0 * 0.02**2 * 0.5
    assert float(last["ALLVD"]) == pytest.approx(expected, rel=1e-11)
    # The trapezoidal work of the first increment begins from no force.
    assert math.isclose(float(last["ALLWK"]), expected * (1.0 - 0.1), rel_tol=1e-11)
