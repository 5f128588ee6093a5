"""Units that are none of impinge's: two linear equations in C, and static laws by PythonFMU."""

import subprocess
import zipfile
from pathlib import Path

SOURCE = Path(__file__).with_name("linear.c")
NAMES = ["u", "y", "z", "a11", "a12", "a21", "a22", "b1", "b2", "c1", "c2", "d", "e", "f1", "f2"]
NAMES += ["x1", "x2"]


def library(folder):
    """The compiled library, made once for a folder."""
    path = Path(folder) / "Linear.so"
    if not path.is_file():
        path.parent.mkdir(parents=True, exist_ok=True)
        made = path.with_suffix(".part")
        subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", made, SOURCE], check=True)
        made.rename(path)
    return path


def make(
    folder, name, *, u=0.0, interpolates=True, states=True, y_unit=None, u_unit=None, **values
):
    """Writes `name.fmu` with these values of parameters; z is told to follow nothing at once."""
    values = {key: 0.0 for key in NAMES} | {"u": u} | values
    rows = []
    for reference, key in enumerate(NAMES):
        if key in ("y", "z"):
            kind, start = 'causality="output" variability="continuous"', ""
        elif key == "u":
            kind, start = 'causality="input" variability="continuous"', f'start="{values[key]!r}"'
        else:
            kind, start = 'causality="parameter" variability="fixed"', f'start="{values[key]!r}"'
        told = {"y": y_unit, "u": u_unit}.get(key)
        told = f'unit="{told}"' if told else ""
        rows.append(
            f'<ScalarVariable name="{key}" valueReference="{reference}" {kind}>'
            f"<Real {told} {start}/></ScalarVariable>"
        )
    direct = "1" if values["d"] else ""
    flag = {True: "true", False: "false"}
    text = f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="{name}" guid="{{linear}}">
<CoSimulation modelIdentifier="Linear" canHandleVariableCommunicationStepSize="true"
 canInterpolateInputs="{flag[interpolates]}" canGetAndSetFMUstate="{flag[states]}"
 canSerializeFMUstate="{flag[states]}"/>
<UnitDefinitions>
<Unit name="K"><BaseUnit K="1"/></Unit>
<Unit name="degC"><BaseUnit K="1" offset="273.15"/></Unit>
<Unit name="W/m2"><BaseUnit kg="1" s="-3"/></Unit>
<Unit name="kW/m2"><BaseUnit kg="1" s="-3" factor="1000"/></Unit>
</UnitDefinitions>
<ModelVariables>{"".join(rows)}</ModelVariables>
<ModelStructure><Outputs><Unknown index="2" dependencies="{direct}"/>
<Unknown index="3" dependencies=""/></Outputs></ModelStructure>
</fmiModelDescription>"""
    path = Path(folder) / f"{name}.fmu"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("modelDescription.xml", text)
        archive.writestr(
            "resources/start.txt", "\n".join(repr(float(values[key])) for key in NAMES)
        )
        archive.write(library(folder), "binaries/linux64/Linear.so")
    return path
