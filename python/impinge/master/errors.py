"""What goes wrong between units."""

from impinge.errors import ImpingeError


class MasterError(ImpingeError):
    """Connections that do not fit, or steps that find no end."""


class MasterWarning(UserWarning):
    """Something that was asked for could not be done, and what has been done in its place."""
