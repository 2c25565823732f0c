"""Bad input of dynamic decks: refused or stopped, with the reason and the last good time."""

import json
import math

import pytest

import support
from verification.dynamics.motion import HARD, UNDAMPED, Scene, linear
from verification.dynamics.test_waves import TRUSS

WAVE = math.sqrt(TRUSS["young"] / TRUSS["density"])


def told(write_deck, tmp_path, text):
    """Exit code, standard error and JOB.json (none where there is no file)."""
    done = support.call("run", write_deck(text), "--out", tmp_path, "--quiet")
    assert "panicked" not in done.stderr
    summary = tmp_path / "deck.json"
    return done.returncode, done.stderr, json.loads(summary.read_text()) if summary.is_file() else None


def bar(elements=10, explicit=True, **changes):
    """A bar in front of a wall."""
    scene = Scene(explicit=explicit)
    labels = scene.bar(elements, **{**TRUSS, **changes}, start=0.01, velocity=-1.5)
    scene.pair(labels[:1], HARD)
    return scene


@pytest.mark.parametrize("factor", [1.001, 1.5, 100.0])
def test_a_direct_increment_above_the_stable_limit(write_deck, tmp_path, factor):
    scene = bar()
    dt = factor * TRUSS["length"] / 10 / WAVE
    code, errors, summary = told(write_deck, tmp_path, scene.text(scene.central(dt, 50)))
    assert code in (2, 3), errors
    reason = errors if code == 2 else summary["reason"]
    assert "stable" in reason and "increment" in reason, reason
    if code == 3:
        assert summary["time_reached"] == 0.0


def test_a_direct_increment_at_the_stable_limit_is_taken(write_deck, tmp_path):
    scene = bar()
    code, errors, _ = told(write_deck, tmp_path, scene.text(scene.central(TRUSS["length"] / 10 / WAVE, 50)))
    assert code == 0, errors


def test_a_direct_increment_above_the_limit_of_a_contact_spring(write_deck, tmp_path):
    """Stable until contact begins: stopped there, or refused before."""
    scene = Scene(explicit=True)
    node = scene.node(0.01, -1.0, 1.0)
    scene.pair([node], [*linear(1e6), *UNDAMPED], 1.0, ["MECHANICAL CONSTRAINT=PENALTY"])
    code, errors, summary = told(write_deck, tmp_path, scene.text(scene.central(2.5e-3, 40)))
    assert code in (2, 3), errors
    reason = errors if code == 2 else summary["reason"]
    assert "stable" in reason, reason
    if code == 3:
        assert 0.0 <= summary["time_reached"] <= 0.0126


@pytest.mark.parametrize("explicit", [True, False])
@pytest.mark.parametrize("density", [-7800.0, 0.0])
def test_densities_that_are_not_positive(write_deck, tmp_path, explicit, density):
    scene = bar(explicit=explicit, density=density)
    code, errors, _ = told(write_deck, tmp_path, scene.text(scene.step(1e-6, 5)))
    assert code == 2
    assert "density" in errors.lower()


@pytest.mark.parametrize("explicit", [True, False])
def test_a_material_without_density(write_deck, tmp_path, explicit):
    scene = bar(explicit=explicit)
    text = scene.text(scene.step(1e-6, 5)).replace("*DENSITY\n7800.0,\n", "")
    code, errors, _ = told(write_deck, tmp_path, text)
    assert code == 2
    assert "density" in errors.lower()


@pytest.mark.parametrize("explicit", [True, False])
@pytest.mark.parametrize("line", ["1e-6, 0.", "1e-6, -1.", "0., 1.", "-1e-6, 1."])
def test_periods_and_increments_that_are_not_positive(write_deck, tmp_path, explicit, line):
    """An implicit increment of 0 is one that is not given: it is the period."""
    scene = bar(explicit=explicit)
    text = scene.text(scene.step(1e-6, 5))
    code, errors, _ = told(
        write_deck, tmp_path, text.replace("1e-06, 5e-06", line).replace("1e-06, 4.9999999999999996e-06", line)
    )
    if line == "0., 1." and not explicit:
        assert code in (0, 3), errors
        return
    assert code == 2, errors
    assert "DYNAMIC" in errors


