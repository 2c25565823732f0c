"""One session in the daemon."""

from __future__ import annotations

import queue
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import TracebackType
from typing import TYPE_CHECKING, TypeVar

import numpy as np
import zenoh

from ._call import call, check_encoding
from ._errors import Fault, TransportError
from ._messages import (
    Checkpoint,
    CloseReply,
    Counts,
    FieldMessage,
    FieldRequest,
    Finding,
    FrameMessage,
    GetReply,
    GetRequest,
    InputValue,
    OpenReply,
    Ports,
    Report,
    RestoreReply,
    RestoreRequest,
    StepReply,
    StepRequest,
)
from ._postcard import decode
from ._values import FloatArray, LabelArray

if TYPE_CHECKING:
    from ._client import Client

T = TypeVar("T")
# Frames that wait for a slow reader; the oldest is dropped first and the numbers show the gap.
FRAMES_WAITING = 1024


@dataclass(frozen=True)
class Step:
    """Result of a step.

    Attributes:
        status: ``reached``, ``stopped`` (not converged: ``reason`` says why), ``increment_limit`` or ``cancelled``.
        reason: why it stopped; empty when it did not.
        time: total time reached.
        counts: work done for this step.
        audit: what the audit of the present solution found; empty when clean.
        outputs: values by port name.
        vector: the same values in port order.

    """

    status: str
    reason: str
    time: float
    counts: Counts
    audit: list[str]
    outputs: dict[str, float]
    vector: FloatArray


@dataclass(frozen=True)
class Field:
    """A field.

    Attributes:
        name: ``U``, ``CPRESS``, ...
        time: total time.
        labels: node label of each row.
        values: one row per label; flat when the field has one component.

    """

    name: str
    time: float
    labels: LabelArray
    values: FloatArray


@dataclass(frozen=True)
class Frame:
    """Results of one increment.

    Attributes:
        number: counts the increments of the session; a gap means frames that were dropped.
        sequence: the step request that it belongs to.
        step: step of the deck, from 1.
        increment: increment within that step, from 1.
        time: total time.
        field: ``outputs`` or the name of a field.
        labels: node labels; empty for ``outputs``.
        values: output vector in port order, or the rows of the field.

    """

    number: int
    sequence: int
    step: int
    increment: int
    time: float
    field: str
    labels: LabelArray
    values: FloatArray


class Session:
    """A session; a context manager that closes it in the daemon.

    Made by :meth:`Client.open` or :meth:`Client.attach`.
    """

    def __init__(self, client: Client, opened: OpenReply) -> None:
        """Take over an open session; use :meth:`Client.open`."""
        self._client = client
        self._opened = opened
        self._names = [p.name for p in opened.ports.outputs]
        self._sequence = opened.sequence_next
        self._closed = False
        self._time = opened.time
        self._outputs = opened.outputs

    def __enter__(self) -> Session:
        """Nothing more to do."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the session. When an error is already on its way, one from closing does not hide it."""
        try:
            self.close()
        except Exception:
            if error is None:
                raise

    def __repr__(self) -> str:
        """Id and time."""
        return f"<overclosure session {self.id} at time {self._time!r}>"

    @property
    def id(self) -> str:
        """Id of the session in the daemon."""
        return self._opened.session

    @property
    def ports(self) -> Ports:
        """Inputs and outputs."""
        return self._opened.ports

    @property
    def warnings(self) -> list[Finding]:
        """Warnings about the deck."""
        return self._opened.warnings

    @property
    def audit(self) -> list[str]:
        """What the audit found when the session was opened."""
        return self._opened.audit

    @property
    def time(self) -> float:
        """Total time reached, as far as this client knows."""
        return self._time

    @property
    def time_end(self) -> float:
        """Total time at which the last step ends by the deck."""
        return self._opened.time_end

    @property
    def sequence(self) -> int:
        """Sequence number that the next step or restore will carry."""
        return self._sequence

    @property
    def outputs(self) -> dict[str, float]:
        """Output values by name after the last step or restore of this client."""
        return dict(zip(self._names, self._outputs.tolist(), strict=True))

    def step(
        self,
        time: float,
        inputs: Mapping[str, float] | Sequence[float] | FloatArray | None = None,
        *,
        frames: Sequence[str] = (),
    ) -> Step:
        """Set inputs and advance to a total time.

        After :class:`Timeout` or :class:`Unavailable` the step may or may not have been done: repeat the same call, or
        take up the present state with :meth:`synchronize`.

        Args:
            time: total time to reach; the present time applies inputs without advancing. Beyond :attr:`time_end` the
                deck has ended: inputs that it drives hold the values of that time, inputs that were set their last
                ones, and nothing is said.
            inputs: actual values at that time, by name, or one for each input in port order.
            frames: fields to publish at the end of each increment.

        Raises:
            Fault: ``unknown_port``, ``not_finite``, ``time_in_past``, ``unknown_session``, ...

        """
        request = StepRequest(self._sequence, float(time), list(frames))
        if isinstance(inputs, Mapping):
            request.inputs = [InputValue(name, float(value)) for name, value in inputs.items()]
        elif inputs is not None:
            request.values = np.asarray(inputs, dtype=np.float64)
            request.indices = np.arange(request.values.size, dtype=np.uint32)
        reply = self._client._request(self._key("step"), request, StepReply, self._client._work)
        self._sequence = reply.sequence + 1
        self._take(reply.time, reply.outputs)
        return Step(reply.status, reply.reason, reply.time, reply.counts, reply.audit, self.outputs, reply.outputs)

    def get(self, *names: str) -> dict[str, float]:
        """Present values of ports, inputs or outputs; of all when no name is given."""
        reply = self._get(list(names))
        return {v.name: v.value for v in [*reply.inputs, *reply.outputs]}

    def synchronize(self) -> None:
        """Ask the daemon for the present time, outputs and sequence number."""
        reply = self._get([])
        self._sequence = reply.sequence_next
        self._take(reply.time, np.array([v.value for v in reply.outputs]))

    def field(self, name: str) -> Field:
        """Read a field such as ``U``, ``RF``, ``S``, ``CPRESS`` or ``COPEN``.

        Raises:
            Fault: ``unknown_field``, with the names there are.

        """
        reply = self._client._request(self._key("field"), FieldRequest(name), FieldMessage, self._client._work)
        return Field(reply.name, reply.time, reply.labels, _rows(reply.values, reply.components))

    def checkpoint(self) -> bytes:
        """Return the state, to go back to; valid in every session of the same deck."""
        return self._ask("checkpoint", Checkpoint).state

    def restore(self, state: bytes) -> None:
        """Return to a state, bit for bit.

        Raises:
            Fault: ``checkpoint_refused``.

        """
        request = RestoreRequest(self._sequence, state)
        reply = self._client._request(self._key("restore"), request, RestoreReply, self._client._work)
        self._sequence = reply.sequence + 1
        self._take(reply.time, reply.outputs)

    def report(self) -> Report:
        """Return the steps so far, work and findings."""
        return self._ask("report", Report)

    def close(self) -> None:
        """End the session in the daemon. Closing twice, or a session that is already gone, does nothing."""
        if self._closed:
            return
        try:
            self._ask("close", CloseReply)
        except Fault as fault:
            if fault.code != "unknown_session":
                raise
        self._closed = True

    def frames(self, field: str = "outputs", *, timeout: float | None = None) -> Frames:
        """Subscribe to the results of every increment, or to a field that steps ask for.

        Args:
            field: ``outputs`` or the name of a field.
            timeout: seconds to wait for a frame while iterating; for ever unless given.

        """
        return Frames(self, field, timeout)

    def _get(self, names: list[str]) -> GetReply:
        return self._client._request(self._key("get"), GetRequest(names), GetReply, self._client._quick)

    def _ask(self, verb: str, reply: type[T]) -> T:
        return call(self._client._zenoh, self._key(verb), reply, "", None, self._client._work)

    def _key(self, verb: str) -> str:
        return f"overclosure/v1/{self._client.daemon}/s/{self.id}/{verb}"

    def _take(self, time: float, outputs: FloatArray) -> None:
        self._time = time
        self._outputs = outputs


