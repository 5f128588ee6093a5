"""A pressed disc on a block: stress on the axis, by scikit-fem."""

from meridian import Section
from telling import tell


def prepare(case: dict):
    section = Section(case)
    solve = section.elastic()

    def run() -> dict:
        stress = section.stress(solve(case["pressure"]), case["below"])
        return {"axial stress": float(stress[2]), "side stress": float(stress[0])}

    return run


if __name__ == "__main__":
    tell(prepare)
