"""Files of other tools into units, and results of units onto meshes of other tools.

``impinge-adapt laser|spray|cfd|drops`` write tables of inputs over time that ``impinge run SCENE
--inputs TABLE`` takes; ``impinge-adapt out`` puts ParaView series of a unit onto a foreign mesh.
The same as functions: :func:`laser_frames`, :func:`spray_frames`, :func:`cfd_frames`,
:func:`drop_inputs`, :func:`write_inputs`, :func:`onto_mesh`.
"""

from .cfd import cfd_frames
from .drops import drop_inputs
from .laser import laser_frames, read_picture
from .out import Body, onto_mesh, write_frames
from .spray import spray_frames
from .table import read_inputs, write_inputs

__all__ = [
    "Body",
    "cfd_frames",
    "drop_inputs",
    "laser_frames",
    "onto_mesh",
    "read_inputs",
    "read_picture",
    "spray_frames",
    "write_frames",
    "write_inputs",
]
