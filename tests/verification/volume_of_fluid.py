"""Computes how far a drop spreads with OpenFOAM's interFoam.

python volume_of_fluid.py WE RE ANGLE [CELLS] [FOLDER]

An independent code for spread.rs: two incompressible phases on a fixed mesh (volume of fluid,
Hirt & Nichols 1981, doi 10.1016/0021-9991(81)90145-5), a wedge of an axisymmetric drop, no slip at
the wall, a constant contact angle [degrees], CELLS over the diameter. Prints diameters over D
against time over D/U. Needs numpy and Debian's package `openfoam`; nothing in `make` calls it.
"""

import math
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

DIAMETER, SPEED, DENSITY = 2e-3, 1.0, 1000.0
WIDTH, HEIGHT = 2.0, 1.25  # Of the mesh, over D.
WEDGE = math.radians(2.5)
TIMES = 3.0  # D/U.

SCHEMES = """
ddtSchemes { default Euler; }
gradSchemes { default Gauss linear; }
divSchemes
{
    default none;
    div(rhoPhi,U) Gauss linearUpwind grad(U);
    div(phi,alpha) Gauss vanLeer;
    div(phirb,alpha) Gauss linear;
    div(((rho*nuEff)*dev2(T(grad(U))))) Gauss linear;
}
laplacianSchemes { default Gauss linear corrected; }
interpolationSchemes { default linear; }
snGradSchemes { default corrected; }
"""
SOLUTION = """
solvers
{
    "alpha.water.*"
    {
        nAlphaCorr 2; nAlphaSubCycles 1; cAlpha 1; MULESCorr yes; nLimiterIter 5;
        solver smoothSolver; smoother symGaussSeidel; tolerance 1e-9; relTol 0;
    }
    "pcorr.*" { solver PCG; preconditioner DIC; tolerance 1e-5; relTol 0; }
    p_rgh { solver GAMG; smoother DIC; tolerance 1e-6; relTol 0.02; }
    p_rghFinal { $p_rgh; relTol 0; }
    "U.*" { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-7; relTol 0; }
}
PIMPLE
{
    momentumPredictor yes; nOuterCorrectors 1; nCorrectors 3; nNonOrthogonalCorrectors 0;
    pRefCell 0; pRefValue 0;
}
"""
OPEN = "top { %s } side { %s }"
SIDES = "front { type wedge; } back { type wedge; } axis { type empty; }"


def put(path, kind, text):
    path.parent.mkdir(exist_ok=True)
    head = f"FoamFile {{ version 2.0; format ascii; class {kind}; object {path.name}; }}\n"
    path.write_text(head + text)


def mesh(case, cells):
    x, y = WIDTH * DIAMETER * math.cos(WEDGE / 2), WIDTH * DIAMETER * math.sin(WEDGE / 2)
    top = HEIGHT * DIAMETER
    counts = f"{round(WIDTH * cells)} 1 {round(HEIGHT * cells)}"
    text = f"""
scale 1;
vertices ((0 0 0) ({x} {-y} 0) ({x} {y} 0) (0 0 {top}) ({x} {-y} {top}) ({x} {y} {top}));
blocks (hex (0 1 2 0 3 4 5 3) ({counts}) simpleGrading (1 1 1));
edges ();
boundary
(
    wall {{ type wall; faces ((0 1 2 0)); }}
    top {{ type patch; faces ((3 4 5 3)); }}
    side {{ type patch; faces ((1 2 5 4)); }}
    front {{ type wedge; faces ((0 1 4 3)); }}
    back {{ type wedge; faces ((0 3 5 2)); }}
    axis {{ type empty; faces ((0 0 3 3)); }}
);
"""
    put(case / "system/blockMeshDict", "dictionary", text)


def fluids(case, weber, reynolds):
    viscosity = SPEED * DIAMETER / reynolds
    tension = DENSITY * SPEED**2 * DIAMETER / weber
    text = f"""
phases (water air);
water {{ transportModel Newtonian; nu {viscosity}; rho {DENSITY}; }}
air {{ transportModel Newtonian; nu 1.5e-5; rho 1.2; }}
sigma {tension};
"""
    put(case / "constant/transportProperties", "dictionary", text)
    put(case / "constant/turbulenceProperties", "dictionary", "simulationType laminar;\n")
    gravity = "dimensions [0 1 -2 0 0 0 0]; value (0 0 0);\n"
    put(case / "constant/g", "uniformDimensionedVectorField", gravity)


