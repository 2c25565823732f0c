"""A pytest plugin that keeps every deck which the tests of a run solve: `pytest -p invariance.recording tests/verification`.

The folder OVERCLOSURE_RECORD gets NNN.inp and NNN.json: the test, and the arguments of the run.
"""

import itertools
import json
import os
import shutil
from pathlib import Path

import support

FOLDER = "OVERCLOSURE_RECORD"


def pytest_configure(config):
    """Puts a keeper before `support.run`."""
    folder = Path(os.environ[FOLDER])
    solve = support.run
    numbers = itertools.count()

    def keep(deck, out, *arguments, **options):
        name = f"{next(numbers):03d}"
        shutil.copy(deck, folder / f"{name}.inp")
        test = os.environ.get("PYTEST_CURRENT_TEST", "").partition(" ")[0]
        (folder / f"{name}.json").write_text(json.dumps({"test": test, "arguments": list(map(str, arguments))}))
        return solve(deck, out, *arguments, **options)

    support.run = keep
