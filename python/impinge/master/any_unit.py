"""The types that a master couples."""

from impinge.function import FunctionUnit
from impinge.unit import Unit

AnyUnit = Unit | FunctionUnit
