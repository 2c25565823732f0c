"""The ASCII results file: is it well formed, and does it hold the numbers of the tables?

The solver shall write results files that a reader by the manual's rules understands, with the numbers of the tables to all their
digits (16 of the 17 in the tables).
"""

import re
import subprocess
import sys

import pytest

import support
from results_file import reader

CONTACT = {1511: ("CPRESS", "CSHEAR1", "CSHEAR2"), 1521: ("COPEN", "CSLIP1", "CSLIP2")}
FORCES = {1522: "CFN", 1523: "CFS", 1575: "CFT", 1576: "CMT"}
CENTRE, AREA, VISCOUS = 1573, 1524, 1512
LONG = "SECONDARY_SURFACE"
REQUESTS = f"""*CONTACT FILE, FREQUENCY=2, SLAVE={LONG}, MASTER=SMA
CSTRESS, CDSTRESS, CDISP, CFN, CFS, CFT, CMT, CAREA, XN
*NODE FILE, NSET=EVERYTHING
U, RF
*EL FILE
S
*NODE PRINT, NSET=EVERYTHING
U, RF
*EL PRINT
S
*END STEP"""


def digits(value):
    """A number of a table with the 16 digits of the results file."""
    return f"{float(value):.15e}"


def same(written, expected):
    """Whether a word of the results file is a number of a table, to the last digit of the former."""
    return digits(reader.real(written)) == digits(expected)


@pytest.fixture(scope="module")
def job(tmp_path_factory):
    """A cylinder that presses into a block: long names, sets of more members than a record holds, several increments."""
    folder = tmp_path_factory.mktemp("results_file")
    deck = folder / "punch.inp"
    generate = [
        sys.executable,
        support.ROOT / "examples" / "generate_deck.py",
        "hertz",
        "12",
        deck,
        "--increments",
        "5",
    ]
    subprocess.run(list(map(str, generate)), check=True)
    text = deck.read_text().replace("SSL", LONG)
    count = len(re.findall(r"^\d+, *-?[\d.]+(?:e-?\d+)?, *-?[\d.e-]+, *-?[\d.e-]+$", text, re.M))
    every = f"*NSET, NSET=EVERYTHING, GENERATE\n1, {count}\n*MATERIAL"
    text = text.replace("*MATERIAL", every, 1)
    head, _, _ = text.partition("*NODE PRINT")
    deck.write_text(head + REQUESTS + "\n")
    result = support.run(deck, folder)
    names, blocks = reader.read(folder / "punch.fil")
    return result, names, blocks


def times(block):
    """Total time, step, increment of an increment by its first record."""
    first = block[0]
    assert first.key == 2000
    assert len(first.attributes) == 21
    time, step_time, *_, procedure, step, increment, perturbation, _, _, size = first.attributes[:11]
    assert (procedure, perturbation) == (2, 0) or (procedure, perturbation) == (1, 0)
    assert size > 0 and step_time <= time
    return first.written[0], step, increment


def at(rows, step, increment):
    return [row for row in rows if (int(row["step"]), int(row["increment"])) == (step, increment)]


def test_the_head_describes_the_model(job):
    result, head, _ = job
    keys = [record.key for record in head]
    assert keys[0] == 1921 and keys[-1] == 1922
    size = result.summary()["size"]
    elements = {record.attributes[0]: record.attributes[1:] for record in head if record.key == 1900}
    nodes = {record.attributes[0]: record.attributes[1:] for record in head if record.key == 1901}
    assert (len(elements), len(nodes)) == (size["elements"], size["nodes"])
    assert head[0].attributes[4:6] == [size["elements"], size["nodes"]]
    assert all(kind == "C3D8    " and set(members) <= set(nodes) for kind, *members in elements.values())
    sets = reader.sets(head, 1931, 1932)
    assert sorted(sets["EVERYTHING"]) == sorted(nodes) and len(nodes) > 3 * reader.WORDS_MAX
    names = reader.labels(head)
    assert sorted(names.values()) == ["EVERYTHING", LONG]
    surfaces = {reader.name(r.attributes[0], names): r.attributes[1:] for r in head if r.key == 1501}
    assert surfaces[LONG][:2] == [3, 1] and surfaces[LONG][3:] == [1, "SMA     "] and surfaces["SMA"][3] == 0
    faces = [record.attributes for record in head if record.key == 1502]
    assert len(faces) == surfaces[LONG][2] + surfaces["SMA"][2]
    for element, face, count, *corners in faces:
        assert 1 <= face <= 6 and count == len(corners) == 4 and set(corners) <= set(elements[element][1:])
    (directions,) = [record.attributes for record in head if record.key == 1902]
    assert directions[:4] == [1, 2, 3, 0] and not any(directions[3:])


