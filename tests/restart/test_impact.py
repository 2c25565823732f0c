"""Motions survive a snapshot, in the middle of an impact too: implicit and explicit, every law and enforcement."""

import pytest
from restart.test_contact_memory import insist

import support
from verification.dynamics.motion import Run
from verification.dynamics.samples import decks


@pytest.mark.parametrize("name", decks())
def test_a_run_goes_on_in_the_middle_of_an_impact(tmp_path, name):
    """Every snapshot leads to the same bits: one of every third increment, of every seventh explicit one."""
    text = decks()[name]
    insist(tmp_path, "deck", text, every=7 if "*DYNAMIC, EXPLICIT" in text else 3)


def test_the_decks_touch_and_part(tmp_path):
    """Each has snapshots out of contact and in it."""
    for number, (name, text) in enumerate(decks().items()):
        path = tmp_path / f"deck{number}.inp"
        path.write_text(text, encoding="utf-8")
        run = Run(support.run(path, tmp_path / str(number)))
        (first, *_) = [key for key in run.history[0] if key.startswith("CAREA[")]
        closed = [float(row[first]) > 0.0 for row in run.history]
        assert any(closed) and not all(closed), name
