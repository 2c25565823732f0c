"""The C functions of an FMU as they are: null pointers, wrong orders and all. FMPy only reads the description."""

import ctypes as c
import shutil
import zipfile
from dataclasses import dataclass, field
from pathlib import Path

import fmpy

OK, WARNING, DISCARD, ERROR, FATAL = range(5)
LOGGER = c.CFUNCTYPE(None, c.c_void_p, c.c_char_p, c.c_int, c.c_char_p, c.c_char_p)

FUNCTIONS = [
    "GetTypesPlatform",
    "GetVersion",
    "SetDebugLogging",
    "Instantiate",
    "FreeInstance",
    "SetupExperiment",
    "EnterInitializationMode",
    "ExitInitializationMode",
    "Terminate",
    "Reset",
    "GetReal",
    "GetInteger",
    "GetBoolean",
    "GetString",
    "SetReal",
    "SetInteger",
    "SetBoolean",
    "SetString",
    "GetFMUstate",
    "SetFMUstate",
    "FreeFMUstate",
    "SerializedFMUstateSize",
    "SerializeFMUstate",
    "DeSerializeFMUstate",
    "GetDirectionalDerivative",
    "SetRealInputDerivatives",
    "GetRealOutputDerivatives",
    "DoStep",
    "CancelStep",
    "GetStatus",
    "GetRealStatus",
    "GetIntegerStatus",
    "GetBooleanStatus",
    "GetStringStatus",
]


class Callbacks(c.Structure):
    """fmi2CallbackFunctions."""

    _fields_ = (
        ("logger", c.c_void_p),
        ("allocate", c.c_void_p),
        ("free", c.c_void_p),
        ("finished", c.c_void_p),
        ("environment", c.c_void_p),
    )


