"""A pressed disc on a block: stress on the axis, by NGSolve."""

from section_ngsolve import Section
from telling import tell


def prepare(case: dict):
    section = Section(case)
    section.elastic()

    def run() -> dict:
        section.load(case["pressure"])
        side, axial = section.stress(case["below"])
        return {"axial stress": axial, "side stress": side}

    return run


if __name__ == "__main__":
    tell(prepare)
