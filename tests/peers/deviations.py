"""Solves every contact deck of CalculiX's collection that we read, and prints how far displacements are from the shipped ones.

    PYTHONPATH=tests .venv/bin/python -m peers.deviations [NAME...] [--limit SECONDS]

One line per deck: what became of it, the largest deviation of a displacement over the largest one of its block at the last time
that both have, and how long it took. `--node-to-surface` solves surface-to-surface and mortar decks as node-to-surface, which is
another discretisation: those lines say so.
"""

import argparse
import re
import subprocess
import tempfile
import time
from pathlib import Path

import support
from peers import collection, dat

PAIR = re.compile(r"^\*\s*CONTACT\s*PAIR", re.IGNORECASE | re.MULTILINE)
OTHER = re.compile(r"TYPE\s*=\s*(SURFACE\s*TO\s*SURFACE|MORTAR|LINMORTAR|PGLINMORTAR|MASSLESS)", re.IGNORECASE)


def names():
    """Names of the decks with a contact pair, in order."""
    base = collection.folder()
    decks = sorted(path for pattern in ("*.inp", "*.inp.gz") for path in base.glob(pattern))
    return sorted({path.name.split(".inp")[0] for path in decks if PAIR.search(dat.read_text(path))})


def printed(name):
    """Displacement blocks that the collection ships, by (set, time)."""
    try:
        return dat.displacements(collection.text_of(f"{name}.dat.ref"))
    except FileNotFoundError:
        return {}


def computed(result):
    """Our displacements by time and node."""
    times = {}
    for row in result.table("nodes"):
        values = [float(row[f"U{d}"] or 0.0) for d in (1, 2, 3)]
        times.setdefault(float(row["time"]), {})[(int(row["node"]),)] = values
    return times


def compare(blocks, ours):
    """(time, deviation) of the worst block at the last time that both have; nothing where there is none."""
    for at in sorted({when for _, when in blocks}, reverse=True):
        near = [t for t in ours if abs(t - at) <= 1e-6 * max(abs(at), 1e-12)]
        here = [block for (_, when), block in blocks.items() if when == at and block.largest() > 0.0]
        if near and here:
            return at, max(dat.deviation(block, ours[near[-1]]) for block in here)
    return None


def judge(name, limit, node_to_surface):
    """One line about a deck."""
    text = collection.text_of(f"{name}.inp")
    note = ""
    if node_to_surface and OTHER.search(text):
        text, note = OTHER.sub("TYPE=NODE TO SURFACE", text), " (as node-to-surface)"
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder) / f"{name}.inp"
        deck.write_text(text, encoding="latin-1")
        begin = time.monotonic()
        try:
            done = support.call("run", deck, "--out", folder, "--quiet", "--dialect", "calculix", timeout=limit)
        except subprocess.TimeoutExpired:
            return f"{name}{note}: more than {limit:g} s"
        seconds = time.monotonic() - begin
        if done.returncode != 0:
            errors = [line for line in done.stderr.splitlines() if "error" in line.lower()] or done.stderr.splitlines()
            reasons = [line.partition("error: ")[2] or line for line in errors if not line.endswith("warnings")]
            return f"{name}{note}: exit {done.returncode}: " + " | ".join(dict.fromkeys(r[:160] for r in reasons[:4]))
        found = compare(printed(name), computed(support.Result(Path(folder), name)))
    if found is None:
        return f"{name}{note}: solved in {seconds:.1f} s, no displacements to compare"
    return f"{name}{note}: deviation {found[1]:.2e} at time {found[0]:g}, {seconds:.1f} s"


def main():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help="decks; all with a contact pair where none is named")
    parser.add_argument("--limit", type=float, default=120.0, help="seconds that a deck may take")
    parser.add_argument("--node-to-surface", action="store_true", help="solve other discretisations as node-to-surface")
    options = parser.parse_args()
    if collection.folder() is None:
        parser.error(f"the decks are not installed: {collection.PACKAGE}, or CALCULIX_TESTS")
    for name in options.names or names():
        print(judge(name, options.limit, options.node_to_surface), flush=True)


if __name__ == "__main__":
    main()
