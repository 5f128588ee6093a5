"""One FMI co-simulation unit, of FMI 2.0 or 3.0 and of any tool, driven by names."""

from impinge.unit.build import build
from impinge.unit.package import Package, open_package
from impinge.unit.state import State
from impinge.unit.unit import Unit
from impinge.unit.variable import Capabilities, Variable

__all__ = ["Capabilities", "Package", "State", "Unit", "Variable", "build", "open_package"]
