"""Several units joined: what one gives, others take, in steps whose error is known."""

from impinge.master.connection import Connection
from impinge.master.energy import Bond
from impinge.master.errors import MasterError, MasterWarning
from impinge.master.master import Master
from impinge.master.stepping import Graded

__all__ = ["Bond", "Connection", "Graded", "Master", "MasterError", "MasterWarning"]
