//! Rules on numbers, solids, loads and the arrangement of a scene.

use super::rule::rules;

rules! {
    Check implausible_value(what, low, high, unit)
    "{what} is plausible from {low} to {high} {unit}"; "check the unit of the value"

    Check implausible_number(what, low, high)
    "{what} is plausible from {low} to {high}"; "check the value"

    Check wrong_unit(what, low, high, unit, meant, given)
    "{what} is plausible from {low} to {high} {unit}"; "did you mean {meant} ({given})?"

    Check celsius(what, low, high, value, celsius, meant, permit)
    "{what} is plausible from {low} to {high}, and {value} K is {celsius}"; "did you mean {meant}?{permit}"

    Check cold_value(what, low, high, value, celsius)
    "{what} is plausible from {low} to {high}, and {value} K is {celsius}";
    "set `cryogenic = true` if the scene is meant to be this cold"

    Check substance_out_of_range(name, low, high, value)
    "the library's constants of `{name}` hold from {low} to {high} K, and this is {value} K; beyond, the values at the \
     end are used"; "give constants that hold there, as tables over the temperature"

    Check substance_away_from_its_constants(name, low, high, value, at)
    "the library knows `{name}` from {low} to {high} K, and this is {value} K: its constants stay those of `at`, {at} K";
    "make sure that they hold there, or give constants of your own"

    Check constants_of_other_temperature(name, taken, there)
    "constants of `{name}` were taken at {taken} K, the temperature in the scene; here they would be {there}";
    "set these, too, or change the temperature in the scene"

    Check expansion_from_other_temperature(name, then, now, mean, given)
    "the mean expansion of `{name}` was taken from {then} K on, the temperature without stress in the scene; from {now} K \
     it would be {mean} instead of {given}"; "set `expansion`, too, or change the temperature in the scene"

    Check light_solid_conducts(conductivity, meant, given)
    "no solid this light conducts {conductivity} W/(m K)"; "did you mean {meant} ({given} g/cm³)?"

    Check sound_faster_than_in_diamond(density, sound)
    "with the density of {density} kg/m³ sound would travel at √(E/ρ) = {sound} m/s, faster than in diamond";
    "check the units of both constants"

    Check hardens_beyond_young(key, modulus, young)
    "`{key}` of {modulus} Pa is more than Young's modulus, {young} Pa, which no metal has: of bodies that hardly flow for \
     it, energies are lost in rounding";
    "check its unit, Pa per strain of 1"

    Check thin_liquid_too_viscous(kind, meant, given)
    "no liquid that {kind} is this viscous"; "did you mean {meant} ({given} mPa s)?"

    Check heat_particles_too_coarse(depth, apart, fine)
    "by the stop time heat penetrates √(at) = {depth} m, and particles are {apart} m apart: temperature rises of \
     heated faces are wrong by tens of per cent"; "set a `mesh.depth_spacing` of {fine} m or less"

    Check plate_too_slender(ratio, most)
    "the body is {ratio} times as wide as thick: rounding consumes the digits of displacements and stresses of its \
     bending, some of which remain up to a ratio of {most}";
    "shorten the body, or put a `roller` on the bottom, which keeps it from bending"

    Check power_makes_implausible_flux(power, flux, radius, most)
    "a power of {power} W makes a heat flux of {flux} W/m² on a footprint of radius {radius} m, and a heat flux is \
     plausible up to {most} W/m²"; "check the units of the power and of the radius"

    Check flux_overheats_surface(rise)
    "this flux, held where it is, would heat the surface by {rise} K by the stop time, more than any solid bears";
    "check the flux and the stop time"

    Check flux_undercools_surface(drop)
    "this flux would cool the surface by {drop} K by the stop time, below absolute zero";
    "check the flux and the stop time"

    Check nozzle_height_unusual(height, ratio)
    "the outlet is {height} m above the plate while fluid comes, {ratio} diameters of the nozzle; 0.1 to 10 are usual";
    "check the height of the nozzle and its unit"

    Check target_beyond_plate(solid)
    "the target leaves the top of `{solid}`"; "move the target, or enlarge the solid"

    Check no_fluid_comes()
    "no fluid comes in the default experiment: the flow of the nozzle is zero";
    "set `nozzle.flow`, or the input `flow` in a run"

    Check strand_laid_along_itself(time, earlier)
    "from {time} s on the nozzle runs along what it laid at {earlier} s without rising: both strands lie in one place";
    "raise the nozzle by a layer there: `z` of the path"

    Check route_outlasts_run(end, stop)
    "the path lays fluid until {end} s, and the run stops at {stop} s"; "extend `stop_time` if all is to be laid"

    Check bending_unresolved(elements, extent, error, fine, other)
    "{elements} across the {extent} m of a slender body: its bending is wrong by {error}";
    "did you mean a `mesh.spacing` of {fine} m or less{other}?"

    Check links_store_more_than_their_law(excess, law, fine, beyond)
    "up to its strength a link this long stores {excess} the area below its law, {law} J/m², and its break takes both: \
     cracks take too much energy, and loads are too high"; "set a `spacing` of {fine} m or less{beyond}"

    Check links_stiffen_bending(ratio, share, above, finer)
    "at a ratio of {ratio} links resist bending by themselves, and make the strip stiffer by {share} its stiffness in \
     bending"; "set a ratio of {above} or more{finer}"

    Check pressure_is_spurious(body)
    "`{body}` hardly changes its volume, and its pressure swings from point to point: normal stresses that are read may be \
     wrong by many times their value, far more than displacements";
    "`mechanics = \"fem\"`, or `integration = \"gauss\"` of `rkpm`, reads them to some per cent"

    Check supports_soften(support, error, fine)
    "supports of {support} distances bend too softly where nodes do not stand in rows, by {error}";
    "set a `support` of {fine}"

    Check warm_layer_unresolved(depth, spacing, fine)
    "by the stop time heat penetrates √(at) = {depth} m, and nodes are {spacing} m apart: heat that passes at first is \
     tens of per cent too large"; "set a `mesh.spacing` of {fine} m or less"

    Check no_heat_passes(one, other, difference)
    "`{one}` and `{other}` differ by {difference} K, and no heat passes where they touch";
    "give the coupling or wall a `conductance`, [W/(m² K)]"

    Check droplet_meets_no_wall(solid, drop)
    "the droplet falls through `{solid}`: nothing joins them";
    "did you mean `[[coupling]]` with from = \"{drop}\", to = \"{solid}.top\"?"

    Check drop_arrives_late(stop, time)
    "the drop does not arrive before the stop time of {stop} s: it comes down at {time} s";
    "extend `stop_time`, or release the drop closer to the wall or earlier"

    Check drop_never_arrives(stop)
    "the drop does not arrive before the stop time of {stop} s: without speed and gravity it never comes down";
    "set `impact_velocity` or `gravity`"

    Check fine_mesh_wider_than_solid(solid, room)
    "the fine mesh is wider than `{solid}`, whose edge is {room} m from the centre";
    "set a `radius` of {room} m or less"

    Check drop_spreads_beyond_edge(spread, solid)
    "the drop is expected to spread over {spread} m, beyond the edge of `{solid}`: heat and force beyond the edge do \
     not enter the solid but are counted apart"; "enlarge the solid if its edge is not meant to be hit"

    Check droplets_of_two_bodies_meet(one, other)
    "`{one}` and `{other}` are expected to spread over each other, and droplets of two bodies do not interact";
    "did you mean `arrivals` of one body?"

    Check droplets_of_two_bodies_may_meet(one, other)
    "inputs may let droplets of `{one}` and `{other}` spread over each other, and droplets of two bodies do not \
     interact"; "ask for droplets that meet from one body"

    Check cells_narrower_than_particles(width, drop, spacing, wide)
    "cells of {width} m are narrower than the film can resolve: particles of `{drop}` are {spacing} m apart, so that \
     fluxes of single cells scatter by chance"; "did you mean cells of {wide} m or more?"

    Check cells_too_wide_on_poor_conductor(width, spacing, drop)
    "cells of {width} m are too wide for a solid that conducts less than the fluid, whose temperature varies within \
     a cell: at the middle the error exceeds 10 % of the temperature rise";
    "did you mean cells of {spacing} m, the distance of particles of `{drop}`?"

    Check hole_of_ring_unresolved(spacing)
    "a mesh that the program chooses does not resolve a hole this small";
    "did you mean a disc, or a `mesh.spacing` of {spacing} m or less?"

    Check flaw_peak_missed(step, time)
    "after a thermal shock the stress intensity of a flaw this deep is highest after {time} s, within a communication \
     step of {step} s: outputs miss it"; "set a `step` of {time} s or less"

    Check bath_wets_symmetry(face)
    "the bath wets `{face}`, which is held along its normal alone: no heat passes a plane of symmetry";
    "set `faces.{face}.flux = 0.0` if it is one"

    Check crack_peak_missed(step, time)
    "after a thermal shock stress has fallen to half its peak after {time} s, within a communication step of {step} s: \
     cracks that it opens may be missed"; "set a `step` of {time} s or less"

    Check flaw_deep(part, most)
    "the crack is {part} of what is behind it, and its stress intensity is that of a half plane, which is too low by \
     more than 6 %"; "a depth of {most} m or less is accurate"

    Check flaw_near_face(face, distance, free)
    "the crack is {distance} m from `{face}`, and its stress intensity is that of a body that goes on there: it may be \
     off by more than 6 %, and is too low beside a free face";
    "from {free} m on it is accurate, and in a plane of symmetry (`roller`)"

    Check flaw_on_symmetry(face)
    "the crack begins on `{face}`, whose rollers make it a plane of symmetry: it is half of a crack inside, and the stress \
     intensity of an edge crack is 12 % above that under even tension"; "take a face without rollers"

    Check flaw_in_yielding_body()
    "the body yields, and the stress intensity of its flaws is that of linear elasticity, with the stress of the \
     yielding body"; "do not rely on it where the stress has reached the yield stress"

    Check flaw_in_relaxing_body()
    "moduli of the body relax, and the energy release rate of its flaws is that of the moduli at once";
    "take `stress_intensity`, and the modulus of the time that counts"

    Check damage_wider_than_body(length, extent)
    "damage spreads over {length} m, more than a third of the body's extent of {extent} m: cracks are as wide as the \
     body, whose strength and energy then depend on its size"; "did you mean a higher `strength` or a lower `toughness`?"

    Check plate_unevenly_warm(biot, part)
    "the temperature is taken as even through the thickness of a section in plane stress, and its Biot number in the bath \
     is {biot}: middle and surfaces differ by {part} of the difference to the bath, and the tension that this makes in \
     the surfaces is left out";
    "set a thickness or a `bath.coefficient` with which hW/(2k) is 0.1 or less, or model the section across the thickness, \
     in plane strain with x along the thickness"

    Check load_unresolved(apart, spacing)
    "the mesh does not resolve a load this small: nodes are {apart} m apart";
    "did you mean a `mesh.spacing` of {spacing} m or less?"

    Step load_moved_off_fine_mesh(apart, key, load)
    "the mesh does not resolve a load this small here: nodes are about {apart} m apart, as the mesh is fine where \
     loads start"; "did you mean `range = {{ {key} = […] }}` for `{load}`, or `mesh.growth = 1`?"

    Step load_shrunk_below_mesh(apart, load, spacing)
    "the mesh does not resolve a load this small: nodes are about {apart} m apart";
    "did you mean `range = {{ radius = […] }}` for `{load}`, or a `mesh.spacing` of {spacing} m or less?"
}
