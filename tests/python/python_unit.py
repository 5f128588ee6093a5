"""Units of FMI 2.0 written in Python, packed by pythonfmu."""

import re
import subprocess
import sys
import zipfile
from pathlib import Path

HEAD = """
from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Integer, Real


class Base(Fmi2Slave):
    def numbers(self, **kinds):
        for name, (causality, value) in kinds.items():
            setattr(self, name, value)
            variability = "tunable" if causality == "parameter" else "continuous"
            told = {
                "causality": Fmi2Causality[causality],
                "variability": Fmi2Variability[variability],
            }
            self.register_variable(Real(name, **told))


"""

BODY = """
class Body(Base):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.numbers(q=("input", 0.0), T=("output", 300.0), cap=("parameter", 10.0))
        self.numbers(T0=("parameter", 300.0))

    def exit_initialization_mode(self):
        self.T = self.T0

    def do_step(self, time, step):
        self.T += step * self.q / self.cap
        return True
"""

LINK = """
class Link(Base):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.numbers(x1=("input", 0.0), x2=("input", 0.0), k=("parameter", 4.0))
        told = {"causality": Fmi2Causality.output}
        self.register_variable(Real("f1", getter=lambda: self.k * (self.x2 - self.x1), **told))
        self.register_variable(Real("f2", getter=lambda: self.k * (self.x1 - self.x2), **told))

    def do_step(self, time, step):
        return True
"""

CUBE = """
class Cube(Base):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.numbers(x=("input", 0.0), k=("parameter", 4.0))
        f = {"causality": Fmi2Causality.output, "getter": lambda: 3.0 - self.k * self.x**3}
        self.register_variable(Real("f", **f))

    def do_step(self, time, step):
        return True
"""

LATE = """
class Late(Base):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.numbers(u=("input", 0.0), y=("output", 0.0), fail_at=("parameter", 1e9))
        self.n = 3
        told = {"causality": Fmi2Causality.input, "variability": Fmi2Variability.discrete}
        self.register_variable(Integer("n", **told))

    def do_step(self, time, step):
        if time + step > self.fail_at:
            raise ValueError("boom")
        self.y = 0.5 * self.u + 1.0
        return True
"""

STAGES = """
class Stages(Base):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.numbers(u=("input", 0.0), y=("output", 0.0))
        self.n, self.count = 0, 1
        told = {"variability": Fmi2Variability.discrete}
        self.register_variable(Integer("n", causality=Fmi2Causality.input, **told))
        self.register_variable(Integer("count", causality=Fmi2Causality.output, **told))

    def do_step(self, time, step):
        self.y = 10.0 * self.n - 0.5 * self.u
        self.count += 1
        return True
"""


def python_unit(folder, name, code, *, states=True, declared=False, variable=True):
    """Packs the class `name` of this code into `name.fmu`; made once for a folder.

    declared: whether its outputs are declared to follow no input at once, in place of nothing.
    variable: whether it takes steps of any length.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    unit = folder / f"{name}.fmu"
    if unit.is_file():
        return unit
    (folder / f"{name.lower()}.py").write_text(HEAD + code)
    command = [sys.executable, "-m", "pythonfmu", "build", "-f", f"{name.lower()}.py"]
    more = ["--handle-state"] if states else []
    subprocess.run([*command, *more], cwd=folder, check=True, capture_output=True)
    if declared:
        _edit(unit, rb'<Unknown index="(\d+)"\s*/>', rb'<Unknown index="\1" dependencies=""/>')
    if not variable:
        can = rb'canHandleVariableCommunicationStepSize="%s"'
        _edit(unit, can % b"true", can % b"false")
    return unit


def _edit(unit, old_text, new_text):
    part = unit.with_suffix(".part")
    with zipfile.ZipFile(unit) as old, zipfile.ZipFile(part, "w") as new:
        for name in old.namelist():
            content = old.read(name)
            if name == "modelDescription.xml":
                content, count = re.subn(old_text, new_text, content)
                assert count
            new.writestr(name, content)
    part.rename(unit)
