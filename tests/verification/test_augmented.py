"""Augmented Lagrange on springs (B09 to B11) and its tolerances (B27): every penetration, every count."""

import itertools
import math

import pytest

import support
from verification.columns import Block, output_of, stack
from verification.points import PAIR, Point, controls, deck, node, rows, step

# Spring, penalty and force; the first is the published case.
CASES = [(1000.0, 3000.0, 12.0), (250.0, 1750.0, 3.0), (40.0, 4000.0, 7.5)]
LENGTH = 2.0
# Penetrations below this part of the free motion are not to be had to 1e-10: they are small differences of forces.
RESOLVED = 1e-5


def penalty(stiffness, clearance=None):
    """Lines of the interaction."""
    words = [repr(stiffness), *([repr(clearance)] if clearance is not None else [])]
    return ["*SURFACE BEHAVIOR, AUGMENTED LAGRANGE", ", ".join(words) + ","]


def pressed(force):
    """A dead force towards the wall."""
    return ["*CLOAD", f"{node()}, 3, {-force!r}"]


def penetrations(spring, stiffness, force, count):
    """Overclosure after each solve: `F / (K + kp) rho^n` with `rho = K / (K + kp)`."""
    rho = spring / (spring + stiffness)
    return [force / (spring + stiffness) * rho**n for n in range(count)]


def solve(write_deck, tmp_path, text, number=0):
    """The run, its points, and the counts of its steps."""
    result = support.run(write_deck(text, f"deck{number}.inp"), tmp_path / str(number))
    summary = result.summary()
    assert summary["outcome"] == "completed" and summary["audit"] == []
    return rows(result), summary["steps"]


@pytest.mark.parametrize(("spring", "stiffness", "force"), CASES)
def test_b09_each_solve_has_its_penetration_and_its_pressure(write_deck, tmp_path, spring, stiffness, force):
    """A tolerance just above the n-th penetration ends the sequence there, after n augmentations."""
    sequence = [h for h in penetrations(spring, stiffness, force, 8) if h > RESOLVED * force / spring]
    multiplier = 0.0
    for count, expected in enumerate(sequence):
        multiplier += stiffness * expected
        limit = controls(f"ABSOLUTE PENETRATION TOLERANCE={expected * 1.0001!r}")
        text = deck([Point(spring=spring)], penalty(stiffness), step(limit, *pressed(force)))
        [[point]], [counts] = solve(write_deck, tmp_path, text, count)
        assert counts["augmentations"] == count
        assert point.overclosure == pytest.approx(expected, rel=1e-12, abs=1e-12 * sequence[0])
        assert point.pressure == pytest.approx(multiplier, rel=1e-12)
        assert point.status == "CL"
    # The published numbers of the first case.
    if (spring, stiffness, force) == CASES[0]:
        assert sequence[-1] == pytest.approx(1.8310546875e-07, rel=1e-15)
        assert multiplier == pytest.approx(11.99981689453125, rel=1e-15)


def test_b09_the_published_tolerance_takes_six_augmentations(write_deck, tmp_path):
    limit = controls("ABSOLUTE PENETRATION TOLERANCE=1e-6")
    text = deck([Point(spring=1000.0)], penalty(3000.0), step(limit, *pressed(12.0)))
    [[point]], [counts] = solve(write_deck, tmp_path, text)
    assert counts["augmentations"] == 6
    assert point.overclosure == pytest.approx(7.32421875e-07, rel=1e-12, abs=3e-15)
    assert point.pressure == pytest.approx(11.999267578125, rel=1e-12)


@pytest.mark.parametrize("ratio", [1000.0, 10.0, 37.0, 0.5])
def test_b10_the_penetration_contracts_by_the_ratio_of_stiffnesses(write_deck, tmp_path, ratio):
    spring, force = 500.0, 8.0
    expected = 1.0 / (1.0 + ratio)
    found = []
    for count in range(3):
        size = penetrations(spring, ratio * spring, force, 3)[count]
        limit = controls(f"ABSOLUTE PENETRATION TOLERANCE={size * 1.0001!r}")
        text = deck([Point(spring=spring)], penalty(ratio * spring), step(limit, *pressed(force)))
        [[point]], [counts] = solve(write_deck, tmp_path, text, count)
        assert counts["augmentations"] == count
        found.append(point.overclosure)
    for before, after in itertools.pairwise(found):
        assert after / before == pytest.approx(expected, rel=1e-12, abs=1e-12 * found[0] / before)


