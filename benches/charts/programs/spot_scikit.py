"""A hot spot on a round plate: the temperature of its centre, by scikit-fem."""

import numpy as np
from meridian import Section, tell


def prepare(case: dict):
    section = Section(case)
    advance = section.advance(case["flux"], case["stop"], case["steps"])
    probe = section.basis.probes(np.array([[1e-9 * case["half"]], [0.0]]))

    def run() -> dict:
        rise = float((probe @ advance())[0])
        return {"temperature of the centre": case["initial"] + rise}

    return run


if __name__ == "__main__":
    tell(prepare)
