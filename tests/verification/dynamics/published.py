"""Tables of measured figures in tests/README.md: made by a script, held to what tests measure."""

from pathlib import Path

README = Path(__file__).resolve().parents[2] / "README.md"


def markers(name):
    """Begin and end of a table."""
    return f"<!-- {name}: generated -->\n", f"<!-- end of {name} -->"


def markdown(header, rows):
    """Lines of a table."""
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join([*lines, *("| " + " | ".join(map(str, row)) + " |" for row in rows)]) + "\n"


def shown(name):
    """The table as it stands."""
    begin, end = markers(name)
    return README.read_text(encoding="utf-8").split(begin)[1].split(end)[0]


def write(name, table):
    """Puts a table into the README."""
    begin, end = markers(name)
    before, rest = README.read_text(encoding="utf-8").split(begin)
    README.write_text(before + begin + table + end + rest.split(end)[1], encoding="utf-8")
