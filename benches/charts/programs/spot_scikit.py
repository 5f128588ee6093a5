"""A hot spot on a round plate: temperature of its centre and stress below, by scikit-fem."""

import numpy as np
from meridian import Section, tell, von_mises


def prepare(case: dict):
    section = Section(case)
    advance = section.advance(case["flux"], case["stop"], case["steps"])
    solve = section.elastic()

    def run() -> dict:
        rise = advance()
        surface = section.basis.probes(np.array([[1e-9 * case["half"]], [0.0]])) @ rise
        stress = section.stress(solve(rise, 0.0), rise, case["below"])
        return {
            "temperature of the centre": case["initial"] + float(surface[0]),
            "von Mises stress 5 µm below": von_mises(stress),
        }

    return run


if __name__ == "__main__":
    tell(prepare)
