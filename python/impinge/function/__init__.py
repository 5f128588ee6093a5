"""Python functions that take part in a master as units do."""

from impinge.function.function import Function
from impinge.function.unit import FunctionUnit

__all__ = ["Function", "FunctionUnit"]