@pytest.mark.parametrize(("tolerance", "augmentations", "expected"), [(0.005, 0, 0.004), (0.003, 1, 0.0)])
def test_b11_a_free_body_under_a_dead_load_needs_one_augmentation(
    write_deck, tmp_path, tolerance, augmentations, expected
):
    limit = controls(f"ABSOLUTE PENETRATION TOLERANCE={tolerance!r}")
    # A second point moves beside it, so that nothing is small against nothing where paths and frames are compared.
    points, beside = [Point(), Point(clearance=1.0)], f"{node(1)}, 3, 3, -0.01"
    text = deck(points, penalty(3000.0), step(limit, *pressed(12.0), "*BOUNDARY", beside))
    [[point, _]], [counts] = solve(write_deck, tmp_path, text)
    assert counts["augmentations"] == augmentations
    assert point.overclosure == pytest.approx(expected, abs=1e-15)
    assert point.pressure == pytest.approx(12.0, rel=1e-12)


def test_b11_a_block_under_a_dead_pressure_needs_one_augmentation(write_deck, tmp_path):
    """Pressure 6 on an area of 2 through a penalty of 1500: 0.004, then nothing."""
    blocks = {
        "TOP": Block((0.0, 0.0, 0.0), (1.0, 2.0, 1.0), (2, 2, 2), 700.0),
        "BOTTOM": Block((-0.5, -0.5, -1.0), (1.5, 2.5, 0.0), (1, 1, 1), 1000.0),
    }
    for tolerance, count, expected in ((0.0041, 0, 0.004), (0.0039, 1, 0.0)):
        card = f"*CONTACT CONTROLS, MASTER=BOTTOM_UP, SLAVE=TOP_DOWN, ABSOLUTE PENETRATION TOLERANCE={tolerance!r}"
        lines = ["*BOUNDARY", "BOTTOM_ALL, 1, 3", "TOP_ALL, 1, 2", "*STEP", "*STATIC, DIRECT", "1., 1.", card]
        lines += ["*DSLOAD", "TOP_UP, P, 6.", *output_of("TOP_ALL")]
        points, [counts] = solve(write_deck, tmp_path, stack(blocks, penalty(1500.0), lines), count)
        assert counts["augmentations"] == count and len(points[0]) == 9
        for point in points[0]:
            assert point.overclosure == pytest.approx(expected, abs=1e-13)
            assert point.pressure == pytest.approx(6.0, rel=1e-12)


def augments(write_deck, tmp_path, penetration, *words, face=LENGTH):
    """Whether a first penetration is augmented; the penalty is so stiff that one augmentation is enough then."""
    spring, stiffness = 1e4, 1e6
    force = penetration * (spring + stiffness)
    lines = [controls(*words)] if words else []
    text = stack(blocks_of(face, spring), penalty(stiffness / face**2), block_step(lines, force / face**2))
    points, [counts] = solve(write_deck, tmp_path, text, f"{penetration}{''.join(words)}")
    assert counts["augmentations"] in (0, 1) and len(points[0]) == 4
    return counts["augmentations"] == 1


def blocks_of(face, spring):
    """A column of stiffness `spring` on one square face of an edge, on a wall of faces of the same size."""
    half = 0.5 * face
    return {
        "TOP": Block((-half, -half, 0.0), (half, half, 1.0), (1, 1, 1), spring / face**2),
        "BOTTOM": Block((-face, -face, -1.0), (face, face, 0.0), (2, 2, 1), 1000.0),
    }


def block_step(lines, pressure):
    """Head held, feet pressed down by nodal forces of a uniform pressure."""
    lines = [line.replace("MASTER=WALL, SLAVE=POINTS", "MASTER=BOTTOM_UP, SLAVE=TOP_DOWN") for line in lines]
    begin = ["*BOUNDARY", "BOTTOM_ALL, 1, 3", "TOP_ALL, 1, 2", "TOP_HIGH, 3, 3", "*STEP", "*STATIC, DIRECT", "1., 1."]
    load = ["*DLOAD", f"ETOP, P1, {-pressure!r}"]
    return [*begin, *lines, *load, *output_of("TOP_ALL")]


