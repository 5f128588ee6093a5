"""What a host written in Python finds after its simulations: no thread, no library, no harm."""

import struct
import subprocess
import sys
from zipfile import ZipFile

import pytest

# Runs a unit again and again, as FMPy does: unpacked anew, loaded and unloaded.
AGAIN = """
import ctypes, os, sys
from fmpy import simulate_fmu

def threads():
    return len(os.listdir("/proc/self/task"))

def libraries():
    return sum("/binaries/" in line for line in open("/proc/self/maps"))

class Allocated(ctypes.Structure):
    names = "arena ordblks smblks hblks hblkhd usmblks fsmblks uordblks fordblks keepcost"
    _fields_ = [(name, ctypes.c_size_t) for name in names.split()]

# What the C library has handed out; resident memory also counts what was freed and may come back.
allocator = ctypes.CDLL(None)
allocator.mallinfo2.restype = Allocated

def allocated():
    memory = allocator.mallinfo2()
    return memory.uordblks + memory.hblkhd

unit, start_values = sys.argv[1], {"solver.threads": 3}
settings = {"stop_time": 4e-8, "output_interval": 1e-8, "start_values": start_values}
# A row of the stress, a solution for the highest.
read = ["centre.temperature", "centre.stress_xx", "plate.max_von_mises"]
for count in range(14):
    simulate_fmu(unit, output=read, **settings)
    assert libraries() == 0, libraries()
    if count == 3:
        before = threads(), allocated()
assert threads() == before[0], (threads(), before)
assert allocated() < before[1] + 500000, (allocated(), before)
"""

# A pool of forked processes runs the unit that the parent has run.
FORKED = """
import multiprocessing, sys
from fmpy import extract, simulate_fmu

folder = extract(sys.argv[1])

def run(flux):
    values = {"spot.heat_flux": flux, "solver.threads": 3}
    # A row of the stress, a solution for the highest.
    read = ["centre.temperature", "centre.stress_xx", "plate.max_von_mises"]
    settings = {"stop_time": 4e-8, "output_interval": 1e-8, "start_values": values}
    result = simulate_fmu(folder, output=read, **settings)
    return result.tobytes()

alone = [run(flux) for flux in (1e7, 2e7, 3e7)]
multiprocessing.set_start_method("fork")
with multiprocessing.Pool(2) as pool:
    assert pool.map_async(run, [1e7, 2e7, 3e7]).get(timeout=100) == alone
"""


def run(program, unit):
    ran = subprocess.run(
        [sys.executable, "-c", program, unit], capture_output=True, text=True, check=False
    )
    assert ran.returncode == 0, ran.stderr


def test_simulations_leave_no_thread_no_library_and_no_memory(pack):
    run(AGAIN, pack("plate"))


def test_forked_processes_run_what_the_parent_has_run(pack):
    run(FORKED, pack("plate"))


@pytest.mark.parametrize("fmi", [2, 3])
def test_the_library_of_a_unit_carries_no_names_and_lines_for_debuggers(pack, fmi):
    unit = ZipFile(pack("plate", fmi=fmi))
    (library,) = [name for name in unit.namelist() if name.startswith("binaries/")]
    content = unit.read(library)
    names = sections(content)
    assert ".dynsym" in names and ".symtab" not in names
    assert not [name for name in names if name.startswith(".debug")]
    assert len(content) < 23e6


def sections(content):
    """Names of the sections of a 64-bit ELF file, from its table of section headers."""
    (table,) = struct.unpack_from("<Q", content, 0x28)
    size, count, names = struct.unpack_from("<HHH", content, 0x3A)
    (start,) = struct.unpack_from("<Q", content, table + names * size + 0x18)
    places = [struct.unpack_from("<I", content, table + k * size)[0] for k in range(count)]
    return [content[start + p : content.index(b"\0", start + p)].decode() for p in places]
