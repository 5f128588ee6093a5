//! Rules on drops of a scene: their fluid, their particles, and films of closed forms.

use super::rule::rules;

rules! {
    Check drop_starts_frozen(start)
    "drops of {start} K are frozen, and the model treats them as liquid";
    "raise `initial_temperature` above `freezes_at`"

    Check freezing_point_in_celsius(point, celsius, meant)
    "{point} K is {celsius}";
    "did you mean {meant} ({point} °C)? If the scene is meant to be this cold, set `cryogenic = true`"

    Check drop_starts_boiling(start, higher_point_or_colder_drop)
    "drops of {start} K boil at once, and the model treats them as liquid"; "{higher_point_or_colder_drop}"

    Check freezes_on_contact(below, temperature)
    "on `{below}` the fluid is predicted to be at {temperature} K in contact, where it freezes, and the model keeps it \
     liquid, without latent heat";
    "with `method = \"sph\"` and `melting` of the fluid it freezes; else do not rely on spread, later heat and forces, nor on \
     temperatures that latent heat would raise"

    Check boils_on_contact(below, temperature)
    "on `{below}` the fluid is predicted to be at {temperature} K in contact, where it boils, and the model keeps it \
     liquid";
    "do not rely on heat and forces from first contact on"

    Check drop_dries(below, temperature, time)
    "a drop at rest on `{below}` at {temperature} K would lose a twentieth of its mass in {time} s to still, dry air, and the \
     model has no evaporation";
    "do not rely on volume, shape and heat beyond that time; humid air slows drying"

    Check pressure_of_thin_fluid(reynolds, thick)
    "the Reynolds number of the drop is {reynolds}: pressure that is solved at the end of steps lets the density of fluid as \
     thin vary by several per cent, and costs more than it saves";
    "leave out `pressure`; up to {thick} it saves time"

    Check film_risk_follows_step(solid, step, shorter)
    "the probability of failure of `{solid}` follows from the stress at the ends of steps, and {step} s are long beside the time \
     in which a drop spreads: it may be off by a factor of two";
    "set a `step` of {shorter} s or less"

    Check skin_thinner_than_particles(thickness, finer_spacing)
    "when the drop has spread, some {thickness} m of it are frozen, less than half a distance of particles, and hold nothing \
     fast: it recoils farther than it would, and ends smaller";
    "did you mean a `spacing` of {finer_spacing} m or less?"

    Check viscosity_beyond_table(what, temperature, low, high)
    "{what} is at {temperature} K, and the table of viscosity spans {low} K to {high} K: beyond it the viscosity is that \
     of the nearer end";
    "extend the table to the temperatures of the fluid"

    Check kernel_forms_pairs(spline, widest, support)
    "under pressure, particles of the {spline} spline form pairs beyond a support of {widest} distances ({support} \
     here), and resolve as little as half as many";
    "did you mean `kernel = \"wendland_c2\"`, or `support = {widest}`?"

    Check density_diffusion_too_weak(usual)
    "with so little density diffusion pressures ring: errors of heat and film heights are 10 % to 30 %";
    "did you mean {usual}?"

    Check particles_line_up()
    "where inertia dominates, particles without shifting line up along streams: errors of velocities are 5 % to 20 % \
     at any `spacing`"; "did you mean to leave `shifting` out?"

    Check drop_of_few_particles(across, spacing)
    "{across} particles across a drop resolve its heat to a third or a half only";
    "did you mean a `spacing` of {spacing} m or less?"

    Check film_thinner_than_particles(film, thinnest, heat, force, spacing)
    "the film is expected to get {film} distances of particles thin by the stop time: below {thinnest} errors are a \
     tenth to a half for its spread, more for its height, {heat}{force} for means of force, which peak before the film \
     is as thin";
    "did you mean a `spacing` of {spacing} m or less?"

    Check middle_too_hot(spacing)
    "the temperature under the middle of the drop changes too much, by a tenth to a third with 20 particles across, \
     as its thermal layer √(aD/U) is thinner than three quarters of a particle";
    "did you mean a `spacing` of {spacing} m or less?"

    Check film_breaks_up(layers, spacing)
    "heat is expected to be too low by a twentieth to a half: on what conducts less than the fluid it is \
     proportional to the wetted area, and the film breaks up, with {layers} particles across its layer of shear \
     √(νD/U)";
    "did you mean a `spacing` of {spacing} m or less?"

    Check wetted_area_unresolved(layers, spacing)
    "heat may be off by a tenth to a third, either way: on what conducts less than the fluid it is proportional to \
     the wetted area, which {layers} particles across its layer of shear √(νD/U) do not resolve";
    "did you mean a `spacing` of {spacing} m or less?"

    Check heat_beyond_tolerance(error, tolerated, film, sheared, warmed, finer_spacing)
    "heat is expected to be off by {error}, more than {tolerated}: {film} particles lie across the film at last, \
     {sheared} across its layer of shear √(νD/U) and {warmed} across that of heat √(aD/U)"; "{finer_spacing}"

    Check heat_error_not_fitted(error, outside, finer_spacing)
    "heat may be off by up to {error} either way: the law of its error was not fitted on this drop, {outside}";
    "{finer_spacing}"

    Check drops_stack(time, films, measured)
    "the drop at {time} s is expected to come down on {films} films that still transfer heat: more than {measured} \
     on one place were not compared with particles. Temperatures stay between those of drops and wall, but their \
     accuracy is not known"; "`method = \"sph\"` computes every drop, at the cost that `check` reports"

    Check layer_thinner_than_heat_penetrates(thickness, depth)
    "temperatures and heat are expected to be off, temperatures up to beyond the drop's own: a drop of this method \
     cools as on a half space of what it lands on, which is {thickness} m thick, and heat penetrates {depth} m \
     meanwhile";
    "did you mean `sph`?"

    Check record_cut_short(duration, given, wetted, usual)
    "the record ends {duration} s after contact, when the drop is expected to have given {given} % of its momentum and to \
     have wetted {wetted} % of its largest radius: the rest of the momentum is left out, and of the heat what the rest \
     of the surface would take"; "leave out `duration`, which is {usual} s then"

    Check film_cools_through(fourier, usual)
    "the change of temperature under the middle of the drop is expected to be too small, by a fifth to nine tenths, and \
     heat is off by up to a half, as this film has cooled through while the drop still comes down (a(D/U)/δ² = {fourier} of what \
     is in contact; films are accurate below {usual})"; "did you mean `sph`?"

    Check film_on_insulator()
    "heat is expected to be too low by a tenth to a half: on what conducts less than a seventh of the fluid it is \
     proportional to the wetted area, which correlations predict no better"; "did you mean `sph`?"

    Check film_not_fitted(error, outside)
    "{error}, as this method was not fitted on such a drop: {outside}"; "did you mean `sph`?"

    Build drops_may_miss_fine_mesh(solid, radius)
    "inputs may let drops fall anywhere on `{solid}`, whose mesh is fine out to {radius} m from its middle only: \
     beyond, temperature rises are far too low"; "set the `radius` of the coupling to where drops may fall"
}
