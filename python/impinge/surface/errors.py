"""What may go wrong between two surfaces."""


class SurfaceError(ValueError):
    """A surface, a file of one or a map between two that cannot be made; the message says where and why."""
