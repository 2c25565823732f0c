"""Decks of CalculiX's own collection, unmodified, against the displacements that it ships with them.

Needs the Debian package calculix-ccx-test. The same comparisons on decks of our own, which need nothing, are in test_cubes.py.
"""

import re
import shutil
import subprocess
from dataclasses import dataclass

import pytest

from peers import dat, decks, small_deck, survey
from peers.collection import text_of

# What the comparison promises: largest deviation of a displacement, over the largest displacement.
ALLOWED = 5e-3


@dataclass(frozen=True)
class Expected:
    """How far our answer, and a small-displacement model of CalculiX's law, are from the shipped displacements."""

    ours: float
    smoothed: float | None


# contact3, contact6: one node in contact, pressure 133 with sigma = 3. What the model of its law leaves is NLGEOM: without that card
# CalculiX meets it to 4e-7 on both decks.
# cubespring: pressure 100 with sigma = 3, so its springs yield 3 % more. NLGEOM and springs that turn with the bodies make up the
# rest: it falls in proportion to the load, to 1.4e-4 at a tenth and 1.4e-5 at a hundredth of it.
EXPECTED = {
    "contact3": Expected(1.80e-5, 4e-6),
    "contact6": Expected(7.11e-4, 7e-4),
    "cubespring": Expected(3.95e-3, 1.7e-3),
}

# Surface-to-surface in CalculiX, whose law there is not smoothed; node-to-surface here. contactenergy loads its four points evenly, which
# both transmit alike. hueeber: two meshes that do not match; what both say node-to-surface is compared below.
SURFACE_TO_SURFACE = {
    "contactenergy": 3.6e-7,
    "hueeber1": 1.66e-4,
    "hueeber2": 2.25e-3,
    "hueeber3": 9.25e-5,
    "hueeber4": 1.96e-3,
}


# Solved over time: in test_dynamics.py.
MOVING = "contdamp1"


def test_the_document_tells_the_deviations(tmp_path):
    told = {name: row.outcome for name, row in survey.documented().items() if row.outcome.startswith("solved")}
    assert {*EXPECTED, *SURFACE_TO_SURFACE, "contact1", MOVING} == set(told)
    assert told.pop(MOVING) == "solved: 0.000009 %"
    for name, outcome in told.items():
        percent = float(re.fullmatch(r"solved: ([0-9.]+) %", outcome)[1])
        folder = tmp_path / name
        folder.mkdir()
        computed, _ = decks.ours(unpacked(name, folder), folder)
        # Small ones are told with one digit.
        assert 100.0 * dat.deviation(shipped(name), computed) == pytest.approx(percent, rel=0.2)


def shipped(name):
    """Displacements of all nodes at the end."""
    ((_, block),) = dat.displacements(text_of(f"{name}.dat.ref")).items()
    return block


def unpacked(name, folder):
    """The deck as a file, byte by byte as in the collection."""
    path = folder / f"{name}.inp"
    path.write_text(text_of(f"{name}.inp"), encoding="latin-1")
    return path


@pytest.mark.parametrize("name", EXPECTED)
def test_displacements_are_within_half_a_percent_of_the_shipped_ones(tmp_path, name):
    block = shipped(name)
    computed, summary = decks.ours(unpacked(name, tmp_path), tmp_path)
    found = dat.deviation(block, computed)
    assert found < ALLOWED
    assert found == pytest.approx(EXPECTED[name].ours, rel=0.01)
    assert summary["outcome"] == "completed"


@pytest.mark.parametrize("name", SURFACE_TO_SURFACE)
def test_surface_to_surface_decks_are_within_half_a_percent_as_node_to_surface(tmp_path, name):
    computed, summary = decks.ours(unpacked(name, tmp_path), tmp_path)
    found = dat.deviation(shipped(name), computed)
    assert found < ALLOWED
    assert found == pytest.approx(SURFACE_TO_SURFACE[name], rel=0.02)
    assert any("solved node-to-surface" in finding["message"] for finding in summary["diagnostics"])


@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX is not installed (ccx, package calculix-ccx)")
@pytest.mark.parametrize(("name", "allowed"), [("hueeber3", 2e-6), ("hueeber4", 2.5e-4)])
def test_node_to_surface_calculix_comes_nearer_than_surface_to_surface(tmp_path, name, allowed):
    """The discretisation is what separates us: asked for node-to-surface, CalculiX agrees 10 to 100 times better."""
    deck = unpacked(name, tmp_path)
    deck.write_text(re.sub("SURFACE TO SURFACE", "NODE TO SURFACE", deck.read_text("latin-1")), encoding="latin-1")
    computed, _ = decks.ours(deck, tmp_path)
    done = subprocess.run(["ccx", name], cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stdout[-500:]
    ((_, block),) = dat.displacements(dat.read_text(tmp_path / f"{name}.dat")).items()
    assert dat.deviation(block, computed) < allowed


def test_contact1_exponential_law_on_one_node_agrees_to_the_printed_digits(tmp_path):
    """Its node stands for a quarter of each outer face at it, 0.03; with 1, as in Abaqus, displacements are 3.3 % off."""
    computed, _ = decks.ours(unpacked("contact1", tmp_path), tmp_path)
    assert dat.deviation(shipped("contact1"), computed) < 1e-6


@pytest.mark.parametrize("name", EXPECTED)
def test_a_model_of_the_smoothed_springs_comes_nearer_to_the_shipped_displacements(name):
    deck = small_deck.read(text_of(f"{name}.inp"))
    displacements, _ = decks.calculix(deck)
    found = dat.deviation(shipped(name), decks.by_node(deck, displacements))
    assert found < EXPECTED[name].smoothed < EXPECTED[name].ours


@pytest.mark.parametrize("name", EXPECTED)
def test_a_table_of_the_smoothed_law_comes_as_near_as_its_model(tmp_path, name):
    text = text_of(f"{name}.inp")
    deck = small_deck.read(text)
    displacements, overclosures = decks.calculix(deck)
    path = tmp_path / f"{name}.inp"
    path.write_text(decks.with_table(text, deck, 2.0 * overclosures.max()), encoding="latin-1")
    computed, _ = decks.ours(path, tmp_path)
    model = dat.Block("displacements", "NALL", 1.0, decks.by_node(deck, displacements))
    assert dat.deviation(model, computed) < 1e-5
    assert dat.deviation(shipped(name), computed) < EXPECTED[name].smoothed
