"""The maps, by name."""

from cases import coupling, fluids, solids

MAPS = solids.MAPS | fluids.MAPS | coupling.MAPS

SHOWN = {
    "small_spots",
    "moved_spots",
    "particle_grading",
    "disordered_particles",
    "graded_part",
    "held_inputs",
    "even_bar",
    "shock_cracks",
    "resolution",
    "films",
    "spreads",
    "coupling_iterate",
    "coupling_rings",
    "coupling_pairs_heat",
    "coupling_films_heat",
}
"""Those whose pictures stand in documents: they show settings that a user chooses."""
