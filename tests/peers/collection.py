"""Where the decks of CalculiX's own collection are on this machine, if they are (Debian package calculix-ccx-test)."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

from peers.dat import read_text

PACKAGE = "calculix-ccx-test"


def folder():
    """Folder of the decks: CALCULIX_TESTS, or where the package put them; nothing when there are none."""
    named = os.environ.get("CALCULIX_TESTS")
    if named:
        return Path(named)
    if shutil.which("dpkg"):
        done = subprocess.run(["dpkg", "-L", PACKAGE], capture_output=True, text=True, check=False)
        for line in done.stdout.splitlines():
            if Path(line).name == "contact3.inp":
                return Path(line).parent
    return None


def required():
    """The folder; a test that needs it is skipped, with the reason, where it is missing."""
    found = folder()
    if found is None:
        pytest.skip(f"the decks of CalculiX are not installed ({PACKAGE}, or set CALCULIX_TESTS to their folder)")
    return found


def text_of(name):
    """Text of a file of the collection, packed or not."""
    base = required()
    for path in (base / name, base / f"{name}.gz"):
        if path.is_file():
            return read_text(path)
    raise FileNotFoundError(f"{base} has no {name}")
