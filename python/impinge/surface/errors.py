"""What may go wrong between two surfaces."""

from ..errors import ImpingeError


class SurfaceError(ImpingeError, ValueError):
    """A surface, a file or a map that cannot be made; the message says where and why."""
