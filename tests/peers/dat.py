"""Tables of a `.dat` file of CalculiX: displacements and other blocks, and how far two of them lie apart."""

import gzip
import re
from dataclasses import dataclass
from pathlib import Path

TITLE = re.compile(
    r"^\s*(?P<what>[a-z][^()]*?)\s*\(.*\bset\s+(?P<name>\S+)\s+and time\s+(?P<time>\S+)\s*$", re.IGNORECASE
)


@dataclass(frozen=True)
class Block:
    """One table: what it holds, its set, its time, and rows of numbers by node (by element and point for stresses)."""

    what: str
    name: str
    time: float
    rows: dict

    def largest(self):
        """Largest absolute number of the block."""
        return max((abs(value) for row in self.rows.values() for value in row), default=0.0)


def read_text(path):
    """Text of a file, unpacked where its name ends in .gz."""
    path = Path(path)
    if path.suffix == ".gz":
        return gzip.decompress(path.read_bytes()).decode("latin-1")
    return path.read_text(encoding="latin-1")


def blocks(text):
    """Blocks of a file in their order. Lines that are neither a title nor numbers end a block."""
    found, title, rows = [], None, {}
    for line in [*text.splitlines(), "end"]:
        words = line.split()
        if not words:
            continue
        match = TITLE.match(line)
        numbers = None if match else as_numbers(words)
        if numbers is None:
            if title and rows:
                found.append(Block(title["what"], title["name"].upper(), float(title["time"]), rows))
            title, rows = match, {}
        elif title:
            keys = 2 if title["what"].startswith("stresses") else 1
            rows[tuple(int(word) for word in words[:keys])] = numbers[keys:]
    return found


def as_numbers(words):
    """The words as numbers, or nothing."""
    try:
        return [float(word) for word in words]
    except ValueError:
        return None


def displacements(text):
    """Displacement blocks: by (set, time)."""
    return {(b.name, b.time): b for b in blocks(text) if b.what == "displacements"}


def deviation(block, computed):
    """Largest difference of a block and computed rows (by node), over the largest number of the block."""
    missing = [key for key in block.rows if key not in computed]
    if missing:
        raise KeyError(f"no values for {missing[:5]}")
    largest = max(abs(a - b) for key, row in block.rows.items() for a, b in zip(row, computed[key], strict=True))
    return largest / block.largest()
