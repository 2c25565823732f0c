"""What becomes of every contact deck of CalculiX's collection: the table of docs/calculix-decks.md.

    PYTHONPATH=tests .venv/bin/python -m peers.survey [FOLDER] [--write]

FOLDER holds the decks, packed or not; without it they are looked for where the package puts them. Refusals come from
`overclosure check --dialect calculix`. What stands behind `solved` or `differs` in the document was found by solving
(`peers.deviations`) and is kept as long as the deck is accepted.
"""

import argparse
import re
import tempfile
from dataclasses import dataclass
from pathlib import Path

import support
from peers import collection, dat

DOCUMENT = support.ROOT / "docs" / "calculix-decks.md"
START, END = "<!-- table: survey -->\n", "<!-- end of the table -->"
CONTACT = re.compile(r"^\*\s*CONTACT\s*PAIR|^\*\s*ELEMENT\s*,.*GAPUNI", re.IGNORECASE | re.MULTILINE)
FINDING = re.compile(r": error: (\*[^:]*): (.*)$")

# What a refusal is about: the keyword, a part of the message, and the words of the table. The first that fits counts.
REASONS = (
    ("*FRICTION", "", "friction"),
    ("*CHANGE FRICTION", "", "friction that changes"),
    ("*CHANGE SURFACE BEHAVIOR", "", "a law that changes"),
    ("*SURFACE BEHAVIOR", "TIED", "tied contact"),
    ("*CONTACT DAMPING", "", "contact damping"),
    ("*CONTACT PAIR", "midside nodes", "a secondary surface with midside nodes"),
    ("*MODEL CHANGE", "", "contact that is switched off and on"),
    ("*GAP CONDUCTANCE", "", "heat transfer"),
    ("*GAP", "", "gap elements"),
    ("*ELEMENT", "type C", "axisymmetric or plane elements"),
    ("*ELEMENT", "type S", "shells"),
    ("*ELEMENT", "type B", "beams"),
    ("*SHELL SECTION", "", "shells"),
    ("*SURFACE", "SPOS", "shells"),
    ("*BEAM SECTION", "", "beams"),
    ("*DYNAMIC", "", "dynamics"),
    ("*MODAL DYNAMIC", "", "eigenmodes"),
    ("*FREQUENCY", "", "eigenmodes"),
    ("*STEP", "PERTURBATION", "eigenmodes"),
    ("*HEAT TRANSFER", "", "heat transfer"),
    ("*COUPLED TEMPERATURE-DISPLACEMENT", "", "heat transfer"),
    ("*BOUNDARY", "11 to 11", "heat transfer"),
    ("*BOUNDARY", "OP=NEW", "supports that are taken away"),
    ("*TEMPERATURE", "", "temperatures"),
    ("*TIE", "", "tied surfaces"),
    ("*CYCLIC SYMMETRY MODEL", "", "cyclic symmetry"),
    ("*SELECT CYCLIC SYMMETRY MODES", "", "cyclic symmetry"),
    ("*TRANSFORM", "", "local axes"),
    ("*PRE-TENSION SECTION", "", "pre-tension"),
    ("*PLASTIC", "", "plasticity"),
    ("*SURFACE", "defined twice", "a node-based and an element-based surface of one name"),
    ("*SOLID SECTION", "already", "elements with two sections"),
    ("*SOLID SECTION", "of this kind", "elements with two sections"),
)
# Their meaning hangs on the TYPE of the card.
INITIAL = {"TEMPERATURE": "temperatures", "VELOCITY": "dynamics", "STRESS": "initial stresses"}


@dataclass(frozen=True)
class Row:
    """A deck of the table."""

    name: str
    has: str
    outcome: str


def texts(folder):
    """Text of every contact deck by its name, in order."""
    found = {}
    for path in sorted(path for pattern in ("*.inp", "*.inp.gz") for path in folder.glob(pattern)):
        text = dat.read_text(path)
        if CONTACT.search(text):
            found[path.name.split(".inp")[0]] = text
    return dict(sorted(found.items()))


