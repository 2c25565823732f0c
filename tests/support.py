"""What the Python tests share: where the binary is, how to run it, how to read what it wrote."""

import csv
import json
import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DATA = ROOT / "tests" / "data"


def binary():
    """The `overclosure` executable: OVERCLOSURE_BINARY, or the release build of this checkout."""
    path = Path(os.environ.get("OVERCLOSURE_BINARY", ROOT / "target" / "release" / "overclosure"))
    if not path.is_file():
        raise FileNotFoundError(f"{path} is missing; build it with `cargo build --release --workspace`")
    return path


def call(*arguments, timeout=120, **options):
    """Runs the binary and returns the completed process; output as text, any exit code."""
    command = [str(binary()), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=timeout, check=False, **options)


@dataclass
class Result:
    """What `overclosure run` left behind."""

    folder: Path
    job: str

    def summary(self):
        """JOB.json."""
        return json.loads((self.folder / f"{self.job}.json").read_text())

    def table(self, name):
        """Rows of JOB_{name}.csv as dictionaries of text."""
        with open(self.folder / f"{self.job}_{name}.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def last(self, name):
        """Rows of the last output time of a table."""
        rows = self.table(name)
        return [row for row in rows if row["time"] == rows[-1]["time"]]


def run(deck, folder, *arguments, timeout=120):
    """Solves a deck, insists on success, and returns its results."""
    done = call("run", deck, "--out", folder, "--quiet", *arguments, timeout=timeout)
    if done.returncode != 0:
        raise AssertionError(f"overclosure run {deck} ended with {done.returncode}\n{done.stdout}\n{done.stderr}")
    return Result(Path(folder), Path(deck).stem)


def close(actual, expected, relative, scale=None):
    """Whether two numbers agree relative to the expected one, or to `scale` where given."""
    reference = abs(expected) if scale is None else scale
    return abs(actual - expected) <= relative * reference
