"""How long a time step may be: sound over the support, density diffusion, viscosity."""

from plan import Axis, Map

from cases.fluids.small_waves import KERNELS, map_of_steps, own_step

STEP = "time step Δt c₀/H"


def sound_step() -> Map:
    return map_of_steps(
        "sound_step",
        "Time step of sound",
        Axis(
            "support H over the distance of particles Δx",
            "1",
            [2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0],
            False,
        ),
        Axis(STEP, "1", [0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.3]),
        lambda x: {"support": x},
        lambda x: own_step("wendland_c2"),
    )


def kernel_step() -> Map:
    return map_of_steps(
        "kernel_step",
        "Time step of sound by kernel, H = 3Δx",
        Axis("kernel", "", list(range(len(KERNELS))), False, KERNELS),
        Axis(STEP, "1", [0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.3]),
        lambda x: {"kernel": KERNELS[round(x)]},
        lambda x: own_step(KERNELS[round(x)]),
    )


def diffusive_step() -> Map:
    return map_of_steps(
        "diffusive_step",
        "Time step of density diffusion",
        Axis("density diffusion δ", "1", [0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0]),
        Axis(STEP, "1", [0.03, 0.05, 0.08, 0.12, 0.2, 0.3, 0.5, 0.8, 1.2]),
        lambda x: {"diffusion": x},
        lambda x: own_step("wendland_c2", diffusion=x),
    )


def viscous_step() -> Map:
    return map_of_steps(
        "viscous_step",
        "Time step of viscosity",
        Axis("viscosity ν/(c₀H)", "1", [1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0, 3.0, 10.0]),
        Axis(STEP, "1", [1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.2, 0.5, 1.0]),
        lambda x: {"viscosity": x},
        lambda x: own_step("wendland_c2", viscosity=x),
    )


MAPS = {of.__name__: of for of in (sound_step, kernel_step, diffusive_step, viscous_step)}
