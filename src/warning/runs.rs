//! Rules on meshes, steps and states, which only a built or running model can test.

use super::rule::rules;

rules! {
    Build mesh_locks(output, error, tolerance)
    "the error of {output} is about {error}, more than the tolerance of {tolerance}: linear elements lock at this \
     `poisson`"; "`mesh.order = 2` would keep the tolerance"

    Build mesh_beyond_tolerance(output, error, tolerance, finer_mesh)
    "the error of {output} is about {error}, more than the tolerance of {tolerance}"; "{finer_mesh}"

    Build outputs_beyond_tolerance(error, tolerance)
    "errors of outputs are about {error} of their ranges, more than the tolerance of {tolerance}";
    "`impinge check` reports which outputs these are, and what would keep the tolerance"

    Build reduction_beyond_tolerance(values, error, tolerance, full_level)
    "the bound of the error of {values} of the reduced model is {error} of their range, more than the tolerance of \
     {tolerance}; it is for start values, and for one unit of an input that starts at zero (except \
     those with the `role` `parameter`)"; "{full_level}"

    Step step_shorter_than_mesh_resolves(step, resolved, asked)
    "a step of {step} s is shorter than the {resolved} s from which on the mesh resolves heated surfaces: before, \
     their temperature rises are too low and heat from prescribed temperatures and droplets is too high, at first \
     several times";
    "a scene whose `step` ({asked} s) is as short has a mesh for it"

    Step held_wall_answers(rise, range, effusivity)
    "the wall was set {rise} K warmer after a step that held it, {range} K below the fluid: what lies below responds \
     to the heat, and is too warm at first contact whatever the step";
    "set `effusivity = {effusivity}` of the wall, about"

    Step fluid_freezes(time, temperature, x, y, z, point)
    "at {time} s the fluid is at {temperature} K at x = {x}, y = {y}, z = {z} m, below the {point} K at which it \
     freezes (`freezes_at`): the model keeps it liquid, without latent heat";
    "do not rely on spread, forces and heat of what freezes from here on; with `method = \"sph\"` and `melting` of the fluid \
     it freezes"

    Step fluid_boils(time, temperature, x, y, z, point)
    "at {time} s the fluid is at {temperature} K at x = {x}, y = {y}, z = {z} m, above the {point} K at which it \
     boils (`boils_at`): the model keeps it liquid";
    "do not rely on spread, heat and forces of what boils from here on"

    Step fluid_beyond_viscosity(time, temperature, x, y, z, end)
    "at {time} s the fluid is at {temperature} K at x = {x}, y = {y}, z = {z} m, beyond the {end} K at which the table of \
     its viscosity ends: it keeps the viscosity of this end";
    "extend the table to the temperatures of the fluid"

    Step fluid_beyond_substance(time, temperature, x, y, z, end, name)
    "at {time} s the fluid is at {temperature} K at x = {x}, y = {y}, z = {z} m, beyond the {end} K at which the range of \
     the library's constants of `{name}` ends: it keeps those of one temperature";
    "give constants that hold there, or take those of another temperature (`at`)"

    Step solid_beyond_substance(temperature, beyond, name, melting, needed)
    "{temperature} K is {beyond} which the library's constants of `{name}` hold{melting}";
    "do not rely on temperatures and stresses from here on; a material with {needed} has them"

    Step fluid_beyond_edge()
    "fluid lies beyond the edge of the solid: it transfers no heat there, and its force, which does not act on the \
     solid, is counted apart as `force_outside`"; "enlarge the solid if its edge is not meant to be hit"

    Step drop_is_late(time)
    "the drop due at {time} s is not released then, nor are later ones, as fluid occupies its place: they wait until a \
     communication step ends with that free"; "a larger `height` of the drops starts them above what rests on the wall"

    Build mesh_below_strand_is_large(strand, nodes, spacing, linear)
    "the mesh below the strand of `{strand}` has {nodes} nodes: a run takes minutes or hours";
    "{linear}limit where the strand is laid by a `[[target]]` or the `radius` of the coupling, or set a `mesh.spacing` \
     of {spacing} m"

    Build mesh_below_strand_is_coarse(strand, error, spacing)
    "the mesh is coarse below the strand of `{strand}`: its heat may be {error} % too high";
    "set a `mesh.spacing` of {spacing} m or less"

    Build strand_freezes_at_contact(solid, contact, low, high)
    "first contact with `{solid}` is at {contact} K, near the freezing range from {low} to {high} K: how much freezes \
     depends on the mesh below"; "compare the frozen part with that on a finer mesh before relying on it"

    Step strand_beyond_edge()
    "the strand lies beyond the edge of the solid, where it transfers neither heat nor force";
    "enlarge the solid, or keep the nozzle above it"

    Step nozzle_jumps(jump, segment)
    "the nozzle jumps by {jump} m between two steps while fluid comes, more than a segment of {segment} m: a straight \
     piece is laid across the jump at once"; "send places and derivatives of one motion"

    Step nozzle_is_slow(rise)
    "the nozzle has moved at less than a quarter of the speed of its fluid, which stands {rise} m above the outlet around \
     it: the width of the strand is that without a nozzle inside, and its rim and its heat are left out";
    "move the nozzle faster, raise it or let less fluid come, or set `method = \"particles\"`"

    Step nozzle_is_late()
    "places of the nozzle came without derivatives: it moves evenly over each step to the place set at the beginning of \
     the step, which it reaches a step late";
    "send the derivatives of the places with each step (`SetRealInputDerivatives`), or take shorter steps"

    Step strand_freezes_at_outlet()
    "fluid freezes right below the outlet, and the nozzle goes on pressing it out: densities, forces and shapes there are \
     wrong, and steps may fail";
    "raise the temperature of the fluid, raise the nozzle or move it faster, or cool the strand less"

    Step particles_lack_neighbours(fallback, particles, support)
    "{fallback} of {particles} particles conduct by the plain operator, as they have too few neighbours for the \
     corrected one: temperatures are wrong by tens of per cent, or grow without end";
    "set an `sph.support` of {support} or more"

    Step particles_lose_heat(part, most)
    "particles have made or lost {part} % of the heat, more than {most} %, as their distances grow too fast \
     (`heat_drift`)"; "set a `mesh.growth` nearer 1, or `heat = \"fem\"`"

    Step torn_apart(opening)
    "a crack is open {opening} times as wide as its elements: it has torn a part off, which the millionth of the \
     stiffness that broken elements keep does not hold";
    "do not rely on displacements, stresses and `crack_area` from here on: the place of the cracks holds"

    Step flaw_unresolved(flaw, elements, finer)
    "the mesh has {elements} elements over the depth of `{flaw}`, too few for the stress along it";
    "set a `mesh.depth_spacing` of {finer} m or less"

    Step risk_unresolved_near_rim(length, finer)
    "elements at its free sides are {length} thicknesses long, and stress changes there within one: the risk of failure \
     may be off by some tenths"; "set a `mesh.spacing` of {finer} m or less, and `mesh.growth = 1.0`"

    Step flaw_worst_is_deep(flaw, part, most)
    "the worst depth of `{flaw}` is {part} of what is behind its mouth, and its stress intensity is that of a half plane, \
     which is too low there"; "do not rely on it beyond {most}"

    Step flaw_has_grown(flaw, part, most)
    "`{flaw}` has grown through {part} of what was behind its mouth, and its stress intensity is that of a half plane";
    "do not rely on it beyond {most}"

    Step breaks_take_energy(part)
    "sudden breaks have taken {part} of the energy that damage dissipated, where they can only release some: the \
     equilibrium after one of them is not the one to which it leads";
    "do not rely on loads, cracks and energies from there on; try steps of another length, `inertia = true`, or a smaller \
     `spacing`"

    Step sides_pass_faces(passed)
    "free sides have bulged by {passed} m through the planes of the faces that press the body: it has no contact with \
     what presses it beyond these faces";
    "do not rely on `height`, nor on forces to some per cent; a finer mesh bulges more"

    Step steps_miss_jolts(part)
    "a face changed its speed faster than steps resolve: that step was cut into parts of {part} s, but the waves that it \
     sends out go on over whole steps, and energies, forces and stress may be far off";
    "take communication steps of {part} s or less after such changes, or move the face smoothly"

    Step body_is_through_its_mirror(place)
    "the node that was at ({place}) m has passed through a plane of symmetry or the axis of its body, which lies within its \
     own mirror image";
    "do not rely on the motion from there on; take shorter communication steps or a smaller `spacing`"

    Step equilibrium_not_stable(time)
    "the equilibrium at {time} s, the first of them, is not stable: under the same loads and displacements another one takes less energy, as \
     where a strut buckles or a bar necks, and rounding decides whether the body finds it";
    "give it an imperfection, such as a small load across or a `quadrilateral` that is not quite straight, and compare two \
     sizes of it; or `inertia = true`"

    Step films_stack(most)
    "more than {most} films that still transfer heat lie on one place: heat and temperatures there stay between \
     those of drops and wall, but their accuracy is not known (docs/fidelity.md)";
    "`method = \"sph\"` computes every drop, at the cost that `check` reports"

    Read film_height_unresolved(layers, usual, large, finer)
    "the film is {layers} distances of particles high, and its height depends on how these happen to stand: the \
     error is some {usual} %, often {large} %";
    "a `spacing` {finer} times as small has errors below 10 %, from 6 distances on"

    Read strain_is_large(what)
    "{what}, so strains are not small: the model adds them up linearly, and keeps loads, areas and stiffness as they were";
    "a body with `strain = \"finite\"` takes any deformation"

    Step stack_yields(ratio)
    "a stack of layers weighs {ratio} times what the yield stress of its lowest layer bears: it flows, and the line keeps \
     its shape"; "`method = \"particles\"` lets it flow"

    Read dissipation_below_zero(value)
    "{value} J are dissipated, less than nothing: at large strain the law of a body that relaxes stores more than the work \
     done; forces and their work are right";
    "do not rely on `stored` and `dissipated` at these strains, take the work of forces and loads instead"

    End damage_is_even(most, mean, scatter_or_load)
    "damage away from cracks is nearly even, {most} at most and {mean} in the mean: where no place is weaker or more \
     stressed than others, a whole region takes energy before one crack is singled out";
    "{scatter_or_load}"

    End fluid_comes_off(part)
    "{part} % of the fluid have come off in small lumps (`stray_mass`): films thinner than some two particles break \
     up";
    "a smaller `spacing` delays it"

    End no_drop_asked_for()
    "the run ends without a drop: `release = \"input\"` waits for drops to be asked for, and none was";
    "set the input `release` to the number of drops, as `impinge run --set BODY.release=1` does"

    End drops_wait(waiting, asked)
    "{waiting} of {asked} drops asked for are not released, as fluid occupies their place (`waiting`)";
    "a larger `height` of the drops starts them above what rests on the wall"

    End fluid_came_off_in_record(part)
    "{part} % of the fluid had come off in small lumps by the end of the record: films thinner than some two \
     particles break up"; "a smaller `spacing` delays it"

    End drops_overlapped(overlapping, released)
    "{overlapping} of {released} drops came down on the film of another that still transferred heat or force \
     (`overlapping`): they transfer heat as one drop of all volumes would, and force as if alone";
    "`method = \"sph\"` computes every drop"

    End front_scatters(volume, error, tolerance, finer_mesh_or_tolerance)
    "the error of {volume} is up to about {error} of its value, and that of temperatures behind the front up to as \
     much of their rise above melting, as the front advances from node to node; the tolerance is {tolerance}";
    "{finer_mesh_or_tolerance}"

    End bend_is_coarse(across, error, effect, finer_mesh)
    "metal was bent beyond its yield stress with {across} elements or nodes across, from yield to yield: what stays of the \
     bend once it is let go may be {error} % {effect}"; "{finer_mesh}: the error falls with its square"

    End heat_unbalanced(residual, expected)
    "heat in differs from heat stored and lost by {residual} of the largest of them (expected at most {expected})";
    "report the scene: this is an error of the program"

    Check run_ends_before_rows(stop, first)
    "the run ends at {stop} s, before the first row at {first} s, whose values hold throughout";
    "check that the times are in seconds"
}
