"""The golden vectors of the protocol, read by this package as they are by the Rust crate."""

import contextlib
import json
import math
import re
from dataclasses import fields, is_dataclass
from pathlib import Path

import numpy as np
import pytest

from overclosure import DecodeError, _messages
from overclosure._messages import MESSAGES
from overclosure._postcard import Choice, decode, encode, layout

VECTORS = Path(__file__).parents[3] / "protocol" / "vectors"
KINDS = {str(kind.SCHEMA): kind for kind in MESSAGES}


def vectors():
    return [json.loads(path.read_text("utf-8")) for path in sorted(VECTORS.glob("*.json"))]


def number(value):
    return {"NaN": math.nan, "inf": math.inf, "-inf": -math.inf}.get(value, value)


def plain(value):
    """A message as the JSON of the vector has it."""
    if is_dataclass(value):
        return {f.name: plain(getattr(value, f.name)) for f in fields(value)}
    if isinstance(value, bytes):
        return value.hex()
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, list):
        return [plain(v) for v in value]
    return value


def normal(value):
    """The JSON of the vector with its special numbers as numbers."""
    if isinstance(value, dict):
        return {k: normal(v) for k, v in value.items()}
    if isinstance(value, list):
        return [normal(v) for v in value]
    return number(value) if isinstance(value, str) and value in ("NaN", "inf", "-inf") else value


def test_every_vector_has_a_message_and_every_message_a_vector():
    assert sorted(v["message"] for v in vectors()) == sorted(KINDS)


@pytest.mark.parametrize("vector", vectors(), ids=lambda v: v["message"])
def test_golden_bytes_read_and_write_the_same(vector):
    data = bytes.fromhex(vector["postcard"])
    message = decode(KINDS[vector["message"]], data)
    assert plain(message) == normal(vector["json"])
    assert encode(message) == data


@pytest.mark.parametrize("vector", vectors(), ids=lambda v: v["message"])
def test_truncated_and_oversized_bytes_are_refused(vector):
    kind = KINDS[vector["message"]]
    for key in ("truncated", "oversized"):
        with pytest.raises(DecodeError):
            decode(kind, bytes.fromhex(vector[key]))


@pytest.mark.parametrize("vector", vectors(), ids=lambda v: v["message"])
def test_damaged_bytes_are_read_or_refused_but_nothing_else(vector):
    kind = KINDS[vector["message"]]
    data = bytes.fromhex(vector["postcard"])
    for cut in range(len(data)):
        with pytest.raises(DecodeError):
            decode(kind, data[:cut])
    for at in range(len(data)):
        for bit in (0x01, 0x40, 0x80):
            damaged = bytearray(data)
            damaged[at] ^= bit
            with contextlib.suppress(DecodeError):
                decode(kind, bytes(damaged))


def test_a_length_beyond_the_data_is_refused_before_anything_is_allocated():
    # Kind "", then 2**62 overclosures that are not there.
    with pytest.raises(DecodeError, match="cannot fit"):
        decode(KINDS["LawReply/2"], bytes([0, *[0x80] * 8, 0x40]))


def test_arrays_are_views_of_the_received_bytes():
    values = np.arange(1000, dtype=np.float64)
    reply = KINDS["RestoreReply/1"](1, 0.5, values)
    outputs = decode(type(reply), encode(reply)).outputs
    assert outputs.base is not None and not outputs.flags.owndata
    np.testing.assert_array_equal(outputs, values)


def test_labels_of_every_length_survive():
    field = KINDS["Field/1"]
    labels = np.array([0, 1, 127, 128, 16383, 16384, 2**21, 2**28 - 1, 2**28, 2**32 - 1], np.uint32)
    message = field("U", 0.0, 1, labels, np.zeros(labels.size))
    np.testing.assert_array_equal(decode(field, encode(message)).labels, labels)


def test_field_types_are_those_of_the_document():
    text = (VECTORS.parent / "PROTOCOL.md").read_text("utf-8")
    for schema, kind in KINDS.items():
        table = text.split(f"### {schema}\n", 1)[1].split("###", 1)[0]
        names = [line.split("`")[1] for line in table.splitlines() if line.startswith("| `")]
        assert names == [name for name, _ in layout(kind)], schema


@pytest.mark.parametrize(
    ("kind", "field", "name"),
    [
        (_messages.FaultMessage, "code", "FaultCode"),
        (_messages.Health, "status", "HealthStatus"),
        (_messages.OpenRequest, "dialect", "Dialect"),
        (_messages.OpenRequest, "path", "SolverPath"),
        (_messages.Port, "quantity", "Quantity"),
        (_messages.Finding, "severity", "Severity"),
        (_messages.StepReply, "status", "StepStatus"),
    ],
)
def test_choices_are_those_of_the_document(kind, field, name):
    """A variant that only the daemon knows would make its messages unreadable."""
    text = (VECTORS.parent / "PROTOCOL.md").read_text("utf-8")
    table = text.split(f"### {name}\n", 1)[1].split("###", 1)[0].split("<!--")[0]
    wire = dict(layout(kind))[field]
    assert isinstance(wire, Choice)
    assert list(wire.names) == re.findall(r"^\| \d+ \| `(\w+)` \|", table, re.MULTILINE)


def test_every_choice_of_the_document_is_held():
    text = (VECTORS.parent / "PROTOCOL.md").read_text("utf-8")
    enums = re.findall(r"^### (\w+)\n\n[^#]*?^\| tag \|", text, re.MULTILINE)
    assert sorted(enums) == sorted(
        ["FaultCode", "HealthStatus", "Dialect", "SolverPath", "Quantity", "Severity", "StepStatus"]
    )