def test_contact_records_are_the_contact_table(job):
    result, head, blocks = job
    names, rows, history = reader.labels(head), result.table("contact"), result.table("history")
    checked = 0
    for block in blocks:
        time, step, increment = times(block)
        requests = reader.contact(block, names)
        last = increment == 5
        assert len(requests) == (1 if increment % 2 == 0 or last else 0), "FREQUENCY=2, and the last increment"
        for request in requests:
            assert request["pair"] == (LONG, "SMA") and request["set"] == ""
            table = {int(row["node"]): row for row in at(rows, step, increment)}
            assert sorted(request["nodes"]) == sorted(table)
            for node, records in request["nodes"].items():
                assert same(time, table[node]["time"])
                for key, columns in CONTACT.items():
                    for written, column in zip(records[key], columns, strict=True):
                        assert same(written, table[node][column]), (increment, node, column)
                        checked += 1
                assert [reader.real(word) for word in records[VISCOUS]] == [0.0, 0.0, 0.0]
            (row,) = at(history, step, increment)
            pair = f"[{LONG}_SMA]"
            for key, family in FORCES.items():
                size, *vector = request["totals"][key]
                for written, d in zip(vector, "123", strict=True):
                    assert same(written, row[f"{family}{d}{pair}"]), (family, d)
                if family != "CFS":
                    assert same(size, row[f"{family}M{pair}"])
            for written, d in zip(request["totals"][CENTRE], "123", strict=True):
                assert same(written, row[f"XN{d}{pair}"])
            assert same(*request["totals"][AREA], row[f"CAREA{pair}"])
    statuses = {row["status"] for row in rows}
    assert checked == 6 * len(rows) and statuses == {"OP", "CL"}, "open points keep their COPEN"
    assert any(float(row["COPEN"]) > 0 for row in rows if row["status"] == "OP")


def test_nodal_records_are_the_node_table(job):
    result, _, blocks = job
    rows = result.table("nodes")
    assert len(blocks) == 5
    for block in blocks:
        _, step, increment = times(block)
        table = {row["node"]: row for row in at(rows, step, increment)}
        for key, name in ((101, "U"), (104, "RF")):
            records = [record for record in block if record.key == key]
            assert len(records) == len(table)
            for record in records:
                row = table[str(record.attributes[0])]
                assert all(same(word, row[f"{name}{d}"]) for word, d in zip(record.written[1:], "123", strict=True))


def test_stresses_are_those_of_the_printed_table(job):
    result, _, blocks = job
    printed = (result.folder / "punch.dat").read_text().rpartition("(STRESSES AVERAGED AT NODES)")[2]
    lines = [line.split() for line in printed.splitlines()]
    table = {int(words[0]): words[1:] for words in lines if len(words) == 7 and words[0].isdigit()}
    block = iter(blocks[-1])
    found = 0
    for record in block:
        if record.key != 1:
            continue
        node, point, section, place, _, direct, shear, *_ = record.attributes
        assert (point, section, place, direct, shear) == (0, 0, 4, 3, 3)
        stress = next(block)
        assert stress.key == 11 and len(stress.reals) == 6
        assert [f"{value:.6E}" for value in stress.reals] == table[node]
        found += 1
    assert found == len(table) > 100


