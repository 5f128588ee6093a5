"""A round plate under the heat and pressure of an impact, held over steps, by NGSolve."""

from impact_on_plate import follow
from section_ngsolve import Section
from telling import tell


class Plate(Section):
    def __init__(self, case: dict):
        super().__init__(case)
        self.heated()
        self.elastic()

    def stresses(self, pressure: float, depth: float) -> tuple[float, float]:
        """Across and along the axis [Pa]."""
        self.load(pressure)
        return self.stress(depth)


def prepare(case: dict):
    plate = Plate(case)
    return lambda: follow(plate)


if __name__ == "__main__":
    tell(prepare)