@pytest.mark.parametrize("region", ["999", "NOWHERE"])
def test_an_initial_velocity_on_a_missing_node(write_deck, tmp_path, region):
    scene = bar()
    text = scene.text(scene.step(1e-6, 5)).replace("TYPE=VELOCITY\n", f"TYPE=VELOCITY\n{region}, 3, 1.\n")
    code, errors, _ = told(write_deck, tmp_path, text)
    assert code == 2
    assert region in errors and "INITIAL CONDITIONS" in errors


def test_a_rigid_secondary_in_kinematic_contact(write_deck, tmp_path):
    """V19; by penalties an element-based one is taken."""
    scene = bar()
    lines = scene.text(scene.central(1e-6, 5)).splitlines()
    at = lines.index("*BOUNDARY")
    facet = [
        "*NODE, NSET=NFACET",
        "901, -0.4, -0.4, 0.3",
        "902, 0.4, -0.4, 0.3",
        "903, 0.4, 0.4, 0.3",
        "904, -0.4, 0.4, 0.3",
    ]
    facet += ["905, 0., 0., 0.3", "*ELEMENT, TYPE=R3D4, ELSET=EFACET", "901, 904, 903, 902, 901"]
    facet += ["*RIGID BODY, ELSET=EFACET, REF NODE=905", "*SURFACE, NAME=FACET, TYPE=ELEMENT", "EFACET, SPOS"]
    facet += ["*ELEMENT, TYPE=MASS, ELSET=MFACET", "906, 905", "*MASS, ELSET=MFACET", "1.,"]
    for word, expected in (("KINEMATIC", 2), ("PENALTY", 0)):
        pair = [f"*CONTACT PAIR, INTERACTION=IPOINTS, MECHANICAL CONSTRAINT={word}, WEIGHT=0.", "FACET, WALL"]
        step = lines.index("*BULK VISCOSITY")
        text = [
            *lines[:at],
            *facet,
            "*BOUNDARY",
            "905, 1, 6",
            *lines[at:step],
            *lines[step : step + 2],
            *pair,
            *lines[step + 2 :],
        ]
        folder = tmp_path / word
        code, errors, _ = told(write_deck, folder, "\n".join(text) + "\n")
        assert code == expected, errors
        if expected:
            assert "rigid" in errors.lower() and "CONTACT PAIR" in errors


def test_both_products_in_one_deck(write_deck, tmp_path):
    scene = bar()
    steps = scene.central(1e-6, 5), ["*STEP", "*STATIC", "1., 1.", "*END STEP"]
    code, errors, _ = told(write_deck, tmp_path, scene.text(*steps))
    assert code == 2
    assert "*STATIC" in errors and "explicit" in errors.lower()


def test_an_alpha_out_of_range(write_deck, tmp_path):
    for alpha in (-0.5, 0.1):
        scene = bar(explicit=False)
        code, errors, _ = told(write_deck, tmp_path, scene.text(scene.implicit(1e-6, 5, alpha=alpha)))
        assert code == 2
        assert "ALPHA" in errors


def test_a_run_that_diverges_says_when(write_deck, tmp_path):
    """A spring of a node without an element limit, stepped far beyond stability where the check sees it."""
    scene = Scene(explicit=True)
    node = scene.node(1.0, -1.0, 1.0)
    scene.spring([node], 1e8)
    code, errors, summary = told(write_deck, tmp_path, scene.text(scene.central(1e-3, 400)))
    assert code in (2, 3), errors
    reason = errors if code == 2 else summary["reason"]
    assert "stable" in reason or "diverge" in reason or "finite" in reason, reason
