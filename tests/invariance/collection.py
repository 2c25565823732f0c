"""Decks that a change of frame, units or path may not change: verification, example, generated and oracle decks."""

import json
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import generate_deck
import support
from oracle import comparison as held
from oracle import deck as oracle_deck
from oracle import floating_comparison as floating
from oracle.parallel import in_parallel
from verification.dynamics import samples

from .recording import FOLDER

# Total forces of large meshes are not run again: the generated decks below are the same at sizes that take no time. Decks that move take
# thousands of increments: their samples stand for them.
LARGE = "not test_totals"


@dataclass
class Deck:
    """A deck as text, and the arguments it is run with."""

    name: str
    text: str
    arguments: list[str]


def verification_decks(folder):
    """Every deck that tests/verification solves, recorded from a run of those tests, each once."""
    paths = [support.ROOT / name for name in ("tests", "examples", "benches")]
    environment = os.environ | {FOLDER: str(folder), "PYTHONPATH": os.pathsep.join(map(str, paths))}
    command = [sys.executable, "-m", "pytest", "-q", "-p", "invariance.recording", "-p", "no:cacheprovider"]
    folder_of_tests = support.ROOT / "tests" / "verification"
    tests = ["-k", LARGE, "--ignore", str(folder_of_tests / "dynamics"), str(folder_of_tests)]
    subprocess.run([*command, *tests], cwd=support.ROOT, env=environment, capture_output=True, check=False)
    decks = {}
    for path in sorted(Path(folder).glob("*.inp")):
        about = json.loads(path.with_suffix(".json").read_text())
        name = about["test"].rpartition("/")[2]
        text = path.read_text()
        decks.setdefault((text, *about["arguments"]), Deck(name, text, about["arguments"]))
    return list(decks.values())


def moving_decks():
    """Decks that move through contact, implicit and explicit."""
    return [Deck(name, text, []) for name, text in samples.decks().items()]


def generated_decks(folder):
    """The example, and small punch and Hertz decks of every law in both dialects."""
    example = support.ROOT / "examples" / "two_blocks.inp"
    decks = [Deck(example.name, example.read_text(), [])]
    for kind, size in (("punch", 4), ("hertz", 6)):
        for law in generate_deck.LAWS:
            path = Path(folder) / f"{kind}_{law}.inp"
            generate_deck.generate([kind, size, path, "--law", law, "--increments", 2])
            for dialect in ("abaqus", "calculix"):
                decks.append(Deck(f"{path.stem}_{dialect}", path.read_text(), ["--dialect", dialect]))
    return decks


def oracle_decks(seeds):
    """Random decks of held bodies, every fifth with exponential laws."""
    return in_parallel(held_deck, seeds)


def held_deck(seed):
    """A random deck of held bodies."""
    deck, _, _ = held.suitable(seed, ("exponential",) if seed % 5 == 0 else ("hard", "linear", "tabular"))
    return Deck(f"held_{seed}", oracle_deck.text(deck), dialect(deck))


def floating_decks(seeds):
    """Random decks of floating bodies, with equations, springs and bars."""
    return in_parallel(floating_deck, seeds)


def floating_deck(seed):
    """A random deck of floating bodies."""
    deck = floating.suitable(seed)[0]
    return Deck(f"floating_{seed}", oracle_deck.text(deck), dialect(deck))


def dialect(deck):
    """Arguments that choose the elements of an oracle deck."""
    return ["--dialect", "calculix" if deck.full_integration else "abaqus"]
