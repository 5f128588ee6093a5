"""Two slabs in contact in scikit-fem: quadratic elements at equal distances, PARDISO throughout.

Heat of both advances together by the L-stable, diagonally implicit Runge–Kutta method of second
order (Alexander 1977, doi 10.1137/0714068).
"""

import numpy as np
import scipy.sparse as sp
from meridian import GAMMA, Factor
from skfem import Basis, BilinearForm, ElementLineP2, MeshLine
from skfem.helpers import dot, grad
from telling import tell


def slab(case: dict, body: dict) -> tuple:
    """Capacity, conductance, and which unknown is the face at 0."""
    capacity, conductivity = body["density"] * body["specific_heat"], body["conductivity"]
    reach = np.sqrt(conductivity / capacity * case["stop"])
    count = round(case["deep"] * case["parts"] / 2)
    mesh = MeshLine(np.linspace(0.0, case["deep"] * reach, count + 1))
    basis = Basis(mesh, ElementLineP2(), intorder=4)
    mass = BilinearForm(lambda u, v, w: capacity * u * v).assemble(basis)
    stiff = BilinearForm(lambda u, v, w: conductivity * dot(grad(u), grad(v))).assemble(basis)
    (face,) = basis.get_dofs(lambda x: np.isclose(x[0], 0.0)).all()
    return mass, stiff, face


def prepare(case: dict):
    slabs = [slab(case, body) for body in case["bodies"]]
    mass, stiff = (sp.block_diag([s[i] for s in slabs], format="lil") for i in (0, 1))
    first = slabs[0][0].shape[0]
    faces = [slabs[0][2], first + slabs[1][2]]
    stiff[np.ix_(faces, faces)] += case["conductance"] * np.array([[1.0, -1.0], [-1.0, 1.0]])
    mass, stiff = mass.tocsr(), stiff.tocsr()
    step = case["stop"] / case["steps"]
    factor = Factor((mass + GAMMA * step * stiff).tocsr())
    cold, hot = (body["initial"] for body in case["bodies"])
    start = np.concatenate([np.full(first, cold), np.full(mass.shape[0] - first, hot)])

    def run() -> dict[str, float]:
        state = start
        for _ in range(case["steps"]):
            slope = factor.solve(-(stiff @ state))
            between = state + (1.0 - GAMMA) * step * slope
            state = state + step * ((1.0 - GAMMA) * slope + GAMMA * factor.solve(-stiff @ between))
        passed = (mass @ (state - start))[:first].sum() * case["area"]
        return {"temperature of the hot face": float(state[faces[1]]), "heat passed": float(passed)}

    return run


tell(prepare)
