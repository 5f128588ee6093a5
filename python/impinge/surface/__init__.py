"""Surfaces and maps between them: rings, tiles and grids of units, meshes and points of other
tools.
"""

from .errors import SurfaceError
from .maps import Map
from .placement import Placement
from .series import Series
from .surface import Surface

__all__ = ["Map", "Placement", "Series", "Surface", "SurfaceError"]
