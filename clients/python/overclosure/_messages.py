"""Messages of the protocol. Field order is wire order; the golden vectors check it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar

import numpy as np

from ._postcard import Blob, Bool, Choice, Float, Floats, Labels, Many, Optional, Schema, Struct, Text, Unsigned

U32 = Annotated[int, Unsigned(32)]
U64 = Annotated[int, Unsigned(64)]
F64 = Annotated[float, Float()]
Truth = Annotated[bool, Bool()]
String = Annotated[str, Text()]
Strings = Annotated[list[str], Many(Text())]
State = Annotated[bytes, Blob()]
FloatArray = Annotated["np.ndarray[Any, np.dtype[np.float64]]", Floats()]
LabelArray = Annotated["np.ndarray[Any, np.dtype[np.uint32]]", Labels()]


def _no_numbers() -> np.ndarray[Any, np.dtype[np.float64]]:
    return np.empty(0)


def _no_labels() -> np.ndarray[Any, np.dtype[np.uint32]]:
    return np.empty(0, np.uint32)


@dataclass
class Finding:
    """A finding about a deck: severity (``warning``, ``error``), line, keyword, what is wrong, what to do."""

    severity: Annotated[str, Choice("warning", "error")]
    line: U32
    keyword: String
    message: String
    remedy: String

    def __str__(self) -> str:
        """As one line."""
        place = f"line {self.line}: " if self.line else ""
        keyword = f"{self.keyword}: " if self.keyword else ""
        remedy = f"; {self.remedy}" if self.remedy else ""
        return f"{place}{self.severity}: {keyword}{self.message}{remedy}"


FAULT_CODES = (
    "bad_request",
    "unsupported_encoding",
    "too_large",
    "unknown_verb",
    "wildcard_key",
    "unknown_session",
    "unknown_port",
    "unknown_field",
    "not_finite",
    "time_in_past",
    "deck_refused",
    "law_refused",
    "sequence_gap",
    "sequence_expired",
    "sequence_conflict",
    "busy",
    "limit_exceeded",
    "checkpoint_refused",
    "preload_stopped",
    "session_failed",
    "shutting_down",
    "internal",
)


@dataclass
class FaultDetails:
    """What a program needs beside the text of a fault."""

    findings: Annotated[list[Finding], Many(Struct(Finding))]
    sequence_expected: Annotated[int | None, Optional(Unsigned(64))]
    limit: Annotated[int | None, Optional(Unsigned(64))]


@dataclass
class FaultMessage:
    """The error reply of every verb."""

    SCHEMA: ClassVar = Schema("Fault")
    code: Annotated[str, Choice(*FAULT_CODES)]
    message: String
    retryable: Truth
    details: FaultDetails


@dataclass
class Limits:
    """Limits of a daemon."""

    sessions: U32
    queue: U32
    message_bytes: U64
    increments_per_request: U32
    law_points: U32
    replies_kept: U32
    threads: U32
    idle_seconds: F64


@dataclass
class Info:
    """Who answers, in which version, with which limits."""

    SCHEMA: ClassVar = Schema("Info", 2)
    daemon: String
    product: String
    version: String
    protocol: U32
    encodings: Strings
    law_kinds: Strings
    dialects: Strings
    limits: Limits


@dataclass
class Health:
    """Whether a daemon takes work (``ready`` or ``draining``)."""

    SCHEMA: ClassVar = Schema("Health")
    status: Annotated[str, Choice("ready", "draining")]
    uptime_seconds: F64
    sessions_failed: U64
    frames_dropped: U64


@dataclass
class SessionSummary:
    """A session as ``load`` lists it."""

    session: String
    label: String
    working: Truth
    waiting: U32
    sequence_next: U64
    time: F64
    idle_seconds: F64


@dataclass
class Load:
    """How busy a daemon is."""

    SCHEMA: ClassVar = Schema("Load", 2)
    sessions_free: U32
    steps: U64
    increments: U64
    models: U32
    sessions: Annotated[list[SessionSummary], Many(Struct(SessionSummary))]


@dataclass
class FieldShape:
    """A field of a message, or a variant of an enum."""

    name: String
    kind: String
    meaning: String


@dataclass
class MessageShape:
    """The fields of a message in wire order."""

    name: String
    purpose: String
    fields: Annotated[list[FieldShape], Many(Struct(FieldShape))]


@dataclass
class SchemaReply:
    """Everything that travels."""

    SCHEMA: ClassVar = Schema("SchemaReply")
    messages: Annotated[list[MessageShape], Many(Struct(MessageShape))]


@dataclass
class Parameter:
    """A parameter of a law, as text."""

    name: String
    value: String


@dataclass
class LawRequest:
    """Evaluate a law."""

    SCHEMA: ClassVar = Schema("LawRequest")
    kind: String
    parameters: Annotated[list[Parameter], Many(Struct(Parameter))]
    overclosure: FloatArray


@dataclass
class LawReply:
    """An evaluated law; the arrays that its kind does not have are empty."""

    SCHEMA: ClassVar = Schema("LawReply", 2)
    kind: String
    overclosure: FloatArray
    pressure: FloatArray
    stiffness: FloatArray
    energy: FloatArray
    coefficient: FloatArray
    coefficient_slope: FloatArray


@dataclass
class InputValue:
    """A value for an input, by name."""

    name: String
    value: F64


@dataclass
class OpenRequest:
    """Open a session."""

    SCHEMA: ClassVar = Schema("OpenRequest")
    token: String
    label: String
    dialect: Annotated[str, Choice("abaqus", "calculix")]
    path: Annotated[str, Choice("auto", "dense", "sparse")]
    threads: U32
    ports_toml: Annotated[str | None, Optional(Text())]
    magnitudes: Annotated[list[InputValue], Many(Struct(InputValue))]
    deck: String


QUANTITIES = (
    "length",
    "force",
    "pressure",
    "acceleration",
    "area",
    "energy",
    "time",
    "count",
    "angle",
    "moment",
    "velocity",
    "angular_velocity",
    "angular_acceleration",
)


@dataclass
class Port:
    """A scalar port."""

    name: String
    quantity: Annotated[str, Choice(*QUANTITIES)]
    unit: Annotated[str | None, Optional(Text())]
    description: String


@dataclass
class Ports:
    """Inputs and outputs, in the order in which values are exchanged."""

    SCHEMA: ClassVar = Schema("Ports")
    inputs: Annotated[list[Port], Many(Struct(Port))]
    outputs: Annotated[list[Port], Many(Struct(Port))]


@dataclass
class OpenReply:
    """An open session."""

    SCHEMA: ClassVar = Schema("OpenReply")
    session: String
    sequence_next: U64
    time: F64
    time_end: F64
    warnings: Annotated[list[Finding], Many(Struct(Finding))]
    audit: Strings
    ports: Ports
    outputs: FloatArray


@dataclass
class StepRequest:
    """Set inputs and advance."""

    SCHEMA: ClassVar = Schema("StepRequest")
    sequence: U64
    time: F64
    frames: Strings = field(default_factory=list)
    inputs: Annotated[list[InputValue], Many(Struct(InputValue))] = field(default_factory=list)
    indices: LabelArray = field(default_factory=_no_labels)
    values: FloatArray = field(default_factory=_no_numbers)


@dataclass
class Counts:
    """Work done."""

    increments: U32
    equilibrium_iterations: U32
    severe_discontinuity_iterations: U32
    cutbacks: U32
    factorizations: U32
    augmentations: U32
    impacts: U32


@dataclass
class StepReply:
    """Result of a step."""

    SCHEMA: ClassVar = Schema("StepReply", 3)
    sequence: U64
    status: Annotated[str, Choice("reached", "stopped", "increment_limit", "cancelled")]
    reason: String
    time: F64
    counts: Counts
    audit: Strings
    outputs: FloatArray


@dataclass
class GetRequest:
    """Read ports."""

    SCHEMA: ClassVar = Schema("GetRequest")
    names: Strings


@dataclass
class NamedValue:
    """A value by name."""

    name: String
    value: F64


@dataclass
class GetReply:
    """Present values."""

    SCHEMA: ClassVar = Schema("GetReply")
    sequence_next: U64
    time: F64
    time_end: F64
    inputs: Annotated[list[NamedValue], Many(Struct(NamedValue))]
    outputs: Annotated[list[NamedValue], Many(Struct(NamedValue))]


@dataclass
class FieldRequest:
    """Read a field."""

    SCHEMA: ClassVar = Schema("FieldRequest")
    name: String


@dataclass
class FieldMessage:
    """A field, row by row."""

    SCHEMA: ClassVar = Schema("Field")
    name: String
    time: F64
    components: U32
    labels: LabelArray
    values: FloatArray


@dataclass
class Checkpoint:
    """A state."""

    SCHEMA: ClassVar = Schema("Checkpoint")
    time: F64
    state: State


@dataclass
class RestoreRequest:
    """Return to a state."""

    SCHEMA: ClassVar = Schema("RestoreRequest")
    sequence: U64
    state: State


@dataclass
class RestoreReply:
    """The state returned to."""

    SCHEMA: ClassVar = Schema("RestoreReply")
    sequence: U64
    time: F64
    outputs: FloatArray


@dataclass
class StepSummary:
    """What a step of the deck has done so far."""

    name: String
    procedure: String
    time_reached: F64
    counts: Counts


@dataclass
class Report:
    """Steps so far, work and findings."""

    SCHEMA: ClassVar = Schema("Report", 3)
    session: String
    sequence_next: U64
    time: F64
    steps: Annotated[list[StepSummary], Many(Struct(StepSummary))]
    audit: Strings
    warnings: Annotated[list[Finding], Many(Struct(Finding))]


@dataclass
class CloseReply:
    """A session that ended."""

    SCHEMA: ClassVar = Schema("CloseReply")
    session: String
    time: F64


@dataclass
class FrameMessage:
    """Published per increment."""

    SCHEMA: ClassVar = Schema("Frame")
    number: U64
    sequence: U64
    step: U32
    increment: U32
    time: F64
    field: String
    components: U32
    labels: LabelArray
    values: FloatArray


MESSAGES: tuple[type[Any], ...] = (
    FaultMessage,
    Info,
    Health,
    Load,
    SchemaReply,
    LawRequest,
    LawReply,
    OpenRequest,
    OpenReply,
    Ports,
    StepRequest,
    StepReply,
    GetRequest,
    GetReply,
    FieldRequest,
    FieldMessage,
    Checkpoint,
    RestoreRequest,
    RestoreReply,
    Report,
    CloseReply,
    FrameMessage,
)
