"""Every solid element through the binary: uniform stress, gravity, contact on its faces, refusals."""

import re

import pytest

import support
from verification.solids import KINDS, Box, node_set, surface

YOUNG, POISSON, DENSITY, PRESSURE = 210.0, 0.3, 7.8, 2.5


def uneven(x):
    """Moves nodes of the box (0, 0, 0)-(2, 1, 1) within their sides."""
    a, b, c = x
    bump = a * (2.0 - a)
    return (a + 0.15 * bump * b * c, b + 0.3 * b * (1.0 - b) * a * c, c + 0.2 * c * (1.0 - c) * (b - 0.4) * a)


def material(name, young=YOUNG, poisson=POISSON):
    return [
        f"*MATERIAL, NAME=M{name}",
        "*ELASTIC",
        f"{young!r}, {poisson!r}",
        "*DENSITY",
        repr(DENSITY),
        f"*SOLID SECTION, ELSET=E{name}, MATERIAL=M{name}",
    ]


def bar(kind):
    """A bar of 2 x 1 x 1, its cells distorted, on rollers at x = 0, y = 0, z = 0."""
    box = Box(kind, (0.0, 0.0, 0.0), (2.0, 1.0, 1.0), (2, 2, 2), uneven)
    lines = [*box.lines("BAR"), *material("BAR")]
    for name, axis, level in (("X0", 0, 0.0), ("Y0", 1, 0.0), ("Z0", 2, 0.0), ("X1", 0, 2.0)):
        lines += node_set(name, box.side(axis, level))
    lines += ["*BOUNDARY", "X0, 1, 1", "Y0, 2, 2", "Z0, 3, 3"]
    return box, lines


def stresses(result):
    """Rows of the last stress table of JOB.dat: node to six components."""
    text = (result.folder / f"{result.job}.dat").read_text()
    table = text[text.rindex("STRESSES AVERAGED") :]
    rows = re.findall(r"^\s+(\d+)((?:\s+-?\d\.\d+E[+-]\d+){6})$", table, re.MULTILINE)
    return {int(node): [float(v) for v in values.split()] for node, values in rows}


@pytest.mark.parametrize("load", ["DLOAD", "DSLOAD"])
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("dialect", ["abaqus", "calculix"])
def test_pressure_on_distorted_elements_gives_the_uniform_stress(write_deck, tmp_path, kind, load, dialect):
    box, lines = bar(kind)
    end = box.side_faces(0, 2.0)
    lines += surface("END", end)
    if load == "DSLOAD":
        drive = ["*DSLOAD", f"END, P, {PRESSURE!r}"]
    else:
        drive = ["*DLOAD", *[f"{element}, P{face}, {PRESSURE!r}" for element, face in end]]
    requests = ["*NODE PRINT, NSET=X1", "U", "*NODE PRINT, NSET=X0, TOTALS=ONLY", "RF", "*EL PRINT, ELSET=EBAR", "S"]
    deck = write_deck("\n".join([*lines, "*STEP", "*STATIC", "1., 1.", *drive, *requests, "*END STEP", ""]))
    result = support.run(deck, tmp_path, "--dialect", dialect)
    row = result.last("history")[0]
    assert float(row["RF1[X0]"]) == pytest.approx(PRESSURE, rel=1e-11)
    for node in result.last("nodes"):
        assert float(node["U1"]) == pytest.approx(-2.0 * PRESSURE / YOUNG, rel=1e-10)
    found = stresses(result)
    assert set(found) == set(box.nodes)
    for stress in found.values():
        assert stress == pytest.approx([-PRESSURE, 0.0, 0.0, 0.0, 0.0, 0.0], abs=2e-6 * PRESSURE)


@pytest.mark.parametrize("kind", KINDS)
def test_gravity_weighs_the_volume(write_deck, tmp_path, kind):
    _, lines = bar(kind)
    step = ["*STEP", "*STATIC", "1., 1.", "*DLOAD", "EBAR, GRAV, 9.81, -1., 0., 0."]
    request = ["*NODE PRINT, NSET=X0, TOTALS=ONLY", "RF", "*END STEP", ""]
    result = support.run(write_deck("\n".join([*lines, *step, *request])), tmp_path)
    # The volume is that of the distorted box, whose sides stay where they are.
    assert float(result.last("history")[0]["RF1[X0]"]) == pytest.approx(DENSITY * 9.81 * 2.0, rel=1e-11)