def words(text, keyword, parameter):
    """Values of a parameter on the cards of a keyword, upper case without blanks, in order, each once."""
    card = re.compile(rf"^\*{keyword}\b([^\n]*)$", re.MULTILINE)
    value = re.compile(rf",{parameter}=([^,]*)")
    packed = re.sub(r"[ \t\r]", "", text).upper()
    return list(dict.fromkeys(v for c in card.findall(packed) for v in value.findall(c)))


def has(text):
    """Elements, pairs, laws and steps of a deck."""
    packed = re.sub(r"[ \t\r]", "", text).upper()
    pairs = {"NODETOSURFACE": "node-to-surface", "SURFACETOSURFACE": "surface-to-surface"}
    parts = [", ".join(words(text, "ELEMENT", "TYPE"))]
    parts += [", ".join(pairs.get(t, t.lower()) for t in words(text, "CONTACTPAIR", "TYPE"))]
    parts += [", ".join(w.lower() for w in words(text, "SURFACEBEHAVIOR", "PRESSURE-OVERCLOSURE"))]
    flags = {"ADJUST": r",ADJUST=", "NLGEOM": r"^\*STEP.*NLGEOM", "equations": r"^\*EQUATION"}
    parts += [flag for flag, pattern in flags.items() if re.search(pattern, packed, re.MULTILINE)]
    return "; ".join(part for part in parts if part)


def reason(keyword, message, text):
    """Words of the table for a finding of `check`."""
    if keyword == "*INITIAL CONDITIONS":
        return next(
            (INITIAL[t] for t in words(text, "INITIALCONDITIONS", "TYPE") if t in INITIAL), "initial conditions"
        )
    for known, fragment, shown in REASONS:
        if keyword == known and fragment in message:
            return shown
    return f"{keyword}: {message}"


def outcome(name, text, before):
    """What becomes of a deck; `before` is what the document says."""
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder) / f"{name}.inp"
        deck.write_text(text, encoding="latin-1")
        done = support.call("check", "--dialect", "calculix", deck)
    if done.returncode == 0:
        return before if before.startswith(("solved", "differs")) else "solved"
    findings = [match.groups() for match in map(FINDING.search, done.stderr.splitlines()) if match]
    if not findings:
        raise AssertionError(f"{name}: exit {done.returncode} without a reason\n{done.stdout}\n{done.stderr}")
    upper = [
        (keyword, message if keyword != "*ELEMENT" else message.upper().replace("TYPE", "type"))
        for keyword, message in findings
    ]
    return "refused: " + ", ".join(dict.fromkeys(reason(keyword, message, text) for keyword, message in upper))


def documented():
    """Rows of the document by name."""
    table = DOCUMENT.read_text(encoding="utf-8").split(START)[1].split(END)[0]
    cells = [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in table.splitlines()[2:]]
    return {row[0]: Row(*row) for row in cells if len(row) == 3}


def survey(folder):
    """Rows of all contact decks of a folder."""
    before = documented()
    unknown = Row("", "", "")
    return [Row(n, has(text), outcome(n, text, before.get(n, unknown).outcome)) for n, text in texts(folder).items()]


def main():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, help="folder of the decks")
    parser.add_argument("--write", action="store_true", help="write the table into the document")
    options = parser.parse_args()
    folder = options.folder or collection.folder()
    if folder is None:
        parser.error(f"the decks are not installed: {collection.PACKAGE}, or name their folder")
    rows = survey(folder)
    table = "| deck | what it has | outcome |\n|---|---|---|\n"
    table += "".join(f"| {row.name} | {row.has} | {row.outcome} |\n" for row in rows)
    if options.write:
        before, rest = DOCUMENT.read_text(encoding="utf-8").split(START)
        DOCUMENT.write_text(before + START + table + END + rest.split(END)[1], encoding="utf-8")
    else:
        print(table, end="")
    print(f"{len(rows)} decks, {sum(not row.outcome.startswith('refused') for row in rows)} accepted")


if __name__ == "__main__":
    main()
