"""The maps of solids, by name."""

from cases.solids import (
    footprints,
    fronts_and_yield,
    inputs_in_time,
    locking,
    particle_clouds,
    particle_steps,
    sudden_heat,
)

ALL = (
    particle_steps.particle_euler,
    particle_steps.particle_steps,
    particle_clouds.cloud_condition,
    particle_clouds.cloud_error,
    particle_clouds.cloud_plain,
    particle_clouds.cloud_fallback,
    particle_clouds.particle_grading,
    locking.incompressible_linear,
    locking.incompressible_quadratic,
    locking.thin_linear,
    locking.thin_quadratic,
    footprints.small_spots,
    footprints.edge_spots,
    footprints.moved_spots,
    footprints.seam,
    inputs_in_time.held_inputs,
    inputs_in_time.sloping_inputs,
    sudden_heat.sudden_heat,
    fronts_and_yield.melting_front,
    fronts_and_yield.limit_load,
    fronts_and_yield.hardening_block,
)
MAPS = {build.__name__: build for build in ALL}