def test_damage_is_noticed(job, tmp_path):
    result, _, _ = job
    text = (result.folder / "punch.fil").read_text()
    for damaged in (text.replace("I 41504", "I 41505 ", 1), text[:-81], text.replace("*I 18", "*I 19", 1), text[100:]):
        path = tmp_path / "damaged.fil"
        path.write_text(damaged)
        with pytest.raises((reader.FormError, ValueError)):
            reader.read(path)


RIGID = """*NODE
1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n5, 0, 0, 1\n6, 1, 0, 1\n7, 1, 1, 1\n8, 0, 1, 1
101, -1, -1, 1\n102, 2, -1, 1\n103, 2, 2, 1\n104, -1, 2, 1\n900, 0.5, 0.5, 2\n11, 5, 0, 0\n12, 6, 0, 0
*ELEMENT, TYPE=C3D8, ELSET=BLOCK
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=R3D4, ELSET=PLATE
10, 101, 102, 103, 104
*ELEMENT, TYPE=SPRING1, ELSET=SPRINGS
20, 11
*ELEMENT, TYPE=GAPUNI, ELSET=GAPS
30, 11, 12
*SPRING, ELSET=SPRINGS
1
400.
*GAP, ELSET=GAPS
0.05, 1., 0., 0.
*RIGID BODY, REF NODE=900, ELSET=PLATE
*NSET, NSET=REF
900
*NSET, NSET=BOTTOM
1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*SOLID SECTION, ELSET=BLOCK, MATERIAL=M
*SURFACE, NAME=TOP
BLOCK, S2
*SURFACE, NAME=PLANE
PLATE, SNEG
*SURFACE INTERACTION, NAME=I
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
1000.
*CONTACT PAIR, INTERACTION=I, TYPE=NODE TO SURFACE, SMALL SLIDING
TOP, PLANE
*BOUNDARY
BOTTOM, 1, 3
REF, 1, 6
12, 1, 3
11, 2, 3
*STEP
*STATIC, DIRECT
0.5, 1.
*BOUNDARY
REF, 3, 3, -0.02
REF, 4, 4, 0.001
*CLOAD
11, 1, 40.
*NODE FILE, NSET=REF
U, RF
*EL FILE, ELSET=GAPS
S, E
*CONTACT PRINT
CSTRESS
*END STEP
"""


def test_reference_nodes_have_six_components_and_contact_elements_their_opening(write_deck, tmp_path):
    result = support.run(write_deck(RIGID), tmp_path)
    head, blocks = reader.read(tmp_path / "deck.fil")
    (directions,) = [record.attributes for record in head if record.key == 1902]
    assert directions[:7] == [1, 2, 3, 4, 5, 6, 0]
    assert len([record for record in head if record.key == 1901]) == result.summary()["size"]["nodes"] == 15
    faces = [record.attributes[:2] for record in head if record.key == 1502]
    assert sorted(faces) == [[1, 2], [10, 8]], "the top of the block, the negative side of the plate"
    last = blocks[-1]
    row = result.table("nodes")[-1]
    for key, names in ((101, ("U", "UR")), (104, ("RF", "RM"))):
        (record,) = [record for record in last if record.key == key]
        columns = [f"{name}{d}" for name in names for d in "123"]
        assert record.attributes[0] == 900
        assert all(same(word, row[column]) for word, column in zip(record.written[1:], columns, strict=True))
    # 400 times 0.05 is carried by the spring, the rest of 40 by the gap; the plate turns by 0.001.
    (stress,), (strain,) = ([r for r in last if r.key == key] for key in (11, 21))
    assert stress.reals == pytest.approx([20.0, 0.0, 0.0]) and strain.reals == [0.0, 0.0, 0.0]
    gap = next(row for row in result.last("contact") if row["pair"] == "GAPS")
    assert same(stress.written[0], gap["CPRESS"]) and same(strain.written[0], gap["COPEN"])
    assert float(row["UR1"]) == 0.001 and float(row["RM1"]) > 0.0
