"""Random decks that move end, and their energies add up."""

import json
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import support
from oracle.parallel import in_parallel

from .moving import PROCEDURES, random_moving_deck

DECKS, SECONDS_MAX = 90, 20.0
PARTS = ("ALLSE", "ALLKE", "ALLFD", "ALLVD", "ALLCCE", "IMPACT_LOSS")
# Explicit contact takes or gives energy where it begins and ends between two increments; implicit steps damp on purpose, and so much
# the more the larger their increments. What the balance may miss without a word of the audit, over the largest energy.
MISSING_MAX = {"implicit": 0.05, "kinematic": 0.02, "penalty": 0.02}


@dataclass
class Told:
    """What came of a deck."""

    seed: int
    procedure: str
    words: list[str]
    code: int | None
    reason: str
    missing: float
    gained: float
    audit: list[str]
    momentum: float


def run(seed):
    """Solves the deck of a seed."""
    deck = random_moving_deck(seed)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "deck.inp"
        path.write_text(deck.text, encoding="utf-8")
        try:
            done = support.call("run", path, "--out", folder, "--quiet", timeout=SECONDS_MAX)
        except subprocess.TimeoutExpired:
            return Told(seed, deck.procedure, sorted(deck.words), None, "did not end in time", 0.0, 0.0, [], 0.0)
        summary = Path(folder) / "deck.json"
        told = json.loads(summary.read_text()) if summary.is_file() else {"audit": [], "reason": None}
        missing = gained = 0.0
        if done.returncode in (0, 3) and summary.is_file():
            missing, gained = balance(support.Result(Path(folder), "deck").table("history"))
    errors = [line.replace(folder, "") for line in done.stderr.splitlines() if "warning:" not in line]
    reason = ("panic: " if "panicked" in done.stderr else "") + (told["reason"] or " | ".join(errors[:3]))
    return Told(seed, deck.procedure, sorted(deck.words), done.returncode, reason, missing, gained, told["audit"], 0.0)


def balance(history):
    """Largest departure of ETOTAL from its first value, and largest gain, over the largest energy; its parts add up to it."""
    if not history:
        return 0.0, 0.0
    column = {name: np.array([float(row[name]) for row in history]) for name in (*PARTS, "ALLWK", "ETOTAL")}
    largest = max(np.abs(values).max() for name, values in column.items() if name != "ETOTAL") or 1.0
    own = sum(column[name] for name in PARTS) - column["ALLWK"]
    if np.abs(own - column["ETOTAL"]).max() > 1e-9 * largest:
        return np.inf, np.inf
    change = column["ETOTAL"] - column["ETOTAL"][0]
    # Contact that gives more than it stores makes energy.
    made = -(column["ALLCCE"] + column["IMPACT_LOSS"]).min()
    return float(np.abs(change).max() / largest), float(max(change.max(), made, 0.0) / largest)


def problems_of(told):
    """What is wrong with the outcome of a deck."""
    if told.code not in (0, 3) or "panic" in told.reason:
        return f"exit {told.code}: {told.reason}"
    if told.code == 3 and told.procedure != "implicit":
        return f"an explicit run stopped: {told.reason}"
    if not np.isfinite(told.missing):
        return "ETOTAL is not the sum of its parts"
    if max(told.missing, told.gained) > MISSING_MAX[told.procedure] and not any(
        "energy" in finding for finding in told.audit
    ):
        return f"{told.missing:.1%} of the energy is missing, {told.gained:.1%} made, and the audit is silent"
    return None


def test_random_moving_decks_end_and_keep_their_energy():
    """None panics, hangs or is refused; explicit ones all complete; energies balance, or the audit says that they do not."""
    outcomes = in_parallel(run, range(DECKS))
    found = [(o.seed, o.procedure, o.words, p) for o in outcomes if (p := problems_of(o))]
    assert not found, f"{len(found)} of {DECKS}:\n" + "\n".join(map(str, found[:20]))
    silent = [o for o in outcomes if o.missing <= MISSING_MAX[o.procedure]]
    assert len(silent) >= 0.9 * DECKS, "the audit has something to say about too many decks"
    assert {o.procedure for o in outcomes} == set(PROCEDURES)
    assert sum(o.code == 0 for o in outcomes) >= 0.95 * DECKS


def test_a_wrong_balance_is_noticed():
    """A history whose parts do not add up, and one that gains."""
    row = {name: 0.0 for name in (*PARTS, "ALLWK")}
    right = [{**row, "ALLKE": 2.0, "ETOTAL": 2.0}, {**row, "ALLSE": 2.0, "ETOTAL": 2.0}]
    assert balance(right) == (0.0, 0.0)
    assert balance([right[0], {**right[1], "ETOTAL": 1.9}]) == (np.inf, np.inf)
    assert balance([right[0], {**right[1], "ALLSE": 2.2, "ETOTAL": 2.2}])[1] > 0.05
