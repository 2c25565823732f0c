"""Energy balance over thousands of increments (explicit) and many bounces (implicit), and its parts computed anew from motions."""

import numpy as np
import pytest

from oracle import fe
from verification.dynamics import bouncing, published
from verification.dynamics.motion import Run, support

DRIFT_MAX = 1e-3


@pytest.fixture(scope="module")
def measured(tmp_path_factory):
    """Figures of every case."""
    folder = tmp_path_factory.mktemp("bouncing")
    return [(case, bouncing.measure(case, folder / str(i))) for i, case in enumerate(bouncing.cases())]


def test_the_balance_holds_over_ten_thousand_explicit_increments(measured):
    for case, figures in measured:
        if case.explicit:
            assert figures.drift < DRIFT_MAX, (case.name, figures)


def test_the_balance_holds_in_implicit_steps(measured):
    """To the same bound, what alpha takes included."""
    for case, figures in measured:
        if not case.explicit:
            assert figures.drift < DRIFT_MAX, (case.name, figures)


def test_every_block_bounces(measured):
    for case, figures in measured:
        least = 1 if "no separation" in case.law else 3
        assert figures.contacts >= least, (case.name, figures)
        if case.enforcement == "kinematic" or (case.law == "hard" and not case.explicit):
            assert figures.impact > 0.0, case.name
        elif not case.explicit:
            assert figures.impact == pytest.approx(0.0, abs=1e-12), case.name
        else:
            # What penalties take or give because they begin and end between two increments; it vanishes with their size, see below.
            assert abs(figures.impact) < 0.08, case.name
        if not case.damped and "hard" not in case.law:
            assert figures.deepest > 0.01, case.name


def test_what_the_time_step_costs_undamped_penalties_vanishes_with_it(tmp_path):
    """The same second with increments of a quarter: IMPACT_LOSS, which has nothing else in it."""
    case = bouncing.Case("linear", "penalty", damped=False)
    found = []
    for parts in (1, 4):
        text = bouncing.deck(case, 300)
        size = f"{bouncing.DT!r}, {bouncing.DT * 300!r}"
        assert size in text
        path = tmp_path / f"deck{parts}.inp"
        path.write_text(text.replace(size, f"{bouncing.DT / parts!r}, {bouncing.DT * 300!r}"), encoding="utf-8")
        run = Run(support.run(path, tmp_path / str(parts)))
        found.append(np.abs(run.energy("IMPACT_LOSS")).max() / run.energy("ALLKE").max())
    assert found[1] < 0.3 * found[0] < 0.02, found


def test_the_readme_shows_the_figures(measured):
    assert published.shown("bouncing") == bouncing.table(measured), (
        "renew it: python -m verification.dynamics.bouncing --write"
    )


def assembled(box_nodes, elements, full):
    """Dense stiffness and lumped masses of the bricks, by the oracle's own elements."""
    index = {label: i for i, label in enumerate(box_nodes)}
    coordinates = np.array([box_nodes[n] for n in box_nodes])
    bricks = [[index[n] for n in nodes] for nodes in elements.values()]
    blocks = fe.stiffnesses(coordinates[np.array(bricks)], fe.elasticity(bouncing.YOUNG, bouncing.POISSON), full)
    stiffness = fe.assemble(len(index), bricks, blocks)
    masses = np.zeros(len(index))
    for nodes in bricks:
        extent = np.ptp(coordinates[nodes], axis=0).prod()
        masses[nodes] += bouncing.DENSITY * extent / 8.0
    return list(index), stiffness, masses


@pytest.mark.parametrize(
    "case",
    [
        bouncing.Case("linear", "penalty", damped=False),
        bouncing.Case("hard", "kinematic"),
        bouncing.Case("exponential", "kinematic"),
        bouncing.Case("linear", "implicit"),
    ],
    ids=lambda case: case.name,
)
def test_energies_are_those_of_the_printed_motion(tmp_path, case):
    """Kinetic, strain and load energies from displacements and velocities, with the oracle's matrices."""
    output = ["*NODE PRINT, NSET=ALL", "U, V", "*CONTACT PRINT", "CSTR, CDIS", "*END STEP"]
    text = bouncing.deck(case, 100 if case.explicit else 50, output, implicit_size=2.0)
    path = tmp_path / "deck.inp"
    path.write_text(text, encoding="utf-8")
    run = Run(support.run(path, tmp_path))
    nodes, elements = read_mesh(text)
    labels, stiffness, masses = assembled(nodes, elements, False)
    u = np.array([[run.node(n, f"U{d}") for d in (1, 2, 3)] for n in labels]).transpose(2, 0, 1)
    v = np.array([[run.node(n, f"V{d}") for d in (1, 2, 3)] for n in labels]).transpose(2, 0, 1)
    flat = u.reshape(len(u), -1)
    strain = 0.5 * np.einsum("ti,ij,tj->t", flat, stiffness, flat)
    top = np.array([nodes[n][2] > 1e-9 for n in labels])
    work = -bouncing.GRAVITY * (u[:, top, 2] * masses[top]).sum(axis=1)
    if case.explicit:
        # Energies stand at the start of an increment, velocities in its middle.
        kinetic = 0.5 * (masses[:, None] * v[:-1] * v[1:]).sum(axis=(1, 2))
        pairs = (
            (kinetic, run.energy("ALLKE")[1:]),
            (strain[:-1], run.energy("ALLSE")[1:]),
            (work[:-1], run.energy("ALLWK")[1:]),
        )
    else:
        kinetic = 0.5 * (masses[:, None] * v * v).sum(axis=(1, 2))
        pairs = ((kinetic, run.energy("ALLKE")), (strain, run.energy("ALLSE")), (work, run.energy("ALLWK")))
    largest = max(np.abs(own).max() for own, _ in pairs)
    for own, told in pairs:
        assert told == pytest.approx(own, abs=1e-8 * largest)
    assert (np.array([float(r["CAREA[DOWN_UP]"]) for r in run.history]) > 0).any(), "no contact in the run"


def read_mesh(text):
    """Nodes and bricks of deck text."""
    nodes, elements, into = {}, {}, None
    for line in text.splitlines():
        if line.startswith("*"):
            into = nodes if line.startswith("*NODE,") else elements if line.startswith("*ELEMENT") else None
        elif into is not None:
            label, *words = line.split(",")
            into[int(label)] = [float(w) for w in words] if into is nodes else [int(w) for w in words]
    return nodes, elements
