"""The connection to one daemon."""

from __future__ import annotations

import os
import uuid
import weakref
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from ._call import Patience, call, open_session
from ._deck import read_deck, read_ports
from ._errors import Fault
from ._messages import (
    FaultDetails,
    FaultMessage,
    GetReply,
    Health,
    Info,
    InputValue,
    LawReply,
    LawRequest,
    Load,
    OpenReply,
    OpenRequest,
    Parameter,
    Ports,
)
from ._postcard import encode
from ._session import Session
from ._values import LawCurve

T = TypeVar("T")
DEFAULT_ENDPOINT = "tcp/127.0.0.1:7447"
LawParameter = str | float | int | Sequence[tuple[float, float]]


def connect(
    endpoint: str = DEFAULT_ENDPOINT,
    *,
    daemon: str | None = None,
    timeout_connect: float = 2.0,
    timeout: float = 10.0,
    timeout_work: float = 3600.0,
    attempts: int = 5,
) -> Client:
    """Connect to a daemon.

    Args:
        endpoint: where it listens.
        daemon: its id; the one that answers unless given.
        timeout_connect: seconds to keep trying to connect.
        timeout: seconds to wait for calls that do no solving.
        timeout_work: seconds to wait for open, step, restore and field. A daemon that dies is noticed at once.
        attempts: how often to ask before an unanswered or busy call fails.

    Raises:
        Unavailable: nobody is there.

    """
    return Client(endpoint, daemon, timeout_connect, Patience(timeout, attempts), Patience(timeout_work, attempts))


class Client:
    """A connection to one daemon; a context manager. Made by :func:`connect`."""

    def __init__(
        self, endpoint: str, daemon: str | None, timeout_connect: float, quick: Patience, work: Patience
    ) -> None:
        """Connect; use :func:`connect`."""
        self._quick = quick
        self._work = work
        self._zenoh = open_session(endpoint, timeout_connect)
        # Also when the program ends without closing: the transport must not outlive the interpreter.
        self._finalizer = weakref.finalize(self, self._zenoh.close)
        try:
            self._info = call(self._zenoh, f"overclosure/v1/{daemon or '*'}/info", Info, "", None, quick)
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> Client:
        """Nothing more to do."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the connection; sessions stay open in the daemon."""
        self.close()

    @property
    def daemon(self) -> str:
        """Id of the daemon."""
        return self._info.daemon

    def info(self) -> Info:
        """Who answers, in which version, with which limits."""
        self._info = self._ask("info", Info)
        return self._info

    def health(self) -> Health:
        """Whether the daemon is well."""
        return self._ask("health", Health)

    def load(self) -> Load:
        """How busy the daemon is, and its sessions."""
        return self._ask("load", Load)

    def law(self, kind: str, params: Mapping[str, LawParameter], overclosures: npt.ArrayLike) -> LawCurve:
        """Evaluate a pressure-overclosure relationship, or contact damping.

        Args:
            kind: ``linear``, ``tabular``, ``exponential``, ``penalty``, ``damping``, ...; see ``info().law_kinds``.
            params: parameters by name, e.g. ``{"c0": 0.01, "p0": 5}``; a table as text (``"p1:h1,p2:h2"``) or as a
                sequence of (pressure, overclosure) pairs.
            overclosures: positive when the bodies overlap [length]; any shape, evaluated flat.

        Raises:
            Fault: ``law_refused`` with the reasons, ``not_finite``, ``limit_exceeded``.

        """
        parameters = [Parameter(name, _parameter(value)) for name, value in params.items()]
        flat = np.ravel(np.asarray(overclosures, dtype=np.float64))
        request = LawRequest(kind, parameters, flat)
        reply = self._request(f"overclosure/v1/{self.daemon}/law", request, LawReply, self._quick)
        return LawCurve(
            reply.kind,
            reply.overclosure,
            reply.pressure,
            reply.stiffness,
            reply.energy,
            reply.coefficient,
            reply.coefficient_slope,
        )

    def open(
        self,
        deck: str | os.PathLike[str],
        *,
        label: str | None = None,
        dialect: str = "abaqus",
        path: str = "auto",
        threads: int = 1,
        ports_toml: str | None = None,
        magnitudes: Mapping[str, float] | None = None,
    ) -> Session:
        """Open a session: the daemon reads the deck, prepares it and runs every step but the last.

        A session that gets no request for ``info().limits.idle_seconds`` is closed by the daemon; any request, such as
        :meth:`Session.get`, keeps it alive.

        Args:
            deck: a path, or the text of a deck (recognised by its line breaks). Files that a deck at a path includes
                are put in their places, relative to the including file, and lines of findings count that text. A text
                has no folder: ``*INCLUDE`` in it is refused.
            label: name for people; the file name unless given.
            dialect: ``abaqus`` or ``calculix``.
            path: solver path, ``auto``, ``dense`` or ``sparse``.
            threads: for the preparation; the numbers do not depend on it.
            ports_toml: text of a ``ports.toml``. Unless given, a deck at a path takes ``DECKNAME.ports.toml`` or
                ``ports.toml`` beside it, the first that is there. An empty text keeps the names of the deck.
            magnitudes: inputs whose deck magnitude is replaced while the deck's amplitude is kept.

        Raises:
            Fault: ``deck_refused`` with every diagnostic in ``findings``, ``preload_stopped``, ...
            OSError: a file cannot be read.
            IncludeError: a file that it includes cannot be put in.

        """
        if isinstance(deck, str) and ("\n" in deck or "\r" in deck or not deck.strip()):
            text, name = deck, ""
        else:
            text, name = read_deck(Path(deck)), Path(deck).name
            if ports_toml is None:
                ports_toml = read_ports(Path(deck))
        request = OpenRequest(
            token=uuid.uuid4().hex,
            label=name if label is None else label,
            dialect=dialect,
            path=path,
            threads=threads,
            ports_toml=ports_toml,
            magnitudes=[InputValue(n, float(v)) for n, v in (magnitudes or {}).items()],
            deck=text,
        )
        reply = self._request(f"overclosure/v1/{self.daemon}/open", request, OpenReply, self._work)
        return Session(self, reply)

    def attach(self, session: str) -> Session:
        """Take up a session that is already open, by its id.

        Raises:
            Fault: ``unknown_session``.

        """
        base = f"overclosure/v1/{self.daemon}/s/{session}"
        ports = call(self._zenoh, f"{base}/ports", Ports, "", None, self._quick)
        now = call(self._zenoh, f"{base}/get", GetReply, "", None, self._quick)
        outputs = np.array([v.value for v in now.outputs])
        return Session(self, OpenReply(session, now.sequence_next, now.time, now.time_end, [], [], ports, outputs))

    def close(self) -> None:
        """Close the connection; sessions stay open in the daemon."""
        self._finalizer()

    def _ask(self, verb: str, reply: type[T]) -> T:
        return call(self._zenoh, f"overclosure/v1/{self.daemon}/{verb}", reply, "", None, self._quick)

    def _request(self, key: str, request: object, reply: type[T], patience: Patience) -> T:
        payload = encode(request)
        limit = self._info.limits.message_bytes
        if len(payload) > limit:
            text = f"the request has {len(payload)} bytes, the daemon accepts {limit}"
            raise Fault(FaultMessage("too_large", text, False, FaultDetails([], None, limit)))
        schema = str(getattr(type(request), "SCHEMA"))  # noqa: B009
        return call(self._zenoh, key, reply, schema, payload, patience)


def _parameter(value: LawParameter) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, Sequence):
        return ",".join(f"{float(point[0])!r}:{float(point[1])!r}" for point in value)
    return repr(float(value))
