"""What may go wrong between two surfaces."""

from importlib import import_module
from types import ModuleType

from ..errors import ImpingeError, extra


class SurfaceError(ImpingeError, ValueError):
    """A surface, a file or a map that cannot be made; the message says where and why."""


def need(module: str) -> ModuleType:
    """A module of the extra `surface`.

    Raises
    ------
    SurfaceError
        With what installs it, if it is not there.
    """
    try:
        return import_module(module)
    except ModuleNotFoundError:
        name = {"PIL.Image": "Pillow"}.get(module, module)
        words = f"{name} is not installed: {extra('surface')}"
        raise SurfaceError(words) from None
