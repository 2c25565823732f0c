"""Total forces of the generated decks, and what may not change them."""

import math

import pytest

import generate_deck
import support

# Reaction of NTOP by another program of the same method, node-to-surface contact with the exact bilinear law;
# tests/oracle/totals.py computes them again.
CALCULIX = {
    ("hertz", 24): -359.631,
    ("hertz", 54): -355.635,
    ("hertz", 110): -356.040,
    ("punch", 9): -496.381,
    ("punch", 16): -469.319,
    ("punch", 26): -460.543,
}
ABAQUS = {("hertz", 54): -354.486, ("punch", 16): -464.474}
ROWS = {"hertz": "RF2[NTOP]", "punch": "RF3[NTOP]"}


def solve(tmp_path, kind, size, *arguments, options=()):
    """Generates and solves a deck."""
    deck = tmp_path / f"{kind}{size}.inp"
    generate_deck.generate([kind, size, deck, *options])
    return support.run(deck, tmp_path, *arguments, timeout=600)


def total(result, kind):
    """Reaction of NTOP in the direction of the drive at the end."""
    return float(result.last("history")[0][ROWS[kind]])


@pytest.mark.parametrize(("kind", "size"), CALCULIX)
def test_totals_with_fully_integrated_bricks(tmp_path, kind, size):
    result = solve(tmp_path, kind, size, "--dialect", "calculix", options=["--no-fields"])
    assert total(result, kind) == pytest.approx(CALCULIX[kind, size], rel=5e-4)
    assert result.summary()["outcome"] == "completed"


@pytest.mark.parametrize(("kind", "size"), ABAQUS)
def test_totals_with_mean_dilatation_bricks(tmp_path, kind, size):
    result = solve(tmp_path, kind, size, options=["--no-fields"])
    assert total(result, kind) == pytest.approx(ABAQUS[kind, size], rel=5e-4)


def test_hertz_theory_gives_the_peak_pressure_of_hard_contact(tmp_path):
    thickness, radius, poisson = 0.5, 10.0, 0.3
    result = solve(tmp_path, "hertz", 110, options=["--law", "hard", "--young", 210e3, 210e5, "--displacement", -0.01])
    # The deck is one quarter: half of the width of the contact strip.
    per_length = -2.0 * total(result, "hertz") / thickness
    modulus = 1.0 / ((1.0 - poisson**2) * (1.0 / 210e3 + 1.0 / 210e5))
    peak = max(float(row["CPRESS"]) for row in result.last("contact"))
    assert peak == pytest.approx(math.sqrt(per_length * modulus / (math.pi * radius)), rel=0.005)


@pytest.mark.parametrize("law", generate_deck.LAWS)
def test_the_end_state_does_not_depend_on_the_increments(tmp_path, law):
    totals = []
    for increments in (0, 1, 20):
        folder = tmp_path / str(increments)
        folder.mkdir()
        result = solve(folder, "hertz", 24, options=["--law", law, "--increments", increments])
        totals.append(total(result, "hertz"))
        if increments:
            assert result.summary()["steps"][0]["increments"] == increments
        # Each of the two bodies is factored once, however many increments follow.
        assert result.summary()["steps"][0]["factorizations"] == 2
    assert totals[1] == pytest.approx(totals[0], rel=1e-10)
    assert totals[2] == pytest.approx(totals[0], rel=1e-10)


@pytest.mark.parametrize("law", generate_deck.LAWS)
def test_four_laws_order_the_forces_as_their_stiffness(tmp_path, law):
    soft = total(solve(tmp_path, "punch", 4, options=["--law", "linear", "--stiffness", 1e3]), "punch")
    force = total(solve(tmp_path, "punch", 4, options=["--law", law]), "punch")
    hard = total(solve(tmp_path, "punch", 4, options=["--law", "hard"]), "punch")
    assert hard <= force < soft < 0.0