class Fmu:
    """An unpacked FMU and its library."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.description = fmpy.read_model_description(str(folder))
        self.identifier = self.description.coSimulation.modelIdentifier
        self.library_path = self.folder / "binaries" / "linux64" / f"{self.identifier}.so"
        self.library = c.CDLL(str(self.library_path))
        self.variables = {v.name: v for v in self.description.modelVariables}
        self.references = {name: v.valueReference for name, v in self.variables.items()}
        for name in FUNCTIONS:
            function = getattr(self.library, f"fmi2{name}")
            function.restype = c.c_int
        self.library.fmi2Instantiate.restype = c.c_void_p
        self.library.fmi2FreeInstance.restype = None
        self.library.fmi2GetVersion.restype = c.c_char_p
        self.library.fmi2GetTypesPlatform.restype = c.c_char_p

    @classmethod
    def unpack(cls, fmu, folder):
        """Unpacks an FMU into a folder of its own."""
        with zipfile.ZipFile(fmu) as archive:
            archive.extractall(folder)
        return cls(folder)

    def copied_to(self, folder):
        """The same tree elsewhere."""
        shutil.copytree(self.folder, folder)
        return Fmu(folder)

    def names(self, causality):
        """Names of all variables with a causality."""
        return [name for name, v in self.variables.items() if v.causality == causality]

    @property
    def outputs(self):
        """Names of the Real outputs."""
        return [name for name in self.names("output") if self.variables[name].type == "Real"]

    @property
    def resources(self):
        """Location as most importers write it."""
        return (self.folder / "resources").resolve().as_uri()


@dataclass
class Message:
    """What the logger was given."""

    status: int
    category: str
    text: str


_DEFAULT = object()


@dataclass
class Instance:
    """One instance; `log` holds what it said."""

    fmu: Fmu
    log: list = field(default_factory=list)
    component: int | None = None

    def instantiate(self, name=b"one", kind=1, guid=_DEFAULT, location=_DEFAULT, callbacks=_DEFAULT, logging=True):
        """fmi2Instantiate; true if there is an instance now."""
        guid = self.fmu.description.guid.encode() if guid is _DEFAULT else guid
        location = self.fmu.resources.encode() if location is _DEFAULT else location
        self._logger = LOGGER(self._take)
        if callbacks is _DEFAULT:
            callbacks = Callbacks(logger=c.cast(self._logger, c.c_void_p).value)
        pointer = None if callbacks is None else c.byref(callbacks)
        self.component = self.fmu.library.fmi2Instantiate(name, kind, guid, location, pointer, 0, int(logging))
        if callbacks is not None:
            # The library must have copied the struct.
            c.memset(c.byref(callbacks), 0xFF, c.sizeof(callbacks))
        return self.component is not None

    def _take(self, _environment, _name, status, category, text):
        self.log.append(Message(status, category.decode(), text.decode()))

    def call(self, function, *arguments):
        """Any function on this instance."""
        return getattr(self.fmu.library, f"fmi2{function}")(c.c_void_p(self.component), *arguments)

    def free(self):
        """fmi2FreeInstance."""
        self.call("FreeInstance")
        self.component = None

    def setup(self, start=0.0, stop=None):
        """fmi2SetupExperiment."""
        return self.call(
            "SetupExperiment", 0, c.c_double(0), c.c_double(start), int(stop is not None), c.c_double(stop or 0.0)
        )

    def start(self, start=0.0, stop=None):
        """From instantiated to the first communication point."""
        statuses = self.setup(start, stop), self.call("EnterInitializationMode"), self.call("ExitInitializationMode")
        assert statuses == (OK, OK, OK), (statuses, self.log)
        return self

    def step(self, point, size):
        """fmi2DoStep."""
        return self.call("DoStep", c.c_double(point), c.c_double(size), 0)

    def set(self, **values):
        """Sets variables by name, with `__` for a dot."""
        return self.set_values({name.replace("__", "."): value for name, value in values.items()})

    def set_values(self, values):
        """Sets variables by name; the worst status."""
        return max((self._set_one(name, value) for name, value in values.items()), default=OK)

    def _set_one(self, name, value):
        reference = c.byref(c.c_uint(self.fmu.references[name]))
        kind = self.fmu.variables[name].type
        if kind == "Real":
            return self.call("SetReal", reference, c.c_size_t(1), c.byref(c.c_double(value)))
        if kind == "String":
            return self.call("SetString", reference, c.c_size_t(1), c.byref(c.c_char_p(value.encode())))
        return self.call("SetInteger", reference, c.c_size_t(1), c.byref(c.c_int(value)))

    def reals(self, names):
        """Real values; fails if the call does."""
        references = (c.c_uint * len(names))(*(self.fmu.references[name] for name in names))
        values = (c.c_double * len(names))()
        status = self.call("GetReal", references, c.c_size_t(len(names)), values)
        assert status == OK, (status, self.log)
        return list(values)

    def real(self, name):
        """One Real value."""
        return self.reals([name])[0]

    def integer(self, name):
        """One Integer value."""
        value = c.c_int()
        status = self.call("GetInteger", c.byref(c.c_uint(self.fmu.references[name])), c.c_size_t(1), c.byref(value))
        assert status == OK, (status, self.log)
        return value.value

    def outputs(self):
        """All Real outputs."""
        return self.reals(self.fmu.outputs)

    def save(self, state=None):
        """fmi2GetFMUstate into a new or a given handle."""
        state = c.c_void_p() if state is None else state
        status = self.call("GetFMUstate", c.byref(state))
        assert status == OK, (status, self.log)
        return state

    def load(self, state):
        """fmi2SetFMUstate."""
        return self.call("SetFMUstate", state)

    def serialize(self, state):
        """Bytes of a state."""
        size = c.c_size_t()
        assert self.call("SerializedFMUstateSize", state, c.byref(size)) == OK, self.log
        bytes_ = (c.c_ubyte * size.value)()
        assert self.call("SerializeFMUstate", state, bytes_, size) == OK, self.log
        return bytes(bytes_)

    def deserialize(self, data):
        """(status, handle) of bytes."""
        state = c.c_void_p()
        buffer = (c.c_ubyte * len(data)).from_buffer_copy(data) if data else None
        return self.call("DeSerializeFMUstate", buffer, c.c_size_t(len(data)), c.byref(state)), state

    def errors(self):
        """Texts of everything that was logged as an error or worse."""
        return [message.text for message in self.log if message.status >= ERROR]