def field(case, name, kind, dimensions, wall, beyond):
    start = "(0 0 0)" if kind == "volVectorField" else "0"
    sides = f"wall {{ {wall} }} {OPEN % (beyond, beyond)} {SIDES}"
    text = f"dimensions {dimensions}; internalField uniform {start}; boundaryField {{ {sides} }}\n"
    put(case / "0" / name, kind, text)


def fields(case, angle):
    still = "value uniform (0 0 0);"
    beyond = f"type pressureInletOutletVelocity; {still}"
    field(case, "U", "volVectorField", "[0 1 -1 0 0 0 0]", "type noSlip;", beyond)
    wall = "type fixedFluxPressure; value uniform 0;"
    beyond = "type totalPressure; p0 uniform 0;"
    field(case, "p_rgh", "volScalarField", "[1 -1 -2 0 0 0 0]", wall, beyond)
    wall = f"type constantAlphaContactAngle; theta0 {angle}; limit gradient; value uniform 0;"
    beyond = "type inletOutlet; inletValue uniform 0; value uniform 0;"
    field(case, "alpha.water", "volScalarField", "[0 0 0 0 0 0 0]", wall, beyond)
    drop = f"centre (0 0 {0.51 * DIAMETER}); radius {0.5 * DIAMETER};"
    values = f"volScalarFieldValue alpha.water 1 volVectorFieldValue U (0 0 {-SPEED})"
    text = f"""
defaultFieldValues (volScalarFieldValue alpha.water 0);
regions (sphereToCell {{ {drop} fieldValues ({values}); }});
"""
    put(case / "system/setFieldsDict", "dictionary", text)


def control(case):
    time = DIAMETER / SPEED
    text = f"""
application interFoam; startFrom startTime; startTime 0; stopAt endTime; endTime {TIMES * time};
deltaT 1e-7; adjustTimeStep yes; maxCo 0.3; maxAlphaCo 0.3; maxDeltaT 1;
writeControl adjustableRunTime; writeInterval {0.1 * time}; writeFormat ascii; writePrecision 8;
timeFormat general; timePrecision 8; runTimeModifiable no;
"""
    put(case / "system/controlDict", "dictionary", text)
    put(case / "system/fvSchemes", "dictionary", SCHEMES)
    put(case / "system/fvSolution", "dictionary", SOLUTION)


def diameters(folder, cells):
    """Of the lowest row of cells and of the widest, by the areas that fluid covers."""
    text = (folder / "alpha.water").read_text()
    values = re.search(r"internalField\s+nonuniform[^\n]*\n\d+\n\(\n(.*?)\n\)", text, re.S)
    shape = round(HEIGHT * cells), round(WIDTH * cells)
    part = np.array(values[1].split(), float).clip(0, 1).reshape(shape)
    radii = (np.arange(shape[1]) + 0.5) / cells
    rows = 2 * np.sqrt((2 * radii / cells * part).sum(axis=1))
    return rows[0], rows.max()


def main():
    weber, reynolds, angle = map(float, sys.argv[1:4])
    cells = int(sys.argv[4]) if len(sys.argv) > 4 else 60
    case = Path(sys.argv[5] if len(sys.argv) > 5 else tempfile.mkdtemp())
    mesh(case, cells)
    fluids(case, weber, reynolds)
    fields(case, angle)
    control(case)
    environment = {"WM_PROJECT_DIR": "/usr/share/openfoam", **os.environ}
    for program in ["blockMesh", "setFields", "interFoam"]:
        with (case / f"log.{program}").open("w") as log:
            subprocess.run([program], cwd=case, env=environment, stdout=log, check=True)
    written = [path for path in case.iterdir() if re.fullmatch(r"[0-9.e-]+", path.name)]
    print("t U/D  on the wall  widest")
    for folder in sorted(written, key=lambda path: float(path.name))[1:]:
        wall, widest = diameters(folder, cells)
        print(f"{float(folder.name) * SPEED / DIAMETER:5.2f}  {wall:11.3f}  {widest:6.3f}")


if __name__ == "__main__":
    main()