class Frames:
    """A subscription: an iterator over frames and a context manager. It ends with the session or with :meth:`close`."""

    def __init__(self, session: Session, field: str, timeout: float | None) -> None:
        """Subscribe; use :meth:`Session.frames`."""
        self._timeout = timeout
        self._session = session
        self._waiting: queue.Queue[zenoh.Sample | None] = queue.Queue(FRAMES_WAITING)
        zenoh_session = session._client._zenoh
        # Not through a thread of Python's: a program that forgets to close must still be able to end.
        handler = zenoh.handlers.Callback(self._arrived, indirect=False)
        self._subscriber = zenoh_session.declare_subscriber(session._key(f"frame/{field}"), handler)
        # One exchange on the same link: once it is answered, the daemon knows of the subscription.
        session._ask("ports", Ports)

    def __enter__(self) -> Frames:
        """Nothing more to do."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Unsubscribe."""
        self.close()

    def __iter__(self) -> Iterator[Frame]:
        """Iterate over frames as they arrive."""
        return self

    def __next__(self) -> Frame:
        """Wait for the next frame.

        Raises:
            TimeoutError: none came in time.

        """
        frame = self.receive(self._timeout)
        if frame is None:
            raise StopIteration
        return frame

    def receive(self, timeout: float | None = None) -> Frame | None:
        """Wait for the next frame; ``None`` when the session or the subscription has ended.

        Raises:
            TimeoutError: none came in time.

        """
        try:
            sample = self._waiting.get(timeout=timeout)
        except queue.Empty:
            raise TimeoutError(f"no frame within {timeout} s") from None
        if sample is None or sample.kind == zenoh.SampleKind.DELETE:
            self._put(None)
            return None
        check_encoding(str(sample.encoding), FrameMessage)
        m = decode(FrameMessage, sample.payload.to_bytes())
        values = m.values if m.field == "outputs" else _rows(m.values, m.components)
        return Frame(m.number, m.sequence, m.step, m.increment, m.time, m.field, m.labels, values)

    def close(self) -> None:
        """Unsubscribe; an iteration in another thread ends."""
        if self._subscriber is not None:
            self._subscriber.undeclare()  # type: ignore[no-untyped-call]
            self._subscriber = None  # type: ignore[assignment]
            self._put(None)

    def _arrived(self, sample: zenoh.Sample) -> None:
        self._put(sample)

    def _put(self, sample: zenoh.Sample | None) -> None:
        while True:
            try:
                return self._waiting.put_nowait(sample)
            except queue.Full:
                try:
                    self._waiting.get_nowait()
                except queue.Empty:
                    continue


def _rows(values: FloatArray, components: int) -> FloatArray:
    if components == 1:
        return values
    if components == 0 or values.size % components:
        raise TransportError(f"{values.size} values do not form rows of {components}")
    return values.reshape(-1, components)