def pressed(kind, upper="C3D8", surfaces=("LOW", "UP")):
    """A block of C3D8 over a block of another kind, pressed down by 0.01; linear law."""
    below = Box(kind, (0.0, 0.0, -1.0), (1.0, 1.0, 0.0), (2, 2, 1))
    above = Box(upper, (0.1, 0.1, 0.0), (0.9, 0.9, 1.0), (3, 3, 1), first_node=1001, first_element=1001)
    lines = [*below.lines("B"), *above.lines("A"), *material("B"), *material("A")]
    lines += node_set("FOOT", below.side(2, -1.0)) + node_set("HEAD", above.side(2, 1.0))
    lines += surface("UP", below.side_faces(2, 0.0)) + surface("LOW", above.side_faces(2, 0.0))
    lines += ["*SURFACE INTERACTION, NAME=SI", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", "500."]
    lines += ["*CONTACT PAIR, INTERACTION=SI, SMALL SLIDING", ", ".join(surfaces)]
    lines += ["*BOUNDARY", "FOOT, 1, 3", "HEAD, 1, 2", "*STEP", "*STATIC", "1., 1.", "*BOUNDARY", "HEAD, 3, 3, -0.01"]
    requests = ["*NODE PRINT, NSET=FOOT, TOTALS=ONLY", "RF", "*NODE PRINT, NSET=HEAD, TOTALS=ONLY", "RF"]
    return "\n".join([*lines, *requests, "*CONTACT PRINT", "CSTR, CDIS", "*END STEP", ""])


@pytest.mark.parametrize("kind", KINDS)
def test_faces_of_every_kind_carry_contact(write_deck, tmp_path, kind):
    result = support.run(write_deck(pressed(kind)), tmp_path)
    row = result.last("history")[0]
    contact = float(row["CFN3[LOW_UP]"])
    assert float(row["RF3[FOOT]"]) == pytest.approx(contact, rel=1e-9)
    assert float(row["RF3[HEAD]"]) == pytest.approx(-contact, rel=1e-9)
    points = result.last("contact")
    assert len(points) == 16 and all(point["status"] == "CL" for point in points)
    assert float(row["CAREA[LOW_UP]"]) == pytest.approx(0.64, rel=1e-12)
    # Two bars and the law in series, stiffened by held ends and by the width of the block below.
    in_series = 0.01 / (2.0 / YOUNG + 1.0 / 500.0)
    assert 1.0 < contact / 0.64 / in_series < 1.4


@pytest.mark.parametrize("kind", ["C3D10", "C3D15", "C3D20", "C3D20R"])
def test_a_quadratic_secondary_surface_is_refused_with_the_reason(write_deck, tmp_path, kind):
    deck = write_deck(pressed(kind, surfaces=("UP", "LOW")))
    done = support.call("check", deck)
    assert done.returncode == 2
    assert "*CONTACT PAIR" in done.stderr and "midside nodes" in done.stderr and kind in done.stderr


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("TYPE=C3D10", "TYPE=C3D20", "nodes; C3D20 has 20"),
        ("TYPE=C3D10", "TYPE=C3D4", "element 1 has 10 nodes; C3D4 has 4"),
        ("TYPE=C3D10", "TYPE=C3D10M", "element type C3D10M is not supported"),
        ("1., 1.\n", "1., 1.\n*DLOAD\nEB, P5, 1.\n", "has 4 faces and no face 5"),
        ("*SURFACE, NAME=UP, TYPE=ELEMENT\n", "*SURFACE, NAME=UP, TYPE=ELEMENT\nEB, S6\n", "no face 6"),
    ],
)
def test_wrong_types_and_faces_are_refused(write_deck, tmp_path, old, new, words):
    text = pressed("C3D10")
    assert old in text
    done = support.call("check", write_deck(text.replace(old, new, 1)))
    assert done.returncode == 2 and words in done.stderr, done.stderr


def test_cells_of_every_kind_reach_paraview(write_deck, tmp_path):
    """Types and ends of the cells, read back from the file."""
    types = {"C3D8": 12, "C3D20": 25, "C3D6": 13, "C3D15": 26, "C3D4": 10, "C3D10": 24}
    for kind, wanted in types.items():
        _, lines = bar(kind)
        step = [
            "*STEP",
            "*STATIC",
            "1., 1.",
            "*DLOAD",
            "EBAR, GRAV, 1., -1., 0., 0.",
            "*NODE FILE",
            "U",
            "*END STEP",
            "",
        ]
        folder = tmp_path / kind
        result = support.run(write_deck("\n".join([*lines, *step])), folder)
        data = (result.folder / f"{result.job}_00001.vtu").read_bytes()
        assert b'Name="types"' in data
        cells = 8 * {8: 1, 20: 1, 6: 2, 15: 2, 4: 6, 10: 6}[int(kind[3:])]
        assert bytes([wanted]) * cells in data, kind
