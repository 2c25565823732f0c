"""One exchange with the daemon, repeated while nobody answers."""

from __future__ import annotations

import re
import time
from dataclasses import dataclass
from typing import Any, TypeVar

import zenoh

from ._errors import Fault, Timeout, TransportError, Unavailable
from ._messages import FaultMessage
from ._postcard import decode

T = TypeVar("T")
POSTCARD = "application/postcard"
_PAUSE = 0.1
_PAUSE_MAX = 2.0


@dataclass(frozen=True)
class Patience:
    """How long to wait for an answer [s], and how often to ask."""

    timeout: float
    attempts: int


def open_session(endpoint: str, timeout: float) -> zenoh.Session:
    """Connect to an endpoint as a client; no scouting."""
    config = zenoh.Config()
    settings = {
        "mode": '"client"',
        "connect/endpoints": f"[{_json(endpoint)}]",
        "connect/timeout_ms": str(int(timeout * 1000)),
        "connect/retry": "{ period_init_ms: 200, period_max_ms: 2000, period_increase_factor: 2 }",
        "scouting/multicast/enabled": "false",
        "scouting/gossip/enabled": "false",
    }
    try:
        for key, value in settings.items():
            config.insert_json5(key, value)
    except zenoh.ZError as error:
        raise TransportError(f"{endpoint!r} is not a locator such as tcp/127.0.0.1:7447: {plain(error)}") from error
    try:
        return zenoh.open(config)
    except zenoh.ZError:
        # zenoh says no more than that, with places in its source code.
        raise Unavailable(f"no daemon answers at {endpoint}; start one with `overclosure serve`") from None


def plain(error: zenoh.ZError) -> str:
    """Return what zenoh says, without the places in its source code that it adds."""
    return re.sub(r" at /[^ ]*?\.rs:\d+\.", "", str(error))


def call(session: zenoh.Session, key: str, reply: type[T], schema: str, payload: bytes | None, patience: Patience) -> T:
    """Send a request until it is answered or patience ends; the same bytes each time."""
    pause = _PAUSE
    for attempt in range(1, patience.attempts + 1):
        try:
            return _once(session, key, reply, schema, payload, patience.timeout)
        except (Unavailable, Timeout, Fault) as error:
            retryable = error.retryable if isinstance(error, Fault) else True
            if not retryable or attempt == patience.attempts:
                raise
        time.sleep(pause)
        pause = min(2 * pause, _PAUSE_MAX)
    raise ValueError("at least one attempt is needed")


def _once(session: zenoh.Session, key: str, reply: type[T], schema: str, payload: bytes | None, timeout: float) -> T:
    encoding = f"{POSTCARD};{schema}" if schema else POSTCARD
    try:
        replies = session.get(
            key,
            payload=payload,
            encoding=encoding,
            target=zenoh.QueryTarget.BEST_MATCHING,
            consolidation=zenoh.ConsolidationMode.NONE,
            congestion_control=zenoh.CongestionControl.BLOCK,
            priority=zenoh.Priority.INTERACTIVE_HIGH,
            express=True,
            timeout=timeout,
        )
        answer = next(iter(replies), None)
    except zenoh.ZError as error:
        raise TransportError(f"{key}: {plain(error)}") from error
    if answer is None:
        raise Unavailable(f"no daemon answers at {key}")
    if answer.ok is not None:
        check_encoding(str(answer.ok.encoding), reply)
        return decode(reply, answer.ok.payload.to_bytes())
    failure = answer.err
    if failure is not None and str(failure.encoding) == f"{POSTCARD};{FaultMessage.SCHEMA}":
        raise Fault(decode(FaultMessage, failure.payload.to_bytes()))
    # Only the transport itself answers with another encoding: its own timeout.
    raise Timeout(f"no answer from {key} within {timeout} s")


def check_encoding(encoding: str, kind: type[Any]) -> None:
    """Refuse a reply that says that it is something else."""
    expected = f"{POSTCARD};{kind.SCHEMA}"
    if encoding != expected:
        raise TransportError(f"{expected} is expected, this is {encoding}")


def _json(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'
