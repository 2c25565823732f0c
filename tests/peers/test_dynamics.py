"""Dynamic contact decks of CalculiX's collection, unmodified, against the displacements and velocities that it ships with them.

contdamp1: a mass on a spring, loaded at once, with a dashpot in contact along the normal; contdamp2: the dashpot along the surface.
The secondary node is on no face, so the primary face is its area: 0.2 by 0.2, 1 by 0.2. One degree of freedom marched by the oracle
with alpha = -0.05 gives the shipped digits of both. contdamp2 slides over half of its face: sliding is small here, so the run stops there. ball, the third deck of the collection with *DYNAMIC and contact, has shells.
"""

import numpy as np
import pytest

import support
from oracle.dynamics import implicit, system
from peers import dat
from peers.collection import text_of

ALLOWED = 1e-3
MASS, SPRING, FORCE, DT = 7.8e-9 * 0.2**3, 10.0, 4.0, 1e-7
# Damping pressure per velocity of each deck, and its area.
DASHPOTS = {"contdamp1": 2.5e-4 * 0.04, "contdamp2": 5e-5 * 0.2}


def shipped(name, what):
    """Numbers by (time, node)."""
    blocks = [b for b in dat.blocks(text_of(f"{name}.dat.ref")) if b.what == what]
    return {(round(b.time, 12), node): row for b in blocks for (node,), row in b.rows.items()}


def ours(name, folder):
    """Rows of our nodes by (time, node), and the summary."""
    path = folder / f"{name}.inp"
    path.write_text(text_of(f"{name}.inp"), encoding="latin-1")
    done = support.call("run", path, "--out", folder, "--quiet", "--dialect", "calculix")
    assert done.returncode in (0, 3), done.stderr
    result = support.Result(folder, name)
    rows = {(round(float(row["time"]), 12), int(row["node"])): row for row in result.table("nodes")}
    return rows, result.summary()


def deviation(theirs, rows, letter):
    """Largest difference over the largest number; every shipped time and node is there."""
    assert theirs
    largest = max(abs(v) for row in theirs.values() for v in row)
    worst = 0.0
    for key, row in theirs.items():
        mine = [float(rows[key][f"{letter}{d}"] or 0.0) for d in (1, 2, 3)]
        worst = max(worst, *(abs(a - b) for a, b in zip(mine, row, strict=True)))
    return worst / largest


def insist_on_the_shipped_motion(name, rows, until):
    """Every shipped displacement and velocity up to a time, to ALLOWED of the largest."""
    for what, letter in (("displacements", "U"), ("velocities", "V")):
        theirs = {key: row for key, row in shipped(name, what).items() if key[0] <= until}
        assert deviation(theirs, rows, letter) < ALLOWED


def test_contdamp1_moves_as_shipped(tmp_path):
    rows, summary = ours("contdamp1", tmp_path)
    assert summary["outcome"] == "completed"
    insist_on_the_shipped_motion("contdamp1", rows, 1e-5)
    # What docs/calculix-decks.md tells.
    assert deviation(shipped("contdamp1", "displacements"), rows, "U") == pytest.approx(9e-8, rel=0.2)


def test_contdamp2_moves_as_shipped_until_it_slides_too_far(tmp_path):
    rows, summary = ours("contdamp2", tmp_path)
    assert summary["outcome"] == "stopped" and "slides beyond half a face" in summary["reason"]
    assert summary["time_reached"] > 7e-6
    insist_on_the_shipped_motion("contdamp2", rows, 7e-6)


@pytest.mark.parametrize("name", DASHPOTS)
def test_one_degree_of_freedom_gives_the_shipped_digits(name):
    """The march of the oracle: what the decks are, apart from any solver."""
    structure = system.Structure(
        *system.chain([MASS], [], [(0, SPRING)]),
        system.wall(1, 1e9),
        damping=np.array([[DASHPOTS[name]]]),
        force=lambda t: np.array([FORCE]),
    )
    history = implicit.march(structure, [0.0], DT, 100)
    theirs = shipped(name, "displacements")
    for time, u in zip(history.time[9::10], history.displacement[9::10, 0], strict=True):
        assert u == pytest.approx(theirs[round(time, 12), 2][0], rel=2e-6)
