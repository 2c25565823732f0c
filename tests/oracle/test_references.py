"""The oracle of floating bodies against the oracle of held ones, against enumeration, and against wrong states."""

import numpy as np
import pytest

from oracle.comparison import suitable as suitable_held
from oracle.constrained import Structure
from oracle.equilibrium import Contact
from oracle.floating import random_deck


@pytest.mark.parametrize("laws", [("hard", "linear", "tabular"), ("exponential",)])
def test_both_oracles_agree_on_held_bodies(laws):
    """Multipliers and proof against elimination and enumeration, which share elements and contact geometry only."""
    for seed in range(12):
        deck, _, solutions = suitable_held(seed, laws)
        structure = Structure(deck)
        contact = Contact(structure, structure.load(deck.nodal_forces), deck.fixed)
        state = contact.equilibrium()
        expected = solutions[-1]
        scale = np.abs(expected.displacement).max()
        assert np.abs(state.displacement - expected.displacement.ravel()).max() <= 1e-11 * scale
        forces = expected.pressure * expected.area
        assert np.abs(state.forces - forces).max() <= 1e-11 * max(np.abs(forces).max(), np.abs(contact.load).max())


def test_enumeration_finds_the_state_that_switching_finds():
    """Where there are few states, the first that keeps all conditions is the same state."""
    compared = 0
    for seed in range(60):
        deck, structure = random_deck(seed, laws=("hard", "linear"))
        contact = Contact(structure, structure.load(deck.nodal_forces), deck.fixed)
        state = contact.switching(contact.smoothed_guess(1e-3 / contact.weight))
        if len(structure.rows) > 8 or state is None:
            continue
        other = contact.enumeration()
        nodal = structure.rows.T @ (other.forces - state.forces)
        reduced = nodal @ structure.influence[: len(nodal)]
        assert np.abs(reduced).max() <= 1e-9 * np.abs(state.displacement).max()
        compared += 1
    assert compared >= 8


def test_a_wrong_state_is_not_certified():
    """A changed force, a changed motion and a pulling point break the proof."""
    deck, structure = random_deck(3, laws=("hard",))
    contact = Contact(structure, structure.load(deck.nodal_forces), deck.fixed)
    state = contact.equilibrium()
    motion = structure.held.T @ state.displacement
    base = structure.held.T @ (contact.unloaded - structure.influence @ state.forces)[: deck.coordinates.size]
    assert contact.certified(state.forces, motion - base, 0)
    assert contact.certified(state.forces * (1.0 + 1e-8), motion - base, 0) is None
    assert contact.certified(state.forces, motion - base + 1e-8, 0) is None
    assert contact.certified(-state.forces, motion - base, 0) is None
