"""What may go wrong, as exceptions that repeat what a unit has to say."""

from importlib import import_module
from types import ModuleType

from impinge import installation


class ImpingeError(Exception):
    """Any error of this package."""


class UnitError(ImpingeError):
    """A unit, or what was asked of it, is at fault.

    `messages` are those that the unit has logged about it.
    """

    def __init__(self, what: str, messages: list[str] | None = None):
        self.messages = messages or []
        super().__init__("\n  ".join([what, *self.messages]))


class StepDiscarded(UnitError):
    """A step came to an end before its time.

    `time` [s] is the last that the unit has reached; `terminated` says that it wants to end. A unit
    of FMI 3.0 can go on from there. FMI 2.0 lets it be read, but go on only after `restore` of a
    state that was saved before, or `reset`.
    """

    def __init__(
        self, what: str, time: float, messages: list[str] | None = None, terminated: bool = False
    ):
        super().__init__(what, messages)
        self.time = time
        self.terminated = terminated


class FunctionError(UnitError):
    """A `Function` does not fit what it declares, or fails; what it raised itself is the cause.

    `function` is its name in the master, `time` [s] when it failed, None while it is made, and
    `variable` the input or output at fault, if it is one. `is_refusal` says that it could not bear
    the values of its inputs, so that others, nearer to the last ones, may be tried.
    """

    def __init__(
        self,
        what: str,
        function: str = "",
        time: float | None = None,
        variable: str | None = None,
        is_refusal: bool = False,
    ):
        super().__init__(what)
        self.function, self.time, self.variable = function, time, variable
        self.is_refusal = is_refusal


class StudyError(ImpingeError, RuntimeError):
    """The folder of a study is in use, or holds files that are none of a study."""


class StudyWarning(UserWarning):
    """Rows of a study warn or fail, or its outputs are no good for what they may be meant for.

    `id` is that of a unit's warning, empty if it has none; `rows` are the numbers of the rows that
    it concerns, from 0 in the order of the table.
    """

    def __init__(self, what: str, id: str = "", rows: tuple[int, ...] = ()):
        super().__init__(what)
        self.id, self.rows = id, rows


def extra(name: str) -> str:
    """The command that installs an extra of this package; no index of packages has it."""
    wheel = installation.wheel()
    if wheel:
        return f'pip install "impinge[{name}] @ {wheel}"'
    return f'pip install "./python[{name}]", in the checkout of impinge'


def need(module: str, command: str, why: str) -> ModuleType:
    """A module that not everyone has; `command` installs it, `why` needs it.

    Raises `ImportError` that says so.
    """
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        missing = error.name or module
        if missing.split(".")[0] != module.split(".")[0]:
            raise  # it is there, and lacks something itself
        raise ImportError(f"{why} needs `{missing}`, which is not installed: {command}") from None
