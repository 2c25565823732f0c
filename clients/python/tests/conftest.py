"""A daemon for the tests: the executable at OVERCLOSURE_BINARY, or the release build of this checkout."""

import os
import subprocess
from pathlib import Path

import pytest

import overclosure

ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def endpoint():
    binary = Path(os.environ.get("OVERCLOSURE_BINARY", ROOT / "target" / "release" / "overclosure"))
    assert binary.exists(), f"{binary} is not there; build it with: cargo build --release -p overclosure-daemon"
    command = [binary, "serve", "--listen", "tcp/127.0.0.1:0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as daemon:
        try:
            line = daemon.stdout.readline()
            assert " on tcp/" in line, line
            yield line.rsplit(" on ", 1)[1].strip()
        finally:
            daemon.terminate()
            code = daemon.wait(30)
    assert code == 0, "SIGTERM ends the daemon with success"


@pytest.fixture
def client(endpoint):
    with overclosure.connect(endpoint, attempts=1) as client:
        yield client


@pytest.fixture
def deck():
    return ROOT / "examples" / "two_blocks.inp"
