"""The solver against brute force on seeded random small decks."""

from functools import partial

import numpy as np
import pytest

import generate_deck
import support
from oracle import fe, totals
from oracle.comparison import compare
from oracle.decks import random_deck
from oracle.enumeration import hard, linear, solve, tabular
from oracle.parallel import in_parallel

DECKS = 500
EXPONENTIAL_DECKS = 60
TOLERANCE = 1e-9


def failures(reports):
    """What a developer wants to read first: seeds with the largest differences."""
    lines = [f"seed {r.seed}: {r.problem}" for r in reports if r.problem]
    for report in reports:
        bad = {k: v for k, v in report.differences.items() if not v <= TOLERANCE}
        if bad:
            lines.append(
                f"seed {report.seed} ({report.dialect}, {report.points} points, {report.closed} closed): {bad}"
            )
    return lines


def test_500_random_decks_agree_with_enumeration():
    """The solver shall find the contact state that brute-force enumeration of all active sets finds, to 1e-9."""
    reports = in_parallel(compare, range(DECKS))
    found = failures(reports)
    assert not found, f"{len(found)} of {DECKS} decks differ:\n" + "\n".join(found[:20])
    assert sum(0 < r.closed < r.points for r in reports) > DECKS // 4, (
        "too few decks are partly closed to prove anything"
    )
    assert {r.dialect for r in reports} == {"abaqus", "calculix"}
    assert max(r.points for r in reports) == 10


def test_random_exponential_decks_agree_with_a_convex_minimisation():
    """The solver shall find the minimum of the potential of structure and exponential contact, to 1e-9."""
    reports = in_parallel(partial(compare, laws=("exponential",)), range(2000, 2000 + 2 * EXPONENTIAL_DECKS))
    reports = [r for r in reports if r.dialect == "abaqus"][:EXPONENTIAL_DECKS]
    assert len(reports) == EXPONENTIAL_DECKS
    found = failures(reports)
    assert not found, f"{len(found)} of {len(reports)} decks differ:\n" + "\n".join(found[:20])


@pytest.mark.parametrize("full", [True, False])
def test_oracle_elements_pass_the_patch_test(full):
    """A linear displacement field on a distorted element shall give the exact stress in the exact volume."""
    deck = random_deck(7)
    hooke = fe.elasticity(1000.0, 0.3)
    gradient = np.random.default_rng(1).normal(size=(3, 3)) * 1e-3
    strain = 0.5 * (gradient + gradient.T)
    vector = np.array([*np.diag(strain), 2 * strain[0, 1], 2 * strain[0, 2], 2 * strain[1, 2]])
    for nodes in deck.elements:
        corners = deck.coordinates[nodes]
        block = fe.stiffnesses(corners[None], hooke, full)[0]
        volume = sum(np.linalg.det(corners.T @ fe.shape(p)[1]) for p in fe.gauss_points())
        moved = (corners @ gradient.T).ravel()
        assert moved @ block @ moved == pytest.approx(vector @ hooke @ vector * volume, rel=1e-11)
        rigid = np.tile([1.0, -2.0, 0.5], 8)
        assert np.abs(block @ rigid).max() < 1e-10 * np.abs(block).max()


def test_enumeration_solves_one_spring_through_each_law():
    """One point on a spring of stiffness 1000 pushed 0.08 too far: the values of case B02."""
    compliance, free, area = np.array([[1e-3]]), np.array([0.08]), np.array([2.0])
    cases = {
        26.666666666666668: linear(250.0),
        80.0: hard(),
        54.285714285714285: tabular([(0, 0), (2, 0.01), (10, 0.02), (40, 0.03)]),
    }
    for force, law in cases.items():
        assert solve(compliance, free, area, [law])[0] == pytest.approx(force, rel=1e-14)
    assert solve(compliance, -free, area, [hard()])[0] == 0.0


@pytest.mark.parametrize("dialect", ["abaqus", "calculix"])
@pytest.mark.parametrize(("kind", "size"), [("punch", 6), ("hertz", 24)])
def test_totals_of_generated_decks_agree_with_the_oracle(tmp_path, kind, size, dialect):
    """The solver shall find the total forces of punch and Hertz decks, to 1e-9."""
    deck = tmp_path / f"{kind}.inp"
    generate_deck.generate([kind, size, deck, "--no-fields"])
    found = support.run(deck, tmp_path, "--dialect", dialect).last("history")[0]
    reaction = float(found[f"RF{generate_deck.PROBLEMS[kind].direction}[NTOP]"])
    assert reaction == pytest.approx(totals.total(kind, size, full=dialect == "calculix"), rel=TOLERANCE)