TRIALS = {
    (): ("default: a thousandth of the face", 2e-3, (0.0019, 0.0021, 0.0006)),
    ("ABSOLUTE PENETRATION TOLERANCE=5e-4",): ("absolute", 5e-4, (0.0019, 0.0021, 0.0006, 0.00049)),
    ("RELATIVE PENETRATION TOLERANCE=0.01",): ("a hundredth of the face", 2e-2, (0.0019, 0.0021, 0.0006, 0.0201)),
}


@pytest.mark.parametrize("words", TRIALS, ids=lambda words: TRIALS[words][0])
def test_b27_augments_beyond_the_tolerance_alone(write_deck, tmp_path, words):
    _, tolerance, trials = TRIALS[words]
    for penetration in trials:
        assert augments(write_deck, tmp_path, penetration, *words) == (penetration > tolerance), penetration


@pytest.mark.parametrize("face", [0.5, 3.0])
def test_b27_the_default_tolerance_follows_the_size_of_the_faces(write_deck, tmp_path, face):
    for factor in (0.97, 1.03):
        assert augments(write_deck, tmp_path, 1e-3 * face * factor, face=face) == (factor > 1.0)


def test_b27_tolerances_and_stiffness_belong_to_the_step(write_deck, tmp_path):
    """Step 2 tightens the tolerance under the same load, step 3 takes twice the stiffness and twice the load."""
    spring, stiffness, force = 1000.0, 3000.0, 12.0
    first, third, *_ = penetrations(spring, stiffness, force, 8)[0], penetrations(spring, stiffness, force, 8)[2]
    lines = step(controls(f"ABSOLUTE PENETRATION TOLERANCE={first * 1.01!r}"), *pressed(force))
    lines += step(controls(f"ABSOLUTE PENETRATION TOLERANCE={third * 1.01!r}"))
    lines += step(
        controls("STIFFNESS SCALE FACTOR=2.", f"ABSOLUTE PENETRATION TOLERANCE={first!r}"), *pressed(2.0 * force)
    )
    result, counts = solve(write_deck, tmp_path, deck([Point(spring=spring)], penalty(stiffness), lines))
    found = [increment[0] for increment in result]
    assert [step["augmentations"] for step in counts] == [0, 2, 0]
    assert found[0].overclosure == pytest.approx(first, rel=1e-12)
    assert found[1].overclosure == pytest.approx(third, rel=1e-12)
    # The multiplier of the accepted solve stays: lambda = p - kp h of step 2.
    multiplier = force - spring * third - stiffness * third
    expected = (2.0 * force - multiplier) / (spring + 2.0 * stiffness)
    assert found[2].overclosure == pytest.approx(expected, rel=1e-12)
    assert found[2].pressure == pytest.approx(2.0 * force - spring * expected, rel=1e-12)


@pytest.mark.parametrize("clearance", [0.0, 0.001, 0.003])
def test_a_clearance_at_zero_pressure_shifts_the_penalty(write_deck, tmp_path, clearance):
    spring, stiffness, force = 1000.0, 3000.0, 12.0
    limit = controls("ABSOLUTE PENETRATION TOLERANCE=1.")
    text = deck([Point(spring=spring)], penalty(stiffness, clearance), step(limit, *pressed(force)))
    [[point]], _ = solve(write_deck, tmp_path, text)
    assert point.overclosure == pytest.approx((force - stiffness * clearance) / (spring + stiffness), rel=1e-12)
    assert point.pressure == pytest.approx(force - spring * point.overclosure, rel=1e-12)


def test_augmentations_factor_nothing_anew(write_deck, tmp_path):
    """Forty augmentations, one factorisation of the spring's body."""
    spring, stiffness, force = 4000.0, 1000.0, 12.0
    rho = spring / (spring + stiffness)
    count = 40
    limit = force / (spring + stiffness) * rho**count * 1.0001
    text = deck(
        [Point(spring=spring)],
        penalty(stiffness),
        step(controls(f"ABSOLUTE PENETRATION TOLERANCE={limit!r}"), *pressed(force)),
    )
    result = support.run(write_deck(text), tmp_path, "--path", "dense")
    [counts] = result.summary()["steps"]
    assert counts["augmentations"] == count
    assert counts["factorizations"] == 1
    assert counts["cutbacks"] == 0
    assert rows(result)[0][0].overclosure == pytest.approx(limit / 1.0001, rel=1e-9)
    assert math.isclose(
        float(result.last("history")[0][f"CFN3[{PAIR}]"]), force - spring * limit / 1.0001, rel_tol=1e-12
    )
