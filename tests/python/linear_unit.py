"""Units of FMI 2.0 that are none of impinge's: linear equations, compiled from `linear.c`."""

import subprocess
import zipfile
from pathlib import Path

import numpy as np

SOURCE = Path(__file__).with_name("linear.c")


def library(folder):
    """The compiled library, made once for a folder."""
    path = Path(folder) / "Linear.so"
    if not path.is_file():
        path.parent.mkdir(parents=True, exist_ok=True)
        made = path.with_suffix(".part")
        command = ["cc", "-O2", "-shared", "-fPIC", "-o", made, SOURCE, "-lm"]
        subprocess.run(command, check=True)
        made.rename(path)
    return path


def make(folder, name, a=(), b=(), c=(), *, d=0.0, e=0.0, f=None, g=0.0, u=0.0, x=None, **told):
    """Writes `name.fmu`: x' = A x + b u, y = c x + d u + e, z = Δ(f x + g u)/Δt, from u and x on.

    told: units of measurement `u_unit`, `y_unit`, and whether it `interpolates`, has `states` and
        takes `variable` steps.
    """
    n = len(b)
    blocks = [np.reshape(a, (n, n)), b, c, d, e, np.zeros(n) if f is None else f, g, u]
    blocks.append(np.zeros(n) if x is None else x)
    numbers = np.concatenate([np.ravel(np.asarray(block, float)) for block in blocks])
    path = Path(folder) / f"{name}.fmu"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("modelDescription.xml", description(name, d != 0.0, u, **told))
        archive.writestr("resources/start.txt", "\n".join([str(n), *map(repr, numbers.tolist())]))
        archive.write(library(folder), "binaries/linux64/Linear.so")
    return path


def description(
    name, is_direct, u, u_unit="", y_unit="", interpolates=True, states=True, variable=True
):
    def real(key, reference, causality, unit, start=""):
        unit = f'unit="{unit}"' if unit else ""
        return (
            f'<ScalarVariable name="{key}" valueReference="{reference}" causality="{causality}"'
            f' variability="continuous"><Real {unit} {start}/></ScalarVariable>'
        )

    can, goes_back = str(interpolates).lower(), str(states).lower()
    any_step = str(variable).lower()
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="{name}" guid="{{linear}}">
<CoSimulation modelIdentifier="Linear" canHandleVariableCommunicationStepSize="{any_step}"
 canInterpolateInputs="{can}" canGetAndSetFMUstate="{goes_back}"
 canSerializeFMUstate="{goes_back}"/>
<UnitDefinitions>
<Unit name="K"><BaseUnit K="1"/></Unit>
<Unit name="degC"><BaseUnit K="1" offset="273.15"/></Unit>
<Unit name="N"><BaseUnit kg="1" m="1" s="-2"/></Unit>
<Unit name="m/s"><BaseUnit m="1" s="-1"/></Unit>
<Unit name="J"><BaseUnit kg="1" m="2" s="-2"/></Unit>
<Unit name="W/m2"><BaseUnit kg="1" s="-3"/></Unit>
<Unit name="kW/m2"><BaseUnit kg="1" s="-3" factor="1000"/></Unit>
</UnitDefinitions>
<ModelVariables>
{real("u", 0, "input", u_unit, f'start="{float(u)!r}"')}
{real("y", 1, "output", y_unit)}
{real("z", 2, "output", "")}
</ModelVariables>
<ModelStructure><Outputs><Unknown index="2" dependencies="{"1" if is_direct else ""}"/>
<Unknown index="3" dependencies=""/></Outputs></ModelStructure>
</fmiModelDescription>"""
